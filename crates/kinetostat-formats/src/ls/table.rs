//! What is done with each statement of FANUC TP programs, and with each option of a motion, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, line};

const BASIC: &str =
    "FANUC, R-30iB controller, operator's manual (basic operation), chapter 4, Program structure";
const ARC: &str = "FANUC, R-30iB controller, Arc welding function operator's manual";
const OPTIONS: &str = "FANUC, R-30iB controller, Optional function operator's manual";
const SENSOR: &str = "FANUC, R-30iB controller, Sensor and tracking manuals";

const AT_RUN_TIME: Treatment = Refused {
    reason: "it moves or bends the path while the program runs",
    remedy: "take this statement into a program of its own",
};
const OTHER_GROUP: Treatment = Refused {
    reason: "it moves several groups at once",
    remedy: "take this statement into a program of its own",
};
const OWN_WAY: Treatment = Refused {
    reason: "its motion is not followed",
    remedy: "write it as J, L or C with positions",
};
const ARCS: Treatment = Refused {
    reason: "an arc through points of several A instructions is not followed",
    remedy: "write it as C",
};
const ASSIGNED: Treatment = Refused {
    reason: "it gives a position another value while the program runs",
    remedy: "teach the position, or use a position register and leave motions to it as written",
};
const FRAME_DATA: Treatment = Refused {
    reason: "it says which frame a number means while the program runs",
    remedy: "set the frame on the controller and take this statement into a program of its own",
};

/// What is done with each statement of FANUC TP programs. A statement that is not here is refused with its line.
#[rustfmt::skip]
pub const LS_STATEMENTS: &[StatementRow] = &[
    line("J", Understood, BASIC),
    line("L", Understood, BASIC),
    line("C", Understood, BASIC),
    line("A", ARCS, BASIC),
    line("S", OWN_WAY, BASIC),
    line("P", ASSIGNED, BASIC),
    line("UFRAME_NUM", Understood, BASIC),
    line("UTOOL_NUM", Understood, BASIC),
    line("UFRAME", FRAME_DATA, BASIC),
    line("UTOOL", FRAME_DATA, BASIC),
    line("LBL", Understood, BASIC),
    line("JMP", Understood, BASIC),
    line("CALL", Understood, BASIC),
    line("IF", Understood, BASIC),
    line("ELSE", Understood, BASIC),
    line("ENDIF", Understood, BASIC),
    line("SELECT", Understood, BASIC),
    line("FOR", Understood, BASIC),
    line("ENDFOR", Understood, BASIC),
    line("END", Understood, BASIC),
    line("ABORT", Understood, BASIC),
    line("RUN", Carried, BASIC),
    line("PAUSE", Carried, BASIC),
    line("WAIT", Carried, BASIC),
    line("R", Carried, BASIC),
    line("PR", Carried, BASIC),
    line("SR", Carried, BASIC),
    line("AR", Carried, BASIC),
    line("DI", Carried, BASIC),
    line("DO", Carried, BASIC),
    line("RI", Carried, BASIC),
    line("RO", Carried, BASIC),
    line("SI", Carried, BASIC),
    line("SO", Carried, BASIC),
    line("UI", Carried, BASIC),
    line("UO", Carried, BASIC),
    line("GI", Carried, BASIC),
    line("GO", Carried, BASIC),
    line("AI", Carried, BASIC),
    line("AO", Carried, BASIC),
    line("F", Carried, BASIC),
    line("M", Carried, BASIC),
    line("WI", Carried, ARC),
    line("WO", Carried, ARC),
    line("TIMER", Carried, BASIC),
    line("OVERRIDE", Carried, BASIC),
    line("MESSAGE", Carried, BASIC),
    line("UALM", Carried, BASIC),
    line("PAYLOAD", Carried, BASIC),
    line("JOINT_MAX_SPEED", Carried, BASIC),
    line("LINEAR_MAX_SPEED", Carried, BASIC),
    line("OFFSET CONDITION", Carried, BASIC),
    line("TOOL_OFFSET CONDITION", Carried, BASIC),
    line("VOFFSET CONDITION", Carried, SENSOR),
    line("SKIP CONDITION", Carried, BASIC),
    line("LOCK PREG", Carried, BASIC),
    line("UNLOCK PREG", Carried, BASIC),
    line("MONITOR", Carried, OPTIONS),
    line("WHEN", Carried, OPTIONS),
    line("COL DETECT", Carried, OPTIONS),
    line("COL GUARD ADJUST", Carried, OPTIONS),
    line("TORQ_LIMIT", Carried, OPTIONS),
    line("RSR", Carried, BASIC),
    line("ERROR_PROG", Carried, OPTIONS),
    line("RESUME_PROG", Carried, OPTIONS),
    line("Arc Start", Carried, ARC),
    line("Arc End", Carried, ARC),
    line("Weave", Carried, ARC),
    line("Weave End", Carried, ARC),
    line("VISION", Carried, SENSOR),
    line("$MNUFRAME", FRAME_DATA, BASIC),
    line("$MNUFRAMENUM", FRAME_DATA, BASIC),
    line("$MNUTOOL", FRAME_DATA, BASIC),
    line("$MNUTOOLNUM", FRAME_DATA, BASIC),
    line("$", Carried, BASIC),
    line("!", Carried, BASIC),
    line("//", Carried, BASIC),
    line("--", Carried, BASIC),
    line("INDEPENDENT GP", OTHER_GROUP, OPTIONS),
    line("SIMULTANEOUS GP", OTHER_GROUP, OPTIONS),
    line("SOFTFLOAT", AT_RUN_TIME, OPTIONS),
    line("FOLLOW UP", AT_RUN_TIME, OPTIONS),
    line("Track", AT_RUN_TIME, ARC),
    line("Touch Offset", AT_RUN_TIME, ARC),
    line("Search Start", AT_RUN_TIME, ARC),
    line("TRACK DPM", AT_RUN_TIME, SENSOR),
    line("FORCE CTRL", AT_RUN_TIME, SENSOR),
    line("STREAM", AT_RUN_TIME, SENSOR),
    line("LINE", AT_RUN_TIME, SENSOR),
    line("PALLETIZING", OWN_WAY, OPTIONS),
    line("PL", OWN_WAY, OPTIONS),
    line("SPOT", OWN_WAY, OPTIONS),
];

