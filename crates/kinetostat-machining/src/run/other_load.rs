//! Errors of a run under another load than its own: under the other reading of sharp corners, and with the spread of the force's
//! coefficients, for which the machine is solved with the force so much larger and smaller.

use kinetostat::number::larger;
use kinetostat::{Pose, Wrench};

use crate::load::law::CornerLoad;
use crate::measured_frame::{MeasuredFrame, PartPlace};
use crate::postures::neighbour::in_chunks;
use crate::result::point::{PointKind, PointResult, size};
use crate::result::run_result::RunResult;
use crate::result::selection::thinned;
use crate::result::uncertainty_band::ForceBand;
use crate::run::points::{BATCH, Machines};
use crate::run::sites::site::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Distance of the tool from its place at each of these, with what the written program commands there and the load beside
/// it (base axes, N, N m), mm. `None` if the machine has no equilibrium under that load. Gravity and what else acts in the
/// model stay as they are.
pub(crate) fn errors_under(
    task: &Task<'_>,
    loaded: &[(Site, Wrench)],
    stage: &str,
    watch: &dyn Watch,
) -> Result<Vec<Option<f64>>, RunError> {
    watch.stage(stage, loaded.len());
    let machines = Machines::new(task);
    let frame = MeasuredFrame::of(task, None)?;
    let mut all: Vec<Option<f64>> = Vec::with_capacity(loaded.len());
    for batch in loaded.chunks(BATCH) {
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let of_one_tool = batch.chunk_by(|a, b| machines.same(&a.0, &b.0));
        let errors = of_one_tool.flat_map(|run| {
            let (machine, orientation) = machines.at(&run[0].0);
            let mechanism = machine.mechanism();
            in_chunks(run, |memory, sites| {
                let poses: Vec<Pose> = sites
                    .iter()
                    .map(|(site, _)| site.commanded_pose(task))
                    .collect();
                let places: Vec<PartPlace> = sites
                    .iter()
                    .map(|(site, _)| site.programmed(site.commanded_placement(task)))
                    .collect();
                let own = task.mechanism_on(sites[0].0.line);
                let motions = frame.motions(own, &places, |_| None);
                let wrenches: Vec<Wrench> = sites.iter().map(|(_, wrench)| *wrench).collect();
                let found = machine.rest(&poses, &wrenches);
                let [memory, _] = memory;
                let mut tool = |i: usize| -> Option<Pose> {
                    match &found {
                        Some(found) => Some(found.tool_pose(i)),
                        None => {
                            let rest = memory.rest(mechanism, &poses[i], &wrenches[i], orientation);
                            Some(rest.ok()?.1)
                        }
                    }
                };
                (0..sites.len())
                    .map(|i| {
                        let wanted = places[i].moved(motions[i].as_ref().ok()?).pose();
                        let off = tool(i)?.translation.vector - wanted.translation.vector;
                        Some(places[i].place.to_program(&off).norm())
                            .filter(|error| error.is_finite())
                    })
                    .collect::<Vec<Option<f64>>>()
            })
        });
        all.extend(errors);
        watch.advance(all.len());
    }
    Ok(all)
}

/// Largest distance of the tool from its place on the corner steps that were read the other way, if the load there is
/// by `reading` ([`Site::other_wrench`]), mm. `None` without such steps; infinite if a step has no equilibrium by
/// that reading.
pub(crate) fn by_the_other_reading<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    reading: CornerLoad,
    sites: impl Fn() -> S,
    watch: &dyn Watch,
) -> Result<Option<f64>, RunError> {
    let mut loads = task.tools.iter().map(|tool| &tool.load).chain([&task.load]);
    if loads.all(|load| load.at_corners == reading) {
        return Ok(None);
    }
    let steps: Vec<(Site, Wrench)> = sites()
        .filter(|site| task.load_on(site.line).at_corners == reading.other())
        .filter_map(|site| {
            let other = site.other_wrench?;
            Some((site, other))
        })
        .collect();
    let errors = errors_under(task, &steps, "corner steps by the other reading", watch)?;
    let errors = errors.into_iter().map(|e| e.unwrap_or(f64::INFINITY));
    Ok(errors.reduce(larger))
}

/// Points with the largest forces for their stiffness that are solved in any case.
const SOFTEST: usize = 500;

/// The band of the errors, which is also written to the points that it was solved at; none where the load is not computed
/// from a cut, or its coefficients have no spread. `sites` are those of the points, in their order.
pub(crate) fn force_band<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    points: &mut [PointResult],
    sites: impl Fn() -> S,
    watch: &dyn Watch,
) -> Result<Option<ForceBand>, RunError> {
    let spread = task.cut.map_or(0.0, |cut| cut.spread());
    if spread <= 0.0 || spread.is_nan() {
        return Ok(None);
    }
    let mut chosen = vec![false; points.len()];
    for i in thinned(points, &softest(points), RunResult::MAX_POINTS) {
        chosen[i] = points[i].kind != PointKind::Rapid;
    }
    let chosen: Vec<(usize, Site)> = sites()
        .enumerate()
        .filter(|(i, _)| chosen.get(*i) == Some(&true))
        .collect();
    let under = |factor: f64, stage: &str| {
        let scaled = |(_, site): &(usize, Site)| (site.clone(), Wrench(site.wrench.0 * factor));
        let loaded: Vec<(Site, Wrench)> = chosen.iter().map(scaled).collect();
        errors_under(task, &loaded, stage, watch)
    };
    let more = under(1.0 + spread, "deflections with the larger force")?;
    let less = under(1.0 - spread, "deflections with the smaller force")?;
    let mut band = ForceBand {
        spread_percent: 100.0 * spread,
        points: chosen.len(),
        of_points: points.iter().filter(|p| p.kind != PointKind::Rapid).count(),
        ..ForceBand::default()
    };
    let infinite = |error: &Option<f64>| error.unwrap_or(f64::INFINITY);
    let mut worst = f64::NEG_INFINITY;
    for (((i, _), more), less) in chosen.iter().zip(&more).zip(&less) {
        let point = &mut points[*i];
        (
            point.error_if_force_larger_mm,
            point.error_if_force_smaller_mm,
        ) = (*more, *less);
        let here = larger(infinite(more), infinite(less));
        if here > worst {
            worst = here;
            band.line = point.line;
        }
    }
    let most = |errors: &[Option<f64>]| {
        let most = errors.iter().map(infinite).reduce(larger);
        most.filter(|error| error.is_finite())
    };
    band.max_error_if_larger_mm = most(&more);
    band.max_error_if_smaller_mm = most(&less);
    Ok(Some(band))
}

/// Points with the largest forces for their stiffness: there the tool gives way most to more force.
fn softest(points: &[PointResult]) -> Vec<usize> {
    let way = |i: &usize| size(&points[*i].force_n) / points[*i].smallest_stiffness_n_per_mm;
    let mut order: Vec<usize> = (0..points.len()).collect();
    if points.len() > SOFTEST {
        let descending = |a: &usize, b: &usize| way(b).total_cmp(&way(a));
        order.select_nth_unstable_by(SOFTEST, descending);
        order.truncate(SOFTEST);
    }
    order
}
