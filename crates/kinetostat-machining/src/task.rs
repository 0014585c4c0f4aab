//! The task of a run, and why it may have no answer.

use kinetostat::{Directions, Error, Mechanism, MotionKind, Pose, number};
use kinetostat_program::{MachineProgram, Path, WriteError, WriteOptions};
use nalgebra::Vector3;

use crate::cut::profile::ForceAlongPath;
use crate::limits::{Beyond, Limits};
use crate::load::law::{ProgramLoad, Tool, tool_on};
use crate::placement::Placement;
use crate::result::joints::WayOut;
use crate::result::run_result::RunInputs;
use crate::weight_correction::WeightCorrection;

/// Everything that decides a run.
#[derive(Clone)]
pub struct Task<'a> {
    /// Machine with its tool: the platform's reference point is the tool's tip.
    pub mechanism: &'a Mechanism,
    /// The program as read.
    pub program: &'a dyn MachineProgram,
    /// Corrected directions of the tool's pose: its position, and the orientation if the program states it.
    pub corrected: Directions,
    /// Placement of the program.
    pub placement: Placement,
    /// Load on the tool.
    pub load: ProgramLoad,
    /// Tools that the program takes by number, each with its own machine and load; empty where there is
    /// one tool. `mechanism` and `load` are those of blocks without one of these.
    pub tools: &'a [Tool<'a>],
    /// Share of the displacement by the machine's own weight that counts as an error.
    pub weight: WeightCorrection,
    /// Forces of the cut, for loads that are [`crate::CuttingLoad::FromCut`].
    pub cut: Option<&'a ForceAlongPath>,
    /// Options for writing the compensated program.
    pub writing: WriteOptions,
    /// Names and words for the result; figures are filled in by the run.
    pub run_inputs: RunInputs,
    /// References for its figures.
    pub bounds: Bounds,
    /// About how many places [`crate::Run::places`] hands on; 0 where nobody asks for them.
    pub places: usize,
    /// Each of them has the compliance of the tool's tip, which takes an equilibrium more.
    pub compliances: bool,
}

impl<'a> Task<'a> {
    /// The motion of the program.
    #[must_use]
    pub fn path(&self) -> &'a Path {
        self.program.path()
    }

    /// Machine with the tool that the block on a line is made with.
    pub(crate) fn mechanism_on(&self, line: usize) -> &'a Mechanism {
        tool_on(self.tools, self.path(), line).map_or(self.mechanism, |tool| tool.mechanism)
    }

    /// Load on the tool of the block on a line.
    pub(crate) fn load_on(&self, line: usize) -> &ProgramLoad {
        tool_on(self.tools, self.path(), line).map_or(&self.load, |tool| &tool.load)
    }
}

/// Reason for which a program has no motion that could need a correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMotion {
    /// No block moves.
    #[error("the program has no motion")]
    NoMoves,
    /// Axes are never stated, and no feed motion states the others.
    #[error(
        "the program has no motion whose place is known: state X, Y and Z before the first cut, or give the start position"
    )]
    UnknownPlace,
    /// The tool is positioned, and nothing is cut.
    #[error("the program has no feed motion, and no rapid motion between two different places")]
    NoFeed,
    /// All feed motion ends where it begins.
    #[error("the feed motion of the program has no length")]
    NoLength,
}

