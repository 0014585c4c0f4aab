//! Actions in and around the motion statements of a robot's program (outputs, procedures, triggers), and in the statements of its lines.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::ls::motion::event_of;
use crate::ls::positions::{named_end, position_names};
use crate::making::events::{Coolant, EventAction, EventKind, SourceEvent};
use crate::model::Language;
use crate::model::motion::Motion;
use crate::model::program::{ENDLESS, RobotProgram};
use crate::rapid::lex::code_of;
use crate::text::source::{SourceFile, in_one_line};

/// The events of all motions of a file.
pub(crate) fn events_of_motions(program: &RobotProgram, file: usize) -> Vec<SourceEvent> {
    let own = || program.motions.iter().filter(|motion| motion.file == file);
    let sorted = |mut all: Vec<usize>| {
        all.sort_unstable();
        all
    };
    let starts = sorted(own().map(|motion| motion.span.start).collect());
    let ends = sorted(own().map(|motion| motion.span.end).collect());
    let mut events = Vec::new();
    let names = match (program.language, program.files.get(file)) {
        (Language::FanucLs, Some(source)) => position_names(source),
        _ => BTreeMap::new(),
    };
    for motion in own() {
        let before = ends.partition_point(|end| *end <= motion.span.start);
        let before = before.checked_sub(1).map_or(0, |before| ends[before]);
        let next = starts.partition_point(|start| *start < motion.span.end);
        let next = starts.get(next).copied().unwrap_or(usize::MAX);
        let Some(source) = program.files.get(file) else {
            continue;
        };
        let begin = source.range_of(motion.line).start;
        let number = |from: usize| starts.partition_point(|start| *start < from);
        let number = number(motion.span.start).saturating_sub(number(begin));
        let called = program.files.get(file);
        let called = called.and_then(|source| named_end(source, motion, &names));
        events.extend(called.map(|text| SourceEvent {
            motion: Some(number),
            ..SourceEvent::words_alone(motion.line, EventKind::Comment, text)
        }));
        events.extend(events_of_motion(
            program.language,
            source,
            motion,
            number,
            before..next,
        ));
    }
    events
}

/// The events in the statement of a motion, with its number on its line; before it there, and behind it up to where the next one begins;
/// `free` is from where the last one ends up to there.
fn events_of_motion(
    language: Language,
    source: &SourceFile,
    motion: &Motion,
    number: usize,
    free: Range<usize>,
) -> Vec<SourceEvent> {
    let found = done_in_motion(language, source, motion);
    let begin = source.range_of(motion.line).start;
    let number = Some(number);
    let mut events = Vec::new();
    if language.has_several_statements_a_line() && free.start <= begin {
        // Statements between two motions of a line belong after the first.
        let text = in_one_line(source.part(&(begin..motion.span.start.max(begin))));
        events.extend(of_line(language, motion.line, &text));
    }
    if language == Language::Rapid {
        let inside = comments_inside(source, motion).into_iter();
        events.extend(inside.map(|(line, text)| SourceEvent {
            motion: number,
            place: format!("line {line}"),
            ..SourceEvent::words_alone(motion.line, EventKind::Comment, text)
        }));
    }
    if let Some((text, is_behind)) = found {
        events.push(SourceEvent {
            is_behind,
            motion: number,
            ..SourceEvent::words_alone(motion.line, EventKind::Other, text)
        });
    }
    events.extend(
        behind(language, source, motion, free.end).map(|event| SourceEvent {
            is_behind: true,
            motion: number,
            ..event
        }),
    );
    events
}

/// Text of an action in the statement of a motion, and true if it is done at the end of the motion.
pub(crate) fn done_in_motion(
    language: Language,
    source: &SourceFile,
    motion: &Motion,
) -> Option<(String, bool)> {
    match language {
        Language::Rapid => of_rapid(source, motion),
        Language::FanucLs => {
            let event = event_of(source.bytes(), &motion.span);
            let text = event.map(|span| in_one_line(source.part(&span)));
            text.map(|text| (text.trim_end_matches(';').trim_end().to_owned(), true))
        }
        _ => None,
    }
}

