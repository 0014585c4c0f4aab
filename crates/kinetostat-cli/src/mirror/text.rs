//! The answer in words.

use kinetostat::number::larger;
use kinetostat_machining::number::{largest_length, mean_length};
use kinetostat_mirror::{Outcome, ToldBy, Unseen, WhyLeftOut};

use crate::mirror::answer::{MeasurementResult, MirrorAnswer};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{given, number, short, triple};

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

/// Upper limit of the points that are listed; others are counted.
const LISTED: usize = 20;

/// A path that bends by less is straight.
const STRAIGHT_MM: f64 = 1e-6;

/// Describes the measurement of one file.
fn measurement(m: &MeasurementResult) -> String {
    let f = &m.figures;
    let mut out = wrapped(&format!("{}: {} points count", m.file, f.points), 0);
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    out.push_str(&columns(
        &[
            row(
                "deviation across the path, root mean square",
                mean_length(f.rms_mm),
            ),
            row("largest", largest_length(f.largest_mm)),
            row(
                "after smoothing, root mean square",
                mean_length(f.smoothed_rms_mm),
            ),
            row(
                "largest after smoothing",
                largest_length(f.smoothed_largest_mm),
            ),
            row(
                match f.scatter_has_bends {
                    true => "scatter of a point in one direction, at most",
                    false => "scatter of a point in one direction",
                },
                mean_length(f.scatter_mm),
            ),
            row(
                "points that a smoothed deviation rests on",
                number(f.effective_points, 3),
            ),
        ],
        2,
    ));
    if let Some(found) = &m.registration {
        out.push_str(&item(&format!(
            "moved onto the path by {} mm, turned by {} deg{}: what this takes away is not corrected",
            triple(found.shift_mm, short),
            triple(found.rotation_vector_deg, short),
            match found.scale == 1.0 {
                true => String::new(),
                false => format!(", scaled by {}", number(found.scale, 7)),
            }
        )));
        for free in &found.free {
            out.push_str(&item(&format!(
                "the points do not determine {free}: it was left as it was"
            )));
        }
    }
    if let Some(found) = &m.registration {
        let what = "did not count in the motion onto the path, being farther from it than six standard deviations";
        out.push_str(&rows_text(&found.rejected_rows, what));
        out.push_str(
            told_by(found.told_by)
                .map(item)
                .as_deref()
                .unwrap_or_default(),
        );
    }
    let what = "lie beside a corner and may belong to its other leg: they do not count";
    out.push_str(&rows_text(&m.beside_corners, what));
    if let Some(times) = m.scatter_of_repeatability {
        out.push_str(&item(&format!(
            "THE POINTS SCATTER by {} times the repeatability stated: what counts as an outlier follows the scatter, and when to stop follows what was stated; look at the measurement, or state what it repeats to",
            number(times, 2)
        )));
    }
    for outlier in m.outliers.iter().take(LISTED) {
        out.push_str(&item(&format!(
            "row {} is left out: {} from the path, {} from what its neighbours say, where {} could be",
            outlier.row,
            largest_length(outlier.distance_mm),
            largest_length(outlier.from_neighbours_mm),
            largest_length(outlier.allowed_mm)
        )));
    }
    for point in m.left_out.iter().take(LISTED) {
        let far = point
            .distance_mm
            .map_or_else(String::new, |mm| format!(", {} away", largest_length(mm)));
        out.push_str(&item(&format!(
            "row {} has no place on the path{far}: {}",
            point.row,
            why(point.why)
        )));
    }
    for (count, what) in [
        (m.outliers.len(), "outliers"),
        (m.left_out.len(), "points without a place"),
    ] {
        if count > LISTED {
            out.push_str(&item(&format!(
                "{count} {what} in all; --json has every one"
            )));
        }
    }
    for unseen in &m.unseen {
        out.push_str(&item(&unseen_text(unseen)));
    }
    for feature in &m.features {
        out.push_str(&feature.text());
    }
    out
}

/// Message about points in another frame.
fn told_by(what: ToldBy) -> Option<&'static str> {
    let said = match what {
        ToldBy::Frame => return None,
        ToldBy::Shape => {
            "THE POINTS WERE IN ANOTHER FRAME than the program: the shape of what was measured tells where they belong, and nothing else does; look whether the motion can be right"
        }
        ToldBy::Order => {
            "THE POINTS WERE IN ANOTHER FRAME than the program, and fit the path in several places: they were taken to run along the whole of it in their order; look whether the motion can be right"
        }
    };
    Some(said)
}

/// Message about rows that are excluded from something, with the first of them.
fn rows_text(rows: &[usize], what: &str) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let named: Vec<String> = rows.iter().take(LISTED).map(ToString::to_string).collect();
    item(&format!(
        "{} of the points {what}: row {}{}",
        rows.len(),
        named.join(", "),
        match rows.len() > LISTED {
            true => " and others; --json has every one",
            false => "",
        }
    ))
}

fn why(why: WhyLeftOut) -> &'static str {
    match why {
        WhyLeftOut::BeyondWindow => "it is beyond the window (--window-mm)",
        WhyLeftOut::NotOnItsLine => {
            "the line that it names (column line) makes no cut there, if it is a cut of the program at all"
        }
        WhyLeftOut::SeveralStretches => {
            "several passes of the tool come by; a column line, --align arc-length or a smaller --window-mm tells them apart"
        }
        WhyLeftOut::OutOfOrder => "it would lie behind the points before it",
    }
}

fn lines_text(first: usize, last: usize) -> String {
    match first == last {
        true => format!("line {first}"),
        false => format!("lines {first} to {last}"),
    }
}

fn unseen_text(unseen: &Unseen) -> String {
    match unseen {
        Unseen::Pass {
            lines: [a, b],
            length_mm,
        } => format!(
            "{}, {} mm: no point was measured; no correction there",
            lines_text(*a, *b),
            short(*length_mm)
        ),
        Unseen::Stretch {
            lines: [a, b],
            length_mm,
        } => format!(
            "{}: {} mm are farther than three smoothing lengths from every point; the correction fades to nothing there",
            lines_text(*a, *b),
            short(*length_mm)
        ),
        Unseen::Gap {
            lines: [a, b],
            gap_mm,
            sagitta_mm,
        } => format!(
            "{}: points are up to {} mm apart, more than the smoothing length; deviations that bend between them are not seen, and the path itself {} there",
            lines_text(*a, *b),
            short(*gap_mm),
            match *sagitta_mm < STRAIGHT_MM {
                true => "is straight".to_owned(),
                false => format!("bends by {}", largest_length(*sagitta_mm)),
            }
        ),
        Unseen::Moves { count, lines } => {
            let named: Vec<String> = lines.iter().map(ToString::to_string).collect();
            format!(
                "{count} moves longer than the smoothing length have no point of their own and are corrected as their neighbours: line {}{}",
                named.join(", "),
                if *count > lines.len() {
                    " and others"
                } else {
                    ""
                }
            )
        }
    }
}
