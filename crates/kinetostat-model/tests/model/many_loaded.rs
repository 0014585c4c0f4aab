//! Every preset under load, many postures at once against the general engine posture by posture:
//! tangent stiffness, stability, forces of the actuators, and compensation.

use kinetostat::batch::{Batch, BatchEquilibrium, Status};
use kinetostat::{
    Directions, Mechanism, MechanismEquilibrium, Pose, Twist, Wrench,
    compensation::target_under_load,
    spatial::{moved, pose_residual},
};
use kinetostat_model::{Model, preset_names};
use kinetostat_testing::{LargestEntry, Worst, largest_size};
use nalgebra::{Matrix6, Vector3, Vector6};

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

fn length(mechanism: &Mechanism) -> f64 {
    mechanism.limbs()[0].nominal.scale().length
}

/// Machines that cannot follow shifts along all three axes: of these no posture is found, and nothing is
/// compared.
pub const OUT_OF_REACH: [&str; 10] = [
    "two_link",
    "three_link_s",
    "three_link_z",
    "two_chains",
    "two_chains_pressed",
    "rrr3_planar",
    "prs3",
    "parallel_wrist",
    "tricept_like",
    "compensated_arm",
];

/// Poses around home, some of them out of reach.
fn poses(mechanism: &Mechanism, count: usize) -> Vec<Pose> {
    let home = mechanism.platforms()[mechanism.tool()].home;
    let size = 0.05 * length(mechanism);
    let shift = |i: usize| {
        Vector6::from_fn(|k, _| {
            if k < 3 {
                size * irregular(6 * i + k)
            } else {
                0.0
            }
        })
    };
    (0..count).map(|i| moved(&home, &Twist(shift(i)))).collect()
}

fn wrenches(count: usize) -> Vec<Wrench> {
    let vector =
        |i: usize, size: f64| size * Vector3::new(irregular(i), irregular(i + 1), irregular(i + 2));
    (0..count)
        .map(|i| Wrench::new(vector(5 * i, 200.0), vector(7 * i, 20.0)))
        .collect()
}

/// Largest difference as a share of the largest number.
fn apart(own: &[f64], other: &[f64]) -> f64 {
    assert_eq!(own.len(), other.len());
    let size = largest_size(other.iter().copied());
    largest_size(own.iter().zip(other).map(|(a, b)| a - b)) / size.max(f64::MIN_POSITIVE)
}

/// Number of postures that have an answer, scalar or vectorised.
fn solved(found: &[Status]) -> usize {
    found.iter().filter(|f| f.is_solved()).count()
}

fn vectorised(found: &[Status]) -> usize {
    found.iter().filter(|f| **f == Status::Vectorised).count()
}

/// Largest differences of stiffness, forces, softness and share to buckling.
fn errors_of(all: &BatchEquilibrium, i: usize, scalar: &MechanismEquilibrium) -> [f64; 4] {
    let own = Matrix6::from_fn(|r, c| all.stiffness.get(i, 6 * r + c));
    let matrix = scalar.stiffness.matrix;
    let forces: Vec<f64> = all.actuator_forces.row(i).collect();
    let stability = all.stability(i).expect("asked for");
    assert_eq!(stability.stable, scalar.stable());
    let soft = scalar.stiffness_against_force();
    let share_to_buckling = match (stability.share_to_buckling, scalar.share_to_buckling()) {
        (Some(a), Some(b)) if a == b => 0.0,
        (Some(a), Some(b)) => (a - b).abs(),
        (None, None) => 0.0,
        (a, b) => panic!("{a:?} {b:?}"),
    };
    let softness = if stability.stiffness_against_force == soft {
        0.0
    } else {
        (stability.stiffness_against_force - soft).abs() / soft.abs()
    };
    [
        (own - matrix).largest_entry() / matrix.largest_entry(),
        apart(&forces, &scalar.actuator_forces()),
        softness,
        share_to_buckling,
    ]
}

