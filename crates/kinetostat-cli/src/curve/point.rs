//! An equilibrium on a curve of a chain or a machine, in the units of the answer.

use kinetostat::continuation::{CurveEquilibrium, CurvePoint, CurveStability};

use crate::curve::answer::PointAnswer;
use crate::curve::query::{CurveQuery, Measure};

/// Converts a point to the units of the query. `more`: what the displacement along the growing load has more than its
/// conjugate, m or rad; `coordinates`: in their units.
pub(crate) fn point_answer<E: CurveEquilibrium>(
    p: &CurvePoint<E>,
    q: &CurveQuery,
    more: f64,
    coordinates: Vec<f64>,
) -> PointAnswer {
    let by_load = q.by_load();
    let [displacement, load, slope] = match (q.measure, by_load) {
        (Measure::Force(_), false) => [1e3 * p.parameter, p.conjugate, 1e-3 * p.slope],
        (Measure::Force(f), true) => [
            1e3 * (p.conjugate / f + more),
            f * p.parameter,
            1e-3 * f * f * p.slope,
        ],
        (Measure::Moment(_), false) => {
            [p.parameter.to_degrees(), p.conjugate, p.slope.to_radians()]
        }
        (Measure::Moment(m), true) => [
            (p.conjugate / m + more).to_degrees(),
            m * p.parameter,
            (m * m * p.slope).to_radians(),
        ],
        (Measure::Work, _) => [p.conjugate, p.parameter, p.slope],
    };
    let e = &p.equilibrium;
    let of = |this: bool, x: f64| this.then_some(x);
    let force = matches!(q.measure, Measure::Force(_));
    let moment = matches!(q.measure, Measure::Moment(_));
    let work = q.measure == Measure::Work;
    PointAnswer {
        factor: of(by_load, p.parameter),
        displacement_mm: of(force, displacement),
        rotation_deg: of(moment, displacement),
        work_per_factor_j: of(work, displacement),
        force_along_n: of(force, load),
        moment_along_n_m: of(moment, load),
        slope_n_per_mm: of(force, slope),
        slope_n_m_per_deg: of(moment, slope),
        slope_per_j: of(work, slope),
        stable_under_dead_load: p.dead_load.stable(),
        stable_under_prescribed_motion: p.displacement_control.stable(),
        may_flutter: p.dead_load.may_flutter(),
        share_to_buckling: e.share_to_buckling().filter(|m| m.is_finite()),
        spring_energy_j: e.spring_energy(),
        force_n: e.wrench().force().into(),
        moment_n_m: e.wrench().moment().into(),
        position_mm: (e.tool().translation.vector * 1e3).into(),
        rotation_vector_deg: e.tool().rotation.scaled_axis().map(f64::to_degrees).into(),
        coordinates,
        shown: [displacement, load, slope],
    }
}
