//! Parallel machines in space (3-PUU, hexapods, Delta, Tripteron) against closed forms, what their errors of
//! manufacture do, and how near a singular posture is. Those in a plane are in `planar_machines`.

use crate::common::{Orthoglide, Rng, assert_equilibrium, orthoglide_point, scaled_error};
use crate::graphs::limb;
use crate::planar_machines::truss;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, DirectionKind, Directions, Limb, Mechanism, MotionKind,
    Platform, Pose, Twist, Wrench, machine::SingularityKind, spatial::moved,
};
use kinetostat_testing::{LargestEntry, Worst, largest};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};

pub const THIRD: f64 = 2.0 * std::f64::consts::FRAC_PI_3;

/// Three PUU legs; `error` bends the feet of the machine as built.
fn puu(error: f64) -> Mechanism {
    let bar = BeamSection::tube(2.1e11, 8.1e10, 0.022, 0.014);
    let mut machine = Mechanism::builder("3-PUU");
    let tool = machine.platform(Platform::new("tool", Pose::identity()));
    for (k, (name, turns)) in [("x", 0.0), ("y", 1.0), ("z", 2.0)].into_iter().enumerate() {
        let turned = Pose::rotation(Vector3::repeat(1.0).normalize() * (THIRD * turns));
        let build = |error: f64| {
            let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6);
            drive.home = -0.34;
            Chain::builder(name)
                .rigid(turned)
                .actuator("drive", drive)
                .rigid(Pose::rotation(vector![error, -0.5 * error, 0.3 * error]))
                .translation(vector![0.0, 0.01 * error, 0.0])
                .passive_universal("foot joint", Vector3::z(), Vector3::y())
                .link("bar", &bar, 0.31)
                .passive_universal("head joint", Vector3::y(), Vector3::z())
                .translation(vector![0.03, 0.0, 0.0])
                .rigid(turned.inverse())
                .build()
                .unwrap()
        };
        machine = machine.limb(
            Limb::between(name, 0, tool, build(0.0))
                .with_actual(build(error * (1.0 + 0.3 * k as f64))),
        );
    }
    machine.build().unwrap()
}

/// Largest wrench in a limb of a machine with errors and no load, as a share of stiffness times
/// shift: a determinate 3-PUU, and the over-constrained Orthoglide.
pub fn internal_wrenches() -> [f64; 2] {
    let machine = puu(0.02);
    let target = Pose::translation(0.02, -0.01, 0.03);
    let posture = machine.posture(&target).unwrap();
    assert_eq!(posture.overconstraint().degree, 0);
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    assert_equilibrium(&posture, &e);
    let shift = e.displacement.0.norm();
    assert!(shift > 1e-5, "the errors move the tool: {shift:e}");
    // Against the wrenches that such a shift would cost if the tool were held.
    let k = e.stiffness.matrix.largest_entry();
    let internal = largest(e.limbs.iter().map(|l| l.wrench.0.norm()));
    let determinate = internal / (k * shift);
    let linear = posture.linear_assembly(&posture.assembly_errors()).unwrap();
    let most = largest(linear.wrenches.iter().map(|w| w.0.norm()));
    assert!(most < 1e-9 * k * shift, "{most:e}");

    let machine = Orthoglide {
        line_error: 1_f64.to_radians(),
        ..Default::default()
    }
    .build();
    let posture = machine.posture(&orthoglide_point(1)).unwrap();
    let over = posture.overconstraint();
    assert_eq!(over.degree, 3);
    for stress in &over.stresses {
        assert!(stress.description(&posture).contains("moment about"));
        // In equilibrium on the platform.
        let sum = stress
            .wrenches
            .iter()
            .fold(Vector6::zeros(), |s, (_, w)| s + w.0);
        assert!(sum.norm() < 1e-9, "{sum}");
        assert!(stress.wrenches.len() >= 2);
    }
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    let internal = largest(e.limbs.iter().map(|l| l.wrench.0.norm()));
    let size = e.stiffness.matrix.largest_entry() * e.displacement.0.norm();
    [determinate, internal / size]
}

/// `sum k n n^T` of legs that take axial force only, by hand.
fn by_legs(k: f64, ends: &[(Vector3<f64>, Vector3<f64>)], pose: &Pose) -> Matrix6<f64> {
    ends.iter().fold(Matrix6::zeros(), |sum, (below, above)| {
        let arm = pose.rotation * above;
        let n = (pose.translation.vector + arm - below).normalize();
        let m = arm.cross(&n);
        let row = Vector6::new(n.x, n.y, n.z, m.x, m.y, m.z);
        sum + row * row.transpose() * k
    })
}

