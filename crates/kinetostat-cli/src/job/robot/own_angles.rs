//! Orientations as the controller of a robot shows them: what stands on a paper is compared with its pendant.

use kinetostat_formats::OrientationText;
use nalgebra::UnitQuaternion;

use crate::job::robot::read_program::RobotRead;
use crate::ui::numbers::fixed;

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
