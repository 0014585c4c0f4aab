//! Distance of a posture from a singular one: the condition of the Jacobian between the actuators and the motions that they
//! drive.
//!
//! Rates of the commands by motions of the tool are differences of the inverse kinematics, which the kernels solve for many
//! poses at once. For a machine that turns its tool as it moves, the driven motions differ from place to place, and a pose
//! next to a reached one may be out of reach: there the posture itself gives them. Rotations of tool and of actuators are
//! multiplied with the natural length, so that all are lengths.

use kinetostat::batch::{Batch, BatchStiffness};
use kinetostat::spatial::moved;
use kinetostat::{Mechanism, MotionKind, Pose, Posture, Twist};
use nalgebra::{DMatrix, DVector, Vector6};

/// Motions for differences, as a share of the natural length.
const STEP: f64 = 1e-4;
/// Offset from a singular home at which motions are counted, share of the natural length.
const BESIDE: f64 = 0.05;
/// Joints that go farther (share of the natural length) in a step have changed their branch.
const JUMP: f64 = 0.1;

/// The motions that a machine drives, and units of its actuators.
#[derive(Clone, Debug)]
pub(crate) struct Nearness {
    /// Motions of the tool for a step, base axes.
    steps: Vec<Twist>,
    /// Factors that make a command a length.
    units: Vec<f64>,
    step: f64,
    /// True if the driven motions are known at home only.
    turns: bool,
}

/// Poses beside one, and what is found there.
#[derive(Debug, Default)]
pub(crate) struct NearnessRoom {
    poses: Vec<Pose>,
    found: BatchStiffness,
}

impl Nearness {
    /// Motions that the actuators drive at home, or next to it if home is singular.
    pub fn of(mechanism: &Mechanism) -> Self {
        let length = mechanism.natural_length();
        let step = STEP * length;
        let basis = driven_motions(mechanism);
        let unit = |k: usize| if k < 3 { 1.0 } else { length };
        let columns = basis.column_iter();
        let steps = columns
            .map(|c| Twist(Vector6::from_fn(|k, _| step * c[k] / unit(k))))
            .collect();
        let actuators = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
        let units = actuators.map(|a| match a.kind {
            MotionKind::Prismatic => 1.0,
            MotionKind::Revolute => length,
        });
        Self {
            steps,
            units: units.collect(),
            step,
            turns: mechanism.turns_as_it_moves(),
        }
    }

    /// Singularity distance at a posture: the smallest singular value of the rates as a share of the largest, 0 if fewer
    /// motions than at home are driven.
    pub fn of_posture(&self, posture: &Posture) -> f64 {
        let rates = posture.command_rates();
        match rates.ncols() < self.steps.len() {
            true => 0.0,
            false => share(&rates),
        }
    }

    /// Singularity distance by differences; `None` if the machine cannot go to either side.
    pub fn at(
        &self,
        batch: &Batch,
        pose: &Pose,
        commands: &[f64],
        room: &mut NearnessRoom,
    ) -> Option<f64> {
        if self.turns || self.steps.is_empty() {
            return None;
        }
        room.poses.clear();
        for step in &self.steps {
            room.poses.push(moved(pose, step));
            room.poses.push(moved(pose, &Twist(-step.0)));
        }
        batch.stiffness_into(&room.poses, &mut room.found);
        let here = DVector::from_fn(self.units.len(), |k, _| commands[k] * self.units[k]);
        let there = |i: usize| -> Option<DVector<f64>> {
            let row = DVector::from_iterator(self.units.len(), room.found.commands.row(i));
            let row = row.component_mul(&DVector::from_column_slice(&self.units));
            let gone = (&row - &here).amax();
            (gone <= JUMP * self.step / STEP).then_some(row)
        };
        let mut rates = DMatrix::zeros(self.units.len(), self.steps.len());
        for k in 0..self.steps.len() {
            let difference = match (there(2 * k), there(2 * k + 1)) {
                (Some(a), Some(b)) => (a - b) / (2.0 * self.step),
                (Some(a), None) => (a - &here) / self.step,
                (None, Some(b)) => (&here - b) / self.step,
                (None, None) => return None,
            };
            rates.set_column(k, &difference);
        }
        Some(share(&rates))
    }
}

/// Motions of the tool that the actuators drive (columns, rotations at the natural length): at home, or beside it, where the machine
/// goes without resistance, if more are driven there.
fn driven_motions(mechanism: &Mechanism) -> DMatrix<f64> {
    let home = &mechanism.platforms()[mechanism.tool()].home;
    let Ok(posture) = mechanism.posture(home) else {
        return DMatrix::zeros(6, 0);
    };
    let at_home = posture.commanded_motions();
    let Ok(stiffness) = posture.stiffness() else {
        return at_home;
    };
    let free = stiffness.compliance().free;
    let size = |t: &Twist| t.linear().norm() + mechanism.natural_length() * t.angular().norm();
    // Irregular shares, the same every time: what is singular for a reason is regular beside it.
    let way = free
        .iter()
        .enumerate()
        .fold(Vector6::zeros(), |way, (k, t)| {
            let share = 1.0 + 0.5 * ((k + 1) as f64 * 0.618_034).fract();
            way + t.0
                * (BESIDE * mechanism.natural_length() * share / size(t).max(f64::MIN_POSITIVE))
        });
    let beside = match free.is_empty() {
        true => None,
        false => mechanism.posture(&moved(home, &Twist(way))).ok(),
    };
    let elsewhere = beside.map(|p| p.commanded_motions());
    match elsewhere {
        Some(more) if more.ncols() > at_home.ncols() => more,
        _ => at_home,
    }
}

/// The smallest singular value as a share of the largest; 0 of what moves nothing.
fn share(rates: &DMatrix<f64>) -> f64 {
    if rates.is_empty() {
        return 0.0;
    }
    let values = kinetostat::linalg::SingularValues::of(rates).values;
    match (values.first(), values.last()) {
        (Some(largest), Some(smallest)) if *largest > 0.0 => smallest / largest,
        _ => 0.0,
    }
}
