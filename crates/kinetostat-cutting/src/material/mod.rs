//! Materials: coefficients of a law of force with their source, their spread and what is assumed.
//!
//! Takes TOML, the library that comes with this crate or a user's file of the same form; gives [`Material`]s by any of their
//! names, and their law with the factors by which a cut differs from the test ([`Material::for_milling`], [R 2.1]). Where
//! each number was read stands with it in `library.toml`.

mod corrected;
mod library;
mod text;

pub use corrected::{Applied, AppliedFactor, Group, Material, MeasuredIn, Process};
pub use library::Materials;
