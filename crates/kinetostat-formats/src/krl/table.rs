//! What is done with each statement of KRL, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, comes_before, line};
use crate::text::name::Name;

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

/// How the end of a motion is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    Joint,
    Linear,
    Circular,
    /// By steps from where the tool is.
    Step,
}

/// A motion that is understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MotionRow {
    pub name: &'static str,
    pub ends: Ends,
    /// The word of a straight piece before its end; none where it cannot be divided.
    pub straight: Option<&'static str>,
    /// What makes the tool pass the end of a piece without a stop.
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

/// Whether a call of such a function leaves its arguments as they are.
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
pub(crate) const MOTIONS: [MotionRow; 8] = [
    motion("PTP", Ends::Joint, None, "C_PTP", EXPERT),
    motion("LIN", Ends::Linear, Some("LIN"), "C_DIS", EXPERT),
    motion("CIRC", Ends::Circular, Some("LIN"), "C_DIS", EXPERT),
    motion("LIN_REL", Ends::Step, Some("LIN"), "C_DIS", EXPERT),
    motion("SPTP", Ends::Joint, None, "C_SPL", KSS),
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
    let letters = name.letters();
    let found = SORTED.binary_search_by(|row| row.name.as_bytes().cmp(letters));
    found.ok().map(|index| &SORTED[index])
}

/// What is done with each statement of KRL, in the order of the alphabet. Routines that are in no file and not here are
/// carried with a finding; any other word that begins a line is refused.
pub const KRL_STATEMENTS: &[StatementRow] = &SORTED;

const COUNT: usize = OTHERS.len() + MOTIONS.len();

/// Motions and others in order of their names.
static SORTED: [StatementRow; COUNT] = sorted();

const fn sorted() -> [StatementRow; COUNT] {
    let mut all = [OTHERS[0]; COUNT];
    let mut filled = 0;
    while filled < COUNT {
        let next = match filled < OTHERS.len() {
            true => OTHERS[filled],
            false => {
                let motion = MOTIONS[filled - OTHERS.len()];
                line(motion.name, Understood, motion.source)
            }
        };
        let mut at = filled;
        while at > 0 && comes_before(next.name.as_bytes(), all[at - 1].name.as_bytes()) {
            all[at] = all[at - 1];
            at -= 1;
        }
        all[at] = next;
        filled += 1;
    }
    all
}

