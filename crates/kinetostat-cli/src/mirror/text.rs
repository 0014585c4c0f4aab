//! The answer in words.

use kinetostat::number::larger;
use kinetostat_machining::number::{largest_length, mean_length};
use kinetostat_mirror::Outcome;

use crate::mirror::answer::MirrorAnswer;
use crate::mirror::measurement_text::measurement;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{given, number};

pub(crate) fn answer_text(a: &MirrorAnswer) -> String {
    let mut out = wrapped(
        &format!(
            "{}, trial {}{}: {}{}",
            a.program,
            a.trial,
            a.model
                .as_ref()
                .map_or_else(String::new, |model| format!(" on top of {model}")),
            outcome(a),
            taken_away(a)
        ),
        0,
    );
    // A correction in a run without mirroring cannot be applied twice.
    if a.shows_correction == Some(false) && matches!(a.outcome, Outcome::GoOn | Outcome::Risen) {
        out.push_str(&item(match a.was_run {
            false => "IT CANNOT BE TOLD whether the last correction was in the program that was measured: what it changes is within what the points scatter by, or other places were measured; if the program before it was run, the same is mirrored twice",
            true => "THE LAST CORRECTION IS NOT SEEN in these points; they are taken because the program that has it is said to have been run (--was-run): if the one before it was, the same is mirrored twice",
        }));
    }
    for measured in &a.measurements {
        out.push('\n');
        out.push_str(&measurement(measured));
    }
    out.push('\n');
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![row(
        "left after smoothing, root mean square",
        mean_length(a.left_mm),
    )];
    rows.extend(
        a.floor_mm
            .map(|floor| row("floor of the repeatability", mean_length(floor))),
    );
    if let Some(found) = &a.convergence {
        rows.push(row(
            "left of the trial before",
            format!("{} %", number(100.0 * found.factor, 3)),
        ));
        let answers = number(100.0 * (1.0 + found.departure), 3);
        let spread = number(100.0 * found.spread, 2);
        rows.push(row(
            "answer to the last correction, with its spread",
            format!("{answers} +- {spread} %"),
        ));
        rows.extend(
            found
                .relaxation_below
                .map(|below| row("relaxation must stay below, by this", round_down(below))),
        );
    }
    rows.push(row("relaxation", given(a.relaxation)));
    rows.push(row(
        "largest correction by measurement",
        largest_length(a.largest_correction_mm),
    ));
    rows.push(row("blocks written", a.accounting.blocks_out.to_string()));
    out.push_str(&columns(&rows, 2));
    out
}

/// States what the registration keeps from being corrected.
fn taken_away(a: &MirrorAnswer) -> String {
    let found = a
        .measurements
        .iter()
        .filter_map(|m| m.registration.as_ref());
    match found.map(|r| r.moved_mm).reduce(larger) {
        Some(mm) => format!(
            ". The registration ({}) moved the points by up to {}: what it takes away is not corrected",
            a.register.word(),
            largest_length(mm)
        ),
        None => String::new(),
    }
}

/// A bound, to a hundredth.
fn round_down(bound: f64) -> String {
    format!("{:.2}", (100.0 * bound).floor() / 100.0)
}

fn outcome(a: &MirrorAnswer) -> String {
    let words = match a.outcome {
        Outcome::GoOn => "the deviation is mirrored; measure the new program",
        Outcome::WithinRepeatability => {
            "stop: what is left is within the repeatability, and the correction stays as it was"
        }
        Outcome::NothingToCorrect => {
            let is_registered = a.measurements.iter().any(|m| m.registration.is_some());
            let by = match is_registered {
                true => " where the registration (below) puts them",
                false => "",
            };
            return format!(
                "nothing to correct: the points that were measured lie on the path{by}, and the program stays as it was"
            );
        }
        Outcome::Risen => {
            "THE ERROR HAS RISEN since the trial before: take a smaller --relaxation, or look whether machine, clamping or measurement have changed"
        }
    };
    words.to_owned()
}
