//! Treatment of each word of URScript, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows, sorted};

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
