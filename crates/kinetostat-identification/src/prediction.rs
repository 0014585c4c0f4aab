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

use kinetostat::machine::{MachineMotion, MachineResidual};
use kinetostat::number::larger;
use kinetostat::spatial::hat;
use kinetostat::{Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest, Wrench};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3, Vector6};
use rayon::prelude::*;

use crate::change::Change;
use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, ReadingOf};
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
        mechanism: &mechanism,
        changes: &changes,
        markers: &unknowns.markers,
        places: unknowns.marker_places(values),
    };
    let of_place = |o: &&Observation| o.readings.iter().any(Reading::is_place);
    if let (Theory::SmallLoads, Some(own)) = (theory, observations.iter().find(of_place)) {
        let posture = own.posture.clone();
        return Err(IdentificationError::PlacesNeedLoads { posture });
    }
    let each = observations.par_iter().map(|observation| {
        let mut found = match theory {
            Theory::SmallLoads => machine.small(observation),
            Theory::Loaded => machine.loaded(observation),
        }?;
        machine.add_friction(observation, values, &mut found)?;
        Ok(found)
    });
    Ok(each.collect())
}

/// Share of the largest torque below which a drive is not loaded.
const NO_TORQUE: f64 = 1e-4;

/// A machine that answers, and how it changes with the unknowns.
pub(crate) struct Machine<'a> {
    pub mechanism: &'a Mechanism,
    pub changes: &'a [Change],
    /// Nominal places of the markers whose places are unknown.
    pub markers: &'a [Vector3<f64>],
    /// The places of these markers, m, in the tool's frame.
    pub places: Vec<Vector3<f64>>,
}

/// A machine in an equilibrium.
#[derive(Clone)]
struct Reached {
    tool: Pose,
    /// Motions of the tool as each unknown grows, per its unit.
    motions: Vec<Vector6<f64>>,
}

