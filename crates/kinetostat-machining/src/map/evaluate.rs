//! Variables of many postures, block by block: the one engine of maps on the command line and in Python.

use std::sync::Arc;

use kinetostat::batch::{Batch, BatchEquilibrium, BatchStiffness, Details};
use kinetostat::spatial::pose_residual;
use kinetostat::{Mechanism, Pose, Posture, Wrench};

use crate::map::nearness::{Nearness, NearnessRoom};
use crate::map::place::PlaceState;
use crate::map::solved::{LOWEST, Solved, Wanted, lowest};
use crate::map::variable::{Needs, Variable};
use crate::postures::configurations::Configurations;

/// Largest difference of the tool's place, as a share of the machine's length and in rad, for two equilibria to be one: both are
/// known far better.
const SAME: f64 = 1e-7;

/// A machine, and which of its variables are asked for.
#[derive(Clone, Debug)]
pub struct Evaluator {
    mechanism: Mechanism,
    batch: Arc<Batch>,
    ratings: Vec<Option<f64>>,
    variables: Vec<Variable>,
    details: Details,
    /// Number of requested natural frequencies: they are about the state of a posture, which the kernels do not return.
    modes: usize,
    /// True if the tool's place without its load is requested.
    unloaded: bool,
    nearness: Option<Nearness>,
    configurations: Configurations,
}

/// Result of a posture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// State of the place.
    pub state: PlaceState,
    /// True if there are numbers, even outside the limits of an actuator.
    pub found: bool,
}

/// Buffers kept from block to block, one for each thread.
#[derive(Debug, Default)]
pub struct EvaluationRoom {
    stiffness: BatchStiffness,
    equilibrium: BatchEquilibrium,
    unloaded: BatchEquilibrium,
    place: Option<Solved>,
    nearness: NearnessRoom,
}

impl Evaluator {
    /// Evaluation of a machine compiled for many postures; `ratings` are those of its actuators as far as they are stated
    /// (N or N m).
    #[must_use]
    pub fn new(
        mechanism: &Mechanism,
        batch: Arc<Batch>,
        ratings: Vec<Option<f64>>,
        variables: &[Variable],
    ) -> Self {
        let asks = |needs: Needs| variables.iter().any(|v| v.needs() == needs);
        Self {
            mechanism: mechanism.clone(),
            batch,
            ratings,
            variables: variables.to_vec(),
            // The kernels tell with the stability whether the stiffness has a free direction.
            details: match asks(Needs::Stiffness) || asks(Needs::Stability) {
                true => Details::Stability,
                false => Details::Rest,
            },
            modes: (variables.iter().map(|v| v.frequencies()).max()).unwrap_or_default(),
            unloaded: asks(Needs::Unloaded),
            nearness: variables
                .contains(&Variable::SingularityDistance)
                .then(|| Nearness::of(mechanism)),
            configurations: Configurations::of(mechanism),
        }
    }

    /// Evaluation for a map, whose usual figures are the stiffness and, under a load, its stability.
    pub(crate) fn of_map(
        mechanism: &Mechanism,
        batch: Arc<Batch>,
        ratings: Vec<Option<f64>>,
        variables: &[Variable],
    ) -> Self {
        let mut own = Self::new(mechanism, batch, ratings, variables);
        own.details = Details::Stability;
        own
    }

    /// Columns of each variable.
    #[must_use]
    pub fn widths(&self) -> Vec<usize> {
        let actuators = self.mechanism.actuator_count();
        self.variables.iter().map(|v| v.width(actuators)).collect()
    }

    /// Variables of some postures into rows of `columns`, one of each variable, each with its own width. Under loads (one for
    /// each posture, base axes, about the tool's reference point) the machine is as it is, with its weight, preloads and
    /// deviations; without them unloaded and as drawn, and what needs a load is NaN.
    pub fn evaluate(
        &self,
        poses: &[Pose],
        loads: Option<&[Wrench]>,
        room: &mut EvaluationRoom,
        columns: &mut [&mut [f64]],
        outcomes: &mut [Outcome],
    ) {
        let widths = self.widths();
        self.solve(poses, loads, room, |i, place| {
            outcomes[i] = place.outcome();
            let each = self.variables.iter().zip(&widths).zip(&mut *columns);
            for ((variable, width), column) in each {
                let out = &mut column[i * width..(i + 1) * width];
                match place.found {
                    true => variable.write(place, out),
                    false => out.fill(f64::NAN),
                }
            }
        });
    }

