//! Poses as a table, one motion in a row: place, quaternion where the orientation is known, speed, whether it is a rapid.

use crate::making::numbers::{angles, coordinates, short};
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
        true => "qw,qx,qy,qz,speed_mm_per_s,rapid\n",
        false => "speed_mm_per_s,rapid\n",
    };
    for step in steps {
        match step {
            Step::Note(note) => text += &format!("# {note}\n"),
            Step::Tool(number) => text += &format!("# tool {number}\n"),
            Step::Action(_) => {}
            Step::Motion(motion) => {
                text += &coordinates(&motion.end, template).join(",");
                if let (true, Some(turn)) = (oriented, &motion.orientation) {
                    let numbers = angles(
                        turn,
                        OrientationText::Quaternion,
                        template.quaternion_decimals,
                    );
                    text += &format!(",{}", numbers.join(","));
                }
                let speed = short(motion.speed_mm_per_s, template.speed_decimals.unwrap_or(9));
                text += &format!(",{speed},{}\n", u8::from(motion.rapid));
            }
        }
    }
    vec![(format!("{name}.csv"), text.into_bytes())]
}
