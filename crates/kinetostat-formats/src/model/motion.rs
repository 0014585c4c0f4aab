//! One motion of a program, and the tools and work objects that it uses.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::model::site::MotionSite;
use crate::model::target::Target;

/// Path of the tool to the end of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionKind {
    /// All joints in step: the way of the tool is the controller's.
    Joint,
    /// Straight line.
    Linear,
    /// Circle through a pose.
    Circular {
        /// Auxiliary point between start and end.
        via: Target,
    },
    /// Arc about a stated centre, or a helix with an even rise: for languages that state centre and axis.
    Arc {
        /// Centre in the axes of the work object, mm.
        centre_mm: Vector3<f64>,
        /// Unit vector.
        axis: Vector3<f64>,
        /// Angle about the axis, right-handed, rad; a full turn if the start equals the end.
        angle_rad: f64,
    },
}

/// Approximation zone: distance to the end before the next motion begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// Exact stop (`fine`, `FINE`).
    Exact,
    /// Radius within which the tool may leave the path, mm.
    Radius(f64),
    /// Percent of what the controller allows (`CNT50`).
    Percent(f64),
    /// The text does not state the zone.
    Unstated,
}

/// Execution count of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Runs {
    /// Once in every run of the program.
    Once,
    /// The motion is in a branch: at most one execution.
    OnCondition,
    /// More than once, or perhaps: in a loop, in a routine with a jump backward, or in one that is called more than once.
    Repeatedly,
    /// The motion is in a routine that nothing in these files calls.
    Elsewhere,
}

/// The speed of a motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Speed {
    /// Speed of the tool centre point in mm/s, if the text states it.
    pub mm_per_s: Option<f64>,
    /// Speed as written.
    pub text: String,
}

/// One motion statement.
///
/// Poses are in the axes of the work object; [`Motion::base_pose`] gives those of the base.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// File, an index of [`crate::RobotProgram::files`].
    pub file: usize,
    /// Line of the file on which the statement begins, counted from 1.
    pub line: usize,
    /// Bytes of the statement with what ends it.
    pub span: Range<usize>,
    /// Path of the motion.
    pub kind: MotionKind,
    /// End of the motion.
    pub target: Target,
    /// Speed of the motion.
    pub speed: Speed,
    /// Approximation zone at the end.
    pub zone: Zone,
    /// Tool of the motion.
    pub tool: FrameUse,
    /// Work object in whose axes the target is.
    pub work_object: FrameUse,
    /// Execution count.
    pub runs: Runs,
    /// The motion (an index of [`crate::RobotProgram::motions`]) at whose end this one begins, at every run; none where
    /// that is not known from the text.
    pub follows: Option<usize>,
    pub(crate) site: MotionSite,
}

impl Motion {
    /// True if the text states the whole path: the end, and the auxiliary point of a circle.
    pub(crate) fn has_known_way(&self) -> bool {
        let via = match &self.kind {
            MotionKind::Circular { via } => via.pose().is_some(),
            MotionKind::Joint | MotionKind::Linear | MotionKind::Arc { .. } => true,
        };
        via && self.target.pose().is_some()
    }

    /// The pose of the tool at the end in the axes of the base, mm; none without a pose or a known work object.
    ///
    /// ```
    /// use kinetostat_formats::{ReadOptions, SourceFile, read_rapid};
    ///
    /// let text = "MODULE M\nPERS wobjdata table:=[FALSE,TRUE,\"\",[[0,0,100],[1,0,0,0]],[[5,0,0],[1,0,0,0]]];\n\
    ///     PROC main()\nMoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0\\WObj:=table;\n\
    ///     ENDPROC\nENDMODULE";
    /// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
    /// let pose = program.motions[0].base_pose().unwrap();
    /// assert_eq!(pose.translation.vector.as_slice(), [6.0, 2.0, 103.0]);
    /// ```
    #[must_use]
    pub fn base_pose(&self) -> Option<Isometry3<f64>> {
        Some(self.work_object.known()? * self.target.pose()?.isometry())
    }
}

/// Statements that ran several times say so at each of their motions.
pub(crate) fn mark_repeated(motions: &mut [Motion]) {
    let mut count: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for motion in motions.iter() {
        *count.entry((motion.file, motion.span.start)).or_default() += 1;
    }
    for motion in motions.iter_mut() {
        let runs = count.get(&(motion.file, motion.span.start));
        if runs.is_some_and(|runs| *runs > 1) && motion.runs < Runs::Repeatedly {
            motion.runs = Runs::Repeatedly;
        }
    }
}

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
