//! One chain at one state, and Newton's iteration for it: a limb by itself, or a serial robot.
//!
//! Takes a [`ChainProblem`] (commands, loads, what is prescribed at the end), gives the tangent
//! stiffness at the end, the principal directions with the joints and springs that take part in them, and whether the
//! shape is stable. Long chains are solved by sweeps along them (`sweep`), short ones by dense matrices: two algorithms
//! of one linear system, held together by one suite of tests (`tests/core/internal/sweeps.rs`).
//!
//! ```text
//! [ 0    J   ] [ F ]                                                      bordered system [R 4.15-4.16, 4.26]
//! [ J^T  H-K ] [ x ]
//! K_C = (J_theta K^-1 J_theta^T)^-1 with passive joints eliminated        [R 3.10, 3.13, 4.28]
//! N^T (K - H) N > 0, N the null space of J: the shape is stable           [R 5.16-5.21]
//! mu, the largest eigenvalue of H against K there: the buckling margin, 1 is buckling (`stability.rs`)
//! ```

pub(crate) mod compliance;
pub(crate) mod directions;
pub(crate) mod equilibrium;
pub(crate) mod graded;
pub(crate) mod link_load;
pub(crate) mod newton;
pub(crate) mod problem;
pub(crate) mod residual;
pub(crate) mod scaling;
pub(crate) mod stability;
pub(crate) mod stiffness;
pub(crate) mod sweep;
pub(crate) mod system;
pub(crate) mod tangent;

pub use compliance::CartesianCompliance;
pub use directions::{Direction, DirectionKind, Share};
pub use equilibrium::Equilibrium;
pub use graded::{uneven_springs, uneven_stiffness};
pub use link_load::{LinkLoad, link_loads};
pub use problem::{ChainProblem, EndCondition, Prescribed, is_conservative, load_energy};
pub use residual::{FoundBy, Residual};
pub use stability::ShapeStability;
pub use stiffness::{ChainStiffness, unloaded_stiffness};
pub use tangent::{ChainPieces, ChainTangent};
