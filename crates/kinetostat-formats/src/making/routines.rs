//! In which order the lines of a robot's program run, and which of them run for certain, once.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::making::block_order::{Part, Running, running_blocks, until_end};
use crate::making::blocks::Blocks;
use crate::making::robot_events::instructions;
use crate::making::statements::statements;
use crate::model::language::Language;
use crate::model::program::RobotProgram;
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
