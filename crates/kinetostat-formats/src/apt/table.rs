//! Treatment of each word of APT and CLDATA, and the CAM system of a file, recognised by its first statements.

use crate::apt::lines::Statement;
use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows};
use crate::text::source::SourceFile;

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

/// Files that differ in what the same words mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dialect {
    /// SOLIDWORKS CAM, CAMWorks: `CIRCLE` with six numbers, right-handed about its axis.
    SolidworksCam,
    /// Siemens NX: `TOOL PATH`, `MSYS`; `CIRCLE` with eleven numbers, left-handed about its axis.
    Nx,
    /// CATIA V5: arcs as `TLON`.
    Catia,
    /// PTC Creo, Pro/ENGINEER.
    Creo,
    /// Any other.
    Other,
}

/// Statements that are looked at.
const FIRST: usize = 64;

impl Dialect {
    /// Dialect of a file.
    pub(crate) fn of(file: &SourceFile, statements: &[Statement]) -> Self {
        let first = statements.iter().take(FIRST);
        let words: Vec<&[u8]> = first.map(|statement| file.part(&statement.word)).collect();
        let has = |names: &[&[u8]]| {
            words
                .iter()
                .any(|word| names.iter().any(|name| word.eq_ignore_ascii_case(name)))
        };
        let head = &file.bytes()[..file.bytes().len().min(2000)];
        match () {
            () if has(&[b"TOOL PATH", b"MSYS", b"TLDATA", b"PAINT"]) => Self::Nx,
            () if has(&[b"TRNTYP", b"CSYS", b"CSI_SET_FLUTE_LENGTH"]) => Self::SolidworksCam,
            () if head.windows(5).any(|part| part == b"CATIA") => Self::Catia,
            () if head.windows(10).any(|part| part == b"Pro/CLfile") => Self::Creo,
            () => Self::Other,
        }
    }

    /// The system's name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::SolidworksCam => "SOLIDWORKS CAM",
            Self::Nx => "Siemens NX",
            Self::Catia => "CATIA",
            Self::Creo => "PTC Creo",
            Self::Other => "no system that is known by its words",
        }
    }

    /// Sense of an arc about the axis that `CIRCLE` states: 1 right-handed, -1 left-handed; `None` if unknown.
    ///
    /// SOLIDWORKS CAM: 1605 arcs of 8 public files fit no other sense. NX: its manual, CLSF, `CIRCLE`, says "the axis vector
    /// (assuming a clockwise direction)", and 327 arcs of 3 public files fit no other.
    pub(crate) fn sense(self) -> Option<f64> {
        match self {
            Self::SolidworksCam => Some(1.0),
            Self::Nx => Some(-1.0),
            Self::Catia | Self::Creo | Self::Other => None,
        }
    }

    /// Remedy: CAM setting that writes points in place of arcs.
    pub(crate) fn points(self) -> &'static str {
        match self {
            Self::Creo => {
                "let Creo write points in place of arcs (manufacturing parameter CIRC_INTERPOLATION: POINTS_ONLY)"
            }
            _ => "let the CAM system write points",
        }
    }
}
