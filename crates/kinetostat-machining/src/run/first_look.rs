//! The first look at a program: a few places, solved before anything is divided, show a wrong unit in
//! milliseconds where the whole program would take minutes.

use kinetostat::Error;
use kinetostat::number::smaller;

use crate::checks::own_weight::weight_is_stated;
use crate::checks::refused::{of_points, of_task};
use crate::limits::{Beyond, Limits};
use crate::load::along_path::LoadAlongPath;
use crate::measured_frame::MeasuredFrame;
use crate::result::point::PointResult;
use crate::run::points::{Machines, Solving, chunk};
use crate::run::sites::of_path::places_on_moves;
use crate::run::sites::site::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Places of a program at which figures are compared with their limits before anything is divided.
const FIRST_LOOKS: usize = 8;

/// A correction beyond its limit by this is refused by the first look: what a wrong unit does takes minutes to be
/// solved everywhere.
const GROSS: f64 = 10.0;

/// Some places on the moves of a program, spread evenly over them: ends of moves, or more of each where there are few.
/// `moves` is the number of all moves, `before` that of those before the first that is this path's own.
fn sites(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    moves: usize,
    before: usize,
) -> impl Iterator<Item = Site> {
    let on_each = FIRST_LOOKS.div_ceil(moves.max(1));
    let every = (moves * on_each).div_ceil(FIRST_LOOKS).max(1);
    let own = task.path().own_moves();
    let own_first = own.start;
    let chosen = own.flat_map(move |index| {
        let first = (before + index - own_first) * on_each;
        let numbers = (0..on_each).filter(move |k| (first + k).is_multiple_of(every));
        numbers.map(move |k| (index, (k + 1) as f64 / on_each as f64))
    });
    let chosen: Vec<(usize, f64)> = chosen.collect();
    places_on_moves(task, load, &chosen).into_iter()
}

/// A few places of a program, each solved by itself.
#[derive(Default)]
pub(crate) struct FirstLook {
    /// Points that have an answer.
    points: Vec<PointResult>,
    /// Error of the first place. Errors of later ones are reported where the program is solved, for there may be others before
    /// them.
    first: Option<RunError>,
    /// True if one of them has no equilibrium under its load.
    not_converged: bool,
}

impl FirstLook {
    /// A few places of the program as it is.
    ///
    /// # Errors
    /// [`RunError::WeightNotStated`], [`RunError::TouchOff`], [`RunError::Cancelled`].
    pub fn new(
        task: &Task<'_>,
        load: &LoadAlongPath<'_>,
        watch: &dyn Watch,
    ) -> Result<Self, RunError> {
        Self::at(task, load, task.path().own_moves().len(), 0, watch)
    }

    /// Points on a part of a program, of the few places of the whole one of so many moves.
    ///
    /// # Errors
    /// [`RunError::WeightNotStated`], [`RunError::TouchOff`], [`RunError::Cancelled`].
    pub fn of_whole(
        task: &Task<'_>,
        load: &LoadAlongPath<'_>,
        moves: usize,
        watch: &dyn Watch,
    ) -> Result<Self, RunError> {
        let path = task.path();
        let before = path.part.as_ref().map_or(0, |part| part.moves_before);
        let before = before + path.own_moves().start;
        Self::at(task, load, moves, before, watch)
    }

    fn at(
        task: &Task<'_>,
        load: &LoadAlongPath<'_>,
        moves: usize,
        before: usize,
        watch: &dyn Watch,
    ) -> Result<Self, RunError> {
        let machines = Machines::new(task);
        let frame = MeasuredFrame::of(task, None)?;
        let mut look = Self::default();
        for (index, site) in sites(task, load, moves, before).enumerate() {
            if watch.cancelled() {
                return Err(RunError::Cancelled);
            }
            let (machine, orientation) = machines.at(&site);
            let one = std::slice::from_ref(&site);
            let memory = &mut Default::default();
            let how = Solving {
                orientation,
                written: false,
                course: None,
                frame: &frame,
            };
            for found in chunk(task, machine, memory, one, how) {
                match found {
                    Ok(point) => look.points.push(point),
                    Err(error) => {
                        let cause = match &error {
                            RunError::Point { cause, .. } => Some(&**cause),
                            _ => None,
                        };
                        look.not_converged |= matches!(cause, Some(Error::NotConverged { .. }));
                        if index == 0 {
                            look.first = Some(error);
                        }
                    }
                }
            }
        }
        weight_is_stated(task, &look.points)?;
        Ok(look)
    }

    /// Returns the points if the first of the places has an answer.
    ///
    /// # Errors
    /// Why it has none.
    pub fn beginning_solved(mut self) -> Result<Self, RunError> {
        match self.first.take() {
            Some(error) => Err(error),
            None => Ok(self),
        }
    }

    /// A load beyond its limits under which a place has no equilibrium, or that puts the tool off by far more than any correction:
    /// a machine that folds over takes minutes to be solved everywhere. An analysis only warns of other loads, and of limits that
    /// are stricter than usual, which are those of a correction.
    pub fn folding_load(&self, task: &Task<'_>) -> Vec<Beyond> {
        let usual = Limits::default();
        let mut beyond = of_task(task);
        beyond.retain(|b| {
            ["force_n", "moment_n_m"].contains(&b.limit.name) && b.found > usual.get(b.limit)
        });
        let is_gross =
            |b: &Beyond| b.limit.name == "correction_mm" && b.found > GROSS * usual.get(b.limit);
        let folds = || self.gross(task).iter().any(is_gross);
        match self.not_converged || folds() {
            true => beyond,
            false => Vec::new(),
        }
    }

    /// Figures of these places beyond their limits.
    pub fn beyond(&self, task: &Task<'_>) -> Vec<Beyond> {
        of_points(task, &self.points)
    }

    /// Corrections that are beyond their limits by far.
    pub fn gross(&self, task: &Task<'_>) -> Vec<Beyond> {
        let mut beyond = self.beyond(task);
        beyond.retain(|b| {
            let of_correction = ["correction_mm", "own_weight_mm"].contains(&b.limit.name);
            of_correction && b.found > GROSS * b.allowed
        });
        beyond
    }

    /// Smallest stiffness against a force, N/mm; infinite where no place was solved.
    pub fn stiffness(&self) -> f64 {
        let stiffnesses = self.points.iter().map(|p| p.smallest_stiffness_n_per_mm);
        stiffnesses.fold(f64::INFINITY, smaller)
    }
}
