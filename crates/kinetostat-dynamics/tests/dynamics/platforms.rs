//! D4: platforms against an independent program.

use crate::common::*;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, Modes};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Matrix3, Rotation3, UnitQuaternion, Vector3, vector};

/// Body of a slender rod along x.
fn rod(mass: f64, length: f64, about_axis: f64) -> Matrix3<f64> {
    let across = mass * length * length / 12.0;
    Matrix3::from_diagonal(&vector![about_axis, across, across])
}

/// Masses of a leg: lower rod, upper rod, axial inertia of both as a share of the lower mass.
#[derive(Clone, Copy)]
pub struct LegMass(f64, f64, f64);

const MASSLESS: LegMass = LegMass(0.0, 0.0, 0.0);

struct Strut<'a> {
    name: &'a str,
    base: Vector3<f64>,
    platform: Vector3<f64>,
    stiffness: f64,
    rest: f64,
    spins: bool,
    mass: LegMass,
}

impl Strut<'_> {
    fn limb(&self) -> Limb {
        let way = self.platform - self.base;
        let length = way.norm();
        let turn = UnitQuaternion::rotation_between(&Vector3::x(), &way).unwrap();
        let axial = self.mass.2 * self.mass.0;
        let half = 0.5 * length;
        let mut chain = Chain::builder(self.name)
            .rigid(Pose::from_parts(self.base.into(), turn))
            .passive_universal("foot", Vector3::y(), Vector3::z());
        if self.spins {
            chain = chain.passive("spin", MotionKind::Revolute, Vector3::x(), 0.0);
        }
        if self.mass.0 > 0.0 {
            chain = chain.body(
                "lower",
                self.mass.0,
                vector![0.25 * length, 0.0, 0.0],
                rod(self.mass.0, half, axial),
            );
        }
        chain = chain.translation(vector![length, 0.0, 0.0]).spring(
            "strut",
            MotionKind::Prismatic,
            Vector3::x(),
            self.stiffness,
            self.rest,
        );
        if self.mass.1 > 0.0 {
            let upper = rod(self.mass.1, half, axial * self.mass.1 / self.mass.0);
            chain = chain.body(
                "upper",
                self.mass.1,
                vector![-0.25 * length, 0.0, 0.0],
                upper,
            );
        }
        let chain = chain
            .passive_spherical("ball")
            .rigid(Pose::rotation(turn.scaled_axis()).inverse())
            .build()
            .unwrap();
        Limb::between(self.name, 0, 1, chain).fixed_at(Pose::translation(
            self.platform.x,
            self.platform.y,
            self.platform.z,
        ))
    }
}

fn polar(radius: f64, degrees: f64, z: f64) -> Vector3<f64> {
    let a = degrees.to_radians();
    vector![radius * a.cos(), radius * a.sin(), z]
}

struct Hexapod {
    mass: LegMass,
    spins: bool,
    rest: f64,
    stiffness: f64,
    centre: Vector3<f64>,
    lifted: f64,
    gravity: Vector3<f64>,
}

impl Default for Hexapod {
    fn default() -> Self {
        Self {
            mass: MASSLESS,
            spins: false,
            rest: 0.0,
            stiffness: 1e6,
            centre: Vector3::zeros(),
            lifted: 0.0,
            gravity: Vector3::zeros(),
        }
    }
}

const BASE_B: [f64; 6] = [0.0, 0.0, 120.0, 120.0, 240.0, 240.0];
const PLATFORM_B: [f64; 6] = [-60.0, 60.0, 60.0, 180.0, 180.0, 300.0];

impl Hexapod {
    fn build(&self, base: &[f64; 6], platform: &[f64; 6]) -> Mechanism {
        let mut m = Mechanism::builder("hexapod").gravity(self.gravity);
        let tool = m.platform(Platform {
            mass: 40.0,
            centre_of_mass: self.centre,
            inertia: Matrix3::from_diagonal(&vector![1.2, 1.2, 2.0]),
            ..Platform::new("platform", Pose::translation(0.0, 0.0, self.lifted))
        });
        assert_eq!(tool, 1);
        for i in 0..6 {
            let strut = Strut {
                name: ["a", "b", "c", "d", "e", "f"][i],
                base: polar(0.5, base[i], -0.6),
                platform: polar(0.3, platform[i], 0.0) - vector![0.0, 0.0, self.lifted],
                stiffness: self.stiffness,
                rest: self.rest,
                spins: self.spins,
                mass: self.mass,
            };
            // Anchors on the platform are counted from its reference point; on the base from the ground.
            let strut = Strut {
                platform: strut.platform + vector![0.0, 0.0, self.lifted],
                ..strut
            };
            let mut limb = strut.limb();
            let at = strut.platform - vector![0.0, 0.0, self.lifted];
            limb.platform_from_tip = Pose::translation(at.x, at.y, at.z);
            m = m.limb(limb);
        }
        m.build().unwrap()
    }
}