pub fn hexapod(k: f64, ends: &[(Vector3<f64>, Vector3<f64>)], home: &Pose) -> Mechanism {
    let mut builder = Mechanism::builder("hexapod");
    let tool = builder.platform(Platform::new("tool", *home));
    for (i, (below, above)) in ends.iter().enumerate() {
        let span = (home * nalgebra::Point3::from(*above)).coords - below;
        let w = span.normalize();
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), k);
        drive.home = span.norm();
        let chain = Chain::builder(format!("leg {i}"))
            .translation(*below)
            .passive("u1", MotionKind::Revolute, Vector3::x(), (-w.y).atan2(w.z))
            .passive("u2", MotionKind::Revolute, Vector3::y(), w.x.asin())
            .actuator("slide", drive)
            .passive_spherical("s")
            .build()
            .unwrap();
        let tip = Pose::translation(above.x, above.y, above.z);
        builder = builder.limb(limb(&format!("leg {i}"), 0, tool, tip, chain));
    }
    builder.build().unwrap()
}

/// Six legs at home, off home and turned against `sum k n n^T`, relative.
pub fn hexapod_apart() -> f64 {
    let mut rng = Rng(2);
    // Pairs of legs, as in [R 3.35]: a feet at 0, 120, 240 degrees, heads in between.
    let on = |r: f64, degrees: f64| {
        let a = degrees.to_radians();
        vector![r * a.cos(), r * a.sin(), 0.0]
    };
    let mut ends = Vec::new();
    for k in 0..3 {
        let turn = 120.0 * f64::from(k);
        ends.push((on(0.6, turn - 10.0), on(0.3, turn - 50.0)));
        ends.push((on(0.6, turn + 10.0), on(0.3, turn + 50.0)));
    }
    let home = Pose::translation(0.0, 0.0, 0.7);
    let machine = hexapod(3e7, &ends, &home);
    let mut worst = Worst::new();
    for step in 0..6 {
        let twist = Twist::new(rng.vector(0.1), rng.vector(0.3));
        let target = if step == 0 {
            home
        } else {
            moved(&home, &twist)
        };
        let posture = machine.posture(&target).unwrap();
        for (command, (below, above)) in posture.commands().iter().zip(&ends) {
            let span = (target * nalgebra::Point3::from(*above)).coords - below;
            assert!((command - span.norm()).abs() < 1e-12);
        }
        let k = posture.stiffness().unwrap().cartesian.matrix;
        worst.add(scaled_error(&k, &by_legs(3e7, &ends, &target)));
        assert_eq!(posture.overconstraint().degree, 0);
        assert_eq!(posture.redundancy(), 0);
    }
    worst.value()
}

/// Stewart's cubic hexapod against its closed form, relative.
pub fn cubic_hexapod_apart() -> f64 {
    // Edges of a cube that meet neither of two opposite corners: `sum n n^T = 2`, nothing couples,
    // and about the centre each has the moment a/sqrt 2, of which a/sqrt 3 along the diagonal. So
    // translations are isotropic, rotations about the diagonal four times as stiff as across.
    let a = 0.8;
    let corner = |x: f64, y: f64, z: f64| (vector![x, y, z] - Vector3::repeat(0.5)) * a;
    let path = [
        corner(1.0, 0.0, 0.0),
        corner(1.0, 1.0, 0.0),
        corner(0.0, 1.0, 0.0),
        corner(0.0, 1.0, 1.0),
        corner(0.0, 0.0, 1.0),
        corner(1.0, 0.0, 1.0),
    ];
    // Upright along the diagonal, so that feet are below and heads above.
    let diagonal = Vector3::repeat(1.0);
    let up = nalgebra::Rotation3::rotation_between(&diagonal, &Vector3::z()).unwrap();
    let ends: Vec<(Vector3<f64>, Vector3<f64>)> = (0..6)
        .map(|i| {
            let (p, q) = (up * path[i], up * path[(i + 1) % 6]);
            if p.z < q.z { (p, q) } else { (q, p) }
        })
        .collect();
    let k = 1e7;
    let machine = hexapod(k, &ends, &Pose::identity());
    let found = machine
        .posture(&Pose::identity())
        .unwrap()
        .stiffness()
        .unwrap();
    let mut expected = Matrix6::identity() * (2.0 * k);
    for (i, share) in [(3, 0.5), (4, 0.5), (5, 2.0)] {
        expected[(i, i)] = share * k * a * a;
    }
    scaled_error(&found.cartesian.matrix, &expected)
}

/// A Delta: driven arms are platforms, each with two rigid rods to the tool.
fn delta(k: f64) -> (Mechanism, f64) {
    (delta_with(k, 0.7, 0.4), 0.7)
}

