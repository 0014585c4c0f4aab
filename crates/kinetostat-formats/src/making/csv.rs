//! Poses as a table, one motion in a row: place, quaternion where the orientation is known, speed, the tool where there are several, whether it
//! is a rapid.

use std::collections::BTreeSet;

use crate::making::names::{angles, coordinates, short};
use crate::making::step::Step;
use crate::making::template::Template;
use crate::model::orientation::OrientationText;

/// The file of a program.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let oriented = steps
        .iter()
        .filter_map(Step::motion)
        .all(|motion| motion.orientation.is_some());
    let mut text = format!("# {made_by}\nx_mm,y_mm,z_mm,");
    text += match oriented {
        true => "qw,qx,qy,qz,speed_mm_per_s,",
        false => "speed_mm_per_s,",
    };
    let several = has_several_tools(steps);
    text += match several {
        true => "tool,rapid\n",
        false => "rapid\n",
    };
    let mut tool = String::new();
    for step in steps {
        match step {
            Step::Note(note) => text += &format!("# {note}\n"),
            Step::Tool(number) => {
                text += &format!("# tool {number}\n");
                if several {
                    tool = number.to_string();
                }
            }
            Step::Action(_) | Step::Statement(_) => {}
            Step::Motion(motion) => {
                text += &coordinates(&motion.end, template.position_decimals).join(",");
                if let (true, Some(turn)) = (oriented, &motion.orientation) {
                    let numbers = angles(
                        turn,
                        OrientationText::Quaternion,
                        template.quaternion_decimals,
                    );
                    text += &format!(",{}", numbers.join(","));
                }
                let speed = short(motion.speed_mm_per_s, template.speed_decimals.unwrap_or(9));
                text += &format!(",{speed},");
                if several {
                    text += &format!("{tool},");
                }
                text += &format!("{}\n", u8::from(motion.rapid));
            }
        }
    }
    vec![(format!("{name}.csv"), text.into_bytes())]
}

/// True if motions use several tools; rapids before the first change use the tool that is taken then.
fn has_several_tools(steps: &[Step]) -> bool {
    let mut tool = None;
    let mut all = BTreeSet::new();
    for step in steps {
        match step {
            Step::Tool(number) => tool = Some(*number),
            Step::Motion(motion) if tool.is_some() || !motion.rapid => {
                all.insert(tool);
            }
            _ => {}
        }
    }
    all.len() > 1
}
