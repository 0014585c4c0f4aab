//! The words of a program in G-code that are no motion.

use std::collections::BTreeSet;

use kinetostat_program::{Path, PauseKind, SpeedMode, Spindle, SpindleRotation};

use crate::making::action::{Coolant, EventAction};
use crate::making::event_kind::EventKind;
use crate::making::events::SourceEvent;

/// The events of a program in G-code.
#[must_use]
pub fn events_of_gcode(program: &kinetostat_program::Program, path: &Path) -> Vec<SourceEvent> {
    let moving: BTreeSet<usize> = path.moves.iter().map(|motion| motion.line).collect();
    let mut events = Vec::new();
    for line in 1..=program.line_count() {
        let Some(bytes) = program.line_bytes(line) else {
            continue;
        };
        let Some(words) = rest_of(bytes) else {
            continue;
        };
        let first = path.pauses.partition_point(|pause| pause.line < line);
        let dwell = path.pauses[first..]
            .iter()
            .find_map(|pause| match pause.kind {
                PauseKind::DwellSeconds(seconds) if pause.line == line => Some(seconds),
                _ => None,
            });
        let event = words.event(line, dwell, path.spindle_on(line));
        events.extend(split_behind(event, moving.contains(&line)));
    }
    events
}

/// What acts behind the motion, beside words that act before it, is an event of its own behind it.
///
/// Controllers disagree about M5 and M9 beside a motion: where one moves they come behind it, since a spindle that stops while
/// the tool still cuts does harm, a little later does none.
fn split_behind(mut event: SourceEvent, moves: bool) -> Vec<SourceEvent> {
    let is_late = |action: &EventAction| text_behind(*action, moves).is_some();
    let late: Vec<_> = event.actions.iter().copied().filter(is_late).collect();
    let Some(first) = late.first().filter(|_| !event.is_behind) else {
        return vec![event];
    };
    if late.len() == event.actions.len() && event.rest.is_none() {
        event.is_behind = true;
        return vec![event];
    }
    event.actions.retain(|action| !is_late(action));
    let texts: Vec<_> = (late.iter())
        .filter_map(|action| text_behind(*action, moves))
        .collect();
    let behind = SourceEvent {
        is_behind: true,
        actions: late.clone(),
        ..SourceEvent::acting(event.line, *first, texts.join(" "))
    };
    vec![event, behind]
}

/// The word of what acts behind the motion of its block; none for what acts before it.
fn text_behind(action: EventAction, moves: bool) -> Option<&'static str> {
    match action {
        EventAction::OptionalStop => Some("M1"),
        EventAction::Stop => Some("M0"),
        EventAction::Spindle {
            rotation: SpindleRotation::Stopped,
            ..
        } if moves => Some("M5"),
        EventAction::Coolant(Coolant::Off) if moves => Some("M9"),
        _ => None,
    }
}

/// The words of a block that are no motion.
struct Words {
    text: String,
    /// What the block as a whole is about.
    kind: EventKind,
    /// Each with its kind, and the action that it is by itself.
    kinds: Vec<(EventKind, Word)>,
    /// The machine's switch says whether it runs.
    is_optional: bool,
    stops_spindle: bool,
}

/// What a word does that is known.
#[derive(Clone, Copy, PartialEq)]
enum Word {
    Action(EventAction),
    /// It turns the spindle, or says how fast.
    Spindle,
    Other,
}