impl Machine<'_> {
    fn small(&self, observation: &Observation) -> Result<Prediction, IdentificationError> {
        let posture = posture_of(self.mechanism, observation)?.as_drawn();
        let free = || IdentificationError::Free {
            posture: observation.posture.clone(),
        };
        let mut tangent = posture.linearised_at_rest();
        let tool = posture.mechanism().tool();
        let load = Wrench::new(observation.load.force, observation.load.moment);
        let under_load = tangent.under(&load).ok_or_else(free)?;
        let count = observation.readings.len();
        let mut values = DVector::zeros(count);
        let mut derivatives = DMatrix::zeros(count, self.changes.len());
        for (i, reading) in observation.readings.iter().enumerate() {
            let arm = posture.target().rotation * (reading.marker - observation.load.at);
            let unit = wrench_of(reading, &arm);
            values[i] = under_load.platforms[tool].0.dot(&unit.0);
            let virtual_motion = tangent.under(&unit).ok_or_else(free)?;
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
        let free = || IdentificationError::Free {
            posture: observation.posture.clone(),
        };
        let posture = posture_of(self.mechanism, observation)?.as_drawn();
        let mut tangent = posture.linearised_at_rest();
        let torque = |motion: &MachineMotion, (limb, coordinate): (usize, usize)| {
            let chain = &posture.mechanism().limbs()[limb].actual;
            let spring = chain.springs().iter().find(|s| s.first == coordinate);
            let stiffness =
                spring.map_or(0.0, |s| s.stiffness_at(&chain.home_coordinates())[(0, 0)]);
            stiffness * motion.coordinates[limb][coordinate]
        };
        let whole = tangent
            .under(&Wrench::new(branch.whole.force, branch.whole.moment))
            .ok_or_else(free)?;
        let grows = if branch.unloading { -1.0 } else { 1.0 };
        let drives = drive_coordinates(self.mechanism);
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
            let arm = posture.target().rotation * (reading.marker - observation.load.at);
            let virtual_motion = tangent.under(&wrench_of(reading, &arm)).ok_or_else(free)?;
            for (sign, (k, (_, at))) in signs.iter().zip((first..).zip(&drives)) {
                let Some(at) = at else { continue };
                let derivative = -grows * sign * torque(&virtual_motion, *at);
                into.derivatives[(i, k)] = derivative;
                into.values[i] += derivative * values[k];
            }
        }
        Ok(())
    }

    /// Place of the marker of a reading in the tool's frame.
    fn place_of(&self, reading: &Reading) -> Vector3<f64> {
        let own = self.markers.iter().position(|m| *m == reading.marker);
        own.map_or(reading.marker, |marker| self.places[marker])
    }

    /// Readings by equilibria, with their derivatives.
    pub(crate) fn loaded(
        &self,
        observation: &Observation,
    ) -> Result<Prediction, IdentificationError> {
        let posture = posture_of(self.mechanism, observation)?;
        let reached = |wrench: &Wrench| {
            let found = posture.deflected_by(wrench);
            let found = found.map_err(|reason| refused(observation, reason))?;
            Ok::<_, IdentificationError>(Reached {
                motions: self.motions(observation, &posture, &found)?,
                tool: found.tool,
            })
        };
        let readings = &observation.readings;
        let under = reached(&Wrench::new(
            observation.load.force,
            observation.load.moment,
        ))?;
        // Only displacements and turns are differences.
        let rest = match readings.iter().all(Reading::is_place) {
            true => under.clone(),
            false => reached(&Wrench::zero())?,
        };
        let arm = |at: &Reached, reading: &Reading| {
            at.tool.rotation * (self.place_of(reading) - observation.load.at)
        };
        let turn = (under.tool.rotation * rest.tool.rotation.inverse()).scaled_axis();
        let moved = under.tool.translation.vector - rest.tool.translation.vector;
        let values = readings.iter().map(|reading| match reading.of {
            ReadingOf::Along(n) => n.dot(&(moved + arm(&under, reading) - arm(&rest, reading))),
            ReadingOf::About(n) => n.dot(&turn),
            ReadingOf::Place(n) => n.dot(&(under.tool.translation.vector + arm(&under, reading))),
        });
        let values = DVector::from_iterator(readings.len(), values);
        let marker_motion =
            |at: &Reached, reading: &Reading, column: usize| match self.changes[column] {
                Change::Marker(marker, k) if self.markers[marker] == reading.marker => {
                    at.tool.rotation * Vector3::ith(k, 1.0)
                }
                _ => twist_at(&at.motions[column], &arm(at, reading)),
            };
        let along_turn = rate_of_rotation_vector(&turn);
        let turned = Rotation3::new(turn);
        let derivatives = DMatrix::from_fn(readings.len(), self.changes.len(), |i, column| {
            let moved = |at: &Reached| marker_motion(at, &readings[i], column);
            match readings[i].of {
                ReadingOf::Along(n) => n.dot(&(moved(&under) - moved(&rest))),
                ReadingOf::About(n) => n.dot(
                    &(along_turn
                        * (angular(&under.motions[column])
                            - turned * angular(&rest.motions[column]))),
                ),
                ReadingOf::Place(n) => n.dot(&moved(&under)),
            }
        });
        Ok(Prediction {
            values,
            derivatives,
        })
    }

    /// Motions of the tool as each unknown grows, per its unit.
    fn motions(
        &self,
        observation: &Observation,
        posture: &Posture,
        at: &MechanismEquilibrium,
    ) -> Result<Vec<Vector6<f64>>, IdentificationError> {
        let machine = |reason| refused(observation, reason);
        let mut tangent = posture.linearised(at).map_err(machine)?;
        let tool = posture.mechanism().tool();
        let mut zero = posture
            .residual_at(&at.state, &at.wrench)
            .map_err(machine)?;
        zero.closures.iter_mut().for_each(|c| c.fill(0.0));
        zero.torques.iter_mut().for_each(|t| t.fill(0.0));
        zero.platforms.iter_mut().for_each(|w| w.0.fill(0.0));
        let each = self.changes.iter().map(|change| {
            let residual = match change {
                Change::Springs(springs) => {
                    let mut residual = zero.clone();
                    springs
                        .iter()
                        .for_each(|s| s.add_residual(posture, at, &mut residual));
                    residual
                }
                Change::Marker(..) | Change::Friction => return Ok(Vector6::zeros()),
                Change::Machine { more, less, step } => {
                    let of = |m: &Mechanism| {
                        let posture = posture_of(m, observation)?;
                        posture.residual_at(&at.state, &at.wrench).map_err(machine)
                    };
                    let (more, less) = (of(more)?, of(less)?);
                    let difference = [(1.0 / step, &more), (-1.0 / step, &less)];
                    MachineResidual::combined(&difference).unwrap_or_else(|| zero.clone())
                }
            };
            let motion = tangent.removing(&residual);
            let motion = motion.ok_or_else(|| IdentificationError::Free {
                posture: observation.posture.clone(),
            })?;
            Ok(motion.platforms[tool].0)
        });
        each.collect()
    }
}

/// The posture with the tool's origin at the point of the load.
fn posture_of(
    mechanism: &Mechanism,
    observation: &Observation,
) -> Result<Posture, IdentificationError> {
    let at = observation.load.at;
    let moved = match at == Vector3::zeros() {
        true => mechanism.clone(),
        false => mechanism.with_tool(&Pose::translation(at.x, at.y, at.z)),
    };
    let request = PostureRequest::commands(&observation.commands);
    moved
        .posture(request)
        .map_err(|reason| refused(observation, reason))
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

/// Unit wrench on the tool whose work is the reading; `arm` from the tool's origin to the marker, base axes.
fn wrench_of(reading: &Reading, arm: &Vector3<f64>) -> Wrench {
    match reading.of {
        ReadingOf::Along(n) | ReadingOf::Place(n) => Wrench::new(n, arm.cross(&n)),
        ReadingOf::About(n) => Wrench::new(Vector3::zeros(), n),
    }
}

fn refused(observation: &Observation, reason: kinetostat::Error) -> IdentificationError {
    IdentificationError::Posture {
        posture: observation.posture.clone(),
        reason,
    }
}
