//! The Orthoglide as identified from the report's own tables, with what the entries vary: errors of
//! its legs, stiffness of its drives, and how its bars are modelled.
//!
//! The numbers are those of the preset `orthoglide` (a test holds the two together); they are written
//! here again because the entries need machines that a model file cannot say.

use kinetostat::{
    ActuatorSpec, BeamSection, Chain, ChainBuilder, Limb, Mechanism, MotionKind, Platform, Pose,
    Posture, Wrench,
    model::{ParallelogramLaw, Role, SpringLaw},
    spatial::turn_matrix,
};
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3};

use crate::Cause;

/// Distance from the last joint to the platform's point, m.
pub(super) const HEAD: f64 = 0.0405;
/// Distance from the slider's line to the first joint, m.
pub(super) const FOOT: f64 = 0.1097;
/// Distance of the bars of a parallelogram, m.
pub(super) const WIDTH: f64 = 0.080;
/// Stiffness of a drive that leaves the bars and feet as they were identified, N/m.
pub(super) const RIGID_DRIVE: f64 = 1e9;

/// Small and large coordinate of the corners of the workspace, m: Q1 = (LARGE, LARGE, LARGE).
pub(super) const LARGE: f64 = 0.126_35;
/// See [`LARGE`].
pub(super) const SMALL: f64 = -0.073_65;

/// Q0 to Q4 of chapter 6 (m).
pub(crate) const POINTS: [(&str, [f64; 3]); 5] = [
    ("Q0", [0.0, 0.0, 0.0]),
    ("Q1", [LARGE, LARGE, LARGE]),
    ("Q2", [SMALL, SMALL, SMALL]),
    ("Q3", [LARGE, LARGE, SMALL]),
    ("Q4", [SMALL, SMALL, LARGE]),
];

/// Cutting forces of groove milling: radial, tangential, axial (N) [R 6.5.2, 7.5].
pub(super) const CUTTING_N: [f64; 3] = [215.0, -10.0, -25.0];
/// Length of the tool, m.
pub(super) const TOOL: f64 = 0.100;

/// Parameters that are varied.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orthoglide {
    /// Length of the bars, m.
    pub(super) bar_length: f64,
    /// Stiffness of the drives, N/m.
    pub(super) drive: f64,
    /// Turn of every leg about its own slider's line, rad (Case B).
    pub(super) line_error: f64,
    /// Offset of every leg along its own slider, m (Case A).
    pub(super) slide_error: f64,
    /// Inclination (rad) at which the matrices of all parallelograms are taken; each its own if none.
    pub(super) matrix_at: Option<f64>,
}

impl Default for Orthoglide {
    fn default() -> Self {
        Self {
            bar_length: 0.310,
            drive: RIGID_DRIVE,
            line_error: 0.0,
            slide_error: 0.0,
            matrix_at: None,
        }
    }
}

impl Orthoglide {
    /// 1 degree of turn of every leg about its slider's line.
    pub(super) fn case_b() -> Self {
        Self {
            line_error: 1_f64.to_radians(),
            ..Self::default()
        }
    }

    /// 1 mm of offset of every leg along its slider.
    pub(super) fn case_a() -> Self {
        Self {
            slide_error: 1e-3,
            ..Self::default()
        }
    }

    /// Each leg one chain, its parallelogram one spring: the report's model.
    pub(crate) fn build(&self) -> Result<Mechanism, Cause> {
        let mut builder = Mechanism::builder("orthoglide");
        let tool = builder.platform(Platform::new("tool", Pose::identity()));
        for leg in 0..3 {
            builder = builder.limb(
                Limb::between(
                    format!("leg {}", ["x", "y", "z"][leg]),
                    0,
                    tool,
                    self.leg(leg, false)?,
                )
                .with_actual(self.leg(leg, true)?),
            );
        }
        Ok(builder.build()?)
    }

