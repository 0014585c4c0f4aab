//! A row of a table of measurements, and a fault of one.

use nalgebra::Vector3;

use crate::body::BodyPoint;
use crate::experiment::TestLoad;

/// A fault of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFault {
    /// Line of the file, from 1.
    pub line: usize,
    /// Column by its name in the header, where one is at fault.
    pub column: Option<String>,
    /// What stands there.
    pub found: Option<String>,
    /// What is wrong, and what is needed.
    pub message: String,
}

/// Most faults that are listed; a file of another kind has one in every cell.
pub const MOST_FAULTS: usize = 50;

/// What a row says of its marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// Displacement by the load, m, base axes.
    pub displacement: Option<Vector3<f64>>,
    /// Place of the marker, m, base axes.
    pub position: Option<Vector3<f64>>,
    /// Turn of the marker's body by the load as a rotation vector, rad, base axes.
    pub turn: Option<Vector3<f64>>,
    /// Displacement along the stylus of a gauge, m, and the direction in which it counts up (base axes).
    pub gauge: Option<(f64, Vector3<f64>)>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRow {
    /// Line of the file, from 1.
    pub line: usize,
    /// Name of the posture; its axes where the table does not name it.
    pub posture: String,
    /// Axes as they were shown, m or rad.
    pub shown: Vec<f64>,
    /// Commands of the actuators, m or rad.
    pub commands: Vec<f64>,
    /// Force and moment, base axes, and where they act.
    pub load: TestLoad,
    /// Mass that hangs at the same point, kg.
    pub mass: f64,
    /// The marker.
    pub marker: BodyPoint,
    /// What was read.
    pub read: Read,
    /// Standard deviation of lengths, m.
    pub deviation: Option<f64>,
    /// Standard deviation of turns, rad.
    pub turn_deviation: Option<f64>,
    /// The load is taken off rather than put on, where the table says which.
    pub unloading: Option<bool>,
}

/// Standard deviation of lengths where neither the table nor the caller states one, m: a good dial gauge or a laser tracker.
pub const DEVIATION: f64 = 20e-6;
/// Standard deviation of turns where none is stated, rad.
pub const TURN_DEVIATION: f64 = 20e-6;

impl MeasuredRow {
    pub(crate) fn load_under(&self, gravity: &Vector3<f64>) -> TestLoad {
        TestLoad {
            force: self.load.force + gravity * self.mass,
            ..self.load
        }
    }

    pub(crate) fn is_loaded(&self) -> bool {
        self.load.force != Vector3::zeros()
            || self.load.moment != Vector3::zeros()
            || self.mass != 0.0
    }
}
