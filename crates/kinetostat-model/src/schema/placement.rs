//! Poses and directions as a file writes them.

use std::fmt;

use kinetostat_diagnostic::wrong_length;
use schemars::JsonSchema;
use serde::de::{Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// A pose: at most one position and at most one orientation; what is left out is zero.
///
/// An orientation names its convention, since the same three angles mean a dozen different
/// rotations.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Translation, mm.
    pub translation_mm: Option<[f64; 3]>,
    /// Translation, m.
    pub translation_m: Option<[f64; 3]>,
    /// Position of the origin, mm.
    pub position_mm: Option<[f64; 3]>,
    /// Position of the origin, m.
    pub position_m: Option<[f64; 3]>,
    /// Rotation vector: direction of the axis times the angle, degrees.
    pub rotation_vector_deg: Option<[f64; 3]>,
    /// Rotation vector: direction of the axis times the angle, radians.
    pub rotation_vector_rad: Option<[f64; 3]>,
    /// Turns about x, then about the new y, then about the new z, degrees: Rx(a) Ry(b) Rz(c).
    pub rotation_intrinsic_xyz_deg: Option<[f64; 3]>,
    /// Roll, pitch, yaw as in URDF, degrees: Rz(yaw) Ry(pitch) Rx(roll).
    pub roll_pitch_yaw_urdf_deg: Option<[f64; 3]>,
    /// Roll, pitch, yaw as in URDF, radians: Rz(yaw) Ry(pitch) Rx(roll).
    pub roll_pitch_yaw_urdf_rad: Option<[f64; 3]>,
    /// A, B, C as on a KUKA controller, degrees: Rz(A) Ry(B) Rx(C).
    pub a_b_c_kuka_deg: Option<[f64; 3]>,
    /// W, P, R as on a FANUC controller, degrees: Rz(R) Ry(P) Rx(W).
    pub w_p_r_fanuc_deg: Option<[f64; 3]>,
    /// Quaternion with the scalar part first.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Quaternion with the scalar part last.
    pub quaternion_xyzw: Option<[f64; 4]>,
    /// Direction of the new x axis. Alone: the new y axis is horizontal (z cross x), or, where x is
    /// within 26 degrees of the vertical, y cross x.
    pub x_axis: Option<Axis>,
    /// Direction of the new y axis, square to `x_axis`.
    pub y_axis: Option<Axis>,
}

/// A direction: a letter or three numbers (any length but zero).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Axis {
    /// Along a coordinate axis.
    Named(AxisName),
    /// Three components.
    Vector([f64; 3]),
}

/// Written by hand for precise messages: the derived reader of alternatives reports only that none of them fits.
impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(AxisVisitor)
    }
}

struct AxisVisitor;

impl<'de> Visitor<'de> for AxisVisitor {
    type Value = Axis;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a direction such as \"x\", \"-z\" or [0, 0, 1]")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Axis, E> {
        AxisName::deserialize(word.into_deserializer()).map(Axis::Named)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Axis, A::Error> {
        let (mut axis, mut given) = ([0.0; 3], 0);
        while let Some(number) = list.next_element()? {
            if let Some(entry) = axis.get_mut(given) {
                *entry = number;
            }
            given += 1;
        }
        match given {
            3 => Ok(Axis::Vector(axis)),
            _ => Err(A::Error::custom(wrong_length(3, given))),
        }
    }
}

/// A coordinate axis and its sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum AxisName {
    /// Along x.
    #[serde(rename = "x")]
    X,
    /// Along y.
    #[serde(rename = "y")]
    Y,
    /// Along z.
    #[serde(rename = "z")]
    Z,
    /// Against x.
    #[serde(rename = "-x")]
    MinusX,
    /// Against y.
    #[serde(rename = "-y")]
    MinusY,
    /// Against z.
    #[serde(rename = "-z")]
    MinusZ,
}