    fn leg(&self, leg: usize, with_errors: bool) -> Result<Chain, Cause> {
        let chain = self.foot(leg, with_errors)?;
        let chain = match self.matrix_at {
            None => chain.parallelogram("q2", self.bar_length, WIDTH, &bar(), 0.0),
            Some(inclination) => {
                let law = ParallelogramLaw {
                    bar: bar(),
                    width: WIDTH,
                    inclination: 0,
                };
                let matrix = law.matrix(inclination);
                let law = SpringLaw::Linear(DMatrix::from_fn(5, 5, |i, j| matrix[(i, j)]));
                chain
                    .passive("q2", MotionKind::Revolute, Vector3::y(), 0.0)
                    .translation(Vector3::new(self.bar_length, 0.0, 0.0))
                    .springs("q2.bars", &[0, 1, 3, 4, 5], law, vec![0.0; 5])
                    .coupled("q2", MotionKind::Revolute, Vector3::y(), -1.0)
            }
        };
        Ok(head(chain, leg).build()?)
    }

    /// Chain from the base to the first joint.
    pub(super) fn foot(&self, leg: usize, with_errors: bool) -> Result<ChainBuilder, Cause> {
        let (turn, slide) = match with_errors {
            true => (self.line_error, self.slide_error),
            false => (0.0, 0.0),
        };
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), self.drive);
        drive.home = -HEAD - self.bar_length;
        let chain = Chain::builder(format!("leg {leg}"))
            .rigid(axes(leg))
            .translation(Vector3::new(0.0, -FOOT, 0.0))
            .rigid(Pose::rotation(Vector3::x() * turn))
            .translation(Vector3::new(slide, 0.0, 0.0))
            .actuator("drive", drive)
            .translation(Vector3::new(0.0, FOOT, 0.0))
            .spring6("foot", &foot_stiffness()?, [0.0; 6])
            .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0);
        Ok(chain)
    }
}

/// Chain from the last joint to the platform.
pub(super) fn head(chain: ChainBuilder, leg: usize) -> ChainBuilder {
    chain
        .passive("q3", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(Vector3::new(HEAD, 0.0, 0.0))
        .rigid(axes(leg).inverse())
}

/// Axes of a leg: x along its slider, y towards its foot's arm, z along its outer joints.
pub(super) fn axes(leg: usize) -> Pose {
    let e = |k: usize| Matrix3::identity().column(k % 3).into_owned();
    let frame =
        Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[e(leg), e(leg + 1), e(leg + 2)]));
    Pose::from_parts(
        Vector3::zeros().into(),
        UnitQuaternion::from_rotation_matrix(&frame),
    )
}

/// The foot at the first joint: a cantilever of 150 mm at 45 degrees between x and y (SI).
fn foot_stiffness() -> Result<Matrix6<f64>, Cause> {
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
    Ok(tilt * section.cantilever(0.150)? * tilt.transpose())
}

/// Stiffness of one bar at its far end (SI). Bending along z, which the lumped parallelogram leaves out, is that
/// along y.
pub(super) fn bar() -> Matrix6<f64> {
    let mut k = Matrix6::zeros();
    k[(0, 0)] = 3.25e7;
    k[(3, 3)] = 34.76;
    for (shift, turn, sign) in [(1, 5, -1.0), (2, 4, 1.0)] {
        k[(shift, shift)] = 18.03e3;
        k[(turn, turn)] = 598.8;
        k[(shift, turn)] = sign * 2878.5;
        k[(turn, shift)] = sign * 2878.5;
    }
    k
}

/// A target of the tool (m), not turned.
pub fn target(point: [f64; 3]) -> Pose {
    Pose::translation(point[0], point[1], point[2])
}

/// Cutting forces on the platform while the tool's edge stands at `angle` (rad) about z [R 7.16, and
/// 7.17 with the sign of erratum 12 of part 2]: radial force outwards, tangential force forwards, the
/// tip one tool length along z.
pub fn cutting(angle: f64) -> Wrench {
    let [radial, tangential, axial] = CUTTING_N;
    let (s, c) = angle.sin_cos();
    let force = Vector3::new(
        radial * c - tangential * s,
        radial * s + tangential * c,
        axial,
    );
    Wrench::new(force, Vector3::new(-force.y * TOOL, force.x * TOOL, 0.0))
}

/// Inclination of the parallelogram of a leg in a posture, rad.
pub(super) fn inclination(posture: &Posture, leg: usize) -> f64 {
    let joints = posture.mechanism().limbs()[leg]
        .nominal
        .indices_of(Role::Passive);
    posture.limbs()[leg].coordinates[joints[1]]
}
