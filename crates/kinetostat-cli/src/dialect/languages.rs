//! The languages that are read, and what their writers keep.

use kinetostat_formats::{Language as Format, MakeLanguage, StatementRow};

/// Source of a language's table of statements.
#[derive(Clone, Copy)]
pub(crate) enum Words {
    /// Codes of G-code, with when they act.
    Codes,
    /// Statements of a robot's language.
    Statements(&'static [StatementRow]),
}

/// A language of programs.
pub(crate) struct Language {
    /// Name in options.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) endings: &'static [&'static str],
    /// Description of the output.
    pub(crate) written: &'static str,
    /// Target language of conversions to it, if there are any.
    pub(crate) made: Option<MakeLanguage>,
    pub(crate) words: Words,
}

const GCODE: Language = Language {
    name: "gcode",
    title: "G-code as LinuxCNC and most controllers read it",
    endings: &["ngc", "nc", "gcode", "tap", "..."],
    written: "Written: numbers in place, further blocks behind the first; 4 decimals in mm (5 in inches) or as --decimals says; lines of at most 250 bytes. A code beside a motion that is divided goes where controllers act on it (see the book).",
    made: Some(MakeLanguage::Gcode),
    words: Words::Codes,
};

/// All of them.
pub(crate) fn languages() -> impl Iterator<Item = Language> {
    let others = Format::ALL.into_iter().map(|language| Language {
        name: language.word(),
        title: language.title(),
        endings: language.endings(),
        written: language.written(),
        made: MakeLanguage::of(Some(language)),
        words: Words::Statements(language.statements()),
    });
    std::iter::once(GCODE).chain(others)
}
