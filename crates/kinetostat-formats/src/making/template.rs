//! Data of the target cell of a made program, as the caller states them.

use std::collections::BTreeMap;

use kinetostat_program::SpindleRotation;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::making::names::short;

/// A base or a tool as the controller knows it, and where it is.
///
/// Without a pose the controller's own one of that number or name is used, whatever it is there.
///
/// ```
/// use kinetostat_formats::StatedFrame;
/// use nalgebra::Isometry3;
///
/// let base = StatedFrame { number: Some(3), pose: Some(Isometry3::translation(800.0, 0.0, 400.0)), ..StatedFrame::default() };
/// assert_eq!(base.name, None);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StatedFrame {
    /// Frame number (`BASE_DATA[3]`, `UF : 3`); default 1.
    pub number: Option<u32>,
    /// Frame name (RAPID).
    pub name: Option<String>,
    /// A base in the axes of the robot's base, a tool in those of the flange; mm.
    pub pose: Option<Isometry3<f64>>,
    /// Object frame in axes of the user frame (RAPID), mm, as part of the pose of a base; by default the pose is all user frame.
    pub object_frame: Option<Isometry3<f64>>,
}

/// A tool with its load, which RAPID declares together.
///
/// ```
/// assert_eq!(kinetostat_formats::StatedTool::default().mass_kg, None);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StatedTool {
    /// Number, name and tip.
    pub frame: StatedFrame,
    /// Mass in kg; default 1.
    pub mass_kg: Option<f64>,
    /// Centre of mass in axes of the flange, mm.
    pub centre_of_mass_mm: Option<Vector3<f64>>,
    /// Turns the axes of the flange into those of its moments of inertia.
    pub axes_of_moment: Option<UnitQuaternion<f64>>,
    /// Moments of inertia about those axes through the centre of mass, kg m^2.
    pub inertia_kg_m2: Option<Vector3<f64>>,
}

/// Statements by which the cell starts and stops its spindle, in the language of the made program; `{rpm}` stands for the speed.
///
/// Robots have no words for a spindle: where none of these is stated, S, M3 and M4 of the source become notes.
///
/// ```
/// assert!(kinetostat_formats::SpindleStatements::default().stop.is_empty());
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SpindleStatements {
    /// Statements for M3, one a line.
    pub clockwise: Vec<String>,
    /// Statements for M4.
    pub counter_clockwise: Vec<String>,
    /// Statements for M5.
    pub stop: Vec<String>,
}

impl SpindleStatements {
    /// The lines for a rotation at a speed; `None` where the cell states none, or where they need a speed that is not known.
    #[must_use]
    pub fn lines(&self, rotation: SpindleRotation, rpm: Option<f64>) -> Option<Vec<String>> {
        let lines = match rotation {
            SpindleRotation::Clockwise => &self.clockwise,
            SpindleRotation::CounterClockwise => &self.counter_clockwise,
            SpindleRotation::Stopped => &self.stop,
        };
        let needs_speed = lines.iter().any(|line| line.contains(RPM));
        if lines.is_empty() || (needs_speed && rpm.is_none()) {
            return None;
        }
        let rpm = short(rpm.unwrap_or(0.0), 3);
        Some(lines.iter().map(|line| line.replace(RPM, &rpm)).collect())
    }

    /// True if starting the spindle leaves out the speed of the source: a cell with one speed, or a forgotten `{rpm}`.
    pub(crate) fn leaves_out_speed(&self) -> bool {
        let starts = [&self.clockwise[..], &self.counter_clockwise].concat();
        !starts.is_empty() && !starts.iter().any(|line| line.contains(RPM))
    }
}

/// The place of the speed in a statement of the spindle.
const RPM: &str = "{rpm}";

/// Output form of rapids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rapids {
    /// Straight motions at the rapid speed: the way is that of the source. Joint motions of a robot that take the arm to another
    /// configuration stay joint motions in the same language.
    #[default]
    Linear,
    /// Joint motions: faster, on a way that is the controller's.
    Joint,
}

/// Treatment of moves to machine positions (G28, G53) and to joint values, which have no position in the part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlacesUnknown {
    /// They are refused by line between moves; before the first and behind the last place that is known they are left out.
    #[default]
    Refused,
    /// They are left out everywhere: the tool goes straight from the place before to the one behind.
    LeftOut,
}

