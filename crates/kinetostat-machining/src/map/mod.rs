//! Stiffness on a grid of tool positions, and under a load deflection and stability too: many places
//! at once, in constant memory.

mod evaluate;
mod nearness;
mod place;
mod solved;
mod variable;

use std::sync::Arc;
use std::time::{Duration, Instant};

use MAP_BLOCK as BLOCK;
use kinetostat::batch::Batch;
use kinetostat::chain::FoundBy;
use kinetostat::number::{larger, smaller};
use kinetostat::{Mechanism, Pose, Posture, Wrench};
use nalgebra::{UnitQuaternion, Vector3};
use rayon::prelude::*;

use crate::map::solved::Solved;
use crate::postures::neighbour::{NEAR, Orientation};
use crate::result::summary::one_by_one_because;
use crate::task::RunError;
use crate::watch::Watch;

pub use evaluate::{EvaluationRoom, Evaluator, Outcome};
pub use place::{MapPlace, PlaceState};
pub use variable::{Entry, VARIABLES, Variable, Width, Worse};

/// The query.
#[derive(Clone, Debug)]
pub struct MapTask<'a> {
    /// Machine with its tool.
    pub mechanism: &'a Mechanism,
    /// Positions of the tool's reference point.
    pub grid: Grid,
    /// Orientation of the tool everywhere, base from tool.
    pub orientation: UnitQuaternion<f64>,
    /// The machine turns its tool as it moves: at every place it takes the orientation nearest to
    /// `orientation` that it can have there, instead of that one.
    pub orientation_follows: bool,
    /// Dead wrench on the tool, base axes, about its reference point. With it, figures are those of
    /// the machine as it is under this load, its own weight, preloads and deviations; without it, of
    /// the unloaded machine as drawn.
    pub load: Option<Wrench>,
    /// Additional orientations and loads: the figures of a place are the worst of all. Not if the orientation
    /// follows.
    pub further: Vec<(UnitQuaternion<f64>, Option<Wrench>)>,
    /// Requested variables beside the usual figures; they come in [`MapPlace::values`].
    pub variables: Vec<Variable>,
    /// Ratings of the actuators, as far as they are stated.
    pub ratings: Vec<Option<f64>>,
    /// Places before this one are known already.
    pub first: usize,
}

impl MapTask<'_> {
    /// Reason for which every place is solved by itself; `None` if kernels take many at once.
    #[must_use]
    pub fn one_by_one_because(&self) -> Option<String> {
        let loaded = self.load.is_some();
        one_by_one_because(self.mechanism, self.orientation_follows, loaded)
    }
}

/// Places that one thread takes at a time, and that `block` gets: a run that goes on begins with a whole one.
pub const MAP_BLOCK: usize = 256;
/// Maximum number of blocks between two calls of the watch, and in memory at a time.
const BLOCKS: usize = 64;
/// A round of blocks takes about so long: what is solved is handed on, so that a run that is stopped loses no more.
const ROUND: Duration = Duration::from_millis(500);

/// Solves all places of a grid in their order. Each block of places is turned into something by
/// `block`, on any thread; `put` takes these one after the other. No more than a fixed number of
/// places is kept, whatever the size of the grid, and answers do not depend on the number of threads.
///
/// # Errors
/// [`RunError::Cancelled`], and what `put` returns.
pub fn map<R: Send, E: From<RunError>>(
    task: &MapTask<'_>,
    watch: &dyn Watch,
    block: impl Fn(&[MapPlace]) -> R + Sync,
    mut put: impl FnMut(R) -> Result<(), E>,
) -> Result<(), E> {
    let batch = Arc::new(Batch::new(task.mechanism));
    let ratings = task.ratings.clone();
    let evaluator = Evaluator::of_map(task.mechanism, batch, ratings, &task.variables);
    let total = task.grid.len();
    watch.stage("map", total);
    let fewest = rayon::current_num_threads().clamp(1, BLOCKS);
    let (mut first, mut blocks) = (task.first, fewest);
    while first < total {
        if watch.cancelled() {
            return Err(RunError::Cancelled.into());
        }
        let begun = Instant::now();
        let end = total.min(first + BLOCK * blocks);
        let starts: Vec<usize> = (first..end).step_by(BLOCK).collect();
        let done: Vec<R> = starts
            .into_par_iter()
            .map_init(EvaluationRoom::default, |room, start| {
                let places = start..end.min(start + BLOCK);
                block(&solved(task, &evaluator, room, places))
            })
            .collect();
        done.into_iter().try_for_each(&mut put)?;
        watch.advance(end);
        first = end;
        blocks = match begun.elapsed() < ROUND {
            true => (2 * blocks).min(BLOCKS),
            false => (blocks / 2).max(fewest),
        };
    }
    Ok(())
}

fn solved(
    task: &MapTask<'_>,
    evaluator: &Evaluator,
    room: &mut EvaluationRoom,
    places: std::ops::Range<usize>,
) -> Vec<MapPlace> {
    let mut out = Vec::new();
    for place in places {
        let index = task.grid.index(place);
        let position_mm = [0, 1, 2].map(|axis| task.grid.position_mm(axis, index[axis]));
        out.push(MapPlace::unknown(index, position_mm));
    }
    if task.orientation_follows {
        let poses = poses_of(&out, &task.orientation);
        following(task, evaluator, &poses, &mut out);
        return out;
    }
    let first = (task.orientation, task.load);
    let cases: Vec<_> = std::iter::once(&first).chain(&task.further).collect();
    for (k, (orientation, load)) in cases.into_iter().enumerate() {
        let poses = poses_of(&out, orientation);
        let loads = load.map(|load| vec![load; poses.len()]);
        evaluator.solve(&poses, loads.as_deref(), room, |i, solved| {
            let mut own = MapPlace::unknown(out[i].index, out[i].position_mm);
            own.take(evaluator, solved);
            if own.state.has_figures() {
                own.tool_turn_deg = 0.0;
            }
            match k {
                0 => out[i] = own,
                _ => out[i].worsen(own, &task.variables, evaluator),
            }
        });
    }
    out
}

