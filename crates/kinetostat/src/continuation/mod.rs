//! Equilibria as one parameter grows: a displacement of the end or a pattern of loads, around limit points and through
//! bifurcations.
//!
//! Takes an equilibrium and what grows, gives the curve through it with limit points, bifurcations, jumps and stability.
//! What a curve needs of a chain or a machine is one trait (`system`), implemented in `chain_*` and
//! `machine_system` (with
//! `tool_*`); `tracer`, `special_points`, `branch_switching` and `jumps` know nothing else.
//!
//! ```text
//! G(u, lambda) = 0,   normal . (z - z_0) = ds                             arc length (Keller)
//! limit point: the parameter's rate changes its sign;  simple bifurcation: det [G_z; t^T] does
//! ```

pub(crate) mod bifurcation;
pub(crate) mod branch_switching;
pub(crate) mod chain_curve;
pub(crate) mod chain_linearisation;
pub(crate) mod chain_stability;
pub(crate) mod chain_start;
pub(crate) mod chain_system;
pub(crate) mod corrector;
pub(crate) mod curve;
pub(crate) mod curve_equilibrium;
pub(crate) mod curve_matrix;
pub(crate) mod curve_sweep;
pub(crate) mod dense_matrix;
pub(crate) mod describe;
pub(crate) mod description;
pub(crate) mod displacement_curve;
pub(crate) mod family;
pub(crate) mod family_of;
pub(crate) mod follow;
pub(crate) mod jumps;
pub(crate) mod machine_curves;
pub(crate) mod machine_system;
pub(crate) mod null_directions;
pub(crate) mod parameter;
pub(crate) mod segment;
pub(crate) mod settings;
pub(crate) mod singular_point;
pub(crate) mod special_points;
pub(crate) mod state_distance;
pub(crate) mod system;
pub(crate) mod tangent;
pub(crate) mod tool_conditions;
pub(crate) mod tool_equilibrium;
pub(crate) mod tool_stability;
pub(crate) mod tool_steps;
pub(crate) mod tracer;

pub use curve::{Branch, BranchEnd, CurvePoint, Curves, Jump, Special, SpecialKind};
pub use curve_equilibrium::{CurveEquilibrium, CurveStability};
pub use displacement_curve::{DisplacementCurve, DisplacementPoint};
pub use follow::follow;
pub use machine_curves::MachineCurves;
pub use parameter::{LoadPattern, Parameter};
pub use settings::CurveSettings;
pub use tool_stability::MachineStability;
