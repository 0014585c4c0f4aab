//! Limit points and bifurcation points between two steps of a curve: found, located, classified.
//!
//! Along a path with tangent `t`, a displacement (or load) limit is a zero of the parameter's (or
//! its conjugate's) rate; a simple bifurcation a change of sign of `det [G_z; t^T]`. Bifurcation
//! points are refined by Newton on
//!
//! ```text
//! G(z) + beta psi = 0,   G_z^T psi = 0,   psi^T psi = 1
//! ```
//!
//! which is regular there, and told apart by the second derivatives along the null vectors.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::continuation::branches::CurvePoint;
use crate::continuation::curve_matrix::Tangent;
use crate::continuation::reduced::{Corrected, Reduced, Row};
use crate::continuation::singular_point::{refine, tangents};
use crate::continuation::tracer::Tracer;

/// What is special about a point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpecialKind {
    /// Limit point of the load: under a dead load the chain jumps (snap-through).
    LoadLimit,
    /// Limit point of the displacement: under prescribed motion the chain jumps (snap-back).
    DisplacementLimit,
    /// Two branches cross, one of them turns back there: buckling of a symmetric chain.
    Pitchfork,
    /// Two branches cross and both go on.
    Transcritical,
    /// Several modes become critical together.
    Multiple {
        /// Number of independent critical modes.
        modes: usize,
    },
}

impl SpecialKind {
    /// True where branches cross.
    #[must_use]
    pub fn is_bifurcation(self) -> bool {
        !matches!(self, Self::LoadLimit | Self::DisplacementLimit)
    }
}

/// A limit point or a bifurcation point.
#[derive(Clone, Debug)]
pub struct Special {
    /// Which kind.
    pub kind: SpecialKind,
    /// The equilibrium there.
    pub point: CurvePoint,
    /// Motion of all coordinates (m, rad; largest component 1): of the critical mode at a
    /// bifurcation, along the curve at a limit point.
    pub mode: Vec<f64>,
    /// Uncertainty of the place in natural units.
    pub accuracy: f64,
    /// Branches through it: indices into [`crate::Curves::branches`].
    pub branches: Vec<usize>,
    /// True if the curve is stable on one side of it at least (for a limit point: under the kind of
    /// load that it limits).
    pub stable_side: bool,
    /// A branch crosses here whose first step did not converge: it is not among the branches.
    pub lost_branch: bool,
    /// Directions of the branches other than the one on which it was found.
    pub(crate) directions: Vec<DVector<f64>>,
}

/// States between two points of a curve, by their share of the way.
struct Segment<'s> {
    here: &'s CurvePoint,
    there: &'s CurvePoint,
}

impl Segment<'_> {
    fn at(&self, reduced: &mut Reduced<'_, '_>, share: f64) -> Option<(Corrected, Tangent)> {
        let t = &self.here.tangent;
        let guess = &self.here.z + (&self.there.z - &self.here.z) * share;
        let c = reduced.correct(&guess, &Row::Plane(t, t.dot(&guess)), 10)?;
        if (&c.z - &guess).norm() > (&self.there.z - &self.here.z).norm() {
            return None;
        }
        let next = c.matrix.tangent(t, reduced.family.as_deref())?;
        Some((c, next))
    }

    /// Zero of a function of the state (Illinois), as a share of the way.
    fn root(
        &self,
        reduced: &mut Reduced<'_, '_>,
        mut low: (f64, f64),
        mut high: (f64, f64),
        width: f64,
        f: &dyn Fn(&mut Reduced<'_, '_>, &Corrected, &Tangent) -> f64,
    ) -> f64 {
        let mut side = 0;
        for _ in 0..60 {
            if (high.0 - low.0).abs() < width || low.1 == 0.0 || high.1 == 0.0 {
                break;
            }
            let mut share = high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1);
            if !(share > low.0 && share < high.0) {
                share = 0.5 * (low.0 + high.0);
            }
            let value = match self.at(reduced, share) {
                Some((c, t)) => f(reduced, &c, &t),
                None => break,
            };
            if !value.is_finite() {
                break;
            }
            if value == 0.0 {
                return share;
            }
            if (value > 0.0) == (high.1 > 0.0) {
                high = (share, value);
                if side == 1 {
                    low.1 *= 0.5;
                }
                side = 1;
            } else {
                low = (share, value);
                if side == -1 {
                    high.1 *= 0.5;
                }
                side = -1;
            }
        }
        if low.1.abs() < high.1.abs() {
            low.0
        } else {
            high.0
        }
    }
}