#[rustfmt::skip]
const OTHERS: [StatementRow; 140] = [
    line("DEF", Understood, EXPERT),
    line("DEFFCT", Understood, EXPERT),
    line("DEFDAT", Understood, EXPERT),
    line("END", Understood, EXPERT),
    line("ENDFCT", Understood, EXPERT),
    line("ENDDAT", Understood, EXPERT),
    line("DECL", Understood, EXPERT),
    line("GLOBAL", Understood, EXPERT),
    line("CONST", Understood, EXPERT),
    line("IF", Understood, EXPERT),
    line("SWITCH", Understood, EXPERT),
    line("FOR", Understood, EXPERT),
    line("WHILE", Understood, EXPERT),
    line("REPEAT", Understood, EXPERT),
    line("LOOP", Understood, EXPERT),
    line("GOTO", Understood, EXPERT),
    line("RETURN", Understood, EXPERT),
    line("EXIT", Understood, EXPERT),
    line("=", Understood, EXPERT),
    line("BAS", Understood, EXPERT),
    line("INTERRUPT", Understood, EXPERT),
    line("TRIGGER", Understood, EXPERT),
    line("STRUC", Carried, EXPERT),
    line("ENUM", Carried, EXPERT),
    line("SIGNAL", Carried, EXPERT),
    line("EXT", Carried, EXPERT),
    line("EXTFCT", Carried, EXPERT),
    line("EXTP", Carried, EXPERT),
    line("EXTFCTP", Carried, EXPERT),
    line("IMPORT", Carried, EXPERT),
    line("CONTINUE", Carried, EXPERT),
    line("HALT", Carried, EXPERT),
    line("WAIT", Carried, EXPERT),
    line("PULSE", Carried, EXPERT),
    line("ANIN", Carried, EXPERT),
    line("ANOUT", Carried, EXPERT),
    line("DIGIN", Carried, EXPERT),
    line("CCLOSE", Carried, EXPERT),
    line("COPEN", Carried, EXPERT),
    line("CIOCTL", Carried, EXPERT),
    line("CREAD", Carried, EXPERT),
    line("CWRITE", Carried, EXPERT),
    line("SREAD", Carried, EXPERT),
    line("SWRITE", Carried, EXPERT),
    line("CONFIRM", Carried, EXPERT),
    line("CHANNEL", Carried, EXPERT),
    line("VARSTATE", Carried, EXPERT),
    line("RESUME", Refused {
        reason: "it leaves motions before their ends",
        remedy: "take the interrupt that resumes into a program of its own",
    }, EXPERT),
    line("BRAKE", Carried, EXPERT),
    line("PTP_REL", RELATIVE, EXPERT),
    line("CIRC_REL", RELATIVE, EXPERT),
    line("SPTP_REL", RELATIVE, KSS),
    line("SCIRC_REL", RELATIVE, KSS),
    line("SPLINE", Understood, KSS),
    line("ENDSPLINE", Understood, KSS),
    line("PTP_SPLINE", SPLINE, KSS),
    line("SPL", SPLINE, KSS),
    line("TIME_BLOCK", TIMES, KSS),
    line("CONST_VEL", Carried, KSS),
    line("STOP", Carried, KSS),
    line("SVEL_CP", Carried, KSS),
    line("SVEL_JOINT", Carried, KSS),
    line("SACC_CP", Carried, KSS),
    line("SACC_JOINT", Carried, KSS),
    line("STOOL2", Carried, KSS),
    line("SBASE", Carried, KSS),
    line("SLOAD", Carried, KSS),
    line("SIPO_MODE", Carried, KSS),
    line("SORI_TYP", Understood, KSS),
    line("SCIRC_TYP", Understood, KSS),
    line("SCIRC_M", Understood, KSS),
    line("SAPO", Carried, KSS),
    line("SAPO_PTP", Carried, KSS),
    line("SJERK", Carried, KSS),
    line("SGEAR_JERK", Carried, KSS),
    line("USE_CM_PRO_VALUES", Carried, KSS),
    line("ASYPTP", ASYNCHRONOUS, KSS),
    line("ASYCONT", ASYNCHRONOUS, KSS),
    line("ASYSTOP", ASYNCHRONOUS, KSS),
    line("ASYCANCEL", ASYNCHRONOUS, KSS),
    line("CWRITEAXIS", ASYNCHRONOUS, KSS),
    line("ABS", Carried, EXPERT),
    line("SQRT", Carried, EXPERT),
    line("SIN", Carried, EXPERT),
    line("COS", Carried, EXPERT),
    line("TAN", Carried, EXPERT),
    line("ACOS", Carried, EXPERT),
    line("ATAN2", Carried, EXPERT),
    line("INV_POS", Carried, EXPERT),
    line("INVERSE", Carried, EXPERT),
    line("FORWARD", Carried, EXPERT),
    line("ROUND", Carried, KSS),
    line("CAST_TO", Carried, KSS),
    line("CAST_FROM", Carried, KSS),
    line("STRLEN", Carried, KSS),
    line("STRADD", Carried, KSS),
    line("STRCLEAR", Carried, KSS),
    line("STRCOMP", Carried, KSS),
    line("STRCOPY", Carried, KSS),
    line("STRDECLLEN", Carried, KSS),
    line("STRFIND", Carried, KSS),
    line("GET_SIG_INF", Carried, KSS),
    line("SET_CD_PARAMS", Carried, KSS),
    line("SET_KRLMSG", Carried, KSS),
    line("SET_KRLDLG", Carried, KSS),
    line("EXISTS_KRLMSG", Carried, KSS),
    line("EXISTS_KRLDLG", Carried, KSS),
    line("CLEAR_KRLMSG", Carried, KSS),
    line("MSGQUIT", Carried, KSS),
    line("MSGNOTIFY", Carried, KSS),
    line("MSGSTATE", Carried, KSS),
    line("MSGLOOP", Carried, KSS),
    line("MSGDIALOG", Carried, KSS),
    line("EKI_INIT", Carried, ETHERNET),
    line("EKI_OPEN", Carried, ETHERNET),
    line("EKI_CLOSE", Carried, ETHERNET),
    line("EKI_CLEAR", Carried, ETHERNET),
    line("EKI_CLEARBUFFER", Carried, ETHERNET),
    line("EKI_CHECKBUFFER", Carried, ETHERNET),
    line("EKI_SEND", Carried, ETHERNET),
    line("EKI_GETBOOL", Carried, ETHERNET),
    line("EKI_GETINT", Carried, ETHERNET),
    line("EKI_GETREAL", Carried, ETHERNET),
    line("EKI_GETSTRING", Carried, ETHERNET),
    line("EKI_GETFRAME", Carried, ETHERNET),
    line("EKI_GETBOOLARRAY", Carried, ETHERNET),
    line("EKI_GETINTARRAY", Carried, ETHERNET),
    line("EKI_GETREALARRAY", Carried, ETHERNET),
    line("EKI_SETBOOL", Carried, ETHERNET),
    line("EKI_SETINT", Carried, ETHERNET),
    line("EKI_SETREAL", Carried, ETHERNET),
    line("EKI_SETSTRING", Carried, ETHERNET),
    line("EKI_SETFRAME", Carried, ETHERNET),
    line("RSI_CREATE", Carried, SENSOR),
    line("RSI_DELETE", Carried, SENSOR),
    line("RSI_ON", AT_RUN_TIME, SENSOR),
    line("RSI_OFF", Carried, SENSOR),
    line("RSI_MOVECORR", AT_RUN_TIME, SENSOR),
    line("ST_ON", AT_RUN_TIME, SENSOR),
    line("ST_SKIPSENS", AT_RUN_TIME, SENSOR),
];
