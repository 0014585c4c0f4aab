//! Labels, and the jumps of GOTO to them.

use std::collections::BTreeSet;

use crate::rapid::place::Place;
use crate::rapid::tree::{Statement, TokenFile};
use crate::rapid::turning::Modes;
use crate::text::name::Name;

/// A jump that has not come to its label yet.
pub(super) struct Jump {
    pub label: Name,
    /// Where the tool is as it jumps.
    pub at: Place,
    /// What is in force there.
    pub modes: Modes,
}

/// The label of a statement, where it is one.
fn label_of(file: &TokenFile<'_>, statement: &Statement) -> Option<Name> {
    match statement {
        Statement::Label { at } => Name::of(file.word(*at)),
        _ => None,
    }
}

/// The label to which a statement jumps.
pub(crate) fn destination(file: &TokenFile<'_>, statement: &Statement) -> Option<Name> {
    let Statement::Leaves { tokens } = statement else {
        return None;
    };
    let jumps = file.word(tokens.start).eq_ignore_ascii_case(b"GOTO");
    jumps.then(|| Name::of(file.word(tokens.start + 1)))?
}

/// Whether every jump of these statements leads forward to a label of its own block or of one around it; `behind` has the labels that
/// stand behind them.
pub(crate) fn lead_forward(
    file: &TokenFile<'_>,
    statements: &[Statement],
    behind: &mut BTreeSet<Name>,
) -> bool {
    let mut own = Vec::new();
    // From the last one, so that what stands behind is known.
    let forward = statements.iter().rev().all(|statement| {
        if let Some(label) = label_of(file, statement)
            && behind.insert(label)
        {
            own.push(label);
        }
        match statement {
            Statement::Leaves { tokens } => {
                let jumps = file.word(tokens.start).eq_ignore_ascii_case(b"GOTO");
                let label = destination(file, statement);
                !jumps || label.is_some_and(|label| behind.contains(&label))
            }
            Statement::Branches { blocks, .. } => {
                (blocks.iter()).all(|block| lead_forward(file, block, behind))
            }
            Statement::Loop { block, .. } => lead_forward(file, block, behind),
            _ => true,
        }
    });
    for label in own {
        behind.remove(&label);
    }
    forward
}
