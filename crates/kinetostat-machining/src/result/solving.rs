//! Methods by which the equilibria of many places were found, if not by the usual one.

use kinetostat::Mechanism;
use kinetostat::batch::Batch;
use kinetostat::chain::FoundBy;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number of places found by one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct FoundCount {
    /// Method, not [`FoundBy::Directly`].
    pub found_by: FoundBy,
    /// Places found so.
    pub places: usize,
}

/// Methods by which the equilibria of many places were found, if not by the usual one: directly, and by kernels that
/// take many places at once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct Solving {
    /// Places that were not found directly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub found_otherwise: Vec<FoundCount>,
    /// Reason for which every place was solved by itself; `None` if kernels take many at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_by_one_because: Option<String>,
}

/// Reason for which the places of a machine are solved one by one, if they are: the orientation of its tool `follows`,
/// or no kernel knows the machine.
pub(crate) fn one_by_one_because(
    mechanism: &Mechanism,
    follows: bool,
    loaded: bool,
) -> Option<String> {
    if follows {
        return Some("the orientation of the tool follows from place to place".to_owned());
    }
    let batch = Batch::new(mechanism);
    let engine = match loaded {
        true => batch.engine(),
        false => batch.engine_unloaded(),
    };
    engine.reason().map(ToString::to_string)
}

impl Solving {
    /// Counts places that were found in one way; of those found directly nothing is kept.
    pub fn note(&mut self, found_by: FoundBy, places: usize) {
        if found_by == FoundBy::Directly || places == 0 {
            return;
        }
        let known = self
            .found_otherwise
            .iter_mut()
            .find(|own| own.found_by == found_by);
        match known {
            Some(own) => own.places += places,
            None => self.found_otherwise.push(FoundCount { found_by, places }),
        }
    }

    /// Counts the places of other ones besides.
    pub fn add(&mut self, other: &Self) {
        for own in &other.found_otherwise {
            self.note(own.found_by, own.places);
        }
    }

    /// One sentence for each way, and one for the engine; none where all was as usual. `place`: what is counted, as in
    /// `place` or `point`.
    #[must_use]
    pub fn sentences(&self, place: &str) -> Vec<String> {
        let ways = self.found_otherwise.iter();
        let ways = ways.map(|own| {
            let places = crate::number::counted(own.places, place);
            format!("At {places} {}.", own.found_by.sentence())
        });
        let engine = self.one_by_one_because.iter();
        let engine = engine.map(|why| format!("Every {place} was solved by itself: {why}."));
        ways.chain(engine).collect()
    }
}
