//! What was done and read: a posture, a load, and displacements or places of points of the tool or of other links.

use kinetostat::{Load, Mechanism, Wrench};
use nalgebra::Vector3;

use crate::body::{Body, BodyPoint};
use crate::error::IdentificationError;

/// A force and a moment that keep their direction while the body on which they act moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestLoad {
    /// Force, N, base axes.
    pub force: Vector3<f64>,
    /// Moment, N m, base axes.
    pub moment: Vector3<f64>,
    /// Point at which the force acts.
    pub at: BodyPoint,
}

/// What a reading measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReadingOf {
    /// Displacement of the marker along a unit vector (base axes), m.
    Along(Vector3<f64>),
    /// Turn of the marker's body about a unit vector (base axes), rad.
    About(Vector3<f64>),
    /// Place of the marker along a unit vector (base axes), from the origin of the base, m: under the load, not by it.
    Place(Vector3<f64>),
}

/// One number that was read: the state under the load less that without it, or, for a place, the state itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Quantity.
    pub of: ReadingOf,
    /// The marker.
    pub marker: BodyPoint,
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
    /// A force at a point: a vector (m) is one of the tool.
    #[must_use]
    pub fn force_at(at: impl Into<BodyPoint>, force: Vector3<f64>) -> Self {
        Self {
            force,
            moment: Vector3::zeros(),
            at: at.into(),
        }
    }

    /// The machine under this load on one of its nodes; one on the tool is the wrench of an equilibrium.
    pub(crate) fn on_nodes(&self, mechanism: Mechanism) -> kinetostat::Result<Mechanism> {
        let Body::Node { limb, node } = self.at.on else {
            return Ok(mechanism);
        };
        let name = mechanism.limbs()[limb].name.clone();
        let force = Load::point_force(node, self.at.at, self.force);
        let moment = Load::dead(node, Wrench::new(Vector3::zeros(), self.moment));
        mechanism.with_load(&name, force)?.with_load(&name, moment)
    }

    /// The wrench of an equilibrium under this load: zero for one on a node.
    pub(crate) fn on_tool(&self) -> Wrench {
        match self.at.on {
            Body::Tool => Wrench::new(self.force, self.moment),
            Body::Node { .. } => Wrench::zero(),
        }
    }

    /// Where the tool's frame is put for this load: at the point where it acts on the tool.
    pub(crate) fn tool_at(&self) -> Vector3<f64> {
        match self.at.on {
            Body::Tool => self.at.at,
            Body::Node { .. } => Vector3::zeros(),
        }
    }

    /// From the origin of a body's frame, as it is under this load, to a place in its own frame.
    pub(crate) fn arm_to(&self, on: Body, place: Vector3<f64>) -> Vector3<f64> {
        match on {
            Body::Tool => place - self.tool_at(),
            Body::Node { .. } => place,
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
        marker: impl Into<BodyPoint>,
        displacement: &Vector3<f64>,
        deviation: f64,
    ) -> [Self; 3] {
        let marker = marker.into();
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::Along(Vector3::ith(k, 1.0)),
            marker,
            value: displacement[k],
            deviation,
        })
    }

    /// Three readings of a marker's place, each with the same standard deviation; `marker` is its nominal place.
    #[must_use]
    pub fn place(marker: impl Into<BodyPoint>, place: &Vector3<f64>, deviation: f64) -> [Self; 3] {
        let marker = marker.into();
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::Place(Vector3::ith(k, 1.0)),
            marker,
            value: place[k],
            deviation,
        })
    }

    /// Three readings of a body's turn as a rotation vector.
    #[must_use]
    pub fn turn(on: Body, turn: &Vector3<f64>, deviation: f64) -> [Self; 3] {
        let at = Vector3::zeros();
        [0, 1, 2].map(|k| Self {
            of: ReadingOf::About(Vector3::ith(k, 1.0)),
            marker: BodyPoint { on, at },
            value: turn[k],
            deviation,
        })
    }
}

impl Observation {
    /// A motion that nothing holds lies along a load or a reading.
    pub(crate) fn free(&self) -> IdentificationError {
        IdentificationError::Free {
            posture: self.posture.clone(),
        }
    }

    /// The machine refuses this posture.
    pub(crate) fn refused(&self, reason: kinetostat::Error) -> IdentificationError {
        IdentificationError::Posture {
            posture: self.posture.clone(),
            reason,
        }
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
