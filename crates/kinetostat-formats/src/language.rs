//! Which language a file is written in.

use crate::model::program::Language;

/// Bytes of a file that are looked at for its language.
const LOOKED_AT: usize = 1 << 16;

/// The language of a file by the ending of its name and what stands in it; `None` where it is none of these languages.
///
/// ```
/// use kinetostat_formats::{Language, language_of};
///
/// assert_eq!(language_of("Path_10.mod", b"MODULE Path_10\n"), Some(Language::Rapid));
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
    match ending.as_str() {
        "ls" if holds("/PROG") => Some(Language::FanucLs),
        "apt" | "aptsource" | "apt_source" | "cls" | "cl" | "cldata" if holds("GOTO") => {
            Some(Language::Apt)
        }
        "mod" | "modx" | "prg" | "sys" | "sysx" if holds("MODULE") => Some(Language::Rapid),
        "src" | "dat" | "sub" if holds("DEF") => Some(Language::Krl),
        "h" if holds("BEGIN PGM") => Some(Language::Heidenhain),
        _ => None,
    }
}
