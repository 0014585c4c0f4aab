//! Cutting forces from the cut.
//!
//! A chip of some thickness costs force per length of edge ([`ForceLaw`]); the edges of a [`Tool`] are in the material where
//! its [`Engagement`] says; what all of them bear together is the force on the tool. It knows no robot and no program: mm, N,
//! N/mm^2 and rad, unless a name says otherwise; forces are those **on the tool**.
//!
//! Axes of the cut: x along the feed of the tool over the part, z along the tool axis towards the spindle, y to the left of
//! the feed. Source: `shared/theory/cutting.md`, and chapter 2 of the report with its errata.

mod engagement;
mod error;
mod law;
mod number;
mod stock;
mod tool;

pub use engagement::{Contact, Edge, Engagement, Side};
pub use error::{CutError, CutErrorKind, Result};
pub use law::{
    Coolant, Corrected, Correction, CuttingMaterial, EdgeForce, Exponential, ForceLaw, Kienzle,
    Law, Linear, RakeReference, Rational, force_as_printed, largest_force,
};
pub use stock::{Probe, Station, Stock, StockSettings};
pub use tool::{RunOut, Shape, Tool};
