//! Joints and drives along a program: distance to limits, load by rating, configuration of an arm. Plain data, units in
//! the names.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::counted;

/// An end of a joint's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitEnd {
    /// The smallest command that is allowed.
    Lower,
    /// The largest one.
    Upper,
}

impl LimitEnd {
    /// `lower` or `upper`.
    ///
    /// ```
    /// assert_eq!(kinetostat_machining::LimitEnd::Lower.word(), "lower");
    /// ```
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        }
    }
}

/// The joint of a machine that is nearest to one of its limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct NearestLimit {
    /// Index, from 0, in the order of `question.actuators`.
    pub actuator: usize,
    /// End of its range.
    pub end: LimitEnd,
    /// Distance of its command to the limit, mm or deg; below zero outside.
    #[serde(rename = "distance_mm_or_deg")]
    pub distance: f64,
}

/// The drive of a machine that carries the largest share of its rating.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct MostLoaded {
    /// Index, from 0, in the order of `question.actuators`.
    pub actuator: usize,
    /// Force or torque by its rating; 1 is the rating.
    pub share_of_rating: f64,
}

/// Side of axis 1 on which an arm reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shoulder {
    /// The centre of the wrist is on the side of axis 1 on which axis 2 is (of an arm whose axis 2 crosses axis 1: on the side
    /// on which it is at the model's home).
    Front,
    /// The wrist is on the other side: the arm reaches over itself.
    Back,
}

/// Elbow flag of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Elbow {
    /// The elbow is above the line from axis 2 to the centre of the wrist when the arm reaches to the front.
    Up,
    /// The elbow is below that line.
    Down,
}

/// Side to which an arm bends its wrist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wrist {
    /// About axis 5 to the side to which it is bent at the model's home (of a wrist that is straight there: the positive one).
    NoFlip,
    /// The wrist bends to the other side.
    Flip,
}

/// Configuration, one of eight, of an arm of six axes with a wrist in one point, and its distance from changing it.
///
/// Between two of them every path that is not joint by joint passes a singular posture. The numbers are those of the geometry, not of
/// a controller: makers count them each in their own way.
///
/// ```
/// use kinetostat_machining::{ArmConfiguration, Elbow, Shoulder, Wrist};
///
/// let arm = ArmConfiguration::of(850.0, 70.0, -12.5).ok_or("not a number")?;
/// assert_eq!((arm.shoulder, arm.elbow, arm.wrist), (Shoulder::Front, Elbow::Up, Wrist::Flip));
/// assert_eq!((arm.number, arm.wrist_from_singular_deg), (4, 12.5));
/// assert_eq!(arm.to_string(), "front, elbow up, wrist flipped");
/// // A forearm that is folded back on the upper arm is as singular as one that is stretched.
/// assert_eq!(ArmConfiguration::of(850.0, -170.0, 30.0).ok_or("not a number")?.elbow_from_singular_deg, 10.0);
/// assert!(ArmConfiguration::of(f64::NAN, 70.0, -12.5).is_none());
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct ArmConfiguration {
    /// Side of axis 1 on which it reaches.
    pub shoulder: Shoulder,
    /// Elbow flag.
    pub elbow: Elbow,
    /// Side to which it bends its wrist.
    pub wrist: Wrist,
    /// 0 to 7: 1 for back, plus 2 for elbow down, plus 4 for a flipped wrist.
    pub number: u8,
    /// Distance of the centre of the wrist from the plane through axis 1 that axis 2 is parallel to, mm: at zero joint 1 cannot move the
    /// centre sideways out of the arm's plane.
    pub shoulder_from_singular_mm: f64,
    /// Angle of the forearm (to the centre of the wrist) from being in line with the upper arm, deg.
    pub elbow_from_singular_deg: f64,
    /// Angle of axis 6 from being in line with axis 4, deg.
    pub wrist_from_singular_deg: f64,
}

impl ArmConfiguration {
    /// The configuration of the signed distances of shoulder (mm, front is positive), elbow (deg, up is positive) and wrist (deg, not
    /// flipped is positive); `None` if one of them is no number.
    #[must_use]
    pub fn of(shoulder_mm: f64, elbow_deg: f64, wrist_deg: f64) -> Option<Self> {
        if ![shoulder_mm, elbow_deg, wrist_deg]
            .iter()
            .all(|value| value.is_finite())
        {
            return None;
        }
        let in_line = |angle: f64| angle.abs().min(180.0 - angle.abs());
        let (shoulder, back) = match shoulder_mm < 0.0 {
            true => (Shoulder::Back, 1),
            false => (Shoulder::Front, 0),
        };
        let (elbow, down) = match elbow_deg < 0.0 {
            true => (Elbow::Down, 2),
            false => (Elbow::Up, 0),
        };
        let (wrist, flip) = match wrist_deg < 0.0 {
            true => (Wrist::Flip, 4),
            false => (Wrist::NoFlip, 0),
        };
        Some(Self {
            shoulder,
            elbow,
            wrist,
            number: back + down + flip,
            shoulder_from_singular_mm: shoulder_mm.abs(),
            elbow_from_singular_deg: in_line(elbow_deg),
            wrist_from_singular_deg: in_line(wrist_deg),
        })
    }
}

