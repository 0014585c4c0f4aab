//! Parallel machines against closed forms, and what their errors of manufacture do.

use crate::common::{Orthoglide, Rng, assert_equilibrium, orthoglide_point, scaled_error};
use crate::graphs::limb;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, DirectionKind, Directions, Limb, Mechanism, MotionKind,
    Platform, Pose, Twist, Wrench, machine::SingularityKind, spatial::moved,
};
use kinetostat_testing::{LargestEntry, Worst, largest};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};

const THIRD: f64 = 2.0 * std::f64::consts::FRAC_PI_3;

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

/// A planar 3-RRR with driven, elastic shoulders, rigid bars; the plane is turned anyhow.
pub struct Planar {
    feet: [nalgebra::Vector2<f64>; 3],
    pins: [nalgebra::Vector2<f64>; 3],
    bars: [f64; 2],
    k: [f64; 3],
    plane: Pose,
}

impl Planar {
    fn new() -> Self {
        let on = |r: f64, turn: f64| vector![r * turn.cos(), r * turn.sin()];
        Self {
            feet: [0.3, THIRD + 0.1, 2.0 * THIRD - 0.2].map(|a| on(0.6, a)),
            pins: [0.0, THIRD, 2.0 * THIRD].map(|a| on(0.12, a + 0.4)),
            bars: [0.35, 0.4],
            k: [900.0, 1400.0, 700.0],
            plane: Pose::from_parts(
                vector![0.1, 0.2, 0.3].into(),
                nalgebra::UnitQuaternion::from_euler_angles(0.4, -0.7, 0.2),
            ),
        }
    }

    fn pin(&self, leg: usize, pose: &Vector3<f64>) -> nalgebra::Vector2<f64> {
        let (s, c) = pose.z.sin_cos();
        let p = self.pins[leg];
        vector![pose.x + c * p.x - s * p.y, pose.y + s * p.x + c * p.y]
    }

    /// Angle of the shoulder and of the elbow against it, elbow to the right.
    fn leg(&self, leg: usize, pose: &Vector3<f64>) -> (f64, f64) {
        let d = self.pin(leg, pose) - self.feet[leg];
        let [a, b] = self.bars;
        let r = d.norm();
        let open = ((a * a + r * r - b * b) / (2.0 * a * r)).acos();
        let shoulder = d.y.atan2(d.x) + open;
        let elbow = self.feet[leg] + vector![shoulder.cos(), shoulder.sin()] * a;
        let w = self.pin(leg, pose) - elbow;
        let turn = w.y.atan2(w.x) - shoulder;
        let tau = std::f64::consts::TAU;
        (shoulder, turn - tau * (turn / tau).round())
    }

    fn energy(&self, commanded: &Vector3<f64>, pose: &Vector3<f64>, load: &Vector3<f64>) -> f64 {
        let stored: f64 = (0..3)
            .map(|i| {
                let d = self.leg(i, pose).0 - self.leg(i, commanded).0;
                let tau = std::f64::consts::TAU;
                0.5 * self.k[i] * (d - tau * (d / tau).round()).powi(2)
            })
            .sum();
        stored - load.dot(&(pose - commanded))
    }

    /// Newton on the energy, derivatives by sixth-order differences.
    fn minimum(&self, commanded: &Vector3<f64>, load: &Vector3<f64>) -> Vector3<f64> {
        let h = 1e-3;
        let weights = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
        let gradient = |p: &Vector3<f64>| {
            Vector3::from_fn(|i, _| {
                let e = |s: f64| {
                    let mut q = *p;
                    q[i] += s * h;
                    self.energy(commanded, &q, load)
                };
                let sum: f64 = weights.iter().map(|(s, w)| w * (e(*s) - e(-s))).sum();
                sum / (60.0 * h)
            })
        };
        let mut p = *commanded;
        for _ in 0..12 {
            let g = gradient(&p);
            let mut hessian = Matrix3::zeros();
            for i in 0..3 {
                let mut d = Vector3::zeros();
                d[i] = 1e-4;
                hessian.set_column(i, &((gradient(&(p + d)) - gradient(&(p - d))) / 2e-4));
            }
            p -= hessian.try_inverse().unwrap() * g;
        }
        p
    }

