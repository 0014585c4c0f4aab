//! Tool and work object that a robot's program states, for the machine of a run.

use kinetostat::Pose;
use kinetostat_formats::{FrameUse, OrientationText, tool_number};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::job::robot::read_program::RobotRead;
use crate::ui::numbers::fixed;

/// Tool and work object as the program states them.
#[derive(Clone, Debug)]
pub(crate) struct RobotFrames {
    /// Number and name of every tool, and where it is in the flange, m.
    pub(crate) tools: Vec<(u32, String, Option<Pose>)>,
    /// Name of the work object in whose axes the path is, and where it is in the robot's base, m; `None`: the path is in axes of
    /// the base.
    pub(crate) work_object: Option<(String, Option<Pose>)>,
    /// Direction from the tool's tip to its holder, in axes of the tool.
    pub(crate) tool_axis: Vector3<f64>,
    /// True if that axis is a default, and the language has no convention for it.
    pub(crate) axis_is_open: bool,
    /// The program states how the tool stands.
    pub(crate) states_orientation: bool,
    /// Orientation of the tool in the program, in the angles of its controller.
    pub(crate) own_angles: Option<OwnAngles>,
    /// True for a converted program: it already contains the job's data on part and tool.
    pub(crate) converted: bool,
}

impl RobotFrames {
    pub(crate) fn of(read: &RobotRead<'_>) -> Self {
        let named = |frame: &FrameUse| (frame.name.clone(), frame.known().map(in_metres));
        Self {
            tools: (read.path.tools.iter().enumerate())
                .map(|(index, tool)| {
                    let (name, pose) = named(tool);
                    (tool_number(&read.path.tools, index), name, pose)
                })
                .collect(),
            work_object: read.path.work_object.as_ref().map(named),
            tool_axis: read.path.path.tool_axis,
            axis_is_open: read.axis_is_open(),
            states_orientation: (read.path.path.moves.iter())
                .any(|motion| motion.tool_turn.is_some()),
            own_angles: OwnAngles::of(read),
            converted: false,
        }
    }
}

pub(crate) fn in_metres(frame: &Isometry3<f64>) -> Pose {
    Pose::from_parts((1e-3 * frame.translation.vector).into(), frame.rotation)
}

/// The numbers by which a controller states orientations, and how its tool stands where the program first cuts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OwnAngles {
    text: OrientationText,
    /// Line, and the axes of the tool's frame in those of the path.
    first: Option<(usize, UnitQuaternion<f64>)>,
}

impl OwnAngles {
    /// Returns the angles of a program in the language of a robot; others have none of their own.
    pub(crate) fn of(read: &RobotRead<'_>) -> Option<Self> {
        let text = read.program.language.orientation_of_controller()?;
        let mut feeds = read.path.path.moves.iter().filter(|m| m.is_known_feed());
        let first = feeds.find_map(|m| Some((m.line, m.tool_turn.as_ref()?.start)));
        Some(Self { text, first })
    }

    /// An orientation, as in `A 30, B 0, C 0 deg`.
    pub(crate) fn words(&self, turn: &UnitQuaternion<f64>) -> String {
        let numbers = self.text.numbers_of(turn, &[0.0; 4]);
        let is_angle = self.text != OrientationText::Quaternion;
        let shown = |number: &f64| match fixed(*number, 4) {
            // A zero has no sign, and half a turn is that of the pendant.
            zero if zero == "-0.0000" => "0.0000".to_owned(),
            half if is_angle && half == "-180.0000" => "180.0000".to_owned(),
            other => other,
        };
        let shown: Vec<String> = numbers.iter().map(shown).collect();
        match (self.text, shown.as_slice()) {
            (OrientationText::Quaternion, _) => format!("quaternion [{}]", shown.join(", ")),
            (OrientationText::Wpr, [w, p, r]) => format!("W {w}, P {p}, R {r} deg"),
            (_, [a, b, c]) => format!("A {a}, B {b}, C {c} deg"),
            _ => shown.join(", "),
        }
    }

    /// Orientation of the tool at the first cut; none if the program does not state it.
    pub(crate) fn standing(&self) -> Option<String> {
        let (line, turn) = self.first.as_ref()?;
        Some(format!(
            "{} in the axes of the program, where it first cuts (line {line})",
            self.words(turn)
        ))
    }
}
