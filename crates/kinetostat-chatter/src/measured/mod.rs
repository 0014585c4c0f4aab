//! Measured responses: read, fitted, compared with a model, and what of a model's parameters they tell.
//!
//! `response` is one measured curve; `universal` and `columns` read files of it; `fit` finds modes by rational
//! fraction polynomials; `scaling` pairs them with a model's, and scales parameters of the model to them.

mod columns;
mod fit;
mod response;
mod scaling;
mod universal;

pub use columns::{read_columns, turning_columns};
pub use fit::{Fit, FittedMode, fit_modes};
pub use response::{MeasuredResponse, Motion};
pub use scaling::{
    ModePair, Parameter, Scaled, ShapedMode, modal_assurance, pair_modes, scale_parameters,
};
pub use universal::{UniversalFile, read_universal};
