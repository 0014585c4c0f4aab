//! Orientations as the languages write them, and back.

use nalgebra::{Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

/// Convention of the numbers of an orientation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrientationText {
    /// w, x, y, z (RAPID).
    Quaternion,
    /// A about Z, B about the new Y, C about the new X, degrees (KRL).
    Abc,
    /// W about X, P about Y, R about Z, fixed axes, degrees (FANUC).
    Wpr,
    /// RX about X, RY about the new Y, RZ about the new Z, degrees (VAL3).
    Xyz,
    /// Direction of the tool's axis, the turn about it unstated (APT).
    Axis,
    /// The axis by the angle about it, radians (URScript).
    RotationVector,
    /// No numbers: the orientation is that of before.
    Unstated,
}

/// Farthest that the length of a written quaternion or direction is from 1: 9.2e-7 in programs seen.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Largest angle of a rotation vector that is taken to mean one, rad.
const FARTHEST_RAD: f64 = 1e3;

impl OrientationText {
    /// The rotation that numbers mean; none where they mean none.
    #[must_use]
    pub fn rotation_of(self, numbers: &[f64]) -> Option<UnitQuaternion<f64>> {
        match (self, numbers) {
            (Self::Quaternion, &[w, x, y, z]) => {
                let quaternion = Quaternion::new(w, x, y, z);
                let is_unit = (quaternion.norm() - 1.0).abs() <= UNIT_TOLERANCE;
                is_unit.then(|| UnitQuaternion::new_normalize(quaternion))
            }
            (Self::Abc, &[a, b, c]) | (Self::Wpr, &[c, b, a]) => {
                let [a, b, c] = [a, b, c].map(f64::to_radians);
                let all = [a, b, c].iter().all(|angle| angle.is_finite());
                all.then(|| UnitQuaternion::from_euler_angles(c, b, a))
            }
            // Backward they are the angles of KRL.
            (Self::Xyz, &[x, y, z]) => Some(Self::Abc.rotation_of(&[-z, -y, -x])?.inverse()),
            (Self::Axis, &[i, j, k]) => {
                let axis = Vector3::new(i, j, k);
                let is_unit = (axis.norm() - 1.0).abs() <= UNIT_TOLERANCE;
                let half_turn =
                    UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
                is_unit.then(|| {
                    UnitQuaternion::rotation_between(&Vector3::z(), &axis).unwrap_or(half_turn)
                })
            }
            (Self::RotationVector, &[x, y, z]) => {
                let vector = Vector3::new(x, y, z);
                (vector.norm() < FARTHEST_RAD).then(|| UnitQuaternion::from_scaled_axis(vector))
            }
            (Self::Unstated, &[]) => Some(UnitQuaternion::identity()),
            _ => None,
        }
    }

    /// The numbers of a rotation, of those that mean the same the nearest to `near`: signs of quaternions and turns of
    /// angles stay as they were written.
    #[must_use]
    pub fn numbers_of(self, rotation: &UnitQuaternion<f64>, near: &[f64]) -> Vec<f64> {
        match self {
            Self::Quaternion => {
                let q = rotation.quaternion();
                let numbers = [q.w, q.i, q.j, q.k];
                let dot: f64 = numbers.iter().zip(near).map(|(a, b)| a * b).sum();
                let sign = match dot < 0.0 {
                    true => -1.0,
                    false => 1.0,
                };
                numbers.map(|number| sign * number).to_vec()
            }
            Self::Abc => angles(rotation, &[at(near, 0), at(near, 1), at(near, 2)]).to_vec(),
            Self::Wpr => {
                let [a, b, c] = angles(rotation, &[at(near, 2), at(near, 1), at(near, 0)]);
                [c, b, a].map(within_half_a_turn).to_vec()
            }
            Self::Xyz => {
                let near = [-at(near, 2), -at(near, 1), -at(near, 0)];
                let [z, y, x] = angles(&rotation.inverse(), &near);
                vec![-x, -y, -z]
            }
            Self::Axis => (rotation * Unit::new_unchecked(Vector3::z()))
                .as_slice()
                .to_vec(),
            Self::RotationVector => rotation_vector(rotation, near).as_slice().to_vec(),
            Self::Unstated => Vec::new(),
        }
    }
}

/// The rotation vector that is the nearest to one of before, by whole turns about its axis.
fn rotation_vector(rotation: &UnitQuaternion<f64>, near: &[f64]) -> Vector3<f64> {
    let near = Vector3::new(at(near, 0), at(near, 1), at(near, 2));
    let vector = rotation.scaled_axis();
    let angle = vector.norm();
    // About no axis the one of before is as good.
    let axis = match angle < 1e-9 {
        true => near.try_normalize(1.0).unwrap_or_default(),
        false => vector / angle,
    };
    let turns = ((near.dot(&axis) - angle) / std::f64::consts::TAU).round();
    vector + axis * (std::f64::consts::TAU * turns)
}

fn at(numbers: &[f64], index: usize) -> f64 {
    numbers.get(index).copied().unwrap_or(0.0)
}

/// An angle in degrees from -180 to 180: FANUC controllers take no other.
fn within_half_a_turn(angle: f64) -> f64 {
    match angle.abs() > 180.0 {
        true => angle - 360.0 * (angle / 360.0).round(),
        false => angle,
    }
}

/// An angle in degrees turned whole turns next to another.
fn next_to(angle: f64, near: f64) -> f64 {
    angle + 360.0 * ((near - angle) / 360.0).round()
}

/// A, B, C of Rz(A) Ry(B) Rx(C) in degrees, of the two triples that mean the same the one nearer to `near`.
fn angles(rotation: &UnitQuaternion<f64>, near: &[f64; 3]) -> [f64; 3] {
    let m: Rotation3<f64> = rotation.to_rotation_matrix();
    let cos_b = m[(0, 0)].hypot(m[(1, 0)]);
    let b = (-m[(2, 0)]).atan2(cos_b);
    // Gimbal lock: only A - C or A + C is defined, and A keeps its value.
    let (a, c) = match cos_b < 1e-7 {
        true => {
            let a = near[0].to_radians();
            let along = Rotation3::from_euler_angles(0.0, b, a).inverse() * m;
            (a, along[(2, 1)].atan2(along[(1, 1)]))
        }
        false => (m[(1, 0)].atan2(m[(0, 0)]), m[(2, 1)].atan2(m[(2, 2)])),
    };
    let [a, b, c] = [a, b, c].map(f64::to_degrees);
    let near_to = |triple: [f64; 3]| {
        let turned = [0, 1, 2].map(|i| next_to(triple[i], near[i]));
        let away: f64 = (0..3).map(|i| (turned[i] - near[i]).abs()).sum();
        (turned, away)
    };
    let (first, second) = (
        near_to([a, b, c]),
        near_to([a + 180.0, 180.0 - b, c + 180.0]),
    );
    match second.1 < first.1 {
        true => second.0,
        false => first.0,
    }
}