/// Dynamics of a machine at home under a wrench on its tool.
fn dynamics(machine: &Mechanism, wrench: &Wrench) -> (LinearDynamics, MechanismEquilibrium) {
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    let at = posture.deflected_by(wrench).unwrap();
    let d = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
    (d, at)
}

fn are(modes: &Modes, first: usize, expected: &[f64]) {
    let found = modes.frequencies_hz();
    let mut worst = Worst::new();
    for (found, expected) in found[first..].iter().zip(expected) {
        if *expected == 0.0 {
            assert!(found.abs() < 1e-3, "{found}");
            worst.add(0.0);
        } else {
            worst.add(relative(*found, *expected));
        }
    }
    assert!(
        worst.of(expected.len()) < 1e-6,
        "{worst} {found:?} {expected:?}"
    );
}

#[test]
fn hexapods_without_load() {
    let none = Wrench::zero();
    let (d, at) = dynamics(&Hexapod::default().build(&BASE_B, &PLATFORM_B), &none);
    let modes = d.modes().unwrap();
    are(
        &modes,
        0,
        &[
            25.413414, 25.413414, 48.286008, 49.869575, 61.162939, 61.162939,
        ],
    );
    assert_eq!(modes.modes.len(), 6);
    let _ = at;
    let singular = Hexapod::default().build(
        &[0.0, 60.0, 120.0, 180.0, 240.0, 300.0],
        &[0.0, 60.0, 120.0, 180.0, 240.0, 300.0],
    );
    let (d, _) = dynamics(&singular, &none);
    let modes = d.modes().unwrap();
    are(&modes, 0, &[0.0, 0.0, 0.0, 58.47726, 72.933957, 72.933957]);
    assert_eq!(modes.counts.free, 3);
    let off = Hexapod {
        centre: vector![0.02, -0.01, 0.08],
        ..Hexapod::default()
    };
    let (d, _) = dynamics(&off.build(&BASE_B, &PLATFORM_B), &none);
    are(
        &d.modes().unwrap(),
        0,
        &[
            24.22364, 24.258585, 48.355054, 49.285528, 64.075408, 64.833898,
        ],
    );
    let legs = Hexapod {
        mass: LegMass(6.0, 3.0, 0.0),
        ..Hexapod::default()
    };
    let (d, _) = dynamics(&legs.build(&BASE_B, &PLATFORM_B), &none);
    let heavy = [
        21.814231, 21.814231, 37.291951, 41.980845, 48.108287, 48.108287,
    ];
    let modes = d.modes().unwrap();
    are(&modes, 0, &heavy);
    assert_eq!(modes.counts.neutral, 0);
    let spins = Hexapod {
        spins: true,
        ..Hexapod::default()
    };
    let (d, _) = dynamics(&spins.build(&BASE_B, &PLATFORM_B), &none);
    let modes = d.modes().unwrap();
    are(
        &modes,
        0,
        &[
            25.413414, 25.413414, 48.286008, 49.869575, 61.162939, 61.162939,
        ],
    );
    assert_eq!(
        (modes.counts.neutral, modes.counts.free, modes.modes.len()),
        (6, 0, 6)
    );
    assert!(
        modes.neutral.iter().any(|n| n == "a.spin"),
        "{:?}",
        modes.neutral
    );
    let spins = Hexapod {
        spins: true,
        mass: LegMass(6.0, 3.0, 1e-3),
        ..Hexapod::default()
    };
    let (d, _) = dynamics(&spins.build(&BASE_B, &PLATFORM_B), &none);
    let modes = d.modes().unwrap();
    are(&modes, 6, &heavy);
    assert_eq!(
        (modes.counts.neutral, modes.counts.free, modes.modes.len()),
        (0, 6, 12)
    );
}

/// The loaded hexapod of the reference values, and the force on it.
pub fn loaded() -> (Mechanism, Wrench) {
    let hexapod = Hexapod {
        mass: LegMass(6.0, 3.0, 0.0),
        rest: 0.02,
        centre: vector![0.02, -0.01, 0.08],
        gravity: down(),
        ..Hexapod::default()
    };
    let force = Wrench::new(vector![3e3, -2e3, -8e3], Vector3::zeros());
    (hexapod.build(&BASE_B, &PLATFORM_B), force)
}

