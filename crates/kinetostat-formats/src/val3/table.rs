//! Treatment of each statement of VAL3, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, row_of, rows, sorted};
use crate::text::name::Name;

const MANUAL: &str = "Staubli, VAL3 Reference Manual";

/// The words of motions.
pub(super) const MOTIONS: [&str; 3] = ["movec", "movej", "movel"];

/// Instructions that change what they are given.
pub(super) const CHANGE_THEIRS: [&str; 7] = [
    "clearBuffer",
    "get",
    "getKey",
    "insert",
    "sioGet",
    "toNum",
    "fromBinary",
];

const MOVED_FRAME: Treatment = Refused {
    reason: "it moves or changes the frame of points while the program runs",
    remedy: "state the frame in the data of the application, or take this statement into a program of its own",
};
const OWN_WAY: Treatment = Refused {
    reason: "its motion is not followed, or it changes the path while it runs",
    remedy: "write it as movel, movec or movej, or take it into a program of its own",
};

/// The row of a statement by its name.
pub(super) fn row(name: &Name) -> Option<&'static StatementRow> {
    row_of(&SORTED, name)
}

/// True for the word of a motion.
pub(super) fn is_motion(name: &Name) -> bool {
    is_one_of(name, &MOTIONS)
}

/// True for a name of a list, whatever its case.
pub(super) fn is_one_of(name: &Name, all: &[&str]) -> bool {
    (all.iter()).any(|own| own.as_bytes().eq_ignore_ascii_case(name.letters()))
}

/// Treatment of each statement of VAL3, in alphabetical order. Library programs and functions that are neither in a file nor listed are carried with
/// a finding.
pub const VAL3_STATEMENTS: &[StatementRow] = &SORTED;

static SORTED: [StatementRow; count(GROUPS)] = sorted(rows::<{ count(GROUPS) }>(GROUPS));

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, MANUAL, &[
        "=", "begin", "end", "if", "elseIf", "else", "endIf", "while", "endWhile", "for", "endFor", "do", "until", "switch",
        "case", "default", "break", "endSwitch", "return", "call", "taskCreate", "taskCreateSync", "movec", "movej", "movel", "appro", "compose",
        "resetMotion", "waitEndMove",
    ]),
    alike(Carried, MANUAL, &[
        "aioSet", "aioLink", "cls", "clearBuffer", "close", "delay", "dioLink", "dioSet", "disablePower", "enablePower", "get",
        "getKey", "gotoxy", "insert", "ioBusStatus", "isEmpty", "isSettled", "logMsg", "open", "popUpMsg", "put", "putln",
        "restartMove", "setMonitorSpeed", "setMutex", "setPayload", "sioGet", "sioLink", "sioSet", "stopMove", "taskKill",
        "taskResume", "taskSuspend", "title", "toNum", "fromBinary", "toBinary", "userPage", "wait", "watch",
    ]),
    alike(MOVED_FRAME, MANUAL, &["link", "setFrame", "setTool", "setWorld", "delete", "resize"]),
    alike(OWN_WAY, MANUAL, &[
        "alter", "alterBegin", "alterEnd", "alterMovec", "alterMovej", "alterMovel", "alterStopTime", "movecf", "movejf", "movelf",
        "autoConnectMove", "libLoad", "libDelete", "stepMove", "trackConv", "compliantMovel", "movejc", "movelc", "movejs",
        "movejfollow", "movels", "rawMovej", "synchroMove",
    ]),
];
