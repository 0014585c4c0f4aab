//! Programs in APT: places with the tool's axis, where that is not z everywhere.

use kinetostat_program::SpindleRotation;
use nalgebra::Vector3;

use crate::making::action::{Coolant, EventAction};
use crate::making::numbers::{coordinates, fixed, short};
use crate::making::step::Step;
use crate::making::template::Template;

/// Axes nearer to z than this are z.
const UPRIGHT: f64 = 1e-12;

/// The file of a program.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let mut motions = steps.iter().filter_map(Step::motion);
    let leans = motions.any(|motion| (motion.axis - Vector3::z()).norm() > UPRIGHT);
    let mut text = format!(
        "PARTNO/{}\n$$ {made_by}\nUNITS/MM\n",
        name.to_ascii_uppercase()
    );
    if leans {
        text += "MULTAX/ON\n";
    }
    let mut feed = String::new();
    for step in steps {
        match step {
            Step::Note(note) => text += &format!("$$ {note}\n"),
            Step::Tool(number) => text += &format!("LOADTL/{number}\n"),
            Step::Statement(statement) => text += &format!("{statement}\n"),
            Step::Action(action) => text += &action_text(*action),
            Step::Motion(motion) => {
                let per_minute = short(
                    60.0 * motion.speed_mm_per_s,
                    template.speed_decimals.unwrap_or(9),
                );
                let wanted = format!("FEDRAT/{per_minute},MMPM\n");
                if motion.rapid {
                    text += "RAPID\n";
                } else if wanted != feed {
                    text += &wanted;
                    feed = wanted;
                }
                text += &format!(
                    "GOTO/{}",
                    coordinates(&motion.end, template.position_decimals).join(",")
                );
                if leans {
                    let axis =
                        [0, 1, 2].map(|i| fixed(motion.axis[i], template.quaternion_decimals));
                    text += &format!(",{}", axis.join(","));
                }
                text.push('\n');
            }
        }
    }
    vec![(format!("{name}.apt"), (text + "FINI\n").into_bytes())]
}

fn action_text(action: EventAction) -> String {
    match action {
        EventAction::Wait { seconds } => format!("DELAY/{}\n", short(seconds, 6)),
        EventAction::Stop => "STOP\n".to_owned(),
        EventAction::OptionalStop => "OPSTOP\n".to_owned(),
        EventAction::Spindle { rotation, rpm } => {
            let sense = match rotation {
                SpindleRotation::Clockwise => "CLW",
                SpindleRotation::CounterClockwise => "CCLW",
                SpindleRotation::Stopped => return "SPINDL/OFF\n".to_owned(),
            };
            match rpm {
                Some(rpm) => format!("SPINDL/{},RPM,{sense}\n", short(rpm, 3)),
                None => format!("SPINDL/{sense}\n"),
            }
        }
        EventAction::Coolant(Coolant::Mist) => "COOLNT/MIST\n".to_owned(),
        EventAction::Coolant(Coolant::Flood) => "COOLNT/FLOOD\n".to_owned(),
        EventAction::Coolant(Coolant::Off) => "COOLNT/OFF\n".to_owned(),
    }
}
