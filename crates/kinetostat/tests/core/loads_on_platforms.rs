//! Wrenches on any platform, springs and compensators between limbs.

use crate::common::{Rng, assert_equilibrium, scaled_error};
use crate::graphs::{arm_with_parallel_wrist, limb, turns};
use crate::oracle::Flat;
use kinetostat::{
    Anchor, Chain, LengthLaw, Mechanism, MotionKind, PlatformLoad, Pose, Twist, Wrench,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, DVector, Matrix6, Vector3, vector};

/// One of every kind, none of them on an axis, between platforms 0 to 2.
fn every_kind() -> Vec<PlatformLoad> {
    let gas = LengthLaw::Gas {
        force: 400.0,
        length: 1.4,
        column: 2.5,
        exponent: 1.3,
    };
    let linear = LengthLaw::Linear {
        stiffness: 3e3,
        free_length: 0.2,
        preload: 40.0,
    };
    let wrench = Wrench::new(vector![30.0, -50.0, 20.0], vector![4.0, 6.0, -3.0]);
    let points = [
        vector![0.1, 0.2, -0.1],
        vector![-0.2, 0.05, 0.15],
        vector![0.3, -0.1, 0.2],
    ];
    let on = |turns| PlatformLoad::Wrench {
        platform: 2,
        point: points[1],
        wrench,
        turns,
    };
    vec![
        PlatformLoad::strut(
            Anchor::on_platform(1, points[0]),
            Anchor::on_platform(2, points[1]),
            linear.clone(),
        ),
        PlatformLoad::strut(
            Anchor::on_platform(0, points[2]),
            Anchor::on_platform(2, points[0]),
            gas,
        ),
        PlatformLoad::strut(
            Anchor::on_platform(2, points[1]),
            Anchor::on_platform(0, points[0]),
            linear,
        ),
        PlatformLoad::strut(
            Anchor::on_platform(1, points[2]),
            Anchor::on_platform(2, points[0]),
            LengthLaw::Constant { tension: 70.0 },
        ),
        on(false),
        on(true),
        PlatformLoad::Wrench {
            platform: 1,
            point: points[0],
            wrench: Wrench::new(wrench.force(), Vector3::zeros()),
            turns: false,
        },
    ]
}

/// Stacked wrenches on three platforms.
fn stacked(load: &PlatformLoad, poses: &[Pose]) -> DVector<f64> {
    let mut list = Vec::new();
    load.wrenches(poses, &mut list);
    let mut all = DVector::zeros(6 * poses.len());
    for (platform, wrench) in list {
        let mut part = all.fixed_rows_mut::<6>(6 * platform);
        part += wrench.0;
    }
    all
}

fn somewhere(rng: &mut Rng) -> Vec<Pose> {
    let mut poses = vec![Pose::identity()];
    poses.extend((0..2).map(|_| rng.pose(1.0, 1.0)));
    poses
}

/// Tangents against fourth-order differences of the wrenches, the wrench against those of the
/// energy, relative: the worst of all kinds.
pub fn derivatives_apart() -> [f64; 2] {
    let mut rng = Rng(5);
    let mut worst = <[Worst; 2]>::default();
    for load in every_kind() {
        for _ in 0..5 {
            let poses = somewhere(&mut rng);
            let near = |column: usize, share: f64| {
                let mut twist = Twist::zero();
                twist.0[column % 6] = 1e-3 * share;
                let mut near = poses.clone();
                near[column / 6] = moved(&poses[column / 6], &twist);
                near
            };
            let mut tangent = DMatrix::zeros(18, 18);
            let mut list = Vec::new();
            load.tangents(&poses, &mut list);
            for t in list {
                let mut part = tangent.fixed_view_mut::<6, 6>(6 * t.on, 6 * t.by);
                part += t.matrix;
            }
            let mut differences = DMatrix::zeros(18, 18);
            for column in 6..18 {
                let at = |share: f64| stacked(&load, &near(column, share));
                let change = 8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0));
                differences.set_column(column, &(change / 12e-3));
            }
            let moving = (6, 6);
            let apart = (&tangent - &differences)
                .view(moving, (12, 12))
                .largest_entry();
            worst[0].add(apart / differences.largest_entry());
            let wrench = stacked(&load, &poses);
            let Some(_) = load.energy(&poses) else {
                assert!(!load.conservative());
                continue;
            };
            for column in 6..18 {
                let at = |share: f64| load.energy(&near(column, share)).unwrap();
                let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-3;
                worst[1].add((slope + wrench[column]).abs() / wrench.largest_entry());
            }
        }
    }
    worst.map(|w| w.value())
}

