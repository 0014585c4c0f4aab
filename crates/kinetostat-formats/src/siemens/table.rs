//! Treatment of each word of the SINUMERIK 840D.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, rows};

const FUNDAMENTALS: &str = "Siemens, SINUMERIK 840D sl / 828D, Programming Manual Fundamentals";
const WORK: &str = "Siemens, SINUMERIK 840D sl / 828D, Programming Manual Job Planning";
const CYCLES: &str = "Siemens, SINUMERIK 840D sl / 828D, Programming Manual Cycles";

const FLAT: Treatment = Refused {
    reason: "what runs depends on it",
    remedy: "let the program be run once and written flat: --expand",
};
const DRILL: Treatment = Refused {
    reason: "its motions are the controller's cycle",
    remedy: "let the cycle be written as blocks: --expand",
};
const CYCLE: Treatment = Refused {
    reason: "its motions are the controller's cycle, which is not followed",
    remedy: "let the CAM system write its motions as blocks",
};
const SWIVEL: Treatment = Refused {
    reason: "it turns the table or the head, and the frame with it",
    remedy: "divide the program there, and state each frame, or let the CAM system write it with TRAORI",
};
const SPLINE: Treatment = Refused {
    reason: "it is neither a line nor an arc",
    remedy: "let the CAM system write lines and arcs (G1, G2, G3, CIP)",
};
const CORNER: Treatment = Refused {
    reason: "the control rounds or breaks the corner to the next block",
    remedy: "let the corner be written as a block of its own: --expand",
};
const CONTOUR: Treatment = Refused {
    reason: "it adds to the contour what no coordinates say",
    remedy: "let the CAM system write the contour out",
};
const POLAR: Treatment = Refused {
    reason: "polar coordinates are not followed",
    remedy: "let the CAM system write X, Y, Z",
};
const THREAD: Treatment = Refused {
    reason: "feed and spindle go together",
    remedy: "take the thread into a program of its own",
};
const MIRRORED: Treatment = Refused {
    reason: "it mirrors or scales the path",
    remedy: "let the CAM system write the path as it is cut",
};
const SHIFTED: Treatment = Refused {
    reason: "it changes one part of the frame alone",
    remedy: "state the frame by TRANS, ATRANS, ROT, AROT",
};
const TRANSFORMED: Treatment = Refused {
    reason: "the machine's axes are not those of the part then",
    remedy: "give a program of three axes, or one with TRAORI",
};
const BESIDE: Treatment = Refused {
    reason: "it acts beside the blocks, whenever its condition holds",
    remedy: "take it out, if it does not move the tool",
};
const OTHER: Treatment = Refused {
    reason: "from here the program is read by another dialect",
    remedy: "give the parts as programs of their own",
};
const LEAN: Treatment = Refused {
    reason: "the tool leans from a surface that is not known here",
    remedy: "let the CAM system write the tool's direction (A3, B3, C3)",
};
const PASSED: Treatment = Refused {
    reason: "how fast the tool goes between the ends is not known",
    remedy: "write FNORM, and feeds by G94",
};
const UNFOLLOWED: Treatment = Refused {
    reason: "it may move the tool or its frame, and is not followed",
    remedy: "take it out, if it does neither",
};
const INVERSE: Treatment = Refused {
    reason: "the feed is one over the time of each block (G93)",
    remedy: "let the CAM system write feeds in mm/min (G94)",
};

/// Cycles whose way is the control's own: with a tap in its chuck or in compensating one, and borings.
pub(crate) const KEPT: [&str; 7] = [
    "CYCLE84", "CYCLE840", "CYCLE85", "CYCLE86", "CYCLE87", "CYCLE88", "CYCLE89",
];

