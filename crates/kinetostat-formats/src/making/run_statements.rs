//! Statements and words of blocks beside the motions in the order of the run, for comparing two programs.

use std::ops::Range;

use crate::heidenhain::blocks::blocks_of;
use crate::making::events::{EventKind, SourceEvent};
use crate::making::motion_events::{done_in_motion, kind_of};
use crate::making::robot_events::events_of_robot;
use crate::model::Language;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::siemens::block::{Block, What};
use crate::siemens::expression::Expression;
use crate::siemens::table::row;
use crate::table::Treatment;
use crate::text::source::SourceFile;

/// A statement that runs beside the motions of a program.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RunStatement {
    /// Line of its file, counted from 1.
    pub line: usize,
    /// What it is about.
    pub kind: EventKind,
    /// Its text in capitals, without its comment and the sign of its end.
    pub text: String,
    /// How many motions of the program run before it.
    pub motions_before: usize,
    /// The setting that it changes, of how motions behind it run (`$ACC.CP`, `SINGAREA`); none of one that changes none.
    pub mode: Option<String>,
}

/// The statements of a program beside its motions, in the order in which they run; without comments, and without settings that are in
/// the places, frames, tools, speeds and zones of the motions. Words of blocks are given by [`crate::each_block`].
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, read_krl, statements_of_run};
///
/// let text = "DEF A()\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 9,A 0,B 0,C 0}\n$VEL.CP=0.1\n$ACC.CP = 2.0 ; soft\n\
///     LIN {X 0,Y 0,Z 5,A 0,B 0,C 0}\nCUT()\nEND\nDEF CUT()\nSPINDLE_ON()\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 0}\nEND\n";
/// let program = read_krl(vec![SourceFile::new("a.src", text)], &ReadOptions::default()).unwrap();
/// let said = statements_of_run(&program);
/// assert_eq!((said[0].text.as_str(), said[0].mode.as_deref()), ("$ACC.CP=2.0", Some("$ACC.CP")));
/// assert_eq!((said[1].text.as_str(), said[1].line, said[1].motions_before), ("SPINDLE_ON()", 10, 1));
/// ```
#[must_use]
pub fn statements_of_run(program: &RobotProgram) -> Vec<RunStatement> {
    let language = program.language;
    let statement = |line: usize, text: &str, motions_before: usize| {
        let text = plain(language, text);
        let kind = kind_of(language, &text);
        let is_said = matches!(kind, EventKind::Comment | EventKind::End) || text.is_empty();
        (!is_said && !is_in_motions(language, &text)).then(|| RunStatement {
            line,
            kind,
            mode: mode_of(language, &text),
            text,
            motions_before,
        })
    };
    let main = program.motions.first().map_or(0, |motion| motion.file);
    // A file that runs line by line (APT) has no list of the statements that ran.
    let is_file_of_lines =
        !language.is_of_robot() && !language.is_list() && !language.is_in_blocks();
    let mut found: Vec<RunStatement> = match is_file_of_lines {
        true => {
            let lines: Vec<usize> = program.motions.iter().map(|motion| motion.line).collect();
            let of_event = |event: &SourceEvent| {
                let before = lines.partition_point(|line| *line < event.line);
                statement(event.line, &event.text, before)
            };
            (events_of_robot(program).iter())
                .filter_map(of_event)
                .collect()
        }
        false => {
            let of_ran = program.ran.iter().filter_map(|ran| {
                let file = program.files.get(ran.file)?;
                let bytes = ran.text.as_deref().unwrap_or_else(|| file.part(&ran.span));
                let text = String::from_utf8_lossy(bytes);
                let mut found = statement(file.line_of(ran.span.start), &text, ran.motions)?;
                if ran.file != main {
                    found.text = format!("{} ('{}')", found.text, file.name());
                }
                Some(found)
            });
            of_ran.collect()
        }
    };
    for (index, motion) in program.motions.iter().enumerate() {
        let file = program.files.get(motion.file);
        let done = file.and_then(|file| done_in_motion(language, file, motion));
        let done = done.and_then(|(text, is_behind)| {
            statement(motion.line, &text, index + usize::from(is_behind))
        });
        found.extend(done);
    }
    found.sort_by_key(|statement| statement.motions_before);
    found
}

