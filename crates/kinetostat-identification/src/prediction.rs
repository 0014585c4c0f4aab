//! What a machine with certain compliances would show, and the derivatives of that by them.
//!
//! *Small loads.* The machine as drawn, springs at rest, no weights: with the motions `x_F` of a spring under the load and `x_v` under
//! the unit wrench `v` of a reading, the reading is `v . t` and its derivative by a number `p` of the spring is
//!
//! ```text
//! d(v . t)/dp = - x_v^T (dK/dp) x_F        so  tau_v c' tau_F  for a compliance, tau = K x
//! ```
//!
//! summed over the springs that have it. An arm carries the same torques whatever its springs are, so its readings are linear in the
//! compliances [R 4.16]; those of other machines are linear near them.
//!
//! *As loaded.* The reading is the pose under load and weights less the pose under the weights alone, both solved; the derivative of each
//! is that of its equilibrium (implicit function theorem, [`kinetostat::machine::LinearisedMachine::removing`]).

use std::collections::BTreeMap;

use kinetostat::machine::{MachineMotion, MachineResidual};
use kinetostat::number::larger;
use kinetostat::spatial::{hat, pose_residual};
use kinetostat::{Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3, Vector6};
use rayon::prelude::*;

use crate::body::{Body, BodyPoint, PlacedBody};
use crate::change::Change;
use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, ReadingOf};
use crate::push::{Push, no_residual};
use crate::springs::{SpringChange, drive_coordinates};
use crate::unknown::Unknowns;

/// Theory by which readings are predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theory {
    /// Stiffness at rest: no weights, displacements in proportion to the load.
    SmallLoads,
    /// Equilibria under load and weights, solved.
    Loaded,
}

/// Readings of one observation as they would be, m and rad, and their derivatives by the unknowns.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// The readings.
    pub values: DVector<f64>,
    /// One row for each reading, one column for each unknown.
    pub derivatives: DMatrix<f64>,
}

/// Predictions of all observations for certain values of the unknowns.
///
/// # Errors
/// Values that make no machine; postures in which it has no equilibrium.
pub fn predict(
    unknowns: &Unknowns,
    values: &DVector<f64>,
    observations: &[Observation],
    theory: Theory,
) -> Result<Vec<Prediction>, IdentificationError> {
    predict_each(unknowns, values, observations, theory)?
        .into_iter()
        .collect()
}

/// The same, one by one: an observation may have no answer.
pub(crate) fn predict_each(
    unknowns: &Unknowns,
    values: &DVector<f64>,
    observations: &[Observation],
    theory: Theory,
) -> Result<Vec<Result<Prediction, IdentificationError>>, IdentificationError> {
    let mechanism = unknowns.mechanism(values)?;
    let changes = unknowns.changes(values)?;
    let of_machine = changes
        .iter()
        .position(|c| matches!(c, Change::Machine { .. } | Change::Marker(..)));
    if let (Theory::SmallLoads, Some(i)) = (theory, of_machine) {
        let path = unknowns.list()[i].parameter.path.clone();
        return Err(IdentificationError::NeedsLoads { path });
    }
    let machine = Machine {
        mechanism,
        changes,
        markers: &unknowns.markers,
        places: unknowns.marker_places(values),
    };
    let of_place = |o: &&Observation| o.readings.iter().any(Reading::is_place);
    if let (Theory::SmallLoads, Some(own)) = (theory, observations.iter().find(of_place)) {
        let posture = own.posture.clone();
        return Err(IdentificationError::PlacesNeedLoads { posture });
    }
    Ok(machine.each(observations, |machine, observation| {
        let mut found = match theory {
            Theory::SmallLoads => machine.small(observation),
            Theory::Loaded => machine.loaded(observation),
        }?;
        machine.add_friction(observation, values, &mut found)?;
        Ok(found)
    }))
}

/// Share of the largest torque below which a drive is not loaded.
const NO_TORQUE: f64 = 1e-4;

/// A machine that answers, with the tool's frame at the point where loads act on it, and how it changes with the unknowns.
pub(crate) struct Machine<'a> {
    pub mechanism: Mechanism,
    pub changes: Vec<Change>,
    /// Nominal places of the markers whose places are unknown.
    pub markers: &'a [BodyPoint],
    /// The places of these markers, m, in the frames of their bodies.
    pub places: Vec<Vector3<f64>>,
}

