//! Graphs with many closed sub-loops: rigid bars between platforms, the double pantograph, towers and lattices of
//! platforms, against one dense flattened system and by the time they take.

use crate::common::{Rng, assert_equilibrium, scaled_error};
use crate::graphs::{assert_closes, flat_stiffness, legs, limb};
use crate::oracle::Flat;
use crate::platforms::lattice;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, DirectionKind, Mechanism, MotionKind, Platform, Pose, Twist,
    Wrench,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix6, Vector3, vector};

/// Two platforms on springs with a limb without any spring between them: `bar` is what joins them.
fn joined_by(bar: Chain, home_b: Pose) -> Mechanism {
    let mut rng = Rng(31);
    let home_a = Pose::translation(0.4, 0.0, 0.1);
    let mut builder = Mechanism::builder("joined").gravity(vector![0.0, 0.0, -9.81]);
    let mut a = Platform::new("a", home_a);
    a.mass = 6.0;
    let a = builder.platform(a);
    let b = builder.platform(Platform::new("b", home_b));
    let hold = |rng: &mut Rng, name: &str, home: &Pose| {
        let k = rng.spring_matrix(2e5, 4e3);
        Chain::builder(name)
            .rigid(*home)
            .spring6("s", &k, [0.0; 6])
            .build()
            .unwrap()
    };
    let (ka, kb) = (hold(&mut rng, "ka", &home_a), hold(&mut rng, "kb", &home_b));
    builder
        .limb(limb("ka", 0, a, Pose::identity(), ka))
        .limb(limb("bar", a, b, Pose::identity(), bar))
        .limb(limb("kb", 0, b, Pose::identity(), kb))
        .build()
        .unwrap()
}

fn rigid_bars() -> Vec<(&'static str, Mechanism)> {
    let span = Pose::from_parts(
        vector![0.35, 0.1, 0.05].into(),
        nalgebra::UnitQuaternion::from_euler_angles(0.2, -0.3, 0.4),
    );
    let home_b = Pose::translation(0.4, 0.0, 0.1) * span;
    let weld = Chain::builder("weld").rigid(span).build().unwrap();
    let rod = Chain::builder("rod")
        .passive_universal("u", Vector3::y(), Vector3::z())
        .rigid(span)
        .passive_spherical("s")
        .build()
        .unwrap();
    let hinge = Chain::builder("hinge")
        .translation(vector![0.1, 0.0, 0.0])
        .passive("h", MotionKind::Revolute, Vector3::y(), 0.0)
        .translation(vector![-0.1, 0.0, 0.0])
        .rigid(span)
        .build()
        .unwrap();
    vec![
        ("weld", joined_by(weld, home_b)),
        ("rod", joined_by(rod, home_b)),
        ("hinge", joined_by(hinge, home_b)),
    ]
}

/// Limbs without a spring between platforms against the flattened system: stiffness unloaded and
/// loaded, relative.
pub fn rigid_limbs_apart() -> [f64; 2] {
    let mut rng = Rng(8);
    let (mut worst, mut loaded) = (Worst::new(), Worst::new());
    for (name, machine) in rigid_bars() {
        let home = machine.platforms()[machine.tool()].home;
        let posture = machine.posture(&home).unwrap();
        let k = posture.stiffness().unwrap().cartesian.matrix;
        worst.add(scaled_error(&k, &flat_stiffness(&posture)));
        let target = moved(&home, &Twist::new(rng.vector(2e-3), rng.vector(5e-3)));
        let e = posture.wrench_at(&target).unwrap();
        assert_equilibrium(&posture, &e);
        assert!(e.stable(), "{name}");
        assert!(e.directions.iter().all(|d| d.kind == DirectionKind::Finite));
        let mut flat = Flat::at_state(&posture, &posture.rest_state(), &Wrench::zero());
        flat.platforms[machine.tool()] = target;
        flat.solve(true);
        let off = (e.wrench.0 - flat.load).norm() / flat.load.norm();
        assert!(off < 1e-8, "{name}: {off:e}");
        let off = scaled_error(&e.stiffness.matrix, &flat.stiffness());
        loaded.add(off);
        assert!(off < 1e-8, "{name}: {off:e}");
        let d = posture.deflected_by(&rng.wrench(100.0, 20.0)).unwrap();
        assert_equilibrium(&posture, &d);
        assert!(d.stable(), "{name}");
    }
    [worst.value(), loaded.value()]
}

