//! Execution order of the lines of a robot's program, and the lines that run exactly once.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::heidenhain::blocks::{Block as Statement, blocks_of};
use crate::heidenhain::flow::{Step, labels_of, order, step_of};
use crate::making::motion_events::statements;
use crate::making::robot_events::instructions;
use crate::model::Language;
use crate::model::program::RobotProgram;
use crate::model::stated_value::SlashBlocks;
use crate::siemens::block::{Block, What};
use crate::siemens::values::{Variables, whole};
use crate::text::source::SourceFile;

/// Deepest nesting of calls that is followed.
const DEEPEST: usize = 100;
/// Limit of the routines that are tried as the main routine.
const MOST_TRIED: usize = 64;

/// A routine: its name in capitals and the lines between head and end.
struct Routine {
    name: String,
    lines: Range<usize>,
}

/// The lines of the file with the motions in the order in which they run; none where that is not the order of the motions.
pub(crate) fn running_lines(program: &RobotProgram, file: usize) -> Option<Vec<Running>> {
    let source = program.files.get(file)?;
    let all = instructions(program.language, source);
    let routines = routines_of(program.language, source, all.clone());
    let mut moving: Vec<usize> = program.motions.iter().map(|motion| motion.line).collect();
    moving.dedup();
    let set: BTreeSet<usize> = moving.iter().copied().collect();
    let is_order = |lines: &[Running]| {
        // The motions of a line stand behind what it calls.
        let own = lines
            .iter()
            .filter(|running| running.part == Part::Rest)
            .map(|running| running.line)
            .filter(|line| set.contains(line));
        own.eq(moving.iter().copied())
    };
    match program.language {
        Language::Heidenhain => return Some(running_blocks(source)).filter(|own| is_order(own)),
        Language::Siemens => return Some(until_end(source)).filter(|own| is_order(own)),
        _ => {}
    }
    let mut outside = Vec::new();
    let mut from = all.start;
    for routine in &routines {
        outside.extend(from..routine.lines.start);
        from = routine.lines.end;
    }
    let is_one = routines.is_empty();
    let whole = match is_one {
        true => vec![Routine {
            name: String::new(),
            lines: all,
        }],
        false => {
            outside.extend(from..all.end);
            routines
        }
    };
    let names = whole.iter().enumerate().rev();
    let names = names.map(|(index, routine)| (routine.name.as_str(), index));
    let names: BTreeMap<&str, usize> = names.collect();
    // A main routine calls what runs of the others.
    let is_main =
        |index: &usize| program.language.main_routine() == Some(whole[*index].name.as_str());
    let main = (0..whole.len()).find(is_main);
    let others = (0..whole.len()).filter(|index| Some(*index) != main);
    main.into_iter()
        .chain(others)
        .take(MOST_TRIED)
        .find_map(|first| {
            let mut walk = Walk {
                language: program.language,
                source,
                routines: &whole,
                names: &names,
                seen: vec![false; whole.len()],
                lines: (outside.iter())
                    .map(|line| Running {
                        line: *line,
                        is_certain: false,
                        part: Part::Rest,
                    })
                    .collect(),
            };
            walk.routine(first, true, 0);
            is_order(&walk.lines).then_some(walk.lines)
        })
}

fn routines_of(language: Language, source: &SourceFile, lines: Range<usize>) -> Vec<Routine> {
    let [heads, ends] = language.routines();
    if heads.is_empty() {
        return Vec::new();
    }
    let mut routines = Vec::new();
    let mut open: Option<(String, usize)> = None;
    for line in lines {
        let words = words_of(language, source, line);
        let words: Vec<&str> = (words.iter().map(String::as_str))
            .skip_while(|word| matches!(*word, "LOCAL" | "GLOBAL"))
            .collect();
        match (words.as_slice(), &open) {
            ([head, rest @ ..], None) if heads.contains(head) => {
                // A function has a type before its name.
                let name = match *head {
                    "FUNC" | "DEFFCT" => String::new(),
                    _ => rest
                        .first()
                        .map_or_else(String::new, |name| (*name).to_owned()),
                };
                open = Some((name, line + 1));
            }
            ([end, ..], Some((name, from))) if ends.contains(end) => {
                routines.push(Routine {
                    name: name.clone(),
                    lines: *from..line,
                });
                open = None;
            }
            _ => {}
        }
    }
    routines
}

/// The words of a line in capitals, without its comment and texts.
pub(crate) fn words_of(language: Language, source: &SourceFile, line: usize) -> Vec<String> {
    let text = String::from_utf8_lossy(source.line(line).unwrap_or_default()).to_ascii_uppercase();
    let text = language.statement_in(&text);
    let code = text.split('"').step_by(2).collect::<Vec<_>>().join(" ");
    words_in(code.split(language.comment()).next().unwrap_or_default())
}

fn words_in(code: &str) -> Vec<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words = code.split(|c| !is_word(c)).filter(|word| !word.is_empty());
    words.map(str::to_owned).collect()
}

struct Walk<'w> {
    language: Language,
    source: &'w SourceFile,
    routines: &'w [Routine],
    names: &'w BTreeMap<&'w str, usize>,
    seen: Vec<bool>,
    lines: Vec<Running>,
}

