//! What is done with each word of APT and CLDATA, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, line};

const ISO: &str = "ISO 4343, NC processor output: postprocessor words";
const APT: &str = "ANSI X3.37, APT";
const NX: &str = "Siemens NX, CLSF commands";
const SW: &str = "SOLIDWORKS CAM, APT CL files (public files)";
const CATIA: &str = "Dassault, CATIA V5 machining: APT output";

const DRIVEN: Treatment = Refused {
    reason: "it drives along geometry, and where it ends the file does not say",
    remedy: "let the CAM system write points (GOTO)",
};
const DISPLACED: Treatment = Refused {
    reason: "it moves or turns all places behind it",
    remedy: "let the CAM system write the places as they are",
};
const REPEATED: Treatment = Refused {
    reason: "it runs statements again or elsewhere",
    remedy: "let the CAM system write the file flat",
};
const TABLE: Treatment = Refused {
    reason: "it turns the table or the head",
    remedy: "divide the file there, or let the CAM system write tool axes (GOTO with six numbers)",
};
const THREAD: Treatment = Refused {
    reason: "its motion is the controller's own cycle",
    remedy: "take it into a file of its own",
};
const HOLES: Treatment = Refused {
    reason: "its motions are the controller's cycle",
    remedy: "let its holes be written as motions: --expand",
};

/// What is done with each word of APT and CLDATA. A word that is not here is refused with its line; words that begin with
/// `CSI_` are carried.
#[rustfmt::skip]
pub const APT_STATEMENTS: &[StatementRow] = &[
    line("GOTO", Understood, APT),
    line("GODLTA", Understood, APT),
    line("FROM", Understood, APT),
    line("GOHOME", Understood, ISO),
    line("RAPID", Understood, ISO),
    line("FEDRAT", Understood, ISO),
    line("UNIT", Understood, SW),
    line("UNITS", Understood, APT),
    line("CIRCLE", Understood, APT),
    line("CYCLE", HOLES, ISO),
    line("CUTCOM", Understood, ISO),
    line("TLCOMP", Understood, ISO),
    line("MULTAX", Understood, APT),
    line("TLAXIS", Understood, APT),
    line("MSYS", Understood, NX),
    line("TRNTYP", Understood, SW),
    line("CSYS", Carried, SW),
    line("LOAD", Understood, ISO),
    line("LOADTL", Understood, ISO),
    line("TOOLNO", Understood, CATIA),
    line("TLON", Understood, APT),
    line("AUTOPS", Carried, APT),
    line("INDIRV", Carried, APT),
    line("INDIRP", Carried, APT),
    line("INTOL", Carried, APT),
    line("OUTTOL", Carried, APT),
    line("TOLER", Carried, APT),
    line("CUTTER", Carried, APT),
    line("PARTNO", Carried, APT),
    line("PPRINT", Carried, ISO),
    line("TPRINT", Carried, CATIA),
    line("INSERT", Carried, "ISO 4343: text for the controller as it stands; named in a warning"),
    line("REMARK", Carried, APT),
    line("TITLES", Carried, APT),
    line("LETTER", Carried, ISO),
    line("MACHIN", Carried, ISO),
    line("DISPLY", Carried, ISO),
    line("FINI", Carried, APT),
    line("END", Carried, ISO),
    line("STOP", Carried, ISO),
    line("OPSTOP", Carried, ISO),
    line("OPSKIP", Carried, ISO),
    line("REWIND", Carried, ISO),
    line("DELAY", Carried, ISO),
    line("SPINDL", Understood, ISO),
    line("COOLNT", Carried, ISO),
    line("SELECT", Carried, ISO),
    line("SELCTL", Carried, ISO),
    line("SEQNO", Carried, ISO),
    line("BREAK", Carried, ISO),
    line("LEADER", Carried, ISO),
    line("AUXFUN", Carried, ISO),
    line("PREFUN", Carried, ISO),
    line("PPFUN", Carried, ISO),
    line("CLAMP", Carried, ISO),
    line("MODE", Carried, ISO),
    line("SWITCH", Carried, CATIA),
    line("TURRET", Carried, ISO),
    line("PIVOTZ", Carried, ISO),
    line("MAXDPM", Carried, ISO),
    line("CLPRNT", Carried, APT),
    line("NOPOST", Carried, APT),
    line("SYN", Carried, APT),
    line("RESERV", Carried, APT),
    line("WPLANE", Carried, ISO),
    line("SETUP", Carried, SW),
    line("TOOL PATH", Understood, NX),
    line("TLDATA", Carried, NX),
    line("PAINT", Carried, NX),
    line("END-OF-PATH", Carried, NX),
    line("GO", DRIVEN, APT),
    line("GOFWD", DRIVEN, APT),
    line("GOBACK", DRIVEN, APT),
    line("GOLFT", DRIVEN, APT),
    line("GORGT", DRIVEN, APT),
    line("GOUP", DRIVEN, APT),
    line("GODOWN", DRIVEN, APT),
    line("OFFSET", DRIVEN, APT),
    line("POCKET", DRIVEN, APT),
    line("TLLFT", DRIVEN, APT),
    line("TLRGT", DRIVEN, APT),
    line("PSIS", DRIVEN, APT),
    line("DNTCUT", DRIVEN, APT),
    line("TRACUT", DISPLACED, APT),
    line("COPY", DISPLACED, APT),
    line("TRANS", DISPLACED, ISO),
    line("ORIGIN", DISPLACED, ISO),
    line("PREADJ", DISPLACED, ISO),
    line("MACRO", REPEATED, APT),
    line("TERMAC", REPEATED, APT),
    line("CALL", REPEATED, APT),
    line("CALLSUB", REPEATED, APT),
    line("ENDSUB", REPEATED, APT),
    line("LOOPST", REPEATED, APT),
    line("LOOPND", REPEATED, APT),
    line("JUMPTO", REPEATED, APT),
    line("IF", REPEATED, APT),
    line("ROTABL", TABLE, ISO),
    line("ROTHED", TABLE, ISO),
    line("ROTATE", TABLE, ISO),
    line("TILT", TABLE, ISO),
    line("THREAD", THREAD, ISO),
    line("PROBE", THREAD, ISO),
    line("PITCH", THREAD, ISO),
];

/// The row of a word.
pub(crate) fn row(word: &[u8]) -> Option<&'static StatementRow> {
    APT_STATEMENTS
        .iter()
        .find(|row| row.name.as_bytes().eq_ignore_ascii_case(word))
}