/// Two pantographs that enlarge twice, the second driven by the first, all of pinned bars in a
/// plane. `bar` is put between pins; the tool turns freely on the last pin.
pub fn double_pantograph() -> Mechanism {
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.03, 0.02);
    let slide = |axis: Vector3<f64>| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7);
    let mut builder = Mechanism::builder("double pantograph");
    let mut limbs = Vec::new();
    // Everything in the plane x, z; pins turn about y. A bar of angle u points along (cos u, -sin u).
    let a = 0.2;
    let at = |x: f64, z: f64, angle: f64| {
        Pose::translation(x, 0.0, z) * Pose::rotation(Vector3::y() * angle)
    };
    let mut drive = at(0.12, 0.05, 0.0);
    let chain = Chain::builder("carriage")
        .rigid(drive)
        .actuator("x", slide(Vector3::x()))
        .actuator("z", slide(Vector3::z()))
        .build()
        .unwrap();
    let mut driven = builder.platform(Platform::new("pen 0", drive));
    limbs.push(limb("carriage", 0, driven, Pose::identity(), chain));
    let mut pivot = vector![0.0, 0.0];
    let mut turned = 0.0;
    for stage in 1..=2 {
        let size = a * f64::from(stage);
        let p = vector![drive.translation.x, drive.translation.z] - pivot;
        // Bars of length `size` from the pivot to A and from A to the pen.
        let (r, span) = (p.norm(), (-p.y).atan2(p.x));
        let open = (r / (2.0 * size)).acos();
        let (u, v) = (span + open, span - open);
        let along = |angle: f64| vector![angle.cos(), -angle.sin()] * size;
        let point = pivot + along(u);
        let end = pivot + 2.0 * p;
        let far = pivot + along(u) * 2.0;
        let mid = far + along(v);
        let name = |what: &str| format!("{what} {stage}");
        let first = builder.platform(Platform::new(name("A"), at(point.x, point.y, u)));
        let second = builder.platform(Platform::new(name("C"), at(mid.x, mid.y, v)));
        let pen_turned = if stage == 2 { 0.0 } else { v };
        let pen = builder.platform(Platform::new(name("pen"), at(end.x, end.y, pen_turned)));
        let bar = |what: &str, start: Option<f64>, angle_end: Option<f64>| {
            let mut chain = Chain::builder(name(what));
            if let Some(home) = start {
                chain = chain.passive("near", MotionKind::Revolute, Vector3::y(), home);
            }
            chain = chain.link("bar", &section, size);
            if let Some(home) = angle_end {
                chain = chain.passive("far", MotionKind::Revolute, Vector3::y(), home);
            }
            chain
        };
        let foot = Chain::builder(name("root"))
            .translation(vector![pivot.x, 0.0, pivot.y])
            .passive("near", MotionKind::Revolute, Vector3::y(), u)
            .link("bar", &section, size)
            .build()
            .unwrap();
        limbs.push(limb(&name("root"), 0, first, Pose::identity(), foot));
        // A to B and round the corner to C.
        let corner = Chain::builder(name("corner"))
            .link("upper", &section, size)
            .passive("B", MotionKind::Revolute, Vector3::y(), v - u)
            .link("outer", &section, size)
            .build()
            .unwrap();
        limbs.push(limb(
            &name("corner"),
            first,
            second,
            Pose::identity(),
            corner,
        ));
        let inner = bar("inner", Some(v - u), Some(turned - v)).build().unwrap();
        limbs.push(limb(&name("inner"), first, driven, Pose::identity(), inner));
        // C to the driven pen: back along the direction of the long arm.
        let back = bar(
            "back",
            Some(u - v + std::f64::consts::PI),
            Some(turned - u - std::f64::consts::PI),
        );
        limbs.push(limb(
            &name("back"),
            second,
            driven,
            Pose::identity(),
            back.build().unwrap(),
        ));
        // The tool turns on the last pin; the pen between is fixed to its bar.
        let pin = (stage == 2).then_some(-v);
        let last = bar("last", None, pin).build().unwrap();
        limbs.push(limb(&name("last"), second, pen, Pose::identity(), last));
        driven = pen;
        drive = at(end.x, end.y, 0.0);
        turned = pen_turned;
        pivot = vector![0.1, -0.1];
    }
    for own in limbs {
        builder = builder.limb(own);
    }
    builder.build().unwrap()
}

#[test]
fn a_double_pantograph_enlarges_four_times() {
    let machine = double_pantograph();
    let home = machine.platforms()[machine.tool()].home;
    let at_home = machine.posture(&home).unwrap();
    assert_closes(&at_home);
    let first = at_home.commands();
    for (x, z) in [(0.06, 0.02), (-0.04, 0.05), (0.03, -0.08)] {
        let target = Pose::translation(x, 0.0, z) * home;
        let posture = machine.posture(&target).unwrap();
        assert_closes(&posture);
        let found = posture.commands();
        assert!((found[0] - first[0] - x / 4.0).abs() < 1e-11, "{found:?}");
        assert!((found[1] - first[1] - z / 4.0).abs() < 1e-11, "{found:?}");
        let k = posture.stiffness().unwrap();
        let flat = flat_stiffness(&posture);
        let off = scaled_error(&k.cartesian.matrix, &flat);
        assert!(off < 1e-9, "{off:e}");
        let e = posture
            .deflected_by(&Wrench::new(vector![20.0, 5.0, -30.0], Vector3::zeros()))
            .unwrap();
        assert_equilibrium(&posture, &e);
    }
}

