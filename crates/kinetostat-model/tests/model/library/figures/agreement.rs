//! Stiffness of every machine at home and at two other places: the crate's against the oracle's.

use kinetostat::{DirectionKind, Pose, Posture, Twist, spatial::moved};
use kinetostat_model::Model;
use kinetostat_testing::{LargestEntry, Worst, largest};
use nalgebra::{DMatrix, DVector, Vector3, vector};
use serde_json::json;

use crate::library::{figure, machine, names, posture_near, preset, turns};

/// A direction with less than this share of what stands behind it is free.
const FREE: f64 = 1e-12;

/// How far the two are apart.
struct Apart {
    /// Stiffness in all finite directions, each as a share of its own.
    stiffness: f64,
    /// Free and rigid directions: sine of the angle between the spaces.
    spaces: f64,
    unknowns: usize,
}

/// Home and two other places: in the stated workspace, and turned where the machine turns.
fn places(model: &Model) -> Vec<Posture> {
    let mechanism = &model.mechanism;
    let home_pose = mechanism.platforms()[mechanism.tool()].home;
    let home = mechanism
        .posture(&home_pose)
        .unwrap_or_else(|e| panic!("{}: home: {e}", model.name()));
    let turns = turns(&home);
    let mut list = vec![home.clone()];
    for (share, turn) in [
        (vector![0.27, 0.68, 0.41], Vector3::zeros()),
        (vector![0.79, 0.33, 0.62], vector![0.04, -0.07, 0.05]),
    ] {
        let target = match model.workspace() {
            Some((low, high)) => {
                let at = low + (high - low).component_mul(&share);
                Pose::from_parts(at.into(), home_pose.rotation)
            }
            // Of a teaching example: a little aside.
            None => {
                let shift = (share - Vector3::repeat(0.5)) * 0.1;
                moved(&home_pose, &Twist::new(shift, Vector3::zeros()))
            }
        };
        let mut posture = posture_near(model, &target, &home);
        if turns {
            let target = moved(posture.target(), &Twist::new(Vector3::zeros(), turn));
            posture = posture_near(model, &target, &posture);
        }
        list.push(posture);
    }
    list
}

/// Largest sine of the angles between columns (unit length) and an orthonormal space.
fn outside(columns: &[DVector<f64>], space: &DMatrix<f64>) -> f64 {
    let out = |c: &DVector<f64>| (c - space * (space.transpose() * c)).norm() / c.norm();
    // No direction of a kind is outside of nothing.
    match columns {
        [] => 0.0,
        columns => largest(columns.iter().map(out)),
    }
}

fn compare(model: &Model, posture: &Posture) -> Apart {
    let machine = machine::structure(model, posture);
    let oracle = machine.structure.condense(machine.tool);
    let found = posture.stiffness().expect("a stiffness");
    let unit = |i: usize| if i < 3 { 1.0 } else { 1.0 / oracle.length };
    let scaled = DMatrix::from_fn(6, 6, |i, j| {
        found.cartesian.matrix[(i, j)] * unit(i) * unit(j)
    });
    let own = oracle.reach.transpose() * scaled * &oracle.reach;

    let eigen = oracle.stiffness.clone().symmetric_eigen();
    let finite: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|i| eigen.eigenvalues[*i] > FREE * oracle.stiffest)
        .collect();
    let free: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|i| !finite.contains(i))
        .collect();
    // In units of every direction's own stiffness the oracle's matrix is one.
    let whiten = DMatrix::from_fn(own.nrows(), finite.len(), |i, j| {
        eigen.eigenvectors[(i, finite[j])] / eigen.eigenvalues[finite[j]].sqrt()
    });
    let one = whiten.transpose() * &own * &whiten;
    let mut stiffness = match finite.is_empty() {
        true => 0.0,
        false => (one - DMatrix::identity(finite.len(), finite.len())).largest_entry(),
    };
    let idle = DMatrix::from_fn(own.nrows(), free.len(), |i, j| {
        eigen.eigenvectors[(i, free[j])]
    });
    if !free.is_empty() {
        // What is free costs nothing.
        stiffness = largest([stiffness, (&own * &idle).largest_entry() / oracle.stiffest]);
    }

    // The kinds of directions, one by one.
    let columns = |kind: DirectionKind| -> Vec<DVector<f64>> {
        let own = found.directions.iter().filter(|d| d.kind == kind);
        own.map(|d| DVector::from_fn(6, |i, _| d.twist.0[i] / unit(i)))
            .collect()
    };
    let place = || {
        format!(
            "{} at {}",
            model.name(),
            posture.target().translation.vector
        )
    };
    let count = |kind| columns(kind).len();
    assert_eq!(
        count(DirectionKind::Rigid),
        6 - oracle.reach.ncols(),
        "rigid directions, {}",
        place()
    );
    assert_eq!(
        count(DirectionKind::Free),
        free.len(),
        "free directions, {}: {:?}",
        place(),
        eigen.eigenvalues
    );
    assert_eq!(count(DirectionKind::Finite), finite.len(), "{}", place());
    let movable = [columns(DirectionKind::Finite), columns(DirectionKind::Free)].concat();
    let spaces = largest([
        outside(&movable, &oracle.reach),
        outside(&columns(DirectionKind::Free), &(&oracle.reach * idle)),
    ]);
    Apart {
        stiffness,
        spaces,
        unknowns: machine.structure.unknowns(),
    }
}

#[test]
fn the_stiffness_of_every_robot_is_that_of_the_dense_system() {
    let mut worst = Worst::new();
    let (mut slant, mut most) = (Worst::new(), Vec::new());
    let mut count = 0;
    for name in names() {
        let model = preset(name);
        for posture in places(&model) {
            let apart = compare(&model, &posture);
            worst.add_at(apart.stiffness, || name.to_owned());
            slant.add(apart.spaces);
            most.push(apart.unknowns);
            count += 1;
            assert!(
                apart.stiffness < 1e-9 && apart.spaces < 1e-9,
                "{name}: {:e} {:e}",
                apart.stiffness,
                apart.spaces
            );
        }
    }
    let most = most.iter().max().expect("a posture");
    let where_worst = worst.place().to_owned();
    let (worst, slant) = (worst.of(count), slant.of(count));
    figure(
        &format!(
            "Library: stiffness of {count} postures minus a dense global system, worst ({where_worst})"
        ),
        json!(worst),
        "at most 1e-9",
        "relative, per direction",
        worst <= 1e-9,
    );
    figure(
        &format!(
            "Library: rigid and free directions minus those of the dense system (up to {most} unknowns)"
        ),
        json!(slant),
        "at most 1e-9",
        "rad",
        slant <= 1e-9,
    );
}