    /// Solves some postures, and calls `each` with every one in turn.
    pub(crate) fn solve(
        &self,
        poses: &[Pose],
        loads: Option<&[Wrench]>,
        room: &mut EvaluationRoom,
        mut each: impl FnMut(usize, &Solved),
    ) {
        let EvaluationRoom {
            stiffness,
            equilibrium,
            unloaded,
            place,
            nearness,
        } = room;
        let place = place.get_or_insert_with(|| Solved::new(&self.mechanism));
        let solved = match loads {
            None => {
                self.batch.stiffness_into(poses, stiffness);
                true
            }
            Some(loads) => {
                let found = self
                    .batch
                    .equilibrium_into(poses, loads, self.details, equilibrium);
                found.is_ok()
            }
        };
        let also_unloaded = self.unloaded && loads.is_some();
        let rest_is_known = also_unloaded && {
            let none = vec![Wrench::zero(); poses.len()];
            let found = self
                .batch
                .equilibrium_into(poses, &none, Details::Rest, unloaded);
            found.is_ok()
        };
        for (i, pose) in poses.iter().enumerate() {
            place.forget();
            let machine = &self.mechanism;
            let status = match loads {
                None => stiffness.status[i],
                Some(_) if solved => equilibrium.status[i],
                Some(_) => kinetostat::batch::Status::Unsolved,
            };
            let mut taken = match (status.is_solved(), loads) {
                (false, _) => false,
                (true, None) => place.take_stiffness(machine, stiffness, i),
                (true, Some(_)) => {
                    place.take_equilibrium(machine, &self.ratings, equilibrium, i, pose)
                }
            };
            if taken && also_unloaded {
                taken = rest_is_known && unloaded.status[i].is_solved();
                if taken {
                    place.unloaded = pose_residual(&unloaded.tool_pose(i), pose);
                }
            }
            if let (true, true, Some(loads)) = (taken, self.modes > 0, loads) {
                let found = self.frequencies(pose, &loads[i], &equilibrium.tool_pose(i));
                taken = found.is_some();
                place.frequencies = found.unwrap_or(place.frequencies);
            }
            if !taken {
                place.forget();
                let load = loads.map(|loads| &loads[i]);
                self.by_itself(place, machine.posture(pose), load);
            }
            if let (Some(own), true, true) = (&self.nearness, place.found, taken) {
                let found = own.at(&self.batch, pose, &place.commands, nearness);
                let by_posture = || machine.posture(pose).ok().map(|p| own.of_posture(&p));
                place.singularity_distance = found.or_else(by_posture).unwrap_or(f64::NAN);
            }
            let left = matches!(
                place.state,
                PlaceState::OutsideLimits | PlaceState::Unreachable
            );
            if let Some(other) = (left.then(|| self.configurations.within_limits(pose))).flatten() {
                place.forget();
                self.by_itself(place, Ok(other), loads.map(|loads| &loads[i]));
            }
            each(i, place);
        }
    }

    /// Natural frequencies about the equilibrium that the kernels found, in which the tool stands `there`; `None` where the
    /// general engine finds another one.
    fn frequencies(&self, pose: &Pose, load: &Wrench, there: &Pose) -> Option<[f64; LOWEST]> {
        let posture = self.mechanism.posture(pose).ok()?;
        let state = posture.rest_under(load, posture.rest_state()).ok()?;
        let tool = &state.platforms[self.mechanism.tool()];
        let apart = (tool.translation.vector - there.translation.vector).norm();
        let near = apart <= SAME * self.mechanism.natural_length()
            && tool.rotation.angle_to(&there.rotation) <= SAME;
        near.then(|| lowest(&posture, &state, load, self.modes))
    }

    /// A posture by itself, perhaps none.
    pub(crate) fn by_itself(
        &self,
        place: &mut Solved,
        posture: kinetostat::Result<Posture>,
        load: Option<&Wrench>,
    ) -> Option<Posture> {
        let wanted = Wanted {
            ratings: &self.ratings,
            modes: self.modes,
            unloaded: self.unloaded,
        };
        let posture = place.take_posture(posture, load, &wanted);
        if let (Some(own), Some(posture), true) = (&self.nearness, &posture, place.found) {
            // The rates of the drives do not show free motions.
            place.singularity_distance = match place.free.is_empty() {
                true => own.of_posture(posture),
                false => 0.0,
            };
        }
        posture
    }

    /// Values of all variables at a place, one after the other.
    pub(crate) fn values(&self, place: &Solved) -> Box<[f64]> {
        let widths = self.widths();
        let mut all = vec![f64::NAN; widths.iter().sum()].into_boxed_slice();
        let mut rest = &mut all[..];
        for (variable, width) in self.variables.iter().zip(widths) {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(width);
            if place.state.has_figures() {
                variable.write(place, own);
            }
            rest = after;
        }
        all
    }
}

impl Solved {
    pub(crate) fn outcome(&self) -> Outcome {
        Outcome {
            state: self.state,
            found: self.found,
        }
    }
}