/// A tower: every platform stands on six legs on the one below.
pub fn tower(floors: usize) -> Mechanism {
    let lift = Pose::translation(0.01, 0.0, 0.3);
    let mut builder = Mechanism::builder("tower").gravity(vector![0.0, 0.0, -9.81]);
    let mut home = Pose::identity();
    let mut all = vec![0];
    for k in 0..floors {
        home *= lift;
        let mut platform = Platform::new(format!("floor {k}"), home);
        platform.mass = 0.05;
        all.push(builder.platform(platform));
    }
    for pair in all.windows(2) {
        builder = legs(
            builder,
            &format!("{}", pair[1]),
            pair[0],
            pair[1],
            0.25,
            0.2,
            &lift,
        );
    }
    builder.build().unwrap()
}

/// Platforms in a lattice, sparse, against the flattened system: unloaded stiffness and
/// displacement under load, relative.
pub fn lattice_apart(rigid: bool) -> [f64; 2] {
    let machine = lattice(4, 3, rigid).unwrap();
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    assert_closes(&posture);
    let k = posture.stiffness().unwrap();
    assert_eq!(k.rank(), 6);
    let flat = flat_stiffness(&posture);
    let pull = Wrench::new(vector![3e3, -2e3, 5e3], vector![400.0, 200.0, -500.0]);
    let e = posture.deflected_by(&pull).unwrap();
    assert_equilibrium(&posture, &e);
    assert!(e.stable());
    let mut dense = Flat::at_state(&posture, &e.state, &pull);
    dense.solve(false);
    let apart = pose_residual(&e.tool, &dense.platforms[machine.tool()]).0;
    [
        scaled_error(&k.cartesian.matrix, &flat),
        apart.norm() / e.displacement.0.norm(),
    ]
}

#[test]
fn a_lattice_of_platforms_is_its_flattened_system() {
    for rigid in [false, true] {
        let [stiffness, displacement] = lattice_apart(rigid);
        assert!(stiffness < 1e-12, "{rigid}: {stiffness:e}");
        assert!(displacement < 1e-11, "{rigid}: {displacement:e}");
    }
}

/// Seconds for the unloaded stiffness, an equilibrium and a target elsewhere of a lattice.
pub fn lattice_times(rows: usize, columns: usize) -> [f64; 3] {
    let machine = lattice(rows, columns, false).unwrap();
    let home = machine.platforms()[machine.tool()].home;
    let clock = std::time::Instant::now;
    let start = clock();
    let posture = machine.posture(&home).unwrap();
    assert_eq!(posture.stiffness().unwrap().rank(), 6);
    let unloaded = start.elapsed();
    let start = clock();
    let pull = Wrench::new(vector![300.0, -200.0, 500.0], vector![40.0, 20.0, -50.0]);
    let e = posture.deflected_by(&pull).unwrap();
    let loaded = start.elapsed();
    assert_equilibrium(&posture, &e);
    assert!(e.stable());
    let start = clock();
    let target = moved(
        &home,
        &Twist::new(vector![0.01, 0.0, 0.01], Vector3::zeros()),
    );
    let elsewhere = machine.posture(&target).unwrap();
    let searched = start.elapsed();
    assert_closes(&elsewhere);
    [unloaded, loaded, searched].map(|t| t.as_secs_f64())
}

/// Seconds for the unloaded stiffness, an equilibrium and a target elsewhere, and how far the
/// compliance is from that of floors in series, relative.
pub fn tower_of(floors: usize) -> [f64; 4] {
    {
        let machine = tower(floors);
        let home = machine.platforms()[machine.tool()].home;
        let start = std::time::Instant::now();
        let posture = machine.posture(&home).unwrap();
        let k = posture.stiffness().unwrap();
        let unloaded = start.elapsed();
        let start = std::time::Instant::now();
        let pull = Wrench::new(vector![1.0, 0.4, -2.0], vector![0.1, 0.0, 0.2]);
        let e = posture.deflected_by(&pull).unwrap();
        let loaded = start.elapsed();
        assert_equilibrium(&posture, &e);
        assert!(e.stable());
        let start = std::time::Instant::now();
        let target = moved(
            &home,
            &Twist::new(vector![0.1, 0.0, 0.05], vector![0.0, 0.1, 0.1]),
        );
        let elsewhere = machine.posture(&target).unwrap();
        let searched = start.elapsed();
        assert_closes(&elsewhere);
        // Floors in series: the compliance by hand, one flat system per floor, shifted to the tool.
        let one = tower(1);
        let lift = one.platforms()[1].home;
        let single = flat_stiffness(&one.posture(&lift).unwrap())
            .try_inverse()
            .unwrap();
        let mut compliance = Matrix6::zeros();
        for floor in 1..=floors {
            let arm = home.translation.vector - machine.platforms()[floor].home.translation.vector;
            let mut t = Matrix6::identity();
            t.fixed_view_mut::<3, 3>(0, 3)
                .copy_from(&-arm.cross_matrix());
            compliance += t * single * t.transpose();
        }
        let found = k.cartesian.matrix.try_inverse().unwrap();
        let off = scaled_error(&found, &compliance);
        let [a, b, c] = [unloaded, loaded, searched].map(|t| t.as_secs_f64());
        [a, b, c, off]
    }
}