#[test]
fn tangents_are_derivatives_and_wrenches_those_of_the_energy() {
    let [tangent, energy] = derivatives_apart();
    assert!(tangent < 1e-8, "{tangent:e}");
    assert!(energy < 1e-8, "{energy:e}");
}

#[test]
fn action_is_reaction_and_frames_do_not_matter() {
    let mut rng = Rng(6);
    for load in every_kind() {
        let poses = somewhere(&mut rng);
        let mut list = Vec::new();
        load.wrenches(&poses, &mut list);
        if let PlatformLoad::Strut(strut) = &load {
            // Between two that move: forces and moments about the base's origin add up to zero.
            if load.platforms().len() == 2 {
                let sum = list.iter().fold(Wrench::zero(), |sum, (p, w)| {
                    let arm = poses[*p].translation.vector;
                    sum + Wrench::new(w.force(), w.moment() + arm.cross(&w.force()))
                });
                assert!(
                    sum.0.largest_entry() < 1e-12 * list[0].1.0.largest_entry(),
                    "{strut:?}"
                );
                // And everything turns with the machine.
                let turn = rng.pose(2.0, 2.0);
                let elsewhere: Vec<Pose> = poses.iter().map(|p| turn * p).collect();
                let mut turned = Vec::new();
                load.wrenches(&elsewhere, &mut turned);
                let rotation = turn.rotation.to_rotation_matrix();
                for ((_, w), (_, other)) in list.iter().zip(&turned) {
                    let off = (w.rotated(&rotation).0 - other.0).largest_entry();
                    assert!(off < 1e-11 * w.0.largest_entry(), "{off:e}");
                }
            }
        }
    }
}

/// The wrist with loads on its platforms.
fn loaded_wrist(loads: Vec<PlatformLoad>) -> Mechanism {
    let machine = arm_with_parallel_wrist(9.81);
    let mut builder = Mechanism::builder("loaded").gravity(machine.gravity());
    for platform in &machine.platforms()[1..] {
        builder.platform(platform.clone());
    }
    for own in machine.limbs() {
        builder = builder.limb(own.clone());
    }
    for load in loads {
        builder = builder.platform_load(load);
    }
    builder.build().unwrap()
}

/// Machines with loads on platforms against the flattened system: displacement and stiffness,
/// relative.
pub fn loaded_apart() -> [f64; 2] {
    let mut worst = <[Worst; 2]>::default();
    let machine = loaded_wrist(every_kind());
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    let pull = Wrench::new(vector![200.0, -100.0, 300.0], vector![20.0, 10.0, -30.0]);
    let e = posture.deflected_by(&pull).unwrap();
    let mut flat = Flat::at_rest(&posture);
    flat.load = pull.0;
    flat.solve(false);
    let apart = pose_residual(&e.tool, &flat.platforms[machine.tool()]).0;
    worst[0].add(apart.norm() / e.displacement.0.norm());
    worst[1].add(scaled_error(&e.stiffness.matrix, &flat.stiffness()));
    worst.map(|w| w.value())
}

#[test]
fn loads_on_platforms_are_those_of_the_flattened_system() {
    let [displacement, stiffness] = loaded_apart();
    assert!(displacement < 1e-11, "{displacement:e}");
    assert!(stiffness < 1e-9, "{stiffness:e}");
    // The tool's frame elsewhere: the same machine.
    let machine = loaded_wrist(every_kind());
    let home = machine.platforms()[machine.tool()].home;
    let tool = Pose::translation(0.02, 0.03, 0.1) * Pose::rotation(vector![0.2, -0.3, 0.4]);
    let other = machine.with_tool(&tool);
    let a = machine.posture(&home).unwrap();
    let b = other.posture(&(home * tool)).unwrap();
    let a = a.deflected_by(&Wrench::zero()).unwrap();
    let b = b.deflected_by(&Wrench::zero()).unwrap();
    let off = pose_residual(&(a.tool * tool), &b.tool).0.norm();
    assert!(off < 1e-11, "{off:e}");
    assert_eq!(a.energy, None, "followers have no potential");
}

