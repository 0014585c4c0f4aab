//! Limit points and bifurcation points between two neighbouring points of a curve.
//!
//! Along a path with tangent `t`, a displacement (or load) limit is a zero of the parameter's (or its conjugate's) rate;
//! a simple bifurcation a change of sign of `det [G_z; t^T]`. Bifurcation points are refined by Newton on
//!
//! ```text
//! G(z) + beta psi = 0,   G_z^T psi = 0,   psi^T psi = 1                  Seydel, 5.4
//! ```
//!
//! which is regular there, and distinguished by the second derivatives along the null vectors.

use nalgebra::DVector;

use crate::continuation::curve::{CurveStability, Special, SpecialKind};
use crate::continuation::linear::tangent::Tangent;
use crate::continuation::tracing::bifurcation::{bifurcation, stability_change};
use crate::continuation::tracing::describe::describe;
use crate::continuation::tracing::segment::{Sample, Segment, dip, largest_one};
use crate::continuation::tracing::system::{Corrected, CurveSystem, Point, SpecialPoint};

/// A rate below this is zero: rates are those of unit tangents in comparable units.
pub(crate) const NO_RATE: f64 = 1e-9;

/// Limit and bifurcation points between two neighbouring points of a curve; `None` if the test
/// functions promise a bifurcation that is not there: the step jumped to another branch nearby.
pub(crate) fn between<S: CurveSystem>(
    system: &mut S,
    known: &[SpecialPoint<S>],
    here: &Point<S>,
    there: &Point<S>,
    before: Option<&Tangent>,
    after: &Tangent,
) -> Option<Vec<SpecialPoint<S>>> {
    let mut found: Vec<(f64, SpecialPoint<S>)> = Vec::new();
    let segment = Segment { here, there };
    if let Some(before) = before {
        let u = |k: usize| here.unstable[k].abs_diff(there.unstable[k]);
        let even = before.sign == after.sign && (u(0) > 1 || u(1) > 1);
        let hidden =
            S::condensed_modes(&here.equilibrium) != S::condensed_modes(&there.equilibrium);
        if hidden {
            found.extend(stability_change(system, &segment));
        } else if before.sign != after.sign || even {
            match bifurcation(system, &segment, before, after, even) {
                Some(special) => found.push(special),
                None if even => {}
                None => return None,
            }
        }
    }
    for (conjugate, share) in limits(system, &segment) {
        let Some((c, t)) = segment.at(system, share) else {
            continue;
        };
        // The branch that turns back at a pitchfork has its limit there.
        let step = (&there.z - &here.z).norm();
        let apart = |s: &SpecialPoint<S>| (&s.point.z - &c.z).norm();
        let least = 1e-5 * (1.0 + step);
        let pitchfork = found
            .iter()
            .any(|(_, s)| apart(s) < least + 10.0 * s.accuracy);
        let known = known
            .iter()
            .any(|s| s.kind.is_bifurcation() && apart(s) < least);
        if !pitchfork && !known {
            found.push((share, limit_point(system, &segment, conjugate, &c, t)));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(found.into_iter().map(|f| f.1).collect())
}

/// Rate of the parameter or of its conjugate along a tangent, in comparable units.
fn rate<S: CurveSystem>(
    system: &S,
    conjugate: bool,
    gradient: &DVector<f64>,
    t: &DVector<f64>,
) -> f64 {
    if conjugate {
        let row = system.conjugate_row(gradient);
        row.dot(t) / row.norm().max(f64::MIN_POSITIVE)
    } else {
        t[t.len() - 1]
    }
}

/// Shares of a segment at which the parameter or (`true`) its conjugate has an extreme.
fn limits<S: CurveSystem>(system: &mut S, segment: &Segment<'_, S>) -> Vec<(bool, f64)> {
    let mut shares: Vec<(bool, f64)> = Vec::new();
    let first = system.gradient(&segment.here.z);
    let last = system.gradient(&segment.there.z);
    for conjugate in [false, true] {
        let a = rate(system, conjugate, &first, &segment.here.tangent);
        let b = rate(system, conjugate, &last, &segment.there.tangent);
        // A rate that is zero throughout (a locked end) has no limit point. A zero right at the
        // first point was found in the step before.
        if a.abs() < NO_RATE || (b.abs() < NO_RATE && a.abs() < 1e-6) {
            continue;
        }
        let here = |system: &mut S, c: &Corrected, t: &Tangent| {
            rate(system, conjugate, &c.matrix.gradient(), &t.direction)
        };
        let [first, last] = [Sample::new(0.0, a), Sample::new(1.0, b)];
        let root = |system: &mut S, low: Sample, high: Sample| {
            segment.root(system, low, high, 1e-13, &here)
        };
        if b.abs() < NO_RATE {
            shares.push((conjugate, 1.0));
        } else if a * b < 0.0 {
            shares.push((conjugate, root(system, first, last)));
        } else if a.abs().min(b.abs()) < 0.5 {
            // Two limit points within one step: the rate dips through zero and comes back.
            let f = |system: &mut S, share: f64| {
                let (c, t) = segment.at(system, share)?;
                Some(here(system, &c, &t))
            };
            if let Some(middle) = dip(system, a, b, &f)
                && middle.value * a < 0.0
            {
                shares.push((conjugate, root(system, first, middle)));
                shares.push((conjugate, root(system, middle, last)));
            }
        }
    }
    shares
}

/// A limit point from the state there and its tangent.
fn limit_point<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    conjugate: bool,
    c: &Corrected,
    t: Tangent,
) -> SpecialPoint<S> {
    let load = conjugate != system.is_load();
    let stable = |p: &Point<S>| match load {
        true => p.dead_load.stable(),
        false => p.displacement_control.stable(),
    };
    Special {
        kind: match load {
            true => SpecialKind::LoadLimit,
            false => SpecialKind::DisplacementLimit,
        },
        mode: largest_one(system.motion(&t.direction)),
        point: describe(system, c, t.direction),
        accuracy: 1e-12,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: stable(segment.here) || stable(segment.there),
        directions: Vec::new(),
    }
}
