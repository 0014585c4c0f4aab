//! The stiffness of a robot from measured deflections.
//!
//! A model is as good as its numbers, and nobody has the stiffness of his robot. With a weight on a string and a dial gauge, or a
//! laser tracker, it is measured in a morning. This crate holds the numbers of a model against such readings.
//!
//! ```text
//! unknown        which numbers of the model, as compliances
//! experiment     postures, loads, readings
//! prediction     what the machine would show, and its derivatives
//! least_squares  weighted least squares by postures
//! fit            Gauss-Newton over both
//! ```

mod axes;
mod cone;
pub mod design;
mod error;
mod experiment;
mod fit;
mod identifiability;
mod least_squares;
mod plan;
mod prediction;
mod result;
mod table;
mod unknown;

pub use axes::Axes;
pub use cone::{BlockState, ConeError, ConeLeastSquares, ConeSolution, Constraint, KktResidual};
pub use error::IdentificationError;
pub use experiment::{Branch, Observation, Reading, ReadingOf, TestLoad};
pub use fit::{Fit, FitOptions, identify};
pub use identifiability::{Combination, Identifiability, Knowledge, WEAK};
pub use least_squares::{HUBER, LinearFit, PostureRows, Start, UNSEEN, fit as least_squares};
pub use plan::{Plan, PlanError, PlanTask, PlannedMeasurement, Purpose, Room, plan};
pub use prediction::{Prediction, Theory, predict};
pub use result::{
    Finding, Identification, IdentifiedNumber, PostureResiduals, identification, identified_model,
    uncertainty_file,
};
pub use table::{
    COLUMNS, DEVIATION, InstrumentFrame, MOST_FAULTS, MeasuredRow, NoFrame, Read, TURN_DEVIATION,
    TableFault, into_base, observations, read_table,
};
pub use unknown::{Form, Unknown, Unknowns};
