//! What is done with each statement of Heidenhain's conversational language, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment};

const PATHS: &str = "HEIDENHAIN, conversational programming: path functions";
const PROGRAMS: &str = "HEIDENHAIN, conversational programming: fundamentals";
const LABELS: &str =
    "HEIDENHAIN, conversational programming: subprograms and program-section repeats";
const PARAMETERS: &str = "HEIDENHAIN, conversational programming: Q parameters";
const CYCLES: &str = "HEIDENHAIN, cycle programming";
const AXES: &str = "HEIDENHAIN, conversational programming: multiple-axis machining";
const MISCELLANEOUS: &str = "HEIDENHAIN, conversational programming: miscellaneous functions";

const ROUNDED: Treatment = Refused {
    reason: "the control rounds or breaks the corner between two blocks",
    remedy: "let the CAM system write arcs and lines",
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

const fn row_of(name: &'static str, treatment: Treatment, source: &'static str) -> StatementRow {
    StatementRow {
        name,
        treatment,
        source,
    }
}

/// What is done with each statement of Heidenhain's conversational language. A statement that is not here is refused with its
/// line. Miscellaneous functions that are not here are the machine builder's: carried, with a remark.
#[rustfmt::skip]
pub const HEIDENHAIN_STATEMENTS: &[StatementRow] = &[
    row_of("BEGIN", Understood, PROGRAMS),
    row_of("END", Understood, PROGRAMS),
    row_of("BLK", Carried, PROGRAMS),
    row_of("TOOL", Understood, PROGRAMS),
    row_of("STOP", Carried, PROGRAMS),
    row_of("L", Understood, PATHS),
    row_of("LP", Understood, PATHS),
    row_of("LN", Understood, AXES),
    row_of("CC", Understood, PATHS),
    row_of("C", Understood, PATHS),
    row_of("CP", Understood, PATHS),
    row_of("CR", Understood, PATHS),
    row_of("CT", Understood, PATHS),
    row_of("CTP", Understood, PATHS),
    row_of("RND", ROUNDED, PATHS),
    row_of("CHF", ROUNDED, PATHS),
    row_of("APPR", APPROACH, PATHS),
    row_of("DEP", APPROACH, PATHS),
    row_of("FPOL", CONTOUR, PATHS),
    row_of("FL", CONTOUR, PATHS),
    row_of("FLT", CONTOUR, PATHS),
    row_of("FC", CONTOUR, PATHS),
    row_of("FCT", CONTOUR, PATHS),
    row_of("FSELECT", CONTOUR, PATHS),
    row_of("SPL", CONTOUR, PATHS),
    row_of("LBL", Understood, LABELS),
    row_of("CALL", Understood, LABELS),
    row_of("SEL", TABLES, LABELS),
    row_of("PATTERN", TABLES, CYCLES),
    row_of("CONTOUR", CONTOUR, CYCLES),
    row_of("FN", Understood, PARAMETERS),
    row_of("Q", Understood, PARAMETERS),
    row_of("QL", Understood, PARAMETERS),
    row_of("QR", Understood, PARAMETERS),
    row_of("QS", Carried, PARAMETERS),
    row_of("CYCL", Understood, CYCLES),
    row_of("CYCLE", Understood, CYCLES),
    row_of("TRANS", Understood, CYCLES),
    row_of("TCH", PROBED, CYCLES),
    row_of("PRESET", TABLES, CYCLES),
    row_of("PLANE", Understood, AXES),
    row_of("FUNCTION", Understood, AXES),
    row_of("M", Understood, MISCELLANEOUS),
    row_of("F", Understood, PATHS),
    row_of("MB", Carried, MISCELLANEOUS),
];

/// The row of a statement's first word.
pub(crate) fn row(letters: &[u8]) -> Option<&'static StatementRow> {
    HEIDENHAIN_STATEMENTS
        .iter()
        .find(|row| row.name.as_bytes() == letters)
}

/// What a miscellaneous function does to the place of the tool.
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
    /// It moves or displaces the tool otherwise.
    Refused(&'static str),
    /// The machine's builder says what it does.
    Unknown,
}

/// What a miscellaneous function is.
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
