//! Settings that the expansion needs and a program does not state.

use std::collections::BTreeMap;

use crate::reading::options::ReadOptions;

/// Default limit of the blocks of a flat program.
const MOST_BLOCKS: usize = 5_000_000;

/// Origin comments in flat blocks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum OriginComments {
    /// Nothing is added; [`crate::Expanded::origins`] knows it.
    #[default]
    Left,
    /// At the end of each block, as in `(line 12)` or `(drill, line 3)`.
    Written,
}

/// The controller whose meaning a word has where controllers disagree.
///
/// ```
/// use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, expand};
///
/// let text = "G21 G90 F100\nG0 X0 Y0 Z10\nG81 X5 Y5 R2 Z-3\nM30\n";
/// let mut options = ExpandOptions::default();
/// // G98 or G99 is not stated: where the tool goes behind the hole depends on the controller.
/// assert!(expand(text, &options, &NoSubprograms).is_err());
/// options.dialect = Dialect::Fanuc;
/// let flat = expand(text, &options, &NoSubprograms)?;
/// assert!(String::from_utf8_lossy(flat.program.bytes()).ends_with("G1 Z-3\nG0 Z10\nM30\n"));
/// # Ok::<(), kinetostat_program::ProgramError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Dialect {
    /// A word that they read differently is refused, with both readings.
    #[default]
    Undecided,
    /// LinuxCNC 2.9.
    LinuxCnc,
    /// Fanuc's milling controllers, and those that follow them (Haas).
    Fanuc,
}

/// Settings of the expansion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExpandOptions {
    /// Options for reading the flat program.
    pub reading: ReadOptions,
    /// Maximum number of blocks of the flat program: endless loops are refused by their line.
    pub most_blocks: usize,
    /// Origin comments in flat blocks.
    pub origin_comments: OriginComments,
    /// The controller that the program is written for.
    pub dialect: Dialect,
    /// Values of numbered parameters before the program, as a controller keeps them.
    pub parameters: BTreeMap<u32, f64>,
    /// Diameters of tools by their numbers, mm: the radius of G41 and G42. A tool that is not named here is refused there. A
    /// negative diameter puts the tool on the other side.
    pub tool_diameters_mm: BTreeMap<u32, f64>,
}

impl Default for ExpandOptions {
    fn default() -> Self {
        Self {
            reading: ReadOptions::default(),
            most_blocks: MOST_BLOCKS,
            origin_comments: OriginComments::default(),
            dialect: Dialect::default(),
            parameters: BTreeMap::new(),
            tool_diameters_mm: BTreeMap::new(),
        }
    }
}

impl ExpandOptions {
    /// The options with those of the reading that follow from the dialect.
    pub(crate) fn of_dialect(&self) -> Self {
        let mut own = self.clone();
        own.reading.of_fanuc_run |= self.dialect == Dialect::Fanuc;
        own
    }
}
