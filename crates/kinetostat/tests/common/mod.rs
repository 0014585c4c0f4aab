//! Machines and helpers shared by the tests.
#![allow(dead_code)]

use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Limb, Mechanism, MotionKind, Platform, Pose, turn_matrix,
};
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, vector};

/// Numbers of the identified Orthoglide (reference values, part 2, section 1), SI.
pub struct Orthoglide {
    pub bar_length: f64,
    /// Rotation of leg i about its own actuator line, rad.
    pub line_error: f64,
    /// Offset of leg i along its own actuator, m.
    pub slide_error: f64,
}

impl Default for Orthoglide {
    fn default() -> Self {
        Self {
            bar_length: 0.310,
            line_error: 0.0,
            slide_error: 0.0,
        }
    }
}

impl Orthoglide {
    pub fn leg(&self, index: usize, errors: bool) -> Chain {
        let (length, r, foot) = (self.bar_length, 0.0405, 0.1097);
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
        // Foot: cantilever of 150 mm at 45 degrees between x and n.
        let in_plane = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: 2.9952e7,
            second_moment_y: 6.385e8 * 1e-6,
            second_moment_z: 1.79e9 * 1e-6,
            torsion_constant: 6.3e8 * 1e-6,
        };
        let tilt = turn_matrix(&Rotation3::from_axis_angle(
            &Vector3::z_axis(),
            45_f64.to_radians(),
        ));
        let foot_matrix = tilt * in_plane.cantilever(0.150) * tilt.transpose();
        let mut bar = Matrix6::zeros();
        bar[(0, 0)] = 3.25e7;
        bar[(1, 1)] = 18.03e3;
        bar[(1, 5)] = -2878.5;
        bar[(5, 1)] = -2878.5;
        bar[(5, 5)] = 598.8;
        bar[(3, 3)] = 34.76;
        let error = if errors { self.line_error } else { 0.0 };
        let slide = if errors { self.slide_error } else { 0.0 };
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e9);
        drive.home = -r - length;
        Chain::builder(format!("leg {}", ["x", "y", "z"][index]))
            .rigid(turned)
            .translation(vector![0.0, -foot, 0.0])
            .rigid(Pose::rotation(Vector3::x() * error))
            .translation(vector![slide, 0.0, 0.0])
            .actuator("drive", drive)
            .translation(vector![0.0, foot, 0.0])
            .spring6("foot", &foot_matrix, [0.0; 6])
            .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
            .parallelogram("q2", length, 0.080, &bar, 0.0)
            .passive("q3", MotionKind::Revolute, Vector3::z(), 0.0)
            .translation(vector![r, 0.0, 0.0])
            .rigid(turned.inverse())
            .build()
            .expect("leg")
    }

    pub fn build(&self) -> Mechanism {
        let mut builder = Mechanism::builder("orthoglide");
        let tool = builder.platform(Platform::new("tool", Pose::identity()));
        for i in 0..3 {
            builder = builder.limb(Limb {
                name: ["x", "y", "z"][i].into(),
                from: 0,
                to: tool,
                platform_from_tip: Pose::identity(),
                nominal: self.leg(i, false),
                actual: self.leg(i, true),
            });
        }
        builder.build().expect("orthoglide")
    }
}

/// Q0 .. Q4 of the report, m.
pub fn orthoglide_points() -> [Vector3<f64>; 5] {
    let (a, b) = (0.12635, -0.07365);
    [
        vector![0.0, 0.0, 0.0],
        vector![a, a, a],
        vector![b, b, b],
        vector![a, a, b],
        vector![b, b, a],
    ]
}
