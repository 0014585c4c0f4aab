//! Treatment of each statement of KRL.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, line, row_of, rows, sorted};
use crate::text::Name;

const KSS: &str =
    "KUKA System Software 8.x, Operating and Programming Instructions for System Integrators";
const EXPERT: &str = "KUKA, KR C2 / KR C3 Expert Programming, KSS 5.x";
const SENSOR: &str = "KUKA.RobotSensorInterface";
const ETHERNET: &str = "KUKA.Ethernet KRL";

const AT_RUN_TIME: Treatment = Refused {
    reason: "a sensor moves the tool while the program runs",
    remedy: "take this statement into a program of its own",
};
const SPLINE: Treatment = Refused {
    reason: "the way between the points of a spline depends on all of them",
    remedy: "write the block with SLIN and SCIRC, with points as near to each other as the way needs, or take it into a program of its own",
};
const TIMES: Treatment = Refused {
    reason: "it shares out the time of a spline block, and the speed along the part with it",
    remedy: "state the speed of the segments (WITH $VEL.CP), or take the block into a program of its own",
};
const RELATIVE: Treatment = Refused {
    reason: "it goes on from where the tool is",
    remedy: "write the end with LIN, PTP or CIRC and all its numbers",
};
const ASYNCHRONOUS: Treatment = Refused {
    reason: "it moves axes apart from the program",
    remedy: "take this statement into a program of its own",
};

/// Settings of how motions run: path mode, acceleration, orientation, zone.
pub(crate) const MODES: &[&[&str]] = &[
    &["$APO"],
    &["$ACC"],
    &["$JERK"],
    &["$GEAR_JERK"],
    &["$VEL"],
    &["$ORI_TYPE"],
    &["$CIRC_TYPE"],
    &["$CIRC_MODE"],
    &["$IPO_MODE"],
    &["$SINGUL_STRATEGY"],
    &["$EX_AX_IGNORE"],
    &["$TECH"],
    &["$ADVANCE"],
    &["FDAT_ACT"],
    &["LDAT_ACT"],
    &["BAS"],
];

/// Settings and data that are in the places, frames, speeds and zones of the motions.
pub(crate) const IN_MOTIONS: &[&str] = &[
    "$BASE",
    "$TOOL",
    "BASE_DATA",
    "TOOL_DATA",
    "$VEL.CP",
    "$VEL=",
    "$APO.CDIS",
    "BAS(#BASE",
    "BAS(#TOOL",
    "BAS(#VEL_CP",
];

/// How the end of a motion is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    Joint,
    Linear,
    Circular,
    /// Relative end from the tool position, linear or in joints.
    Step,
    JointStep,
}

impl Ends {
    /// True for relative ends.
    pub(crate) fn are_steps(self) -> bool {
        matches!(self, Self::Step | Self::JointStep)
    }
}

/// A motion that is understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MotionRow {
    pub name: &'static str,
    pub ends: Ends,
    /// The word of a straight piece before its end; none where it cannot be divided.
    pub straight: Option<&'static str>,
    /// Word that approximates the end of a piece, without a stop.
    pub pass: &'static str,
    source: &'static str,
}

/// Words before a bracket that call nothing.
pub(crate) const OPERATORS: [&str; 15] = [
    "AND", "OR", "NOT", "EXOR", "B_AND", "B_OR", "B_EXOR", "B_NOT", "UNTIL", "TO", "STEP", "THEN",
    "CASE", "WHEN", "DO",
];

/// Functions of the controller that change nothing of what they are given: of the inline forms, and of numbers.
const READERS: [&str; 22] = [
    "SVEL_CP",
    "SVEL_JOINT",
    "SACC_CP",
    "SACC_JOINT",
    "STOOL2",
    "SBASE",
    "SLOAD",
    "SIPO_MODE",
    "SORI_TYP",
    "SCIRC_TYP",
    "SCIRC_M",
    "SAPO",
    "SAPO_PTP",
    "SJERK",
    "SGEAR_JERK",
    "ABS",
    "SQRT",
    "SIN",
    "COS",
    "TAN",
    "ACOS",
    "ATAN2",
];

/// True if a call of such a function does not change its arguments.
pub(crate) fn only_reads(called: &Name) -> bool {
    READERS.iter().any(|name| called.is(name))
}

const fn motion(
    name: &'static str,
    ends: Ends,
    straight: Option<&'static str>,
    pass: &'static str,
    source: &'static str,
) -> MotionRow {
    MotionRow {
        name,
        ends,
        straight,
        pass,
        source,
    }
}

/// All motions that are understood.
pub(crate) const MOTIONS: [MotionRow; 10] = [
    motion("PTP", Ends::Joint, None, "C_PTP", EXPERT),
    motion("LIN", Ends::Linear, Some("LIN"), "C_DIS", EXPERT),
    motion("CIRC", Ends::Circular, Some("LIN"), "C_DIS", EXPERT),
    motion("LIN_REL", Ends::Step, Some("LIN"), "C_DIS", EXPERT),
    motion("PTP_REL", Ends::JointStep, None, "C_PTP", EXPERT),
    motion("SPTP", Ends::Joint, None, "C_SPL", KSS),
    motion("SPTP_REL", Ends::JointStep, None, "C_SPL", KSS),
    motion("SLIN", Ends::Linear, Some("SLIN"), "C_SPL", KSS),
    motion("SLIN_REL", Ends::Step, Some("SLIN"), "C_SPL", KSS),
    motion("SCIRC", Ends::Circular, Some("SLIN"), "C_SPL", KSS),
];

