//! Forces that a dynamometer has logged: read, conditioned, and matched in time.
//!
//! Knows neither robot nor program. Takes the log as CSV (forces over time, or along the path) and what is known of it (when
//! the tool was in air, over which time to smooth); gives forces without outliers, drift and the ripple of the teeth, with what
//! was done to them ([`Conditioning`]), and the shift between the clock of the log and that of an expected course of the force
//! ([`match_shift`]).
//!
//! Sources: outliers, R. K. Pearson, "Outliers in process modeling and identification", IEEE Trans. Control Syst. Technol. 10,
//! 2002 (Hampel filter); the shift, the usual cross-correlation with the coefficient of Pearson at every shift, by fast Fourier
//! transform (`rustfft`); drift and mean, own work.

mod cleaning;
mod conditioning;
mod correlation;
mod log;
mod matching;
mod report;

pub use cleaning::{DriftModel, DriftRemoved, Outlier};
pub use conditioning::{Conditioned, Conditioning, OutlierTreatment};
pub use correlation::Activity;
pub use log::{ForceLog, LoggedBy};
pub use matching::{ShiftMatch, match_shift};
pub use report::ConditioningReport;
