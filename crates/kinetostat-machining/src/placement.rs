//! Placement of the program in the machine: part frame, tool, scale.

use kinetostat::Pose;
use kinetostat_program::Move;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Places a program of positions (mm, part frame) into the base of the machine (m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// Base from part frame, m.
    pub base_from_part: Pose,
    /// Orientation of the tool frame at every point of a program that does not state it, base from tool.
    pub tool_orientation: UnitQuaternion<f64>,
    /// The machine turns its tool as it moves: at every point it takes the orientation nearest to
    /// `tool_orientation` that it can have there, instead of that one.
    #[serde(default)]
    pub orientation_follows: bool,
    /// Length in the machine per length in the program: 1 for real work; other values try a
    /// program of another size.
    pub scale: f64,
}

impl Placement {
    /// Part frame and tool axes parallel to the base, program origin at `origin` (m).
    #[must_use]
    pub fn at(origin: Vector3<f64>) -> Self {
        Self {
            base_from_part: Pose::from_parts(origin.into(), UnitQuaternion::identity()),
            tool_orientation: UnitQuaternion::identity(),
            orientation_follows: false,
            scale: 1.0,
        }
    }

    /// Placement at a share of a move: as it is, or turned with the table that carries the part.
    #[must_use]
    pub fn on(&self, motion: &Move, share: f64) -> Self {
        self.turned(motion.part_turn(share).as_ref())
    }

    /// Placement after a motion of the part from there (in the axes of the part there, mm).
    #[must_use]
    pub fn turned(&self, part: Option<&Isometry3<f64>>) -> Self {
        let Some(part) = part else {
            return *self;
        };
        let way = part.translation.vector * self.metres();
        Self {
            base_from_part: self.base_from_part * Pose::from_parts(way.into(), part.rotation),
            ..*self
        }
    }

    /// Metres in the machine per millimetre of the program.
    fn metres(&self) -> f64 {
        1e-3 * self.scale
    }

    /// A displacement in the program (mm, part frame) as one in the machine (m, base axes).
    #[must_use]
    pub fn to_metres(&self, displacement_mm: &Vector3<f64>) -> Vector3<f64> {
        self.base_from_part.rotation * displacement_mm * self.metres()
    }

    /// Pose of the tool at a point of a program of positions (mm); where the orientation follows, the one that
    /// it is kept near to.
    #[must_use]
    pub fn tool_pose(&self, position_mm: &Vector3<f64>) -> Pose {
        self.pose(position_mm, self.tool_orientation)
    }

    /// Orientation of the tool at a share of a move, base from tool: that of the program, or where it states none
    /// [`Self::tool_orientation`].
    #[must_use]
    pub fn orientation_on(&self, motion: &Move, share: f64) -> UnitQuaternion<f64> {
        self.on(motion, share)
            .orientation_of(motion.orientation(share))
    }

    /// Orientation in base axes of one in axes of the part.
    #[must_use]
    pub fn orientation_of(&self, in_part: Option<UnitQuaternion<f64>>) -> UnitQuaternion<f64> {
        in_part.map_or(self.tool_orientation, |o| self.base_from_part.rotation * o)
    }

    /// Pose of the tool at a point of the program (mm) with an orientation (base from tool).
    #[must_use]
    pub fn pose(&self, position_mm: &Vector3<f64>, orientation: UnitQuaternion<f64>) -> Pose {
        let point = self.base_from_part * nalgebra::Point3::from(position_mm * self.metres());
        Pose::from_parts(point.coords.into(), orientation)
    }

    /// A displacement in the machine (m, base axes) as a displacement in the program (mm).
    #[must_use]
    pub fn to_program(&self, displacement: &Vector3<f64>) -> Vector3<f64> {
        self.base_from_part.rotation.inverse() * displacement / self.metres()
    }

    /// A vector of the part frame in base axes, length unchanged.
    #[must_use]
    pub fn to_base_axes(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.base_from_part.rotation * vector
    }

    /// The inverse of [`Self::to_base_axes`].
    #[must_use]
    pub fn to_part_axes(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.base_from_part.rotation.inverse() * vector
    }
}
