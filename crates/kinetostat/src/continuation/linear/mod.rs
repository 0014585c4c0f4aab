//! The linear problem at one point of a curve: its matrix (dense or by sweeps), the tangent, null directions, and families of
//! equilibria that motions for nothing make.
//!
//! Takes the derivatives at a point, gives steps and tangents: `[K, -P; n^T] [du; dlambda] = [-r; 0]`.

pub(crate) mod curve_matrix;
pub(crate) mod curve_sweep;
pub(crate) mod family;
pub(crate) mod tangent;