/// A body that is read, in an equilibrium.
#[derive(Clone)]
struct ReadBody {
    pose: Pose,
    /// Its motions as each unknown grows, per its unit.
    motions: Vec<Vector6<f64>>,
}

impl Machine<'_> {
    /// Answers for all observations, in their order. The tool's frame is put to each point at which loads act on it, once for all
    /// observations that have it.
    pub fn each<A: Send>(
        &self,
        observations: &[Observation],
        answer: impl Fn(&Self, &Observation) -> A + Sync,
    ) -> Vec<A> {
        let mut by_point: BTreeMap<[u64; 3], Vec<usize>> = BTreeMap::new();
        for (i, observation) in observations.iter().enumerate() {
            let at: [f64; 3] = observation.load.tool_at().into();
            by_point.entry(at.map(f64::to_bits)).or_default().push(i);
        }
        let groups = by_point.par_iter().flat_map(|(at, members)| {
            let machine = self.with_tool_at(&at.map(f64::from_bits).into());
            let own = members.par_iter();
            own.map(|i| (*i, answer(&machine, &observations[*i])))
                .collect::<Vec<_>>()
        });
        let mut answers: Vec<(usize, A)> = groups.collect();
        answers.sort_by_key(|(i, _)| *i);
        answers.into_iter().map(|(_, answer)| answer).collect()
    }

    fn with_tool_at(&self, at: &Vector3<f64>) -> Self {
        let moved = |mechanism: &Mechanism| match *at == Vector3::zeros() {
            true => mechanism.clone(),
            false => mechanism.with_tool(&Pose::translation(at.x, at.y, at.z)),
        };
        Self {
            mechanism: moved(&self.mechanism),
            changes: self.changes.iter().map(|c| c.of_machine(moved)).collect(),
            markers: self.markers,
            places: self.places.clone(),
        }
    }

    fn small(&self, observation: &Observation) -> Result<Prediction, IdentificationError> {
        let posture = posture_of(&self.mechanism, observation)?.as_drawn();
        let mut push = Push::at_rest(&posture, observation)?;
        let load = &observation.load;
        let under_load = push.by_load(load)?;
        let count = observation.readings.len();
        let mut values = DVector::zeros(count);
        let mut derivatives = DMatrix::zeros(count, self.changes.len());
        for (i, reading) in observation.readings.iter().enumerate() {
            let (body, unit) = push.unit(reading);
            values[i] = body.twist(&under_load).dot(&unit.0);
            let virtual_motion = push.by(&body, &unit)?;
            for (column, change) in self.changes.iter().enumerate() {
                let Change::Springs(springs) = change else {
                    continue;
                };
                let work = springs.iter().map(|s| s.work(&virtual_motion, &under_load));
                derivatives[(i, column)] = -work.sum::<f64>();
            }
        }
        Ok(Prediction {
            values,
            derivatives,
        })
    }

    /// Friction holds a drive back by `b` against the change of its torque: `theta = c tau - b sign(d tau)`.
    fn add_friction(
        &self,
        observation: &Observation,
        values: &DVector<f64>,
        into: &mut Prediction,
    ) -> Result<(), IdentificationError> {
        let is_friction = |c: &Change| matches!(c, Change::Friction);
        let (Some(branch), Some(first)) = (
            observation.branch,
            self.changes.iter().position(is_friction),
        ) else {
            return Ok(());
        };
        let posture = posture_of(&self.mechanism, observation)?.as_drawn();
        let mut push = Push::at_rest(&posture, observation)?;
        let torque = |motion: &MachineMotion, (limb, coordinate): (usize, usize)| {
            let chain = &posture.mechanism().limbs()[limb].actual;
            let spring = chain.springs().iter().find(|s| s.first == coordinate);
            let stiffness =
                spring.map_or(0.0, |s| s.stiffness_at(&chain.home_coordinates())[(0, 0)]);
            stiffness * motion.coordinates[limb][coordinate]
        };
        let whole = push.by_load(&branch.whole)?;
        let grows = if branch.unloading { -1.0 } else { 1.0 };
        let drives = drive_coordinates(&self.mechanism);
        let torques = drives
            .iter()
            .map(|(_, at)| at.map_or(0.0, |at| torque(&whole, at)));
        let torques: Vec<f64> = torques.collect();
        let largest = torques.iter().map(|t| t.abs()).fold(0.0, larger);
        // A load that does not turn a drive moves no friction.
        let signs = torques.iter().map(|t| {
            if t.abs() > NO_TORQUE * largest {
                t.signum()
            } else {
                0.0
            }
        });
        let signs: Vec<f64> = signs.collect();
        for (i, reading) in observation.readings.iter().enumerate() {
            let (body, unit) = push.unit(reading);
            let virtual_motion = push.by(&body, &unit)?;
            for (sign, (k, (_, at))) in signs.iter().zip((first..).zip(&drives)) {
                let Some(at) = at else { continue };
                let derivative = -grows * sign * torque(&virtual_motion, *at);
                into.derivatives[(i, k)] = derivative;
                into.values[i] += derivative * values[k];
            }
        }
        Ok(())
    }

    /// Place of the marker of a reading in the frame of its body.
    fn place_of(&self, reading: &Reading) -> Vector3<f64> {
        let own = self.markers.iter().position(|m| *m == reading.marker);
        own.map_or(reading.marker.at, |marker| self.places[marker])
    }

    /// Readings by equilibria, with their derivatives.
    pub(crate) fn loaded(
        &self,
        observation: &Observation,
    ) -> Result<Prediction, IdentificationError> {
        let readings = &observation.readings;
        let mut bodies: Vec<Body> = Vec::new();
        let of_readings = readings.iter().map(|reading| {
            let on = reading.marker.on;
            bodies
                .iter()
                .position(|body| *body == on)
                .unwrap_or_else(|| {
                    bodies.push(on);
                    bodies.len() - 1
                })
        });
        // Index of the body of every reading.
        let body: Vec<usize> = of_readings.collect();
        let under = self.reached(observation, &bodies)?;
        // Only displacements and turns are differences.
        let rest = match readings.iter().all(Reading::is_place) {
            true => under.clone(),
            false => {
                let mut unloaded = observation.clone();
                unloaded.load.force.fill(0.0);
                unloaded.load.moment.fill(0.0);
                self.reached(&unloaded, &bodies)?
            }
        };
        let load = &observation.load;
        let arms = readings
            .iter()
            .map(|r| load.arm_to(r.marker.on, self.place_of(r)));
        let arms: Vec<Vector3<f64>> = arms.collect();
        let place = |at: &[ReadBody], i: usize| {
            let pose = &at[body[i]].pose;
            pose.rotation * arms[i] + pose.translation.vector
        };
        let turn = |i: usize| {
            let [under, rest] = [&under, &rest].map(|at| at[body[i]].pose.rotation);
            (under * rest.inverse()).scaled_axis()
        };
        let values = readings
            .iter()
            .enumerate()
            .map(|(i, reading)| match reading.of {
                ReadingOf::Along(n) => n.dot(&(place(&under, i) - place(&rest, i))),
                ReadingOf::About(n) => n.dot(&turn(i)),
                ReadingOf::Place(n) => n.dot(&place(&under, i)),
            });
        let values = DVector::from_iterator(readings.len(), values);
        let moved = |at: &[ReadBody], i: usize, column: usize| {
            let own = &at[body[i]];
            let rotation = own.pose.rotation;
            match self.changes[column] {
                Change::Marker(marker, k) if self.markers[marker] == readings[i].marker => {
                    rotation * Vector3::ith(k, 1.0)
                }
                _ => twist_at(&own.motions[column], &(rotation * arms[i])),
            }
        };
        let derivatives = DMatrix::from_fn(readings.len(), self.changes.len(), |i, column| {
            let turned = |at: &[ReadBody]| angular(&at[body[i]].motions[column]);
            match readings[i].of {
                ReadingOf::Along(n) => n.dot(&(moved(&under, i, column) - moved(&rest, i, column))),
                ReadingOf::About(n) => {
                    let rate = turned(&under) - Rotation3::new(turn(i)) * turned(&rest);
                    n.dot(&(rate_of_rotation_vector(&turn(i)) * rate))
                }
                ReadingOf::Place(n) => n.dot(&moved(&under, i, column)),
            }
        });
        Ok(Prediction {
            values,
            derivatives,
        })
    }

    /// Bodies in the equilibrium under the load of an observation.
    fn reached(
        &self,
        observation: &Observation,
        bodies: &[Body],
    ) -> Result<Vec<ReadBody>, IdentificationError> {
        let machine = |reason| observation.refused(reason);
        let posture = posture_of(&self.mechanism, observation)?;
        let at = posture
            .deflected_by(&observation.load.on_tool())
            .map_err(machine)?;
        let place = |body: &Body| PlacedBody::of(*body, &posture, &at.state);
        let placed: Vec<PlacedBody> = bodies.iter().map(place).collect();
        let still = |body: &PlacedBody| ReadBody {
            pose: body.pose,
            motions: vec![Vector6::zeros(); self.changes.len()],
        };
        let mut read: Vec<ReadBody> = placed.iter().map(still).collect();
        let mut tangent = posture.linearised(&at).map_err(machine)?;
        let zero = no_residual(&posture, &at.state).map_err(machine)?;
        for (column, change) in self.changes.iter().enumerate() {
            let residual = match change {
                Change::Springs(springs) => {
                    let mut residual = zero.clone();
                    springs
                        .iter()
                        .for_each(|s| s.add_residual(&posture, &at, &mut residual));
                    residual
                }
                Change::Marker(..) | Change::Friction => continue,
                Change::Machine { more, less, step } => {
                    let more = posture_of(more, observation)?;
                    let less = posture_of(less, observation)?;
                    for (own, body) in read.iter_mut().zip(bodies) {
                        let of = |p: &Posture| PlacedBody::of(*body, p, &at.state).pose;
                        own.motions[column] = pose_residual(&of(&more), &of(&less)).0 / *step;
                    }
                    let of = |p: &Posture| p.residual_at(&at.state, &at.wrench).map_err(machine);
                    let difference = [(1.0 / step, &of(&more)?), (-1.0 / step, &of(&less)?)];
                    MachineResidual::combined(&difference).unwrap_or_else(|| zero.clone())
                }
            };
            let motion = tangent.removing(&residual);
            let motion = motion.ok_or_else(|| observation.free())?;
            for (own, body) in read.iter_mut().zip(&placed) {
                own.motions[column] += body.twist(&motion);
            }
        }
        Ok(read)
    }
}

