//! The statements of a line of a robot's program, what each does beside motions, and those that other languages have, too.

use crate::making::events::{Coolant, EventAction, EventKind, SourceEvent};
use crate::model::language::Language;
use crate::model::program::ENDLESS;

/// Words of RAPID with which a statement on the same line may run on a condition, again, or not at all.
const OF_BLOCKS: [&str; 17] = [
    "IF", "THEN", "ELSE", "ELSEIF", "ENDIF", "FOR", "ENDFOR", "WHILE", "ENDWHILE", "TEST", "CASE",
    "DEFAULT", "ENDTEST", "GOTO", "RETURN", "EXIT", "ERROR",
];

/// Events of the statements of a line, without those that only structure the program.
pub(crate) fn of_line(language: Language, line: usize, text: &str) -> Vec<SourceEvent> {
    let all = statements(language, text).into_iter();
    let matter = all.filter(|text| !text.is_empty() && !orders_only(language, text));
    matter
        .map(|text| of_statement(language, line, text))
        .collect()
}

fn of_statement(language: Language, line: usize, text: &str) -> SourceEvent {
    let kind = kind_of(language, &text.to_ascii_uppercase());
    match action_of(language, text).filter(|_| kind != EventKind::Comment) {
        Some(action) => SourceEvent::acting(line, action, text),
        None => SourceEvent::words_alone(line, kind, text),
    }
}

/// The comment behind the statement of a line; none where the line is one.
pub(crate) fn comment_behind(language: Language, text: &str) -> Option<&str> {
    let sign = language.comment_behind_statement()?;
    let mut in_text = false;
    let begins = |(at, letter): (usize, char)| {
        in_text ^= letter == '"';
        (!in_text && text[at..].starts_with(sign)).then_some(at)
    };
    let at = text.char_indices().find_map(begins).filter(|at| *at > 0)?;
    let comment = text[at..].trim();
    (comment.len() > sign.len()).then_some(comment)
}

/// The statements of a line of RAPID and its comment; the whole line of others, and of what belongs to a block.
pub(crate) fn statements(language: Language, text: &str) -> Vec<&str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let capitals = text.to_ascii_uppercase();
    let is_of_block = (capitals.split(|c| !is_word(c))).any(|word| OF_BLOCKS.contains(&word));
    if !language.has_several_statements_a_line() || is_of_block {
        return vec![text.trim()];
    }
    let mut found = Vec::new();
    let (mut start, mut in_text) = (0, false);
    for (at, letter) in text.char_indices() {
        match letter {
            '"' => in_text = !in_text,
            ';' if !in_text => {
                found.push(text[start..=at].trim());
                start = at + 1;
            }
            // A comment behind its statement stays with it.
            '!' if !in_text => break,
            _ => {}
        }
    }
    found.push(text[start..].trim());
    found
}

/// True if a statement only structures its program.
pub(crate) fn orders_only(language: Language, statement: &str) -> bool {
    let upper = statement.to_ascii_uppercase();
    (language.order_words().iter()).any(|word| begins(&upper, word))
}

/// True if a statement begins with a whole word; a word that ends in a sign may be continued.
fn begins(statement: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is_whole = word.starts_with('$') || !word.ends_with(is_part);
    let behind = statement.strip_prefix(word);
    behind.is_some_and(|rest| is_whole || !rest.starts_with(is_part))
}

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
