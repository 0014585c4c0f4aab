//! Laws of force: what a mm of edge bears with a chip of some thickness.
//!
//! Takes the thickness of the chip, gives force per length of edge along the tooth's way, along the outward normal of the
//! envelope and along the edge. `shared/theory/cutting.md`; [R 2.2-2.4] with their errata.

mod any;
mod correction;
mod exponential;
mod force_law;
mod kienzle;
mod linear;
mod rational;
mod scaled;
mod worst_case;

pub use any::Law;
pub use correction::{Coolant, Corrected, Correction, CuttingMaterial, RakeReference};
pub use exponential::Exponential;
pub use force_law::{EdgeForce, ForceLaw};
pub use kienzle::Kienzle;
pub use linear::Linear;
pub use rational::Rational;
pub use scaled::Scaled;
pub use worst_case::{force_as_printed, largest_force};
