//! The file of uncertainties, or a model file that states its own: TOML, refused by name and line.

mod rows;
mod written;

use kinetostat::Wrench;
use kinetostat_model::{Model, ModelError};

use crate::tolerance::file::written::{Load, Reader, Written};
use crate::tolerance::uncertain::{Uncertain, Uncertainties};

pub use rows::SharedNumber;
pub use written::{CUTTING_PARTS, Source};

/// Content of a file of uncertainties.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyFile {
    /// The numbers and their distributions.
    pub uncertainties: Uncertainties,
    /// Source of each number.
    pub sources: Vec<Source>,
    /// Numbers that several limbs have and that move together in all of them.
    pub shared: Vec<SharedNumber>,
}

impl UncertaintyFile {
    /// Paths of the model's numbers that are uncertain, in their order.
    pub(crate) fn parameters(&self) -> Vec<&str> {
        let all = self.sources.iter();
        all.filter_map(|source| match source {
            Source::Parameter(path) => Some(path.as_str()),
            _ => None,
        })
        .collect()
    }

    /// Reads the uncertainties of a model's numbers and of the load on its tool; `file` names the text in messages.
    ///
    /// # Errors
    /// Every fault with its line: an unknown parameter (with the nearest that exist), a negative spread, one that makes a stiffness
    /// negative, correlations that contradict each other.
    pub fn read(text: &str, file: &str, model: &Model, load: &Wrench) -> Result<Self, ModelError> {
        Self::read_with(text, file, model, Load::Stated(load))
    }

    /// Variant for a run along a program, where the load differs from place to place: `load` is then `factor`, or one of
    /// [`CUTTING_PARTS`].
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_along_program(text: &str, file: &str, model: &Model) -> Result<Self, ModelError> {
        Self::read_with(text, file, model, Load::AlongProgram)
    }

    fn read_with(
        text: &str,
        file: &str,
        model: &Model,
        load: Load<'_>,
    ) -> Result<Self, ModelError> {
        let mut reader = Reader {
            text,
            file,
            problems: Vec::new(),
        };
        let written: Written = match Written::read(text) {
            Ok(written) => written,
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                reader.refuse(
                    span,
                    error.message(),
                    "see `kinetostat tolerance --help-all` for what such a file says",
                );
                return Err(ModelError::new(reader.problems));
            }
        };
        if *written.schema.get_ref() != 1 {
            reader.refuse(
                written.schema.span(),
                "this version reads schema 1",
                "write schema = 1",
            );
        }
        if written.uncertain.is_empty() {
            reader.refuse(
                0..0,
                "nothing is uncertain",
                "add a table [[uncertain]] with a parameter and its spread",
            );
        }
        let mut each: Vec<Uncertain> = Vec::new();
        let mut sources = Vec::new();
        let mut shared = Vec::new();
        let rows = reader.of_each_limb(&written.uncertain, model, &mut shared);
        for row in &rows {
            let Some((uncertain, source)) = reader.row(row, model, load) else {
                continue;
            };
            if each.iter().any(|u| u.name == uncertain.name) {
                reader.refuse(
                    row.span(),
                    format!("'{}' is given twice", uncertain.name),
                    "keep one of them",
                );
            }
            each.push(uncertain);
            sources.push(source);
        }
        let pairs = reader.pairs(&written.correlation, &each);
        if !reader.problems.is_empty() {
            return Err(ModelError::new(reader.problems));
        }
        match Uncertainties::correlated(each, &pairs) {
            Ok(uncertainties) => Ok(Self {
                uncertainties,
                sources,
                shared,
            }),
            Err(contradiction) => {
                let first = written.correlation.first();
                let span = first.map_or(0..0, |p| p.get_ref().coefficient.span());
                reader.refuse(
                    span,
                    contradiction.to_string(),
                    "of three numbers, two that both go with the third go with each other: make the coefficients smaller, or state the missing ones",
                );
                Err(ModelError::new(reader.problems))
            }
        }
    }
}