    fn pose(&self, p: &Vector3<f64>) -> Pose {
        self.plane * Pose::translation(p.x, p.y, 0.0) * Pose::rotation(Vector3::z() * p.z)
    }

    fn machine(&self, home: &Vector3<f64>) -> Mechanism {
        let mut builder = Mechanism::builder("3-RRR");
        let tool = builder.platform(Platform::new("tool", self.pose(home)));
        for i in 0..3 {
            let (shoulder, elbow) = self.leg(i, home);
            let mut drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), self.k[i]);
            drive.home = shoulder;
            let chain = Chain::builder(format!("leg {i}"))
                .rigid(self.plane)
                .translation(vector![self.feet[i].x, self.feet[i].y, 0.0])
                .actuator("shoulder", drive)
                .translation(vector![self.bars[0], 0.0, 0.0])
                .passive("elbow", MotionKind::Revolute, Vector3::z(), elbow)
                .translation(vector![self.bars[1], 0.0, 0.0])
                .passive(
                    "pin",
                    MotionKind::Revolute,
                    Vector3::z(),
                    home.z - shoulder - elbow,
                )
                .build()
                .unwrap();
            let tip = Pose::translation(self.pins[i].x, self.pins[i].y, 0.0);
            builder = builder.limb(limb(&format!("leg {i}"), 0, tool, tip, chain));
        }
        builder.build().unwrap()
    }
}

/// A planar 3-RRR against the minimum of its energy, as a share of its displacement.
pub fn planar_3_rrr_apart() -> f64 {
    let planar = Planar::new();
    let home = vector![0.02, -0.03, 0.1];
    let machine = planar.machine(&home);
    let mut worst = Worst::new();
    for (target, load) in [
        (home, vector![30.0, -20.0, 2.0]),
        (vector![-0.05, 0.04, -0.1], vector![-15.0, 40.0, -3.0]),
    ] {
        let posture = machine.posture(&planar.pose(&target)).unwrap();
        for (i, limb) in posture.limbs().iter().enumerate() {
            assert!((limb.commands[0] - planar.leg(i, &target).0).abs() < 1e-10);
        }
        assert_eq!(posture.mobility().ncols(), 3);
        let k = posture.stiffness().unwrap();
        let rigid = k
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Rigid);
        assert_eq!(rigid.count(), 3);
        let turn = planar.plane.rotation;
        let wrench = Wrench::new(
            turn * vector![load.x, load.y, 0.0],
            turn * vector![0.0, 0.0, load.z],
        );
        let e = posture.deflected_by(&wrench).unwrap();
        assert!(e.stable());
        let expected = planar.pose(&planar.minimum(&target, &load));
        let off = kinetostat::spatial::pose_residual(&e.tool, &expected)
            .0
            .norm();
        worst.add(off / e.displacement.0.norm());
    }
    worst.value()
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

/// Two elastic sliding legs from the left and the right in the plane x, z: a truss that snaps.
pub fn truss(b: f64, h: f64, k: f64) -> Mechanism {
    truss_of(b, h, k, ["left", "right"])
}

/// The same with hinges at the heads of these legs only: the tool turns with the other one.
pub fn truss_of<const N: usize>(b: f64, h: f64, k: f64, heads: [&str; N]) -> Mechanism {
    let mut builder = Mechanism::builder("truss");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, h)));
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let span = vector![-side * b, 0.0, h];
        // About y, positive turns z to x.
        let turn = span.x.atan2(span.z);
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), k);
        drive.home = span.norm();
        let chain = Chain::builder(name)
            .translation(vector![side * b, 0.0, 0.0])
            .passive("foot", MotionKind::Revolute, Vector3::y(), turn)
            .actuator("slide", drive);
        let chain = match heads.contains(&name) {
            true => chain.passive("head", MotionKind::Revolute, Vector3::y(), -turn),
            false => chain.rigid(Pose::new(Vector3::zeros(), Vector3::y() * -turn)),
        };
        let chain = chain.build().unwrap();
        builder = builder.limb(limb(name, 0, tool, Pose::identity(), chain));
    }
    builder.build().unwrap()
}

