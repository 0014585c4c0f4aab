//! The languages that are read, and what their writers keep.

use kinetostat_formats::{RAPID_STATEMENTS, StatementRow};

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
    pub(crate) words: Words,
}

/// All of them.
pub(crate) const LANGUAGES: [Language; 2] = [
    Language {
        name: "gcode",
        title: "G-code as LinuxCNC and most controllers read it",
        endings: &["ngc", "nc", "gcode", "tap", "..."],
        written: "Written: numbers in place, further blocks behind the first; 4 decimals in mm (5 in inches) or as --decimals says; lines of at most 250 bytes. A code beside a motion that is divided goes where controllers act on it (see the book).",
        words: Words::Codes,
    },
    Language {
        name: "rapid",
        title: "ABB RAPID",
        endings: &["mod", "modx", "prg", "sys", "sysx"],
        written: "Written: numbers of targets in place, declarations edited or copied under a free name of at most 32 characters, further motions as MoveL with the same speed, tool and work object. A divided motion stops at its end alone; circles that are corrected become straight motions.",
        words: Words::Statements(RAPID_STATEMENTS),
    },
];
