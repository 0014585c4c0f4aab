//! TODO

pub(crate) mod bifurcation;
pub(crate) mod branches;
pub(crate) mod curve_matrix;
pub(crate) mod curve_sweep;
pub(crate) mod family;
pub(crate) mod held_curve;
pub(crate) mod jumps;
pub(crate) mod machine_path;
pub(crate) mod reduced;
pub(crate) mod singular_point;
pub(crate) mod state_distance;
pub(crate) mod tracer;
