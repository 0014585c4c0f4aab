//! One step after another along a curve of equilibria: predictor along the tangent, Newton across
//! it.

use std::sync::Arc;

use nalgebra::DVector;

use crate::continuation::bifurcation::{self, Special};
use crate::continuation::branches::{Branch, BranchEnd, CurvePoint, CurveSettings, Stop, join};
use crate::continuation::curve_matrix::{CurveMatrix, Tangent};
use crate::continuation::family::{Family, family_of};
use crate::continuation::reduced::{Corrected, Reduced, Row};
use crate::continuation::singular_point::start_direction;
use crate::continuation::state_distance::{
    distance, off_segment, segment_distance, wrapped, wraps,
};
use crate::error::Result;
use crate::spatial::MotionKind;

/// Attempted steps after which a branch must have come further.
const ATTEMPTS: usize = 150;

/// Ends branches that make no progress.
#[derive(Default)]
struct Budget {
    attempts: usize,
    since: usize,
    way: f64,
}

impl Budget {
    fn advanced(&mut self, by: f64) {
        self.way += by;
    }

    /// Counts an attempt from a branch of some points whose longest step is known.
    fn spent(&mut self, points: usize, longest: f64) -> bool {
        self.attempts += 1;
        self.since += 1;
        if self.since > ATTEMPTS {
            if self.way < 0.05 * longest {
                return true;
            }
            self.since = 0;
            self.way = 0.0;
        }
        self.attempts > 10 * points + ATTEMPTS
    }
}

/// Compliance, in natural units, below which a chain is locked along the load.
const LOCKED: f64 = 1e-12;

/// No first step away from a bifurcation converged.
struct NotFollowed;

/// Family of a branch close to the special point from which it starts.
fn beside_origin(branch: &Branch, special: &Special) -> Option<Arc<Family>> {
    let apart = |p: &CurvePoint| (&p.z - &special.point.z).norm();
    let beside = branch.points.iter().filter(|p| apart(p) > 0.0);
    beside
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .and_then(|p| p.family.clone())
}

pub(crate) struct Tracer<'p, 'a, 's> {
    pub reduced: Reduced<'p, 'a>,
    pub settings: &'s CurveSettings,
    pub specials: Vec<Special>,
}

