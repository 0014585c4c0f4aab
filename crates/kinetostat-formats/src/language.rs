//! Which language a file is written in.

use crate::model::program::Language;

/// Bytes of a file that are looked at for its language.
const LOOKED_AT: usize = 1 << 16;

/// Endings that no file in G-code has, and what a file of the language holds.
const OWN_ENDINGS: [(&[&str], &str, &str); 4] = [
    (&["mod", "modx"], "RAPID", "MODULE"),
    (&["src"], "KRL", "DEF"),
    (&["ls"], "FANUC", "/PROG"),
    (&["apt", "aptsource", "cls", "cldata"], "APT", "GOTO"),
];

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
    let by_ending = OWN_ENDINGS
        .iter()
        .find(|(endings, _, _)| ending.as_deref().is_some_and(|e| endings.contains(&e)));
    if let Some((_, language, word)) = by_ending {
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
    match ending.as_str() {
        "ls" if holds("/PROG") => Some(Language::FanucLs),
        "apt" | "aptsource" | "apt_source" | "cls" | "cl" | "cldata" if holds("GOTO") => {
            Some(Language::Apt)
        }
        "mod" | "modx" | "prg" | "sys" | "sysx" if holds("MODULE") => Some(Language::Rapid),
        "src" | "dat" | "sub" if holds("DEF") => Some(Language::Krl),
        // None of them is ever anything else that is read.
        "csv" | "tsv" | "yaml" | "yml" | "parquet" => Some(Language::Poses),
        "mpf" | "spf" => Some(Language::Siemens),
        "nc" | "cnc" | "tap" | "ngc" | "iso" | "txt" if is_siemens(&beginning) => {
            Some(Language::Siemens)
        }
        "h" if holds("BEGIN PGM") => Some(Language::Heidenhain),
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
