//! Force laws of cutting, and where along a program they act.

use kinetostat::{Mechanism, Pose, Wrench};
use kinetostat_program::Path;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::cut::profile::ForceOrigin;

/// Axes of a constant wrench.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadAxes {
    /// Axes of the machine's base.
    Base,
    /// Axes of the (nominal) tool frame.
    Tool,
    /// x along the feed, z along the part frame's z, y to the left.
    Feed,
}

/// A force law on feed moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CuttingLoad {
    /// No cutting force.
    None,
    /// Constant wrench at the tool's tip, N and N m.
    Constant {
        /// Axes of its components.
        axes: LoadAxes,
        /// Force and moment about the tool's tip.
        wrench: Wrench,
    },
    /// Radial, tangential and axial force of milling, N.
    Milling {
        /// Force to the right of the feed.
        radial: f64,
        /// Force along the feed.
        tangential: f64,
        /// Force along the part frame's z; along the tool, away from the part, if the program turns the tool.
        axial: f64,
    },
    /// Computed from the cut or measured, another at every place: see [`crate::ForceAlongPath`].
    FromCut {
        /// Origin of the force, computed or measured.
        #[serde(default)]
        origin: ForceOrigin,
        /// The one with the largest force, N and N m, x along the feed, z along the part frame's z, y to the left.
        largest: Wrench,
    },
}

/// Load while the written program steps at a sharp corner, or where a cut begins.
///
/// A step is written so that the tool stays at its place on the part while the load turns. That holds
/// only if the load turns as evenly as the step is made. The bytes written are the same for both readings:
/// no program can correct a load that turns at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CornerLoad {
    /// The load turns uniformly from the one before to the one after while the tool steps.
    #[default]
    Turns,
    /// The load follows the feed: on a step it is that of a cut along the step. A load that does not turn with the
    /// feed is already that after the step.
    FollowsFeed,
}

impl CornerLoad {
    /// The reading that this one is not.
    pub(crate) fn other(self) -> Self {
        match self {
            Self::Turns => Self::FollowsFeed,
            Self::FollowsFeed => Self::Turns,
        }
    }
}

/// The load of a program: a law of force, where it acts, and how it turns at corners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProgramLoad {
    /// Force law.
    pub cutting: CuttingLoad,
    /// Acts only where the program's z is below this, mm; `None`: wherever the program feeds.
    pub below_z_mm: Option<f64>,
    /// Corners that turn by at most this are gentle, rad. Default 30 degrees.
    pub gentle_corner: f64,
    /// Length over which the load turns before and after a gentle corner, mm. Default 2.
    pub turning_length_mm: f64,
    /// Largest change of the correction outside sharp corners, mm per mm of path: the load comes and goes accordingly, in the air
    /// before and after a cut. Default 0.5.
    #[serde(default = "largest_step")]
    pub largest_step: f64,
    /// Load on the steps written at sharp corners. Default [`CornerLoad::Turns`].
    #[serde(default)]
    pub at_corners: CornerLoad,
    /// True if that was stated, and is no assumption. Default false.
    #[serde(default)]
    pub corners_stated: bool,
}

fn largest_step() -> f64 {
    0.5
}

impl ProgramLoad {
    /// The load is fixed in the tool and turns with it.
    pub(crate) fn in_tool_axes(&self) -> bool {
        matches!(
            self.cutting,
            CuttingLoad::Constant {
                axes: LoadAxes::Tool,
                ..
            }
        )
    }

    /// This law on all feed moves.
    #[must_use]
    pub fn new(cutting: CuttingLoad) -> Self {
        Self {
            cutting,
            below_z_mm: None,
            gentle_corner: 30_f64.to_radians(),
            turning_length_mm: 2.0,
            largest_step: largest_step(),
            at_corners: CornerLoad::Turns,
            corners_stated: false,
        }
    }

    pub(crate) fn description(&self) -> String {
        let text = match self.cutting {
            CuttingLoad::None => return "no cutting load".into(),
            CuttingLoad::Constant { axes, wrench } => {
                let (f, m) = (wrench.force(), wrench.moment());
                let axes = match axes {
                    LoadAxes::Base => "base",
                    LoadAxes::Tool => "tool",
                    LoadAxes::Feed => "feed",
                };
                format!(
                    "force ({}, {}, {}) N and moment ({}, {}, {}) N m at the tool's tip in {axes} axes, on feed moves",
                    f.x, f.y, f.z, m.x, m.y, m.z
                )
            }
            CuttingLoad::Milling {
                radial,
                tangential,
                axial,
            } => format!(
                "milling: {radial} N to the right of the feed, {tangential} N along it, {axial} N along z, on feed moves"
            ),
            CuttingLoad::FromCut { origin, largest } => {
                let f = largest.force();
                let origin = match origin {
                    ForceOrigin::Computed => "computed from the cut",
                    ForceOrigin::Measured => "measured along the program",
                };
                format!(
                    "{origin}; at most {:.1} N ({:.1} along the feed, {:.1} to the left, {:.1} along z)",
                    f.norm(),
                    f.x,
                    f.y,
                    f.z
                )
            }
        };
        match self.below_z_mm {
            Some(z) => format!("{text}, only below Z {z} mm"),
            None => text,
        }
    }

    /// True if its direction depends on the motion of the tool.
    ///
    /// ```
    /// use kinetostat_machining::{CuttingLoad, ProgramLoad};
    ///
    /// let milling = CuttingLoad::Milling { radial: 300.0, tangential: -100.0, axial: -50.0 };
    /// assert!(ProgramLoad::new(milling).turns());
    /// assert!(!ProgramLoad::new(CuttingLoad::None).turns());
    /// ```
    #[must_use]
    pub fn turns(&self) -> bool {
        matches!(
            self.cutting,
            CuttingLoad::Milling { .. }
                | CuttingLoad::FromCut { .. }
                | CuttingLoad::Constant {
                    axes: LoadAxes::Feed,
                    ..
                }
        )
    }
}

/// A tool of the machine's magazine.
///
/// The tool is a part of the machine: its length is in the mechanism, whose platform's reference point is
/// the tool's tip ([`Mechanism::with_tool`]).
#[derive(Clone, Copy, Debug)]
pub struct Tool<'a> {
    /// Number in the program's T words.
    pub number: u32,
    /// Machine with this tool.
    pub mechanism: &'a Mechanism,
    /// Load on this tool.
    pub load: ProgramLoad,
}

/// The tool that the block on a line is made with; `None` where the program names none of these.
pub(crate) fn tool_on<'t, 'a>(
    tools: &'t [Tool<'a>],
    path: &Path,
    line: usize,
) -> Option<&'t Tool<'a>> {
    if tools.is_empty() {
        return None;
    }
    let number = path.tool_on(line)?;
    tools.iter().find(|tool| tool.number == number)
}

/// Turns a tool given by its length along z of the flange into a pose, platform from tool, m.
#[must_use]
pub fn straight_tool(length: f64) -> Pose {
    Pose::translation(0.0, 0.0, length)
}