impl Tracer<'_, '_, '_> {
    /// Follows the path through a state both ways, and the branches that cross it.
    pub fn grow(
        &mut self,
        z: &DVector<f64>,
        branches: &mut Vec<Branch>,
        more: &mut bool,
        stop: Stop<'_>,
    ) -> Result<bool> {
        let first = self.first_point(z)?;
        let chain = self.reduced.problem.chain;
        let on_branch = branches.iter().flat_map(|b| b.points.windows(2)).any(|w| {
            let step = (&w[1].z - &w[0].z).norm();
            off_segment(chain, &self.reduced, &first.z, &w[0].z, &w[1].z) < 0.02 * step
        });
        if on_branch {
            return Ok(false);
        }
        let own = branches.len();
        let allowed = own + self.settings.branches.max(1);
        let mut next = self.specials.len();
        let mut halves = Vec::new();
        for sign in [-1.0, 1.0] {
            // A search goes one way only: towards larger parameters.
            if sign < 0.0 && stop.is_some() {
                halves.push((vec![first.clone()], BranchEnd::Found));
                continue;
            }
            let mut point = first.clone();
            point.tangent *= sign;
            halves.push(self.run(point, true, own, stop));
            if halves.first().is_some_and(|h| h.1 == BranchEnd::Closed) {
                halves.push((vec![first.clone()], BranchEnd::Closed));
                break;
            }
        }
        branches.push(join(halves, None));
        while next < self.specials.len() && stop.is_none() {
            let special = self.specials[next].clone();
            let mut followed: Vec<(DVector<f64>, Arc<Family>)> = Vec::new();
            for direction in &special.directions {
                // One branch of a family stands for all.
                if followed.iter().any(|(d, f)| f.joins(d, direction)) {
                    continue;
                }
                if branches.len() >= allowed {
                    *more |= self.settings.branches > 1;
                    break;
                }
                let mut halves = Vec::new();
                for sign in [-1.0, 1.0] {
                    let half = self.switch(&special, &(direction * sign), branches, branches.len());
                    let half = half.unwrap_or_else(|NotFollowed| {
                        self.specials[next].lost_branch = true;
                        None
                    });
                    let closed = half.as_ref().is_some_and(|h| h.1 == BranchEnd::Closed);
                    halves.push(half);
                    if closed {
                        halves.push(None);
                        break;
                    }
                }
                if halves.iter().all(Option::is_none) {
                    continue;
                }
                let middle = special.point.clone();
                let whole = halves
                    .into_iter()
                    .map(|h| h.unwrap_or((vec![middle.clone()], BranchEnd::Closed)))
                    .collect();
                let branch = join(whole, Some(next));
                if let Some(family) = beside_origin(&branch, &special) {
                    followed.push((direction.clone(), family));
                }
                self.specials[next].branches.push(branches.len());
                branches.push(branch);
            }
            next += 1;
        }
        Ok(true)
    }

    fn first_point(&mut self, z: &DVector<f64>) -> Result<CurvePoint> {
        let m = self.reduced.count();
        let mut z = z.clone();
        let mut best = None;
        // The start is refined across its own tangent, which exists where the parameter stands
        // still.
        for _ in 0..3 {
            let (_, _, matrix) = self.reduced.linearised(&z);
            let t = match matrix.only_direction() {
                Some(t) => t,
                None => start_direction(&mut self.reduced, &z),
            };
            let offset = t.dot(&z);
            let Some(c) = self.reduced.correct(&z, &Row::Plane(&t, offset), 12) else {
                break;
            };
            z.clone_from(&c.z);
            best = Some((c, t));
        }
        let Some((c, mut t)) = best else {
            let (_, balance) = self.reduced.evaluate(&z);
            return Err(crate::error::Error::NotConverged {
                place: format!("chain '{}'", self.reduced.problem.chain.name()),
                iterations: 12,
                residual_position_m: balance.closure * self.reduced.problem.chain.scale().length,
                residual_torque: balance.torque / balance.loads.max(1e-9),
                load_factor: 0.0,
                last: self.reduced.coordinates(&z),
                limit: None,
            });
        };
        if t[m] < 0.0 {
            t *= -1.0;
        }
        self.reduced.family = self.family_at(&c, &t);
        if let Some(own) = self.tangent(&c.matrix, &t) {
            t = own.direction;
        }
        self.reduced.evaluate(&c.z);
        Ok(self.describe(&c, t))
    }

    /// Family to which a state on a curve along `t` belongs.
    fn family_at(&mut self, c: &Corrected, t: &DVector<f64>) -> Option<Arc<Family>> {
        match c.matrix.only_direction() {
            Some(_) => None,
            None => family_of(&mut self.reduced, &c.z, t).map(Arc::new),
        }
    }

    /// Tangent of the curve that is followed.
    pub fn tangent(&self, matrix: &CurveMatrix, guide: &DVector<f64>) -> Option<Tangent> {
        matrix.tangent(guide, self.reduced.family.as_deref())
    }

    /// A point from a corrected state, with the family as it is there; the system is evaluated
    /// there.
    pub fn describe(&mut self, c: &Corrected, direction: DVector<f64>) -> CurvePoint {
        let before = self.reduced.family.clone();
        if let Some(carried) = before.as_ref().and_then(|f| match &c.matrix {
            CurveMatrix::Dense(own) => f.carried(own, &direction),
            CurveMatrix::Swept(_) => None,
        }) {
            self.reduced.family = Some(Arc::new(carried));
        }
        let point = self.described(c, direction);
        self.reduced.family = before;
        point
    }

    fn described(&mut self, c: &Corrected, direction: DVector<f64>) -> CurvePoint {
        self.reduced.evaluate(&c.z);
        let held = self.reduced.stability(c, true);
        let dead = self.reduced.stability(c, false);
        let m = self.reduced.count();
        let rate = self
            .reduced
            .conjugate_row(&c.matrix.gradient())
            .dot(&direction);
        let change = direction[m] * self.reduced.sigma;
        let (load, displacement) = if self.reduced.is_load() {
            (change, rate)
        } else {
            (rate, change)
        };
        // Both in natural units.
        let (own, other) = (direction[m], self.reduced.natural_conjugate(rate));
        let (pushed, moved) = match self.reduced.is_load() {
            true => (own, other),
            false => (other, own),
        };
        let slope = if moved.abs() > LOCKED * pushed.abs() {
            load / displacement
        } else {
            f64::INFINITY
        };
        CurvePoint {
            parameter: self.reduced.value(&c.z),
            conjugate: self.reduced.conjugate(&c.z),
            equilibrium: self.reduced.equilibrium(c),
            slope,
            unstable: [held.unstable_modes, dead.unstable_modes],
            held,
            dead,
            arc: 0.0,
            z: c.z.clone(),
            tangent: direction,
            family: self.reduced.family.clone(),
        }
    }

    /// Largest step along `t`.
    pub fn longest(&self, t: &DVector<f64>) -> f64 {
        let chain = self.reduced.problem.chain;
        let turn = self.settings.largest_turn;
        let mut h = 2.0_f64;
        for (dx, c) in self.reduced.motion(t).iter().zip(chain.coordinates()) {
            let most = match c.kind {
                MotionKind::Revolute => turn,
                MotionKind::Prismatic => turn * chain.scale().length,
            };
            h = h.min(most / dx.abs().max(1e-300));
        }
        let (low, high) = self.settings.range;
        let width = high - low;
        let most = self
            .settings
            .largest_change
            .or_else(|| width.is_finite().then_some(width / 20.0));
        if let Some(most) = most.filter(|m| *m > 0.0) {
            let change = (t[self.reduced.count()] * self.reduced.sigma).abs();
            h = h.min(most / change.max(1e-300));
        }
        h
    }

    /// Follows the path from a point along its tangent. `known` tells that the first point is an
    /// ordinary one, whose test functions may be compared with the next.
    pub fn run(
        &mut self,
        start: CurvePoint,
        known: bool,
        branch: usize,
        stop: Stop<'_>,
    ) -> (Vec<CurvePoint>, BranchEnd) {
        let m = self.reduced.count();
        let mut points = vec![start];
        self.reduced.family.clone_from(&points[0].family);
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
            let back = distance(
                self.reduced.problem.chain,
                &self.reduced,
                &origin.z,
                &point.z,
            );
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
            self.reduced.family.clone_from(&point.family);
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

    /// The point between two neighbours at which a verdict changes, by halving.
    pub fn verdict_change(
        &mut self,
        here: &CurvePoint,
        there: &CurvePoint,
        verdict: &dyn Fn(&CurvePoint) -> bool,
    ) -> CurvePoint {
        self.reduced.family.clone_from(&here.family);
        let (mut low, mut high, mut best) = (0.0, 1.0, there.clone());
        for _ in 0..50 {
            let share = 0.5 * (low + high);
            let guess = &here.z + (&there.z - &here.z) * share;
            let t = &here.tangent;
            let Some(c) = self
                .reduced
                .correct(&guess, &Row::Plane(t, t.dot(&guess)), 10)
            else {
                break;
            };
            let point = self.describe(&c, t.clone());
            if verdict(&point) {
                high = share;
                best = point;
            } else {
                low = share;
            }
        }
        best
    }

    /// Test functions at a point.
    pub fn probe(&mut self, point: &CurvePoint) -> Option<Tangent> {
        let (_, _, matrix) = self.reduced.linearised(&point.z);
        self.tangent(&matrix, &point.tangent)
    }

    /// One step of length `h`, `None` if it is too long.
    fn step(&mut self, here: &CurvePoint, h: f64) -> Option<(CurvePoint, Tangent, usize)> {
        let t = &here.tangent;
        let straight = &here.z + t * h;
        let offset = t.dot(&straight);
        let predicted = self.reduced.followed(&here.z, straight);
        let c = self
            .reduced
            .correct(&predicted, &Row::Plane(t, offset), 8)?;
        if (&c.z - &predicted).norm() > 0.3 * h {
            return None;
        }
        let next = self.tangent(&c.matrix, t)?;
        if next.direction.dot(t) < 0.95 && h > 1e-5 {
            return None;
        }
        let iterations = c.iterations;
        let point = self.describe(&c, next.direction.clone());
        Some((point, next, iterations))
    }

    /// Whether the last step left the limits.
    fn beyond(&self, here: &CurvePoint, point: &CurvePoint) -> Option<BranchEnd> {
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
        let chain = self.reduced.problem.chain;
        let far = point
            .equilibrium
            .coordinates
            .iter()
            .zip(chain.coordinates())
            .any(|(x, c)| c.kind == MotionKind::Revolute && x.abs() > self.settings.largest_angle);
        far.then_some(BranchEnd::Angle)
    }

    /// The point at which the path crosses a limit between two points.
    fn cut(&mut self, here: &CurvePoint, point: &CurvePoint) -> Option<(CurvePoint, Tangent)> {
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
        let c = self.reduced.correct(&guess, &row, 10)?;
        if (&c.z - &guess).norm() > (&point.z - &here.z).norm() {
            return None;
        }
        let next = self.tangent(&c.matrix, &here.tangent)?;
        let last = self.describe(&c, next.direction.clone());
        Some((last, next))
    }

    /// First point of another branch at a bifurcation, and the path from there; `None` where it is known already.
    fn switch(
        &mut self,
        special: &Special,
        direction: &DVector<f64>,
        branches: &[Branch],
        branch: usize,
    ) -> std::result::Result<Option<(Vec<CurvePoint>, BranchEnd)>, NotFollowed> {
        let mut middle = special.point.clone();
        middle.tangent.clone_from(direction);
        let usual = 0.3 * self.longest(direction);
        for h in [usual, 0.2 * usual, 0.04 * usual, 3.0 * usual] {
            self.reduced.family.clone_from(&special.point.family);
            let straight = &middle.z + direction * h;
            let offset = direction.dot(&straight);
            let predicted = self.reduced.followed(&middle.z, straight);
            let Some(c) = self
                .reduced
                .correct(&predicted, &Row::Plane(direction, offset), 10)
            else {
                continue;
            };
            if (&c.z - &predicted).norm() > 0.4 * h {
                continue;
            }
            self.reduced.family = self.family_at(&c, direction);
            let Some(next) = self.tangent(&c.matrix, direction) else {
                continue;
            };
            let chain = self.reduced.problem.chain;
            let covered = branches.iter().any(|b| {
                b.points
                    .windows(2)
                    .any(|w| off_segment(chain, &self.reduced, &c.z, &w[0].z, &w[1].z) < 0.15 * h)
            });
            if covered {
                return Ok(None);
            }
            let second = self.describe(&c, next.direction.clone());
            if self.beyond(&middle, &second).is_some() {
                return Ok(Some((vec![middle], BranchEnd::Range)));
            }
            return Ok(Some(self.run_from(middle, second, branch)));
        }
        Err(NotFollowed)
    }

    fn run_from(
        &mut self,
        middle: CurvePoint,
        second: CurvePoint,
        branch: usize,
    ) -> (Vec<CurvePoint>, BranchEnd) {
        let origin = middle.z.clone();
        let (rest, mut end) = self.run_watching(second, branch, &origin);
        let mut points = vec![middle.clone()];
        points.extend(rest);
        if end == BranchEnd::Closed {
            // The last step went past the origin.
            points.pop();
            let mut last = middle;
            if let Some(before) = points.last() {
                last.tangent.clone_from(&before.tangent);
            }
            points.push(last);
        } else if points.len() < 2 {
            end = BranchEnd::Lost;
        }
        (points, end)
    }

    /// As [`Self::run`] from an ordinary point; ends as closed where the path returns to `origin`.
    fn run_watching(
        &mut self,
        second: CurvePoint,
        branch: usize,
        origin: &DVector<f64>,
    ) -> (Vec<CurvePoint>, BranchEnd) {
        let home = origin.clone();
        let chain = self.reduced.problem.chain;
        let scales: Vec<f64> = wraps(chain, &self.reduced);
        let offset = self.reduced.reactions();
        let first = second.z.clone();
        let came = std::cell::Cell::new(0_usize);
        let previous = std::cell::RefCell::new(first.clone());
        let returns = |p: &CurvePoint| {
            came.set(came.get() + 1);
            let last = previous.replace(p.z.clone());
            let span = wrapped(&p.z, &last, &scales, offset).norm();
            came.get() > 5 && segment_distance(&home, &last, &p.z, &scales, offset) < 0.05 * span
        };
        let (points, end) = self.run(second, true, branch, Some(&returns));
        let end = if end == BranchEnd::Found {
            BranchEnd::Closed
        } else {
            end
        };
        (points, end)
    }

    /// Books limit and bifurcation points between two points; false if the second lies on another
    /// branch.
    fn look_between(
        &mut self,
        here: &CurvePoint,
        point: &CurvePoint,
        before: Option<&Tangent>,
        after: &Tangent,
        branch: usize,
    ) -> bool {
        let Some(found) = bifurcation::between(self, here, point, before, after) else {
            return false;
        };
        for mut special in found {
            let chain = self.reduced.problem.chain;
            let same = self.specials.iter().position(|s| {
                let bifurcations = s.kind.is_bifurcation() == special.kind.is_bifurcation();
                let apart = distance(chain, &self.reduced, &s.point.z, &special.point.z);
                bifurcations && apart < (10.0 * (s.accuracy + special.accuracy)).max(1e-7)
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