/// A truss that snaps against statics by hand: force along its way as a share of `k h`, and place of
/// the limit points, m.
pub fn truss_apart() -> [f64; 2] {
    let (b, h, k) = (0.5, 0.1, 1e5);
    let machine = truss(b, h, k);
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    let displacements: Vec<f64> = (0..=44).map(|i| -0.005 * f64::from(i)).collect();
    let up = Twist::new(Vector3::z(), Vector3::zeros());
    let curve = posture.displaced_along(&up, &displacements, None).unwrap();
    assert!(curve.ended.is_none());
    let free = (b * b + h * h).sqrt();
    let mut worst = Worst::new();
    for point in &curve.points {
        let z = h + point.along;
        let l = (b * b + z * z).sqrt();
        let force = 2.0 * k * (l - free) * z / l;
        worst.add((point.force - force).abs() / (k * h));
    }
    // dF/dz = 0 where l^3 = free b^2.
    let limit = ((free * b * b).powf(2.0 / 3.0) - b * b).sqrt();
    assert_eq!(curve.limits.len(), 2);
    let mut limits = Worst::new();
    for (found, expected) in curve.limits.iter().zip([limit, -limit]) {
        let off = (h + found.along - expected).abs();
        limits.add(off);
    }
    [worst.value(), limits.value()]
}

