//! The stiffness of a robot from measured deflections.
//!
//! A model is as good as its numbers, and nobody has the stiffness of his robot. With a weight on a string and a dial gauge, or a
//! laser tracker, it is measured in a morning. This crate holds the numbers of a model against such readings.
//!
//! ```text
//! table              measurements as text: postures, loads, readings; the frame of the instrument
//! experiment         the same as observations; body: what is loaded and read, the tool or a node of a limb
//! unknown            which numbers of the model, as compliances; springs, change: what they change
//! geometry, markers  errors of the geometry and places of markers as unknowns; gauge: which of their combinations are free
//! prediction         what the machine would show, and its derivatives; push: small motions of it at rest
//! least_squares      weighted least squares by postures; cone: with physical constraints
//! fit                Gauss-Newton steps over both
//! identifiability    what the readings see
//! result, findings   the numbers, and what must be known of them; written: as a model file; work: what they are good for;
//!                    resampling: intervals by other postures
//! plan, design       the postures in which to measure
//! ```

mod axes;
mod body;
mod change;
mod compliance_matrix;
mod cone;
pub mod design;
mod error;
mod experiment;
mod findings;
mod fit;
mod gauge;
mod geometry;
mod identifiability;
mod identified;
mod least_squares;
mod markers;
mod plan;
mod prediction;
mod push;
mod random;
mod resampling;
mod result;
mod springs;
mod table;
mod unknown;
mod work;
mod written;

pub use axes::Axes;
pub use body::{Body, BodyPoint};
pub use cone::{Constrained, ConstrainedRows, Constraint, NotSolved, UNSEEN};
pub use error::IdentificationError;
pub use experiment::{Branch, Observation, Reading, ReadingOf, TestLoad};
pub use findings::Finding;
pub use fit::{Fit, FitOptions, identify};
pub use gauge::Gauge;
pub use identifiability::{Combination, Identifiability, Knowledge, WEAK};
pub use identified::{DirectionResiduals, IdentifiedNumber, PostureResiduals};
pub use least_squares::{HUBER, LinearFit, PostureRows, Start, fit as least_squares};
pub use markers::MARKER_ERROR;
pub use plan::{Plan, PlanError, PlanTask, PlannedMeasurement, Purpose, Room, plan};
pub use prediction::{Prediction, Theory, predict};
pub use result::{Identification, identification};
pub use table::{
    COLUMNS, DEVIATION, InstrumentFrame, MOST_FAULTS, MeasuredRow, NoFrame, Read, TURN_DEVIATION,
    TableFault, into_base, observations, places, read_postures, read_table,
};
pub use unknown::{Form, Unknown, Unknowns};
pub use work::ErrorAtWork;
pub use written::identified_model;
