//! Many postures at once.
//!
//! A machine is compiled once into a [`Batch`]: per limb a list of steps with constants folded.
//! Kernels go along the steps with several postures in each number, without a branch that
//! depends on a posture and without allocating; the widest vector instructions of the machine are
//! chosen at run time. A posture whose lane cannot go on (a singular place, an iteration that does
//! not contract) is solved by the general engine, and so is every posture of a machine with something that no
//! kernel knows: the [`Status`] of each posture and the [`Engine`] of the result say so.
//!
//! Takes targets or commands and wrenches of many postures, gives tables of poses, coordinates, stiffnesses and stability,
//! one row for each, with a status.
//!
//! ```text
//! unloaded: C = sum a_j c_j a_j^T                  [R 3.10-3.13];   loaded: tau(q) = J^T F             [R 4.16]
//! machines: sum T_i^T F_i = W                      [R 6.21-6.30];   target: t0F <- t0F + (t - f^-1(F | t0F)) [R 7.13]
//! ```
//!
//! The answer of a posture depends on nothing but that posture: not on its neighbours, the number of
//! threads or the width of the vectors. Along a path ([`AlongPath`]) it depends on the places before it in the list that
//! is computed at once, too, far below what is written of it.

mod assessed;
mod commanded;
mod compiled;
mod equilibria;
pub(crate) mod limb;
pub(crate) mod machine;
pub(crate) mod numbers;
mod path;
pub(crate) mod plan;
mod run;
mod status;
mod stiffness;
mod table;

pub use commanded::{Commanded, LoadedBatch, over_machines};
pub use compiled::Batch;
pub use equilibria::{BatchEquilibrium, BatchTargets, Details, PostureStability};
pub use path::AlongPath;
pub use status::{Engine, NoKernel, Status};
pub use stiffness::BatchStiffness;
pub use table::Table;