/// With rods of another length, its arms that far below the level at home (rad).
fn delta_with(k: f64, rod: f64, down: f64) -> Mechanism {
    let (base, arm, head, half) = (0.2, 0.3, 0.06, 0.05);
    let reach = base + arm * down.cos() - head;
    let height = -(arm * down.sin()) - (rod * rod - reach * reach).sqrt();
    let home = Pose::translation(0.0, 0.0, height);
    let mut builder = Mechanism::builder("delta");
    let mut list = Vec::new();
    for i in 0..3 {
        let turned = Pose::rotation(Vector3::z() * (THIRD * f64::from(i)));
        let mut drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::y(), k);
        drive.home = down;
        let chain = Chain::builder(format!("arm {i}"))
            .rigid(turned)
            .translation(vector![base, 0.0, 0.0])
            .actuator("shoulder", drive)
            .translation(vector![arm, 0.0, 0.0])
            .build()
            .unwrap();
        let place = turned
            * Pose::translation(base, 0.0, 0.0)
            * Pose::rotation(Vector3::y() * down)
            * Pose::translation(arm, 0.0, 0.0);
        let elbow = builder.platform(Platform::new(format!("elbow {i}"), place));
        list.push((elbow, chain, turned, place));
    }
    let tool = builder.platform(Platform::new("tool", home));
    for (i, (elbow, chain, turned, place)) in list.into_iter().enumerate() {
        builder = builder.limb(limb(&format!("arm {i}"), 0, elbow, Pose::identity(), chain));
        for (name, side) in [("left", half), ("right", -half)] {
            let foot = vector![0.0, side, 0.0];
            let top = turned * Pose::translation(head, side, 0.0);
            let span = place.inverse()
                * ((home * top).translation.vector - (place * nalgebra::Point3::from(foot)).coords);
            let w = span.normalize();
            let chain = Chain::builder(format!("rod {i} {name}"))
                .translation(foot)
                .passive("u1", MotionKind::Revolute, Vector3::x(), (-w.y).atan2(w.z))
                .passive("u2", MotionKind::Revolute, Vector3::y(), w.x.asin())
                .translation(Vector3::z() * rod)
                .passive_spherical("s")
                .build()
                .unwrap();
            builder = builder.limb(limb(
                &format!("rod {i} {name}"),
                elbow,
                tool,
                Pose::from_parts(top.translation, nalgebra::UnitQuaternion::identity()),
                chain,
            ));
        }
    }
    builder.build().unwrap()
}

/// A Delta of platforms and rigid rods against `J^-T k J^-1`, relative.
pub fn delta_apart() -> f64 {
    let k = 4000.0;
    let (machine, rod) = delta(k);
    let home = machine.platforms()[machine.tool()].home;
    let mut worst = Worst::new();
    for offset in [
        Vector3::zeros(),
        vector![0.1, -0.05, 0.08],
        vector![-0.12, 0.1, -0.05],
    ] {
        let target = Pose::translation(offset.x, offset.y, offset.z) * home;
        let posture = machine.posture(&target).unwrap();
        // v_tool . n = theta' (y x r) . n for every arm.
        let mut expected = Matrix3::zeros();
        for i in 0..3 {
            let turned = Pose::rotation(Vector3::z() * (THIRD * i as f64));
            let theta = posture.commands()[i];
            let r = turned.rotation * (Pose::rotation(Vector3::y() * theta) * Vector3::x() * 0.3);
            let elbow = turned.rotation * Vector3::x() * 0.2 + r;
            let head = target.translation.vector + turned.rotation * Vector3::x() * 0.06;
            let n = (head - elbow) / rod;
            assert!((n.norm() - 1.0).abs() < 1e-11);
            let lever = (turned.rotation * Vector3::y()).cross(&r).dot(&n);
            expected += n * n.transpose() * (k / (lever * lever));
        }
        let found = posture.stiffness().unwrap();
        let rigid = found
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Rigid);
        assert_eq!(rigid.count(), 3, "{:?}", found.directions);
        let block = found.cartesian.matrix.fixed_view::<3, 3>(0, 0).into_owned();
        worst.add((block - expected).largest_entry() / expected.largest_entry());
        let pull = Wrench::new(vector![20.0, -10.0, -30.0], Vector3::zeros());
        let e = posture.deflected_by(&pull).unwrap();
        assert_equilibrium(&posture, &e);
        assert!(e.stable());
        let turned = e.displacement.angular().norm();
        assert!(turned < 1e-12, "a Delta does not turn: {turned:e}");
    }
    worst.value()
}

