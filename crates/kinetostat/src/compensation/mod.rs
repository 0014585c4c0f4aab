//! The target that must be commanded so that the tool is where it should be under load: `F = f(t_desired | t0F)`
//! [R 7.7-7.13]; of machines with fewer than six freedoms for the position alone, whose orientation follows.
//!
//! Takes a mechanism, the desired pose (or position) and the wrench there, gives the target to command with its actuators
//! and what is left over (`target`; `following` where the orientation follows). Built on `machine` and `equilibrium`.
//!
//! ```text
//! t0 <- t0 + (t_desired - t(F | t0)) until the tool is there              [R 7.13]
//! here in one Newton iteration: the tool held at t_desired, the wrench F given, t0 unknown
//! ```

pub(crate) mod following;
pub(crate) mod target;

pub use following::{compensate_following, target_under_load_following};
pub use target::{Compensation, compensate, compensate_from, target_under_load};
