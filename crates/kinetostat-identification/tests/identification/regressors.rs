//! Arms, loads and random numbers of the reference problems for identification, for tests of any crate.
//!
//! Lengths in metres, angles in radians, forces in newtons. Twists are `[v; w]` and wrenches `[f; m]`, in base axes.

use crate::support::{H6, RANGES, Random};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Unit, Vector3};

/// Serial arm of revolute joints as a product of exponentials. In the zero posture the flange axes are the base axes.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Unit vector and a point of each axis in the zero posture.
    pub axes: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Flange in the zero posture.
    pub flange: Vector3<f64>,
    /// Limits of the joints, degrees.
    pub ranges_deg: Vec<(f64, f64)>,
    /// Compliances of the joints, rad/(N m).
    pub compliances: Vec<f64>,
}

impl Arm {
    /// Reference arm H6: a heavy arm with six joints.
    pub fn h6() -> Self {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let wrist = Vector3::new(1.85, 0.0, 1.945);
        Self {
            axes: vec![
                (z, Vector3::zeros()),
                (y, Vector3::new(0.35, 0.0, 0.75)),
                (y, Vector3::new(0.35, 0.0, 2.0)),
                (x, Vector3::new(0.35, 0.0, 1.945)),
                (y, wrist),
                (x, wrist),
            ],
            flange: Vector3::new(2.08, 0.0, 1.945),
            ranges_deg: RANGES.into(),
            compliances: H6.into(),
        }
    }

    /// Reference arm with three joints; the tool point is the flange.
    pub fn three_r() -> Self {
        let (y, z) = (Vector3::y(), Vector3::z());
        Self {
            axes: vec![
                (z, Vector3::zeros()),
                (y, Vector3::new(0.0, 0.0, 0.75)),
                (y, Vector3::new(0.0, 0.0, 2.0)),
            ],
            flange: Vector3::new(0.0, 0.0, 3.4),
            ranges_deg: vec![(-180.0, 180.0), (-60.0, 60.0), (-70.0, 80.0)],
            compliances: vec![0.25e-6, 0.30e-6, 0.40e-6],
        }
    }

    /// Random posture within the limits, one draw per joint.
    pub fn draw(&self, random: &mut Random) -> Vec<f64> {
        let limits = self.ranges_deg.iter();
        limits
            .map(|(low, high)| random.between(*low, *high).to_radians())
            .collect()
    }

    /// Posture at joint angles.
    pub fn at(&self, q: &[f64]) -> Posture {
        let mut rotation = Rotation3::identity();
        let mut translation = Vector3::zeros();
        let mut axes = Vec::new();
        for ((axis, point), angle) in self.axes.iter().zip(q) {
            axes.push((rotation * axis, rotation * point + translation));
            let turn = Rotation3::from_axis_angle(&Unit::new_normalize(*axis), *angle);
            translation += rotation * (point - turn * point);
            rotation *= turn;
        }
        Posture {
            axes,
            flange: rotation * self.flange + translation,
            rotation,
        }
    }
}

/// Arm in a posture.
#[derive(Clone, Debug)]
pub struct Posture {
    /// Unit vector and a point of each axis.
    pub axes: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Flange.
    pub flange: Vector3<f64>,
    /// Orientation of the flange.
    pub rotation: Rotation3<f64>,
}

impl Posture {
    /// Place of a point given in the flange frame.
    pub fn point(&self, in_flange: Vector3<f64>) -> Vector3<f64> {
        self.flange + self.rotation * in_flange
    }

    /// Jacobian of the twist `[v; w]` at a point, 6 x joints.
    pub fn jacobian(&self, point: Vector3<f64>) -> DMatrix<f64> {
        let mut jacobian = DMatrix::zeros(6, self.axes.len());
        for ((axis, on_axis), mut column) in self.axes.iter().zip(jacobian.column_iter_mut()) {
            column
                .rows_mut(0, 3)
                .copy_from(&axis.cross(&(point - on_axis)));
            column.rows_mut(3, 3).copy_from(axis);
        }
        jacobian
    }

    /// Regressor `J_j (J_j^T F)` of the joint compliances for a force at a point: twist of that point, 6 x joints.
    pub fn regressor(&self, point: Vector3<f64>, force: Vector3<f64>) -> DMatrix<f64> {
        let mut jacobian = self.jacobian(point);
        for mut column in jacobian.column_iter_mut() {
            let torque = column.rows(0, 3).dot(&force);
            column *= torque;
        }
        jacobian
    }

    /// Regressor of the displacements of markers, three rows each, for a force at a point. Markers and point in the flange frame.
    pub fn marker_regressor(
        &self,
        point: Vector3<f64>,
        force: Vector3<f64>,
        markers: &[Vector3<f64>],
    ) -> DMatrix<f64> {
        let loaded = self.point(point);
        let twist = self.regressor(loaded, force);
        let mut rows = DMatrix::zeros(3 * markers.len(), self.axes.len());
        for (k, marker) in markers.iter().enumerate() {
            let part = marker_rows(self.point(*marker) - loaded) * &twist;
            rows.rows_mut(3 * k, 3).copy_from(&part);
        }
        rows
    }
}

/// Rows `[I, -hat(r)]` that take the twist of a point to the displacement of a marker at the distance `r` from it, 3 x 6.
pub fn marker_rows(r: Vector3<f64>) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(3, 6);
    rows.view_mut((0, 0), (3, 3))
        .copy_from(&Matrix3::identity());
    rows.view_mut((0, 3), (3, 3)).copy_from(&-r.cross_matrix());
    rows
}

/// Tool point of H6 in the flange frame.
pub fn tool_point() -> Vector3<f64> {
    Vector3::new(0.25, 0.10, -0.05)
}

/// Markers of H6 in the flange frame.
pub fn markers() -> [Vector3<f64>; 3] {
    [
        Vector3::new(0.30, 0.12, 0.10),
        Vector3::new(0.28, -0.15, 0.05),
        Vector3::new(0.22, 0.02, -0.18),
    ]
}

/// Standard deviation of the laser tracker at (4, -3, 1) for a marker, metres.
pub fn tracker_sigma(marker: Vector3<f64>) -> f64 {
    15e-6 + 6e-6 * (marker - Vector3::new(4.0, -3.0, 1.0)).norm()
}

/// Displacements for given compliances.
pub fn displacement(regressor: &DMatrix<f64>, compliances: &[f64]) -> DVector<f64> {
    regressor * DVector::from_column_slice(compliances)
}
