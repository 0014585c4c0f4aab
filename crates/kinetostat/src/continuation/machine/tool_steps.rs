//! Steps of a machine's tool along a motion or under a load, for searches that need no special points.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::continuation::curve::BranchEnd;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::error::Result;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::state::MechanismState;
use crate::spatial::{Twist, moved, pose_residual};

/// Steps that may fail besides as many as there may be points.
const LOST_STEPS: usize = 20;

/// Steps of a search between two points.
const BISECTIONS: usize = 50;

/// An equilibrium to which a step leads.
#[derive(Clone, Debug)]
pub(crate) struct ToolPoint {
    /// Displacement from the nominal target (m, rad) or load factor.
    pub parameter: f64,
    /// Force along the displacement (N, N m; without the dead wrench), or displacement along the load pattern (J per unit
    /// factor).
    pub conjugate: f64,
    /// Every shape and platform stays where it is under the load that is reached, as a dead load.
    pub dead: bool,
    pub equilibrium: MechanismEquilibrium,
    tangent: ToolTangent,
    factor: f64,
}

/// Direction of the path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToolTangent {
    /// Motion of the tool per step (scaled: m and rad times the natural length).
    motion: Vector6<f64>,
    /// Change of the load factor per step.
    rate: f64,
}

/// Direction in which the load changes and the tool does not move.
const LOAD_ALONE: ToolTangent = ToolTangent {
    motion: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    rate: 1.0,
};

impl ToolPoint {
    /// Orients the tangent along the tool's last motion, whatever the load did on the step: over a limit of the load
    /// its rate changes its sign, and the motion continues.
    pub(crate) fn onwards_from(mut self, before: &Self) -> Self {
        let ToolTangent { motion, rate } = self.tangent;
        if motion.dot(&before.tangent.motion) < 0.0 {
            self.tangent = ToolTangent {
                motion: -motion,
                rate: -rate,
            };
        }
        self
    }
}

