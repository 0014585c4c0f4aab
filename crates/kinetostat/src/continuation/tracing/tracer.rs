//! One step after another along a curve of equilibria: predictor along the tangent, Newton across
//! it.

use std::sync::Arc;

use nalgebra::DVector;

use crate::continuation::curve::{BranchEnd, Stop};
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::Tangent;
use crate::continuation::settings::CurveSettings;
use crate::continuation::tracing::bifurcation::start_direction;
use crate::continuation::tracing::describe::{describe, family_of, tangent};
use crate::continuation::tracing::special_points;
use crate::continuation::tracing::system::{
    Corrected, CurveSystem, HalfBranch, Point, Row, SpecialPoint, distance,
};
use crate::error::Result;

/// Attempted steps after which a branch must have come further.
const ATTEMPTS: usize = 150;

/// Ends branches that make no progress.
#[derive(Default)]
struct Budget {
    attempts: usize,
    since: usize,
    progress: f64,
}

impl Budget {
    fn advanced(&mut self, by: f64) {
        self.progress += by;
    }

    /// Counts an attempt from a branch of some points whose longest step is known.
    fn spent(&mut self, points: usize, longest: f64) -> bool {
        self.attempts += 1;
        self.since += 1;
        if self.since > ATTEMPTS {
            if self.progress < 0.05 * longest {
                return true;
            }
            self.since = 0;
            self.progress = 0.0;
        }
        self.attempts > 10 * points + ATTEMPTS
    }
}

pub(crate) struct Tracer<'s, S: CurveSystem> {
    pub system: S,
    pub settings: &'s CurveSettings,
    pub specials: Vec<SpecialPoint<S>>,
}

impl<'s, S: CurveSystem> Tracer<'s, S> {
    pub fn new(system: S, settings: &'s CurveSettings) -> Self {
        Self {
            system,
            settings,
            specials: Vec::new(),
        }
    }

    pub(super) fn first_point(&mut self, z: &DVector<f64>) -> Result<Point<S>> {
        let mut z = z.clone();
        let mut best = None;
        // The start is refined across its own tangent, which exists where the parameter stands
        // still.
        for _ in 0..3 {
            let (_, _, matrix) = self.system.linearised(&z);
            let t = match matrix.only_direction() {
                Some(t) => t,
                None => start_direction(&mut self.system, &z),
            };
            let offset = t.dot(&z);
            let Some(c) = self.system.correct(&z, &Row::Plane(&t, offset), 12) else {
                break;
            };
            z.clone_from(&c.z);
            best = Some((c, t));
        }
        let Some((c, mut t)) = best else {
            return Err(self.system.not_converged(&z, 12));
        };
        if !self.system.points_forward(&t) {
            t *= -1.0;
        }
        let family = self.family_at(&c, &t);
        self.system.set_family(family);
        if let Some(own) = tangent(&self.system, &c.matrix, &t) {
            t = own.direction;
        }
        self.system.evaluate(&c.z);
        Ok(describe(&mut self.system, &c, t))
    }

    /// Family to which a state on a curve along `t` belongs.
    pub(super) fn family_at(&mut self, c: &Corrected, t: &DVector<f64>) -> Option<Arc<Family>> {
        match c.matrix.only_direction() {
            Some(_) => None,
            None => family_of(&mut self.system, &c.z, t).map(Arc::new),
        }
    }

    /// Largest step along `t`.
    pub fn longest(&self, t: &DVector<f64>) -> f64 {
        let mut h = self.system.longest_step(t, self.settings);
        let (low, high) = self.settings.range;
        let width = high - low;
        let most = self
            .settings
            .largest_change
            .or_else(|| width.is_finite().then_some(width / 20.0));
        if let Some(most) = most.filter(|m| *m > 0.0) {
            let change = (t[self.system.count()] * self.system.sigma()).abs();
            h = h.min(most / change.max(1e-300));
        }
        h
    }

