//! The spread of the force's coefficients through to the errors: the machine solved with the force so much larger and
//! smaller.

use kinetostat::Wrench;
use kinetostat::number::larger;

use crate::result::force_band::ForceBand;
use crate::result::point::{PointKind, PointResult, size};
use crate::result::run_result::RunResult;
use crate::result::selection::thinned;
use crate::run::other_load::errors_under;
use crate::run::sites::site::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

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