impl Words {
    fn event(self, line: usize, dwell: Option<f64>, spindle: Spindle) -> SourceEvent {
        let mut event = SourceEvent::words_alone(line, self.kind, self.text);
        event.rest = None;
        event.is_behind = matches!(event.kind, EventKind::Stop | EventKind::End);
        for (kind, word) in self.kinds {
            let action = match (word, dwell) {
                _ if self.is_optional => None,
                (Word::Action(action), _) => Some(action),
                (Word::Spindle, _) if spindle.mode == SpeedMode::Constant => {
                    Some(EventAction::Spindle {
                        rotation: spindle.rotation,
                        rpm: spindle.speed,
                    })
                }
                (_, Some(seconds)) if kind == EventKind::Dwell => {
                    Some(EventAction::Wait { seconds })
                }
                _ => None,
            };
            match action {
                Some(action) if event.actions.last() != Some(&action) => event.actions.push(action),
                Some(_) => {}
                None if matches!(kind, EventKind::Comment | EventKind::End) => {}
                None => event.rest = Some(event.rest.map_or(kind, |rest| rest.min(kind))),
            }
        }
        // A speed of a spindle that stands still is that of its start.
        let stands = spindle.rotation == SpindleRotation::Stopped;
        if stands && !self.stops_spindle {
            (event.actions).retain(|action| !matches!(action, EventAction::Spindle { .. }));
        }
        event
    }
}

/// G codes that are all in the places and feeds of the moves, times ten.
const FOLLOWED: [u32; 35] = [
    0, 10, 20, 30, 170, 180, 190, 200, 210, 280, 300, 400, 530, 540, 550, 560, 570, 580, 590, 591,
    592, 593, 610, 611, 640, 800, 900, 910, 901, 911, 920, 930, 940, 950, 970,
];

/// What of a block is no motion, and what it is about; none where nothing is left.
fn rest_of(bytes: &[u8]) -> Option<Words> {
    let text = String::from_utf8_lossy(bytes);
    let mut words = Vec::new();
    let mut kinds = Vec::new();
    let mut rest = text.trim();
    let (mut dwells, mut stops_spindle) = (false, false);
    while let Some(first) = rest.chars().next() {
        match first {
            '(' => {
                let end = rest.find(')').map_or(rest.len(), |at| at + 1);
                words.push(rest[..end].to_owned());
                kinds.push((EventKind::Comment, Word::Other));
                rest = &rest[end..];
            }
            ';' => {
                let comment = rest[1..].trim();
                if !comment.is_empty() {
                    words.push(comment.to_owned());
                    kinds.push((EventKind::Comment, Word::Other));
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
                stops_spindle |= letter == 'M' && value == 5.0;
                if let Some(kind) = kind_of(letter, value, dwells) {
                    words.push(format!("{letter}{number}"));
                    kinds.push((kind, word_of(letter, value)));
                }
                rest = &tail[end..];
            }
            other => rest = &rest[other.len_utf8()..],
        }
        rest = rest.trim_start();
    }
    let is_optional = text.trim_start().starts_with('/');
    let kind = match kinds.iter().map(|(kind, _)| *kind).min()? {
        // The machine's switch says whether such a block runs: it is a note.
        EventKind::Stop if is_optional => EventKind::Other,
        kind => kind,
    };
    Some(Words {
        text: words.join(" "),
        kind,
        kinds,
        is_optional,
        stops_spindle,
    })
}

/// What a word does that other languages have, too.
fn word_of(letter: char, value: f64) -> Word {
    let action = match (letter, value) {
        ('M', 0.0 | 60.0) => EventAction::Stop,
        ('M', 1.0) => EventAction::OptionalStop,
        ('M', 7.0) => EventAction::Coolant(Coolant::Mist),
        ('M', 8.0) => EventAction::Coolant(Coolant::Flood),
        ('M', 9.0) => EventAction::Coolant(Coolant::Off),
        ('S', _) | ('M', 3.0..=5.0) => return Word::Spindle,
        ('G', 97.0) => return Word::Spindle,
        _ => return Word::Other,
    };
    Word::Action(action)
}

/// What a word is about; none where it is part of a motion.
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
        'M' => Some(match tenths as i64 / 10 {
            0 | 1 | 60 => EventKind::Stop,
            2 | 30 => EventKind::End,
            3 | 4 | 5 | 19 => EventKind::Spindle,
            6 => EventKind::Tool,
            7..=9 => EventKind::Coolant,
            _ => EventKind::Other,
        }),
        _ => Some(EventKind::Other),
    }
}
