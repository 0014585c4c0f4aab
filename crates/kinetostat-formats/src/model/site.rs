//! Positions in the text at which a motion can be corrected, and the arm whose joint values a table states: readers fill them in and the
//! writer uses them.
//!
//! One idea for all languages: numbers in place; a declaration, edited or copied under a free name; the literal arguments
//! of an offset; further statements before the one that is there.

use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use nalgebra::Isometry3;

use crate::model::orientation::OrientationText;
use crate::model::target::PoseTarget;
use crate::text::number::{NumberText, Width};

/// The numbers of a pose in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PoseText {
    /// An index of the program's files.
    pub file: usize,
    /// The whole literal, with configuration and external axes.
    pub whole: Range<usize>,
    /// X, Y, Z.
    pub position: [NumberText; 3],
    /// Length unit in mm.
    pub unit_mm: f64,
    /// Numbers of the orientation, in number and order of the convention.
    pub orientation: Vec<NumberText>,
    /// Convention of the orientation.
    pub convention: OrientationText,
    /// Replaceable numbers of the external axes, in the order of [`MotionSite::external`].
    pub external: Vec<Option<NumberText>>,
    /// Width policy of the numbers.
    pub width: Width,
}

/// The numbers of a pose that leaves some of them open: they are those of before (KRL).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PartialText {
    /// An index of the program's files.
    pub file: usize,
    /// The whole literal, with configuration and external axes.
    pub whole: Range<usize>,
    /// Position in the statement: the literal itself, or the name with which it is declared.
    pub place: Range<usize>,
    /// X, Y, Z, A, B, C.
    pub numbers: [Option<NumberText>; 6],
}

/// Joint values in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointsText {
    /// The whole row.
    pub whole: Range<usize>,
    /// Joint values in the order of the joints, with their unit in degrees or mm.
    pub numbers: Vec<(NumberText, f64)>,
    /// Arm of the joints.
    pub arm: TableArm,
}

impl JointsText {
    /// Joint values in degrees or mm.
    pub fn joints(&self) -> Vec<f64> {
        let numbers = self.numbers.iter();
        numbers.map(|(number, unit)| number.value * unit).collect()
    }
}

/// A declared pose.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Declaration {
    /// The whole statement with what ends it.
    pub statement: Range<usize>,
    /// Name without an index.
    pub name: Range<usize>,
    /// Numbers of the pose.
    pub text: PoseText,
    /// Value of the pose.
    pub pose: PoseTarget,
    /// Other users than the pose depend on it (offsets, assignments): its value must stay.
    pub keeps_value: bool,
    /// Form of a copied declaration.
    pub copy: DeclarationCopy,
}

/// Form in which a declaration is copied.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum DeclarationCopy {
    /// Copy of the statement, with another name and other numbers.
    Statement,
    /// Texts around its name and its pose: of an element of an array.
    #[allow(dead_code, reason = "read by the languages that have arrays")]
    Around {
        before: Vec<u8>,
        middle: Vec<u8>,
        after: Vec<u8>,
    },
}

/// Axes of the arguments of an offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OffsetAxes {
    /// Axes of the work object (`Offs`).
    WorkObject,
    /// Axes of the tool at the pose that is offset (`RelTool`, KRL's geometric sum).
    Tool,
}

/// A part of a target in a statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PartText {
    pub span: Range<usize>,
    /// Numbers of the part; empty if it is a name or computed.
    pub numbers: Vec<NumberText>,
}

/// An end that the statement has by names or computes: another one is written in place of its expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReplacedText {
    /// The expression.
    pub span: Range<usize>,
    /// Value of the expression.
    pub pose: PoseTarget,
    /// Position and orientation as separate parts, if the statement separates them.
    pub parts: Option<[PartText; 2]>,
}

/// Position of a target in the text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum TargetSite {
    /// A literal in the statement.
    Literal(PoseText),
    /// A name in the statement, an index of the program's declarations.
    Declared {
        declaration: usize,
        name: Range<usize>,
    },
    /// An offset from a pose by literals in the statement.
    Offset {
        /// The whole call.
        call: Range<usize>,
        arguments: Box<[NumberText; 3]>,
        axes: OffsetAxes,
        /// The pose that is offset.
        base: Box<PoseTarget>,
        /// A literal with the configuration and external axes of the end.
        literal: Box<PoseText>,
    },
    /// A literal that leaves something open, in the statement or declared.
    Partial(Box<PartialText>),
    /// An expression in the statement.
    Replaced(Box<ReplacedText>),
    /// Joint values in a row of a table.
    Joints(Box<JointsText>),
    /// Target that cannot be corrected, with the reason.
    Fixed(&'static str),
}

/// Position of the speed in the text, and the text around a replacement: `[`, the number, `,500,5000,1000]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpeedSite {
    pub span: Range<usize>,
    pub before: String,
    pub after: String,
    /// Unit of the number in mm/s.
    pub unit_mm_per_s: f64,
}

