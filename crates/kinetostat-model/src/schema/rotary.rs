//! Rotary axes by the words of a program.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::schema::placement::Axis;

/// The word of a rotary axis.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
pub enum RotaryWord {
    /// About x, as a rule.
    A,
    /// About y, as a rule.
    B,
    /// About z, as a rule.
    C,
}

impl RotaryWord {
    /// Letter of the axis in programs.
    ///
    /// ```
    /// assert_eq!(kinetostat_model::schema::RotaryWord::B.letter(), 'B');
    /// ```
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::A => 'A',
            Self::B => 'B',
            Self::C => 'C',
        }
    }
}

/// Body that a rotary axis turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CarriesWord {
    /// The tool: a head, whose joint is in the chain as well.
    Tool,
    /// The part: a table, which is taken to be rigid.
    Part,
}

/// A rotary axis of a machine of five axes, by its word in programs. Heads are joints of a chain as well; a table turns the part and is in no
/// chain. Of two heads, or two tables, the one that carries the other comes first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotaryAxisTable {
    /// Letter of the axis in programs.
    pub word: RotaryWord,
    /// Body that the axis turns.
    pub carries: CarriesWord,
    /// About which a positive word turns that, right-handed, base axes, where all rotary axes stand at zero. Where a table turns
    /// against its word (as ISO 841 has it), write the axis with a minus.
    pub axis: Axis,
    /// A point on the axis there, base axes, mm; needed of a table.
    pub point_mm: Option<[f64; 3]>,
    /// A point on the axis there, base axes, m.
    pub point_m: Option<[f64; 3]>,
    /// Lower and upper limit of its angle, deg; without them it turns without end, or a head as far as the joint of its
    /// chain does.
    pub limits_deg: Option<[f64; 2]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}