/// The tool at every place with an orientation.
fn poses_of(places: &[MapPlace], orientation: &UnitQuaternion<f64>) -> Vec<Pose> {
    let at = |place: &MapPlace| Vector3::from(place.position_mm) * 1e-3;
    let each = places.iter().map(at);
    each.map(|at| Pose::from_parts(at.into(), *orientation))
        .collect()
}

/// Places by their positions only, one after the other: each followed from the one before where that
/// is near.
fn following(task: &MapTask<'_>, evaluator: &Evaluator, poses: &[Pose], out: &mut [MapPlace]) {
    let requested = Orientation {
        follows: true,
        load_turns: false,
    };
    let near = NEAR * task.mechanism.size();
    let mut solved = Solved::new(task.mechanism);
    let mut last: Option<Posture> = None;
    for (place, pose) in out.iter_mut().zip(poses) {
        let close = last.as_ref().filter(|posture| {
            let at = posture.target().translation.vector;
            (at - pose.translation.vector).norm() < near
        });
        let posture = requested.posture(task.mechanism, pose, close);
        solved.forget();
        last = evaluator.by_itself(&mut solved, posture, task.load.as_ref());
        place.take(evaluator, &solved);
        last = last.filter(|p| p.within_limits().is_ok());
        if let (Some(posture), true) = (&last, place.state.has_figures()) {
            let turned = posture.target().rotation.angle_to(&pose.rotation);
            place.tool_turn_deg = turned.to_degrees();
        }
    }
}

impl MapPlace {
    /// A place of which nothing is known yet.
    #[must_use]
    pub fn unknown(index: [usize; 3], position_mm: [f64; 3]) -> Self {
        Self {
            index,
            position_mm,
            state: PlaceState::Unanswered,
            smallest_stiffness_n_per_mm: f64::NAN,
            stiffness_n_per_mm: [f64::NAN; 3],
            tool_turn_deg: f64::NAN,
            displacement_mm: [f64::NAN; 3],
            rotation_deg: [f64::NAN; 3],
            found_by: FoundBy::Directly,
            values: Box::default(),
        }
    }

    fn take(&mut self, evaluator: &Evaluator, solved: &Solved) {
        self.state = solved.state;
        self.found_by = solved.found_by;
        self.values = evaluator.values(solved);
        if !solved.state.has_figures() {
            return;
        }
        self.smallest_stiffness_n_per_mm = 1e-3 * solved.softest();
        self.stiffness_n_per_mm = [0, 1, 2].map(|k| 1e-3 * solved.along(k));
        self.displacement_mm = (solved.displacement.linear() * 1e3).into();
        self.rotation_deg = solved.displacement.angular().map(f64::to_degrees).into();
    }

    /// Takes what is worse of another orientation or load at the same place.
    fn worsen(&mut self, other: Self, variables: &[Variable], evaluator: &Evaluator) {
        let worse = |own: f64, other: f64| smaller(own, other);
        let softest = self.smallest_stiffness_n_per_mm;
        self.smallest_stiffness_n_per_mm = worse(softest, other.smallest_stiffness_n_per_mm);
        for k in 0..3 {
            let own = &mut self.stiffness_n_per_mm[k];
            *own = worse(*own, other.stiffness_n_per_mm[k]);
        }
        let farther = |own: &[f64; 3], other: &[f64; 3]| {
            let size = |v: &[f64; 3]| Vector3::from(*v).norm();
            size(other) > size(own) || size(other).is_nan()
        };
        if farther(&self.displacement_mm, &other.displacement_mm) {
            self.displacement_mm = other.displacement_mm;
        }
        if farther(&self.rotation_deg, &other.rotation_deg) {
            self.rotation_deg = other.rotation_deg;
        }
        self.tool_turn_deg = larger(self.tool_turn_deg, other.tool_turn_deg);
        if other.state as u8 > self.state as u8 {
            self.state = other.state;
            self.found_by = other.found_by;
        }
        let mut at = 0;
        for (variable, width) in variables.iter().zip(evaluator.widths()) {
            let own = &mut self.values[at..at + width];
            variable.worsen(own, &other.values[at..at + width]);
            at += width;
        }
    }
}

/// Evenly spaced positions of the tool, base axes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// First position along x, y and z.
    pub from_mm: [f64; 3],
    /// Last position along x, y and z; that of an axis with one place does not count.
    pub to_mm: [f64; 3],
    /// Places along x, y and z, at least one each.
    pub counts: [usize; 3],
}

impl Grid {
    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        let [x, y, z] = self.counts;
        x.saturating_mul(y).saturating_mul(z)
    }

    /// True without places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of a place along each axis: x runs fastest, z slowest.
    #[must_use]
    pub fn index(&self, place: usize) -> [usize; 3] {
        let [x, y, _] = self.counts.map(|n| n.max(1));
        [place % x, place / x % y, place / x / y]
    }

    /// Position along one axis (0 to 2), mm.
    #[must_use]
    pub fn position_mm(&self, axis: usize, index: usize) -> f64 {
        let (from, to, count) = (self.from_mm[axis], self.to_mm[axis], self.counts[axis]);
        match index {
            0 => from,
            // Exactly what was requested.
            _ if index + 1 == count => to,
            _ => from + (to - from) * index as f64 / (count - 1) as f64,
        }
    }
}
