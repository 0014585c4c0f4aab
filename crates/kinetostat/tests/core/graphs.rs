//! Graphs: several platforms, limbs between moving platforms, redundant actuators, errors and wrenches on any
//! platform. Closed sub-loops of bars are in `pantographs_and_lattices`.

use crate::common::{Rng, assert_equilibrium, scaled_error};
use crate::oracle::{Flat, Frames, scaled_solve, springs};
use crate::platforms::{anchors, leg};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Directions, Limb, Mechanism, MotionKind, Platform, Pose,
    Posture, PostureRequest, Settings, Twist, Wrench, compensate,
    model::unloaded_tip,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Matrix6, Vector3, vector};

/// `K_C` of the unloaded nominal machine as one dense system over all coordinates, wrenches and
/// platforms: nothing is condensed. `[0 J A; J^T -K 0; A^T 0 0]`, with the tool held.
pub fn flat_stiffness(posture: &Posture) -> Matrix6<f64> {
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
    scaled_solve(&a, &b)
        .fixed_view::<6, 6>(tool, 0)
        .into_owned()
}

pub fn limb(name: &str, from: usize, to: usize, tip: Pose, chain: Chain) -> Limb {
    Limb::between(name, from, to, chain).fixed_at(tip)
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
    below: f64,
    above: f64,
    home: &Pose,
) -> kinetostat::MechanismBuilder {
    for i in 0..6 {
        let ends = anchors(i, [below, above]);
        let own = leg(&format!("{name} leg {i}"), from, to, ends, home, false);
        builder = builder.limb(own.unwrap());
    }
    builder
}

/// Rotations about x and then y that turn z along a direction.
pub fn turns(span: &Vector3<f64>) -> (f64, f64) {
    let w = span.normalize();
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
    let mut builder =
        Mechanism::builder("arm with a parallel wrist").gravity(Vector3::new(0.0, 0.0, -gravity));
    let mut wrist = Platform::new("flange", flange);
    wrist.mass = 8.0;
    let wrist = builder.platform(wrist);
    let mut tool = Platform::new("tool", flange * offset);
    tool.mass = 5.0;
    let tool = builder.platform(tool);
    let builder = builder.limb(limb("arm", 0, wrist, Pose::identity(), arm));
    legs(builder, "wrist", wrist, tool, 0.15, 0.1, &offset)
        .build()
        .unwrap()
}

/// A serial arm on a six-legged base.
pub fn arm_on_a_parallel_base(gravity: f64) -> Mechanism {
    let arm = serial("arm", 1.0);
    let lift = Pose::translation(0.05, 0.02, 0.6);
    let tip = unloaded_tip(&arm, &lift, &arm.home_coordinates(), &arm.home_commands());
    let mut builder =
        Mechanism::builder("arm on a parallel base").gravity(Vector3::new(0.0, 0.0, -gravity));
    let mut table = Platform::new("table", lift);
    table.mass = 60.0;
    let table = builder.platform(table);
    let tool = builder.platform(Platform::new("tool", tip));
    let builder = legs(builder, "base", 0, table, 0.6, 0.4, &lift);
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
pub fn assert_closes(posture: &Posture) {
    let m = posture.mechanism();
    for (limb, joints) in m.limbs().iter().zip(posture.limbs()) {
        let base = posture.platforms()[limb.from];
        let tip = unloaded_tip(&limb.nominal, &base, &joints.coordinates, &joints.commands);
        let residual = pose_residual(
            &(posture.platforms()[limb.to] * limb.platform_from_tip),
            &tip,
        );
        assert!(
            residual.0.norm() < 1e-11,
            "{}: {:e}",
            limb.name,
            residual.0.norm()
        );
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
            let posture = machine
                .posture(&target)
                .unwrap_or_else(|e| panic!("{k}: {e}"));
            assert_closes(&posture);
            near = machine
                .posture(PostureRequest::pose(&target).near(&near))
                .unwrap();
            assert_closes(&near);
        }
    }
}

