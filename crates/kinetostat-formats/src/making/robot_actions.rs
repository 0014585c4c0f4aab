//! Statements of robots and of APT that other languages have, too: pauses, stops, coolant.

use crate::making::action::{Coolant, EventAction};
use crate::making::event_kind::EventKind;
use crate::model::language::Language;
use crate::model::program::ENDLESS;

/// Action of the only statement of a line; `None` if no other language has it.
pub(crate) fn action_of(language: Language, text: &str) -> Option<EventAction> {
    let upper = text.to_ascii_uppercase();
    match language {
        Language::Rapid => {
            let (statement, behind) = upper.split_once(';')?;
            let alone = behind.trim().is_empty() || behind.trim().starts_with('!');
            of_rapid(statement.trim()).filter(|_| alone)
        }
        Language::Krl => {
            let statement = upper.split(';').next()?.trim();
            match statement.strip_prefix("WAIT SEC") {
                Some(time) => seconds(time),
                None => (statement == "HALT").then_some(EventAction::Stop),
            }
        }
        Language::FanucLs => match upper.strip_prefix("WAIT") {
            Some(time) => seconds(time.trim().strip_suffix("(SEC)")?),
            None => (upper == "PAUSE").then_some(EventAction::Stop),
        },
        Language::Apt => of_apt(upper.split("$$").next()?.trim()),
        Language::Val3 => seconds(
            upper
                .split("//")
                .next()?
                .trim()
                .strip_prefix("DELAY(")?
                .strip_suffix(')')?,
        ),
        // In block languages each word is an action of its own.
        _ => None,
    }
}

fn of_rapid(statement: &str) -> Option<EventAction> {
    if let Some(time) = statement.strip_prefix("WAITTIME") {
        let time = time.trim();
        let in_position = time.strip_prefix("\\INPOS");
        let behind = in_position.map(|rest| rest.trim_start().trim_start_matches(','));
        return seconds(behind.unwrap_or(time));
    }
    let stops = statement.split('\\').next().map(str::trim) == Some("STOP");
    stops.then_some(EventAction::Stop)
}

fn of_apt(statement: &str) -> Option<EventAction> {
    let (word, arguments) = statement.split_once('/').unwrap_or((statement, ""));
    let coolant = |coolant| Some(EventAction::Coolant(coolant));
    match (word.trim(), arguments.trim()) {
        ("DELAY", time) => seconds(time),
        ("STOP", "") => Some(EventAction::Stop),
        ("OPSTOP", "") => Some(EventAction::OptionalStop),
        ("COOLNT", "ON" | "FLOOD") => coolant(Coolant::Flood),
        ("COOLNT", "MIST") => coolant(Coolant::Mist),
        ("COOLNT", "OFF") => coolant(Coolant::Off),
        _ => None,
    }
}

/// A time in seconds, written as a number.
fn seconds(text: &str) -> Option<EventAction> {
    let seconds: f64 = text.trim().parse().ok()?;
    (seconds.is_finite() && seconds >= 0.0).then_some(EventAction::Wait { seconds })
}

/// Subject of a statement that has no action in other languages.
pub(crate) fn kind_of(language: Language, upper: &str) -> EventKind {
    let has = |words: &[&str]| words.iter().any(|word| upper.starts_with(word));
    match () {
        () if upper.starts_with(language.comment()) || has(&["PPRINT", "REMARK"]) => {
            EventKind::Comment
        }
        () if upper == ENDLESS => EventKind::Endless,
        () if has(&["SPINDL"]) => EventKind::Spindle,
        () if has(&["COOLNT"]) => EventKind::Coolant,
        () if has(&["LOAD", "TOOLNO", "TOOL PATH", "TLDATA"]) => EventKind::Tool,
        // Others wait for a signal.
        () if has(&["WAITTIME", "WAIT SEC", "DELAY"]) => EventKind::Dwell,
        () if has(&["WAIT"]) && upper.ends_with("(SEC)") => EventKind::Dwell,
        () if has(&["STOP", "HALT", "PAUSE", "OPSTOP"]) => EventKind::Stop,
        () => EventKind::Other,
    }
}
