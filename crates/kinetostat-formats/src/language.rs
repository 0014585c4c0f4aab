//! Which language a file is written in.

use crate::model::language::Language;

/// Bytes of a file that are looked at for its language.
const LOOKED_AT: usize = 1 << 16;

/// Endings that files in G-code or of other kinds have, too.
const SHARED: [&str; 7] = ["prg", "sys", "sysx", "dat", "sub", "cl", "h"];

/// Endings of files of a language, in small letters, the usual one first.
///
/// ```
/// use kinetostat_formats::{Language, endings_of};
///
/// assert_eq!(endings_of(Language::Siemens), ["mpf", "spf"]);
/// assert!(Language::ALL.iter().all(|language| !endings_of(*language).is_empty()));
/// ```
#[must_use]
pub const fn endings_of(language: Language) -> &'static [&'static str] {
    match language {
        Language::Rapid => &["mod", "modx", "prg", "sys", "sysx"],
        Language::Krl => &["src", "dat", "sub"],
        Language::FanucLs => &["ls"],
        Language::Apt => &["apt", "cls", "cl", "aptsource", "apt_source", "cldata"],
        Language::Poses => &["csv", "tsv", "yaml", "yml", "parquet"],
        Language::Siemens => &["mpf", "spf"],
        Language::Heidenhain => &["h"],
    }
}

/// What a file of a language holds where its ending alone does not say it, and a short name of the language.
fn held_by(language: Language) -> Option<(&'static str, &'static str)> {
    match language {
        Language::Rapid => Some(("MODULE", "RAPID")),
        Language::Krl => Some(("DEF", "KRL")),
        Language::FanucLs => Some(("/PROG", "FANUC")),
        Language::Apt => Some(("GOTO", "APT")),
        Language::Heidenhain => Some(("BEGIN PGM", "Heidenhain")),
        // None of them is ever anything else that is read.
        Language::Poses | Language::Siemens => None,
    }
}

/// The language whose files have an ending.
fn by_ending(ending: &str) -> Option<Language> {
    let all = Language::ALL.into_iter();
    all.into_iter()
        .find(|language| endings_of(*language).contains(&ending))
}

/// Words in which a language differs from G-code, and the ending that its files have.
const OWN_WORDS: [(&str, &str, &str); 4] = [
    ("ENDMODULE", "RAPID", "mod"),
    ("ENDDAT", "KRL", "dat"),
    ("&ACCESS", "KRL", "src"),
    ("/PROG", "FANUC", "ls"),
];

/// Why a file that [`language_of`] does not know is hardly G-code, and what to do; `None` where it may be.
///
/// ```
/// use kinetostat_formats::odd_program;
///
/// assert!(odd_program("slot.mod", b"").unwrap().contains("`MODULE`"));
/// assert!(odd_program("slot.txt", b"MODULE A\nENDMODULE\n").unwrap().contains(".mod"));
/// assert_eq!(odd_program("part.nc", b"G21 G90\n"), None);
/// ```
#[must_use]
pub fn odd_program(name: &str, bytes: &[u8]) -> Option<String> {
    let ending = name
        .rsplit_once('.')
        .map(|(_, ending)| ending.to_ascii_lowercase());
    let own = ending.filter(|ending| !SHARED.contains(&ending.as_str()));
    let known = own.and_then(|ending| by_ending(&ending));
    if let Some((word, language)) = known.and_then(held_by) {
        return Some(format!(
            "its ending is that of {language}, and no `{word}` stands in it: give the program as the controller saves it"
        ));
    }
    let beginning = bytes[..bytes.len().min(LOOKED_AT)].to_ascii_uppercase();
    let holds = |word: &str| {
        let mut parts = beginning.windows(word.len());
        parts.any(|part| part == word.as_bytes())
    };
    let (_, language, ending) = OWN_WORDS.iter().find(|(word, _, _)| holds(word))?;
    Some(format!(
        "it looks like {language}, and its ending is not .{ending}: give the file that ending"
    ))
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
        let is_held = held_by(language).is_none_or(|(word, _)| holds(word));
        return is_held.then_some(language);
    }
    let shared = ["nc", "cnc", "tap", "ngc", "iso", "txt"].contains(&ending.as_str());
    (shared && is_siemens(&beginning)).then_some(Language::Siemens)
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
