//! Postures along a path start from each other and are those that each has by itself.

use kinetostat::batch::{AlongPath, Batch, BatchEquilibrium, Details, Status};
use kinetostat::internal::{InstructionSet, batch_along_path};
use kinetostat::model::ActuatorSpec;
use kinetostat::{Chain, Directions, Mechanism, MotionKind, Pose, Wrench};
use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector3};

use super::kernels::sliders;

/// Places on a circle with a corner, and a force that turns with the path.
fn path(home: &Pose, count: usize) -> (Vec<Pose>, Vec<Wrench>) {
    let places = (0..count).map(|i| {
        let turn = 0.02 * i as f64 + if i > count / 2 { 0.7 } else { 0.0 };
        let (s, c) = turn.sin_cos();
        let place = Pose::translation(0.02 * c, 0.02 * s, 0.001 * i as f64) * home;
        (
            place,
            Wrench::new(
                Vector3::new(200.0 * c, 200.0 * s, -40.0),
                Vector3::new(3.0, -2.0 * s, c),
            ),
        )
    });
    places.unzip()
}

/// Targets and equilibria of places, each started from the one before it if they lie `along` a path.
fn found(
    machine: &Mechanism,
    along: bool,
    (poses, wrenches): (&[Pose], &[Wrench]),
    directions: Option<Directions>,
) -> (Vec<Pose>, BatchEquilibrium) {
    let batch = match along {
        true => batch_along_path(machine),
        false => Batch::new(machine),
    };
    match directions {
        Some(directions) => {
            let found = batch.targets_under_load(poses, wrenches, directions);
            let found = found.expect("sizes");
            (found.targets, found.equilibrium)
        }
        None => {
            let found = batch
                .equilibrium(poses, wrenches, Details::Stability)
                .expect("sizes");
            (poses.to_vec(), found)
        }
    }
}

/// Where the tool goes, and what to command so that it is there.
fn requests() -> [Option<Directions>; 2] {
    [
        None,
        Some(Directions::from([true, true, true, false, false, false])),
    ]
}

/// Three slides and a wrist on soft links: the machine that no platform closes.
fn gantry() -> Mechanism {
    let mut chain = Chain::builder("gantry");
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    for (i, kind) in [MotionKind::Prismatic, MotionKind::Revolute]
        .iter()
        .enumerate()
    {
        for (k, axis) in axes.iter().enumerate() {
            let name = format!("drive {}", 3 * i + k);
            chain = chain.actuator(&name, ActuatorSpec::new(*kind, *axis, 1e6));
        }
        let mut stiffness = Matrix6::identity() * 2e5;
        stiffness
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(Matrix3::identity() * 1e6));
        chain = chain
            .translation(Vector3::new(0.1, 0.2, 0.4))
            .spring6(&format!("link {i}"), &stiffness, [0.0; 6])
            .body(
                &format!("mass {i}"),
                30.0,
                Vector3::new(0.0, 0.1, 0.0),
                Matrix3::zeros(),
            );
    }
    let chain = chain.build().expect("a gantry");
    let gravity = Vector3::new(0.0, 0.0, -9.81);
    Mechanism::serial(chain, Pose::identity(), gravity).expect("a machine")
}

#[test]
fn a_path_has_the_same_bits_on_every_instruction_set() {
    let sets = InstructionSet::available();
    for machine in [sliders(), gantry()] {
        let home = machine.platforms()[machine.tool()].home;
        for count in [3, 11, 50, 64] {
            let (poses, wrenches) = path(&home, count);
            for directions in requests() {
                let bits = |set: InstructionSet| -> Vec<u64> {
                    let places = (poses.as_slice(), wrenches.as_slice());
                    let (targets, found) =
                        set.during(|| self::found(&machine, true, places, directions));
                    let tables = [&found.tool, &found.coordinates, &found.actuator_forces];
                    let numbers = tables.map(|t| (0..count).flat_map(|i| t.row(i)));
                    let all = numbers.into_iter().flatten();
                    let places = targets.iter().flat_map(|t| t.translation.vector.data.0[0]);
                    all.chain(places).map(f64::to_bits).collect()
                };
                let single = bits(InstructionSet::Single);
                for set in &sets {
                    assert!(bits(*set) == single, "{}: {set:?}", machine.name());
                }
            }
        }
    }
}