/// Limit and bifurcation points between two neighbouring points of a curve; `None` if the test
/// functions promise a bifurcation that is not there: the step jumped to another branch nearby.
pub(crate) fn between(
    tracer: &mut Tracer<'_, '_, '_>,
    here: &CurvePoint,
    there: &CurvePoint,
    before: Option<&Tangent>,
    after: &Tangent,
) -> Option<Vec<Special>> {
    let mut found: Vec<(f64, Special)> = Vec::new();
    let segment = Segment { here, there };
    let m = tracer.reduced.count();
    if let Some(before) = before {
        let u = |k: usize| here.unstable[k].abs_diff(there.unstable[k]);
        let even = before.sign == after.sign && (u(0) > 1 || u(1) > 1);
        if before.sign != after.sign || even {
            match bifurcation(tracer, &segment, before, after, even) {
                Some(special) => found.push(special),
                None if even => {}
                None => return None,
            }
        }
    }
    // Rates of the parameter and of its conjugate.
    let mut shares: Vec<(bool, f64)> = Vec::new();
    let (_, _, first) = tracer.reduced.gradient(&here.z);
    let (_, _, last) = tracer.reduced.gradient(&there.z);
    for conjugate in [false, true] {
        let rate = |reduced: &Reduced<'_, '_>, gradient: &DVector<f64>, t: &DVector<f64>| {
            if conjugate {
                let row = reduced.conjugate_row(gradient);
                row.dot(t) / row.norm().max(f64::MIN_POSITIVE)
            } else {
                t[m]
            }
        };
        let a = rate(&tracer.reduced, &first, &here.tangent);
        let b = rate(&tracer.reduced, &last, &there.tangent);
        // A rate that is zero throughout (a locked end) has no limit point. A zero right at the
        // first point was found in the step before.
        if a.abs() < 1e-9 || (b.abs() < 1e-9 && a.abs() < 1e-6) {
            continue;
        }
        let root = |reduced: &mut Reduced<'_, '_>, low: (f64, f64), high: (f64, f64)| {
            segment.root(reduced, low, high, 1e-13, &|reduced, c, t| {
                rate(reduced, &c.matrix.gradient(), &t.direction)
            })
        };
        if b.abs() < 1e-9 {
            shares.push((conjugate, 1.0));
        } else if a * b < 0.0 {
            shares.push((conjugate, root(&mut tracer.reduced, (0.0, a), (1.0, b))));
        } else if a.abs().min(b.abs()) < 0.5 {
            // Two limit points within one step: the rate dips through zero and comes back.
            let f = |reduced: &mut Reduced<'_, '_>, share: f64| {
                let (c, t) = segment.at(reduced, share)?;
                Some(rate(reduced, &c.matrix.gradient(), &t.direction))
            };
            if let Some((share, value)) = dip(&mut tracer.reduced, a, b, &f)
                && value * a < 0.0
            {
                let middle = (share, value);
                shares.push((conjugate, root(&mut tracer.reduced, (0.0, a), middle)));
                shares.push((conjugate, root(&mut tracer.reduced, middle, (1.0, b))));
            }
        }
    }
    for (conjugate, share) in shares {
        let Some((c, t)) = segment.at(&mut tracer.reduced, share) else {
            continue;
        };
        // The branch that turns back at a pitchfork has its limit there.
        let step = (&there.z - &here.z).norm();
        let pitchfork = found
            .iter()
            .any(|(_, s)| (&s.point.z - &c.z).norm() < 1e-5 * (1.0 + step) + 10.0 * s.accuracy);
        let known = tracer
            .specials
            .iter()
            .any(|s| s.kind.is_bifurcation() && (&s.point.z - &c.z).norm() < 1e-5 * (1.0 + step));
        if pitchfork || known {
            continue;
        }
        let load = conjugate != tracer.reduced.is_load();
        let mode = largest_one(tracer.reduced.motion(&t.direction));
        let stable = |p: &CurvePoint| if load { p.dead.stable } else { p.held.stable };
        let point = tracer.describe(&c, t.direction);
        found.push((
            share,
            Special {
                kind: if load {
                    SpecialKind::LoadLimit
                } else {
                    SpecialKind::DisplacementLimit
                },
                point,
                mode,
                accuracy: 1e-12,
                branches: Vec::new(),
                lost_branch: false,
                stable_side: stable(here) || stable(there),
                directions: Vec::new(),
            },
        ));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(found.into_iter().map(|f| f.1).collect())
}

/// Where a function of the share of the way, `a` and `b` of one sign at the ends, comes nearest to
/// zero or beyond it: parabolas through three values, a few times.
fn dip(
    reduced: &mut Reduced<'_, '_>,
    a: f64,
    b: f64,
    f: &dyn Fn(&mut Reduced<'_, '_>, f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let (mut low, mut high) = ((0.0, a), (1.0, b));
    let mut middle = (0.5, f(reduced, 0.5)?);
    for _ in 0..8 {
        if middle.1 * a < 0.0 {
            return Some(middle);
        }
        let (d1, d2) = (
            (middle.1 - low.1) / (middle.0 - low.0),
            (high.1 - middle.1) / (high.0 - middle.0),
        );
        let bend = (d2 - d1) / (high.0 - low.0);
        // Nearest to zero must be inside, and the parabola must come near it.
        if bend * a <= 0.0 || d1 * a >= 0.0 || d2 * a <= 0.0 {
            return None;
        }
        let vertex = 0.5 * (low.0 + middle.0) - 0.5 * d1 / bend;
        if !(vertex > low.0 && vertex < high.0) || (vertex - middle.0).abs() < 1e-4 {
            return None;
        }
        let next = (vertex, f(reduced, vertex)?);
        let (left, right) = if next.0 < middle.0 {
            (next, middle)
        } else {
            (middle, next)
        };
        if left.1 * a < right.1 * a {
            (middle, high) = (left, right);
        } else {
            (low, middle) = (left, right);
        }
    }
    None
}

/// Scales a motion so that its largest component is 1.
fn largest_one(motion: Vec<f64>) -> Vec<f64> {
    let most = motion
        .iter()
        .copied()
        .fold(0.0_f64, |m, x| if x.abs() > m.abs() { x } else { m });
    if most == 0.0 {
        return motion;
    }
    motion.iter().map(|x| x / most).collect()
}

fn bifurcation(
    tracer: &mut Tracer<'_, '_, '_>,
    segment: &Segment<'_>,
    before: &Tangent,
    after: &Tangent,
    even: bool,
) -> Option<(f64, Special)> {
    let step = (&segment.there.z - &segment.here.z).norm();
    let share = if even {
        // Counted modes change without a change of sign: halve on the count.
        let count = segment.here.unstable;
        let differs = move |reduced: &mut Reduced<'_, '_>, c: &Corrected| {
            reduced.evaluate(&c.z);
            let same = (0..2).all(|k| {
                let modes = reduced.stability(c, k == 0).unstable_modes;
                modes == count[k]
            });
            if same { 1.0 } else { -1.0 }
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let (c, _) = segment.at(&mut tracer.reduced, middle)?;
            if differs(&mut tracer.reduced, &c) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    } else {
        let reference = before.logarithm.max(after.logarithm);
        let value = move |t: &Tangent| t.sign * (t.logarithm - reference).exp();
        segment.root(
            &mut tracer.reduced,
            (0.0, value(before)),
            (1.0, value(after)),
            1e-9,
            &move |_, _, t| value(t),
        )
    };
    // Right at the point the tangent is undefined: beside it the corrector still works.
    let guess = match segment.at(&mut tracer.reduced, share) {
        Some((c, _)) => c.z,
        None => &segment.here.z + (&segment.there.z - &segment.here.z) * share,
    };
    tracer.reduced.dense = true;
    let special = classified(tracer, segment, &guess, step, even);
    tracer.reduced.dense = false;
    special.map(|special| (share, special))
}

/// Which kind of bifurcation is at a place, and which branches cross there; with dense matrices.
fn classified(
    tracer: &mut Tracer<'_, '_, '_>,
    segment: &Segment<'_>,
    guess: &DVector<f64>,
    step: f64,
    even: bool,
) -> Option<Special> {
    // Along a family the extended system is singular; the test function alone has found the place.
    let family = tracer.reduced.family.clone();
    let refined = if even || family.is_some() {
        None
    } else {
        refine(&mut tracer.reduced, guess).filter(|z| (z - guess).norm() < 0.5 * step)
    };
    let refined_missing = refined.is_none();
    let accuracy = if refined.is_some() { 1e-10 } else { 1e-6 };
    let z = refined.unwrap_or_else(|| guess.clone());
    let (_, balance, matrix) = tracer.reduced.linearised_densely(&z);
    let found = match &family {
        Some(family) => tracer.reduced.null_directions(&family.beside(&matrix)),
        None => tracer.reduced.null_directions(&matrix),
    };
    let whole = tracer.reduced.whole(matrix.clone());
    if found.values.is_empty() || (refined_missing && found.count(0, 1e-5) < 2) {
        return None;
    }
    let null: Vec<DVector<f64>> = (0..found.count(2, 1e-5))
        .map(|k| found.right.column(k).into_owned())
        .collect();
    let m = tracer.reduced.count();
    let mean = (&segment.here.tangent + &segment.there.tangent).normalize();
    // The path's own direction within the null space, and what is left of it.
    let own = |vectors: &[DVector<f64>]| {
        let mut sum = DVector::zeros(m + 1);
        for v in vectors {
            sum += v * v.dot(&mean);
        }
        let size = sum.norm();
        if size > 1e-12 {
            sum / size
        } else {
            mean.clone()
        }
    };
    let (kind, path, directions, mode) = if null.len() == 2 {
        let psi = match &family {
            Some(family) => {
                let beside = family.beside_left(&matrix);
                tracer.reduced.null_directions(&beside).left
            }
            None => found.left,
        };
        let psi = psi.column(0).into_owned();
        let (path, other) = tangents(&mut tracer.reduced, &z, &psi, &null, &own(&null));
        let flat = |d: &DVector<f64>| d[m].abs() < 1e-4;
        let kind = if flat(&path) || flat(&other) {
            SpecialKind::Pitchfork
        } else {
            SpecialKind::Transcritical
        };
        // The mode is the null motion at a fixed parameter; where both keep it, the other branch.
        let mode = if path[m].abs() > 1e-9 {
            &other - &path * (other[m] / path[m])
        } else {
            other.clone()
        };
        (kind, path, vec![other], mode)
    } else {
        let path = own(&null);
        let mut rest = Vec::new();
        for v in &null {
            let mut v = v - &path * path.dot(v);
            for d in &rest {
                let d: &DVector<f64> = d;
                v -= d * d.dot(&v);
            }
            if v.norm() > 1e-3 {
                rest.push(v.normalize());
            }
        }
        let mode = rest.first().cloned().unwrap_or_else(|| path.clone());
        let modes = null.len() - 1;
        (SpecialKind::Multiple { modes }, path, rest, mode)
    };
    let corrected = Corrected {
        z,
        matrix: whole,
        balance,
        iterations: 0,
    };
    let mode = largest_one(tracer.reduced.motion(&mode));
    let point = tracer.describe(&corrected, path);
    let (here, there) = (segment.here, segment.there);
    Some(Special {
        kind,
        point,
        mode,
        accuracy,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: here.held.stable || there.held.stable,
        directions,
    })
}
