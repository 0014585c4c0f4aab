//! Warnings about loads that come and go: the length of their ramps, and paths that are too short for them.

use kinetostat::number::larger;
use kinetostat_program::Path;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::profile::Begins;

/// A change of the force inside a cut that is faster than the correction may follow, where that is worst on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TooFast {
    /// Line of the program.
    pub line: usize,
    /// Force that the correction lacks there, N.
    pub force_n: f64,
    /// Displacement of the tool by that force at the machine's smallest stiffness, mm.
    pub off_mm: f64,
}

impl TooFast {
    /// True if it is large compared with the tolerance of the path.
    pub fn matters(&self, tolerance_mm: f64) -> bool {
        self.off_mm > 0.5 * tolerance_mm
    }
}

/// Feed between two rapids that is too short for the load to come as slowly as it should.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShortFeed {
    /// First and last line of a part of it without a sharp corner.
    pub lines: [usize; 2],
    /// Length at feed between the two rapids, mm.
    pub length_mm: f64,
    /// Length over which the load would come, mm.
    pub needs_mm: f64,
}

/// Place at which a stated load begins to act.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema, Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LoadBegins {
    /// The load acts below a stated height: it comes over the path before, and goes over the path after.
    BelowHeight,
    /// The height was not stated: the load comes over the first millimetres of feed after a rapid, and acts until the
    /// next one.
    AfterRapid,
}

/// Maximum length of path over which a stated load comes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct LoadRamp {
    /// Place at which it begins to act; with several loads [`LoadBegins::AfterRapid`] if one of them begins so.
    pub begins: LoadBegins,
    /// Longest way over which a load comes, mm.
    pub length_mm: f64,
}

/// Warnings about loads that come and go.
#[derive(Clone, Debug, Default)]
pub(crate) struct RampFindings {
    /// Fast changes, one for each line.
    pub too_fast: Vec<TooFast>,
    pub short: Vec<ShortFeed>,
    /// Ramp of stated loads.
    pub ramp: Option<LoadRamp>,
}

impl RampFindings {
    /// Notes how a stated load begins on a run whose load would come over a length.
    pub fn begins(
        &mut self,
        path: &Path,
        run: &[usize],
        begins: Begins,
        load: LoadBegins,
        needs_mm: f64,
    ) {
        let since = match begins {
            Begins::WithNothing(since) => Some(since),
            Begins::Anyhow => None,
        };
        let known = since.is_some() || load == LoadBegins::BelowHeight;
        if needs_mm <= 0.0 || !known {
            return;
        }
        let mut length_mm = needs_mm;
        if let Some(since) = since.filter(|since| since.in_all_mm < needs_mm) {
            length_mm = since.in_all_mm;
            let line = |i: Option<&usize>| i.map_or(0, |i| path.moves[*i].line);
            self.short.push(ShortFeed {
                lines: [line(run.first()), line(run.last())],
                length_mm,
                needs_mm,
            });
        }
        let before = self.ramp.unwrap_or(LoadRamp {
            begins: load,
            length_mm,
        });
        self.ramp = Some(LoadRamp {
            begins: before.begins.max(load),
            length_mm: larger(before.length_mm, length_mm),
        });
    }
}