    /// Follows the path from a point along its tangent. `known` tells that the first point is an
    /// ordinary one, whose test functions may be compared with the next.
    pub fn run(
        &mut self,
        start: Point<S>,
        known: bool,
        branch: usize,
        stop: Stop<'_, S::Equilibrium>,
    ) -> HalfBranch<S> {
        let m = self.system.count();
        let mut points = vec![start];
        self.system.resume(&points[0]);
        if stop.is_some_and(|stop| stop(&points[0])) {
            return (points, BranchEnd::Found);
        }
        let mut probe = if known { self.probe(&points[0]) } else { None };
        let mut h = 0.2 * self.longest(&points[0].tangent);
        let mut budget = Budget::default();
        loop {
            let here = points[points.len() - 1].clone();
            if points.len() > self.settings.points {
                return (points, BranchEnd::Points);
            }
            let longest = self.longest(&here.tangent);
            if budget.spent(points.len(), longest) {
                return (points, BranchEnd::Stalled);
            }
            h = h.min(longest);
            let Some((point, next, iterations)) = self.step(&here, h) else {
                h *= 0.5;
                if h < self.settings.smallest_step.max(1e-12) {
                    return (points, BranchEnd::Lost);
                }
                continue;
            };
            let jumps = (0..2).any(|k| here.unstable[k].abs_diff(point.unstable[k]) > 1);
            if jumps && h > 1e-5 && points.len() > usize::from(!known) {
                h *= 0.5;
                continue;
            }
            if let Some(end) = self.beyond(&here, &point) {
                if let Some((last, next)) = self.cut(&here, &point) {
                    self.look_between(&here, &last, probe.as_ref(), &next, branch);
                    points.push(last);
                }
                return (points, end);
            }
            let clear = self.look_between(&here, &point, probe.as_ref(), &next, branch);
            if !clear && h > self.settings.smallest_step.max(1e-6) {
                h *= 0.5;
                continue;
            }
            let origin = &points[0];
            let back = distance(&self.system, &origin.z, &point.z);
            if points.len() > 5
                && back < 0.75 * h
                && origin.tangent.dot(&point.tangent) > 0.8
                && (origin.z[m] - point.z[m]).abs() < h
            {
                let mut last = origin.clone();
                last.tangent.clone_from(&point.tangent);
                points.push(last);
                return (points, BranchEnd::Closed);
            }
            let found = stop.is_some_and(|stop| stop(&point));
            budget.advanced((&point.z - &here.z).norm());
            self.system.resume(&point);
            probe = if point.family.is_some() {
                self.probe(&point)
            } else {
                Some(next)
            };
            points.push(point);
            if found {
                return (points, BranchEnd::Found);
            }
            if iterations <= 4 {
                h *= 1.5;
            }
        }
    }

    /// The point between two neighbours at which stability changes, by halving.
    pub fn stability_change(
        &mut self,
        here: &Point<S>,
        there: &Point<S>,
        unstable: &dyn Fn(&Point<S>) -> bool,
    ) -> Point<S> {
        self.system.resume(here);
        let (mut low, mut high, mut best) = (0.0, 1.0, there.clone());
        for _ in 0..50 {
            let share = 0.5 * (low + high);
            let guess = &here.z + (&there.z - &here.z) * share;
            let t = &here.tangent;
            let Some(c) = self
                .system
                .correct(&guess, &Row::Plane(t, t.dot(&guess)), 10)
            else {
                break;
            };
            let point = describe(&mut self.system, &c, t.clone());
            if unstable(&point) {
                high = share;
                best = point;
            } else {
                low = share;
            }
        }
        best
    }

    /// Test functions at a point.
    pub fn probe(&mut self, point: &Point<S>) -> Option<Tangent> {
        let (_, _, matrix) = self.system.linearised(&point.z);
        tangent(&self.system, &matrix, &point.tangent)
    }