/// Treatment of each word of a SINUMERIK program. A word that is not listed is refused with its line; M, H and S words and variables are carried.
pub const SIEMENS_STATEMENTS: &[StatementRow] = &rows::<{ count(GROUPS) }>(GROUPS);

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, FUNDAMENTALS, &[
        "G0", "G1", "G2", "G3", "CIP", "X", "Y", "Z", "I", "J", "K", "I1", "J1", "K1", "CR", "AR",
        "AC", "IC", "DC", "ACP", "ACN", "G17", "G18", "G19", "G70", "G71", "G700", "G710", "G90",
        "G91",
    ]),
    alike(INVERSE, FUNDAMENTALS, &["G93"]),
    alike(Understood, FUNDAMENTALS, &[
        "G94", "G95", "F", "G4", "G9", "G60", "G64", "G641", "G642", "G643", "G644", "G645", "G40",
        "G41", "G42", "G53", "G153", "SUPA", "G54", "G55", "G56", "G57", "G500", "G505", "G599",
        "G74", "G75", "T", "D", "M6", "M2", "M17", "M30", "RET", "TRANS", "ATRANS", "ROT", "AROT",
        "RPL",
    ]),
    alike(Understood, WORK, &[
        "TRAORI", "TRAFOOF", "A2", "B2", "C2", "A3", "B3", "C3", "ORIWKS", "ORIMKS", "ORIEULER",
        "ORIRPY",
    ]),
    alike(Understood, FUNDAMENTALS, &["A", "B", "C", "U", "V", "W", "Q", "E"]),
    alike(Understood, WORK, &["DEF"]),
    alike(Understood, FUNDAMENTALS, &["R"]),
    alike(Understood, WORK, &["PROC"]),
    alike(Carried, WORK, &["SAVE", "EXTERN"]),
    alike(Carried, FUNDAMENTALS, &[
        "N", "M", "S", "H", "G25", "G26", "G96", "G961", "G97", "G971", "G450", "G451", "G601",
        "G602", "G603",
    ]),
    alike(Carried, WORK, &["G290"]),
    alike(Carried, FUNDAMENTALS, &[
        "LIMS", "SPOS", "SPOSA", "SPCON", "SPCOF", "SETMS", "WAITS", "DIAMOF",
    ]),
    alike(Carried, WORK, &["FNORM"]),
    alike(Understood, FUNDAMENTALS, &["FGROUP"]),
    alike(Carried, FUNDAMENTALS, &["FGREF", "CFC", "CFTCP", "CFIN"]),
    alike(Carried, WORK, &["FFWON", "FFWOF"]),
    alike(Carried, FUNDAMENTALS, &[
        "SOFT", "SOFTA", "BRISK", "BRISKA", "DRIVE", "DRIVEA", "DYNNORM", "DYNPOS", "DYNROUGH",
        "DYNSEMIFIN", "DYNFINISH", "DYNPREC", "ADIS", "ADISPOS",
    ]),
    alike(Carried, WORK, &["CTOL", "OTOL", "ATOL"]),
    alike(Carried, FUNDAMENTALS, &["ACC", "OVR"]),
    alike(Carried, WORK, &[
        "COMPON", "COMPOF", "COMPCURV", "COMPCAD", "COMPSURF", "UPATH", "SPATH",
    ]),
    alike(Carried, FUNDAMENTALS, &["RTLION", "RTLIOF", "NORM", "KONT", "CDOF", "CDOF2", "CDON"]),
    alike(Carried, WORK, &["CUT2D", "CUT2DF"]),
    alike(Understood, WORK, &["ORIAXES", "ORIVECT", "ORIPLANE"]),
    alike(Carried, WORK, &["ORISON", "ORISOF", "OSOF", "OSC", "OSD", "OST", "OSS", "OSSE"]),
    alike(Carried, FUNDAMENTALS, &["TOROTOF", "PAROTOF", "WALIMON", "WALIMOF"]),
    alike(Carried, WORK, &["STOPRE", "STARTFIFO", "STOPFIFO", "FIFOCTRL"]),
    alike(Carried, FUNDAMENTALS, &["MSG"]),
    alike(Carried, WORK, &["GROUP_BEGIN", "GROUP_END"]),
    alike(Carried, CYCLES, &["WORKPIECE", "CYCLE832"]),
    alike(Carried, WORK, &[
        "SBLON", "SBLOF", "DISPLON", "DISPLOF", "CANCEL", "SETAL", "WRITE", "GETD", "GET",
        "RELEASE",
    ]),
    alike(SWIVEL, CYCLES, &["CYCLE800"]),
    alike(FLAT, WORK, &[
        "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR", "REPEAT", "REPEATB", "UNTIL",
        "LOOP", "ENDLOOP", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "CASE", "CALL", "L", "P",
    ]),
    alike(DRILL, CYCLES, &["MCALL", "CYCLE81", "CYCLE82", "CYCLE83", "HOLES1", "HOLES2"]),
    alike(Carried, CYCLES, &KEPT),
    alike(CYCLE, CYCLES, &[
        "CYCLE90", "CYCLE60",
        "CYCLE61", "CYCLE62", "CYCLE63", "CYCLE64", "CYCLE70", "CYCLE71", "CYCLE72", "CYCLE73",
        "CYCLE74", "CYCLE75", "CYCLE76", "CYCLE77", "CYCLE78", "CYCLE79", "CYCLE801", "CYCLE802",
        "CYCLE899", "CYCLE92", "CYCLE93", "CYCLE94", "CYCLE95", "CYCLE951", "CYCLE97",
        "CYCLE98", "CYCLE977", "CYCLE978", "POCKET1", "POCKET2", "POCKET3",
        "POCKET4", "SLOT1", "SLOT2", "LONGHOLE",
    ]),
    alike(SPLINE, FUNDAMENTALS, &["CT", "TURN"]),
    alike(SPLINE, WORK, &["ASPLINE", "BSPLINE", "CSPLINE", "POLY"]),
    alike(SPLINE, FUNDAMENTALS, &["INVCW", "INVCCW"]),
    alike(CORNER, FUNDAMENTALS, &["CHF", "CHR", "RND"]),
    alike(CONTOUR, FUNDAMENTALS, &["FRC", "FRCM", "RNDM", "ANG", "OFFN"]),
    alike(POLAR, FUNDAMENTALS, &["G110", "G111", "G112", "AP", "RP"]),
    alike(THREAD, FUNDAMENTALS, &["G33", "G63", "G331", "G332"]),
    alike(MIRRORED, FUNDAMENTALS, &["SCALE", "ASCALE", "MIRROR", "AMIRROR"]),
    alike(SHIFTED, FUNDAMENTALS, &["G58", "G59", "ROTS", "AROTS", "CROTS"]),
    alike(SWIVEL, FUNDAMENTALS, &["TOFRAME", "TOROT", "PAROT"]),
    alike(TRANSFORMED, WORK, &["TRANSMIT", "TRACYL", "TRAANG", "TRAFOON"]),
    alike(TRANSFORMED, FUNDAMENTALS, &["DIAMON", "DIAM90"]),
    alike(CONTOUR, WORK, &["CUT3DC", "CUT3DF", "CUT3DFF"]),
    alike(LEAN, WORK, &[
        "LEAD", "TILT", "A4", "B4", "C4", "A5", "B5", "C5", "ORIPATH", "ORICURVE", "ORICONCW",
        "ORICONCCW",
    ]),
    alike(PASSED, WORK, &["FLIN", "FCUB"]),
    alike(PASSED, FUNDAMENTALS, &["FB", "G931"]),
    alike(BESIDE, WORK, &["WHEN", "WHENEVER", "EVERY", "DO", "ID", "IDS", "SETINT", "DEFINE"]),
    alike(BESIDE, FUNDAMENTALS, &["POS", "POSA", "POSP"]),
    alike(BESIDE, WORK, &["MEAS", "MEAW"]),
    alike(UNFOLLOWED, WORK, &[
        "EXTCALL", "EXECTAB", "EXECUTE", "CONTPRON", "CONTDCON", "TANG", "TANGON", "TANGOF",
        "TANGDEL", "TRAILON", "TRAILOF", "LEADON", "LEADOF", "COUPDEF", "COUPON", "COUPONC",
        "COUPOF", "COUPOFS", "COUPDEL", "COUPRES", "CPON", "CPOF", "EGDEF", "EGON", "EGONSYN",
        "EGONSYNE", "EGOFS", "EGOFC", "EGDEL", "TRACON", "GEOAX", "AXSWAP", "CORROF", "DRFOF",
        "PRESETON", "PRESETONS", "FTOCON", "FTOCOF", "PUTFTOC", "PUTFTOCF", "TOFFON", "TOFFOF",
        "CUTMOD", "TOOLENV", "DELTOOLENV", "TCA", "CTABDEF", "CTABEND", "LFON", "LFOF", "LFTXT",
        "LFWP", "LFPOS", "LIFTFAST", "TOFRAMEX", "TOFRAMEY", "TOFRAMEZ", "TOROTX", "TOROTY",
        "TOROTZ", "TCOABS", "TCOFR", "TCOFRX", "TCOFRY", "TCOFRZ", "REPOSA", "REPOSL", "REPOSQ",
        "REPOSH", "REPOSHA", "REPOSQA", "RMB", "RMI", "RME", "RMN", "PON", "SON", "PONS", "SONS",
        "PDELAYON", "SYNFCT", "AXTOCHAN", "OSCILL", "FOCON", "FOCOF", "FXS", "PTP", "PTPG0",
        "ORIROTA", "ORIROTR", "ORIROTT", "ORIROTC", "ORIPATHS", "ORICONTO", "ORICONIO", "ORIVIRT1",
        "ORIVIRT2", "ORIRPY2", "ORIEULER2", "KONTC", "KONTT", "CUTCONON", "TOWMCS", "TOWWCS",
        "TOWBCS", "TOWTCS", "TOWKCS", "MASLDEF", "MASLDEL", "MASLON", "MASLOF", "MASLOFS",
        "ISOCALL", "FPRAON", "DIAM90A", "DIAMCHANA", "GFRAME",
    ]),
    alike(Carried, WORK, &[
        "MMC", "NEWCONF", "INIT", "START", "WAITM", "WAITMC", "WAITE", "SETM", "CLEARM", "EXTOPEN",
        "EXTCLOSE", "ENABLE", "DISABLE", "CLRINT", "LOCK", "UNLOCK", "RESETMON", "SPOF",
        "IPOBRKA", "FINEA", "COARSEA", "IPOENDA", "DELAYFSTON", "DELAYFSTOF", "STOPREOF", "CP",
        "CUTCONOF", "TOWSTD", "FPRAOF", "FENDNORM", "CPRECON", "CPRECOF", "BNAT", "BTAN", "BAUTO",
        "ENAT", "ETAN", "EAUTO",
    ]),
    alike(OTHER, WORK, &["G291"]),
];

