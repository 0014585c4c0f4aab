//! Tolerances: what is known of a machine whose lengths, stiffnesses, errors and loads are not exactly those of the drawing.
//!
//! An uncertain number has a distribution about its value ([`Distribution`]), some go together ([`Uncertainties`]). Machines are
//! built as chance draws them and commanded as the drawing says ([`UncertainMachine`]). Three answers stand beside each other:
//!
//! - **linear**: derivatives by central differences, `variance = g^T C g` ([`Linear`]); exact for small spreads.
//! - **draws**: thousands of machines at points of scrambled Sobol sequences, with quantiles and their confidence ([`Summary`]).
//! - **which number it comes from**: Sobol indices ([`sobol_indices`]).
//!
//! [`Verdict`] says whether the first is enough. Draws without an answer are counted ([`Failures`]).
//!
//! ```
//! use kinetostat_analysis::tolerance::{Distribution, Draws, Summary, Uncertain, Uncertainties};
//! // Two springs in series, 2 and 3 N/mm, both to 5 %: compliance 1/2 + 1/3 mm/N.
//! let spring = |name: &str, value| Uncertain {
//!     name: name.into(), value, unit: "N/mm".into(), distribution: Distribution::Normal(0.05 * value),
//! };
//! let springs = Uncertainties::independent(vec![spring("a", 2.0), spring("b", 3.0)]);
//! let draws = Draws::new(4096, 1);
//! let compliance: Vec<f64> = (0..draws.len())
//!     .map(|i| springs.drawn(&draws, i).iter().map(|k| 1.0 / k).sum())
//!     .collect();
//! let found = Summary::of(&draws, &compliance);
//! let linear = 0.05 * (1.0_f64 / 4.0 + 1.0 / 9.0).sqrt();
//! assert!((found.standard_deviation.value / linear - 1.0).abs() < 0.02);
//! ```

mod along_program;
mod draws;
mod file;
mod linear;
mod machine;
mod near_drawing;
mod statistics;
mod study;
mod uncertain;

pub use along_program::{CuttingParts, UncertainRun, band};
pub use draws::{Distribution, Draws, MOST_DRAWS, REPLICATES};
pub use file::{CUTTING_PARTS, SharedNumber, Source, UncertaintyFile};
pub use linear::{ENOUGH, Linear, NOTHING, linear, linear_points, nonlinearity};
pub use machine::{DependsOnMachine, Quantity, Room, TaskError, UncertainMachine};
pub use statistics::{
    CONFIDENCE, Estimate, Quantile, SHARES, Summary, mean_and_deviation, quantile,
};
pub use study::{
    Failures, MOST_MISSING, MOST_NUMBERS, OutputAnswer, Samples, SobolIndex, TooManyNumbers,
    Verdict, answers, can_be_kept, design_row, design_rows, linearised, monte_carlo, sample, sobol,
    sobol_indices,
};
pub use uncertain::{Contradiction, Uncertain, Uncertainties};
