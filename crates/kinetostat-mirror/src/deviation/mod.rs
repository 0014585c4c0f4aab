//! Deviations along the path: outliers, smoothing, and what the points cannot tell.

mod along_path;
mod figures;
mod kernel;
mod measure;
mod on_lines;
mod outliers;
mod piece_means;
mod scatter;
mod stations;
mod unseen;

pub(crate) use along_path::smoothed_along;
pub use figures::DeviationFigures;
pub use kernel::{Kernel, Smoothed};
pub use measure::{MeasureSettings, Measurement, Register, measure};
pub use on_lines::{OnLines, on_lines};
pub use outliers::Outlier;
pub use piece_means::PieceMean;
pub(crate) use piece_means::piece_means;
pub use stations::{Stations, Stretch};
pub use unseen::Unseen;
