//! Programmable frames: TRANS, ATRANS, ROT, AROT.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// A statement of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// TRANS: instead of all before.
    Shift,
    /// ATRANS: in the axes in force.
    FurtherShift,
    /// ROT: instead of all before.
    Turn,
    /// AROT: in the axes in force.
    FurtherTurn,
    /// SCALE or MIRROR without values: all before is taken back.
    Reset,
}

impl Change {
    /// Frame statement of a word in capitals.
    pub(crate) fn of(word: &str) -> Option<Self> {
        Some(match word {
            "TRANS" => Self::Shift,
            "ATRANS" => Self::FurtherShift,
            "ROT" => Self::Turn,
            "AROT" => Self::FurtherTurn,
            "SCALE" | "MIRROR" => Self::Reset,
            _ => return None,
        })
    }

    /// The frame in force behind it: `values` along or about X, Y, Z in mm or degrees, `in_plane` the angle of RPL about the
    /// axis across the plane.
    ///
    /// Several angles are RPY, the setting of machine data 10600 that controls come with: about Z, then the new Y, then the new X.
    pub(crate) fn applied(
        self,
        frame: &Isometry3<f64>,
        values: [f64; 3],
        in_plane: Option<f64>,
        normal: usize,
    ) -> Isometry3<f64> {
        let shift = || {
            let by = Translation3::from(Vector3::from(values));
            Isometry3::from_parts(by, UnitQuaternion::identity())
        };
        let turn = || {
            let mut angles = values.map(f64::to_radians);
            if let Some(angle) = in_plane {
                angles = [0.0; 3];
                angles[normal] = angle.to_radians();
            }
            let turn = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
            Isometry3::from_parts(Translation3::identity(), turn)
        };
        match self {
            Self::Shift => shift(),
            Self::FurtherShift => frame * shift(),
            Self::Turn => turn(),
            Self::FurtherTurn => frame * turn(),
            Self::Reset => Isometry3::identity(),
        }
    }
}
