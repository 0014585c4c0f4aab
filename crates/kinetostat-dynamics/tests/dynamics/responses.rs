//! Responses: against reference values, at rest against the statics, and three ways against each other.

use crate::arms::arm6;
use crate::common::*;
use crate::platforms::loaded;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse, Quantity, Receptance};
use kinetostat_testing::Worst;
use nalgebra::{Complex, DMatrix, Matrix6, Vector3, vector};

fn arm_in_gravity(chain: &Chain) -> (LinearDynamics, kinetostat::chain::Equilibrium) {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    problem.loads.push(Load::gravity(down()));
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d =
        LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap();
    (d, at)
}

/// Largest difference of two receptances in units of the geometric means of the diagonal of `size`.
fn off(found: &Receptance, expected: &Receptance) -> f64 {
    let mut worst = Worst::new();
    for i in 0..6 {
        for j in 0..6 {
            let unit = (expected[(i, i)].norm() * expected[(j, j)].norm()).sqrt();
            worst.add((found[(i, j)] - expected[(i, j)]).norm() / unit);
        }
    }
    worst.of(36)
}

#[test]
fn tool_receptance_of_the_arm() {
    let chain = arm6();
    let (d, at) = arm_in_gravity(&chain);
    let modes = d.modes().unwrap();
    let tool = d.tool();
    let response =
        ModalResponse::new(&d, &modes, &Damping::Ratio(0.03), tool, tool, usize::MAX).unwrap();
    let direct = d.direct(&modes, &Damping::Ratio(0.03)).unwrap();
    let mut worst = Worst::new();
    for (hz, expected) in [
        (
            0.0,
            [
                [
                    7.75385244e-07,
                    0.0,
                    -2.33069765e-07,
                    0.0,
                    8.29027517e-08,
                    0.0,
                ],
                [
                    -2.33069765e-07,
                    0.0,
                    1.37678996e-06,
                    0.0,
                    7.84729328e-08,
                    0.0,
                ],
                [
                    8.29027517e-08,
                    0.0,
                    7.84729328e-08,
                    0.0,
                    1.08610148e-06,
                    0.0,
                ],
            ],
        ),
        (
            10.0,
            [
                [
                    1.03845145e-06,
                    -8.41924925e-08,
                    -8.64404413e-07,
                    1.66691164e-07,
                    5.22953111e-08,
                    -5.69578837e-07,
                ],
                [
                    -8.64404413e-07,
                    1.66691164e-07,
                    4.02206863e-06,
                    -7.54689338e-07,
                    6.06828377e-08,
                    -3.95315121e-07,
                ],
                [
                    5.22953111e-08,
                    -5.69578837e-07,
                    6.06828377e-08,
                    -3.95315121e-07,
                    -5.89851087e-07,
                    -1.65719600e-05,
                ],
            ],
        ),
        (
            25.0,
            [
                [
                    -1.81596762e-06,
                    -8.99261253e-07,
                    -6.21280173e-07,
                    -2.04913512e-07,
                    -9.40831692e-07,
                    -3.17931684e-07,
                ],
                [
                    -6.21280173e-07,
                    -2.04913512e-07,
                    1.90126049e-07,
                    -8.31590820e-08,
                    -1.78270726e-07,
                    -7.95418759e-08,
                ],
                [
                    -9.40831692e-07,
                    -3.17931684e-07,
                    -1.78270726e-07,
                    -7.95418759e-08,
                    -4.38744492e-07,
                    -1.24927631e-07,
                ],
            ],
        ),
        (
            52.0,
            [
                [
                    9.18771444e-08,
                    -1.61499867e-06,
                    2.45454540e-06,
                    -2.66946237e-07,
                    -2.33738429e-07,
                    5.72519236e-07,
                ],
                [
                    2.45454540e-06,
                    -2.66946237e-07,
                    -1.07691480e-06,
                    -1.88522417e-06,
                    -8.15475502e-07,
                    1.89576659e-07,
                ],
                [
                    -2.33738429e-07,
                    5.72519236e-07,
                    -8.15475502e-07,
                    1.89576659e-07,
                    5.74175616e-08,
                    -2.10119170e-07,
                ],
            ],
        ),
    ] {
        let (found, solved) = (response.at_hz(hz), direct.at_hz(tool, tool, hz).unwrap());
        assert!(off(&found, &solved) < 1e-10, "{}", off(&found, &solved));
        for i in 0..3 {
            for j in 0..3 {
                let e = Complex::new(expected[i][2 * j], expected[i][2 * j + 1]);
                worst.add((found[(i, j)] - e).norm() / 1e-6);
            }
        }
    }
    println!("{worst}");
    assert!(worst.of(36) < 2e-8);
    // Reciprocity between two other points.
    let (a, b) = (
        d.place("link 2").unwrap(),
        tool.at(vector![0.1, -0.05, 0.2]),
    );
    let there = ModalResponse::new(&d, &modes, &Damping::Ratio(0.03), a, b, usize::MAX)
        .unwrap()
        .at_hz(17.0);
    let back = ModalResponse::new(&d, &modes, &Damping::Ratio(0.03), b, a, usize::MAX)
        .unwrap()
        .at_hz(17.0);
    for i in 0..6 {
        for j in 0..6 {
            assert!((there[(i, j)] - back[(j, i)]).norm() < 1e-12 * there.norm());
        }
    }
    // At rest it is the loaded compliance, however few modes are kept; of six joints the tool has all directions.
    let compliance = at.stiffness.cartesian.compliance().unwrap();
    for kept in [0, 1, 3, 6] {
        let few = ModalResponse::new(&d, &modes, &Damping::Ratio(0.03), tool, tool, kept).unwrap();
        let unity = few.at_hz(0.0).map(|x| x.re) * at.stiffness.cartesian.matrix;
        let (l, mut worst) = (1.0, Worst::new());
        for i in 0..6 {
            for j in 0..6 {
                let unit = (compliance[(i, i)] / compliance[(j, j)]).sqrt() * l;
                worst.add((unity[(i, j)] - f64::from(u8::from(i == j))) / unit);
            }
        }
        assert!(worst.of(36) < 1e-9, "{worst}");
    }
    let there = response.over(&[17.0], Quantity::Velocity)[0];
    let acceleration = response.over(&[17.0], Quantity::Acceleration)[0];
    let w = 17.0 * std::f64::consts::TAU;
    assert!((acceleration - there * Complex::new(0.0, w)).norm() < 1e-12 * acceleration.norm());
}