/// Hybrids against the flattened system: unloaded stiffness, displacement under load, wrenches of
/// limbs, relative.
pub fn hybrids_apart() -> [f64; 3] {
    let mut rng = Rng(12);
    let mut worst = <[Worst; 3]>::default();
    for machine in hybrids() {
        let home = machine.platforms()[machine.tool()].home;
        for _ in 0..3 {
            let target = moved(&home, &Twist::new(rng.vector(0.2), rng.vector(0.2)));
            let posture = machine.posture(&target).unwrap();
            let unloaded = posture.stiffness().unwrap();
            let flat = flat_stiffness(&posture);
            worst[0].add(scaled_error(&unloaded.cartesian.matrix, &flat));
            let wrench = rng.wrench(200.0, 30.0);
            let e = posture.deflected_by(&wrench).unwrap();
            assert_equilibrium(&posture, &e);
            let mut flat = Flat::at_rest(&posture);
            flat.load = wrench.0;
            flat.solve(false);
            let apart = pose_residual(&e.tool, &flat.platforms[machine.tool()]).0;
            worst[1].add(apart.norm() / e.displacement.0.norm());
            for (limb, w) in e.limbs.iter().zip(&flat.wrenches) {
                worst[2].add((limb.wrench.0 - w).norm() / w.norm());
            }
        }
    }
    worst.map(|w| w.value())
}

#[test]
fn hybrids_are_compensated() {
    let mut rng = Rng(6);
    for machine in hybrids() {
        let home = machine.platforms()[machine.tool()].home;
        let wrench = rng.wrench(200.0, 20.0);
        let all = Directions::ALL;
        let found = compensate(&machine, &home, &wrench, all, &Settings::default()).unwrap();
        let again = found.posture.deflected_by(&wrench).unwrap();
        let residual = pose_residual(&again.tool, &home).0.norm();
        assert!(residual < 1e-10, "{}: {residual:e}", machine.name());
    }
}

/// A gantry (two slides) that carries six legs: two actuators too many.
fn gantry_with_legs() -> Mechanism {
    let slide = |axis: Vector3<f64>| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7);
    let gantry = Chain::builder("gantry")
        .actuator("x", slide(Vector3::x()))
        .actuator("y", slide(Vector3::y()))
        .build()
        .unwrap();
    let offset = Pose::translation(0.0, 0.0, 0.5);
    let mut builder = Mechanism::builder("gantry with legs");
    let carriage = builder.platform(Platform::new("carriage", Pose::identity()));
    let tool = builder.platform(Platform::new("tool", offset));
    let builder = builder.limb(limb("gantry", 0, carriage, Pose::identity(), gantry));
    legs(builder, "legs", carriage, tool, 0.3, 0.2, &offset)
        .build()
        .unwrap()
}

#[test]
fn redundant_actuators_take_the_commands_nearest_to_home() {
    let machine = gantry_with_legs();
    let home = machine.platforms()[machine.tool()].home;
    let target = moved(
        &home,
        &Twist::new(vector![0.12, -0.07, 0.05], vector![0.1, 0.05, 0.15]),
    );
    let posture = machine.posture(&target).unwrap();
    assert_closes(&posture);
    assert_eq!(posture.redundancy(), 2);
    let first = machine.posture(&home).unwrap().commands();
    // Leg lengths in closed form for any place of the carriage.
    let cost = |x: f64, y: f64| {
        let carriage = Pose::translation(x, y, 0.0);
        let mut sum = x * x + y * y;
        for (k, limb) in machine.limbs()[1..].iter().enumerate() {
            let below = match limb.nominal.elements()[0] {
                kinetostat::model::Element::Rigid(pose) => pose.translation.vector,
                _ => panic!("a leg starts with its foot"),
            };
            let above = (target * limb.platform_from_tip).translation.vector;
            let length = (above - (carriage * nalgebra::Point3::from(below)).coords).norm();
            sum += (length - first[2 + k]).powi(2);
        }
        sum
    };
    let own = posture.commands();
    let own_cost: f64 = own.iter().zip(&first).map(|(a, b)| (a - b).powi(2)).sum();
    assert!((own_cost - cost(own[0], own[1])).abs() < 1e-10);
    let mut least = f64::INFINITY;
    for i in -100..=100 {
        for j in -100..=100 {
            least = least.min(cost(f64::from(i) * 2e-3, f64::from(j) * 2e-3));
        }
    }
    assert!(own_cost < 1.02 * least, "{own_cost:e} {least:e}");
    for other in hybrids() {
        let at = other
            .posture(&other.platforms()[other.tool()].home)
            .unwrap();
        assert_eq!(
            at.redundancy(),
            6,
            "six drives in the arm and six in the legs"
        );
    }
}