impl Walk<'_> {
    fn routine(&mut self, index: usize, is_certain: bool, depth: usize) {
        self.seen[index] = true;
        let lines = self.routines[index].lines.clone();
        let mut blocks = Blocks::of(self.language);
        for line in lines.clone() {
            blocks.jump(&words_of(self.language, self.source, line));
        }
        for line in lines {
            let words = words_of(self.language, self.source, line);
            blocks.enter(&words);
            let is_certain = is_certain && blocks.is_certain();
            let text = String::from_utf8_lossy(self.source.line(line).unwrap_or_default());
            let text = text.to_ascii_uppercase();
            for statement in statements(self.language, self.language.statement_in(&text)) {
                let called = self.called(statement);
                let Some(called) = called.filter(|called| !self.seen[*called] && depth < DEEPEST)
                else {
                    continue;
                };
                self.lines.push(Running {
                    line,
                    is_certain,
                    part: Part::Before(self.routines[called].name.clone()),
                });
                self.routine(called, is_certain, depth + 1);
            }
            self.lines.push(Running {
                line,
                is_certain,
                part: Part::Rest,
            });
        }
    }

    /// The routine that a statement calls.
    fn called(&self, statement: &str) -> Option<usize> {
        let name = words_in(statement).into_iter().next()?;
        let index = *self.names.get(name.as_str())?;
        let behind = statement.strip_prefix(name.as_str())?.trim_start();
        self.language.is_call(behind).then_some(index)
    }
}

/// Blocks that run on a condition or again and again.
pub(crate) struct Blocks {
    language: Language,
    open: usize,
    /// The line follows a jump, or its routine has one.
    is_lost: bool,
}

impl Blocks {
    /// State at the start of a routine.
    pub(crate) fn of(language: Language) -> Self {
        Self {
            language,
            open: 0,
            is_lost: false,
        }
    }

    /// True if the line runs exactly once, unconditionally.
    pub(crate) fn is_certain(&self) -> bool {
        self.open == 0 && !self.is_lost
    }

    /// Jumps make the order of lines no order of time.
    pub(crate) fn jump(&mut self, words: &[String]) {
        let jumps = self.language.jumps();
        self.is_lost |= words.iter().any(|word| jumps.contains(&word.as_str()));
    }

    /// The words of the next line.
    pub(crate) fn enter(&mut self, words: &[String]) {
        let Some(first) = words.first().map(String::as_str) else {
            return;
        };
        let has = |word: &str| words.iter().any(|own| own == word);
        let ends = [
            "ENDIF",
            "ENDFOR",
            "ENDWHILE",
            "ENDTEST",
            "ENDLOOP",
            "UNTIL",
            "ENDSWITCH",
        ];
        let closes = words
            .iter()
            .filter(|word| ends.contains(&word.as_str()))
            .count();
        self.open += usize::from(self.language.opens_block(words));
        match self.open.checked_sub(closes) {
            Some(open) => self.open = open,
            None => self.is_lost = true,
        }
        // Statements after these only run if the routine was not left before.
        let leaves = [
            "RETURN",
            "EXIT",
            "EXITCYCLE",
            "RETRY",
            "TRYNEXT",
            "RAISE",
            "ERROR",
            "UNDO",
            "BACKWARD",
        ];
        let is_statement = leaves.contains(&first) && words.len() == 1 || has("RETURN");
        self.is_lost |= is_statement && self.language.is_of_robot();
        self.is_lost |= self.language.ends_of_run().contains(&first);
    }
}

/// A line in the order of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Running {
    pub line: usize,
    /// The block runs exactly once, unconditionally.
    pub is_certain: bool,
    /// Part of the line that runs here.
    pub part: Part,
}

/// Part of a line that runs at a place of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Part {
    /// The rest of it: what stands on it behind the calls that are followed.
    Rest,
    /// A call and no more; what it calls stands behind it.
    Call,
    /// Text before the call of a routine (its name in capitals); the routine's lines follow.
    Before(String),
}

/// Running blocks of a Heidenhain program, with the labels that it calls.
pub(crate) fn running_blocks(source: &SourceFile) -> Vec<Running> {
    let bytes = source.bytes();
    let blocks = blocks_of(bytes);
    let begins = |block: &Statement| {
        let words = block.words(bytes);
        words.first().is_some_and(|word| word.is("BEGIN"))
    };
    let first = blocks.iter().position(begins).unwrap_or(0);
    let (labels, _) = labels_of(bytes, &blocks);
    let step = |at: usize| step_of(bytes, &blocks[at], SlashBlocks::Run);
    let ordered = order(first, blocks.len(), &labels, step).unwrap_or_default();
    let lines = |at: usize| {
        let lines = &blocks[at].lines;
        let is_followed = matches!(step(at), Step::Call(_));
        let last = source.line_of(lines.end.saturating_sub(1).max(lines.start));
        (source.line_of(lines.start)..=last).map(move |line| Running {
            line,
            is_certain: true,
            part: match is_followed {
                true => Part::Call,
                false => Part::Rest,
            },
        })
    };
    (0..first).chain(ordered).flat_map(lines).collect()
}

/// Running blocks of a SINUMERIK program with linear control flow: up to the block that ends it.
pub(crate) fn until_end(source: &SourceFile) -> Vec<Running> {
    let last = last_line(source).unwrap_or(source.line_count());
    let certain = |line: usize| Running {
        line,
        is_certain: true,
        part: Part::Rest,
    };
    (1..=last).map(certain).collect()
}

/// The line of the block that ends a program.
fn last_line(source: &SourceFile) -> Option<usize> {
    let variables = Variables::default();
    (1..=source.line_count()).find(|line| {
        let block = Block::of(source.bytes(), source.range_of(*line));
        block.is_ok_and(|(block, _)| {
            block.items.iter().any(|item| match &item.what {
                What::Name => source.part(&item.name).eq_ignore_ascii_case(b"RET"),
                What::Value { value, .. } if source.part(&item.name) == b"M" => {
                    let number = variables.number(source.bytes(), value).ok().and_then(whole);
                    matches!(number, Some(2 | 17 | 30))
                }
                _ => false,
            })
        })
    })
}
