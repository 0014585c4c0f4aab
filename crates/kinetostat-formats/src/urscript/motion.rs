//! Motions: their ends, with the frames in which they are stated, their speeds and their blends; the treatment of each word.

use std::ops::Range;

use nalgebra::Isometry3;

use crate::interpreter::calls::argument;
use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::{self, Reason};
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Speed, Zone};
use crate::model::program::ACCELERATION;
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::Target;
use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows, sorted};
use crate::urscript::grammar::FORM;

/// A run of a URScript program.
pub(super) type Run<'r, 'p> = run::Run<'r, 'p, UrScript>;

/// Modal state.
pub(crate) struct UrScript {
    pub tool: FrameUse,
    /// Tools that the program has in numbers.
    pub tools: Vec<Frame>,
}

/// Expressions of the end of a motion.
pub(super) struct End<'e> {
    /// `pose_trans(frame, pose)`: a feature of the pendant, or a frame of the program.
    pub frame: Option<&'e Expression>,
    pub pose: &'e Expression,
    /// `get_inverse_kin(pose, near)`: the joints of a pose next to others.
    pub others: Vec<&'e Expression>,
}

impl<'e> End<'e> {
    pub(super) fn of(expression: &'e Expression) -> Self {
        let mut end = Self {
            frame: None,
            pose: expression,
            others: Vec::new(),
        };
        // A call with further arguments states the pose of another tool.
        if let Some(given) = expression.given_to("GET_INVERSE_KIN", &["X", "QNEAR"])
            && let [pose, others @ ..] = given.as_slice()
        {
            (end.pose, end.others) = (pose, others.to_vec());
        }
        let given = end.pose.given_to("POSE_TRANS", &["P_FROM", "P_FROM_TO"]);
        if let Some([frame, pose]) = given.as_deref() {
            (end.frame, end.pose) = (Some(*frame), pose);
        }
        end
    }
}

impl Run<'_, '_> {
    /// The motion of a statement, or why it is refused.
    pub(super) fn motion_of(
        &mut self,
        tokens: &Range<usize>,
        arguments: &[Argument],
    ) -> Result<Motion, Reason> {
        let file = self.file();
        let no_motion = || ("it is no motion".to_owned(), FORM.remedy);
        let row = motion_row(file.word(tokens.start)).ok_or_else(no_motion)?;
        let given = |name: &str| argument(row.parameters, arguments, name);
        for value in ["A", "V", "T", "R"].into_iter().filter_map(given) {
            let found = self.value(value);
            if found.unknown_reason().is_none() && found.as_number().is_none() {
                let reason = format!("`{}` is no number", file.text(&value.tokens));
                return Err((
                    reason,
                    "write acceleration, speed, time and radius as numbers",
                ));
            }
        }
        let values = arguments.iter().filter_map(|own| own.value.as_ref());
        if let Some(odd) = values.into_iter().find(|own| own.node == Node::Unreadable) {
            let reason = format!("`{}` is no expression", file.text(&odd.tokens));
            return Err((reason, FORM.remedy));
        }
        let last = row.parameters[row.ends - 1];
        let is_missing = || (format!("{} needs {last}", row.name), FORM.remedy);
        let end = given(last).ok_or_else(is_missing)?;
        let (target, target_site, work_object) = self.end(row, end)?;
        let keyword = file.span(&(tokens.start..tokens.start + 1));
        let mut site = MotionSite::of(keyword, file.span(&End::of(end).pose.tokens), target_site);
        let kind = match (row.name, row.ends) {
            ("movej", _) => MotionKind::Joint,
            (_, 1) => MotionKind::Linear,
            _ => {
                let first = given(row.parameters[0]).ok_or_else(is_missing)?;
                let (via, via_site, frame) = self.end(row, first)?;
                let mode = given("MODE").map_or(Some(0.0), |mode| self.value(mode).as_number());
                if mode != Some(0.0) {
                    let reason = "on the circle the tool turns with the path (mode=1), or its mode is not known";
                    let remedy =
                        "write mode=0 with the orientation that the tool is to have at the end";
                    return Err((reason.to_owned(), remedy));
                }
                if frame != work_object {
                    let reason = "the place on the circle and its end are in two frames";
                    return Err((reason.to_owned(), "write both in one frame"));
                }
                let whole = file.span(&first.tokens).start..file.span(&end.tokens).start;
                site.via = Some((whole, via_site));
                MotionKind::Circular { via }
            }
        };
        let time = given("T").map(|time| self.value(time).as_number());
        let is_timed = time.is_some_and(|time| time != Some(0.0));
        site.indivisible = is_timed.then_some("its time is stated, not its speed");
        site.zone = given("R").map(|blend| file.span(&blend.tokens));
        let frames = [self.own.tool.clone(), work_object];
        let mut motion = self.made_motion(tokens, kind, target, site, frames);
        (motion.speed, motion.site.speed) = self.speed(row, given("V"), is_timed, tokens);
        let blend = given("R").map_or(Some(0.0), |blend| self.value(blend).as_number());
        motion.zone = match blend {
            Some(0.0) => Zone::Exact,
            blend => blend.map_or(Zone::Unstated, |radius| Zone::Radius(1e3 * radius)),
        };
        // The manual's defaults, in m/s2 and rad/s2.
        let usual = if row.name == "movej" { 1.4 } else { 1.2 };
        let stated = given("A").map(|own| self.value(own).as_number());
        let acceleration = match stated.unwrap_or(Some(usual)) {
            Some(number) => number.to_string(),
            None => given("A").map_or_else(String::new, |own| file.text(&own.tokens)),
        };
        self.say_beside(tokens, format!("{ACCELERATION} {acceleration}"));
        if let (true, Some(time), MotionKind::Linear) = (is_timed, time.flatten(), &motion.kind) {
            motion.speed.mm_per_s = self.way_mm(&motion).map(|way| way / time);
        }
        Ok(motion)
    }

