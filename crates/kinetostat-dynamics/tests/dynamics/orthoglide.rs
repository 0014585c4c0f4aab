//! The Orthoglide: massless legs, and legs whose bars are bodies before the parallelogram's spring, by definition.

use crate::common::*;
use kinetostat::model::{ParallelogramLaw, SpringLaw};
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, Modes};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, vector};

/// Masses of slider, foot and each of the two bars of a leg, kg.
type LegMasses = [f64; 3];

fn leg(index: usize, masses: LegMasses) -> Chain {
    let (length, r, foot) = (0.310, 0.0405, 0.1097);
    let e = |k: usize| Matrix3::identity().column(k % 3).into_owned();
    let frame = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[
        e(index),
        e(index + 1),
        e(index + 2),
    ]));
    let turned = Pose::from_parts(
        Vector3::zeros().into(),
        UnitQuaternion::from_rotation_matrix(&frame),
    );
    let section = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: 2.9952e7,
        second_moment_y: 638.5,
        second_moment_z: 1790.0,
        torsion_constant: 630.0,
    };
    let tilt = spatial::turn_matrix(&Rotation3::from_axis_angle(
        &Vector3::z_axis(),
        45_f64.to_radians(),
    ));
    let foot_matrix = tilt * section.cantilever(0.150).unwrap() * tilt.transpose();
    let mut bar = Matrix6::zeros();
    bar[(0, 0)] = 3.25e7;
    bar[(1, 1)] = 18.03e3;
    bar[(1, 5)] = -2878.5;
    bar[(5, 1)] = -2878.5;
    bar[(5, 5)] = 598.8;
    bar[(3, 3)] = 34.76;
    let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e9);
    drive.home = -r - length;
    let point = |chain: ChainBuilder, name: &str, mass: f64| match mass > 0.0 {
        true => chain.body(name, mass, Vector3::zeros(), Matrix3::zeros()),
        false => chain,
    };
    let law = ParallelogramLaw {
        bar,
        width: 0.080,
        inclination: 8,
    };
    let chain = Chain::builder(format!("leg {index}"))
        .rigid(turned)
        .translation(vector![0.0, -foot, 0.0])
        .actuator("drive", drive);
    let chain = point(chain, "slider", masses[0])
        .translation(vector![0.0, foot, 0.0])
        .spring6("foot", &foot_matrix, [0.0; 6]);
    let mut chain = point(chain, "foot mass", masses[1])
        .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
        .passive("q2", MotionKind::Revolute, Vector3::y(), 0.0);
    if masses[2] > 0.0 {
        let across = masses[2] * length * length / 12.0;
        // Each bar turns about its own hinge, half the width beside the axis.
        for (name, side) in [("bar 1", 0.04), ("bar 2", -0.04)] {
            chain = chain
                .coupled("q2", MotionKind::Revolute, Vector3::y(), -1.0)
                .translation(vector![0.0, 0.0, side])
                .coupled("q2", MotionKind::Revolute, Vector3::y(), 1.0)
                .body(
                    name,
                    masses[2],
                    vector![0.5 * length, 0.0, 0.0],
                    Matrix3::from_diagonal(&vector![0.0, across, across]),
                )
                .coupled("q2", MotionKind::Revolute, Vector3::y(), -1.0)
                .translation(vector![0.0, 0.0, -side])
                .coupled("q2", MotionKind::Revolute, Vector3::y(), 1.0);
        }
    }
    chain
        .translation(vector![length, 0.0, 0.0])
        .springs(
            "bars",
            &[0, 1, 3, 4, 5],
            SpringLaw::Parallelogram(Box::new(law)),
            vec![0.0; 5],
        )
        .coupled("q2", MotionKind::Revolute, Vector3::y(), -1.0)
        .passive("q3", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![r, 0.0, 0.0])
        .rigid(turned.inverse())
        .build()
        .unwrap()
}

