//! Figures that sentences of other languages than English are made of, as the English ones have them.

use kinetostat_machining::CornerLoad;

use crate::number::{self, Rounding};
use crate::run::Shown;
use crate::text;

/// A largest length, as the English sentences round it.
pub(crate) fn length(mm: f64) -> String {
    number::typeset(&kinetostat_machining::number::largest_length(mm))
}

/// Line of a missed tolerance, with the reason in brackets where it is known: of a program of others it is not.
pub(crate) fn missed_place(result: &Shown<'_>) -> Option<String> {
    let missed = result.tolerance.missed.as_ref()?;
    let line = number::count(missed.line);
    Some(match text::clean(&missed.reason) {
        reason if reason.is_empty() => line,
        reason => format!("{line} ({reason})"),
    })
}

/// Steps of a program, and what is assumed of the load on them.
pub(crate) struct Corners {
    /// Number of steps at corners, and the length of the longest, mm.
    pub(crate) corner: Option<(usize, f64)>,
    /// Number of steps at the ends of rapids, and the length of the longest, mm.
    pub(crate) entry: Option<(usize, f64)>,
    /// The reading of the load; none where tools have different ones.
    pub(crate) reading: Option<CornerLoad>,
    /// Error there if the load turns evenly, mm; none without an equilibrium.
    pub(crate) if_turns: Option<f64>,
    /// Error there if it follows the feed, mm.
    pub(crate) if_follows: Option<f64>,
    /// Share of the points.
    pub(crate) percent: String,
}

/// Collects the steps; `None` for a program without steps.
pub(crate) fn corners(result: &Shown<'_>) -> Option<Corners> {
    let s = &result.summary;
    let steps = |count: usize, mm: f64| (count > 0).then_some((count, mm));
    let corner = steps(s.corner_steps, s.largest_corner_step_mm);
    let entry = steps(s.entry_steps, s.largest_entry_step_mm);
    corner.or(entry)?;
    let tools = &result.run_inputs.tools_at_corners;
    let first = tools.first().map(|tool| tool.load_at_corners);
    let shared = tools.iter().all(|tool| Some(tool.load_at_corners) == first);
    let finite = |mm: Option<f64>| mm.filter(|mm| mm.is_finite());
    Some(Corners {
        corner,
        entry,
        reading: match first {
            None => Some(result.run_inputs.load_at_corners),
            first => first.filter(|_| shared),
        },
        if_turns: finite(s.max_corner_error_if_load_turns_mm),
        if_follows: finite(s.max_corner_error_if_load_follows_feed_mm),
        percent: number::typeset(&kinetostat_machining::number::largest(
            s.corner_points_percent,
            "%",
        )),
    })
}

/// Scatter of errors.
pub(crate) struct Uncertain {
    pub(crate) numbers: String,
    pub(crate) file: String,
    pub(crate) machines: String,
    pub(crate) places: String,
    pub(crate) before: String,
    pub(crate) after: Option<String>,
    pub(crate) high: String,
    pub(crate) linear: bool,
    pub(crate) unanswered: usize,
    pub(crate) unstable: usize,
}

/// Collects the scatter; `None` if nothing is uncertain.
pub(crate) fn uncertain(result: &Shown<'_>) -> Option<Uncertain> {
    let band = result.uncertainty.as_ref()?;
    let shown = band.after.as_ref().unwrap_or(&band.before);
    Some(Uncertain {
        numbers: number::count(band.uncertain.len()),
        file: text::clean(&band.file),
        machines: number::count(band.machines),
        places: number::count(band.places.len()),
        before: number::typeset(&band.before.band_text()),
        after: (band.after.as_ref()).map(|after| number::typeset(&after.band_text())),
        high: length(shown.high_mm),
        linear: band.before.linear_is_enough,
        unanswered: band.unanswered,
        unstable: band.unstable,
    })
}

/// The numbers that are uncertain, the seed, whether linear propagation is enough, and its deviation.
pub(crate) fn uncertain_numbers(result: &Shown<'_>) -> (String, u64, bool, String) {
    let Some(band) = result.uncertainty.as_ref() else {
        return Default::default();
    };
    let numbers = band
        .uncertain
        .iter()
        .map(crate::run::facts::uncertain_number);
    let numbers: Vec<String> = numbers.collect();
    let deviation = number::length(band.before.deviation_by_line_mm, 2, Rounding::Nearest);
    (
        numbers.join("; "),
        band.seed,
        band.before.linear_is_enough,
        deviation,
    )
}

/// Line of the fastest change of the correction; what is stated for it, mm/mm, and how many lines are beyond that.
pub(crate) fn stated_change(result: &Shown<'_>) -> (String, Option<(String, usize)>) {
    let Some(change) = result.summary.largest_change_mm_per_mm else {
        return (String::new(), None);
    };
    let stated = change.stated.map(|value| {
        let text = number::with_unit(&number::setting(value), "mm/mm");
        (text, change.lines_beyond)
    });
    (number::count(change.line), stated)
}
