//! Elasto-dynamics about a loaded equilibrium: mass, modes, damping, response.
//!
//! A robot that machines vibrates about the posture into which gravity and the cut bend it; its frequencies depend on the
//! posture and on the load, and the lowest one falls to zero where its shape buckles. This crate takes an equilibrium of
//! `kinetostat` - a chain, or a machine of platforms with loops - and gives what is linear about it:
//!
//! ```text
//! M(x*) x'' + C x' + (K - H) x = B^T w                  x* the LOADED equilibrium            [D3]
//! N^T (K - H) N, N^T M N, N the null space of closures and held directions                  [D5]
//! w^2 M phi = (K - H) phi, massless coordinates followed exactly                            [D6]
//! G(w) = sum phi phi^T / (w_k^2 - w^2 + 2 i zeta_k w_k w) + residual,   G(0) = loaded compliance
//! ```
//!
//! | question | answer |
//! |---|---|
//! | the linear machine about an equilibrium | [`LinearDynamics::of_chain`], [`LinearDynamics::of_machine`] |
//! | its modes, signed frequencies, counts of free, massless, neutral and rigid directions | [`LinearDynamics::modes`] |
//! | the lowest modes of a long chain or of any machine, at a cost by its length | [`LongChain`], [`lowest_modes`] |
//! | which body moves, which spring bends | [`LinearDynamics::kinetic_shares`], [`LinearDynamics::elastic_shares`] |
//! | dead moments, followers, dampers: flutter or divergence | [`LinearDynamics::complex_modes`] |
//! | damping | [`Damping`], [`LinearDynamics::damping_ratios`] |
//! | response between two points | [`ModalResponse`], [`LinearDynamics::direct`] |
//! | modal data of a cut, for chatter | [`ModalResponse::translational`] |
//! | rotors behind elastic gears | [`Rotor`], [`LinearDynamics::with_rotors`] |
//! | a tool that spins | [`LinearDynamics::gyroscopic_matrix`] |
//! | a large limb by a few numbers | [`LinearDynamics::reduced`] |
//!
//! `[D 5]` is section 5 and `[D5]` equation 5 of the theory note on dynamics. SI units, linear part before angular, base
//! axes. A physical finding - unstable, free, neutral - is a field of a result; `Err` is a wrong input or a question
//! without an answer. No I/O.
//!
//! Mass along links is part of the model ([`kinetostat::LinkSpec::with_mass`]): it moves as the link bends, and weighs
//! in the statics. A link hinged at both ends that has its mass in a rigid body instead vibrates 70 % too slowly.
//!
//! # Not covered
//!
//! Friction and backlash, servo dynamics beyond a spring, flexible foundations and workpieces. No number here was measured on a machine.

mod damping;
mod ends;
mod error;
mod linear;
mod mass;
mod modes;
mod reduction;
mod response;
mod swept;

pub use damping::Damping;
pub use ends::Held;
pub use error::{Error, Result};
pub use linear::places::Point;
pub use linear::rotor::Rotor;
pub use linear::{LinearDynamics, LumpedLink};
pub use mass::body::{about_point, check_masses};
pub use mass::{MassKind, MassPart};
pub use modes::complex::{ComplexMode, ComplexModes, Verdict};
pub use modes::{DirectionCounts, EnergyShare, Mode, ModeKind, Modes};
pub use reduction::{BoundedFrequency, ReducedLimb};
pub use response::coupled::{CoupledDamping, TranslationalModes};
pub use response::direct::DirectResponse;
pub use response::modal::ModalResponse;
pub use response::{Quantity, Receptance};
pub use swept::long_chain::LongChain;
pub use swept::lowest::{lowest_modes, lowest_modes_of_state};