/// Errors of the limbs of a graph, loads on any platform, springs between its limbs.
#[test]
fn a_graph_with_errors_strains_itself_to_first_order() {
    let mut rng = Rng(77);
    let mut worst = <[Worst; 2]>::default();
    for size in [1e-6, 1e-7] {
        let mut builder = Mechanism::builder("ring");
        let homes = [
            Pose::identity(),
            Pose::translation(0.3, 0.0, 0.2) * Pose::rotation(vector![0.2, 0.1, -0.3]),
            Pose::translation(0.6, 0.1, 0.3) * Pose::rotation(vector![-0.2, 0.4, 0.1]),
        ];
        let a = builder.platform(Platform::new("a", homes[1]));
        let tool = builder.platform(Platform::new("tool", homes[2]));
        for (name, from, to) in [("1", 0, a), ("2", a, tool), ("3", 0, tool), ("4", a, tool)] {
            let arm = rng.pose(0.1, 0.5);
            let span = homes[from].inverse() * homes[to] * arm;
            let k = rng.spring_matrix(1e6, 1e4);
            let error = Pose::translation(size, -2.0 * size, size * f64::from(from as u8 + 1))
                * Pose::rotation(vector![3.0 * size, size, -size]);
            let build = |error: Pose| {
                let mut chain = Chain::builder(name).rigid(span).rigid(error);
                if name != "4" {
                    chain = chain.spring6("s", &k, [0.0; 6]);
                }
                if name == "2" {
                    chain = chain.passive("q", MotionKind::Revolute, Vector3::z(), 0.0);
                }
                if name == "4" {
                    // Rigid but for a ball joint.
                    chain = chain.passive_spherical("q");
                }
                chain.build().unwrap()
            };
            builder = builder.limb(
                Limb::between(name, from, to, build(Pose::identity()))
                    .with_actual(build(error))
                    .fixed_at(arm),
            );
        }
        let machine = builder.build().unwrap();
        let posture = machine.posture(&homes[2]).unwrap();
        let linear = posture.linear_assembly(&posture.assembly_errors()).unwrap();
        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        assert_equilibrium(&posture, &e);
        let apart = (e.displacement.0 - linear.shift.0).norm() / linear.shift.0.norm();
        worst[0].add(apart / size);
        for (limb, wrench) in e.limbs.iter().zip(&linear.wrenches) {
            assert!(wrench.0.norm() > 0.0);
            let apart = (limb.wrench.0 - wrench.0).norm() / limb.wrench.0.norm();
            worst[1].add(apart / size);
        }
    }
    let worst = worst.map(|w| w.value());
    assert!(worst.iter().all(|w| *w < 1e3), "{worst:?}");
}

