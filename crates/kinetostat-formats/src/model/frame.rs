//! Tools and work objects: what a motion uses, as far as the text or the caller says what it is, and the payload of a tool.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Pose of a tool or a work object.
#[derive(Debug, Clone, PartialEq)]
pub enum Frame {
    /// A tool in the flange's axes, a work object in the axes of the base (or the world, where the controller says so); mm.
    Known(Isometry3<f64>),
    /// Frame that neither the text nor the caller states.
    Unknown {
        /// Reason in words.
        reason: String,
    },
}

/// A tool or a work object that a motion uses.
///
/// ```
/// use kinetostat_formats::{Frame, FrameUse};
/// use nalgebra::Isometry3;
///
/// let tool = FrameUse { name: "tool0".into(), frame: Frame::Known(Isometry3::identity()) };
/// assert_eq!(tool.known(), Some(&Isometry3::identity()));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FrameUse {
    /// Name or number in the program.
    pub name: String,
    /// Pose of the frame.
    pub frame: Frame,
}

impl FrameUse {
    /// A frame of which its text says the name alone (`of`: "the file", "the program"), as the caller states it.
    pub(crate) fn stated(name: &str, frame: Option<&Isometry3<f64>>, of: &str) -> Self {
        let unknown = || Frame::Unknown {
            reason: format!("{of} does not say it; state it under [robot.frames]"),
        };
        Self {
            name: name.to_owned(),
            frame: frame.map_or_else(unknown, |frame| Frame::Known(*frame)),
        }
    }

    /// Pose of the frame, if known.
    #[must_use]
    pub fn known(&self) -> Option<&Isometry3<f64>> {
        match &self.frame {
            Frame::Known(isometry) => Some(isometry),
            Frame::Unknown { .. } => None,
        }
    }
}

/// The load of a tool: `loaddata` of RAPID, `LOAD` of KRL.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ToolLoad {
    pub mass_kg: f64,
    /// Centre of mass in axes of the flange, mm.
    pub centre_of_mass_mm: Vector3<f64>,
    /// Turns the axes of the flange into those of the moments of inertia.
    pub axes_of_moment: UnitQuaternion<f64>,
    /// Moments of inertia about those axes through the centre of mass, kg m^2.
    pub inertia_kg_m2: Vector3<f64>,
}
