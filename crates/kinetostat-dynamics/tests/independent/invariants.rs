//! What must not change with how a machine is described, and what holds for every machine. All numbers off every axis.

use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse, Modes};
use kinetostat_testing::Worst;
use nalgebra::{Complex, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, vector};
use proptest::prelude::*;

use crate::common::{DENSITY, section};
use crate::platform::{loaded, machine};

/// Units in which an arm is written: how many to one m, kg, s.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

const SI: Units = Units {
    length: 1.0,
    mass: 1.0,
    time: 1.0,
};

impl Units {
    fn force(self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    fn stress(self) -> f64 {
        self.force() / (self.length * self.length)
    }
}

/// How the same arm may be described.
#[derive(Clone, Copy)]
struct Description {
    units: Units,
    /// The drive of the second joint as two springs in series.
    drive_in_two: bool,
    /// The link as two links of half the length.
    link_in_two: bool,
    /// The body on the link's end as two bodies that make the same one.
    body_in_two: bool,
    /// One more passive joint behind everything that has mass.
    idle_joint: bool,
}

const PLAIN: Description = Description {
    units: SI,
    drive_in_two: false,
    link_in_two: false,
    body_in_two: false,
    idle_joint: false,
};

/// Three elastic drives about skew axes, a link with mass, a body with products of inertia; numbers of the arm in [-1, 1].
fn arm(r: &[f64], how: Description) -> Chain {
    let u = how.units;
    let (l, m) = (u.length, u.mass);
    let per_turn = u.force() * l;
    let inertia = m * l * l;
    let at = |x: f64, y: f64, z: f64| vector![x, y, z] * l;
    let heavy = Matrix3::new(3.0, 0.2 * r[0], -0.1, 0.2 * r[0], 4.0, 0.3, -0.1, 0.3, 2.5) * inertia;
    let mut chain = Chain::builder("arm")
        .rigid(Pose::from_parts(
            at(0.1 * r[1], -0.2, 0.4).into(),
            UnitQuaternion::from_scaled_axis(vector![0.2, 0.3 * r[2], -0.1]),
        ))
        .spring(
            "base",
            MotionKind::Revolute,
            vector![0.1, 0.2 * r[3], 1.0].normalize(),
            9e5 * per_turn,
            0.1 * r[4],
        )
        .body("column", 60.0 * m, at(0.05, 0.1 * r[5], 0.2), heavy)
        .translation(at(0.3, 0.05, 0.5));
    let axis = vector![0.2 * r[6], 1.0, 0.1].normalize();
    let (stiffness, rest) = (5e5 * per_turn, 0.2 * r[7]);
    chain = if how.drive_in_two {
        // One third and two thirds of the flexibility, and of the turn at rest.
        chain
            .spring(
                "shoulder",
                MotionKind::Revolute,
                axis,
                3.0 * stiffness,
                0.25 * rest,
            )
            .spring(
                "shoulder's gear",
                MotionKind::Revolute,
                axis,
                1.5 * stiffness,
                0.75 * rest,
            )
    } else {
        chain.spring("shoulder", MotionKind::Revolute, axis, stiffness, rest)
    };
    let s = section();
    let own = BeamSection {
        youngs_modulus: s.youngs_modulus * u.stress(),
        shear_modulus: s.shear_modulus * u.stress(),
        area: 4.0 * s.area * l * l,
        second_moment_y: 16.0 * s.second_moment_y * l.powi(4),
        second_moment_z: 16.0 * s.second_moment_z * l.powi(4),
        torsion_constant: 16.0 * s.torsion_constant * l.powi(4),
    };
    let mass = LinkMass::of_section(&own, DENSITY * m / l.powi(3));
    let beam = |length: f64, segments| {
        LinkSpec::beam(own, length * l)
            .segments(segments)
            .with_mass(mass)
    };
    chain = if how.link_in_two {
        chain
            .link_with("boom", &beam(0.45, 1))
            .link_with("jib", &beam(0.45, 1))
    } else {
        chain.link_with("boom", &beam(0.9, 2))
    };
    let own = Matrix3::new(
        0.3,
        0.02,
        -0.03,
        0.02,
        0.4,
        0.05 * r[8],
        -0.03,
        0.05 * r[8],
        0.35,
    ) * inertia;
    let place = at(0.04, -0.1 * r[9], 0.06);
    chain = if how.body_in_two {
        // Two halves, apart along d: they bring m (d.d 1 - d d^T) of their own.
        let apart = at(0.03, 0.02, -0.04);
        let steiner =
            (Matrix3::identity() * apart.norm_squared() - apart * apart.transpose()) * (14.0 * m);
        let half = (own - steiner) * 0.5;
        chain.body("head, left", 7.0 * m, place + apart, half).body(
            "head, right",
            7.0 * m,
            place - apart,
            half,
        )
    } else {
        chain.body("head", 14.0 * m, place, own)
    };
    chain = chain
        .spring(
            "wrist",
            MotionKind::Prismatic,
            vector![0.3, 0.1, 1.0].normalize(),
            4e6 * u.force() / l,
            0.01 * r[10] * l,
        )
        .body(
            "tool",
            6.0 * m,
            at(0.1, 0.02, 0.1),
            Matrix3::identity() * (0.05 * inertia),
        )
        .translation(at(0.15, -0.05, 0.1));
    if how.idle_joint {
        chain = chain.passive(
            "idle",
            MotionKind::Revolute,
            vector![0.4, -0.2, 1.0].normalize(),
            0.3,
        );
    }
    chain.build().unwrap()
}

struct Frame {
    base: Pose,
    rotation: Rotation3<f64>,
}

impl Frame {
    fn here() -> Self {
        Self {
            base: Pose::identity(),
            rotation: Rotation3::identity(),
        }
    }

