//! An equilibrium on a curve of a chain or a machine, in the units of the answer.

use kinetostat::{Pose, Wrench};

use crate::curve::answer::PointAnswer;
use crate::curve::query::{CurveQuery, Measure};

/// An equilibrium on a curve of a chain or a machine, SI.
pub(crate) struct CurveState {
    pub(crate) parameter: f64,
    pub(crate) conjugate: f64,
    pub(crate) slope: f64,
    /// Under a dead load, under prescribed motion.
    pub(crate) stable: [bool; 2],
    pub(crate) may_flutter: bool,
    pub(crate) share_to_buckling: Option<f64>,
    pub(crate) energy: f64,
    pub(crate) wrench: Wrench,
    pub(crate) tip: Pose,
    /// In their units.
    pub(crate) coordinates: Vec<f64>,
}

impl CurveState {
    /// In the units of the question. `turned`: whole turns of the tool about the growing moment, rad.
    pub(crate) fn answer(self, q: &CurveQuery, turned: f64) -> PointAnswer {
        let by_load = q.by_load();
        let p = &self;
        let [displacement, load, slope] = match (q.measure, by_load) {
            (Measure::Force(_), false) => [1e3 * p.parameter, p.conjugate, 1e-3 * p.slope],
            (Measure::Force(f), true) => [
                1e3 * p.conjugate / f,
                f * p.parameter,
                1e-3 * f * f * p.slope,
            ],
            (Measure::Moment(_), false) => {
                [p.parameter.to_degrees(), p.conjugate, p.slope.to_radians()]
            }
            (Measure::Moment(m), true) => [
                (p.conjugate / m + turned).to_degrees(),
                m * p.parameter,
                (m * m * p.slope).to_radians(),
            ],
            (Measure::Work, _) => [p.conjugate, p.parameter, p.slope],
        };
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
            stable_under_dead_load: p.stable[0],
            stable_under_prescribed_motion: p.stable[1],
            may_flutter: p.may_flutter,
            share_to_buckling: p.share_to_buckling.filter(|m| m.is_finite()),
            spring_energy_j: p.energy,
            force_n: p.wrench.force().into(),
            moment_n_m: p.wrench.moment().into(),
            position_mm: (p.tip.translation.vector * 1e3).into(),
            rotation_vector_deg: p.tip.rotation.scaled_axis().map(f64::to_degrees).into(),
            coordinates: self.coordinates,
            shown: [displacement, load, slope],
        }
    }
}
