//! Equilibria on the branches of a curve at one load or one displacement, and where a system jumps from its limit points.

use crate::continuation::curve::{CurveStability, Jump, SpecialKind};
use crate::continuation::tracing::describe::{describe, tangent};
use crate::continuation::tracing::system::{
    BranchOf, CurveSystem, Point, Row, SpecialPoint, distance, wrapped,
};

/// Equilibria at one value of the parameter, or (`false`) of its conjugate, on all branches.
pub(crate) fn points_at<S: CurveSystem>(
    system: &mut S,
    branches: &[BranchOf<S>],
    value: f64,
    parameter: bool,
) -> Vec<Point<S>> {
    let found = crossings(system, branches, value, parameter);
    found.into_iter().map(|(_, p)| p).collect()
}

/// Equilibria at one value of the parameter, or (`false`) of its conjugate, with the branch on which each lies.
fn crossings<S: CurveSystem>(
    system: &mut S,
    branches: &[BranchOf<S>],
    value: f64,
    parameter: bool,
) -> Vec<(usize, Point<S>)> {
    let mut found: Vec<(usize, Point<S>)> = Vec::new();
    let branches = branches.iter().enumerate();
    for (k, pair) in branches.flat_map(|(k, b)| b.points.windows(2).map(move |pair| (k, pair))) {
        let of = |p: &Point<S>| (if parameter { p.parameter } else { p.conjugate }) - value;
        let (a, b) = (of(&pair[0]), of(&pair[1]));
        let slack = 1e-12 * (1.0 + value.abs());
        if a * b > 0.0 && a.abs() > slack && b.abs() > slack || a == b {
            continue;
        }
        let guess = &pair[0].z + (&pair[1].z - &pair[0].z) * (a / (a - b)).clamp(0.0, 1.0);
        let row = if parameter {
            Row::Parameter(value)
        } else {
            Row::Conjugate(value)
        };
        system.start_from(&pair[0].equilibrium);
        system.set_family(pair[0].family.clone().or_else(|| pair[1].family.clone()));
        let Some(c) = system.correct(&guess, &row, 12) else {
            continue;
        };
        let far = (&c.z - &guess).norm() > (&pair[1].z - &pair[0].z).norm();
        if far {
            continue;
        }
        let Some(t) = tangent(system, &c.matrix, &pair[0].tangent) else {
            continue;
        };
        let next = describe(system, &c, t.direction);
        let known = found.iter().any(|(_, p)| {
            let (own, other) = (&next.equilibrium, &p.equilibrium);
            distance(system, &p.z, &next.z) < 1e-7 && !system.condensed_apart(own, other, other)
        });
        if !known {
            found.push((k, next));
        }
    }
    found
}

/// Jumps from every limit point that a stable part of a branch runs into: to stable equilibria on the branches at the
/// same dead load (load limits) or at the same displacement (displacement limits), nearest first.
pub(crate) fn jumps<S: CurveSystem>(
    system: &mut S,
    branches: &[BranchOf<S>],
    specials: &[SpecialPoint<S>],
) -> Vec<Jump<S::Equilibrium>> {
    let is_load = system.is_load();
    let turns = system.full_turns();
    let mut jumps = Vec::new();
    for (index, special) in specials.iter().enumerate() {
        let by_load = match special.kind {
            SpecialKind::LoadLimit => true,
            SpecialKind::DisplacementLimit => false,
            _ => continue,
        };
        let stable = |p: &Point<S>| match by_load {
            true => p.dead_load.stable(),
            false => p.displacement_control.stable(),
        };
        if !special.stable_side {
            continue;
        }
        let value = if by_load == is_load {
            special.point.parameter
        } else {
            special.point.conjugate
        };
        let there = crossings(system, branches, value, by_load == is_load);
        let mut there: Vec<_> = (there.into_iter())
            .filter(|(_, p)| stable(p))
            .map(|(k, p)| (wrapped(&p.z, &special.point.z, &turns).norm(), k, p))
            .filter(|(d, ..)| *d > 1e-3)
            .collect();
        there.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (branches, to) = there.into_iter().map(|(_, k, p)| (k, p)).unzip();
        jumps.push(Jump {
            from: index,
            dead_load: by_load,
            to,
            branches,
        });
    }
    jumps
}