/// Words of how motions run, in groups of which one is in force: path mode, acceleration, orientation, corners.
#[rustfmt::skip]
pub(crate) const MODES: &[&[&str]] = &[
    &["G9"], &["G60", "G64", "G641", "G642", "G643", "G644", "G645"], &["G601", "G602", "G603"],
    &["ADIS"], &["ADISPOS"], &["CYCLE832"], &["CTOL"], &["OTOL"], &["ATOL"], &["FFWON", "FFWOF"],
    &["SOFT", "BRISK", "DRIVE"], &["SOFTA"], &["BRISKA"], &["DRIVEA"], &["ACC"],
    &["DYNNORM", "DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH", "DYNPREC"],
    &["COMPON", "COMPOF", "COMPCURV", "COMPCAD", "COMPSURF"], &["UPATH", "SPATH"],
    &["ORIAXES", "ORIVECT", "ORIPLANE"], &["ORIWKS", "ORIMKS"], &["ORIEULER", "ORIRPY"],
    &["ORISON", "ORISOF"], &["OSOF", "OSC", "OSD", "OST", "OSS", "OSSE"],
    &["G450", "G451"], &["CFC", "CFTCP", "CFIN"], &["NORM", "KONT"], &["CUT2D", "CUT2DF"],
    &["CDOF", "CDOF2", "CDON"], &["RTLION", "RTLIOF"], &["FGROUP"], &["FGREF"], &["FNORM"],
];

/// The row of a word, in capitals. Frames of G505 to G599 have one row, and so have those of a grinding wheel (GFRAME1) and cycles that are not listed.
pub(crate) fn row(word: &str) -> Option<&'static StatementRow> {
    let of_word = |word: &str| SIEMENS_STATEMENTS.iter().find(|row| row.name == word);
    let is_cycle = (word.strip_prefix("CYCLE"))
        .is_some_and(|rest| rest.bytes().all(|byte| byte.is_ascii_digit()) && !rest.is_empty());
    let family = match word.starts_with("GFRAME") {
        true => Some("GFRAME"),
        false => is_cycle.then_some("CYCLE90"),
    };
    of_word(word).or_else(|| of_word(family?))
}