/// The same truss pushed down while its tool is free to swerve, with a soft spring across so that
/// it cannot run away, and with a heavy one.
#[test]
fn a_pushed_truss_swerves_before_it_snaps_where_that_costs_less() {
    let (b, h, k) = (0.5, 0.3, 1e5);
    let machine = truss(b, h, k);
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    let displacements: Vec<f64> = (0..=90).map(|i| -0.002 * f64::from(i)).collect();
    let curve = posture
        .pushed_along(&Vector3::z(), &displacements, &Wrench::zero(), None)
        .unwrap();
    // By symmetry it goes straight down until it snaps; the force by hand.
    let free = (b * b + h * h).sqrt();
    for point in &curve.points {
        let z = h + point.along;
        let l = (b * b + z * z).sqrt();
        let force = 2.0 * k * (l - free) * z / l;
        assert!(
            (point.force - force).abs() < 1e-10 * k,
            "{} {force}",
            point.force
        );
        assert!(point.equilibrium.tool.translation.x.abs() < 1e-12);
    }
    let limit = ((free * b * b).powf(2.0 / 3.0) - b * b).sqrt();
    let found: Vec<f64> = curve.limits.iter().map(|p| h + p.along).collect();
    assert!(found.iter().any(|z| (z - limit).abs() < 1e-9));
    // Beyond the limit a dead force would let it fall.
    let (first, last) = (&curve.points[1], curve.points.last().unwrap());
    assert!(first.equilibrium.platform.stable);
    assert!(!last.equilibrium.platform.stable);
    // And a weight across moves it aside while the pin goes down.
    let aside = Wrench::new(vector![500.0, 0.0, 0.0], Vector3::zeros());
    let curve = posture
        .pushed_along(&Vector3::z(), &displacements[..20], &aside, None)
        .unwrap();
    for point in &curve.points {
        assert_equilibrium(&posture, &point.equilibrium);
        let e = &point.equilibrium;
        assert!((e.wrench.force().x - 500.0).abs() < 1e-9);
        assert!((e.tool.translation.z - h - point.along).abs() < 1e-12);
        assert!(e.tool.translation.x > 1e-4);
    }
    // The slope is the derivative of the force.
    let p = &curve.points;
    for i in 2..p.len() - 2 {
        let d = 8.0 * (p[i + 1].force - p[i - 1].force) - (p[i + 2].force - p[i - 2].force);
        let slope = d / (12.0 * -0.002);
        assert!(
            (slope - p[i].slope).abs() < 1e-4 * k,
            "{slope} {}",
            p[i].slope
        );
    }
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

/// A symmetric 3-RRR turned about its centre is singular where its outer bars meet there; by
/// symmetry that is the way.
#[test]
fn a_3_rrr_near_its_singular_posture_says_how_far_it_turns() {
    let on = |r: f64, turn: f64| vector![r * turn.cos(), r * turn.sin()];
    let turns = [0.0, THIRD, 2.0 * THIRD];
    let planar = Planar {
        feet: turns.map(|a| on(0.6, a)),
        pins: turns.map(|a| on(0.12, a)),
        bars: [0.35, 0.4],
        k: [900.0; 3],
        ..Planar::new()
    };
    // The elbow lies on the line through centre and pin, at 0.12 + 0.4 from the centre.
    let (foot, elbow, bar) = (0.6_f64, 0.52, 0.35_f64);
    let angle = ((foot * foot + elbow * elbow - bar * bar) / (2.0 * foot * elbow)).acos();
    let meets = |turn: f64| {
        let shoulder = planar.leg(0, &vector![0.0, 0.0, turn]).0;
        (planar.feet[0] + on(bar, shoulder) - on(elbow, turn)).norm() < 1e-9
    };
    let singular = [angle, -angle].into_iter().find(|t| meets(*t)).unwrap();
    let near = vector![0.0, 0.0, singular * 0.7];
    let machine = planar.machine(&near);
    for off in [0.1, 0.03, 0.005] {
        for side in [-1.0, 1.0] {
            let target = planar.pose(&vector![0.0, 0.0, singular + side * off]);
            let posture = machine.posture(&target).unwrap();
            let length = posture.stiffness().unwrap().length;
            let list = posture.near_singularities(0.5).unwrap();
            let first = list
                .iter()
                .find(|s| s.kind == SingularityKind::Gained)
                .unwrap();
            assert!(first.followed, "{}", first.description());
            let expected = off * length;
            assert!(
                (first.distance_m - expected).abs() < 1e-5 * expected,
                "{off} {side}: {} {expected}",
                first.distance_m
            );
            // Back by a turn about the plane's axis.
            let axis = planar.plane.rotation * Vector3::z();
            let turn = first.towards.angular().dot(&axis) * length;
            assert!((turn + side).abs() < 1e-3, "{turn} {}", first.description());
            let gained = first.motion.angular().dot(&axis) * length;
            assert!(gained.abs() > 0.99, "{}", first.description());
        }
    }
}

/// A leg of a 3-RRR that is all but stretched: the platform goes straight away from its foot.
#[test]
fn a_stretched_leg_of_a_3_rrr_says_how_far_the_platform_may_go() {
    let on = |r: f64, turn: f64| vector![r * turn.cos(), r * turn.sin()];
    let turns = [0.0, THIRD, 2.0 * THIRD];
    let planar = Planar {
        feet: turns.map(|a| on(0.6, a)),
        pins: turns.map(|a| on(0.12, a)),
        bars: [0.35, 0.4],
        k: [900.0; 3],
        ..Planar::new()
    };
    // From foot to pin 0.6 - (0.12 + x).
    let ends = -(0.35 + 0.4 - 0.48);
    let machine = planar.machine(&vector![ends + 0.05, 0.0, 0.0]);
    for off in [0.03, 0.01, 0.001, 1e-5] {
        let target = planar.pose(&vector![ends + off, 0.0, 0.0]);
        let posture = machine.posture(&target).unwrap();
        let list = posture.near_singularities(0.05).unwrap();
        let first = &list[0];
        assert!(first.kind == SingularityKind::Lost && first.followed);
        assert!(
            (first.distance_m - off).abs() < 1e-6 * off + 1e-12,
            "{off}: {} {}",
            first.distance_m,
            first.description()
        );
        let away = planar.plane.rotation * -Vector3::x();
        assert!(first.towards.linear().dot(&away) > 0.999_999);
        assert!(first.motion.linear().dot(&away).abs() > 0.999_99);
    }
}
