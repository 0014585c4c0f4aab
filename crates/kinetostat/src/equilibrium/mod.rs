//! Equilibria: the one to which a load leads, all that can be found, and the load at which stability is lost.
//!
//! Takes the question (a chain with its end condition, a posture with what holds and loads its tool), tries Newton's
//! iteration directly, then a load that grows, then other starts; where there is no equilibrium it says why. Built on
//! `chain`, `machine` and `continuation`, where `Posture::deflected_by` stands.
//!
//! ```text
//! tau(q) + sum J_j^T G_j + J^T F = 0,  g(q) = t where the end is prescribed      [R 4.12-4.16]
//! share s of the load grows: G = s G_1;  deflation: what is known repels the iteration
//! critical load: det (K - s H) = 0 on the null space of J                        [R 5.16-5.21]
//! ```

pub(crate) mod all_of_chain;
pub(crate) mod all_of_machine;
pub(crate) mod chain;
pub(crate) mod chain_search;
pub(crate) mod chain_starts;
pub(crate) mod critical;
pub(crate) mod critical_tangent;
pub(crate) mod descent;
pub(crate) mod found;
pub(crate) mod inner_motion;
pub(crate) mod limb_shapes;
pub(crate) mod machine_search;
pub(crate) mod search;

pub use all_of_chain::{SearchSettings, equilibria};
pub use all_of_machine::SpreadSettings;
pub use chain::solve_chain;
pub use chain_starts::Bounds;
pub use critical::{CriticalLoad, CriticalPoint, critical_load_factor};
pub use critical_tangent::StabilityOf;
pub use found::{Equilibria, FoundEquilibrium, LimbShapes};