/// The row of a statement: the longest name with which its text begins.
pub(crate) fn row(text: &[u8]) -> Option<&'static StatementRow> {
    let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let begins = |row: &&StatementRow| {
        let name = row.name.as_bytes();
        text.starts_with(name)
            && !(name.last().is_some_and(is_part) && text.get(name.len()).is_some_and(is_part))
    };
    LS_STATEMENTS
        .iter()
        .filter(begins)
        .max_by_key(|row| row.name.len())
}

/// What follows the name of an option of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Follows {
    Nothing,
    /// A number or a register, with or without a unit.
    Value,
    /// A comma and a register, or nothing.
    Register,
    /// All to the end of the instruction: what runs at the end of the motion, once.
    Event,
}

/// What an option does to a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// The end stays: carried.
    None,
    /// The tool turns otherwise than evenly, in words how.
    Turned(&'static str),
    /// The end is elsewhere, which only the run knows.
    Displaced(&'static str),
    /// The motion is not followed.
    Refused(&'static str),
}

/// An option of a motion.
pub(crate) struct OptionRow {
    pub name: &'static str,
    pub follows: Follows,
    pub effect: Effect,
}

const fn option(name: &'static str, follows: Follows, effect: Effect) -> OptionRow {
    OptionRow {
        name,
        follows,
        effect,
    }
}

const OFFSET: Effect =
    Effect::Displaced("it is offset by a register, whose value is not in the text");
const COORDINATED: Effect =
    Effect::Refused("it is coordinated with another group that moves the part");

/// All options that are known.
#[rustfmt::skip]
pub(crate) const MOTION_OPTIONS: &[OptionRow] = &[
    option("ACC", Follows::Value, Effect::None),
    option("Wjnt", Follows::Nothing, Effect::Turned("the joints of the wrist turn evenly (Wjnt), and with them the tool does not")),
    option("Mrot", Follows::Nothing, Effect::None),
    option("PTH", Follows::Nothing, Effect::None),
    option("BREAK", Follows::Nothing, Effect::None),
    option("EV", Follows::Value, Effect::None),
    option("PSPD", Follows::Value, Effect::None),
    option("CR", Follows::Value, Effect::None),
    option("AP_LD", Follows::Value, Effect::None),
    option("RT_LD", Follows::Value, Effect::None),
    option("TA", Follows::Event, Effect::None),
    option("TB", Follows::Event, Effect::None),
    option("DB", Follows::Event, Effect::None),
    option("Arc", Follows::Event, Effect::None),
    option("Weave", Follows::Event, Effect::None),
    option("Offset", Follows::Register, OFFSET),
    option("Tool_Offset", Follows::Register, OFFSET),
    option("VOFFSET", Follows::Register, OFFSET),
    option("INC", Follows::Nothing, Effect::Displaced("its position is a step from where the tool was")),
    option("Skip", Follows::Event, Effect::Displaced("it ends where a signal changes, which only the run decides")),
    option("COORD", Follows::Nothing, COORDINATED),
    option("RTCP", Follows::Nothing, Effect::Refused("its tool stands still and the arm holds the part")),
    option("TRACK", Follows::Event, Effect::Refused("a sensor bends its path")),
    option("SPOT", Follows::Event, Effect::Refused("a spot gun moves at its end")),
];
