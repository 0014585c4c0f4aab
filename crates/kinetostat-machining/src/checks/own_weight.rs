//! Deflection of the tool by the machine's own weight and the other loads of its model, without a load on it: the
//! part of a correction that has nothing to do with cutting.
//!
//! It has a limit of its own. Heavy arms sag by millimetres, as they should; a cutting force that moves the tool that
//! far is a wrong unit. The share of it that is an error of the program depends on how the part was measured
//! ([`crate::WeightCorrection`]).

use kinetostat::number::larger;
use kinetostat_program::Move;
use nalgebra::Vector3;

use crate::measured_frame::{FrameMotion, MeasuredFrame, PartPlace, Sag};
use crate::postures::neighbour::in_chunks;
use crate::result::point::PointResult;
use crate::result::run_result::RunResult;
use crate::task::{RunError, Task};

/// Displacement of the unloaded tool by what acts in the machine, program axes, mm.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ByOwnLoads {
    /// All of it.
    pub whole: Vector3<f64>,
    /// Part that is an error of the program.
    pub error: Vector3<f64>,
}

/// Displacements at points; `None` if there is no answer.
pub(crate) fn by_own_loads(task: &Task<'_>, points: &[&PointResult]) -> Vec<Option<ByOwnLoads>> {
    let Ok(frame) = MeasuredFrame::of(task, None) else {
        return vec![None; points.len()];
    };
    let machine = |p: &PointResult| task.mechanism_on(p.line);
    let of_one_machine = points.chunk_by(|a, b| std::ptr::eq(machine(a), machine(b)));
    of_one_machine
        .flat_map(|run| {
            let sag = Sag::new(machine(run[0]), &task.placement);
            in_chunks(run, |_, points| {
                let programmed = |point: &&PointResult| PartPlace::of_point(task, point);
                let places: Vec<PartPlace> = points.iter().map(programmed).collect();
                let measured = frame.motions(machine(run[0]), &places, |_| None);
                let both = sag.at(&places, |_| None).into_iter().zip(measured);
                let shift = |motion: FrameMotion| motion.shift_mm;
                both.map(|(whole, measured)| {
                    let (whole, measured) = (shift(whole.ok()?), shift(measured.ok()?));
                    let error = whole - measured;
                    Some(ByOwnLoads { whole, error })
                })
                .collect()
            })
        })
        .collect()
}

/// Largest displacement of the unloaded tool by own weight and loads of the model at
/// [`RunResult::MAX_POSTURES`](crate::RunResult::MAX_POSTURES) places, mm: all of it, and its part that is an error.
pub(crate) fn largest_by_own_weight(task: &Task<'_>, points: &[&PointResult]) -> Option<[f64; 2]> {
    let mut machines = points.iter().map(|p| task.mechanism_on(p.line));
    if !machines.any(kinetostat::Mechanism::has_own_loads) {
        return None;
    }
    let some = points.iter().step_by(every(task, points.len()));
    let some: Vec<&PointResult> = some.copied().collect();
    let own = by_own_loads(task, &some).into_iter().flatten();
    let sizes = own.map(|own| [own.whole.norm(), own.error.norm()]);
    sizes.reduce(|[a, b], [c, d]| [larger(a, c), larger(b, d)])
}

/// Refuses a program along which own weight moves the tool where nobody stated whether that is an error.
pub(crate) fn weight_is_stated(task: &Task<'_>, points: &[PointResult]) -> Result<(), RunError> {
    if !task.weight.is_not_stated() {
        return Ok(());
    }
    let points: Vec<&PointResult> = points.iter().collect();
    let displacement_mm = largest_by_own_weight(task, &points).map_or(0.0, |[whole, _]| whole);
    let last_digit = 10_f64.powi(-i32::from(task.writing.decimals.unwrap_or(4)));
    match displacement_mm > last_digit {
        true => Err(RunError::WeightNotStated { displacement_mm }),
        false => Ok(()),
    }
}

/// Places of a part of a longer program, at least.
const OF_PART: usize = 2;

/// Every how many of so many points one is looked at, so that there are [`RunResult::MAX_POSTURES`] places at most: of a part of a
/// longer program as many of them as its length has a share in that, and two at least.
pub(crate) fn every(task: &Task<'_>, points: usize) -> usize {
    points.div_ceil(places(task)).max(1)
}

fn places(task: &Task<'_>) -> usize {
    let Some(part) = &task.path().part else {
        return RunResult::MAX_POSTURES;
    };
    let own = task.path().moves[part.moves.clone()].iter();
    let own_mm: f64 = own
        .filter(|motion| motion.is_known_feed())
        .map(Move::length_mm)
        .sum();
    let share = (own_mm / part.whole_feed_mm).min(1.0);
    // No number where nothing is cut.
    let share = if share.is_finite() { share } else { 1.0 };
    let places = (share * RunResult::MAX_POSTURES as f64).ceil() as usize;
    places.max(OF_PART)
}
