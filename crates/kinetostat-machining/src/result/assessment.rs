//! Assessment of a run: its level, and the assumptions of its figures, ranked by what each can cost.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Level of a run, from good to bad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// The written program keeps its tolerance, whichever of the stated assumptions fails.
    Good,
    /// Nothing was to be corrected.
    Unchanged,
    /// An answer without a tolerance: analysis only.
    #[default]
    Analysis,
    /// The tolerance is missed, or may be where an assumption fails.
    Attention,
    /// The program must not be run.
    Stop,
}

/// Kind of an assumption. Kinds may be added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum AssumptionKind {
    /// Force of the cut as its coefficients have it, without their spread.
    ForceSpread,
    /// Machine and force as drawn, without the numbers that are stated to be uncertain.
    UncertainNumbers,
    /// Load on steps at corners and where a rapid ends.
    Corners,
    /// Steps and pieces against the direction of motion, which cut nothing only if the machine yields as computed.
    BackwardSteps,
    /// Length over which a stated load comes.
    LoadRamp,
    /// Weight and springs of the machine, and whether they are to be corrected.
    OwnWeight,
    /// A cut that does not chatter.
    Chatter,
    /// Calls of what is in none of the files of a program, taken not to move the tool and not to change what is in force.
    OutsideCalls,
    /// Lengths of a program that states no unit.
    Units,
    /// Feeds of which no way is judged: they start at a place that is not known, or go as the controller has it.
    UnjudgedFeeds,
}

/// An assumption on which the figures of a run rest.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Assumption {
    /// Kind of the assumption.
    pub kind: AssumptionKind,
    /// Largest distance of the tool from its programmed place if it fails, um; `None` if that is not computed.
    pub up_to_um: Option<f64>,
    /// The program must not be run before it is settled: the machine has no equilibrium otherwise, or no length says what is lost.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_critical: bool,
    /// Sentences in English.
    pub text: String,
}

/// Level of a run and the assumptions behind it; made once, and shown by the terminal, reports and JSON.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct Assessment {
    /// Level of the assessment.
    pub level: Level,
    /// Largest distance of the tool from its programmed place if one of the assumptions fails, um; of a written program with that
    /// program. `None` if a critical one has no such distance.
    pub max_error_um: Option<f64>,
    /// Assumptions, the costliest first: critical ones, then by `up_to_um`, then those without a figure.
    pub assumptions: Vec<Assumption>,
}

/// Calls that are named in one sentence.
const MOST_CALLS: usize = 5;

impl Assumption {
    /// An assumption with its cost in mm, if that is known.
    ///
    /// ```
    /// use kinetostat_machining::{Assumption, AssumptionKind};
    ///
    /// let corners = Assumption::new(AssumptionKind::Corners, Some(0.25), "At corners ...");
    /// assert_eq!(corners.up_to_um, Some(250.0));
    /// ```
    #[must_use]
    pub fn new(kind: AssumptionKind, up_to_mm: Option<f64>, text: impl Into<String>) -> Self {
        Self {
            kind,
            up_to_um: up_to_mm.map(|mm| 1e3 * mm),
            is_critical: false,
            text: text.into(),
        }
    }

    /// Calls of what is in none of the files, by name with the first line; `None` where there are none.
    #[must_use]
    pub fn of_calls(calls: &[(String, usize)]) -> Option<Self> {
        let named = |(name, line): &(String, usize)| format!("{name} (line {line})");
        let shown: Vec<String> = calls.iter().take(MOST_CALLS).map(named).collect();
        let more = match calls.len().saturating_sub(MOST_CALLS) {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        let (calls, are) = match calls.len() {
            0 => return None,
            1 => ("The call of", "is"),
            _ => ("The calls of", "are"),
        };
        let text = format!(
            "{calls} {}{more}, in none of the files, {are} taken not to move the tool and not to change speed, tool or frame.",
            shown.join(", ")
        );
        Some(Self::new(AssumptionKind::OutsideCalls, None, text))
    }

    /// Rank of the assumption: critical ones first, unknown costs last.
    pub(crate) fn rank(&self) -> f64 {
        match (self.is_critical, self.up_to_um) {
            (true, _) => f64::INFINITY,
            (false, Some(um)) => um,
            (false, None) => f64::NEG_INFINITY,
        }
    }
}
