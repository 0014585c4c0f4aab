//! The programs that programs call.

use std::collections::BTreeMap;

use crate::ls::found::Reader;
use crate::ls::lines::Layout;
use crate::ls::program::Program;
use crate::ls::step::Step;
use crate::model::outside_call::OutsideCall;
use crate::text::source::SourceFile;

impl Reader<'_> {
    /// Finds the programs that are called.
    pub(super) fn link_calls(
        &mut self,
        files: &[SourceFile],
        layouts: &[Layout],
        programs: &mut [Program],
    ) {
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
        for (index, program) in programs.iter_mut().enumerate() {
            let file = &files[index];
            for (at, step) in program.steps.iter().enumerate() {
                let step = match step {
                    Step::Perhaps(step) => step,
                    step => step,
                };
                let Step::Call(name) = step else {
                    continue;
                };
                let called = name.as_ref().map(|name| file.part(name));
                match called.and_then(|name| names.get(&name.to_ascii_uppercase())) {
                    Some(to) => {
                        program.called.insert(at, *to);
                    }
                    None => {
                        self.outside_calls.push(OutsideCall {
                            file: index,
                            line: file.line_of(layouts[index].lines[at].whole.start),
                            name: called.map(crate::error::excerpt),
                        });
                    }
                }
            }
        }
    }
}
