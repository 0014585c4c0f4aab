//! Linear algebra that the mechanics rests on: it knows matrices and nothing of robots.
//!
//! Takes scaled matrices (every unknown in a unit that makes it comparable), gives solutions of least norm, ranks,
//! ranges, inertia: a singular matrix is a result here, never an exception.
//!
//! ```text
//! saddle             A x = b, bordered or aggregated; pseudo-inverse and rank where A is singular
//! singular_values    one-sided Jacobi rotations: ranks, ranges, shortest solutions
//! complement         bases of what is orthogonal to given columns, by Householder reflections
//! block_elimination  the same for many platforms, block by block with delayed pivots; sparse: their entries
//! derivatives        numbers that formulas are written for once: single ones, several in one, with their derivatives
//! krylov             the few largest eigenvalues of a large symmetric matrix
//! largest            the largest entry, NaN included
//! ```

pub(crate) mod block_elimination;
pub(crate) mod complement;
pub(crate) mod derivatives;
pub(crate) mod saddle;
pub(crate) mod singular_values;
pub(crate) mod sparse;

pub use saddle::Inertia;
pub use singular_values::SingularValues;
