//! Points of the curves of a chain or a machine: those with names, the jumps between them, and the branches.

use kinetostat::Parameter;
use kinetostat::continuation::{
    BranchEnd, CurveEquilibrium, CurvePoint, CurveStability, Jump, Special,
};
use kinetostat_analysis::rotation::ContinuousRotation;
use nalgebra::Vector3;

use crate::curve::answer::{BranchAnswer, JumpAnswer, NamedPoint, PointAnswer, kind_name, letter};
use crate::curve::followed::Followed;
use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::subject::Subject;

/// Points of a branch that are nearer to each other, in natural units, are one.
const SAME_POINT: f64 = 1e-9;

/// Curves as they are shown.
pub(crate) struct View<'v, S: Subject> {
    pub(crate) subject: &'v S,
    pub(crate) q: &'v CurveQuery,
    pub(crate) curves: &'v Followed<S::Equilibrium>,
    pub(crate) rotation: ContinuousRotation,
    /// Displacement along the growing load where the curve of a chain starts, m or rad.
    pub(crate) at_start: f64,
}

impl<S: Subject> View<'_, S> {
    /// `more`: what a continuous rotation has more than the one within half a turn, about the moment
    /// that grows, rad.
    fn point(&self, p: &CurvePoint<S::Equilibrium>, more: &Vector3<f64>) -> PointAnswer {
        let coordinates = self.subject.values(&p.equilibrium);
        point_answer(p, self.q, self.about(more) + self.at_start, coordinates)
    }

    /// The part of a rotation vector about the growing moment.
    fn about(&self, rotation: &Vector3<f64>) -> f64 {
        match &self.q.parameter {
            Parameter::Load(pattern) => {
                let axis = pattern.end.moment().try_normalize(0.0);
                axis.map_or(0.0, |axis| rotation.dot(&axis))
            }
            Parameter::Displacement(_) => 0.0,
        }
    }

    /// Points with names, and the jumps between them.
    pub(crate) fn named(&self) -> (Vec<NamedPoint>, Vec<JumpAnswer>) {
        let mut names = Names {
            view: self,
            list: Vec::new(),
        };
        let own = self.curves.branches.first();
        if let Some(p) = own.and_then(|own| own.points.get(own.start)) {
            names.add("start", "where the curve starts".into(), 0, p);
        }
        let specials = self.curves.specials.iter();
        let specials: Vec<String> = specials.map(|s| names.special(s)).collect();
        let jumps = self.curves.jumps.iter();
        let jumps = jumps
            .map(|jump| names.jump(jump, &specials[jump.from]))
            .collect();
        for k in 0..self.curves.branches.len() {
            names.ends(k);
        }
        (names.list, jumps)
    }

    pub(crate) fn branches(&self, named: &[NamedPoint]) -> Vec<BranchAnswer> {
        let branches = &self.curves.branches;
        let points = |k: usize| {
            let points = branches[k].points.iter().enumerate();
            let turned = |i| self.rotation.of_point(branches, k, i);
            points.map(|(i, p)| self.point(p, &turned(i))).collect()
        };
        branches
            .iter()
            .enumerate()
            .map(|(k, b)| BranchAnswer {
                number: k + 1,
                // The start is named first, then the special points in their order.
                from: b
                    .origin
                    .and_then(|s| named.get(s + 1))
                    .map(|n| n.name.clone()),
                ends: b.ends,
                points: points(k),
            })
            .collect()
    }
}

/// Points as they get their names: A, B, C and so on.
struct Names<'n, S: Subject> {
    view: &'n View<'n, S>,
    list: Vec<NamedPoint>,
}

impl<S: Subject> Names<'_, S> {
    /// Gives the point the next letter as its name; `branch` counts from 0.
    fn add(
        &mut self,
        kind: &'static str,
        in_words: String,
        branch: usize,
        p: &CurvePoint<S::Equilibrium>,
    ) -> String {
        let view = self.view;
        let name = letter(self.list.len());
        self.list.push(NamedPoint {
            name: name.clone(),
            kind,
            in_words,
            branches: vec![branch + 1],
            mode: Vec::new(),
            mode_in_words: String::new(),
            limits: [false; 2],
            point: view.point(p, &view.rotation.at(&view.curves.branches, p)),
        });
        name
    }

    fn special(&mut self, s: &Special<S::Equilibrium>) -> String {
        let words = s.description(self.view.q.holding.subject);
        let name = self.add(kind_name(s.kind), words, 0, &s.point);
        let mode_in_words = self.view.subject.motion_description(&s.mode);
        if let Some(added) = self.list.last_mut() {
            added.branches = s.branches.iter().map(|b| b + 1).collect();
            // The sign of zeros is removed.
            added.mode = s.mode.iter().map(|x| x + 0.0).collect();
            added.mode_in_words = mode_in_words;
            added.limits = s.ends_stability();
        }
        name
    }

    fn jump(&mut self, jump: &Jump<S::Equilibrium>, from: &str) -> JumpAnswer {
        let (under, words) = match jump.dead_load {
            true => ("dead_load", "under a dead load"),
            false => ("prescribed_motion", "under prescribed motion"),
        };
        let to = jump.to.iter().zip(&jump.branches).map(|(p, branch)| {
            let words = format!("where the jump from {from} {words} may land");
            self.add("landing", words, *branch, p)
        });
        let to = to.collect();
        JumpAnswer {
            from: from.to_owned(),
            under,
            to,
        }
    }

    /// Names both ends of a branch, except the curve's start, which has a name already.
    fn ends(&mut self, k: usize) {
        let branch = &self.view.curves.branches[k];
        let start = branch.points.get(branch.start).filter(|_| k == 0);
        let is_start =
            |p: &CurvePoint<S::Equilibrium>| start.is_some_and(|o| p.apart(o) < SAME_POINT);
        let ends = [branch.points.first(), branch.points.last()];
        for (p, end) in ends.into_iter().zip(branch.ends) {
            if matches!(end, BranchEnd::Closed | BranchEnd::Found) {
                continue;
            }
            if let Some(p) = p.filter(|p| !is_start(p)) {
                let words = format!("end of branch {}: {}", k + 1, end.description());
                self.add("end", words, k, p);
            }
        }
    }
}

/// Converts a point to the units of the query. `more`: what the displacement along the growing load has more than its
/// conjugate, m or rad; `coordinates`: in their units.
fn point_answer<E: CurveEquilibrium>(
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
