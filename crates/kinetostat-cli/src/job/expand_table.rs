//! The table `[expand]` of a job file: the program is run once and written flat before it is read.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_spanned::Spanned;

use crate::job::dialect_word::DialectWord;

/// Expansion of the program: `[expand]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpandTable {
    /// Diameters of tools by their numbers, for G41 and G42.
    pub tool_diameters_mm: Option<NumberedTable>,
    /// Folders of subprograms beside that of the program.
    #[serde(default)]
    pub subprograms: Vec<Spanned<String>>,
    /// Values of numbered parameters before the program.
    pub parameters: Option<NumberedTable>,
    /// Controller that the program is written for.
    pub dialect: Option<DialectWord>,
    /// True if flat blocks have a comment with the line that they came from.
    pub comments: Option<bool>,
}

impl ExpandTable {
    /// The first key that says something of G-code alone.
    pub(crate) fn given_for_gcode(&self) -> Option<&'static str> {
        let all = [
            ("tool_diameters_mm", self.tool_diameters_mm.is_some()),
            ("parameters", self.parameters.is_some()),
            ("dialect", self.dialect.is_some()),
        ];
        all.into_iter()
            .find_map(|(name, given)| given.then_some(name))
    }
}

/// Numbers with a value each.
pub(crate) type NumberedTable = Spanned<BTreeMap<Spanned<String>, Spanned<f64>>>;
