//! Treatment of each statement of Heidenhain's conversational language.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows};

const PATHS: &str = "HEIDENHAIN, conversational programming: path functions";
const PROGRAMS: &str = "HEIDENHAIN, conversational programming: fundamentals";
const LABELS: &str =
    "HEIDENHAIN, conversational programming: subprograms and program-section repeats";
const PARAMETERS: &str = "HEIDENHAIN, conversational programming: Q parameters";
const CYCLES: &str = "HEIDENHAIN, cycle programming";
const AXES: &str = "HEIDENHAIN, conversational programming: multiple-axis machining";
const MISCELLANEOUS: &str = "HEIDENHAIN, conversational programming: miscellaneous functions";

const ROUNDED: Treatment = Refused {
    reason: "the control rounds the corner between two blocks",
    remedy: "write the program flat first (--expand): the arc becomes a block of its own",
};
const CHAMFERED: Treatment = Refused {
    reason: "the control breaks the corner between two blocks",
    remedy: "write the program flat first (--expand): the chamfer becomes a block of its own",
};
const APPROACH: Treatment = Refused {
    reason: "the control makes the way to or from a contour by itself",
    remedy: "let the CAM system write it as L and C blocks",
};
const CONTOUR: Treatment = Refused {
    reason: "the control computes the contour by itself",
    remedy: "let the CAM system write it as L and C blocks",
};
const PROBED: Treatment = Refused {
    reason: "it moves until a probe touches",
    remedy: "take it into a program of its own",
};
const TABLES: Treatment = Refused {
    reason: "places or programs come from a table or a choice of the control",
    remedy: "write the places into the program",
};

/// Treatment of each statement of Heidenhain's conversational language. A statement that is not listed is refused with its line. Miscellaneous
/// functions that are not listed are the machine builder's: carried, with a remark.
pub const HEIDENHAIN_STATEMENTS: &[StatementRow] = &rows::<{ count(GROUPS) }>(GROUPS);

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, PROGRAMS, &["BEGIN", "END"]),
    alike(Carried, PROGRAMS, &["BLK"]),
    alike(Understood, PROGRAMS, &["TOOL"]),
    alike(Carried, PROGRAMS, &["STOP"]),
    alike(Understood, PATHS, &["L", "LP"]),
    alike(Understood, AXES, &["LN"]),
    alike(Understood, PATHS, &["CC", "C", "CP", "CR", "CT", "CTP"]),
    alike(ROUNDED, PATHS, &["RND"]),
    alike(CHAMFERED, PATHS, &["CHF"]),
    alike(APPROACH, PATHS, &["APPR", "DEP"]),
    alike(CONTOUR, PATHS, &["FPOL", "FL", "FLT", "FC", "FCT", "FSELECT", "SPL"]),
    alike(Understood, LABELS, &["LBL", "CALL"]),
    alike(TABLES, LABELS, &["SEL"]),
    alike(TABLES, CYCLES, &["PATTERN"]),
    alike(CONTOUR, CYCLES, &["CONTOUR"]),
    alike(Understood, PARAMETERS, &["FN", "Q", "QL", "QR"]),
    alike(Carried, PARAMETERS, &["QS"]),
    alike(Understood, CYCLES, &["CYCL", "CYCLE", "TRANS"]),
    alike(PROBED, CYCLES, &["TCH"]),
    alike(TABLES, CYCLES, &["PRESET"]),
    alike(Understood, AXES, &["PLANE", "FUNCTION"]),
    alike(Understood, MISCELLANEOUS, &["M"]),
    alike(Understood, PATHS, &["F"]),
    alike(Carried, MISCELLANEOUS, &["MB"]),
];

/// The row of a statement's first word.
pub(crate) fn row(letters: &[u8]) -> Option<&'static StatementRow> {
    HEIDENHAIN_STATEMENTS
        .iter()
        .find(|row| row.name.as_bytes() == letters)
}

/// Effect of a miscellaneous function on the tool position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    /// Nothing, from the beginning of its block on.
    AtStart,
    /// Nothing, at the end of its block.
    AtEnd,
    /// The block's places are the machine's.
    Machine,
    /// The tool goes back along its axis.
    Retracts,
    /// A cycle is called at the block's end.
    Calls,
    /// Speeds are per turn of the spindle from here on.
    PerTurn,
    /// Speeds are per minute again.
    PerMinute,
    /// The function moves or displaces the tool in another way.
    Refused(&'static str),
    /// The machine's builder says what it does.
    Unknown,
}

/// Classifies a miscellaneous function.
pub(crate) fn function(number: u32) -> Function {
    match number {
        3
        | 4
        | 7
        | 8
        | 13
        | 14
        | 90
        | 94
        | 97
        | 103
        | 107
        | 108
        | 109
        | 110
        | 111
        | 112
        | 116
        | 120
        | 124
        | 126
        | 128
        | 134
        | 138
        | 141
        | 148
        | 150
        | 197..=204 => Function::AtStart,
        0 | 1 | 2 | 5 | 6 | 9 | 30 | 98 | 113 | 115 | 117 | 127 | 129 | 135 | 145 | 149 => {
            Function::AtEnd
        }
        91 | 92 => Function::Machine,
        140 => Function::Retracts,
        89 | 99 => Function::Calls,
        136 => Function::PerTurn,
        137 => Function::PerMinute,
        101 => Function::Refused("the control may take another tool here by itself"),
        102 => Function::AtStart,
        114 | 144 => {
            Function::Refused("the control moves the axes for the tilt of the head or table")
        }
        118 => Function::Refused("the handwheel moves the tool beside the program"),
        130 => Function::Refused("the places are those of the plane that is not tilted"),
        142 | 143 => Function::Refused("it deletes what places or turns the coordinates"),
        _ => Function::Unknown,
    }
}
