//! What blocks and routines may change of what is in force.

use crate::krl::lex::TokenFile;
use crate::krl::settings::{BAS, touched};
use crate::krl::state::{Thing, Things};
use crate::krl::table::{motion_row, row};
use crate::krl::tree::Statement;
use crate::krl::values::Values;
use crate::table::Treatment;

/// By routine: what it may change, with all that it calls.
pub(crate) struct Touched {
    pub routines: Vec<Things>,
}

impl Touched {
    /// Of all routines: what each does itself, then what it calls, until nothing is added.
    pub(crate) fn of(values: &Values<'_>) -> Self {
        let count = values.symbols.routines.len();
        let mut all = Self {
            routines: vec![Things::default(); count],
        };
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); count];
        for routine in 0..count {
            let mut calls = Vec::new();
            let body = &values.symbols.routines[routine].routine.body;
            all.routines[routine] = own(values, routine, body, &mut calls);
            for called in calls {
                callers[called].push(routine);
            }
        }
        let mut waiting: Vec<usize> = (0..count).collect();
        while let Some(routine) = waiting.pop() {
            for caller in &callers[routine] {
                let with = all.routines[*caller].with(all.routines[routine]);
                if with != all.routines[*caller] {
                    all.routines[*caller] = with;
                    waiting.push(*caller);
                }
            }
        }
        all
    }

    /// Of a block of a routine.
    pub(crate) fn by(&self, values: &Values<'_>, routine: usize, block: &[Statement]) -> Things {
        let mut calls = Vec::new();
        let things = own(values, routine, block, &mut calls);
        calls
            .iter()
            .fold(things, |things, called| things.with(self.routines[*called]))
    }
}

/// What a block does itself, and the routines that it calls.
fn own(values: &Values<'_>, routine: usize, block: &[Statement], calls: &mut Vec<usize>) -> Things {
    let file = values.file(routine);
    let mut things = Things::default();
    for statement in block {
        let line = match statement {
            Statement::Simple(line) | Statement::Leaves(line) => *line,
            Statement::Branches { header, blocks, .. } => {
                for block in blocks {
                    things = things.with(own(values, routine, block, calls));
                }
                *header
            }
            Statement::Loop { header, block, .. } => {
                things = things.with(own(values, routine, block, calls));
                *header
            }
            Statement::Label => {
                things = Things::ALL;
                continue;
            }
            Statement::Exit => continue,
        };
        things = things.with(of_line(values, routine, file, line, calls));
    }
    things
}

fn of_line(
    values: &Values<'_>,
    routine: usize,
    file: &TokenFile<'_>,
    line: usize,
    calls: &mut Vec<usize>,
) -> Things {
    let tokens = file.lines[line].tokens.clone();
    let mut things = touched(file, tokens.start);
    for at in tokens.clone() {
        let Some(name) = file.name(at) else {
            continue;
        };
        let is_first = at == tokens.start;
        if is_first && motion_row(&name).is_some() {
            things = things.with(Things::of(&[Thing::Place]));
        } else if name.is("BAS") {
            things = things.with(Things::of(&BAS));
        } else if file.is(at + 1, b'(') || is_first {
            let refused = |treatment| matches!(treatment, Treatment::Refused { .. });
            match (values.symbols.routine(routine, &name), row(&name)) {
                (Some(called), _) => calls.push(called),
                (None, Some(row)) if !refused(row.treatment) => {}
                // What is in none of the files is taken to change nothing.
                (None, None) => {}
                (None, Some(_)) => things = Things::ALL,
            }
        }
    }
    things
}