pub fn orthoglide(masses: LegMasses, gravity: Vector3<f64>) -> Mechanism {
    let mut machine = Mechanism::builder("orthoglide").gravity(gravity);
    let tool = machine.platform(Platform {
        mass: 8.0,
        inertia: Matrix3::identity() * 0.03,
        ..Platform::new("tool", Pose::identity())
    });
    for index in 0..3 {
        machine = machine.limb(Limb::between(
            ["x", "y", "z"][index],
            0,
            tool,
            leg(index, masses),
        ));
    }
    machine.build().unwrap()
}

fn modes(masses: LegMasses, at: Vector3<f64>, loaded: bool) -> Modes {
    let machine = orthoglide(masses, if loaded { down() } else { Vector3::zeros() });
    let posture = machine
        .posture(&Pose::translation(at.x, at.y, at.z))
        .unwrap();
    let force = if loaded {
        vector![400.0, -300.0, 200.0]
    } else {
        Vector3::zeros()
    };
    let at = posture
        .deflected_by(&Wrench::new(force, Vector3::zeros()))
        .unwrap();
    let d = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
    assert!(d.asymmetry() < 1e-12, "{}", d.asymmetry());
    d.modes().unwrap()
}

#[test]
fn orthoglide_with_and_without_masses_of_its_legs() {
    let (none, heavy) = ([0.0; 3], [10.0, 3.0, 1.2]);
    let q = |x: f64| Vector3::repeat(x);
    let (q0, q1, q2) = (q(0.0), q(0.12635), q(-0.07365));
    // Off the diagonal of the workspace.
    let q3 = vector![0.12635, 0.12635, -0.07365];
    let mut worst = Worst::new();
    for (at, masses, loaded, expected) in [
        (
            q0,
            none,
            false,
            [59.44302, 59.45996, 59.45996, 97.49119, 97.49119, 97.49119],
        ),
        (
            q0,
            heavy,
            false,
            [16.22355, 16.22355, 16.25733, 46.79747, 46.79747, 47.38762],
        ),
        (
            q0,
            heavy,
            true,
            [14.94174, 15.89156, 17.13705, 46.774, 46.86668, 47.48994],
        ),
        (
            q1,
            none,
            false,
            [25.73926, 25.73926, 29.6089, 148.492, 148.492, 220.1847],
        ),
        (
            q1,
            heavy,
            false,
            [15.44531, 15.44531, 16.56153, 24.33175, 24.33175, 27.48419],
        ),
        (
            q1,
            heavy,
            true,
            [13.1845, 15.40792, 17.68132, 23.69791, 25.22082, 27.57891],
        ),
        (
            q2,
            none,
            false,
            [35.1969, 48.62082, 48.62082, 72.82366, 97.70992, 97.70992],
        ),
        (
            q2,
            heavy,
            false,
            [16.129, 16.33395, 16.33395, 31.07349, 41.94319, 41.94319],
        ),
        (
            q2,
            heavy,
            true,
            [14.90918, 15.72799, 16.90028, 31.11355, 41.89206, 42.12077],
        ),
        (
            q3,
            none,
            false,
            [27.54701, 45.46942, 51.34246, 84.5631, 135.7994, 211.3889],
        ),
        (
            q3,
            heavy,
            false,
            [15.67221, 16.42244, 16.55182, 25.80749, 36.80979, 40.8989],
        ),
        (
            q3,
            heavy,
            true,
            [13.50052, 16.10942, 18.72013, 25.32067, 36.99938, 41.13714],
        ),
    ] {
        let modes = modes(masses, at, loaded);
        let found = modes.frequencies_hz();
        println!("{:?} {:?}", &found[..6], modes.counts);
        for (found, expected) in found.iter().zip(expected) {
            worst.add_at(relative(*found, expected), || format!("{found} {expected}"));
        }
        if masses == none {
            assert_eq!((modes.modes.len(), modes.counts.massless), (6, 27));
        }
    }
    println!("{worst}");
    // Seven digits are printed.
    assert!(worst.of(72) < 1e-6);
}
