//! Coefficients of the linear law from mean forces that a dynamometer measured.
//!
//! Takes the mean force on the tool at several feeds per tooth in a cut that is stated; gives `K_c` and `K_e` with their 95 %
//! confidence intervals, by linear least squares on the closed form of the mean force (`shared/theory/cutting.md`,
//! Closed forms; the method is that of the average forces of slot tests, after Altintas).
//!
//! What it supposes: a flat cutter whose spindle turns clockwise; forces **on the tool**, in the axes of the cut (a
//! dynamometer under the part shows those on the part: change the sign of all three); run-out that lets no tooth miss its
//! chip. Near 0 and 180 degrees chips are thin and any run-out lets teeth miss them: with 4 um at feeds of 50 to 150 um in an
//! arc from 0 degrees on, `K_re` comes out 5 % too low, `K_rc` 2 % too high, and the intervals do not show it.

mod cut;
mod fit;
mod least_squares;
mod series;

pub use cut::MeasuredCut;
pub use fit::{Coefficient, CoefficientFit, fit_coefficients};
pub use series::{MeanForce, Series};
