//! Measured points, from CSV or from the path of a second program.

mod read;
mod set;

pub use set::{MeasuredPoint, MeasuredPoints};