impl ToolConditions<'_> {
    /// The first point of steps along a driven motion.
    pub(crate) fn first(&self, displacement: f64) -> Result<ToolPoint> {
        let (e, factor) = self.first_driven(displacement)?;
        Ok(self.point(e, factor, &self.along_pattern()))
    }

    /// Direction of a motion along the load pattern under a constant load.
    fn along_pattern(&self) -> ToolTangent {
        ToolTangent {
            motion: self.pattern.0,
            rate: 0.0,
        }
    }

    /// A point with its tangent, which goes on as `before` goes.
    pub(crate) fn point(
        &self,
        e: MechanismEquilibrium,
        factor: f64,
        before: &ToolTangent,
    ) -> ToolPoint {
        let tangent = self.tangent(&e, before);
        let motion = self.motion(&e.tool);
        let displacement = self.displacement(&motion);
        let (parameter, conjugate) = match self.by_motion {
            true => (displacement, factor),
            false => (factor, displacement),
        };
        ToolPoint {
            parameter,
            conjugate,
            dead: self.machine_stability(&e, false).stable,
            equilibrium: e,
            tangent,
            factor,
        }
    }

    /// Null vector of `[K, -P]` in the motions of the tool that goes on as `before`; its motion has
    /// the length one.
    pub(crate) fn tangent(&self, e: &MechanismEquilibrium, before: &ToolTangent) -> ToolTangent {
        let possible = self.possible(e, &self.motions);
        let n = possible.ncols();
        let k = possible.transpose() * self.scaled_stiffness(e) * &possible;
        let load = DVector::from_fn(6, |i, _| self.pattern.0[i] / self.unit(i));
        let load = possible.transpose() * load;
        // One unit for all points, or the tangent's sense would be lost where the stiffness is.
        let (stiff, push) = (self.posture.mechanism.scale().stiffness, load.norm());
        if n == 0 || push == 0.0 {
            return LOAD_ALONE;
        }
        let unit = stiff / push;
        let mut rows = DMatrix::zeros(n + 1, n + 1);
        rows.view_mut((0, 0), (n, n)).copy_from(&(k / stiff));
        rows.view_mut((0, n), (n, 1)).copy_from(&(-&load / push));
        let own = crate::linalg::singular_values::SingularValues::of(&rows);
        let most = own.largest();
        let was = DVector::from_fn(n + 1, |i, _| match i < n {
            true => possible.column(i).dot(&before.motion),
            false => before.rate / unit,
        });
        let mut next = DVector::zeros(n + 1);
        for (own, value) in own.right.column_iter().zip(&own.values) {
            if *value <= 1e-9 * most {
                let share = own.dot(&was);
                next += own * share;
            }
        }
        if next.norm() <= 1e-9 * was.norm() {
            // A flat posture: the load starts to move the tool where nothing holds it yet.
            let push = load.normalize();
            next.fill(0.0);
            for (own, value) in own.right.column_iter().zip(&own.values) {
                if *value <= 1e-9 * most {
                    next += own * own.rows(0, n).dot(&push);
                }
            }
            next[n] = 0.0;
        }
        let motion = &possible * next.rows(0, n);
        let size = motion.norm();
        if size == 0.0 {
            return *before;
        }
        let motion = Vector6::from_fn(|i, _| motion[i] / size);
        ToolTangent {
            motion,
            rate: next[n] * unit / size,
        }
    }

    /// The equilibrium a step `by` (m, scaled) along the path from a point.
    pub(crate) fn step(&self, from: &ToolPoint, by: f64) -> Option<ToolPoint> {
        let ToolTangent {
            motion: along,
            rate,
        } = &from.tangent;
        let mut state = from.equilibrium.state.clone();
        let tool = self.posture.mechanism.tool();
        let motion = self.unscaled(along) * by;
        let row = Vector6::from_fn(|i, _| along[i] * self.unit(i));
        let goal = row.dot(&self.motion(&state.platforms[tool])) + by;
        state.platforms[tool] = moved(&state.platforms[tool], &Twist(motion));
        let predicted = state.platforms[tool];
        let wrench = from.equilibrium.wrench + self.pattern * (rate * by);
        let guide = self.guide(Some((&row, goal)));
        let (e, factor) = self.converge(state, wrench, guide, false).ok()?;
        let off = pose_residual(&e.tool, &predicted).0;
        let off = Vector6::from_fn(|i, _| off[i] * self.unit(i)).norm();
        (off <= 0.5 * by.abs() + 1e-12 * self.length).then(|| self.point(e, factor, &from.tangent))
    }

    /// The equilibrium at a value of the parameter (or of its conjugate), from a point near it.
    fn at(&self, from: &ToolPoint, value: f64, motion: bool) -> Option<ToolPoint> {
        let state = from.equilibrium.state.clone();
        let wrench = from.equilibrium.wrench;
        let (e, factor) = if motion {
            let row = self.pattern.0;
            self.converge(state, wrench, self.guide(Some((&row, value))), false)
        } else {
            let wrench = wrench + self.pattern * (value - from.factor);
            self.converge(state, wrench, self.guide(None), false)
        }
        .ok()?;
        Some(self.point(e, factor, &from.tangent))
    }

    /// Points in one direction from the start, without it.
    pub(crate) fn steps_from(&self, start: &ToolPoint, sign: f64) -> (Vec<ToolPoint>, BranchEnd) {
        let (low, high) = self.settings.range;
        let (least, most) = self.settings.conjugate_range;
        let change = (self.settings.largest_change).unwrap_or(0.05 * (high - low));
        let rate = |p: &ToolPoint| {
            let along = self.displacement(&self.unscaled(&p.tangent.motion));
            let by = if self.by_motion {
                along
            } else {
                p.tangent.rate
            };
            by.abs()
        };
        let edge = if sign > 0.0 { high } else { low };
        if start.parameter == edge || start.tangent.motion.norm() == 0.0 {
            return (Vec::new(), BranchEnd::Range);
        }
        // For a load that starts at zero, the machine's size sets the step.
        let largest = match rate(start) * self.length > 1e-9 * change {
            true => change / rate(start),
            false => 0.02 * self.length,
        };
        let least_step = self.settings.smallest_step * largest.min(self.length);
        // Turns of the tangent are seen in units in which it starts at 45 degrees, if it has any
        // stiffness to speak of.
        let soft = 1e-4 * self.posture.mechanism.scale().stiffness / self.pattern.0.norm();
        let unit = start.tangent.rate.abs().max(soft);
        let angle = |a: &ToolPoint, b: &ToolPoint| {
            let (x, y) = (&a.tangent, &b.tangent);
            let dot = x.motion.dot(&y.motion) + x.rate * y.rate / (unit * unit);
            let size = |t: &ToolTangent| (1.0 + (t.rate / unit).powi(2)).sqrt();
            (dot / (size(x) * size(y))).clamp(-1.0, 1.0).acos()
        };
        // Below these units a limit of the load would be passed unseen: there the load that a step
        // gained must be that of its tangents.
        let nothing = 1e-6 * soft;
        let resolved = |a: &ToolPoint, b: &ToolPoint, by: f64| {
            let (x, y) = (a.tangent.rate, b.tangent.rate);
            let most = x.abs().max(y.abs());
            let apart = (b.factor - a.factor) / by - 0.5 * (x + y);
            x == 0.0 || most > soft || most < nothing || apart.abs() < 0.1 * most
        };
        let mut points: Vec<ToolPoint> = Vec::new();
        let mut by = largest;
        let mut here = start.clone();
        let mut lost = 0;
        loop {
            if points.len() >= self.settings.points {
                return (points, BranchEnd::Points);
            }
            if lost > self.settings.points + LOST_STEPS {
                return (points, BranchEnd::Stalled);
            }
            by = by.min(change / rate(&here).max(1e-300)).min(4.0 * largest);
            let next = self
                .step(&here, sign * by)
                .filter(|p| angle(&here, p) < 0.35 && resolved(&here, p, sign * by));
            let Some(next) = next else {
                by *= 0.5;
                lost += 1;
                if by < least_step {
                    return (points, BranchEnd::Lost);
                }
                continue;
            };
            if next.parameter > high || next.parameter < low {
                let edge = if next.parameter > high { high } else { low };
                if let Some(p) = self.between(&here, sign * by, |p| p.parameter - edge) {
                    points.push(self.at(&p, edge, self.by_motion).unwrap_or(p));
                }
                return (points, BranchEnd::Range);
            }
            if next.conjugate > most || next.conjugate < least {
                return (points, BranchEnd::Range);
            }
            if angle(&here, &next) < 0.1 {
                by *= 1.5;
            }
            here = next.clone();
            points.push(next);
        }
    }

    /// Zero of a quantity between a point and the one a step ahead.
    pub(crate) fn between(
        &self,
        from: &ToolPoint,
        step: f64,
        of: impl Fn(&ToolPoint) -> f64,
    ) -> Option<ToolPoint> {
        let far = self.step(from, step)?;
        let (mut a, mut b) = ((0.0, of(from)), (step, of(&far)));
        let mut best = if a.1.abs() < b.1.abs() {
            from.clone()
        } else {
            far
        };
        let size = a.1.abs().max(b.1.abs());
        for _ in 0..BISECTIONS {
            if of(&best).abs() <= 1e-12 * size || (a.0 - b.0).abs() <= 1e-14 * step.abs() {
                break;
            }
            let s = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            let Some(next) = self.step(from, s) else {
                break;
            };
            let f = of(&next);
            // Illinois: false position with halving.
            if f * b.1 < 0.0 {
                a = b;
            } else {
                a.1 *= 0.5;
            }
            b = (s, f);
            if f.abs() < of(&best).abs() {
                best = next;
            }
        }
        Some(best)
    }

    /// Length of the step from one point to the next along its tangent.
    pub(crate) fn step_between(&self, a: &ToolPoint, b: &ToolPoint) -> f64 {
        let (x, y) = (
            self.motion(&a.equilibrium.tool),
            self.motion(&b.equilibrium.tool),
        );
        let along = &a.tangent.motion;
        (0..6)
            .map(|k| along[k] * (y[k] - x[k]) * self.unit(k))
            .sum()
    }

    /// Extremum of the load between two points.
    pub(crate) fn load_limit(&self, a: &ToolPoint, b: &ToolPoint, step: f64) -> Option<ToolPoint> {
        let load = |p: &ToolPoint| p.tangent.rate;
        (load(a) * load(b) < 0.0)
            .then(|| self.between(a, step, load))
            .flatten()
    }

    /// Point at which the path from rest without load reaches the whole load, if it does before a limit; else the first
    /// limit point of the load at which the machine becomes unstable. `none` tells which of them are rounding.
    pub(crate) fn growing(
        &self,
        start: MechanismState,
        none: impl Fn(&ToolPoint) -> bool,
    ) -> Result<(Option<ToolPoint>, Option<ToolPoint>)> {
        let (e, factor) = self.first_loaded(0.0, start)?;
        let start = self.point(e, factor, &LOAD_ALONE);
        let (ahead, end) = self.steps_from(&start, 1.0);
        let last = ahead.last().cloned();
        let points: Vec<ToolPoint> = [start].into_iter().chain(ahead).collect();
        let first = points
            .windows(2)
            .filter(|w| w[0].dead != w[1].dead)
            .find_map(|w| {
                let step = self.step_between(&w[0], &w[1]);
                let limit = (step >= 0.0).then(|| self.load_limit(&w[0], &w[1], step));
                let limit = limit.flatten().filter(|p| !none(p))?;
                Some((&w[0], limit))
            });
        let whole = self.settings.range.1;
        Ok(match first {
            // A step may lead over a limit that lies beyond the whole load, and end below it: the
            // whole was carried before.
            Some((before, limit)) if limit.parameter >= whole => {
                let step = self.step_between(before, &limit);
                let there = self.between(before, step, |p| p.parameter - whole);
                (there, None)
            }
            Some((_, limit)) => (None, Some(limit)),
            None => {
                let reached = |p: &ToolPoint| end == BranchEnd::Range && p.parameter == whole;
                (last.filter(reached), None)
            }
        })
    }

    /// States where the load along a driven motion vanishes on the path in both directions from an equilibrium (without
    /// one, from the machine held where it is commanded), and the ends of that path.
    pub(crate) fn unloaded(&self, from: Option<&MechanismEquilibrium>) -> [Vec<MechanismState>; 2] {
        let ahead = self.along_pattern();
        let start = match from {
            Some(e) => Ok(self.point(e.clone(), 0.0, &ahead)),
            None => self.first(0.0),
        };
        let (mut crossings, mut ends) = (Vec::new(), Vec::new());
        let Ok(start) = start else {
            return [crossings, ends];
        };
        for sign in [-1.0, 1.0] {
            let (points, _) = self.steps_from(&start, sign);
            let from_start: Vec<&ToolPoint> = [&start].into_iter().chain(&points).collect();
            for pair in from_start.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                if a.factor * b.factor < 0.0 {
                    let near = self.between(a, self.step_between(a, b), |p| p.factor);
                    crossings.extend(near.map(|p| p.equilibrium.state));
                }
            }
            ends.extend(points.last().map(|p| p.equilibrium.state.clone()));
        }
        [crossings, ends]
    }
}