/// A spring between flange and tool as a load, and as a limb of ball joint, slide with a spring
/// and ball joint: displacement and stiffness apart, relative.
pub fn spring_and_limb_apart() -> [f64; 2] {
    let (k, rest) = (3e4, 0.25);
    let (below, above) = (vector![0.05, 0.02, 0.03], vector![-0.02, 0.01, 0.0]);
    let law = LengthLaw::Linear {
        stiffness: k,
        free_length: rest,
        preload: 0.0,
    };
    let first = loaded_wrist(vec![PlatformLoad::strut(
        Anchor::on_platform(1, below),
        Anchor::on_platform(2, above),
        law,
    )]);
    let second = {
        let machine = arm_with_parallel_wrist(9.81);
        let mut builder = Mechanism::builder("sprung").gravity(machine.gravity());
        for platform in &machine.platforms()[1..] {
            builder.platform(platform.clone());
        }
        for own in machine.limbs() {
            builder = builder.limb(own.clone());
        }
        let offset = Pose::translation(0.01, -0.02, 0.25);
        let span = (offset * nalgebra::Point3::from(above)).coords - below;
        let (u1, u2) = turns(&span);
        let chain = Chain::builder("spring")
            .translation(below)
            .passive("u1", MotionKind::Revolute, Vector3::x(), u1)
            .passive("u2", MotionKind::Revolute, Vector3::y(), u2)
            .spring("slide", MotionKind::Prismatic, Vector3::z(), k, rest)
            .home("slide", span.norm())
            .passive_spherical("s")
            .build()
            .unwrap();
        let tip = Pose::translation(above.x, above.y, above.z);
        builder
            .limb(limb("spring", 1, 2, tip, chain))
            .build()
            .unwrap()
    };
    let home = first.platforms()[2].home;
    let push = Wrench::new(vector![90.0, -40.0, 70.0], vector![3.0, 5.0, -2.0]);
    let solve = |machine: &Mechanism| {
        let posture = machine.posture(&home).unwrap();
        let e = posture.deflected_by(&push).unwrap();
        assert_equilibrium(&posture, &e);
        (
            e.tool,
            e.displacement,
            e.stiffness.matrix,
            e.energy.unwrap(),
        )
    };
    let (a, b) = (solve(&first), solve(&second));
    assert!((a.3 - b.3).abs() < 1e-9 * a.3.abs(), "{} {}", a.3, b.3);
    let apart = pose_residual(&a.0, &b.0).0.norm() / a.1.0.norm();
    let matrices: [Matrix6<f64>; 2] = [a.2, b.2];
    [apart, scaled_error(&matrices[0], &matrices[1])]
}

#[test]
fn a_spring_between_limbs_is_the_limb_that_it_replaces() {
    let [displacement, stiffness] = spring_and_limb_apart();
    assert!(displacement < 1e-11, "{displacement:e}");
    assert!(stiffness < 1e-10, "{stiffness:e}");
}

#[test]
fn loads_that_do_not_fit_are_refused() {
    let machine = arm_with_parallel_wrist(0.0);
    let build = |load: PlatformLoad| {
        let mut builder = Mechanism::builder("wrong");
        for platform in &machine.platforms()[1..] {
            builder.platform(platform.clone());
        }
        for own in machine.limbs() {
            builder = builder.limb(own.clone());
        }
        builder.platform_load(load).build()
    };
    let rope = |tension| LengthLaw::Constant { tension };
    let zero = Vector3::zeros();
    for (load, words) in [
        (
            PlatformLoad::strut(
                Anchor::on_platform(0, zero),
                Anchor::on_platform(7, zero),
                rope(1.0),
            ),
            "platform 7",
        ),
        (
            PlatformLoad::strut(
                Anchor::on_platform(1, zero),
                Anchor::on_platform(1, Vector3::x()),
                rope(1.0),
            ),
            "same platform",
        ),
        (
            PlatformLoad::strut(
                Anchor::on_platform(0, zero),
                Anchor::on_platform(0, Vector3::x()),
                rope(1.0),
            ),
            "same platform",
        ),
        (
            PlatformLoad::strut(
                Anchor::on_platform(0, zero),
                Anchor::on_platform(1, zero),
                rope(f64::NAN),
            ),
            "tension is NaN, a finite number",
        ),
        (
            PlatformLoad::Wrench {
                platform: 0,
                point: zero,
                wrench: Wrench::zero(),
                turns: false,
            },
            "platform 0",
        ),
    ] {
        let error = build(load).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}