/// The posture under the load, if it acts on a node.
fn posture_of(
    mechanism: &Mechanism,
    observation: &Observation,
) -> Result<Posture, IdentificationError> {
    let machine = |reason| observation.refused(reason);
    let loaded = observation
        .load
        .on_nodes(mechanism.clone())
        .map_err(machine)?;
    loaded
        .posture(PostureRequest::commands(&observation.commands))
        .map_err(machine)
}

impl SpringChange {
    /// `x_v^T (dK) x_F`.
    fn work(&self, virtual_motion: &MachineMotion, motion: &MachineMotion) -> f64 {
        let own = self.first..self.first + self.matrix.nrows();
        let (v, u) = (
            &virtual_motion.coordinates[self.limb][own.clone()],
            &motion.coordinates[self.limb][own],
        );
        let mut sum = 0.0;
        for (i, v) in v.iter().enumerate() {
            for (j, u) in u.iter().enumerate() {
                sum += v * self.matrix[(i, j)] * u;
            }
        }
        sum
    }

    /// Adds the derivative of the residual at a fixed state: the spring's torque grows by `dK (x - rest)`.
    fn add_residual(
        &self,
        posture: &Posture,
        at: &MechanismEquilibrium,
        into: &mut MachineResidual,
    ) {
        let chain = &posture.mechanism().limbs()[self.limb].actual;
        let Some(spring) = chain.springs().iter().find(|s| s.first == self.first) else {
            return;
        };
        let x = &at.state.coordinates[self.limb];
        let torques = &mut into.torques[self.limb];
        for i in 0..self.matrix.nrows() {
            for (j, rest) in spring.rest.iter().enumerate() {
                torques[self.first + i] -= self.matrix[(i, j)] * (x[self.first + j] - rest);
            }
        }
    }
}

/// Velocity at the end of an arm.
fn twist_at(twist: &Vector6<f64>, arm: &Vector3<f64>) -> Vector3<f64> {
    twist.fixed_rows::<3>(0) + angular(twist).cross(arm)
}

fn angular(twist: &Vector6<f64>) -> Vector3<f64> {
    twist.fixed_rows::<3>(3).into_owned()
}

/// Rate of a rotation vector per angular velocity: `I - hat/2 + (1/t^2 - (1 + cos t)/(2 t sin t)) hat^2`.
fn rate_of_rotation_vector(turn: &Vector3<f64>) -> Matrix3<f64> {
    let (angle, cross) = (turn.norm(), hat(turn));
    let square = match angle < 1e-3 {
        true => 1.0 / 12.0,
        false => angle.powi(-2) - (1.0 + angle.cos()) / (2.0 * angle * angle.sin()),
    };
    Matrix3::identity() - cross * 0.5 + cross * cross * square
}