    fn there() -> Self {
        let turn = UnitQuaternion::from_scaled_axis(vector![0.9, -1.3, 0.4]);
        Self {
            base: Pose::from_parts(vector![3.0, -2.0, 5.0].into(), turn),
            rotation: turn.to_rotation_matrix(),
        }
    }
}

/// The arm in a frame under its weight and a force of so many times (700, -900, -1500) N.
fn loaded_arm(chain: &Chain, frame: &Frame, units: Units, load: f64) -> LinearDynamics {
    let force = frame.rotation * vector![700.0, -900.0, -1500.0] * (load * units.force());
    let end = EndCondition::wrench(Wrench::new(force, Vector3::zeros()));
    let mut problem = ChainProblem::new(chain, end);
    problem.base = frame.base;
    let acceleration = units.length / (units.time * units.time);
    problem.loads.push(Load::gravity(
        frame.rotation * vector![0.8, -1.1, -9.6] * acceleration,
    ));
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap()
}

fn plainly(r: &[f64], how: Description) -> LinearDynamics {
    loaded_arm(&arm(r, how), &Frame::here(), how.units, 1.0)
}

fn same(found: &Modes, expected: &Modes, times: f64) -> Worst {
    let (found, expected) = (found.frequencies_hz(), expected.frequencies_hz());
    assert_eq!(found.len(), expected.len());
    let mut worst = Worst::new();
    for (k, (f, e)) in found.iter().zip(&expected).enumerate() {
        worst.add_at(f / (e * times) - 1.0, || format!("mode {k}: {f} {e}"));
    }
    worst
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0_f64, 11)
}

