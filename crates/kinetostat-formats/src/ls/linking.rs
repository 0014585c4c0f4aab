//! The programs that programs call.
//!
//! Programs that a statement makes run beside the motions, or at another time: at the end of a motion (`TB .10sec,CALL X`), while a
//! condition is watched (`MONITOR X`, `WHEN DI[1]=ON,CALL X`), behind an error (`ERROR_PROG=X`, `RESUME_PROG=X`).
//!
//! Source: FANUC Robotics, SYSTEM R-J3iB/R-30iA HandlingTool, setup and operations manual: time before and after, condition monitor,
//! automatic error recovery.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::ls::found::Reader;
use crate::ls::lines::Layout;
use crate::ls::run::Files;
use crate::ls::step::{Step, name_from};
use crate::ls::table::row;
use crate::ls::words::words_of;
use crate::model::outside_call::OutsideCall;
use crate::text::source::SourceFile;

impl Reader<'_> {
    /// Programs by their names in capitals.
    pub(super) fn names_of(
        &mut self,
        files: &[SourceFile],
        layouts: &[Layout],
    ) -> BTreeMap<Vec<u8>, usize> {
        let mut names: BTreeMap<Vec<u8>, usize> = BTreeMap::new();
        for (index, layout) in layouts.iter().enumerate() {
            let name = files[index].part(&layout.name).to_ascii_uppercase();
            let first = *names.entry(name).or_insert(index);
            if first != index {
                let reason = "another file holds a program of this name";
                self.fault(
                    &files[index],
                    layout.name.clone(),
                    reason,
                    "give one of them",
                );
            }
        }
        names
    }
}

impl Files<'_> {
    /// The program of a name.
    pub(super) fn named(&self, name: &[u8]) -> Option<usize> {
        self.names.get(&name.to_ascii_uppercase()).copied()
    }

    /// Programs that are in none of the files and are called, or run beside the motions.
    pub(super) fn outside_calls(&self) -> Vec<OutsideCall> {
        let mut found = Vec::new();
        for (index, program) in self.programs.iter().enumerate() {
            let file = &self.files[index];
            for (at, step) in program.steps.iter().enumerate() {
                let line = &self.layouts[index].lines[at];
                let named = match step.action() {
                    Step::Call(call) => vec![call.name.clone()],
                    _ => run_beside(file.bytes(), &line.text),
                };
                for name in named {
                    let name = name.as_ref().map(|name| file.part(name));
                    if name.and_then(|name| self.named(name)).is_none() {
                        found.push(OutsideCall {
                            file: index,
                            line: file.line_of(line.whole.start),
                            name: name.map(crate::error::excerpt),
                        });
                    }
                }
            }
        }
        found
    }
}

/// The names of such programs in a statement; none where a register says it.
fn run_beside(bytes: &[u8], text: &Range<usize>) -> Vec<Option<Range<usize>>> {
    let blanks = |from: usize| {
        let part = bytes.get(from..text.end).unwrap_or_default();
        from + part.len() - part.trim_ascii_start().len()
    };
    let start = blanks(text.start);
    let Some(row) = row(bytes.get(start..text.end).unwrap_or_default()) else {
        return Vec::new();
    };
    let behind = start + row.name.len();
    match row.name {
        // `MONITOR END X` ends it.
        "MONITOR" => {
            let from = blanks(behind);
            let part = bytes.get(from..text.end).unwrap_or_default();
            let ends = part.starts_with(b"END") && part.get(3).is_some_and(u8::is_ascii_whitespace);
            match ends || part.is_empty() {
                true => Vec::new(),
                false => vec![name_from(bytes, from..text.end)],
            }
        }
        "ERROR_PROG" | "RESUME_PROG" => {
            let equals = bytes.get(behind..text.end).unwrap_or_default();
            let equals = equals.iter().position(|byte| *byte == b'=');
            let name = equals.map(|at| name_from(bytes, behind + at + 1..text.end));
            name.into_iter().collect()
        }
        "J" | "L" | "C" | "WHEN" => {
            let words = words_of(bytes, &(start..text.end)).into_iter();
            let calls = words.filter(|word| bytes[word.span.clone()] == *b"CALL");
            calls
                .map(|word| name_from(bytes, word.span.end..text.end))
                .collect()
        }
        _ => Vec::new(),
    }
}
