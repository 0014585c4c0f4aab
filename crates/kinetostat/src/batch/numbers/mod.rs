//! Numbers of several postures: lanes of a vector register, and vectors, wrenches and matrices of them.
//!
//! Takes arrays of `f64`, gives the same operations for every lane; which instructions a processor has is asked once
//! (`instruction_set`). Knows nothing of robots.
//!
//! ```text
//! shifted wrench: (f, m + r x f);  symmetric 6 x 6 by 21 numbers;  elimination by reflections I - 2 v v^T / v^T v
//! ```

pub(crate) mod eliminate;
pub(crate) mod instruction_set;
pub(crate) mod lanes;
pub(crate) mod reflection;
pub(crate) mod symmetric;
pub(crate) mod vectors;
pub(crate) mod wrenches;