/// Of two complex matrices, in units of the geometric mean of the diagonal of the second.
fn apart(found: &Matrix6<Complex<f64>>, expected: &Matrix6<Complex<f64>>) -> Worst {
    let mut worst = Worst::new();
    for i in 0..6 {
        for j in 0..6 {
            let size = (expected[(i, i)].norm() * expected[(j, j)].norm()).sqrt();
            worst.add_at((found[(i, j)] - expected[(i, j)]).norm() / size, || {
                format!("{i} {j}")
            });
        }
    }
    worst
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// The base stands elsewhere and leans: frequencies stay, and a response turns with it.
    #[test]
    fn frames_do_not_matter(r in numbers()) {
        let chain = arm(&r, PLAIN);
        let here = loaded_arm(&chain, &Frame::here(), SI, 1.0);
        let there = loaded_arm(&chain, &Frame::there(), SI, 1.0);
        let (a, b) = (here.modes().unwrap(), there.modes().unwrap());
        let worst = same(&b, &a, 1.0);
        prop_assert!(worst.of(a.modes.len()) < 1e-9, "{worst}");
        let damping = Damping::Ratio(0.02);
        let tool = here.tool();
        let g = |d: &LinearDynamics, modes: &Modes| ModalResponse::new(d, modes, &damping, tool, tool, usize::MAX).unwrap().at_hz(23.0);
        let turn = kinetostat::spatial::turn_matrix(&Frame::there().rotation).map(|x| Complex::new(x, 0.0));
        let back = turn.transpose() * g(&there, &b) * turn;
        let worst = apart(&back, &g(&here, &a));
        prop_assert!(worst.of(36) < 1e-8, "{worst}");
    }

    /// Millimetres, tonnes and milliseconds: the same arm.
    #[test]
    fn units_do_not_matter(r in numbers(), time in prop::sample::select(vec![1.0, 1e3])) {
        let units = Units { length: 1e3, mass: 1e-3, time };
        let worst = same(&plainly(&r, Description { units, ..PLAIN }).modes().unwrap(), &plainly(&r, PLAIN).modes().unwrap(), 1.0 / time);
        prop_assert!(worst.value() < 1e-8, "{worst}");
    }

    /// A spring in two, a link in two, a body in two: the same arm.
    #[test]
    fn splitting_does_not_matter(r in numbers()) {
        let whole = plainly(&r, PLAIN);
        let expected = whole.modes().unwrap();
        for how in [
            Description { drive_in_two: true, ..PLAIN },
            Description { link_in_two: true, ..PLAIN },
            Description { body_in_two: true, ..PLAIN },
        ] {
            let parts = plainly(&r, how);
            let found = parts.modes().unwrap();
            prop_assert_eq!(found.counts.massless, expected.counts.massless + usize::from(how.drive_in_two));
            let worst = same(&found, &expected, 1.0);
            prop_assert!(worst.value() < 1e-8, "{worst}");
            prop_assert!((parts.total_mass() / whole.total_mass() - 1.0).abs() < 1e-12);
            let (a, b) = (parts.tool(), whole.tool());
            let found = ModalResponse::new(&parts, &found, &Damping::Undamped, a, a, 2).unwrap().at_hz(3.0);
            let expected = ModalResponse::new(&whole, &expected, &Damping::Undamped, b, b, 2).unwrap().at_hz(3.0);
            let worst = apart(&found, &expected);
            prop_assert!(worst.of(36) < 1e-6, "{worst}");
        }
    }

    /// A joint behind everything that has mass or load arm: one more neutral direction, the same frequencies.
    #[test]
    fn a_massless_joint_changes_nothing(r in numbers()) {
        let expected = plainly(&r, PLAIN).modes().unwrap();
        let found = plainly(&r, Description { idle_joint: true, ..PLAIN }).modes().unwrap();
        prop_assert_eq!(found.counts.neutral, expected.counts.neutral + 1);
        prop_assert_eq!(&found.neutral, &["idle".to_owned()]);
        prop_assert_eq!(found.counts.massless, expected.counts.massless);
        let worst = same(&found, &expected, 1.0);
        prop_assert!(worst.value() < 1e-9, "{worst}");
    }

    /// A load that goes to zero takes its effect along, in proportion.
    #[test]
    fn loads_go_to_zero(r in numbers()) {
        let chain = arm(&r, PLAIN);
        let squares = |load: f64| -> Vec<f64> {
            let modes = loaded_arm(&chain, &Frame::here(), SI, load).modes().unwrap();
            modes.modes.iter().map(|m| m.squared).collect()
        };
        let (none, small, half) = (squares(0.0), squares(2e-3), squares(1e-3));
        let (mut linear, mut tiny) = (Worst::new(), Worst::new());
        for k in 0..none.len() {
            let (whole, part) = (small[k] / none[k] - 1.0, half[k] / none[k] - 1.0);
            tiny.add(whole);
            // Halves, but for what is of second order and rounding.
            linear.add_at(whole - 2.0 * part, || format!("mode {k}: {whole} {part}"));
        }
        prop_assert!(tiny.value() < 1e-3, "{tiny}");
        prop_assert!(linear.value() < 1e-6, "{linear}");
    }

    /// Without circulatory loads: what A feels of B is what B feels of A; at rest the response is the loaded compliance.
    #[test]
    fn responses_are_reciprocal(r in numbers(), hz in 1.0..200.0_f64) {
        let d = plainly(&r, PLAIN);
        prop_assert!(!d.is_circulatory() && d.asymmetry() < 1e-12);
        let modes = d.modes().unwrap();
        let (a, b) = (d.tool(), d.place("boom.1.far").unwrap().at(vector![0.03, -0.05, 0.02]));
        for damping in [
            Damping::Undamped,
            Damping::Ratio(0.03),
            Damping::Rayleigh { mass_per_s: 3.0, stiffness_s: 1e-5 },
            Damping::Structural { loss_factor: 0.04 },
            Damping::Viscous(vec![("base".to_owned(), 900.0), ("wrist".to_owned(), 4000.0)]),
        ] {
            let direct = d.direct(&modes, &damping).unwrap();
            let (ab, ba) = (direct.at_hz(a, b, hz).unwrap(), direct.at_hz(b, a, hz).unwrap());
            let size = direct.at_hz(a, a, hz).unwrap();
            let mut worst = Worst::new();
            for i in 0..6 {
                for j in 0..6 {
                    let unit = (size[(i, i)].norm() * size[(j, j)].norm()).sqrt();
                    worst.add((ab[(i, j)] - ba[(j, i)]).norm() / unit);
                }
            }
            prop_assert!(worst.of(36) < 1e-8, "{}: {worst}", damping.name());
        }
        let at_rest = d.direct(&modes, &Damping::Ratio(0.03)).unwrap().at_hz(a, a, 0.0).unwrap();
        let motions = d.motions(a);
        let compliance = &motions * d.tangent().clone().lu().solve(&motions.transpose()).unwrap();
        let compliance = Matrix6::from_fn(|i, j| Complex::new(compliance[(i, j)], 0.0));
        let sum = ModalResponse::new(&d, &modes, &Damping::Ratio(0.03), a, a, 1).unwrap().at_hz(0.0);
        for found in [at_rest, sum] {
            let worst = apart(&found, &compliance);
            prop_assert!(worst.of(36) < 1e-9, "{worst}");
        }
    }

    /// In every mode, shares of kinetic and of elastic energy add to one, none is negative, and phi^T M phi is one.
    #[test]
    fn energies_are_shared_out(r in numbers()) {
        let d = plainly(&r, PLAIN);
        let modes = d.modes().unwrap();
        let mut worst = Worst::new();
        for mode in &modes.modes {
            for shares in [d.kinetic_shares(mode), d.elastic_shares(mode)] {
                worst.add(shares.iter().map(|s| s.share).sum::<f64>() - 1.0);
                prop_assert!(shares.iter().all(|s| s.share > -1e-12), "{shares:?}");
            }
            worst.add(mode.shape.dot(&(d.mass() * &mode.shape)) - 1.0);
        }
        prop_assert!(worst.of(3 * modes.modes.len()) < 1e-9, "{worst}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, ..ProptestConfig::default() })]

    /// The order in which limbs are listed does not matter, whichever of them the closures are met by.
    #[test]
    fn the_order_of_limbs_does_not_matter(
        order in Just([0, 1, 2, 3, 4, 5]).prop_shuffle(),
        force in proptest::array::uniform3(-4000.0..4000.0_f64),
    ) {
        let wrench = Wrench::new(force.into(), Vector3::zeros());
        let of = |order| loaded(&machine(order), &wrench, |_, _, dynamics| {
            let modes = dynamics.modes().unwrap();
            let tool = dynamics.tool();
            let g = dynamics.direct(&modes, &Damping::Ratio(0.02)).unwrap().at_hz(tool, tool, 40.0).unwrap();
            (modes, g)
        });
        let (expected, shuffled) = (of([0, 1, 2, 3, 4, 5]), of(order));
        let worst = same(&shuffled.0, &expected.0, 1.0);
        prop_assert!(worst.of(42) < 1e-8, "{worst}");
        let worst = apart(&shuffled.1, &expected.1);
        prop_assert!(worst.of(36) < 1e-7, "{worst}");
    }
}
