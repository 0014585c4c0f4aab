//! Names of a program in RAPID: data and routines of all modules, and the variables of loops.

use crate::error::ProgramError;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{LoopKind, Module, Statement};
use crate::text::name::Name;

/// The names of the modules of each file.
pub(super) fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    modules: &'p [(usize, Module)],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    for (file, content) in modules {
        let file = &files[*file];
        let module = all.add_module(file.index, None);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        for routine in &content.routines {
            all.add_routine(file, module, routine, faults);
            let index = all.routines.len() - 1;
            for block in [&routine.body, &routine.handlers] {
                add_loop_variables(file, block, index, &mut all);
            }
        }
    }
    all.main = Name::of(b"main").and_then(|name| all.routine_everywhere(&name));
    all
}

/// Adds the variables of loops (`FOR i FROM`): each is one of its routine.
fn add_loop_variables(
    file: &TokenFile<'_>,
    block: &[Statement],
    routine: usize,
    all: &mut Symbols<'_>,
) {
    for statement in block {
        match statement {
            Statement::Loop {
                kind,
                header,
                block,
                ..
            } => {
                let name = Name::of(file.word(header.start));
                if let (LoopKind::Counting, Some(name)) = (kind, name) {
                    all.add_local(routine, name);
                }
                add_loop_variables(file, block, routine, all);
            }
            Statement::Branches { blocks, .. } => {
                for block in blocks {
                    add_loop_variables(file, block, routine, all);
                }
            }
            _ => {}
        }
    }
}