#[test]
fn loaded_hexapod() {
    let (machine, force) = loaded();
    let (d, at) = dynamics(&machine, &force);
    let place = vector![0.003118932, -0.00207875, 0.022414913];
    assert!(
        (at.tool.translation.vector - place).norm() < 1e-9,
        "{:?}",
        at.tool.translation
    );
    are(
        &d.modes().unwrap(),
        0,
        &[
            20.523934, 20.554005, 36.375443, 42.056447, 49.199055, 49.624738,
        ],
    );
    assert!(d.asymmetry() < 1e-12, "{}", d.asymmetry());
    let k = rows(
        "974873.6  -524.73492  10311.37  -891.62855  -47277.732  2.2359563
-524.73492  976406.06  -6864.3639  49961.511  891.66929  -9.3935929
10311.37  -6864.3639  4021047.2  316.53343  452.10929  -0.040740816
-891.62855  49961.511  316.53343  181416.27  261.65919  52.743056
-47277.732  891.66929  452.10929  261.65919  180624.99  -36.759649
2.2359563  -9.3935929  -0.040740815  52.743056  -36.759649  174717.89",
    );
    let found = DMatrix::from_fn(6, 6, |i, j| at.stiffness.matrix[(i, j)]);
    println!("K_C {}", apart(&found, &k, &k));
    // Eight digits are printed: half a unit of the last of 4021047.2 is 1.2e-8 of it.
    assert!(apart(&found, &k, &k) < 2e-8);
}

#[test]
fn opposed_legs_preloaded() {
    let base = [0.0, 40.0, 90.0, 130.0, 180.0, 220.0, 270.0, 310.0];
    let platform = [20.0, 20.0, 110.0, 110.0, 200.0, 200.0, 290.0, 290.0];
    for (force, expected) in [
        (
            -20000.0,
            [
                -15.158836, 8.5589298, 8.5679394, 46.133629, 48.700932, 49.688794,
            ],
        ),
        (
            -10000.0,
            [
                -10.706411, 10.839783, 10.850675, 46.26727, 49.22889, 50.229863,
            ],
        ),
        (
            0.0,
            [0.0, 12.713042, 12.725226, 46.4063, 49.752504, 50.766478],
        ),
        (
            10000.0,
            [
                10.677626, 14.339393, 14.352489, 46.551527, 50.271895, 51.298763,
            ],
        ),
        (
            20000.0,
            [
                15.076899, 15.795327, 15.809064, 46.703909, 50.787181, 51.826836,
            ],
        ),
    ] {
        let mut m = Mechanism::builder("opposed");
        m.platform(Platform {
            mass: 45.0,
            inertia: Matrix3::from_diagonal(&vector![1.4, 1.3, 2.2]),
            ..Platform::new("platform", Pose::identity())
        });
        for i in 0..8 {
            let z = if i % 2 == 0 { -0.65 } else { 0.65 };
            let strut = Strut {
                name: ["a", "b", "c", "d", "e", "f", "g", "h"][i],
                base: polar(0.6, base[i], z),
                platform: polar(0.3, platform[i], 0.0),
                stiffness: 8e5,
                // Tension pulls the ends together: at rest it is shorter.
                rest: -force / 8e5,
                spins: false,
                mass: LegMass(5.0, 3.0, 0.0),
            };
            m = m.limb(strut.limb());
        }
        let machine = m.build().unwrap();
        let posture = machine.posture(&Pose::identity()).unwrap();
        // At the nominal pose, whatever it is: the reference says so.
        let held = posture.wrench_at(&Pose::identity()).unwrap();
        println!("{:?}", held.wrench.0);
        let d = LinearDynamics::of_machine(&posture, &held, &Held::nothing()).unwrap();
        are(&d.modes().unwrap(), 0, &expected);
    }
}

#[test]
fn raised_tool_falls_where_its_stiffness_is_singular() {
    let hexapod = Hexapod {
        stiffness: 2e4,
        lifted: 0.6,
        ..Hexapod::default()
    };
    let machine = hexapod.build(&BASE_B, &PLATFORM_B);
    let home = machine.platforms()[1].home;
    let posture = machine.posture(&home).unwrap();
    let at = |load: f64| {
        let push = Wrench::new(vector![0.0, 0.0, -load], Vector3::zeros());
        let at = posture.deflected_by(&push).unwrap();
        let d = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
        (d.modes().unwrap(), at)
    };
    for (load, f1) in [(0.0, 1.9043365), (4000.0, 0.97390424)] {
        let found = at(load).0.frequencies_hz()[0];
        assert!(relative(found, f1).abs() < 1e-7, "{found} {f1}");
    }
    // Straight down, so that the load goes through the point where it may leave the axis.
    let held = |z: f64| {
        let pose = Pose::translation(0.0, 0.0, z);
        let at = posture.wrench_at(&pose).unwrap();
        let d = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
        let k = at.stiffness.symmetric().symmetric_eigenvalues().min();
        (-at.wrench.force().z, d.modes().unwrap().modes[0].squared, k)
    };
    let load_of_zero = |figure: &dyn Fn(f64) -> f64| {
        let (mut above, mut below) = (home.translation.z, home.translation.z - 0.2);
        assert!(figure(above) > 0.0 && figure(below) < 0.0);
        for _ in 0..60 {
            let middle = 0.5 * (above + below);
            if figure(middle) > 0.0 {
                above = middle
            } else {
                below = middle
            }
        }
        held(above).0
    };
    let slow = load_of_zero(&|z| held(z).1);
    let singular = load_of_zero(&|z| held(z).2);
    println!("{slow} {singular}");
    let exact = exact_singular_load();
    println!("{exact}");
    // The reference page has 5084.3595849, which is off by 1.4e-6: the closed form is the judge.
    assert!((exact / 5084.3595849 - 1.0).abs() < 2e-6);
    assert!((slow / exact - 1.0).abs() < 1e-9 && (singular / exact - 1.0).abs() < 1e-9);
}

