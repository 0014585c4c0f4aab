//! Language of a file, and the registry of languages: a line for each.
//!
//! A language is a folder of this crate: its reader, its writer, its table of statements, and a file `language.rs` with what all other
//! files ask of it ([`ProgramLanguage`]). They ask the [`Language`] of a program, which is one of this list and stands for its entry.

use std::ops::Deref;

use crate::model::Language;
use crate::program_language::ProgramLanguage;

/// Bytes of a file that are looked at for its language.
const LOOKED_AT: usize = 1 << 16;

/// Endings that files in G-code or of other kinds have, too.
const SHARED: [&str; 7] = ["prg", "sys", "sysx", "dat", "sub", "cl", "h"];

/// The language whose files have an ending.
fn by_ending(ending: &str) -> Option<Language> {
    let mut all = Language::ALL.into_iter();
    all.find(|language| language.endings().contains(&ending))
}

/// Reason why a file that [`language_of`] does not know is hardly G-code, and the remedy; `None` if it may be G-code.
///
/// ```
/// use kinetostat_formats::odd_program;
///
/// assert!(odd_program("slot.mod", b"").unwrap().contains("`MODULE`"));
/// assert!(odd_program("slot.txt", b"MODULE A\nENDMODULE\n").unwrap().contains(".mod"));
/// assert!(odd_program("part.urp", &[0x1f, 0x8b]).unwrap().contains(".script"));
/// assert_eq!(odd_program("part.nc", b"G21 G90\n"), None);
/// ```
#[must_use]
pub fn odd_program(name: &str, bytes: &[u8]) -> Option<String> {
    let ending = name
        .rsplit_once('.')
        .map(|(_, ending)| ending.to_ascii_lowercase());
    let unread = Language::ALL.iter().find_map(|language| {
        let mut all = language.unread_endings().iter();
        all.find(|(own, _)| ending.as_deref() == Some(*own))
    });
    if let Some((_, what)) = unread {
        return Some((*what).to_owned());
    }
    let own = ending.filter(|ending| !SHARED.contains(&ending.as_str()));
    let known = own.and_then(|ending| by_ending(&ending));
    let held = known.and_then(|language| Some((language.held_word()?, language.name())));
    if let Some((word, language)) = held {
        return Some(format!(
            "its ending is that of {language}, and no `{word}` stands in it: give the program as the controller saves it"
        ));
    }
    let beginning = bytes[..bytes.len().min(LOOKED_AT)].to_ascii_uppercase();
    let holds = |word: &str| {
        let mut parts = beginning.windows(word.len());
        parts.any(|part| part == word.as_bytes())
    };
    let known = Language::ALL.iter().find_map(|language| {
        let mut own = language.own_words().iter();
        let found = own.find(|(word, _)| holds(word))?;
        Some((language.name(), found.1))
    });
    known.map(|(language, ending)| {
        format!(
            "it looks like {language}, and its ending is not .{ending}: give the file that ending"
        )
    })
}

/// The language of a file by the ending of its name and what stands in it; `None` where it is none of these languages.
///
/// ```
/// use kinetostat_formats::{Language, language_of};
///
/// assert_eq!(language_of("Path_10.mod", b"MODULE Path_10\n"), Some(Language::Rapid));
/// assert_eq!(language_of("poses.csv", b"x_mm,y_mm,z_mm\n"), Some(Language::Poses));
/// assert_eq!(language_of("PART.H", b"0 BEGIN PGM PART MM\n"), Some(Language::Heidenhain)); // and no header of C
/// assert_eq!(language_of("part.prg", b"%\nG21 G90\n"), None); // G-code has this ending, too
/// ```
#[must_use]
pub fn language_of(name: &str, bytes: &[u8]) -> Option<Language> {
    let ending = name.rsplit_once('.')?.1.to_ascii_lowercase();
    let beginning = bytes[..bytes.len().min(LOOKED_AT)].to_ascii_uppercase();
    let holds = |word: &str| {
        beginning
            .windows(word.len())
            .any(|part| part == word.as_bytes())
    };
    if let Some(language) = by_ending(&ending) {
        let is_held = language.held_word().is_none_or(holds);
        return is_held.then_some(language);
    }
    let shared = ["nc", "cnc", "tap", "ngc", "iso", "txt"].contains(&ending.as_str());
    let mut all = Language::ALL.into_iter().filter(|_| shared);
    all.find(|language| language.is_beginning(&beginning))
}

/// Gives a macro the languages in the order in which they are listed: the name of each in code, in words, and its entry.
macro_rules! each_language {
    ($made:ident) => {
        $made! {
            Rapid, "ABB RAPID.", crate::rapid::language::RapidLanguage;
            Krl, "KUKA KRL.", crate::krl::language::KrlLanguage;
            FanucLs, "FANUC TP programs as text.", crate::ls::language::LsLanguage;
            Apt, "APT and CLDATA.", crate::apt::language::AptLanguage;
            Siemens, "SINUMERIK 840D.", crate::siemens::language::SiemensLanguage;
            Heidenhain, "Heidenhain conversational.", crate::heidenhain::language::HeidenhainLanguage;
            Val3, "Staubli VAL3.", crate::val3::language::Val3Language;
            UrScript, "Universal Robots URScript.", crate::urscript::dialect::URSCRIPT;
            Poses, "Lists of poses: tables (CSV) and YAML.", crate::poses::language::PosesLanguage;
        }
    };
}

macro_rules! entries {
    ($($name:ident, $words:literal, $entry:expr;)*) => {
        /// Facts and acts of a language, as its folder states them.
        impl Deref for Language {
            type Target = dyn ProgramLanguage;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$name => &$entry,)*
                }
            }
        }
    };
}

each_language!(entries);
