//! Treatment of each word of APT and CLDATA.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows};

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

/// Treatment of each word of APT and CLDATA. A word that is not listed is refused with its line; words that begin with `CSI_` are carried.
pub const APT_STATEMENTS: &[StatementRow] = &rows::<{ count(GROUPS) }>(GROUPS);

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, APT, &["GOTO", "GODLTA", "FROM"]),
    alike(Understood, ISO, &["GOHOME", "RAPID", "FEDRAT"]),
    alike(Understood, SW, &["UNIT"]),
    alike(Understood, APT, &["UNITS", "CIRCLE"]),
    alike(HOLES, ISO, &["CYCLE"]),
    alike(Understood, ISO, &["CUTCOM", "TLCOMP"]),
    alike(Understood, APT, &["MULTAX", "TLAXIS"]),
    alike(Understood, NX, &["MSYS"]),
    alike(Understood, SW, &["TRNTYP"]),
    alike(Carried, SW, &["CSYS"]),
    alike(Understood, ISO, &["LOAD", "LOADTL"]),
    alike(Understood, CATIA, &["TOOLNO"]),
    alike(Understood, APT, &["TLON"]),
    alike(Carried, APT, &[
        "AUTOPS", "INDIRV", "INDIRP", "INTOL", "OUTTOL", "TOLER", "CUTTER", "PARTNO",
    ]),
    alike(Carried, ISO, &["PPRINT"]),
    alike(Carried, CATIA, &["TPRINT"]),
    alike(Carried, "ISO 4343: text for the controller as it stands; named in a warning", &["INSERT"]),
    alike(Carried, APT, &["REMARK", "TITLES"]),
    alike(Carried, ISO, &["LETTER", "MACHIN", "DISPLY"]),
    alike(Carried, APT, &["FINI"]),
    alike(Carried, ISO, &["END", "STOP", "OPSTOP", "OPSKIP", "REWIND", "DELAY"]),
    alike(Understood, ISO, &["SPINDL"]),
    alike(Carried, ISO, &[
        "COOLNT", "SELECT", "SELCTL", "SEQNO", "BREAK", "LEADER", "AUXFUN", "PREFUN", "PPFUN",
        "CLAMP", "MODE",
    ]),
    alike(Carried, CATIA, &["SWITCH"]),
    alike(Carried, ISO, &["TURRET", "PIVOTZ", "MAXDPM"]),
    alike(Carried, APT, &["CLPRNT", "NOPOST", "SYN", "RESERV"]),
    alike(Carried, ISO, &["WPLANE"]),
    alike(Carried, SW, &["SETUP"]),
    alike(Understood, NX, &["TOOL PATH"]),
    alike(Carried, NX, &["TLDATA", "PAINT", "END-OF-PATH"]),
    alike(DRIVEN, APT, &[
        "GO", "GOFWD", "GOBACK", "GOLFT", "GORGT", "GOUP", "GODOWN", "OFFSET", "POCKET", "TLLFT",
        "TLRGT", "PSIS", "DNTCUT",
    ]),
    alike(DISPLACED, APT, &["TRACUT", "COPY"]),
    alike(DISPLACED, ISO, &["TRANS", "ORIGIN", "PREADJ"]),
    alike(REPEATED, APT, &[
        "MACRO", "TERMAC", "CALL", "CALLSUB", "ENDSUB", "LOOPST", "LOOPND", "JUMPTO", "IF",
    ]),
    alike(TABLE, ISO, &["ROTABL", "ROTHED", "ROTATE", "TILT"]),
    alike(THREAD, ISO, &["THREAD", "PROBE", "PITCH"]),
];

/// The row of a word.
pub(crate) fn row(word: &[u8]) -> Option<&'static StatementRow> {
    APT_STATEMENTS
        .iter()
        .find(|row| row.name.as_bytes().eq_ignore_ascii_case(word))
}