    /// The speed, and where it stands or may stand; a time takes its place.
    fn speed(
        &mut self,
        row: &MotionRow,
        stated: Option<&Expression>,
        is_timed: bool,
        tokens: &Range<usize>,
    ) -> (Speed, Option<SpeedSite>) {
        // The manual's default; joints turn by another unit.
        let value = stated.map_or(Some(0.25), |stated| self.value(stated).as_number());
        let is_said = row.name != "movej" && !is_timed;
        let mm_per_s = value.map(|value| 1e3 * value).filter(|_| is_said);
        let file = self.file();
        let close = file.span(tokens).end - 1;
        let (span, text, before) = match stated {
            Some(stated) => (file.span(&stated.tokens), file.text(&stated.tokens), ""),
            None => (close..close, String::new(), ", v="),
        };
        let site = mm_per_s.map(|_| SpeedSite {
            span,
            before: before.to_owned(),
            after: String::new(),
            unit_mm_per_s: 1e3,
        });
        (Speed { mm_per_s, text }, site)
    }

    /// An end, where its numbers stand, and in which frame they are.
    fn end(
        &mut self,
        row: &MotionRow,
        expression: &Expression,
    ) -> Result<(Target, TargetSite, FrameUse), Reason> {
        let End { frame, pose, .. } = End::of(expression);
        let frame = match frame {
            Some(frame) => self.frame_use(&FORM, frame),
            None => FrameUse {
                name: "base".to_owned(),
                frame: Frame::Known(Isometry3::identity()),
            },
        };
        let value = self.value(pose);
        let in_joints = "its end is stated in joints, and which pose they give is not known";
        let remedy = "write the end as a pose, or go there by movej, which takes joint values";
        let (target, site) = match (value.as_numbers::<6>(), row.name) {
            (Some(joints), "movej") => {
                let values_deg = joints.map(f64::to_degrees).to_vec();
                (Target::Joints { values_deg }, TargetSite::Fixed(in_joints))
            }
            (Some(_), _) => return Err((in_joints.to_owned(), remedy)),
            (None, _) => self.pose_end(&FORM, pose, &value)?,
        };
        Ok((target, site, frame))
    }

    /// `set_tcp(pose)`: a tool that the statement has in numbers has no name.
    pub(super) fn set_tcp(&mut self, tcp: &Expression) {
        let mut tool = self.frame_use(&FORM, tcp);
        if !matches!(tcp.node, Node::Word(_)) {
            if let Some(stated) = self.options.frames.get("tcp") {
                tool.frame = Frame::Known(*stated);
            }
            let tools = &mut self.own.tools;
            if !tools.contains(&tool.frame) {
                tools.push(tool.frame.clone());
            }
            tool.name = match tools.iter().position(|own| *own == tool.frame) {
                None | Some(0) => "tcp".to_owned(),
                Some(at) => format!("tcp_{}", at + 1),
            };
        }
        self.own.tool = tool;
    }
}

const MANUAL: &str =
    "Universal Robots, The URScript Programming Language (script manual, e-Series, SW 5)";

const OWN_WAY: Treatment = Refused {
    reason: "it moves the tool on a way that only the run decides",
    remedy: "write it as movej, movel, movep or movec, or take it into a program of its own",
};
const AT_RUN_TIME: Treatment = Refused {
    reason: "it moves the tool off the programmed path while the program runs",
    remedy: "take it, and the motions under it, into a program of its own",
};
const MOVED_FRAME: Treatment = Refused {
    reason: "the work piece moves with the conveyor",
    remedy: "a moving work piece is not corrected: take this statement into a program of its own",
};