impl fmt::Display for ArmConfiguration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shoulder = match self.shoulder {
            Shoulder::Front => "front",
            Shoulder::Back => "back",
        };
        let elbow = match self.elbow {
            Elbow::Up => "elbow up",
            Elbow::Down => "elbow down",
        };
        let wrist = match self.wrist {
            Wrist::NoFlip => "wrist not flipped",
            Wrist::Flip => "wrist flipped",
        };
        write!(f, "{shoulder}, {elbow}, {wrist}")
    }
}

/// Place at which a joint comes nearest to one of its limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct LimitPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Joint, end and distance.
    #[serde(flatten)]
    pub limit: NearestLimit,
}

/// Place of the largest share of a drive's rating.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct RatingPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Drive and share.
    #[serde(flatten)]
    pub drive: MostLoaded,
}

/// Two neighbouring places of a feed motion between which the arm changes its configuration, or turns a joint much farther than it turns
/// its tool: on the way it passes a singular posture, or stands beside one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct PostureChange {
    /// Line of the input program of the place before, from 1.
    pub line_before: usize,
    /// Line of the place behind.
    pub line: usize,
    /// The place behind, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Configuration before; `None` for machines that are no arms of six axes with a wrist in one point.
    pub before: Option<ArmConfiguration>,
    /// Configuration behind.
    pub after: Option<ArmConfiguration>,
    /// The joint that turns farthest between the two, from 0, in the order of `question.actuators`.
    pub actuator: usize,
    /// Angle by which it turns, deg.
    pub turn_deg: f64,
}

/// Remedy for an arm that cannot follow a program in one posture: a constant turn of the tool about its own axis (which does not matter
/// for a round tool) along the whole program. It is looked for in steps of 5 deg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct WayOut {
    /// The smallest turn, right-handed about z of the tool, with which every place that was looked at is reached inside all limits, in
    /// one configuration, and not near a singular posture; `None` if no turn does.
    pub turn_about_tool_axis_deg: Option<f64>,
    /// Places along the program that were looked at.
    pub places: usize,
}

impl WayOut {
    /// Remedy, in a sentence without a full stop.
    ///
    /// ```
    /// let mut way = kinetostat_machining::WayOut::default();
    /// assert!(way.description().starts_with("No turn of the tool"));
    /// way.turn_about_tool_axis_deg = Some(-35.0);
    /// assert!(way.description().starts_with("With the tool turned by -35 deg about its own axis"));
    /// ```
    #[must_use]
    pub fn description(&self) -> String {
        match self.turn_about_tool_axis_deg {
            Some(turn) => format!(
                "With the tool turned by {turn:.0} deg about its own axis along the whole program, which a round tool does not \
                 notice, the {} looked at are reached inside the limits in one configuration (turn tool_orientation; \
                 where the program states the orientation, turn the frame of its tool)",
                counted(self.places, "place")
            ),
            None => "No turn of the tool about its own axis in steps of 5 deg keeps limits and configuration along the whole \
                     program: move the part (part_origin_mm), or divide the program"
                .to_owned(),
        }
    }
}

/// Figures of joints and drives along a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct JointsResult {
    /// Smallest and largest joint value of every actuator on cutting moves (everywhere if none cuts), mm or deg.
    #[serde(rename = "ranges_mm_or_deg", default)]
    pub ranges: Vec<[f64; 2]>,
    /// Place at which a joint comes nearest to a limit; `None` if no joint has limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nearest_limit: Option<LimitPlace>,
    /// Place of the largest share of a drive's rating; `None` if the model states no rating.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_loaded: Option<RatingPlace>,
    /// The configuration at the first place that is cut; `None` for machines that are no arms of six axes with a wrist in one point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub configuration: Option<ArmConfiguration>,
    /// Changes of the posture in feed motions, in the order of the path, at most [`Self::MAX_CHANGES`].
    #[serde(default)]
    pub changes: Vec<PostureChange>,
    /// Number of changes in all.
    #[serde(default)]
    pub change_count: usize,
    /// Remedy against them; `None` if there are none, or if the orientation of the tool follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub way_out: Option<WayOut>,
}

impl JointsResult {
    /// Maximum number of changes that are listed.
    pub const MAX_CHANGES: usize = 20;

    /// The configuration along the program in words; `None` for machines that are no arms of six axes with a wrist in one point.
    ///
    /// ```
    /// use kinetostat_machining::{ArmConfiguration, JointsResult};
    ///
    /// let mut joints = JointsResult::default();
    /// assert_eq!(joints.configuration_text(), None);
    /// joints.configuration = ArmConfiguration::of(850.0, 70.0, 40.0);
    /// assert_eq!(joints.configuration_text().as_deref(), Some("front, elbow up, wrist not flipped"));
    /// ```
    #[must_use]
    pub fn configuration_text(&self) -> Option<String> {
        let first = self.configuration?;
        Some(match self.change_count {
            0 => first.to_string(),
            count => format!("{first}; it does not stay so ({})", counted(count, "place")),
        })
    }
}