/// The options in the statement of a motion of an arm, in capitals: what is neither its way nor its end, speed, zone, tool and work
/// object; and by which law it passes its places. Of other languages there are none.
#[must_use]
pub fn options_of_motion(program: &RobotProgram, motion: &Motion) -> String {
    let Some(file) = program.files.get(motion.file) else {
        return String::new();
    };
    let site = &motion.site;
    let keyword = plain(
        program.language,
        &String::from_utf8_lossy(file.part(&site.keyword)),
    );
    let law = program.language.law_of_motion(&keyword).unwrap_or_default();
    let Some(told) = program.language.words_of_motion(motion) else {
        return law.to_owned();
    };
    let mut parts: Vec<Range<usize>> = [&site.keyword, &site.target_span]
        .into_iter()
        .chain(site.via.as_ref().map(|(span, _)| span))
        .chain(site.speed.as_ref().map(|speed| &speed.span))
        .chain(&site.zone)
        .cloned()
        .collect();
    parts.sort_by_key(|span| span.start);
    let mut rest = Vec::new();
    let mut at = site.keyword.start;
    for span in parts {
        rest.extend_from_slice(file.part(&(at..span.start.max(at))));
        if span.end > at {
            at = span.end;
        }
    }
    rest.extend_from_slice(file.part(&(at..motion.span.end.max(at))));
    let mut text = plain(program.language, &String::from_utf8_lossy(&rest)).replace(' ', "");
    let done = done_in_motion(program.language, file, motion);
    let done = done.map(|(done, _)| plain(program.language, &done).replace(' ', ""));
    for part in done.into_iter().chain(told) {
        text = text.replace(&part.to_ascii_uppercase(), "");
    }
    // Separators of arguments say nothing by themselves.
    let text = text.trim_matches(',').replace(",,", "");
    format!("{law}{text}")
}

/// A statement in capitals without its comment, with a blank between words alone.
fn plain(language: Language, text: &str) -> String {
    let lines = text.lines().map(|line| language.code_of(line).trim());
    let lines: Vec<&str> = lines.collect();
    let joined = lines.join(" ").to_ascii_uppercase();
    let joined = joined.trim().trim_end_matches(';');
    let words: Vec<&str> = joined.split_whitespace().collect();
    let is_sign = |c: char| "=,()[]{}:".contains(c);
    let mut plain = String::new();
    for word in words {
        let joins = plain.ends_with(is_sign) || word.starts_with(is_sign);
        if !plain.is_empty() && !joins {
            plain.push(' ');
        }
        plain.push_str(word);
    }
    plain
}

fn is_in_motions(language: Language, text: &str) -> bool {
    let is_mode = || mode_of(language, text).is_some();
    let is_letter = |c: char| c.is_ascii_alphanumeric();
    let is_set = |word: &str| {
        let behind = text.strip_prefix(word);
        behind.is_some_and(|rest| !(word.ends_with(is_letter) && rest.starts_with(is_letter)))
    };
    let declares = language.sign_of_declaration();
    language
        .settings_in_motions()
        .iter()
        .any(|word| is_set(word))
        || declares.is_some_and(|sign| text.contains(sign)) && !is_mode()
}

/// The setting that a statement or a word of a block changes, of how motions behind it run; none of one that changes none.
///
/// ```
/// use kinetostat_formats::{Language, mode_of};
///
/// assert_eq!(mode_of(Language::Siemens, "G642").as_deref(), Some("G60"));
/// assert_eq!(mode_of(Language::Krl, "$OUT[1]=TRUE"), None);
/// ```
#[must_use]
pub fn mode_of(language: Language, text: &str) -> Option<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is = |word: &str| {
        let behind = text.strip_prefix(word);
        behind.is_some_and(|behind| !behind.starts_with(is_part))
    };
    let group = language
        .modes()
        .iter()
        .find(|group| group.iter().any(|word| is(word)))?;
    let own = text.split(['=', ',', '\\', ' ', ')']).next();
    Some(match language.modes_have_members() {
        true => own.unwrap_or_default().to_owned(),
        false => group[0].to_owned(),
    })
}