/// Positions of the parts of a motion statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionSite {
    /// The word that says on which way.
    pub keyword: Range<usize>,
    /// Position of the end, in the file of the statement.
    pub target_span: Range<usize>,
    pub target: TargetSite,
    /// Span and text of the pose on a circle.
    pub via: Option<(Range<usize>, TargetSite)>,
    /// Position of the speed; `None` if it cannot be replaced.
    pub speed: Option<SpeedSite>,
    /// Speeds of turning, deg/s, and of external axes, mm/s and deg/s, as in `500,5000,1000` (RAPID); none where they are not known.
    pub other_speeds: Option<String>,
    pub zone: Option<Range<usize>>,
    /// External axes at the end as the text states them, of poses and of joint values.
    pub external: Vec<Option<f64>>,
    /// Other statements may move external axes before the next motion.
    pub external_moved_behind: bool,
    /// Reason why the motion cannot be divided.
    pub indivisible: Option<&'static str>,
    /// Reason for an uneven rotation of the tool along the motion: it is refused if the tool turns.
    pub turns_otherwise: Option<TurnsOtherwise>,
}

impl MotionSite {
    /// A motion whose parts stand nowhere but for its word and its end.
    pub(crate) fn of(keyword: Range<usize>, target_span: Range<usize>, target: TargetSite) -> Self {
        Self {
            keyword,
            target_span,
            target,
            via: None,
            speed: None,
            other_speeds: None,
            zone: None,
            external: Vec::new(),
            external_moved_behind: false,
            indivisible: None,
            turns_otherwise: None,
        }
    }
}

/// Uneven rotation of the tool between the ends of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TurnsOtherwise {
    pub reason: &'static str,
    pub remedy: &'static str,
    /// The statement before the motion with which it does, where it may be written.
    pub evenly: Option<&'static str>,
}

/// Turns below this are none, rad.
pub(crate) const TURN_RAD: f64 = 1e-5;

/// Message on an uneven rotation by an angle; `turns` names its cause. `None` if the tool does not turn.
pub(crate) fn not_evenly(turns: &str, turn_rad: f64, otherwise: TurnsOtherwise) -> Option<String> {
    // NaN is no small turn.
    let is_none = turn_rad < TURN_RAD;
    (!is_none).then(|| {
        format!(
            "{turns} by {:.4} deg on its way, and {}",
            turn_rad.to_degrees(),
            otherwise.reason
        )
    })
}

/// Kinematic model of an arm: tool pose of joint values, and the inverse.
///
/// Joint values are in degrees, or mm of linear joints, in the order of the joints; poses are those of the tool in axes of the robot's
/// base, mm.
pub trait JointArm: Debug + Send + Sync {
    /// Number of joints.
    fn joint_count(&self) -> usize;

    /// The pose of the tool at as many joint values.
    fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64>;

    /// The joint values next to others that give a pose; none where there are none.
    fn joints_near(&self, tool: &Isometry3<f64>, near: &[f64]) -> Option<Vec<f64>>;
}

/// Interpolation by the controller from one row of a table of joint values to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BetweenRows {
    /// All joints in step: rows must stand so near to each other that the tool goes all but straight.
    Joint,
    /// The tool on a straight line.
    Linear,
}

/// The arm of a table of joint values, and how it moves between its rows.
///
/// ```
/// use std::sync::Arc;
/// use kinetostat_formats::*;
/// use nalgebra::{Isometry3, Vector3};
///
/// /// Two slides, x and y, that carry the tool.
/// #[derive(Debug)]
/// struct Slides;
/// impl JointArm for Slides {
///     fn joint_count(&self) -> usize {
///         2
///     }
///     fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64> {
///         Isometry3::translation(joints[0], joints[1], 0.0)
///     }
///     fn joints_near(&self, tool: &Isometry3<f64>, _near: &[f64]) -> Option<Vec<f64>> {
///         Some(vec![tool.translation.x, tool.translation.y])
///     }
/// }
///
/// let text = "joint_1_mm,joint_2_mm,note\n0,0,begin\n50,7.5,cut\n";
/// let mut options = ReadOptions::default();
/// options.arm = Some(TableArm { arm: Arc::new(Slides), between: BetweenRows::Linear });
/// let program = read_poses(vec![SourceFile::new("q.csv", text)], &options).unwrap();
/// assert_eq!(program.motions[1].target.pose().unwrap().position_mm.y, 7.5);
/// // What is written are joint values again.
/// let piece = Piece::to(1, Vector3::new(50.0, 7.6, 0.0));
/// let files = write(&program, &[piece], &WriteOptions::default()).unwrap();
/// assert_eq!(files[0].1, text.replace("7.5", "7.600000").as_bytes());
/// ```
#[derive(Debug, Clone)]
#[allow(
    clippy::exhaustive_structs,
    reason = "an arm, and what is between rows"
)]
pub struct TableArm {
    /// The arm.
    pub arm: Arc<dyn JointArm>,
    /// Interpolation between rows.
    pub between: BetweenRows,
}

impl PartialEq for TableArm {
    /// Identity of the arm: models of equal build are different.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.arm, &other.arm) && self.between == other.between
    }
}