#[test]
fn two_ways_to_the_response_of_a_loaded_platform() {
    let (machine, force) = loaded();
    let posture = machine.posture(&machine.platforms()[1].home).unwrap();
    let at = posture.deflected_by(&force).unwrap();
    let d = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
    let (modes, tool) = (d.modes().unwrap(), d.tool());
    let modal = ModalResponse::new(&d, &modes, &Damping::Undamped, tool, tool, usize::MAX).unwrap();
    let direct = d.direct(&modes, &Damping::Undamped).unwrap();
    for hz in [0.0, 15.0, 33.3] {
        let (a, b) = (modal.at_hz(hz), direct.at_hz(tool, tool, hz).unwrap());
        println!("{hz}: {:e}", off(&b, &a));
        assert!(off(&b, &a) < 1e-9);
    }
    let reference = rows("2.18529183e-06  -5.85334355e-10  -8.56689499e-09  1.10587848e-08  1.02395078e-06  5.59916362e-08
-5.85334355e-10  2.19039161e-06  5.42798383e-09  -1.05684703e-06  -1.11423558e-08  1.12436063e-07
-8.56689499e-09  5.42798383e-09  2.84255020e-07  -9.46665222e-09  -1.74184130e-08  5.87843650e-11
1.10587848e-08  -1.05684703e-06  -9.46665222e-09  6.68897237e-06  3.38882176e-09  -8.01716364e-08
1.02395078e-06  -1.11423558e-08  -1.74184130e-08  3.38882176e-09  6.69375952e-06  3.92606899e-08
5.59916362e-08  1.12436063e-07  5.87843650e-11  -8.01716364e-08  3.92606899e-08  6.91287168e-06");
    let found = modal.at_hz(15.0);
    let found = DMatrix::from_fn(6, 6, |i, j| found[(i, j)].re);
    println!("15 Hz: {:e}", apart(&found, &reference, &reference));
    assert!(apart(&found, &reference, &reference) < 1e-8);
    let unity = modal.at_hz(0.0).map(|x| x.re) * at.stiffness.matrix - Matrix6::identity();
    assert!(unity.iter().all(|x| x.abs() < 1e-9), "{unity}");
    // With damping of every kind the sum of modes and the direct solution agree where they say the same.
    for damping in [Damping::Ratio(0.02), Damping::Ratios(vec![0.01, 0.05])] {
        let modal = ModalResponse::new(&d, &modes, &damping, tool, tool, usize::MAX).unwrap();
        let direct = d.direct(&modes, &damping).unwrap();
        assert!(off(&direct.at_hz(tool, tool, 36.4).unwrap(), &modal.at_hz(36.4)) < 1e-9);
    }
}

#[test]
fn the_loss_factor_multiplies_the_material_alone() {
    // A pendulum whose spring is beaten by its weight's help: k = 40, m g l = 20.6; the loss is that of k.
    let chain = Chain::builder("pendulum")
        .spring("pivot", MotionKind::Revolute, Vector3::y(), 40.0, 0.0)
        .body(
            "bob",
            3.0,
            vector![0.0, 0.0, -0.7],
            nalgebra::Matrix3::zeros(),
        )
        .build()
        .unwrap();
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads.push(Load::gravity(down()));
    let d = about(&problem, &Held::nothing());
    let modes = d.modes().unwrap();
    let bob = d.place("bob").unwrap();
    let damping = Damping::Structural { loss_factor: 0.05 };
    let w2 = modes.modes[0].squared;
    let hz = w2.sqrt() / std::f64::consts::TAU;
    let expected = Complex::new(0.49, 0.0) / Complex::new(0.0, 0.05 * 40.0);
    let direct = d
        .direct(&modes, &damping)
        .unwrap()
        .at_hz(bob, bob, hz)
        .unwrap()[(0, 0)];
    let modal = ModalResponse::new(&d, &modes, &damping, bob, bob, 1)
        .unwrap()
        .at_hz(hz)[(0, 0)];
    assert!((direct - expected).norm() < 1e-9 * expected.norm());
    assert!((modal - expected).norm() < 1e-9 * expected.norm());
}

#[test]
fn truncation_needs_residual_flexibility() {
    let mass = kinetostat::model::LinkMass::of_section(&section(), DENSITY);
    let chain = Chain::builder("beam")
        .link_with(
            "beam",
            &LinkSpec::beam(section(), 1.0).segments(4).with_mass(mass),
        )
        .build()
        .unwrap();
    let (d, _) = arm_in_gravity(&chain);
    let (modes, tool) = (d.modes().unwrap(), d.tool());
    assert_eq!(modes.modes.len(), 24);
    let all =
        ModalResponse::new(&d, &modes, &Damping::Ratio(0.02), tool, tool, usize::MAX).unwrap();
    let three = ModalResponse::new(&d, &modes, &Damping::Ratio(0.02), tool, tool, 3).unwrap();
    let hz = 0.9 * modes.modes[2].frequency_hz();
    let (exact, with, bare) = (
        all.at_hz(hz),
        three.at_hz(hz),
        three.at_hz(hz) - three.residual().map(|x| Complex::new(x, 0.0)),
    );
    // Along the beam no bending mode gives anything: without the residual all of it is missing.
    assert!(((bare - exact)[(0, 0)] / exact[(0, 0)]).norm() > 0.9);
    assert!(((with - exact)[(0, 0)] / exact[(0, 0)]).norm() < 0.02);
}

#[test]
fn bad_questions_are_refused_in_words() {
    let chain = arm6();
    let (d, _) = arm_in_gravity(&chain);
    let modes = d.modes().unwrap();
    let said = |damping: Damping| d.damping_matrix(&modes, &damping).unwrap_err().to_string();
    assert!(said(Damping::Ratio(1.5)).contains("critical"));
    assert!(said(Damping::Ratio(f64::NAN)).contains("not below zero"));
    assert!(said(Damping::Viscous(vec![("q9".into(), 1.0)])).contains("q1, q2"));
    assert!(
        d.place("nowhere")
            .unwrap_err()
            .to_string()
            .contains("link 3")
    );
    let bare = Chain::builder("bare")
        .spring("joint", MotionKind::Revolute, Vector3::z(), 1e4, 0.0)
        .translation(vector![0.4, 0.0, 0.0])
        .build()
        .unwrap();
    let problem = ChainProblem::new(&bare, EndCondition::wrench(Wrench::zero()));
    let error =
        LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing()).unwrap_err();
    assert!(error.to_string().contains("no mass anywhere"));
    let body = |inertia| {
        let chain = Chain::builder("odd")
            .spring("joint", MotionKind::Revolute, Vector3::z(), 1e4, 0.0)
            .body("lump", 3.0, vector![0.4, 0.0, 0.0], inertia)
            .build()
            .unwrap();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing())
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    let diagonal = |x, y, z| nalgebra::Matrix3::from_diagonal(&vector![x, y, z]);
    assert!(body(diagonal(1.0, 1.0, 2.0)).is_ok());
    assert!(
        body(diagonal(1.0, 1.0, 2.1))
            .unwrap_err()
            .contains("lump: its principal moments")
    );
    assert!(
        body(diagonal(-0.1, 1.0, 1.0))
            .unwrap_err()
            .contains("below zero")
    );
}