/// A word of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlockWord {
    /// Letters of the word in capitals; `/` for a block that a switch of the control skips.
    pub name: String,
    /// All of it in capitals, without blanks, and without zeros that say nothing: `M3`, `ADIS=0.5`, `CYCLE832(0.5,1)`.
    pub text: String,
    /// It is in the path, the frames, feeds or speeds that are read from the blocks.
    pub is_in_path: bool,
}

/// Gives the words of every block with its line; of languages without blocks there are none.
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, each_block, read_siemens};
///
/// let text = "N10 G0 X0 Y0 Z5 M03 ; start\nG642 ADIS = 0.50\n";
/// let program = read_siemens(vec![SourceFile::new("a.mpf", text)], &ReadOptions::default()).unwrap();
/// let mut said = Vec::new();
/// each_block(&program, |line, words| said.extend(words.iter().map(|word| (line, word.text.clone()))));
/// assert_eq!(said[4], (1, "M3".to_owned()));
/// assert_eq!(said[6], (2, "ADIS=0.5".to_owned()));
/// ```
pub fn each_block(program: &RobotProgram, mut say: impl FnMut(usize, &[BlockWord])) {
    let file = program.motions.first().map_or(0, |motion| motion.file);
    let Some(source) = program.files.get(file) else {
        return;
    };
    match program.language {
        Language::Siemens => {
            for line in 1..=source.line_count() {
                say(line, &words_of_siemens(source, line));
            }
        }
        Language::Heidenhain => {
            for block in blocks_of(source.bytes()) {
                let words = block.words(source.bytes());
                let words = words.iter().map(|word| {
                    let name = capitals(word.letters.letters());
                    let text = match word.value() {
                        Some(value) => format!("{name}{value}"),
                        None => capitals(source.part(&word.span)),
                    };
                    BlockWord {
                        name,
                        text,
                        is_in_path: false,
                    }
                });
                let words: Vec<BlockWord> = slash(block.skipped).chain(words).collect();
                say(source.line_of(block.text.start), &words);
            }
        }
        _ => {}
    }
}

/// The words of a line; none of one that cannot be read.
fn words_of_siemens(source: &SourceFile, line: usize) -> Vec<BlockWord> {
    let Ok((block, _)) = Block::of(source.bytes(), source.range_of(line)) else {
        return Vec::new();
    };
    let words = block.items.iter().map(|item| {
        let name = capitals(source.part(&item.name));
        let text = match &item.what {
            What::Value {
                value: Expression::Number(number),
                indices,
                set,
                ..
            } if indices.is_empty() => {
                format!("{name}{}{number}", if *set { "=" } else { "" })
            }
            _ => capitals(source.part(&item.span)),
        };
        // Of `S2=1000`, `R1=5`, `G505` the table has no rows.
        let has_no_row = || name.starts_with(['S', 'R', 'G']) && is_numbered(&name);
        let is_in_path = row(&name)
            .or_else(|| row(&text))
            .map_or_else(has_no_row, |row| {
                row.treatment == Treatment::Understood || matches!(row.name, "N" | "S")
            });
        BlockWord {
            name,
            text,
            is_in_path,
        }
    });
    slash(block.skip).chain(words).collect()
}

fn slash(stands: bool) -> impl Iterator<Item = BlockWord> {
    let word = || BlockWord {
        name: "/".to_owned(),
        text: "/".to_owned(),
        is_in_path: true,
    };
    stands.then(word).into_iter()
}

fn capitals(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).to_uppercase();
    text.split_whitespace().collect()
}

/// True for one letter with digits behind it, if any.
fn is_numbered(name: &str) -> bool {
    name.chars().skip(1).all(|c| c.is_ascii_digit())
}