/// Approximation distances at the ends of motions that others follow.
///
/// ```
/// let zones = kinetostat_formats::Zones::default();
/// assert_eq!((zones.rapids_mm, zones.feeds_mm), (1.0, 0.3));
/// assert_eq!((zones.rapids_percent, zones.feeds_percent), (50.0, 20.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zones {
    /// Distance for rapids, mm; 0 is an exact stop. KRL: `$APO.CDIS`; RAPID: the path zone.
    pub rapids_mm: f64,
    /// Distance for motions at feed, mm.
    pub feeds_mm: f64,
    /// Percentage for rapids on controllers that use one (FANUC: `CNT50`, KRL: `$APO.CPTP` of joint motions); 0 is an exact stop.
    pub rapids_percent: f64,
    /// Percentage for motions at feed.
    pub feeds_percent: f64,
}

impl Default for Zones {
    fn default() -> Self {
        Self {
            rapids_mm: 1.0,
            feeds_mm: 0.3,
            rapids_percent: 50.0,
            feeds_percent: 20.0,
        }
    }
}

/// Settings of a made program: names, frames, speeds, zones, digits.
///
/// ```
/// use kinetostat_formats::{Rapids, Template};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let mut template = Template::default();
/// assert_eq!((template.rapids, template.rapid_speed_mm_per_s), (Rapids::Linear, 200.0));
/// assert_eq!((template.position_decimals, template.tolerance_mm), (6, 0.001));
/// // The tool's z points down, as is usual at ABB and FANUC.
/// template.tool_orientation = Some(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Template {
    /// Name of the program, and of its file.
    pub program_name: String,
    /// Frame in whose axes the positions are: the part.
    pub base: StatedFrame,
    /// The tool of a program with one tool.
    pub tool: StatedTool,
    /// Tools by the numbers of the source, of a program with several.
    pub tools: BTreeMap<u32, StatedTool>,
    /// Statements that start and stop the spindle.
    pub spindle: SpindleStatements,
    /// Turns the part's axes into the tool's, for moves that state no orientation.
    pub tool_orientation: Option<UnitQuaternion<f64>>,
    /// Output form of rapids.
    pub rapids: Rapids,
    /// Speed of straight rapids, mm/s.
    pub rapid_speed_mm_per_s: f64,
    /// Speed of joint motions, percent of the largest.
    pub joint_speed_percent: f64,
    /// Speed of motions at feed whose source states none, mm/s; they are refused without it.
    pub unstated_feed_mm_per_s: Option<f64>,
    /// Acceleration along the path, m/s^2, where the language states one.
    pub acceleration_m_per_s2: Option<f64>,
    /// Rounding of corners.
    pub zones: Zones,
    /// Arm configuration at the first pose (KRL: `S 2, T 35`; FANUC: `N U T, 0, 0, 0`; RAPID: `[0,-1,0,0]`).
    pub configuration: Option<String>,
    /// Initial joint values, degrees.
    pub start_joints_deg: Option<Vec<f64>>,
    /// Treatment of moves without a position in the part.
    pub places_unknown: PlacesUnknown,
    /// Decimals of lengths in mm.
    pub position_decimals: usize,
    /// Decimals of angles in degrees.
    pub angle_decimals: usize,
    /// Decimals of parts of quaternions and directions.
    pub quaternion_decimals: usize,
    /// Limit of the decimals of speeds in mm/s (or mm/min, if the language uses it); default: that of the language.
    pub speed_decimals: Option<usize>,
    /// Limit of the positions in a file; default: that of the language.
    pub most_points: Option<usize>,
    /// Chord error of lines that replace unsupported curves, mm.
    pub tolerance_mm: f64,
}

impl Default for Template {
    fn default() -> Self {
        Self {
            program_name: "part".to_owned(),
            base: StatedFrame::default(),
            tool: StatedTool::default(),
            tools: BTreeMap::new(),
            spindle: SpindleStatements::default(),
            tool_orientation: None,
            rapids: Rapids::Linear,
            rapid_speed_mm_per_s: 200.0,
            joint_speed_percent: 10.0,
            unstated_feed_mm_per_s: None,
            acceleration_m_per_s2: None,
            zones: Zones::default(),
            configuration: None,
            start_joints_deg: None,
            places_unknown: PlacesUnknown::Refused,
            position_decimals: 6,
            angle_decimals: 8,
            quaternion_decimals: 10,
            speed_decimals: None,
            most_points: None,
            tolerance_mm: 0.001,
        }
    }
}
