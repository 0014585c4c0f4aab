//! Deviations along the path: outliers, smoothing, and what the points cannot tell.

mod kernel;
mod measure;
mod on_lines;
mod outliers;
mod piece_means;
mod stations;
mod unseen;

pub use kernel::{Kernel, Smoothed};
pub(crate) use measure::smoothed_along;
pub use measure::{DeviationFigures, MeasureSettings, Measurement, Register, measure};
pub use on_lines::{OnLines, on_lines};
pub use outliers::Outlier;
pub use piece_means::PieceMean;
pub(crate) use piece_means::piece_means;
pub use stations::{Stations, Stretch};
pub use unseen::Unseen;
