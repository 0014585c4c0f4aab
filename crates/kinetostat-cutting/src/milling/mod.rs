//! Forces of a milling cutter from its engagement.
//!
//! Takes a tool, a law of force, an engagement and a feed; gives the force over the revolution, its mean, peaks and harmonics,
//! and the force at the moment at which a tooth makes the surface. `shared/theory/cutting.md`.
//!
//! Nothing is divided into slices of fixed size: between the places at which a chip begins, ends or changes the tooth that it
//! follows, the sums are integrals of smooth functions, and are taken by Gauss's rule.

mod chip;
mod cut;
mod cut_force;
mod feed;
mod instant;
mod mean;
mod peak;
mod revolution;
mod table;
mod thickness;
mod wall;

pub use cut::{Milling, Rotation};
pub use cut_force::CutForce;
pub use feed::Feed;
pub use peak::{Peak, Peaks};
pub use revolution::{Harmonic, Revolution};
pub use table::MeanTable;
pub use thickness::ChipThickness;
pub use wall::Wall;
