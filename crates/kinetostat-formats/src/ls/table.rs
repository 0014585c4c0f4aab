//! Treatment of each statement of FANUC TP programs, and of each motion option.

use crate::model::site::OffsetAxes;
use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows};

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
const FRAME_MENU: Treatment = Refused {
    reason: "it says which frame a number means while the program runs",
    remedy: "set the frame on the controller and take this statement into a program of its own",
};

/// Treatment of each statement of FANUC TP programs. A statement that is not listed is refused with its line.
pub const LS_STATEMENTS: &[StatementRow] = &rows::<{ count(GROUPS) }>(GROUPS);

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, BASIC, &["J", "L", "C"]),
    alike(ARCS, BASIC, &["A"]),
    alike(OWN_WAY, BASIC, &["S"]),
    alike(ASSIGNED, BASIC, &["P"]),
    alike(Understood, BASIC, &[
        "UFRAME_NUM", "UTOOL_NUM", "UFRAME", "UTOOL", "PR", "OFFSET CONDITION", "TOOL_OFFSET CONDITION",
        "LBL", "JMP", "CALL", "IF", "ELSE", "ENDIF", "SELECT", "FOR", "ENDFOR", "END", "ABORT",
    ]),
    alike(Carried, BASIC, &[
        "RUN", "PAUSE", "WAIT", "R", "SR", "AR", "DI", "DO", "RI", "RO", "SI", "SO", "UI",
        "UO", "GI", "GO", "AI", "AO", "F", "M",
    ]),
    alike(Carried, ARC, &["WI", "WO"]),
    alike(Carried, BASIC, &[
        "TIMER", "OVERRIDE", "MESSAGE", "UALM", "PAYLOAD", "JOINT_MAX_SPEED", "LINEAR_MAX_SPEED",
    ]),
    alike(Carried, SENSOR, &["VOFFSET CONDITION"]),
    alike(Carried, BASIC, &["SKIP CONDITION", "LOCK PREG", "UNLOCK PREG"]),
    alike(Carried, OPTIONS, &["MONITOR", "WHEN", "COL DETECT", "COL GUARD ADJUST", "TORQ_LIMIT"]),
    alike(Carried, BASIC, &["RSR"]),
    alike(Carried, OPTIONS, &["ERROR_PROG", "RESUME_PROG"]),
    alike(Carried, ARC, &["Arc Start", "Arc End", "Weld Start", "Weld End", "Weave", "Weave End"]),
    alike(Carried, SENSOR, &["VISION"]),
    alike(FRAME_MENU, BASIC, &["$MNUFRAME", "$MNUFRAMENUM", "$MNUTOOL", "$MNUTOOLNUM"]),
    alike(Carried, BASIC, &["$", "!", "//", "--"]),
    alike(OTHER_GROUP, OPTIONS, &["INDEPENDENT GP", "SIMULTANEOUS GP"]),
    alike(AT_RUN_TIME, OPTIONS, &["SOFTFLOAT", "FOLLOW UP"]),
    alike(AT_RUN_TIME, ARC, &["Track", "Touch Offset", "Search Start"]),
    alike(AT_RUN_TIME, SENSOR, &["TRACK DPM", "FORCE CTRL", "STREAM", "LINE"]),
    alike(OWN_WAY, OPTIONS, &["PALLETIZING", "PL", "SPOT"]),
];

/// Settings of how motions run.
pub(crate) const MODES: &[&[&str]] = &[
    &["JOINT_MAX_SPEED"],
    &["LINEAR_MAX_SPEED"],
    &["PAYLOAD"],
    &["TORQ_LIMIT"],
    &["COL DETECT"],
    &["COL GUARD ADJUST"],
    &["WEAVE"],
];

/// Settings and data that are in the places and frames of the motions.
pub(crate) const IN_MOTIONS: &[&str] = &["UFRAME", "UTOOL", "PR["];

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

/// Argument after the name of a motion option.
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

/// Effect of an option on a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// The end stays: carried.
    None,
    /// The tool turns otherwise than evenly, in words how.
    Turned(&'static str),
    /// The end is elsewhere, which only the run knows.
    Displaced(&'static str),
    /// The end is offset by a register.
    Offset(OffsetAxes),
    /// The motion is not followed, and what to do.
    Refused(&'static str, &'static str),
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

/// Reason why an offset end is unknown.
pub(crate) const OFFSET: &str =
    "it is offset by a register, whose value is not in the text, or which turns the tool";
const ALONE: &str = "take this motion into a program of its own";
pub(crate) const SKIP: Effect =
    Effect::Displaced("it ends where a signal changes, which only the run decides");
const COORDINATED: Effect = Effect::Refused(
    "it is coordinated with another group that moves the part",
    "let the other group stand still and write the motion without COORD, or take it into a program of its own",
);

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
    option("Weld", Follows::Event, Effect::None),
    option("Weave", Follows::Event, Effect::None),
    option("Offset", Follows::Register, Effect::Offset(OffsetAxes::WorkObject)),
    option("Tool_Offset", Follows::Register, Effect::Offset(OffsetAxes::Tool)),
    option("VOFFSET", Follows::Register, Effect::Displaced("it is offset by a register of the vision system, whose value is not in the text")),
    option("INC", Follows::Nothing, Effect::Displaced("its position is a step from where the tool was")),
    option("Skip", Follows::Event, SKIP),
    option("SkipJump", Follows::Event, SKIP),
    option("COORD", Follows::Nothing, COORDINATED),
    option("RTCP", Follows::Nothing, Effect::Refused("its tool stands still and the arm holds the part", ALONE)),
    option("TRACK", Follows::Event, Effect::Refused("a sensor bends its path", ALONE)),
    option("SPOT", Follows::Event, Effect::Refused("a spot gun moves at its end", ALONE)),
];