#[test]
fn every_preset_has_the_same_tangent_scalar_and_vectorised() {
    let (count, mut without) = (11, Vec::new());
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let mechanism = &model.mechanism;
        let batch = Batch::new(mechanism);
        let (poses, wrenches) = (poses(mechanism, count), wrenches(count));
        let all = batch
            .equilibrium(&poses, &wrenches, kinetostat::batch::Details::Stiffness)
            .expect("sizes");
        let mut worst = Worst::new();
        for i in 0..count {
            let posture = mechanism.posture(&poses[i]);
            let scalar = posture.and_then(|p| p.deflected_by(&wrenches[i]));
            assert_eq!(scalar.is_ok(), all.status[i].is_solved(), "{}", preset.name);
            let Ok(scalar) = scalar else { continue };
            let matrix = scalar.stiffness.matrix;
            let own = Matrix6::from_fn(|r, c| all.stiffness.get(i, 6 * r + c));
            worst.add((own - matrix).largest_entry() / matrix.largest_entry());
        }
        if solved(&all.status) == 0 {
            without.push(preset.name);
        }
        let (found, worst) = (vectorised(&all.status), worst.of_all(solved(&all.status)));
        println!(
            "{}: {found} of {count} together, apart {worst:.0e}",
            preset.name
        );
        assert!(worst < 1e-11, "{}: {worst:e}", preset.name);
    }
    assert_eq!(without, OUT_OF_REACH);
}

#[test]
fn every_preset_has_the_same_stability_scalar_and_vectorised() {
    let (count, mut without) = (11, Vec::new());
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let mechanism = &model.mechanism;
        let batch = Batch::new(mechanism);
        let (poses, wrenches) = (poses(mechanism, count), wrenches(count));
        let all = batch
            .equilibrium(&poses, &wrenches, kinetostat::batch::Details::Stability)
            .expect("sizes");
        let mut worst = <[Worst; 4]>::default();
        for i in 0..count {
            let posture = mechanism.posture(&poses[i]);
            let scalar = posture.and_then(|p| Ok((p.deflected_by(&wrenches[i])?, p.commands())));
            assert_eq!(
                scalar.is_ok(),
                all.status[i] != Status::Unsolved,
                "{}",
                preset.name
            );
            let Ok((scalar, commands)) = scalar else {
                assert!(all.stability(i).is_none());
                continue;
            };
            for (w, x) in worst.iter_mut().zip(errors_of(&all, i, &scalar)) {
                w.add(x);
            }
            let own: Vec<f64> = all.commands.row(i).collect();
            assert!(apart(&own, &commands) < 1e-11, "{}", preset.name);
        }
        if solved(&all.status) == 0 {
            without.push(preset.name);
        }
        let found = vectorised(&all.status);
        let worst = worst.map(|w| w.of_all(solved(&all.status)));
        println!(
            "{}: {found} of {count} together, apart {worst:?}",
            preset.name
        );
        let [stiffness, forces, softness, share_to_buckling] = worst;
        assert!(stiffness < 1e-11, "{}: {stiffness:e}", preset.name);
        assert!(forces < 1e-9, "{}: {forces:e}", preset.name);
        assert!(softness < 1e-9, "{}: {softness:e}", preset.name);
        assert!(
            share_to_buckling < 1e-9,
            "{}: {share_to_buckling:e}",
            preset.name
        );
    }
    assert_eq!(without, OUT_OF_REACH);
}

