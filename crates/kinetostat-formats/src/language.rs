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
        "mpf" | "spf" => Some(Language::Siemens),
        "nc" | "cnc" | "tap" | "ngc" | "iso" | "txt" if is_siemens(&beginning) => {
            Some(Language::Siemens)
        }
        _ => None,
    }
}

/// Whether a program that may as well be G-code has lines that only a SINUMERIK reads; in capitals.
fn is_siemens(beginning: &[u8]) -> bool {
    beginning.split(|byte| *byte == b'\n').any(|line| {
        let line = line.trim_ascii();
        let numbered = line
            .strip_prefix(b"N")
            .filter(|rest| rest.first().is_some_and(u8::is_ascii_digit));
        let digits = numbered.map_or(0, |rest| {
            1 + rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
        });
        let words = line[digits..].trim_ascii_start();
        let cycle = words.strip_prefix(b"CYCLE8").is_some_and(|rest| {
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
            digits > 0 && rest.get(digits) == Some(&b'(')
        });
        cycle
            || words.starts_with(b"%_N_")
            || words.starts_with(b"DEF REAL ")
            || words == b"TRAORI"
            || words.starts_with(b"TRAORI(")
            || words.starts_with(b"TRAORI ")
    })
}