/// Load straight down at which sway along x and tilt about y lose their stiffness, by the legs' axial forces alone.
fn exact_singular_load() -> f64 {
    let at = |z: f64| {
        let (mut sway, mut coupling, mut tilt, mut force) = (0.0, 0.0, 0.0, 0.0);
        for (b, p) in BASE_B.iter().zip(PLATFORM_B) {
            let (a, s) = (polar(0.5, *b, -0.6), polar(0.3, p, -0.6));
            let free = (s - a + vector![0.0, 0.0, 0.6]).norm();
            let d = s - a + vector![0.0, 0.0, 0.6 + z];
            let (length, u) = (d.norm(), d.normalize());
            let f = 2e4 * (length - free);
            let k =
                u * u.transpose() * 2e4 + (Matrix3::identity() - u * u.transpose()) * (f / length);
            let by_tilt = vector![s.z, 0.0, -s.x];
            sway += k[(0, 0)];
            coupling += (k * by_tilt).x;
            tilt += by_tilt.dot(&(k * by_tilt)) - f * (u.x * s.x + u.z * s.z);
            force += f * u.z;
        }
        (sway * tilt - coupling * coupling, -force)
    };
    let (mut above, mut below) = (0.0, -0.2);
    for _ in 0..100 {
        let middle = 0.5 * (above + below);
        if at(middle).0 > 0.0 {
            above = middle
        } else {
            below = middle
        }
    }
    at(above).1
}

#[test]
fn planar_machine_has_three_rigid_directions() {
    let mut m = Mechanism::builder("3-RRR");
    m.platform(Platform {
        mass: 8.0,
        inertia: Matrix3::from_diagonal(&vector![0.1, 0.1, 0.15]),
        ..Platform::new("platform", Pose::identity())
    });
    for (i, degrees) in [90.0, 210.0, 330.0].into_iter().enumerate() {
        let (foot, head) = (polar(0.6, degrees, 0.0), polar(0.12, degrees, 0.0));
        let way = head - foot;
        let alpha = (0.5 * way.norm() / 0.32_f64).acos();
        let to = Rotation3::from_axis_angle(&Vector3::z_axis(), way.y.atan2(way.x) + alpha);
        let chain = Chain::builder(["a", "b", "c"][i])
            .rigid(Pose::from_parts(
                foot.into(),
                UnitQuaternion::from_rotation_matrix(&to),
            ))
            .actuator(
                "drive",
                ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 2e4),
            )
            .body("one", 2.0, vector![0.16, 0.0, 0.0], rod(2.0, 0.32, 0.0))
            .translation(vector![0.32, 0.0, 0.0])
            .passive("elbow", MotionKind::Revolute, Vector3::z(), -2.0 * alpha)
            .body("two", 1.5, vector![0.16, 0.0, 0.0], rod(1.5, 0.32, 0.0))
            .translation(vector![0.32, 0.0, 0.0])
            .passive(
                "wrist",
                MotionKind::Revolute,
                Vector3::z(),
                alpha - way.y.atan2(way.x),
            )
            .build()
            .unwrap();
        let limb = Limb::between(["a", "b", "c"][i], 0, 1, chain)
            .fixed_at(Pose::translation(head.x, head.y, head.z));
        m = m.limb(limb);
    }
    let machine = m.build().unwrap();
    let (d, _) = dynamics(&machine, &Wrench::zero());
    let modes = d.modes().unwrap();
    are(&modes, 0, &[21.536285, 25.035588, 25.035588]);
    assert_eq!(modes.modes.len(), 3);
    assert_eq!(modes.counts.rigid, 3);
}
