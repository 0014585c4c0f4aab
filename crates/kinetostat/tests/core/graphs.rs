//! Graphs: several platforms, limbs between moving platforms, closed sub-loops, rigid bars.

use crate::common::{Rng, assert_equilibrium, balanced_error};
use crate::oracle::{Flat, Frames, balanced_solve, springs};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, DirectionKind, Limb, Mechanism, MotionKind, Platform, Pose,
    Posture, Twist, Wrench, moved, pose_residual, unloaded_tip,
};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3, Vector6, vector};

/// `K_C` of the unloaded nominal machine as one dense system over all coordinates, wrenches and
/// platforms: nothing is condensed. `[0 J A; J^T -K 0; A^T 0 0]`, with the tool held.
pub fn flat_stiffness(posture: &Posture<'_>) -> Matrix6<f64> {
    let m = posture.mechanism();
    let moving = m.platforms().len() - 1;
    let counts: Vec<usize> = m
        .limbs()
        .iter()
        .map(|l| l.nominal.coordinate_count())
        .collect();
    let size = 6 * moving + counts.iter().map(|n| n + 6).sum::<usize>();
    let mut a = DMatrix::zeros(size, size);
    let mut at = 6 * moving;
    for (i, limb) in m.limbs().iter().enumerate() {
        let n = counts[i];
        let joints = &posture.limbs()[i];
        let base = posture.platforms()[limb.from];
        let end = posture.platforms()[limb.to];
        let frames = Frames::new(&limb.nominal, &base, &joints.coordinates, &joints.commands);
        let tip = frames.tip();
        let j = frames.jacobian(tip);
        let (_, k, _) = springs(&limb.nominal, &joints.coordinates, &joints.coordinates);
        a.view_mut((at, at + 6), (6, n)).copy_from(&j);
        a.view_mut((at + 6, at), (n, 6)).copy_from(&j.transpose());
        a.view_mut((at + 6, at + 6), (n, n)).copy_from(&-k);
        let lever = |arm: Vector3<f64>| {
            let mut t = Matrix6::identity();
            t.fixed_view_mut::<3, 3>(0, 3)
                .copy_from(&-arm.cross_matrix());
            t
        };
        let p = frames.position(tip);
        for (platform, sign, origin) in [
            (limb.to, -1.0, end.translation.vector),
            (limb.from, 1.0, base.translation.vector),
        ] {
            if platform > 0 {
                let t = lever(p - origin) * sign;
                let column = 6 * (platform - 1);
                a.view_mut((at, column), (6, 6)).copy_from(&t);
                a.view_mut((column, at), (6, 6)).copy_from(&t.transpose());
            }
        }
        at += 6 + n;
    }
    // Rows of the platforms: minus the wrenches of the limbs; the tool is held by a wrench.
    let tool = 6 * (m.tool() - 1);
    let mut b = DMatrix::zeros(size, 6);
    for k in 0..6 {
        b.set_column(k, &-a.column(tool + k));
        a.column_mut(tool + k).fill(0.0);
        a[(tool + k, tool + k)] = 1.0;
    }
    balanced_solve(&a, &b)
        .fixed_view::<6, 6>(tool, 0)
        .into_owned()
}

pub fn limb(name: &str, from: usize, to: usize, tip: Pose, chain: Chain) -> Limb {
    Limb {
        name: name.into(),
        from,
        to,
        platform_from_tip: tip,
        nominal: chain.clone(),
        actual: chain,
    }
}

/// An arm of six driven joints with elastic links, its tip at the end of the last link.
pub fn serial(name: &str, scale: f64) -> Chain {
    let bar = BeamSection::tube(2.1e11, 8.1e10, 0.08 * scale, 0.06 * scale);
    let mut builder = Chain::builder(name);
    let axes = [
        (Vector3::z(), 0.3, 0.2),
        (Vector3::y(), -0.5, 1e-9),
        (Vector3::y(), 1.1, 0.8),
        (Vector3::x(), 0.2, 0.5),
        (Vector3::y(), 0.6, 0.3),
        (Vector3::x(), -0.4, 0.2),
    ];
    for (k, (axis, home, length)) in axes.into_iter().enumerate() {
        let mut drive = ActuatorSpec::new(MotionKind::Revolute, axis, 3e5 * scale);
        drive.home = home;
        drive.limits = Some((-3.1, 3.1));
        builder = builder.actuator(&format!("a{k}"), drive);
        if length > 1e-6 {
            builder = builder.link(&format!("l{k}"), &bar, length * scale);
        }
    }
    builder.build().unwrap()
}

/// Six telescopic legs with spherical ends between two platforms: points below and above.
pub fn legs(
    mut builder: kinetostat::MechanismBuilder,
    name: &str,
    from: usize,
    to: usize,
    height: f64,
    below: f64,
    above: f64,
    home: &Pose,
) -> kinetostat::MechanismBuilder {
    for i in 0..6 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let third = std::f64::consts::FRAC_PI_3 * 2.0 * f64::from(i / 2);
        let b = Vector3::new((third + side * 0.3).cos(), (third + side * 0.3).sin(), 0.0) * below;
        let s = third + side * 0.75;
        let a = Vector3::new(s.cos(), s.sin(), 0.0) * above;
        let way = home * nalgebra::Point3::from(a) - nalgebra::Point3::from(b);
        let (first, second) = turns(&way);
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 2e7);
        drive.home = way.norm();
        let chain = Chain::builder(format!("{name} leg {i}"))
            .translation(b)
            .passive("u1", MotionKind::Revolute, Vector3::x(), first)
            .passive("u2", MotionKind::Revolute, Vector3::y(), second)
            .actuator("slide", drive)
            .passive_spherical("s")
            .build()
            .unwrap();
        let _ = height;
        builder = builder.limb(limb(
            &format!("{name} leg {i}"),
            from,
            to,
            Pose::translation(a.x, a.y, a.z),
            chain,
        ));
    }
    builder
}

