//! The posture in which the model's arm comes to the first place of a program that was converted, in words: its language does not say
//! it, or not all of it.

use kinetostat_machining::{ArmConfiguration, PointResult, Warning, WarningCode};

use crate::job::robot::configuration::{as_stated, joint_words, shown, shown_by_controller};
use crate::job::robot::joint_arm::ArmOfTable;
use crate::job::robot::read_program::RobotRead;

/// A joint that is farther than this from where it starts is on another turn, deg.
const HALF_A_TURN: f64 = 180.0;

/// Reports the configuration that was solved, and whether the arm comes to it from stated joints.
pub(crate) fn of_first_place(
    read: &RobotRead<'_>,
    arm: Option<&ArmOfTable>,
    points: &[PointResult],
) -> Vec<Warning> {
    let (Some(made), Some(arm), Some(point)) = (&read.settings.made_arm, arm, points.first())
    else {
        return Vec::new();
    };
    let (Some(solved), Some(joints)) = (point.configuration, shown(arm, point)) else {
        return Vec::new();
    };
    let counted = match arm.has_controller() {
        true => "as the controller shows them ([controller] of the model)",
        false => {
            "as the model counts them, which has no [controller]: zeros and directions of the controller's axes may be others"
        }
    };
    let language = read.program.language;
    let axis_5 = shown_by_controller(Some(arm), point).and_then(|shown| shown.get(4).copied());
    let words = language.words_of_arm(&as_stated(language, &solved, axis_5));
    let text = words.map_or_else(String::new, |words| format!(" ({words})"));
    let mut found = vec![Warning::at_line(
        WarningCode::OtherConfiguration,
        point.line,
        format!(
            "the arm was solved in the configuration {solved}{text}; at its first place its joints are {} deg, {counted}. The results are those of this posture: before the program starts, bring the arm into it, or state it in the template (configuration, start_joints_deg)",
            joint_words(&joints)
        ),
    )];
    if let Some(start) = &made.start_joints_deg {
        let other = otherwise(arm, start, &solved, &joints);
        found.extend(other.map(|other| {
            let joints: Vec<String> = joints.iter().map(|joint| format!("{joint:.2}")).collect();
            Warning::at_line(
                WarningCode::OtherConfiguration,
                point.line,
                format!(
                    "the program begins at start_joints_deg {} of the template, {}: the results are not those of the arm that comes from there. start_joints_deg = [{}] begins in the posture that was solved{}. Joints are taken {counted}",
                    joint_words(start),
                    other.what,
                    joints.join(", "),
                    other.helps,
                ),
            )
        }));
    }
    found
}

/// Difference of the start, and a remedy other than another start.
struct Otherwise {
    what: String,
    helps: &'static str,
}

/// Compares the solved configuration with that at the start joints of the program.
fn otherwise(
    arm: &ArmOfTable,
    start: &[f64],
    solved: &ArmConfiguration,
    joints: &[f64],
) -> Option<Otherwise> {
    let of_start = arm.configuration_at(start)?;
    if of_start.number != solved.number {
        return Some(Otherwise {
            what: format!("where the arm is {of_start}, and the run solved it {solved}"),
            helps: "; or give the model a home in the configuration of the start",
        });
    }
    let far = start.iter().zip(joints).enumerate();
    let mut far = far.filter(|(_, (start, joint))| (*start - *joint).abs() > HALF_A_TURN);
    let (axis, (start, joint)) = far.next()?;
    Some(Otherwise {
        what: format!(
            "where joint {} is at {start:.1} deg, and the run solved it at {joint:.1} deg, more than half a turn away",
            axis + 1
        ),
        helps: "",
    })
}
