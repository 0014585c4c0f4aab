//! The target that must be commanded so that the tool is where it should be under load: `F = f(t_desired | t0F)`
//! [R 7.7-7.13]; of machines with fewer than six freedoms for the position alone, whose orientation follows.

pub(crate) mod following;
pub(crate) mod target;

pub use following::{compensate_following, target_under_load_following};
pub use target::{Compensation, compensate, compensate_from, target_under_load};
