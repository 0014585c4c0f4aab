//! What was done and read: a posture, a load on the tool, and displacements or places of points of the tool.

use nalgebra::Vector3;

/// A force and a moment on the tool that keep their direction while it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestLoad {
    /// Force, N, base axes.
    pub force: Vector3<f64>,
    /// Moment, N m, base axes.
    pub moment: Vector3<f64>,
    /// Point at which the force acts, m, in the tool's frame.
    pub at: Vector3<f64>,
}

/// What a reading measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReadingOf {
    /// Displacement of the marker along a unit vector (base axes), m.
    Along(Vector3<f64>),
    /// Turn of the tool about a unit vector (base axes), rad.
    About(Vector3<f64>),
    /// Place of the marker along a unit vector (base axes), from the origin of the base, m: under the load, not by it.
    Place(Vector3<f64>),
}

/// One number that was read: the state under the load less that without it, or, for a place, the state itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Quantity.
    pub of: ReadingOf,
    /// Place of the marker, m, in the tool's frame.
    pub marker: Vector3<f64>,
    /// Value, m or rad.
    pub value: f64,
    /// Its standard deviation, m or rad.
    pub deviation: f64,
}

/// Whether a load was being put on or taken off when readings were taken: friction holds the joints back either way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// The load is taken off.
    pub unloading: bool,
    /// The whole load, which decides the directions of the torques.
    pub whole: TestLoad,
}

/// Readings in one posture under one load.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Name of the posture: observations with the same name share its errors.
    pub posture: String,
    /// Commands of the actuators, m or rad, in the order of [`kinetostat::Mechanism::actuator_names`].
    pub commands: Vec<f64>,
    /// The load.
    pub load: TestLoad,
    /// Side of a loop of loading and unloading; none where nobody knows.
    pub branch: Option<Branch>,
    /// The readings.
    pub readings: Vec<Reading>,
}

impl TestLoad {
    /// A force at a point of the tool.
    #[must_use]
    pub fn force_at(at: Vector3<f64>, force: Vector3<f64>) -> Self {
        Self {
            force,
            moment: Vector3::zeros(),
            at,
        }
    }
}

impl Reading {
    /// True for a place, false for what a load changed.
    #[must_use]
    pub fn is_place(&self) -> bool {
        matches!(self.of, ReadingOf::Place(_))
    }

    /// Three readings of a marker's displacement, each with the same standard deviation.
    #[must_use]
    pub fn displacement(
        marker: Vector3<f64>,
        displacement: &Vector3<f64>,
        deviation: f64,
    ) -> [Self; 3] {
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::Along(Vector3::ith(k, 1.0)),
            marker,
            value: displacement[k],
            deviation,
        })
    }

    /// Three readings of a marker's place, each with the same standard deviation; `marker` is its nominal place in the tool's frame.
    #[must_use]
    pub fn place(marker: Vector3<f64>, place: &Vector3<f64>, deviation: f64) -> [Self; 3] {
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::Place(Vector3::ith(k, 1.0)),
            marker,
            value: place[k],
            deviation,
        })
    }

    /// Three readings of the tool's turn as a rotation vector.
    #[must_use]
    pub fn turn(turn: &Vector3<f64>, deviation: f64) -> [Self; 3] {
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::About(Vector3::ith(k, 1.0)),
            marker: Vector3::zeros(),
            value: turn[k],
            deviation,
        })
    }
}

/// Groups of observations of one posture each, in the order in which the postures come first.
pub(crate) fn by_posture(observations: &[Observation]) -> Vec<(&str, Vec<usize>)> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut index = std::collections::BTreeMap::new();
    for (i, observation) in observations.iter().enumerate() {
        let name = observation.posture.as_str();
        let at = *index.entry(name).or_insert_with(|| {
            groups.push((name, Vec::new()));
            groups.len() - 1
        });
        groups[at].1.push(i);
    }
    groups
}