/// The parameters of a motion.
pub(super) struct MotionRow {
    pub name: &'static str,
    /// Number of parameters that are ends.
    pub ends: usize,
    /// Names in capitals, in their order.
    pub parameters: &'static [&'static str],
}

#[rustfmt::skip]
const MOTIONS: [MotionRow; 4] = [
    MotionRow { name: "movec", ends: 2, parameters: &["POSE_VIA", "POSE_TO", "A", "V", "R", "MODE"] },
    MotionRow { name: "movej", ends: 1, parameters: &["Q", "A", "V", "T", "R"] },
    MotionRow { name: "movel", ends: 1, parameters: &["POSE", "A", "V", "T", "R"] },
    MotionRow { name: "movep", ends: 1, parameters: &["POSE", "A", "V", "R"] },
];

/// The motion of a word.
pub(super) fn motion_row(word: &[u8]) -> Option<&'static MotionRow> {
    MOTIONS
        .iter()
        .find(|row| row.name.as_bytes().eq_ignore_ascii_case(word))
}

/// Carried words that influence the deflection.
pub(super) const EFFECTS: &[(&str, &str)] = &[
    ("set_payload", LOAD),
    ("set_payload_mass", LOAD),
    ("set_payload_cog", LOAD),
    ("set_target_payload", LOAD),
    ("set_gravity", "says how the arm hangs to the controller"),
];
const LOAD: &str = "changes the load that the controller reckons with";

/// The row of a word: its own, or that of its family (`socket_*`).
pub(super) fn row(word: &[u8]) -> Option<&'static StatementRow> {
    SORTED.iter().find(|row| match row.name.strip_suffix('*') {
        Some(family) => word
            .get(..family.len())
            .is_some_and(|own| own.eq_ignore_ascii_case(family.as_bytes())),
        None => word.eq_ignore_ascii_case(row.name.as_bytes()),
    })
}

/// Treatment of each word of URScript, in alphabetical order. Functions that are neither in a file nor listed are carried with a finding.
pub const URSCRIPT_STATEMENTS: &[StatementRow] = &SORTED;

static SORTED: [StatementRow; count(OTHERS)] = sorted(rows(OTHERS));

#[rustfmt::skip]
const OTHERS: &[Alike] = &[
    alike(Understood, MANUAL, &[
        "def", "sec", "thread", "if", "elif", "else", "while", "end", "return", "break", "continue", "halt", "pass", "global", "local",
        "movec", "movej", "movel", "movep", "set_tcp", "pose_trans", "pose_inv", "pose_add", "point_dist", "interpolate_pose", "get_inverse_kin", "rpy2rotvec", "rotvec2rpy",
        "cos", "sin", "tan", "acos", "asin", "atan", "atan2", "sqrt", "pow", "log", "ceil", "floor", "norm", "d2r", "r2d", "length", "get_list_length",
    ]),
    alike(Carried, MANUAL, &[
        "run", "join", "kill", "enter_critical", "exit_critical", "sync", "sleep", "textmsg", "popup", "assert", "powerdown",
        "set_payload", "set_payload_mass", "set_payload_cog", "set_target_payload", "set_gravity", "set_digital_out", "set_flag",
        "set_analog_*", "set_configurable_*", "set_euromap_*", "set_gp_*", "set_input_*", "set_runstate_*", "set_standard_*",
        "set_tool_*", "set_safety_mode_transition_hardness", "read_*", "write_*", "modbus_*", "socket_*", "rtde_*", "rpc_factory",
        "request_*", "encoder_*", "str_*", "to_num", "to_str", "random", "binary_list_to_integer", "integer_to_binary_list",
        "get_actual_*", "get_target_*", "get_joint_*", "get_tcp_*", "get_tool_*", "get_standard_*", "get_configurable_*",
        "get_digital_*", "get_analog_*", "get_flag", "get_forward_kin", "get_steptime", "get_inverse_kin_has_solution", "force",
        "digital_in", "digital_out", "analog_in", "is_steady", "is_within_safety_limits", "pose_sub", "pose_dist", "wrench_trans",
        "stopj", "stopl", "end_force_mode", "end_freedrive_mode", "end_teach_mode", "end_screw_driving", "path_offset_disable",
        "stop_conveyor_tracking", "set_conveyor_tick_count", "get_conveyor_tick_count", "position_deviation_warning",
        "reset_revolution_counter", "zero_ftsensor", "force_mode_set_*", "tool_contact",
    ]),
    alike(OWN_WAY, MANUAL, &[
        "servoc", "servoj", "servol", "speedj", "speedl", "optimovej", "optimovel", "screw_driving", "torque_command", "direct_torque",
        "mc_*",
    ]),
    alike(AT_RUN_TIME, MANUAL, &[
        "force_mode", "freedrive_mode", "teach_mode", "path_offset_enable", "path_offset_set",
    ]),
    alike(MOVED_FRAME, MANUAL, &["track_conveyor_*"]),
];
