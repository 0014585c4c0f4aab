//! Bifurcation points between two steps of a curve: located, refined, classified, with the branches that cross there.
//!
//! A simple bifurcation is a change of sign of `det [G_z; t^T]` along the curve (Keller 1977; Seydel, Practical
//! Bifurcation and Stability Analysis, 5.2). Two modes that become critical together leave the sign as it is: they are
//! found by the number of unstable modes.

use nalgebra::{DMatrix, DVector};

use crate::continuation::curve::{CurveStability, Special, SpecialKind};
use crate::continuation::linear::tangent::{NullDirections, Tangent};
use crate::continuation::tracing::describe::describe;
use crate::continuation::tracing::segment::{Sample, Segment, largest_one};
use crate::continuation::tracing::singular_point::{refine, tangents};
use crate::continuation::tracing::system::{Corrected, CurveSystem, SpecialPoint};

/// Singular values below this share of the largest belong to directions in which branches may leave.
const NULL: f64 = 1e-5;

/// The bifurcation point of a segment and its share of it; `even` where an even number of modes changes, which the
/// determinant does not show.
pub(crate) fn bifurcation<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    before: &Tangent,
    after: &Tangent,
    even: bool,
) -> Option<(f64, SpecialPoint<S>)> {
    let step = (&segment.there.z - &segment.here.z).norm();
    let share = match even {
        true => by_count(system, segment)?,
        false => by_determinant(system, segment, before, after),
    };
    // Right at the point the tangent is undefined: beside it the corrector still works.
    let guess = match segment.at(system, share) {
        Some((c, _)) => c.z,
        None => &segment.here.z + (&segment.there.z - &segment.here.z) * share,
    };
    system.set_dense(true);
    let special = classified(system, segment, &guess, step, even);
    system.set_dense(false);
    special.map(|special| (share, special))
}

/// Change of the number of unstable modes, by bisection.
fn by_count<S: CurveSystem>(system: &mut S, segment: &Segment<'_, S>) -> Option<f64> {
    let count = segment.here.unstable;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let (c, _) = segment.at(system, middle)?;
        system.evaluate(&c.z);
        let same = (0..2).all(|k| system.stability(&c, k == 0).unstable_modes() == count[k]);
        match same {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(0.5 * (low + high))
}

/// Change of the number of unstable modes through parts that are condensed out of the unknowns.
pub(crate) fn stability_change<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
) -> Option<(f64, SpecialPoint<S>)> {
    let (here, there) = (segment.here, segment.there);
    if here.unstable == there.unstable {
        return None;
    }
    let share = by_count(system, segment)?;
    let (c, t) = segment.at(system, share)?;
    let special = Special {
        kind: SpecialKind::StabilityChange,
        mode: largest_one(system.motion(&t.direction)),
        point: describe(system, &c, t.direction),
        accuracy: 1e-6,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: here.displacement_control.stable() || there.displacement_control.stable(),
        directions: Vec::new(),
    };
    Some((share, special))
}

/// Zero of the determinant.
fn by_determinant<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    before: &Tangent,
    after: &Tangent,
) -> f64 {
    let reference = before.logarithm.max(after.logarithm);
    let value = move |t: &Tangent| t.sign * (t.logarithm - reference).exp();
    let (low, high) = (
        Sample::new(0.0, value(before)),
        Sample::new(1.0, value(after)),
    );
    segment.root(system, low, high, 1e-9, &move |_, _, t| value(t))
}

/// Kind of the bifurcation at a place, and the branches that cross there; with dense matrices.
fn classified<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    guess: &DVector<f64>,
    step: f64,
    even: bool,
) -> Option<SpecialPoint<S>> {
    // The extended system is singular along a family; the test function alone has found the place.
    let refined = match even || system.family().is_some() {
        true => None,
        false => refine(system, guess).filter(|z| (z - guess).norm() < 0.5 * step),
    };
    let accuracy = if refined.is_some() { 1e-10 } else { 1e-6 };
    let only_located = refined.is_none();
    let z = refined.unwrap_or_else(|| guess.clone());
    let (_, norms, matrix) = system.linearised_densely(&z);
    let found = match system.family().cloned() {
        Some(family) => system.null_directions(&family.beside(&matrix)),
        None => system.null_directions(&matrix),
    };
    let whole = system.whole(matrix.clone());
    if found.values.is_empty() || (only_located && found.count(0, NULL) < 2) {
        return None;
    }
    let null: Vec<DVector<f64>> = (0..found.count(2, NULL))
        .map(|k| found.right.column(k).into_owned())
        .collect();
    let mean = (&segment.here.tangent + &segment.there.tangent).normalize();
    let own = within(&null, &mean);
    let crossing = match null.len() {
        2 => two_branches(system, &z, &matrix, found, &null, &own),
        _ => many_branches(&null, own),
    };
    let corrected = Corrected {
        z,
        matrix: whole,
        norms,
        iterations: 0,
    };
    let mode = largest_one(system.motion(&crossing.mode));
    let point = describe(system, &corrected, crossing.path);
    let (here, there) = (segment.here, segment.there);
    Some(Special {
        kind: crossing.kind,
        point,
        mode,
        accuracy,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: here.displacement_control.stable() || there.displacement_control.stable(),
        directions: crossing.others,
    })
}

/// The curve's own direction within the null space, from what was seen of it.
fn within(null: &[DVector<f64>], seen: &DVector<f64>) -> DVector<f64> {
    let mut sum = DVector::zeros(seen.len());
    for v in null {
        sum += v * v.dot(seen);
    }
    let size = sum.norm();
    match size > 1e-12 {
        true => sum / size,
        false => seen.clone(),
    }
}

/// Branches that cross at a bifurcation point.
struct Crossing {
    kind: SpecialKind,
    /// Direction of the branch on which the point was found.
    path: DVector<f64>,
    /// Directions of the other branches.
    others: Vec<DVector<f64>>,
    /// The critical mode.
    mode: DVector<f64>,
}

/// A simple bifurcation: two branches.
fn two_branches<S: CurveSystem>(
    system: &mut S,
    z: &DVector<f64>,
    matrix: &DMatrix<f64>,
    found: NullDirections,
    null: &[DVector<f64>],
    own: &DVector<f64>,
) -> Crossing {
    let left = match system.family().cloned() {
        Some(family) => system.null_directions(&family.beside_left(matrix)).left,
        None => found.left,
    };
    let psi = left.column(0).into_owned();
    let (path, other) = tangents(system, z, &psi, null, own);
    let m = z.len() - 1;
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
    Crossing {
        kind,
        path,
        others: vec![other],
        mode,
    }
}

/// Several modes at once: what is left of the null space across the curve's own direction.
fn many_branches(null: &[DVector<f64>], path: DVector<f64>) -> Crossing {
    let mut others: Vec<DVector<f64>> = Vec::new();
    for v in null {
        let mut v = v - &path * path.dot(v);
        for d in &others {
            v -= d * d.dot(&v);
        }
        if v.norm() > 1e-3 {
            others.push(v.normalize());
        }
    }
    Crossing {
        kind: SpecialKind::Multiple {
            modes: null.len() - 1,
        },
        mode: others.first().cloned().unwrap_or_else(|| path.clone()),
        path,
        others,
    }
}
