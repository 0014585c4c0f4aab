//! Options of the caller for reading and writing.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Isometry3;

use crate::model::site::TableArm;
use crate::model::stated_value::{SlashBlocks, StatedValue};

/// Treatment of a motion with an unknown end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnknownTargets {
    /// The motion is refused with its line.
    #[default]
    Refused,
    /// The motion stays as it is written: [`crate::Target::Unknown`], with a finding.
    LeftAsWritten,
}

/// Treatment of external axes that move from one target to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExternalAxes {
    /// The program is refused at the first line where they move: the arm stands elsewhere then.
    #[default]
    Refused,
    /// They are carried as written, and shared out evenly over the pieces of a motion that is divided: the caller knows what they move
    /// ([`crate::PoseTarget::external`]).
    Carried,
}

/// Treatment of a path with cutter radius compensation on the controller (APT: `CUTCOM`, `TLCOMP`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CutterCompensation {
    /// The path is refused with its line.
    #[default]
    Refused,
    /// The places are those of the tool's centre: the controller's radius is zero, or only the wear.
    CentrePath,
}

/// Length unit of a list of poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// mm.
    Millimetre,
    /// m.
    Metre,
}

impl StatedValue {
    /// The value that a text states.
    ///
    /// ```
    /// use kinetostat_formats::StatedValue;
    ///
    /// assert_eq!(StatedValue::of("1.5"), StatedValue::Number(1.5));
    /// assert_eq!(StatedValue::of("true"), StatedValue::Truth(true));
    /// assert_eq!(StatedValue::of("rough"), StatedValue::Text("rough".into()));
    /// ```
    #[must_use]
    pub fn of(text: &str) -> Self {
        let number = text.parse().ok().filter(|value: &f64| value.is_finite());
        match (number, text.to_ascii_uppercase().as_str()) {
            (Some(number), _) => Self::Number(number),
            (None, "TRUE") => Self::Truth(true),
            (None, "FALSE") => Self::Truth(false),
            (None, _) => Self::Text(text.to_owned()),
        }
    }
}

/// Options with which a program is read.
///
/// ```
/// use kinetostat_formats::{ExternalAxes, ReadOptions, UnknownTargets};
/// use nalgebra::Isometry3;
///
/// let mut options = ReadOptions::default();
/// options.unknown_targets = UnknownTargets::LeftAsWritten;
/// options.external_axes = ExternalAxes::Carried;
/// // Names count without case where the language takes them so.
/// options.frames.insert("tSpindle".into(), Isometry3::translation(0.0, 0.0, 180.0));
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Tools (in the flange's axes) and work objects (in the robot's base axes, or the world's where its controller says
    /// so) by name, in mm: they stand in for what the program says or does not say.
    pub frames: BTreeMap<String, Isometry3<f64>>,
    /// Values of names that only the controller knows: signals, inputs, registers, and the first values of variables.
    pub values: BTreeMap<String, StatedValue>,
    /// Motions to ends that are not known from the text.
    pub unknown_targets: UnknownTargets,
    /// External axes that move.
    pub external_axes: ExternalAxes,
    /// Paths that the controller moves aside.
    pub cutter_compensation: CutterCompensation,
    /// Blocks of SINUMERIK behind a slash.
    pub slash_blocks: SlashBlocks,
    /// Unit of the lengths of a list of poses that does not state it; none where it must.
    pub length_unit: Option<LengthUnit>,
    /// Letters of the machine's rotary axes whose words are followed (SINUMERIK under `TRAORI`, Heidenhain with `M128`): those of
    /// [`crate::PathOptions::rotary`], in their order. Words of other axes that turn are refused.
    pub rotary_axes: Vec<char>,
    /// The arm of a table of joint values; without it such values are read, and not corrected.
    pub arm: Option<TableArm>,
    /// Names of what the program calls, none of its files holds, and moves the tool: such calls are refused with their lines. Others are
    /// taken to leave the tool where it is, and speed, tool and frame in force, with a finding.
    pub moving_calls: BTreeSet<String>,
}

impl ReadOptions {
    /// Options that leave all that is not followed as written: for an internal first read without a report.
    pub(crate) fn as_written(&self) -> Self {
        Self {
            unknown_targets: UnknownTargets::LeftAsWritten,
            cutter_compensation: CutterCompensation::CentrePath,
            ..self.clone()
        }
    }
}

/// Options with which a program is written.
///
/// ```
/// let mut options = kinetostat_formats::WriteOptions::default();
/// assert_eq!((options.position_decimals, options.quaternion_decimals), (3, 7));
/// options.position_decimals = 4;
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct WriteOptions {
    /// Minimum decimals of a changed length in mm, 3: half a micrometre along each axis. A number that had more keeps them.
    pub position_decimals: usize,
    /// Minimum decimals of a changed component of a quaternion, 7: two tenths of a microradian.
    pub quaternion_decimals: usize,
    /// Minimum decimals of a changed angle in degrees, 5.
    pub angle_decimals: usize,
    /// Limit of the bytes of a changed line, without its line ending, if the controller or its loader has one.
    pub max_line_bytes: Option<usize>,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            position_decimals: 3,
            quaternion_decimals: 7,
            angle_decimals: 5,
            max_line_bytes: None,
        }
    }
}