/// The motion of a name.
pub(crate) fn motion_row(name: &Name) -> Option<&'static MotionRow> {
    MOTIONS.iter().find(|row| name.is(row.name))
}

/// The row of a statement by its name.
pub(crate) fn row(name: &Name) -> Option<&'static StatementRow> {
    row_of(&SORTED, name)
}

/// Treatment of each statement of KRL, in alphabetical order. Routines that are neither in a file nor listed are carried with a finding; any other
/// word that begins a line is refused.
pub const KRL_STATEMENTS: &[StatementRow] = &SORTED;

const COUNT: usize = count(OTHERS) + MOTIONS.len();

/// Motions and others in order of their names.
static SORTED: [StatementRow; COUNT] = {
    let mut all = rows::<COUNT>(OTHERS);
    let mut at = 0;
    while at < MOTIONS.len() {
        all[count(OTHERS) + at] = line(MOTIONS[at].name, Understood, MOTIONS[at].source);
        at += 1;
    }
    sorted(all)
};

#[rustfmt::skip]
const OTHERS: &[Alike] = &[
    alike(Understood, EXPERT, &[
        "DEF", "DEFFCT", "DEFDAT", "END", "ENDFCT", "ENDDAT", "DECL", "GLOBAL", "CONST", "IF",
        "SWITCH", "FOR", "WHILE", "REPEAT", "LOOP", "GOTO", "RETURN", "EXIT", "=", "BAS",
        "INTERRUPT", "TRIGGER",
    ]),
    alike(Carried, EXPERT, &[
        "STRUC", "ENUM", "SIGNAL", "EXT", "EXTFCT", "EXTP", "EXTFCTP", "IMPORT", "CONTINUE", "HALT",
        "WAIT", "PULSE", "ANIN", "ANOUT", "DIGIN", "CCLOSE", "COPEN", "CIOCTL", "CREAD", "CWRITE",
        "SREAD", "SWRITE", "CONFIRM", "CHANNEL", "VARSTATE", "BRAKE", "ABS", "SQRT", "SIN", "COS",
        "TAN", "ACOS", "ATAN2", "INV_POS", "INVERSE", "FORWARD",
    ]),
    alike(Refused {
        reason: "it leaves motions before their ends",
        remedy: "take the interrupt that resumes into a program of its own",
    }, EXPERT, &["RESUME"]),
    alike(RELATIVE, EXPERT, &["CIRC_REL"]),
    alike(RELATIVE, KSS, &["SCIRC_REL"]),
    alike(Understood, KSS, &["SPLINE", "ENDSPLINE", "SORI_TYP", "SCIRC_TYP", "SCIRC_M"]),
    alike(SPLINE, KSS, &["PTP_SPLINE", "SPL"]),
    alike(TIMES, KSS, &["TIME_BLOCK"]),
    alike(Carried, KSS, &[
        "CONST_VEL", "STOP", "SVEL_CP", "SVEL_JOINT", "SACC_CP", "SACC_JOINT", "STOOL2", "SBASE",
        "SLOAD", "SIPO_MODE", "SAPO", "SAPO_PTP", "SJERK", "SGEAR_JERK", "USE_CM_PRO_VALUES",
        "ROUND", "CAST_TO", "CAST_FROM", "STRLEN", "STRADD", "STRCLEAR", "STRCOMP", "STRCOPY",
        "STRDECLLEN", "STRFIND", "GET_SIG_INF", "SET_CD_PARAMS", "SET_KRLMSG", "SET_KRLDLG",
        "EXISTS_KRLMSG", "EXISTS_KRLDLG", "CLEAR_KRLMSG", "MSGQUIT", "MSGNOTIFY", "MSGSTATE",
        "MSGLOOP", "MSGDIALOG",
    ]),
    alike(ASYNCHRONOUS, KSS, &["ASYPTP", "ASYCONT", "ASYSTOP", "ASYCANCEL", "CWRITEAXIS"]),
    alike(Carried, ETHERNET, &[
        "EKI_INIT", "EKI_OPEN", "EKI_CLOSE", "EKI_CLEAR", "EKI_CLEARBUFFER", "EKI_CHECKBUFFER",
        "EKI_SEND", "EKI_GETBOOL", "EKI_GETINT", "EKI_GETREAL", "EKI_GETSTRING", "EKI_GETFRAME",
        "EKI_GETBOOLARRAY", "EKI_GETINTARRAY", "EKI_GETREALARRAY", "EKI_SETBOOL", "EKI_SETINT",
        "EKI_SETREAL", "EKI_SETSTRING", "EKI_SETFRAME",
    ]),
    alike(Carried, SENSOR, &["RSI_CREATE", "RSI_DELETE", "RSI_OFF"]),
    alike(AT_RUN_TIME, SENSOR, &["RSI_ON", "RSI_MOVECORR", "ST_ON", "ST_SKIPSENS"]),
];
