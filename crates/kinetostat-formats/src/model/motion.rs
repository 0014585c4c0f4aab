//! One motion of a program.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::model::frame::FrameUse;
use crate::model::site::MotionSite;
use crate::model::target::Target;

/// On which way the tool goes to the end of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionKind {
    /// All joints in step: the way of the tool is the controller's.
    Joint,
    /// On a straight line.
    Linear,
    /// On a circle through a pose.
    Circular {
        /// Between start and end.
        via: Target,
    },
    /// On an arc about a stated centre, or a helix with an even rise: for languages that state centre and axis.
    Arc {
        /// In the axes of the work object, mm.
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
    /// Not known from the text.
    Unstated,
}

/// Execution count of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Runs {
    /// Once in every run of the program.
    Once,
    /// At most once: in a branch.
    OnCondition,
    /// More than once, or perhaps: in a loop, in a routine with a jump backward, or in one that is called more than once.
    Repeatedly,
    /// In a routine that nothing in these files calls.
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
    /// On which way.
    pub kind: MotionKind,
    /// End of the motion.
    pub target: Target,
    /// Speed of the motion.
    pub speed: Speed,
    /// Approximation zone at the end.
    pub zone: Zone,
    /// With which tool.
    pub tool: FrameUse,
    /// In the axes of which work object.
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
