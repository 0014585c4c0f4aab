//! G-code of three axes, for programs whose tool stands along z of the part.

use kinetostat_program::SpindleRotation;
use nalgebra::Vector3;

use crate::making::MakeError;
use crate::making::events::{Coolant, EventAction};
use crate::making::names::{coordinates, fixed, short};
use crate::making::step::{Step, Way};
use crate::making::template::Template;

/// Farthest that the tool's axis may be from z, rad.
const UPRIGHT: f64 = 1e-6;

/// Every line at which the tool does not stand along z.
pub(crate) fn faults(steps: &[Step]) -> Vec<MakeError> {
    let motions = steps.iter().filter_map(Step::motion);
    let leaning = motions.filter(|motion| (motion.axis - Vector3::z()).norm() > UPRIGHT);
    let mut lines: Vec<usize> = leaning.map(|motion| motion.line).collect();
    lines.dedup();
    let fault = |line: usize| {
        MakeError::at(
            line,
            "the tool's axis is not z of the part here, and G-code of three axes has no other",
            "write the program for a robot, or as a table of poses (--to csv)",
        )
    };
    lines.into_iter().map(fault).collect()
}

/// The file of a program.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let mut text = format!("({made_by})\nG21 G90 G17 G94 G40 G54\n");
    let mut feed = String::new();
    let mut before = Vector3::zeros();
    for step in steps {
        match step {
            Step::Note(note) => text += &format!("({note})\n"),
            Step::Tool(number) => text += &format!("T{number} M6\n"),
            Step::Statement(statement) => text += &format!("{statement}\n"),
            Step::Action(action) => text += &action_text(*action),
            Step::Motion(motion) => {
                let [x, y, z] = coordinates(&motion.end, template.position_decimals);
                let word = match motion.way {
                    _ if motion.rapid => "G0",
                    Way::AboutZ {
                        clockwise: true, ..
                    } => "G2",
                    Way::AboutZ {
                        clockwise: false, ..
                    } => "G3",
                    _ => "G1",
                };
                text += &format!("{word} X{x} Y{y} Z{z}");
                if let Way::AboutZ { centre, .. } = motion.way {
                    let arm = centre - before;
                    let [i, j] = [0, 1].map(|axis| fixed(arm[axis], template.position_decimals));
                    text += &format!(" I{i} J{j}");
                }
                let wanted = short(
                    60.0 * motion.speed_mm_per_s,
                    template.speed_decimals.unwrap_or(9),
                );
                if !motion.rapid && wanted != feed {
                    text += &format!(" F{wanted}");
                    feed = wanted;
                }
                text.push('\n');
                before = motion.end;
            }
        }
    }
    vec![(format!("{name}.ngc"), (text + "M2\n").into_bytes())]
}

fn action_text(action: EventAction) -> String {
    match action {
        // Seconds with X are seconds, or unknown to the controller; with P they would be milliseconds on some.
        EventAction::Wait { seconds } => format!("G4 X{}\n", with_point(&short(seconds, 6))),
        EventAction::Stop => "M0\n".to_owned(),
        EventAction::OptionalStop => "M1\n".to_owned(),
        EventAction::Spindle { rotation, rpm } => {
            let word = match rotation {
                SpindleRotation::Clockwise => "M3",
                SpindleRotation::CounterClockwise => "M4",
                SpindleRotation::Stopped => return "M5\n".to_owned(),
            };
            match rpm {
                Some(rpm) => format!("S{} {word}\n", short(rpm, 3)),
                None => format!("{word}\n"),
            }
        }
        EventAction::Coolant(Coolant::Mist) => "M7\n".to_owned(),
        EventAction::Coolant(Coolant::Flood) => "M8\n".to_owned(),
        EventAction::Coolant(Coolant::Off) => "M9\n".to_owned(),
    }
}

/// Adds a decimal point: without it, some controllers count in their least unit.
fn with_point(number: &str) -> String {
    match number.contains('.') {
        true => number.to_owned(),
        false => format!("{number}.0"),
    }
}
