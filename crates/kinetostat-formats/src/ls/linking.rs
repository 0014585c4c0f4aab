//! The programs that programs call.

use std::collections::BTreeMap;

use crate::ls::beside::run_beside;
use crate::ls::found::Reader;
use crate::ls::lines::Layout;
use crate::ls::run::Files;
use crate::ls::step::Step;
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
