//! The languages that are read, and what their writers keep.

use kinetostat_formats::{
    APT_STATEMENTS, HEIDENHAIN_STATEMENTS, KRL_STATEMENTS, LS_STATEMENTS, Language as Format,
    MakeLanguage, POSES_STATEMENTS, RAPID_STATEMENTS, SIEMENS_STATEMENTS, StatementRow, endings_of,
};

/// Where the table of a language is.
#[derive(Clone, Copy)]
pub(crate) enum Words {
    /// Codes of G-code, with when they act.
    Codes,
    /// Statements of a robot's language.
    Statements(&'static [StatementRow]),
}

/// A language of programs.
pub(crate) struct Language {
    /// As options write it.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) endings: &'static [&'static str],
    /// What is written, in words.
    pub(crate) written: &'static str,
    /// As what programs of other languages are converted to it, if they are.
    pub(crate) made: Option<MakeLanguage>,
    pub(crate) words: Words,
}

/// All of them.
pub(crate) const LANGUAGES: [Language; 8] = [
    Language {
        name: "gcode",
        title: "G-code as LinuxCNC and most controllers read it",
        endings: &["ngc", "nc", "gcode", "tap", "..."],
        written: "Written: numbers in place, further blocks behind the first; 4 decimals in mm (5 in inches) or as --decimals says; lines of at most 250 bytes. A code beside a motion that is divided goes where controllers act on it (see the book).",
        made: Some(MakeLanguage::Gcode),
        words: Words::Codes,
    },
    Language {
        name: "rapid",
        title: "ABB RAPID",
        endings: endings_of(Format::Rapid),
        written: "Written: numbers of targets in place, declarations edited or copied under a free name of at most 32 characters, further motions as MoveL, and of circles as MoveC, with the same speed, tool and work object. External axes are shared out evenly over the motions that one becomes. A divided motion stops at its end alone.",
        made: Some(MakeLanguage::Rapid),
        words: Words::Statements(RAPID_STATEMENTS),
    },
    Language {
        name: "krl",
        title: "KUKA KRL",
        endings: endings_of(Format::Krl),
        written: "Written: numbers in place, in the program or in its data list; points that several motions use copied under a free name of at most 24 characters, with the texts of their FOLDs; further motions as LIN, and of circles as CIRC, with the same approximation. S and T stay as they are; external axes are shared out evenly over the motions that one becomes.",
        made: Some(MakeLanguage::Krl),
        words: Words::Statements(KRL_STATEMENTS),
    },
    Language {
        name: "ls",
        title: "FANUC TP programs as text",
        endings: endings_of(Format::FanucLs),
        written: "Written: numbers of positions in place and in their columns; further motions as L, and of circles as C, with positions of their own at the end of /POS (external axes shared out evenly), lines numbered again and LINE_COUNT raised, since a controller loads only lines that follow one another.",
        made: Some(MakeLanguage::FanucLs),
        words: Words::Statements(LS_STATEMENTS),
    },
    Language {
        name: "apt",
        title: "APT and CLDATA of SolidWorks CAM, NX, CATIA and others",
        endings: endings_of(Format::Apt),
        written: "Written: numbers of GOTO in place, further places as GOTO before it; circles that are corrected become straight motions.",
        made: Some(MakeLanguage::Apt),
        words: Words::Statements(APT_STATEMENTS),
    },
    Language {
        name: "poses",
        title: "lists of poses: tables (CSV, Parquet) and YAML",
        endings: endings_of(Format::Poses),
        written: "Written: numbers in place, in their unit; further poses as copies of the row (CSV, Parquet) or of the item (YAML) before it, with all its other cells and keys. The first pose of a raster stays a motion in air, which is not divided.",
        made: Some(MakeLanguage::Csv),
        words: Words::Statements(POSES_STATEMENTS),
    },
    Language {
        name: "siemens",
        title: "Siemens SINUMERIK 840D",
        endings: endings_of(Format::Siemens),
        written: "Written: numbers in place, the first piece in its block and further ones in blocks behind it, without numbers: N numbers need be neither unique nor complete. Arcs that are corrected become circles through a place (CIP), which may lean, or G1; codes, feeds and places that stay in force are stated again where they would be others; steps (G91, IC) become X=AC(). Blocks of at most 512 characters; file names have at most 24. Programs with jumps, loops, calls, drilling cycles, rounded and broken corners (RND, CHF, CHR) are run once and written flat (--expand).",
        made: None,
        words: Words::Statements(SIEMENS_STATEMENTS),
    },
    Language {
        name: "heidenhain",
        title: "Heidenhain conversational programs of TNC 426 to TNC 640",
        endings: endings_of(Format::Heidenhain),
        written: "Written: numbers in place with the file's signs, at most 4 decimals in mm and 5 in inches, as the control takes them (from -99999.9999 to 99999.9999); a coordinate that a block took over from a corrected one is stated. Further blocks stand before the block, with its feed and radius compensation; a function acts on the first or the last of them as it acts on a block. Circles that are corrected become circles about centres of their own (CC and C), helices where they rise (CP with IPA and IZ), or L blocks where neither follows; the program's pole is stated again where a block counts from it. Polar lines become L blocks. LN blocks are divided with surface normals and tool directions between those of the program; a corrected direction is stated (TX, TY, TZ) as long as it differs. Where a file numbers its blocks and gets further ones, all are numbered again. Programs with labels, Q parameters, jumps, drilling cycles and rounded corners (RND, an arc of its own then) are written flat first (--expand): at most 5 million blocks.",
        made: None,
        words: Words::Statements(HEIDENHAIN_STATEMENTS),
    },
];
