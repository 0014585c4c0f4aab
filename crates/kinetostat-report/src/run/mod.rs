//! The report of a run: what it means, its figures and tables, its pictures, and the page that holds them.
//!
//! Takes a run's result or all of its points; gives HTML or SVG.

pub(crate) mod along;
pub(crate) mod chatter;
pub(crate) mod cutting;
pub(crate) mod facts;
pub(crate) mod force_band;
pub(crate) mod joints;
pub(crate) mod meaning;
pub(crate) mod page;
pub(crate) mod plan;
pub(crate) mod uncertainty;

use std::ops::Deref;

use kinetostat_machining::{
    Envelope, Figures, PointKind, PointResult, Quantity, Run, RunResult, TurnChoice,
};

use crate::MachineShown;
use crate::chart::panel::Along;
use crate::number::typeset;

/// A result, the points that are drawn (of a run all of them), and its figures in type.
pub(crate) struct Shown<'a> {
    pub(crate) result: &'a RunResult,
    pub(crate) points: &'a [PointResult],
    /// The envelope of all points, where there are more than are drawn one by one.
    pub(crate) envelope: Option<&'a Envelope>,
    pub(crate) figures: Figures,
    /// The turn of the tool about its axis, where it was chosen for the run, and in words.
    pub(crate) turns: Option<(&'a TurnChoice, &'a str)>,
    pub(crate) machine: Option<&'a MachineShown>,
}

impl Deref for Shown<'_> {
    type Target = RunResult;

    fn deref(&self) -> &RunResult {
        self.result
    }
}

impl<'a> Shown<'a> {
    /// Points that are drawn in plots along the path: all but those of rapids.
    pub(crate) fn cutting_points(&self) -> impl Iterator<Item = &PointResult> {
        let points = self.points.iter();
        points.filter(|p| p.kind != PointKind::Rapid)
    }

    pub(crate) fn of_result(result: &'a RunResult) -> Self {
        Self {
            result,
            points: &result.points,
            envelope: None,
            figures: in_type(result),
            turns: None,
            machine: None,
        }
    }

    pub(crate) fn of_run(run: &'a Run) -> Self {
        Self {
            result: &run.result,
            points: &run.points,
            envelope: Some(&run.envelope)
                .filter(|envelope| envelope.points() > RunResult::MAX_POINTS),
            figures: in_type(&run.result),
            turns: None,
            machine: None,
        }
    }

    /// The axis along the path; none if no point has a place on it.
    pub(crate) fn along(&self) -> Option<Along> {
        match self.envelope {
            Some(envelope) => Along::of_envelope(envelope),
            None => Along::of(self.points),
        }
    }

    /// A quantity over the path, in a unit that is so much smaller; of many points the lowest and the highest value in each stretch.
    pub(crate) fn curve(
        &self,
        along: &Along,
        quantity: Quantity,
        factor: f64,
    ) -> Vec<Option<(f64, f64)>> {
        match self.envelope {
            Some(envelope) => along.envelope(envelope, quantity, factor),
            None => along.values(self.points, |p| quantity.of(p).map(|value| value * factor)),
        }
    }
}

/// The figures as they are printed.
pub(crate) fn in_type(result: &RunResult) -> Figures {
    let plain = Figures::of(result);
    let set = |text: &String| {
        // A report has no word for what is infinite: it is no figure.
        if text.ends_with(kinetostat::number::INFINITE) {
            crate::number::MISSING.to_owned()
        } else {
            typeset(text)
        }
    };
    let maybe = |text: &Option<String>| text.as_ref().map(set);
    let list = |texts: &[String]| texts.iter().map(set).collect();
    Figures {
        error_before: set(&plain.error_before),
        rms_before: set(&plain.rms_before),
        error_after: set(&plain.error_after),
        rms_after: set(&plain.rms_after),
        rounding: set(&plain.rounding),
        correction: set(&plain.correction),
        rotation: set(&plain.rotation),
        speed: set(&plain.speed),
        corner_step: maybe(&plain.corner_step),
        entry_step: maybe(&plain.entry_step),
        change: maybe(&plain.change),
        shortest_piece: maybe(&plain.shortest_piece),
        blocks_per_second: maybe(&plain.blocks_per_second),
        feed_length: set(&plain.feed_length),
        stiffness: set(&plain.stiffness),
        share_to_buckling: maybe(&plain.share_to_buckling),
        nearest_limit: maybe(&plain.nearest_limit),
        nearest_limit_at: plain.nearest_limit_at.clone(),
        share_of_rating: maybe(&plain.share_of_rating),
        share_of_rating_at: plain.share_of_rating_at.clone(),
        configuration: plain.configuration.clone(),
        actuator_force: list(&plain.actuator_force),
        actuator_correction: list(&plain.actuator_correction),
    }
}