#[test]
fn a_place_on_a_path_is_as_by_itself() {
    // The gantry's slides have no end: a place far away is another start, not out of reach.
    for (machine, far) in [
        (sliders(), Status::Unsolved),
        (gantry(), Status::Vectorised),
    ] {
        let home = machine.platforms()[machine.tool()].home;
        let (mut poses, wrenches) = path(&home, 64);
        // Those after it start from home.
        poses[21] = Pose::translation(5.0, 0.0, 0.0);
        for directions in requests() {
            let places = (poses.as_slice(), wrenches.as_slice());
            let (targets, path) = found(&machine, true, places, directions);
            let (own, alone) = found(&machine, false, places, directions);
            for i in 0..64 {
                assert_eq!(path.status[i], alone.status[i], "{i}");
                if i == 21 {
                    assert_eq!(path.status[i], far);
                    continue;
                }
                assert_eq!(path.status[i], Status::Vectorised, "{i}");
                let off = (targets[i].translation.vector - own[i].translation.vector).norm();
                assert!(
                    off < 1e-11,
                    "{}, {i}: target off by {off:e} m",
                    machine.name()
                );
                let tool = path.tool_pose(i).translation.vector;
                let off = (tool - alone.tool_pose(i).translation.vector).norm();
                assert!(
                    off < 1e-11,
                    "{}, {i}: tool off by {off:e} m",
                    machine.name()
                );
                let forces = path
                    .actuator_forces
                    .row(i)
                    .zip(alone.actuator_forces.row(i));
                for (x, y) in forces {
                    assert!((x - y).abs() < 1e-7 * (200.0 + y.abs()), "{i}: {x} for {y}");
                }
                if let (Some(x), Some(y)) = (path.stability(i), alone.stability(i)) {
                    assert_eq!(x.stable, y.stable);
                    let both = [
                        (x.stiffness_against_force, y.stiffness_against_force),
                        (
                            x.share_to_buckling.unwrap_or_default(),
                            y.share_to_buckling.unwrap_or_default(),
                        ),
                    ];
                    for (x, y) in both {
                        assert!((x - y).abs() <= 1e-7 * y.abs(), "{i}: {x} for {y}");
                    }
                }
            }
        }
    }
}

/// With the wrist half a turn from home, kernels find no way there by themselves: runs begin where the general engine does.
#[test]
fn a_path_far_from_home_is_solved_by_kernels_too() {
    let machine = gantry();
    let home = machine.platforms()[machine.tool()].home;
    let (poses, wrenches) = path(&home, 300);
    let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
    let poses: Vec<Pose> = poses.iter().map(|pose| pose * turned).collect();
    let count = |found: &BatchEquilibrium| {
        let by_kernels = found.status.iter();
        by_kernels.filter(|s| **s == Status::Vectorised).count()
    };
    for directions in requests() {
        let places = (poses.as_slice(), wrenches.as_slice());
        let (targets, path) = found(&machine, true, places, directions);
        let (own, alone) = found(&machine, false, places, directions);
        assert!(count(&alone) < 30, "{} of 300 from home", count(&alone));
        assert_eq!(count(&path), 300);
        for i in 0..300 {
            let off = (targets[i].translation.vector - own[i].translation.vector).norm();
            let tool = path.tool_pose(i).translation.vector;
            let apart = (tool - alone.tool_pose(i).translation.vector).norm();
            assert!(off < 1e-10 && apart < 1e-10, "{i}: {off:e} {apart:e} m");
        }
    }
}

#[test]
fn the_thread_that_solves_a_path_does_not_matter() {
    let machine = sliders();
    let along = AlongPath::new(&machine);
    let (poses, wrenches) = path(&Pose::identity(), 64);
    let here = along.rest(&poses, &wrenches).expect("a path");
    let elsewhere = std::thread::scope(|scope| {
        let there = scope.spawn(|| along.rest(&poses, &wrenches).expect("a path"));
        there.join().expect("a thread")
    });
    for i in 0..poses.len() {
        assert!(here.tool.row(i).eq(elsewhere.tool.row(i)), "{i}");
    }
}

/// Along a smooth path, around its corner, and where the load comes, goes and turns while the tool stands: what is said of places that were not looked
/// at is what is found there.
#[test]
fn stability_between_places_is_as_where_it_is_looked_at() {
    for machine in [sliders(), gantry()] {
        let home = machine.platforms()[machine.tool()].home;
        let along = AlongPath::new(&machine);
        let (smooth, turning) = path(&home, 64);
        let finely: Vec<Pose> = (0..64_u32)
            .map(|i| Pose::translation(1e-4 * f64::from(i), -2e-5 * f64::from(i), 0.0) * home)
            .collect();
        let load = |i: usize, most: f64| {
            let share = match i {
                0..20 => 1.0,
                20..30 => 0.1 * (30 - i) as f64,
                30..40 => 0.0,
                _ => -1.0,
            };
            Wrench::new(
                Vector3::new(most * share, 0.3 * most, -40.0),
                Vector3::zeros(),
            )
        };
        let of = |most: f64| (0..64).map(|i| load(i, most)).collect::<Vec<_>>();
        let still = vec![home; 64];
        for (poses, wrenches) in [
            (&smooth, &turning),
            (&finely, &turning),
            (&finely, &of(200.0)),
            (&still, &of(500.0)),
            (&finely, &vec![load(0, 300.0); 64]),
        ] {
            let found = along.with_stability(poses, wrenches).expect("a path");
            let all = Batch::new(&machine);
            let all = all
                .equilibrium(poses, wrenches, Details::Stability)
                .expect("sizes");
            for i in 0..64 {
                let (x, y) = (
                    found.stability(i).expect("told"),
                    all.stability(i).expect("found"),
                );
                assert_eq!(x.stable, y.stable);
                let shares = (x.share_to_buckling, y.share_to_buckling);
                let off = (x.stiffness_against_force / y.stiffness_against_force - 1.0).abs();
                assert!(off < 1e-7, "{}, {i}: {off:e}", machine.name());
                assert_eq!(shares.0.is_some(), shares.1.is_some());
                if let (Some(x), Some(y)) = shares {
                    let off = (x - y).abs() / y.abs().max(0.01);
                    assert!(off < 1e-7, "{}, {i}: {x} for {y}", machine.name());
                }
            }
        }
    }
}
