//! The programs that programs call.

use std::collections::BTreeMap;

use crate::ls::beside::run_beside;
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
                let line = &layouts[index].lines[at];
                let mut outside = |name: Option<&[u8]>| {
                    self.outside_calls.push(OutsideCall {
                        file: index,
                        line: file.line_of(line.whole.start),
                        name: name.map(crate::error::excerpt),
                    });
                };
                let known = |name: &[u8]| names.get(&name.to_ascii_uppercase());
                if let Step::Call(name) = step {
                    let called = name.as_ref().map(|name| file.part(name));
                    match called.and_then(known) {
                        Some(to) => {
                            program.called.insert(at, *to);
                        }
                        None => outside(called),
                    }
                    continue;
                }
                for name in run_beside(file.bytes(), &line.text) {
                    let name = name.as_ref().map(|name| file.part(name));
                    if name.and_then(known).is_none() {
                        outside(name);
                    }
                }
            }
        }
    }
}
