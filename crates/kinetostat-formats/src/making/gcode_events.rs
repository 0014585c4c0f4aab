//! The words of a program in G-code that are no motion.

use std::collections::BTreeSet;

use kinetostat_program::{Path, PauseKind};

use crate::making::events::{EventKind, SourceEvent};
use crate::making::words::{InForce, Said, Word, Words, kind_of_m, word_of_m};

/// The events of a program in G-code.
#[must_use]
pub fn events_of_gcode(program: &kinetostat_program::Program, path: &Path) -> Vec<SourceEvent> {
    let moving: BTreeSet<usize> = path.moves.iter().map(|motion| motion.line).collect();
    let mut events = Vec::new();
    for line in 1..=program.line_count() {
        let Some(bytes) = program.line_bytes(line) else {
            continue;
        };
        let words = rest_of(bytes, moving.contains(&line));
        let first = path.pauses.partition_point(|pause| pause.line < line);
        let dwell_s = path.pauses[first..]
            .iter()
            .find_map(|pause| match pause.kind {
                PauseKind::DwellSeconds(seconds) if pause.line == line => Some(seconds),
                _ => None,
            });
        let force = InForce {
            dwell_s,
            spindle: Some(path.spindle_on(line)),
        };
        events.extend(words.events(line, force));
    }
    events
}

/// True if a word acts after the motion of its block.
///
/// Controllers disagree about M5 and M9 beside a motion: where one moves they come behind it, since a spindle that stops while
/// the tool still cuts does harm, a little later does none.
fn is_late(letter: char, value: f64, moves: bool) -> bool {
    let late: &[f64] = match moves {
        true => &[0.0, 1.0, 60.0, 2.0, 30.0, 5.0, 9.0],
        false => &[0.0, 1.0, 60.0, 2.0, 30.0],
    };
    letter == 'M' && late.contains(&value)
}

/// G codes that are all in the places and feeds of the moves, times ten.
const FOLLOWED: [u32; 35] = [
    0, 10, 20, 30, 170, 180, 190, 200, 210, 280, 300, 400, 530, 540, 550, 560, 570, 580, 590, 591,
    592, 593, 610, 611, 640, 800, 900, 910, 901, 911, 920, 930, 940, 950, 970,
];

/// Words of a block that are no motion.
fn rest_of(bytes: &[u8], moves: bool) -> Words {
    let text = String::from_utf8_lossy(bytes);
    let mut words = Vec::new();
    let mut said = Vec::new();
    let mut rest = text.trim();
    let mut dwells = false;
    while let Some(first) = rest.chars().next() {
        match first {
            '(' => {
                let end = rest.find(')').map_or(rest.len(), |at| at + 1);
                words.push(rest[..end].to_owned());
                said.push(Said::early(EventKind::Comment, Word::Other, &rest[..end]));
                rest = &rest[end..];
            }
            ';' => {
                let comment = rest[1..].trim();
                if !comment.is_empty() {
                    words.push(comment.to_owned());
                    said.push(Said::early(EventKind::Comment, Word::Other, comment));
                }
                rest = "";
            }
            letter if letter.is_ascii_alphabetic() => {
                let tail = &rest[1..];
                let inside =
                    |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ' ' | '\t');
                let end = tail.find(|c| !inside(c)).unwrap_or(tail.len());
                let number: String = tail[..end].chars().filter(|c| !c.is_whitespace()).collect();
                let Ok(value) = number.parse::<f64>() else {
                    // Text behind a code, as in M117 hello.
                    words.push(rest.to_owned());
                    break;
                };
                let letter = letter.to_ascii_uppercase();
                dwells |= letter == 'G' && value == 4.0;
                if let Some(kind) = kind_of(letter, value, dwells) {
                    let text = format!("{letter}{number}");
                    words.push(text.clone());
                    said.push(Said {
                        is_late: is_late(letter, value, moves),
                        ..Said::early(kind, word_of(letter, value, kind), text)
                    });
                }
                rest = &tail[end..];
            }
            other => rest = &rest[other.len_utf8()..],
        }
        rest = rest.trim_start();
    }
    Words {
        text: words.join(" "),
        said,
        is_optional: text.trim_start().starts_with('/'),
    }
}

/// Action of a word that other languages share.
fn word_of(letter: char, value: f64, kind: EventKind) -> Word {
    match (letter, whole(value)) {
        ('M', Some(number)) => word_of_m(number),
        ('S', _) | ('G', Some(97)) => Word::Spindle,
        _ if kind == EventKind::Dwell => Word::Dwell,
        _ => Word::Other,
    }
}

fn whole(value: f64) -> Option<u32> {
    (value.fract() == 0.0 && (0.0..1e9).contains(&value)).then_some(value as u32)
}

/// Subject of a word; `None` if it is part of a motion.
fn kind_of(letter: char, value: f64, dwells: bool) -> Option<EventKind> {
    let tenths = (10.0 * value).round();
    match letter {
        'G' if tenths == 40.0 => Some(EventKind::Dwell),
        'G' if (430.0..=432.0).contains(&tenths) || tenths == 490.0 => Some(EventKind::Tool),
        'G' if (960.0..=970.0).contains(&tenths) => Some(EventKind::Spindle),
        'G' if tenths >= 0.0 && FOLLOWED.contains(&(tenths as u32)) => None,
        'P' | 'X' | 'U' if dwells => Some(EventKind::Dwell),
        'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'A' | 'B' | 'C' | 'E' | 'U' | 'V'
        | 'W' => None,
        // The number of a program.
        'O' => Some(EventKind::Comment),
        'S' => Some(EventKind::Spindle),
        'T' | 'H' | 'D' => Some(EventKind::Tool),
        'M' => Some(whole(value).map_or(EventKind::Other, kind_of_m)),
        _ => Some(EventKind::Other),
    }
}