/// Rotations about x and then y that turn z along a direction.
fn turns(way: &Vector3<f64>) -> (f64, f64) {
    let w = way.normalize();
    let second = w.x.asin();
    ((-w.y).atan2(w.z), second)
}

/// A six-legged wrist on a serial arm.
pub fn arm_with_parallel_wrist(gravity: f64) -> Mechanism {
    let arm = serial("arm", 1.0);
    let flange = unloaded_tip(
        &arm,
        &Pose::identity(),
        &arm.home_coordinates(),
        &arm.home_commands(),
    );
    let offset = Pose::translation(0.01, -0.02, 0.25);
    let mut builder = Mechanism::builder("arm with a parallel wrist")
        .gravity(Vector3::new(0.0, 0.0, -gravity));
    let mut wrist = Platform::new("flange", flange);
    wrist.mass = 8.0;
    let wrist = builder.platform(wrist);
    let mut tool = Platform::new("tool", flange * offset);
    tool.mass = 5.0;
    let tool = builder.platform(tool);
    let builder = builder.limb(limb("arm", 0, wrist, Pose::identity(), arm));
    legs(builder, "wrist", wrist, tool, 0.25, 0.15, 0.1, &offset)
        .build()
        .unwrap()
}

/// A serial arm on a six-legged base.
pub fn arm_on_a_parallel_base(gravity: f64) -> Mechanism {
    let arm = serial("arm", 1.0);
    let lift = Pose::translation(0.05, 0.02, 0.6);
    let tip = unloaded_tip(
        &arm,
        &lift,
        &arm.home_coordinates(),
        &arm.home_commands(),
    );
    let mut builder = Mechanism::builder("arm on a parallel base")
        .gravity(Vector3::new(0.0, 0.0, -gravity));
    let mut table = Platform::new("table", lift);
    table.mass = 60.0;
    let table = builder.platform(table);
    let tool = builder.platform(Platform::new("tool", tip));
    let builder = legs(builder, "base", 0, table, 0.6, 0.6, 0.4, &lift);
    builder
        .limb(limb("arm", table, tool, Pose::identity(), arm))
        .build()
        .unwrap()
}

fn hybrids() -> Vec<Mechanism> {
    vec![arm_with_parallel_wrist(9.81), arm_on_a_parallel_base(9.81)]
}

/// Closure of all limbs and the tool at the target.
#[track_caller]
pub fn assert_closes(posture: &Posture<'_>) {
    let m = posture.mechanism();
    for (limb, joints) in m.limbs().iter().zip(posture.limbs()) {
        let base = posture.platforms()[limb.from];
        let tip = unloaded_tip(&limb.nominal, &base, &joints.coordinates, &joints.commands);
        let miss = pose_residual(
            &(posture.platforms()[limb.to] * limb.platform_from_tip),
            &tip,
        );
        assert!(miss.0.norm() < 1e-11, "{}: {:e}", limb.name, miss.0.norm());
    }
    assert_eq!(posture.platforms()[m.tool()], *posture.target());
}

#[test]
fn hybrids_are_commanded_anywhere() {
    let mut rng = Rng(4);
    for machine in hybrids() {
        let home = machine.platforms()[machine.tool()].home;
        let at_home = machine.posture(&home).unwrap();
        assert_closes(&at_home);
        for (limb, joints) in machine.limbs().iter().zip(at_home.limbs()) {
            for (found, home) in joints.commands.iter().zip(limb.nominal.home_commands()) {
                assert!((found - home).abs() < 1e-9, "{}", limb.name);
            }
        }
        let mut near = at_home.clone();
        for k in 0..6 {
            let target = moved(&home, &Twist::new(rng.vector(0.3), rng.vector(0.4)));
            let posture = machine.posture(&target).unwrap_or_else(|e| panic!("{k}: {e}"));
            assert_closes(&posture);
            near = machine.posture_near(&target, &near).unwrap();
            assert_closes(&near);
        }
    }
}

#[test]
fn hybrids_equal_the_flattened_system() {
    let mut rng = Rng(12);
    let mut worst = [0.0_f64; 3];
    for machine in hybrids() {
        let home = machine.platforms()[machine.tool()].home;
        for k in 0..3 {
            let target = moved(&home, &Twist::new(rng.vector(0.2), rng.vector(0.2)));
            let posture = machine.posture(&target).unwrap();
            let unloaded = posture.stiffness().unwrap();
            let flat = flat_stiffness(&posture);
            worst[0] = worst[0].max(balanced_error(&unloaded.cartesian.matrix, &flat));
            let wrench = rng.wrench(200.0, 30.0);
            let e = posture.deflected_by(&wrench).unwrap();
            assert_equilibrium(&posture, &e);
            let mut flat = Flat::at_rest(&posture);
            flat.load = wrench.0;
            flat.solve(false);
            let apart = pose_residual(&e.tool, &flat.platforms[machine.tool()]).0;
            worst[1] = worst[1].max(apart.norm() / e.displacement.0.norm());
            for (limb, w) in e.limbs.iter().zip(&flat.wrenches) {
                worst[2] = worst[2].max((limb.wrench.0 - w).norm() / w.norm());
            }
            let _ = k;
        }
    }
    println!("stiffness {:e}, displacement {:e}, wrenches {:e}", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 1e-12, "unloaded stiffness {:e}", worst[0]);
    assert!(worst[1] < 1e-10, "displacement {:e}", worst[1]);
    assert!(worst[2] < 1e-8, "wrenches {:e}", worst[2]);
}