/// Reason for which a run has no answer.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The program cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// A point has no answer.
    #[error("line {line}: at X{:.4} Y{:.4} Z{:.4} mm: {message}", position_mm[0], position_mm[1], position_mm[2])]
    Point {
        /// Line of the program, from 1.
        line: usize,
        /// Program coordinates, mm.
        position_mm: [f64; 3],
        /// Error and remedy.
        message: String,
        /// The core's error.
        cause: Box<Error>,
    },
    /// The written program would be worse somewhere.
    #[error(
        "line {line}: compensated, this block would end {} off, more than the {} without compensation; nothing was written. Tighten the path tolerance, allow more decimals, or report this with the job",
        number::against(*after_mm, *before_mm).0, number::against(*after_mm, *before_mm).1
    )]
    Worse {
        /// Line of the program, from 1.
        line: usize,
        /// Error without compensation, mm.
        before_mm: f64,
        /// Error with compensation, mm.
        after_mm: f64,
    },
    /// Own weight moves the tool, and nobody stated whether that is an error.
    #[error(
        "the machine's own weight moves the tool by up to {} along this program, and nothing says how the part was measured, so that it is not known whether that is to be corrected; state weight under [load] in the job, or --weight: \"touch-off\" if this machine touched the part off (touch_off_mm, --touch-off X Y Z: where), so that only the change of the sag from there is corrected, \"all\" if the part was measured without this machine, \"none\" if the controller corrects the weight", number::largest_length(*displacement_mm)
    )]
    WeightNotStated {
        /// Largest displacement found, mm.
        displacement_mm: f64,
    },
    /// The machine has no answer where it touched the part off.
    #[error(
        "the place where the part was touched off, X{:.4} Y{:.4} Z{:.4} mm: {cause}; give it in coordinates of the program (touch_off_mm under [load], --touch-off X Y Z)", position_mm[0], position_mm[1], position_mm[2]
    )]
    TouchOff {
        /// Program coordinates, mm.
        position_mm: [f64; 3],
        /// The core's error.
        cause: Box<Error>,
    },
    /// Figures that no sensible question has.
    #[error("{}; nothing was written", in_lines(.0))]
    BeyondLimits(Vec<Beyond>),
    /// The machine would jump to another shape.
    #[error(
        "line {line}: at X{:.4} Y{:.4} Z{:.4} mm the machine is not stable under this load: it would jump to another shape; nothing was written. Reduce the load, move the part, or stiffen the machine; `kinetostat deflect` shows the rest of the path", position_mm[0], position_mm[1], position_mm[2]
    )]
    Unstable {
        /// Line of the program, from 1.
        line: usize,
        /// Program coordinates, mm.
        position_mm: [f64; 3],
    },
    /// The orientation that follows is not continuous.
    #[error(
        "line {line}: the orientation of the tool jumps here: the machine would have to change its branch, or passes close to a singular posture; nothing was written. Move the part, or give an orientation to keep near to (`kinetostat deflect` shows how far the tool turns)"
    )]
    Jump {
        /// Line of the program, from 1.
        line: usize,
    },
    /// A program that is verified does not go where its original goes.
    #[error(
        "line {line}: at X{:.4} Y{:.4} Z{:.4} mm {}; it can be verified only against the program that it was made from, in the same part frame",
        position_mm[0], position_mm[1], position_mm[2], elsewhere(*distance_mm)
    )]
    Elsewhere {
        /// Line of the program that is verified, from 1.
        line: usize,
        /// Program coordinates, mm.
        position_mm: [f64; 3],
        /// Distance of the compensated original from there, mm; `None` if that comes by, but in another order.
        distance_mm: Option<f64>,
    },
    /// The program has no motion on which a correction could be needed.
    #[error("{0}")]
    NoMotion(NoMotion),
    /// An arm cannot take a place, and a turn of its tool was looked for with which it can.
    #[error("{error}. {}", way_out.description())]
    ArmStops {
        /// The error at the place.
        error: Box<RunError>,
        /// The turn, if there is one.
        way_out: WayOut,
    },
    /// Stopped on request.
    #[error("stopped on request; nothing was written")]
    Cancelled,
}

/// Largest distance of a program that is where the original is, mm.
const SAME_PLACE_MM: f64 = 0.001;

fn elsewhere(distance_mm: Option<f64>) -> String {
    match distance_mm {
        Some(mm) if mm < SAME_PLACE_MM => {
            "the program comes by once more, or in another order than the original".to_owned()
        }
        Some(mm) => format!(
            "the program is {} away from where the original, compensated, would be",
            number::largest_length(mm)
        ),
        None => "the program comes by in another order than the original".to_owned(),
    }
}

fn in_lines(list: &[Beyond]) -> String {
    let lines: Vec<String> = list.iter().map(Beyond::to_string).collect();
    lines.join("\n")
}

impl RunError {
    /// Wrong input (exit code 1) or a question that has no answer (2).
    #[must_use]
    pub fn is_unanswered(&self) -> bool {
        match self {
            Self::Point { cause, .. } | Self::TouchOff { cause, .. } => cause.is_unanswered(),
            Self::ArmStops { error, .. } => error.is_unanswered(),
            Self::Write(WriteError::Field { .. })
            | Self::Worse { .. }
            | Self::Unstable { .. }
            | Self::Jump { .. } => true,
            _ => false,
        }
    }
}

pub(crate) fn kinds(mechanism: &Mechanism) -> impl Iterator<Item = MotionKind> + '_ {
    mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
}

/// References with which the figures of a run are compared.
#[derive(Clone, Debug, Default)]
pub struct Bounds {
    /// Limits beyond which a program is refused.
    pub limits: Limits,
    /// Largest force (N) or torque (N m) of every drive, in the order of the actuators; empty where
    /// no rating is known.
    pub ratings: Vec<Option<f64>>,
    /// The tools as they were given; empty where the platform's own point is the tool by construction.
    pub tools: Vec<ToolGiven>,
    /// Line and radius (mm) of the widest zone at a corner at feed, where a program states zones.
    pub widest_zone: Option<(usize, f64)>,
    /// True if nobody stated the placement of the part.
    pub is_unplaced: bool,
    /// Workspace of the machine without its tool: smallest and largest coordinates, base axes, m.
    pub workspace: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// A tool as a question states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolGiven {
    /// Number of the tool, if the question numbers its tools.
    pub number: Option<u32>,
    /// Flange from tip, m.
    pub pose: Pose,
    /// True if the question states a tool.
    pub stated: bool,
}

impl ToolGiven {
    /// Length along z of the flange if it points there, else the distance of the tip, mm.
    pub(crate) fn length_mm(&self) -> f64 {
        let tip = self.pose.translation.vector * 1e3;
        if tip.xy().norm() <= 1e-9 {
            tip.z
        } else {
            tip.norm()
        }
    }
}