#[test]
fn wrenches_act_on_any_platform_and_springs_between_limbs_are_limbs() {
    for machine in hybrids() {
        let home = machine.platforms()[machine.tool()].home;
        let posture = machine.posture(&home).unwrap();
        let push = Wrench::new(vector![150.0, -80.0, 60.0], vector![5.0, 3.0, -4.0]);
        assert!(posture.clone().with_wrench_on(0, push).is_err());
        assert!(posture.clone().with_wrench_on(9, push).is_err());
        let tool = machine.tool();
        // On the tool it is the wrench on the tool.
        let by_argument = posture.deflected_by(&push).unwrap();
        let on_tool = posture.clone().with_wrench_on(tool, push).unwrap();
        let found = on_tool.deflected_by(&Wrench::zero()).unwrap();
        let apart = pose_residual(&by_argument.tool, &found.tool).0.norm();
        assert!(apart < 1e-12, "{apart:e}");
        // Work: what moves the other platform is the other's motion under the first (Betti).
        let small = |w: &Wrench| Wrench(w.0 * 1e-3);
        let pull = Wrench::new(vector![-20.0, 90.0, 40.0], vector![-2.0, 6.0, 1.0]);
        let rest = posture.deflected_by(&Wrench::zero()).unwrap();
        let with = |platform: usize, wrench: &Wrench| {
            let p = posture.clone().with_wrench_on(platform, *wrench).unwrap();
            p.deflected_from(&Wrench::zero(), rest.state.clone())
                .unwrap()
        };
        let motion = |platform: usize, e: &kinetostat::MechanismEquilibrium| {
            pose_residual(
                &e.state.platforms[platform],
                &rest.state.platforms[platform],
            )
        };
        let (a, b) = (with(1, &small(&push)), with(tool, &small(&pull)));
        let first = motion(tool, &a).dot(&small(&pull));
        let second = motion(1, &b).dot(&small(&push));
        let off = (first - second).abs() / first.abs();
        assert!(off < 1e-3, "{first:e} {second:e}");
    }
    // A spring between two moving platforms: a limb of ball joint, slide with a spring, ball joint.
    let (k, rest) = (3e4, 0.25);
    let mut machines = Vec::new();
    for sprung in [false, true] {
        let machine = arm_with_parallel_wrist(9.81);
        let (flange, tool) = (1, machine.tool());
        let mut builder = Mechanism::builder("sprung").gravity(machine.gravity());
        for platform in &machine.platforms()[1..] {
            builder.platform(platform.clone());
        }
        for own in machine.limbs() {
            builder = builder.limb(own.clone());
        }
        let (below, above) = (vector![0.05, 0.02, 0.03], vector![-0.02, 0.01, 0.0]);
        if sprung {
            let offset = Pose::translation(0.01, -0.02, 0.25);
            let span = (offset * nalgebra::Point3::from(above)).coords - below;
            let (first, second) = turns(&span);
            let chain = Chain::builder("spring")
                .translation(below)
                .passive("u1", MotionKind::Revolute, Vector3::x(), first)
                .passive("u2", MotionKind::Revolute, Vector3::y(), second)
                .spring("slide", MotionKind::Prismatic, Vector3::z(), k, rest)
                .home("slide", span.norm())
                .passive_spherical("s")
                .build()
                .unwrap();
            let tip = Pose::translation(above.x, above.y, above.z);
            builder = builder.limb(limb("spring", flange, tool, tip, chain));
        }
        machines.push((builder.build().unwrap(), below, above));
    }
    let (machine, below, above) = &machines[1];
    let (flange, tool) = (1, machine.tool());
    let home = machine.platforms()[tool].home;
    let sprung = machine.posture(&home).unwrap();
    let e = sprung.deflected_by(&Wrench::zero()).unwrap();
    assert_equilibrium(&sprung, &e);
    // Statics by hand: the force of the spring as dead forces on both platforms of the machine
    // without it gives the same rest.
    let (p, q) = (&e.state.platforms[flange], &e.state.platforms[tool]);
    let (foot, head) = (p.rotation * below, q.rotation * above);
    let span = q.translation.vector + head - p.translation.vector - foot;
    let force = span.normalize() * (k * (span.norm() - rest));
    let bare = machines[0].0.posture(&home).unwrap();
    let bare = bare
        .with_wrench_on(flange, Wrench::new(force, foot.cross(&force)))
        .unwrap()
        .with_wrench_on(tool, Wrench::new(-force, -head.cross(&force)))
        .unwrap();
    let same = bare.deflected_by(&Wrench::zero()).unwrap();
    let apart = pose_residual(&same.tool, &e.tool).0.norm();
    assert!(force.norm() > 10.0);
    assert!(apart < 1e-11, "{apart:e}");
}