/// Presets with masses along their links, moved as they can be: poses and loads off all axes, to buckling and back.
#[test]
fn presets_with_masses_along_their_links_are_solved_together() {
    let count = 9;
    for (name, moves) in [
        ("hexaglide", [1.0; 6]),
        ("tripteron", [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
        ("prs3", [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        ("rrr3_planar", [1.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
    ] {
        let mechanism = &Model::preset(name).expect("a preset").mechanism;
        let limbs = mechanism.limbs().iter();
        assert!(limbs.clone().all(|l| !l.actual.segment_masses().is_empty()));
        let batch = Batch::new(mechanism);
        assert_eq!(
            (batch.engine().reason(), batch.engine_unloaded().reason()),
            (None, None)
        );
        let home = mechanism.platforms()[mechanism.tool()].home;
        let size = 0.05 * length(mechanism);
        let unit = |k: usize| if k < 3 { size } else { 0.05 };
        let twist = |i: usize| Vector6::from_fn(|k, _| moves[k] * unit(k) * irregular(6 * i + k));
        let poses: Vec<Pose> = (0..count).map(|i| moved(&home, &Twist(twist(i)))).collect();
        let wrenches = wrenches(count);
        let all = batch
            .equilibrium(&poses, &wrenches, kinetostat::batch::Details::Stability)
            .expect("sizes");
        let mut worst = <[Worst; 4]>::default();
        for i in 0..count {
            assert_eq!(all.status[i], Status::Vectorised, "{name} {i}");
            let scalar = mechanism.posture(&poses[i]).expect("reachable");
            let scalar = scalar.deflected_by(&wrenches[i]).expect("an equilibrium");
            for (w, x) in worst.iter_mut().zip(errors_of(&all, i, &scalar)) {
                w.add(x);
            }
        }
        let worst = worst.map(|w| w.of_all(count));
        println!("{name}: apart {worst:?}");
        let [stiffness, forces, softness, share_to_buckling] = worst;
        assert!(stiffness < 1e-11 && forces < 1e-9, "{name}: {worst:?}");
        assert!(
            softness < 1e-9 && share_to_buckling < 1e-9,
            "{name}: {worst:?}"
        );
    }
}

#[test]
fn every_preset_is_compensated_the_same_scalar_and_vectorised() {
    let (count, mut without) = (11, Vec::new());
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let mechanism = &model.mechanism;
        let batch = Batch::new(mechanism);
        let (poses, wrenches) = (poses(mechanism, count), wrenches(count));
        for directions in [Directions::POSITION, Directions::ALL] {
            let all = batch
                .targets_under_load(&poses, &wrenches, directions)
                .expect("sizes");
            let (mut worst, mut off) = (Worst::new(), Worst::new());
            for i in 0..count {
                let scalar = mechanism.posture(&poses[i]).and_then(|near| {
                    let rest = near.rest_state();
                    target_under_load(&near, &poses[i], &wrenches[i], directions, rest)
                });
                assert_eq!(
                    scalar.is_ok(),
                    all.equilibrium.status[i] != Status::Unsolved,
                    "{} {i}",
                    preset.name
                );
                let Ok((scalar, _)) = scalar else { continue };
                let between = pose_residual(&all.targets[i], scalar.target());
                worst.add(between.linear().norm() / length(mechanism));
                worst.add(between.angular().norm());
                let left = pose_residual(&all.equilibrium.tool_pose(i), &poses[i]);
                off.add(left.linear().norm() / length(mechanism));
                if directions[3] {
                    off.add(left.angular().norm());
                }
            }
            let found = vectorised(&all.equilibrium.status);
            let compared = solved(&all.equilibrium.status);
            // All six directions are not to be had with fewer than six drives.
            if compared == 0 && !directions[3] {
                without.push(preset.name);
            }
            let ends = if directions[3] { 2 } else { 1 };
            let (worst, off) = (worst.of_all(2 * compared), off.of_all(ends * compared));
            println!(
                "{} {directions:?}: {found} of {count} together, apart {worst:.0e}, off {off:.0e}",
                preset.name
            );
            assert!(worst < 1e-11, "{}: {worst:e}", preset.name);
            assert!(off < 1e-11, "{}: {off:e}", preset.name);
        }
    }
    // The legs of that one leave a motion free, and no target holds the load.
    assert_eq!(without, [&["stewart_gough_a"], &OUT_OF_REACH[..]].concat());
}