/// What stands behind a motion on its last line, up to where the next one begins.
fn behind(
    language: Language,
    source: &SourceFile,
    motion: &Motion,
    next: usize,
) -> impl Iterator<Item = SourceEvent> {
    let last = source.line_of(motion.span.end.saturating_sub(1));
    let end = source.range_of(last).end.min(next);
    let text = in_one_line(source.part(&(motion.span.end.min(end)..end)));
    let is_comment = |sign| text.starts_with(sign);
    let is_said = language.has_several_statements_a_line()
        || language.comment_behind_statement().is_some_and(is_comment);
    let found = match is_said {
        true => of_line(language, motion.line, &text),
        false => Vec::new(),
    };
    let place = format!("line {last}");
    found.into_iter().map(move |event| SourceEvent {
        place: place.clone(),
        ..event
    })
}

/// The comments within a statement of RAPID over several lines, with their lines.
fn comments_inside(source: &SourceFile, motion: &Motion) -> Vec<(usize, String)> {
    let text = String::from_utf8_lossy(source.part(&motion.span)).into_owned();
    let first = source.line_of(motion.span.start);
    let comments = text.lines().enumerate().filter_map(|(index, line)| {
        let comment = line[code_of(line).len()..].trim();
        (comment.len() > 1).then(|| (first + index, comment.to_owned()))
    });
    comments.collect()
}

/// Action of a RAPID motion instruction beside its motion, and true if it acts after the motion.
fn of_rapid(source: &SourceFile, motion: &Motion) -> Option<(String, bool)> {
    let keyword = in_one_line(source.part(&motion.site.keyword));
    let upper = keyword.to_ascii_uppercase();
    let is_circle = upper.starts_with("MOVEC") || upper == "TRIGGC";
    let from = match upper.as_str() {
        "TRIGGL" | "TRIGGJ" | "TRIGGC" => 2,
        _ if ["DO", "AO", "GO", "SYNC"]
            .iter()
            .any(|end| upper.ends_with(end)) =>
        {
            4
        }
        _ => return None,
    } + usize::from(is_circle);
    let statement = source.part(&(motion.site.keyword.end..motion.span.end));
    let statement = String::from_utf8_lossy(statement).into_owned();
    let code: Vec<&str> = statement.lines().map(code_of).collect();
    let statement = in_one_line(code.join(" ").as_bytes());
    let arguments = arguments_of(statement.trim_end_matches(';'));
    let to = match upper.starts_with("TRIGG") {
        // Zone and tool follow.
        true => arguments.len().saturating_sub(2),
        false => arguments.len(),
    };
    let own = arguments.get(from..to)?.join(",");
    Some((format!("{keyword} {own}"), !upper.starts_with("TRIGG")))
}

/// Arguments between the commas that no bracket and no text holds; switches before the first are left out.
fn arguments_of(text: &str) -> Vec<String> {
    let mut arguments = vec![String::new()];
    let (mut open, mut in_text) = (0_usize, false);
    for letter in text.chars() {
        match letter {
            '"' => in_text = !in_text,
            '(' | '[' | '{' if !in_text => open += 1,
            ')' | ']' | '}' if !in_text => open = open.saturating_sub(1),
            ',' if !in_text && open == 0 => {
                arguments.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = arguments.last_mut() {
            last.push(letter);
        }
    }
    let is_switch = |argument: &String| argument.trim_start().starts_with('\\');
    let switches = arguments
        .iter()
        .take_while(|argument| is_switch(argument))
        .count();
    arguments.drain(..switches);
    arguments
        .iter()
        .map(|argument| argument.trim().to_owned())
        .collect()
}

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
            instructions_of_rapid(statement.trim()).filter(|_| alone)
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

fn instructions_of_rapid(statement: &str) -> Option<EventAction> {
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
