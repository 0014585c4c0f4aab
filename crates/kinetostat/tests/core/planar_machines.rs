//! Parallel machines in a plane, a 3-RRR and a truss of two bars: against the minimum of their energy and closed
//! forms, and near their singular postures.

use crate::common::assert_equilibrium;
use crate::graphs::limb;
use crate::parallel_machines::THIRD;
use kinetostat::{
    ActuatorSpec, Chain, DirectionKind, Mechanism, MotionKind, Platform, Pose, Twist, Wrench,
    machine::SingularityKind,
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector2, Vector3, vector};

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

/// A place at a radius and an angle.
fn on(radius: f64, angle: f64) -> Vector2<f64> {
    vector![radius * angle.cos(), radius * angle.sin()]
}

/// Three equal legs, a third of a turn apart.
fn symmetric_3_rrr() -> Planar {
    let turns = [0.0, THIRD, 2.0 * THIRD];
    Planar {
        feet: turns.map(|a| on(0.6, a)),
        pins: turns.map(|a| on(0.12, a)),
        bars: [0.35, 0.4],
        k: [900.0; 3],
        ..Planar::new()
    }
}

/// A symmetric 3-RRR turned about its centre is singular where its outer bars meet there; by
/// symmetry that is the way.
#[test]
fn a_3_rrr_near_its_singular_posture_says_how_far_it_turns() {
    let planar = symmetric_3_rrr();
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
    let planar = symmetric_3_rrr();
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