    /// One step of length `h`, `None` if it is too long.
    pub(super) fn step(&mut self, here: &Point<S>, h: f64) -> Option<(Point<S>, Tangent, usize)> {
        let t = &here.tangent;
        let straight = &here.z + t * h;
        let offset = t.dot(&straight);
        let predicted = self.system.followed(&here.z, straight);
        let c = self.system.correct(&predicted, &Row::Plane(t, offset), 8)?;
        if (&c.z - &predicted).norm() > 0.3 * h {
            return None;
        }
        let next = tangent(&self.system, &c.matrix, t)?;
        if next.direction.dot(t) < 0.95 && h > 1e-5 {
            return None;
        }
        let iterations = c.iterations;
        let point = describe(&mut self.system, &c, next.direction.clone());
        Some((point, next, iterations))
    }

    /// Reason of the branch's end if the last step left the limits.
    pub(super) fn beyond(&self, here: &Point<S>, point: &Point<S>) -> Option<BranchEnd> {
        let left = |from: f64, to: f64, (low, high): (f64, f64)| {
            (to > high && to > from) || (to < low && to < from)
        };
        if left(here.parameter, point.parameter, self.settings.range)
            || left(
                here.conjugate,
                point.conjugate,
                self.settings.conjugate_range,
            )
        {
            return Some(BranchEnd::Range);
        }
        let far = (self.system).beyond_angle(&point.equilibrium, self.settings.largest_angle);
        far.then_some(BranchEnd::Angle)
    }

    /// The point at which the path crosses a limit between two points.
    fn cut(&mut self, here: &Point<S>, point: &Point<S>) -> Option<(Point<S>, Tangent)> {
        let cross = |from: f64, to: f64, (low, high): (f64, f64)| {
            let limit = if to > high { high } else { low };
            let crosses = (to > high && from < high) || (to < low && from > low);
            crosses.then(|| (limit, (limit - from) / (to - from)))
        };
        let a = cross(here.parameter, point.parameter, self.settings.range);
        let b = cross(
            here.conjugate,
            point.conjugate,
            self.settings.conjugate_range,
        );
        let (row, share) = match (a, b) {
            (Some((_, s)), Some((v, u))) if u < s => (Row::Conjugate(v), u),
            (Some((v, s)), _) => (Row::Parameter(v), s),
            (None, Some((v, u))) => (Row::Conjugate(v), u),
            (None, None) => return None,
        };
        let guess = &here.z + (&point.z - &here.z) * share;
        let c = self.system.correct(&guess, &row, 10)?;
        if (&c.z - &guess).norm() > (&point.z - &here.z).norm() {
            return None;
        }
        let next = tangent(&self.system, &c.matrix, &here.tangent)?;
        let last = describe(&mut self.system, &c, next.direction.clone());
        Some((last, next))
    }

    /// Books limit and bifurcation points between two points; false if the second lies on another
    /// branch.
    pub(super) fn look_between(
        &mut self,
        here: &Point<S>,
        point: &Point<S>,
        before: Option<&Tangent>,
        after: &Tangent,
        branch: usize,
    ) -> bool {
        let Some(found) =
            special_points::between(&mut self.system, &self.specials, here, point, before, after)
        else {
            return false;
        };
        for mut special in found {
            let same = self.specials.iter().position(|s| {
                let bifurcations = s.kind.is_bifurcation() == special.kind.is_bifurcation();
                let apart = distance(&self.system, &s.point.z, &special.point.z);
                let (own, other) = (&special.point.equilibrium, &s.point.equilibrium);
                bifurcations
                    && apart < (10.0 * (s.accuracy + special.accuracy)).max(1e-7)
                    && !self.system.condensed_apart(own, other, other)
            });
            match same {
                Some(i) => {
                    if !self.specials[i].branches.contains(&branch) {
                        self.specials[i].branches.push(branch);
                    }
                }
                None => {
                    special.branches = vec![branch];
                    self.specials.push(special);
                }
            }
        }
        true
    }
}
