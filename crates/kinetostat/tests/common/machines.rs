//! Machines of the report and of the benches.

use kinetostat::{
    ActuatorSpec, BeamSection, Chain, ChainBuilder, Limb, Mechanism, MotionKind, Platform, Pose,
    spatial::turn_matrix,
};
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, vector};

/// The identified Orthoglide (the book, reference numbers), SI.
pub struct Orthoglide {
    pub bar_length: f64,
    /// Rotation of leg i about its own actuator line, rad.
    pub line_error: f64,
    /// Offset of leg i along its own actuator, m.
    pub slide_error: f64,
    /// Order of the legs in the mechanism.
    pub order: [usize; 3],
}

impl Default for Orthoglide {
    fn default() -> Self {
        Self {
            bar_length: 0.310,
            line_error: 0.0,
            slide_error: 0.0,
            order: [0, 1, 2],
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
        // Foot: cantilever of 150 mm at 45 degrees between x and n; EA, EI, GJ are what is known.
        let section = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: 2.9952e7,
            second_moment_y: 638.5,
            second_moment_z: 1790.0,
            torsion_constant: 630.0,
        };
        let tilt = turn_matrix(&Rotation3::from_axis_angle(
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
        for i in self.order {
            builder = builder.limb(
                Limb::between(["x", "y", "z"][i], 0, tool, self.leg(i, false))
                    .with_actual(self.leg(i, true)),
            );
        }
        builder.build().expect("orthoglide")
    }
}

/// Names of the six directions of a spring in [`kinetostat::Chain`] order.
pub const SIX: [(MotionKind, [f64; 3]); 6] = [
    (MotionKind::Prismatic, [1.0, 0.0, 0.0]),
    (MotionKind::Prismatic, [0.0, 1.0, 0.0]),
    (MotionKind::Prismatic, [0.0, 0.0, 1.0]),
    (MotionKind::Revolute, [1.0, 0.0, 0.0]),
    (MotionKind::Revolute, [0.0, 1.0, 0.0]),
    (MotionKind::Revolute, [0.0, 0.0, 1.0]),
];

/// The heavy 6R arm of the benches (KUKA KR-270-like, `benches/numpy/machines.py`): per joint an actuator
/// spring and a 6-D link spring (tube), link masses.
pub fn arm(with_masses: bool) -> Chain {
    let axes = [
        Vector3::z(),
        Vector3::y(),
        Vector3::y(),
        Vector3::x(),
        Vector3::y(),
        Vector3::x(),
    ];
    let links = [
        vector![0.35, 0.0, 0.75],
        vector![0.0, 0.0, 1.25],
        vector![0.55, 0.0, -0.055],
        vector![0.55, 0.0, 0.0],
        vector![0.23, 0.0, 0.0],
        vector![0.15, 0.0, 0.10],
    ];
    let drives = [3.8e6, 6.6e6, 3.9e6, 5.6e5, 6.6e5, 4.7e5];
    let tubes = [
        (0.40, 0.36),
        (0.32, 0.28),
        (0.26, 0.23),
        (0.22, 0.19),
        (0.16, 0.13),
        (0.12, 0.08),
    ];
    let masses = [330.0, 270.0, 190.0, 90.0, 35.0, 25.0];
    let mut builder: ChainBuilder = Chain::builder("arm");
    for i in 0..6 {
        let l: Vector3<f64> = links[i];
        let x = l.normalize();
        let up = if x.z.abs() < 0.9 {
            Vector3::z()
        } else {
            Vector3::y()
        };
        let y = up.cross(&x).normalize();
        let frame = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]));
        let turn = turn_matrix(&frame);
        let section = BeamSection::tube(2.1e11, 2.1e11 / 2.6, tubes[i].0, tubes[i].1);
        let k = turn * section.cantilever(l.norm()).unwrap() * turn.transpose();
        builder = builder
            .actuator(
                &format!("A{}", i + 1),
                ActuatorSpec::new(MotionKind::Revolute, axes[i], drives[i]),
            )
            .translation(l)
            .spring6(&format!("link {}", i + 1), &k, [0.0; 6]);
        if with_masses {
            builder = builder.body(
                &format!("mass {}", i + 1),
                masses[i],
                -0.5 * l,
                Matrix3::identity(),
            );
        }
    }
    builder.build().expect("arm")
}

/// A planar chain of `n` rigid links of length `l` with a hinge at the base, torsion springs `k`
/// at the inner joints and a free hinge at the end: the columns of chapter 5.
pub fn planar_column(n: usize, l: f64, k: f64) -> Chain {
    let mut b = Chain::builder("column").passive("q", MotionKind::Revolute, Vector3::z(), 0.0);
    for i in 0..n {
        b = b.translation(vector![l, 0.0, 0.0]);
        b = if i + 1 < n {
            b.spring(
                &format!("th{}", i + 1),
                MotionKind::Revolute,
                Vector3::z(),
                k,
                0.0,
            )
        } else {
            b.passive("e", MotionKind::Revolute, Vector3::z(), 0.0)
        };
    }
    b.build().expect("column")
}

/// Q0 .. Q4 of the report.
pub fn orthoglide_point(index: usize) -> Pose {
    let (a, b) = (0.12635, -0.07365);
    let [x, y, z] = [[0.0; 3], [a; 3], [b; 3], [a, a, b], [b, b, a]][index];
    Pose::translation(x, y, z)
}
