//! Equilibria as one parameter grows: a displacement of the end or a pattern of loads, around limit points and through
//! bifurcations.
//!
//! Takes an equilibrium and what grows, gives the curve through it with limit points, bifurcations, jumps and stability;
//! and where a machine comes to rest when its load has grown. What a curve needs of a chain or a machine is one trait
//! (`tracing::system`), implemented in `chain` and `machine`; the rest of `tracing` knows nothing else.
//!
//! ```text
//! linear    the linear problem at one point: K u' = P lambda', bordered, with its null directions
//! tracing   one step after the other, limit points, bifurcations, branches, jumps
//! chain     a chain with all of its reactions and coordinates as unknowns
//! machine   a machine by the motions of its tool; where its tool goes under a load or along a path
//!
//! G(u, lambda) = 0,   normal . (z - z_0) = ds                             arc length (Keller)
//! limit point: the parameter's rate changes its sign;  simple bifurcation: det [G_z; t^T] does
//! ```

pub(crate) mod chain;
pub(crate) mod curve;
pub(crate) mod follow;
pub(crate) mod linear;
pub(crate) mod machine;
pub(crate) mod settings;
pub(crate) mod tracing;

pub use curve::{
    Branch, BranchEnd, CurveEquilibrium, CurvePoint, CurveStability, Curves, Jump, Special,
    SpecialKind,
};
pub use follow::follow;
pub use machine::curves::MachineCurves;
pub use machine::displacement_curve::{DisplacementCurve, DisplacementPoint};
pub use machine::tool_stability::MachineStability;
pub use settings::{CurveSettings, LoadPattern, Parameter};