/// A Tripteron against the diagonal of its drives, relative.
pub fn tripteron_apart() -> f64 {
    let mut worst = Worst::new();
    let stiffness = [2e6, 3e6, 5e6];
    let mut builder = Mechanism::builder("tripteron");
    let tool = builder.platform(Platform::new("tool", Pose::identity()));
    for i in 0..3 {
        let axis = |k: usize| {
            let mut v = Vector3::zeros();
            v[(i + k) % 3] = 1.0;
            v
        };
        // From the slide two bars in the plane across it, folded.
        let drive = ActuatorSpec::new(MotionKind::Prismatic, axis(0), stiffness[i]);
        let start = axis(1) * -0.4 + axis(2) * 0.3;
        let chain = Chain::builder(["x", "y", "z"][i])
            .translation(start)
            .actuator("slide", drive)
            .passive("r1", MotionKind::Revolute, axis(0), 0.0)
            .translation(axis(1) * 0.4)
            .passive("r2", MotionKind::Revolute, axis(0), 0.0)
            .translation(axis(2) * -0.3)
            .passive("r3", MotionKind::Revolute, axis(0), 0.0)
            .build()
            .unwrap();
        builder = builder.limb(limb(["x", "y", "z"][i], 0, tool, Pose::identity(), chain));
    }
    let machine = builder.build().unwrap();
    for target in [
        Pose::identity(),
        Pose::translation(0.05, -0.1, 0.08),
        Pose::translation(-0.15, 0.02, -0.1),
    ] {
        let posture = machine.posture(&target).unwrap();
        let p = target.translation.vector;
        for (found, expected) in posture.commands().iter().zip(p.iter()) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(posture.overconstraint().degree, 3);
        assert_eq!(posture.mobility().ncols(), 3);
        let k = posture.stiffness().unwrap();
        let block = k.cartesian.matrix.fixed_view::<3, 3>(0, 0).into_owned();
        let expected = Matrix3::from_diagonal(&Vector3::from(stiffness));
        worst.add((block - expected).largest_entry() / 5e6);
    }
    worst.value()
}

#[test]
fn a_delta_is_compensated_in_its_three_directions() {
    let (machine, _) = delta(4000.0);
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    assert_eq!(posture.correctable(), Directions::POSITION);
    let pull = Wrench::new(vector![20.0, -10.0, -30.0], vector![0.5, 0.2, -0.1]);
    let found = kinetostat::compensate(
        &machine,
        &home,
        &pull,
        posture.correctable(),
        &kinetostat::Settings::default(),
    )
    .unwrap();
    assert!(found.left_over.linear().norm() < 1e-12);
    assert!(found.equilibrium.residual.iterations <= 8);
    let again = found.posture.deflected_by(&pull).unwrap();
    let residual = (again.tool.translation.vector - home.translation.vector).norm();
    assert!(residual < 1e-11, "{residual:e}");
}

#[test]
fn a_posture_near_a_singular_one_says_how_far_and_where() {
    // The truss at height z is singular when flat.
    let machine = truss(0.5, 0.1, 1e5);
    for z in [0.1, 0.02, 0.001] {
        let posture = machine.posture(&Pose::translation(0.0, 0.0, z)).unwrap();
        let list = posture.near_singularities(0.2).unwrap();
        let first = list
            .iter()
            .find(|s| s.kind == SingularityKind::Gained)
            .unwrap();
        assert!(first.description().contains("moves along z"));
        assert!(first.followed);
        assert!(
            (first.distance_m - z).abs() < 1e-6 * z,
            "{}",
            first.distance_m
        );
        assert!(first.towards.linear().z < -0.999);
        if z == 0.001 {
            assert!(first.motion.linear().z.abs() > 0.99);
        }
        assert!(posture.near_singularities(0.5 * z).unwrap().is_empty());
    }
    let flat = machine.posture(&Pose::identity()).unwrap();
    let list = flat.near_singularities(1e-3).unwrap();
    assert_eq!(list[0].distance_m, 0.0);
    assert!(
        list[0].motion.linear().z.abs() > 0.99,
        "{}",
        list[0].description()
    );
    assert!(list[0].description().starts_with("singular posture"));
}

/// By symmetry the way to the singular posture is straight up, where the rods are level: there the
/// tool also tilts for nothing, and it is a tilt that is lost first.
#[test]
fn a_delta_near_its_flat_posture_says_how_far_it_is() {
    let machine = delta_with(4000.0, 0.4, 0.7);
    // base + arm cos(theta) - head = rod, tool and elbows at one height.
    let flat = -0.3 * (1.0 - ((0.4 - 0.14) / 0.3_f64).powi(2)).sqrt();
    for above in [0.08, 0.03, 0.004] {
        let target = Pose::translation(0.0, 0.0, flat - above);
        let posture = machine.posture(&target).unwrap();
        let list = posture.near_singularities(0.5).unwrap();
        let first = list
            .iter()
            .find(|s| s.kind == SingularityKind::Gained)
            .unwrap();
        // Very near, joints are not found any more where the way ends: first order it stays.
        let most = if first.followed { 1e-4 } else { 1e-2 };
        assert!(first.followed || above < 0.01, "{}", first.description());
        assert!(
            (first.distance_m - above).abs() < most * above,
            "{above}: {} {}",
            first.distance_m,
            first.description()
        );
        assert!(first.towards.linear().z > 0.999, "{}", first.description());
    }
}
