//! Declared poses that get corrections: edited where all their uses agree, copied under free names where not.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::model::program::RobotProgram;
use crate::model::site::{Declaration, DeclarationCopy};
use crate::text::edits::Edits;
use crate::writing::syntax::{Renamed, Syntax};

/// Required poses of declarations, for each use, as the bytes of their literals.
#[derive(Debug, Default)]
pub(crate) struct Demands(BTreeMap<usize, Vec<Demand>>);

#[derive(Debug)]
struct Demand {
    /// Position of the name in a statement.
    file: usize,
    name: Range<usize>,
    literal: Vec<u8>,
}

impl Demands {
    /// A use, of an index of [`RobotProgram::declarations`], of a name in a file.
    pub(crate) fn demand(&mut self, of: usize, file: usize, name: Range<usize>, literal: Vec<u8>) {
        let demands = self.0.entry(of).or_default();
        demands.push(Demand {
            file,
            name,
            literal,
        });
    }

    /// Writes them; `None` where no name is free.
    pub(crate) fn write(
        self,
        program: &RobotProgram,
        syntax: &dyn Syntax,
        names: &mut Names,
        edits: &mut [Edits],
    ) -> Option<()> {
        let mut renamed = Vec::new();
        for (index, demands) in self.0 {
            let declaration = program.declarations.get(index)?;
            let home = declaration.text.file;
            let file = program.files.get(home)?;
            let original = file.part(&declaration.text.whole);
            let stays = declaration.keeps_value || demands.iter().any(|d| d.literal == original);
            let kept: &[u8] = match (stays, demands.first()) {
                (false, Some(first)) => &first.literal,
                _ => original,
            };
            if kept != original {
                edits[home].replace(declaration.text.whole.clone(), kept);
            }
            let mut new: BTreeMap<&[u8], Vec<u8>> = BTreeMap::new();
            let mut number = 2;
            for demand in demands.iter().filter(|demand| demand.literal != kept) {
                if !new.contains_key(demand.literal.as_slice()) {
                    let name = names.declare(
                        program,
                        syntax,
                        declaration,
                        &demand.literal,
                        &mut number,
                        edits,
                    )?;
                    new.insert(&demand.literal, name);
                }
                let name = new.get(demand.literal.as_slice())?;
                edits[demand.file].replace(demand.name.clone(), name.clone());
                renamed.push(Renamed {
                    home,
                    file: demand.file,
                    place: demand.name.clone(),
                    name: name.clone(),
                });
            }
        }
        if !renamed.is_empty() {
            syntax.renamed(program, &renamed, edits);
        }
        Some(())
    }
}

/// The names that are taken, once they are asked for.
#[derive(Debug, Default)]
pub(crate) struct Names(Option<BTreeSet<Vec<u8>>>);

impl Names {
    /// Declares a pose like another under a free name, and gives that name.
    pub(crate) fn declare(
        &mut self,
        program: &RobotProgram,
        syntax: &dyn Syntax,
        declaration: &Declaration,
        literal: &[u8],
        number: &mut usize,
        edits: &mut [Edits],
    ) -> Option<Vec<u8>> {
        let file = program.files.get(declaration.text.file)?;
        let taken = self.0.get_or_insert_with(|| syntax.names(program));
        let name = syntax.free_name(file.part(&declaration.name), number, taken)?;
        let at = syntax.copies_at(program, declaration);
        let text = further(program, declaration, &name, literal, at)?;
        edits[declaration.text.file].replace(at..at, text);
        Some(name)
    }
}

/// A further declaration on a line of its own, as it is put in at a place.
fn further(
    program: &RobotProgram,
    declaration: &Declaration,
    name: &[u8],
    literal: &[u8],
    at: usize,
) -> Option<Vec<u8>> {
    let file = program.files.get(declaration.text.file)?;
    let mut text = Vec::new();
    match &declaration.copy {
        DeclarationCopy::Statement => {
            let mut edits = Edits::default();
            edits.replace(declaration.name.clone(), name);
            edits.replace(declaration.text.whole.clone(), literal);
            text.extend(edits.applied_to_part(file.bytes(), &declaration.statement)?);
        }
        DeclarationCopy::Around {
            before,
            middle,
            after,
        } => {
            text.extend([before, name, middle.as_slice(), literal, after].concat());
        }
    }
    text.extend_from_slice(file.line_ending());
    // The text at the insertion point keeps its indentation.
    text.extend_from_slice(file.indentation_before(at));
    Some(text)
}
