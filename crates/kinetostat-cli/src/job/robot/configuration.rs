//! The configuration of the arm that a program states, beside that in which the model was solved.

use kinetostat_formats::{Language, StatedArm};
use kinetostat_machining::{
    ArmConfiguration, Elbow, PointResult, Shoulder, Warning, WarningCode, Wrist,
};

use crate::job::robot::joint_arm::ArmOfTable;
use crate::job::robot::read_program::RobotRead;
use crate::ui::numbers::fixed;

/// Distance to a singular posture, mm or deg, within which both sides are one.
const ON_NEITHER_SIDE: f64 = 0.1;

/// Remedy, with the program that was written, ...
const OF_PROGRAM: &str = "Give the model a home in the program's configuration, or run the parts with different configurations one by one";

/// ... and with one that is made.
const OF_MADE: &str = "State the configuration that was solved in the template (configuration), or give the model a home in the program's";

/// Posture that a program in a language would state: shoulder, elbow and wrist, each on one of two sides.
///
/// Behind axis 1 is the same for all makers, and so is the elbow: KUKA sets bit 1 where axis 3 bends the forearm down from the upper
/// arm (elbow up), ABB and FANUC say the other side (bit 1 of cfx: the wrist is behind the lower arm; D). The wrist of KUKA and ABB is the
/// sign of axis 5 as the controller shows it; without `[controller]`, and for FANUC, a wrist is flipped that bends to the other side than
/// at the model's home.
pub(crate) fn as_stated(
    language: Language,
    solved: &ArmConfiguration,
    axis_5_deg: Option<f64>,
) -> StatedArm {
    let beyond = |distance: f64| distance > ON_NEITHER_SIDE;
    let is_down = solved.elbow == Elbow::Down;
    let by_sign = axis_5_deg.filter(|_| language.wrist_is_sign_of_axis_5());
    let flips = by_sign.map_or(solved.wrist == Wrist::Flip, |angle| angle < 0.0);
    StatedArm {
        is_back: beyond(solved.shoulder_from_singular_mm)
            .then_some(solved.shoulder == Shoulder::Back),
        elbow: beyond(solved.elbow_from_singular_deg)
            .then_some(is_down != language.elbow_flag_is_up()),
        wrist: beyond(solved.wrist_from_singular_deg).then_some(flips),
    }
}

/// Displayed values of the controller at a place, deg: of a model with `[controller]`.
pub(crate) fn shown_by_controller(
    arm: Option<&ArmOfTable>,
    point: &PointResult,
) -> Option<Vec<f64>> {
    arm.filter(|arm| arm.has_controller())
        .and_then(|arm| shown(arm, point))
}

/// Joint values at a place, deg, as a program states them.
pub(crate) fn shown(arm: &ArmOfTable, point: &PointResult) -> Option<Vec<f64>> {
    let commands = <[f64; 6]>::try_from(point.actuator_command.as_slice()).ok()?;
    arm.shown_deg(&commands.map(f64::to_radians))
}

/// `(1.0, -20.3, ...)`.
pub(crate) fn joint_words(joints: &[f64]) -> String {
    let joints: Vec<String> = joints.iter().map(|joint| fixed(*joint, 1)).collect();
    format!("({})", joints.join(", "))
}

/// The first place where the model's arm bends otherwise than the program states: stiffness and joint values there are those of another
/// posture.
pub(crate) fn other_configuration(
    read: &RobotRead<'_>,
    arm: Option<&ArmOfTable>,
    points: &[PointResult],
) -> Option<Warning> {
    let (program, language) = (read.program, read.program.language);
    let made = read.settings.made_arm.as_ref();
    // The others of a made program state nothing: the arm takes what is near.
    let only_first = made.is_some() && language.may_take_near_configurations();
    if only_first && made.is_some_and(|made| !made.states_configuration) {
        return None;
    }
    let is_near = made.is_none() && language.takes_near_configurations(program);
    let is_last = |(index, point): &(usize, &PointResult)| {
        let next = points.get(index + 1);
        next.is_none_or(|next| next.move_index != point.move_index)
    };
    let mut last = points.iter().enumerate().filter(is_last);
    last.find_map(|(_, point)| {
        let motion = *read.path.motions.get(point.move_index)?;
        if only_first && point.move_index != points.first()?.move_index {
            return None;
        }
        let configuration = &program.motions.get(motion)?.target.pose()?.configuration;
        let mut stated = StatedArm::of(language, configuration);
        if is_near {
            (stated.elbow, stated.wrist) = (None, None);
        }
        let solved = point.configuration?;
        let shown_5 = shown_by_controller(arm, point).and_then(|shown| shown.get(4).copied());
        let own = as_stated(language, &solved, shown_5);
        let other = others(&stated, &own);
        (!other.is_empty()).then(|| {
            let what = of_parts(&other);
            let remedy = made.map_or(OF_PROGRAM, |_| OF_MADE);
            let joints = arm.and_then(|arm| shown(arm, point));
            let joints = joints.map_or_else(String::new, |joints| {
                format!(", with the joints at {} deg", joint_words(&joints))
            });
            let taken = match shown_5.is_some() || other == ["shoulder"] {
                true => "",
                false => " The model's joints are taken for those of the controller here, as the model has no [controller]: where its home is not in the configuration that the controller counts as not flipped, this may be said without need.",
            };
            Warning::at_line(
                WarningCode::OtherConfiguration,
                point.line,
                format!(
                    "the program states the configuration `{}`, and the model's arm is solved {solved}{joints}, which is another {what}: the results are those of the model's posture, not of the program's. {remedy}.{taken}",
                    configuration.text,
                ),
            )
        })
    })
}

/// Stated parts of the configuration that differ.
fn others(stated: &StatedArm, own: &StatedArm) -> Vec<&'static str> {
    let parts = [
        ("shoulder", stated.is_back, own.is_back),
        ("elbow", stated.elbow, own.elbow),
        ("wrist", stated.wrist, own.wrist),
    ];
    let differ = parts
        .iter()
        .filter(|(_, stated, own)| stated.zip(*own).is_some_and(|(stated, own)| stated != own));
    differ.map(|(name, ..)| *name).collect()
}

fn of_parts(parts: &[&str]) -> String {
    match parts {
        [first, others @ .., last] => {
            let before: Vec<&str> = [&[*first], others].concat();
            format!("{} and {last}", before.join(", "))
        }
        _ => parts.concat(),
    }
}
