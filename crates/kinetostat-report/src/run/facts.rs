//! Figures and tables of the report as text.

use kinetostat_machining::{
    FileRead, PointKind, PointResult, RunInputs, Summary, UncertainNumber, UncertaintyBand,
};
use minijinja::{Value, context};

use crate::number::{self, MISSING, Rounding, norm};
use crate::run::{Shown, meaning};
use crate::text::{self, or_unknown};

/// A key figure: what, how much, and a line that helps to read it.
fn card(name: &str, value: String, note: String) -> Value {
    context! { name, value, note }
}

/// The key figures as cards; none if nothing was calculated.
pub(crate) fn cards(result: &Shown<'_>) -> Vec<Value> {
    let (summary, run_inputs) = (&result.summary, &result.run_inputs);
    if summary.points == 0 && result.points.is_empty() {
        return Vec::new();
    }
    let figures = &result.figures;
    let mut cards = vec![card(
        "Error without compensation",
        figures.error_before.clone(),
        format!("largest; root mean square {}", figures.rms_before),
    )];
    if run_inputs.compensated {
        cards.push(error_with_compensation(result));
        cards.push(card(
            "Largest correction",
            figures.correction.clone(),
            "of the programmed positions".to_owned(),
        ));
    }
    let (name, note) = match run_inputs.compensated {
        true if run_inputs.orientation_corrected => {
            ("Tilt that stays", "of the orientation in the program")
        }
        true if run_inputs.states_orientation => {
            ("Tilt that stays", "not corrected; --correct pose does")
        }
        true => ("Tilt that stays", "not corrected by positions"),
        false => ("Tilt of the tool", "largest along the path"),
    };
    cards.push(card(name, figures.rotation.clone(), note.to_owned()));
    cards.push(card(
        "Smallest stiffness against a force",
        figures.stiffness.clone(),
        "the tip pushed in its softest direction, the tool free to turn".to_owned(),
    ));
    let (value, note) = match &figures.share_to_buckling {
        Some(share) => (share.clone(), "100 % is buckling"),
        None => ("none".to_owned(), "no limb of this model can buckle"),
    };
    cards.push(card("Share of the way to buckling", value, note.to_owned()));
    cards.push(actuator_card(result));
    cards.push(if run_inputs.compensated {
        let pieces = match &figures.shortest_piece {
            Some(shortest) => format!("at most; divided blocks: pieces from {shortest}"),
            None => "at most; no block was divided".to_owned(),
        };
        let most = figures.blocks_per_second.clone();
        card(
            "Blocks per second",
            most.unwrap_or_else(|| MISSING.to_owned()),
            pieces,
        )
    } else {
        card(
            "Path cut",
            figures.feed_length.clone(),
            format!("{} calculated", number::counted(summary.points, "point")),
        )
    });
    cards
}

/// The error after compensation; where it may be beyond the tolerance, that of the costliest assumption.
fn error_with_compensation(result: &Shown<'_>) -> Value {
    let (summary, figures) = (&result.summary, &result.figures);
    let (value, note) = match (result.is_doubtful(), meaning::worst_and_allowed(result)) {
        (true, (worst, allowed)) => {
            let note = format!(
                "{} if all assumptions hold; {allowed} allowed",
                figures.error_after
            );
            (
                worst.map_or_else(
                    || "not bounded".to_owned(),
                    |worst| format!("up to {worst}"),
                ),
                note,
            )
        }
        (false, _) => {
            let allowed =
                number::against(summary.max_position_error_after_mm, result.allowed_mm()).1;
            let note = format!(
                "largest; root mean square {}; {allowed} allowed",
                figures.rms_after
            );
            (figures.error_after.clone(), note)
        }
    };
    card("Error with compensation", value, note)
}

fn actuator_card(result: &Shown<'_>) -> Value {
    let size = |i: usize| {
        let force = result.summary.max_actuator_force.get(i);
        force.and_then(|f| number::drawable(*f)).map(f64::abs)
    };
    let largest = (0..result.run_inputs.actuators.len())
        .filter_map(|i| Some((i, size(i)?)))
        .reduce(|a, b| if b.1 > a.1 { b } else { a });
    match largest {
        Some((i, _)) => card(
            "Largest actuator load",
            text::shorten(&result.figures.actuator_force[i], 32),
            text::shorten(&result.run_inputs.actuators[i].name, 40),
        ),
        None => card("Largest actuator load", MISSING.to_owned(), String::new()),
    }
}

/// Tables of the worst places without compensation and, of a compensated program, with it.
pub(crate) fn worst(result: &Shown<'_>) -> Vec<Value> {
    let before = "Where the tool is farthest off without compensation, worst first.";
    let after =
        "Where it is farthest off with the written program, worst first, one place of a line.";
    let mut tables = vec![worst_places(
        result,
        "The worst places",
        before,
        &result.worst_points,
    )];
    if !result.worst_points_after.is_empty() {
        tables.push(worst_places(
            result,
            "The worst places with compensation",
            after,
            &result.worst_points_after,
        ));
    }
    tables
}

/// Rows of a table of points, and the units of its errors before and after.
fn worst_places(result: &Shown<'_>, title: &str, order: &str, points: &[PointResult]) -> Value {
    let shown: Vec<&PointResult> = points.iter().take(10).collect();
    let unit_of = |error: fn(&PointResult) -> f64| {
        number::length_unit(number::largest(shown.iter().map(|p| error(p))).unwrap_or(0.0))
    };
    let before = unit_of(|p| norm(&p.error_before_mm));
    let after = unit_of(|p| norm(&p.error_after_mm));
    let rows: Vec<Value> = shown
        .iter()
        .map(|point| {
            context! {
                line => number::count(point.line),
                source => source_of(result, point.line),
                output_line => (point.output_line > 0).then(|| number::count(point.output_line)),
                place => vector(&point.position_mm, 1.0, 3),
                motion => motion(point),
                before => error_columns(&point.error_before_mm, before.1),
                after => error_columns(&point.error_after_mm, after.1),
            }
        })
        .collect();
    context! { title, order, rows, before_unit => before.0, after_unit => after.0 }
}

/// Source of a line of a flat program.
fn source_of(result: &Shown<'_>, line: usize) -> Option<String> {
    let (file, from) = result.run_inputs.flat.as_ref()?.source_of(line)?;
    let file = text::shorten(file, 40);
    Some(format!("from {} of {file}", number::count(from)))
}

fn motion(point: &PointResult) -> String {
    match point.kind {
        PointKind::Feed => {
            let share = 100.0 * point.share;
            format!(
                "cutting, at {}",
                number::with_unit(&number::fixed(share, 0), "%")
            )
        }
        PointKind::Rapid => "rapid".to_owned(),
        PointKind::Corner => "corner".to_owned(),
        PointKind::Entry => "where a rapid ends".to_owned(),
    }
}

fn vector(values: &[f64; 3], factor: f64, decimals: usize) -> Vec<String> {
    values
        .iter()
        .map(|value| number::fixed(value * factor, decimals))
        .collect()
}

fn error_columns(error: &[f64; 3], factor: f64) -> Vec<String> {
    let decimals = if factor == 1.0 { 4 } else { 2 };
    let mut columns = vector(error, factor, decimals);
    columns.push(number::fixed(norm(error) * factor, decimals));
    columns
}

/// A number that is uncertain: `name = value unit (distribution spread unit)`.
pub(crate) fn uncertain_number(n: &UncertainNumber) -> String {
    let unit = if n.unit.is_empty() { "" } else { " " };
    format!(
        "{} = {}{unit}{} ({} {}{unit}{})",
        n.name,
        number::setting(n.value),
        n.unit,
        n.distribution,
        number::setting(n.spread),
        n.unit
    )
}

/// Uncertain figures, and validity of linear propagation.
fn uncertain_words(band: &UncertaintyBand) -> String {
    let numbers = band.uncertain.iter().map(uncertain_number);
    let numbers: Vec<String> = numbers.collect();
    let linear = match band.before.linear_is_enough {
        true => "Linear propagation agrees",
        false => "Linear propagation is not enough: the errors are not linear in these numbers",
    };
    format!(
        "Machines drawn with {}, seed {}. Mean and standard deviation of the largest error over {} machines, at {} places. {linear} (before compensation: a deviation of {}).",
        numbers.join("; "),
        band.seed,
        number::count(band.machines),
        number::count(band.places.len()),
        number::length(band.before.deviation_by_line_mm, 2, Rounding::Nearest)
    )
}

/// Something that a program leaves, or that its figures do not cover. It holds no words, so that every language says the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Left {
    /// The tool is turned.
    Tilt,
    /// The force of the cut may be another.
    ForceOfCut,
    /// Machine and force may be others.
    Uncertain,
    /// Digits that are not written.
    Rounding,
    /// Steps at corners.
    CornerSteps,
    /// Steps where a rapid ends.
    EntrySteps,
    /// Rate of change of the correction.
    Change,
    /// Steps against the motion.
    Backwards,
    /// Pieces that are cut more slowly.
    FeedLimited,
}

/// Remarks on a run, in order.
pub(crate) fn left(result: &Shown<'_>) -> Vec<Left> {
    let summary = &result.summary;
    let written = result.run_inputs.compensated;
    let all = [
        (true, Left::Tilt),
        (result.force_band.is_some(), Left::ForceOfCut),
        (result.uncertainty.is_some(), Left::Uncertain),
        (written, Left::Rounding),
        (written, Left::CornerSteps),
        (written && summary.entry_steps > 0, Left::EntrySteps),
        (
            written && summary.largest_change_mm_per_mm.is_some(),
            Left::Change,
        ),
        (
            written && summary.largest_backward_step_mm > 0.0,
            Left::Backwards,
        ),
        (
            written && summary.feed_limited_pieces > 0,
            Left::FeedLimited,
        ),
    ];
    let said = all.into_iter().filter(|(is_said, _)| *is_said);
    said.map(|(_, left)| left).collect()
}

/// Uncorrected errors of the written program: name, size, explanation.
pub(crate) fn uncorrected(result: &Shown<'_>) -> Vec<Value> {
    let all = left(result).into_iter();
    all.map(|left| context! { name => left.name(), size => left.size(result), text => left.text(result) })
        .collect()
}

impl Left {
    /// Name in English.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Tilt => "Tilt of the tool",
            Self::ForceOfCut => "Force of the cut",
            Self::Uncertain => "Machine and force as they may be",
            Self::Rounding => "Rounding",
            Self::CornerSteps => "Corner steps",
            Self::EntrySteps => "Steps where a rapid ends",
            Self::Change => "Change of the correction",
            Self::Backwards => "Way backwards",
            Self::FeedLimited => "Feed limited",
        }
    }

    /// Figure; of steps the longest one, of limited feeds the slowest speed.
    pub(crate) fn figure(self, result: &Shown<'_>) -> String {
        let figures = &result.figures;
        let summary = &result.summary;
        let or_missing = |text: &Option<String>| text.clone().unwrap_or_else(|| MISSING.to_owned());
        match self {
            Self::Tilt => figures.rotation.clone(),
            Self::ForceOfCut => {
                let error = result.force_band.as_ref().and_then(|b| b.max_error_mm());
                error.map_or_else(
                    || MISSING.to_owned(),
                    |error| number::length(error, 3, Rounding::Up),
                )
            }
            Self::Uncertain => {
                let band = result.uncertainty.as_ref();
                let shown = band.map(|band| band.after.as_ref().unwrap_or(&band.before));
                shown.map_or_else(
                    || MISSING.to_owned(),
                    |shown| number::typeset(&shown.band_text()),
                )
            }
            Self::Rounding => figures.rounding.clone(),
            Self::CornerSteps => or_missing(&figures.corner_step),
            Self::EntrySteps => or_missing(&figures.entry_step),
            Self::Change => or_missing(&figures.change),
            Self::Backwards => number::length(summary.largest_backward_step_mm, 3, Rounding::Up),
            Self::FeedLimited => number::with_unit(
                &number::significant(
                    summary.slowest_limited_speed_percent.unwrap_or(f64::NAN),
                    2,
                    Rounding::Down,
                ),
                "%",
            ),
        }
    }

    /// Number of occurrences; `None` for what is not counted.
    pub(crate) fn counted(self, result: &Shown<'_>) -> Option<usize> {
        match self {
            Self::CornerSteps => Some(result.summary.corner_steps),
            Self::EntrySteps => Some(result.summary.entry_steps),
            Self::FeedLimited => Some(result.summary.feed_limited_pieces),
            _ => None,
        }
    }

    /// Size in English.
    pub(crate) fn size(self, result: &Shown<'_>) -> String {
        match (self, self.counted(result)) {
            (Self::FeedLimited, Some(pieces)) => number::counted(pieces, "piece"),
            (_, Some(0)) => "none".to_owned(),
            (_, Some(steps)) => {
                format!("{}, longest {}", number::count(steps), self.figure(result))
            }
            (_, None) => self.figure(result),
        }
    }

    /// Explanation in English.
    pub(crate) fn text(self, result: &Shown<'_>) -> String {
        let summary = &result.summary;
        match self {
            Self::Tilt => {
                "Load, weight and assembly errors turn the tool as well as moving it. A program of positions moves the tool tip back to its place but \
                 cannot turn it back; a side wall cut deep below the tip shows it."
                    .to_owned()
            }
            Self::ForceOfCut => result.force_band_text().unwrap_or_default(),
            Self::Uncertain => {
                let band = result.uncertainty.as_ref();
                band.map_or_else(String::new, uncertain_words)
            }
            Self::Rounding => format!(
                "Numbers are written with {} decimals at least: those that had more keep them. This part of the error after compensation comes from that alone.",
                result.run_inputs.decimals
            ),
            Self::CornerSteps => format!(
                "Where the load turns at once, as at a sharp corner, the correction turns with it: the program makes a short \
                 step there while the tool stays at its corner. {}",
                result.corners_text().unwrap_or_default()
            )
            .trim_end()
            .to_owned(),
            Self::EntrySteps => {
                "The load is there at once where a rapid ends: the program makes a step while the tool stays at its \
                 place."
                    .to_owned()
            }
            Self::Change => change(result),
            Self::Backwards => format!(
                "The longest step or piece against the direction of motion; {} are longer than {}.",
                number::count(summary.backward_steps),
                number::length_setting(summary.backward_step_limit_mm)
            ),
            Self::FeedLimited => format!(
                "Their feed is held to {} times the programmed one, so the part is cut more slowly there than \
                 programmed, the slowest at {} of its speed, first at line {}.",
                summary.max_feed_factor,
                self.figure(result).replace('\u{202f}', " "),
                number::count(summary.feed_limited_line.unwrap_or(0))
            ),
        }
    }
}

/// The fastest change of the correction outside steps, with its line, beside what is stated.
fn change(result: &Shown<'_>) -> String {
    let Some(change) = result.summary.largest_change_mm_per_mm else {
        return String::new();
    };
    let line = number::count(change.line);
    let beside = match (change.stated, change.lines_beyond) {
        (Some(stated), 0) => format!(
            "; no line changes faster than the {stated} mm/mm that are stated (largest_step_mm_per_mm)"
        ),
        (Some(stated), lines) => format!(
            ". {} faster than stated ({stated} mm/mm at this one, largest_step_mm_per_mm): see the warnings",
            match lines {
                1 => "1 line changes".to_owned(),
                lines => format!("{} lines change", number::count(lines)),
            }
        ),
        (None, _) => String::new(),
    };
    format!(
        "The fastest one per mm of path outside steps, from the written positions, at line {line}{beside}."
    )
}

/// The first lines under the title: what the result is about.
pub(crate) fn heading(result: &Shown<'_>) -> Vec<Value> {
    let run_inputs = &result.run_inputs;
    let mut rows = Vec::new();
    if let Some(date) = &run_inputs.date {
        rows.push(fact("Date", text::shorten(date, 20)));
    }
    rows.extend([fact("Program", first_screen(&run_inputs.program))]);
    let part = [
        ("Part number", &run_inputs.part_number),
        ("Revision", &run_inputs.revision),
    ];
    rows.extend(
        part.into_iter()
            .filter_map(|(name, text)| Some(fact(name, text.clone()?))),
    );
    rows.extend([
        fact("Machine", first_screen(&run_inputs.model)),
        fact("Load", first_screen(&run_inputs.load)),
    ]);
    if let Some(flat) = &run_inputs.flat {
        rows.push(fact("Lines", first_screen(&flat.description())));
    }
    if run_inputs.compensated {
        rows.push(fact(
            "Tolerance",
            format!(
                "path {}, chords of arcs {}",
                number::length_setting(rounded(run_inputs.tolerance_mm)),
                number::length_setting(rounded(run_inputs.chord_tolerance_mm))
            ),
        ));
    }
    rows
}

/// A share of what was set, to four digits.
fn rounded(share: f64) -> f64 {
    format!("{share:.3e}").parse().unwrap_or(share)
}

/// Text for the first screen, where an endless name must not push the result away.
fn first_screen(text: &str) -> String {
    text::shorten(&or_unknown(text), 200)
}

fn fact(name: &str, text: String) -> Value {
    context! { name, lines => vec![text] }
}

/// Length, time and blocks per second of the feed moves, before and after where a program was written.
fn length_and_time(summary: &Summary) -> String {
    let with = |value: Option<f64>, digits: usize, unit: &str| {
        value.map_or_else(
            || "unknown".to_owned(),
            |value| {
                let text = number::significant(value, digits, Rounding::Nearest);
                number::with_unit(&text, unit)
            },
        )
    };
    let mm = |value: f64| with(Some(value), 5, "mm");
    if summary.feed_length_after_mm == 0.0 {
        return mm(summary.feed_length_mm);
    }
    format!(
        "{}, {}, {} blocks a second before; {}, {}, {} after",
        mm(summary.feed_length_before_mm),
        with(summary.feed_time_before_s, 4, "s"),
        with(summary.mean_blocks_per_second_before, 3, "").trim(),
        mm(summary.feed_length_after_mm),
        with(summary.feed_time_after_s, 4, "s"),
        with(summary.mean_blocks_per_second_after, 3, "").trim(),
    )
}

fn list(name: &str, lines: &[String]) -> Value {
    let mut lines: Vec<String> = lines.iter().map(|line| text::clean(line)).collect();
    if lines.is_empty() {
        lines.push("not stated".to_owned());
    }
    context! { name, lines }
}

fn file(file: &FileRead) -> String {
    format!("{} {}: {}", file.what, file.name, file.sha256)
}

/// Inputs of the run, and the way in which the program was written.
pub(crate) fn inputs_of_run(result: &Shown<'_>) -> Vec<Value> {
    let (summary, run_inputs) = (&result.summary, &result.run_inputs);
    let deviations: Vec<String> = run_inputs
        .model_deviations
        .iter()
        .map(|line| text::clean(line))
        .collect();
    let mut rows = vec![
        fact("Machine model", or_unknown(&run_inputs.model)),
        fact("Model from", or_unknown(&run_inputs.model_source)),
        context! {
            name => "Deviations from the drawing",
            lines => if deviations.is_empty() { vec!["none".to_owned()] } else { deviations },
        },
        list("Stiffnesses used", &run_inputs.stiffnesses),
        fact("Program", or_unknown(&run_inputs.program)),
        list(
            "Files and their SHA-256",
            &run_inputs.files.iter().map(file).collect::<Vec<_>>(),
        ),
        fact("Load", or_unknown(&run_inputs.load)),
        list("Cutting force", &run_inputs.cut),
        fact("Where the program lies", or_unknown(&run_inputs.placement)),
        fact("Tool", or_unknown(&run_inputs.tool)),
        fact(
            "Orientation of the tool",
            or_unknown(&run_inputs.tool_orientation),
        ),
        fact("Path cut", extent(run_inputs, &result.figures.feed_length)),
        fact("Actuators", actuator_names(run_inputs)),
        fact("Length and time at feed", length_and_time(summary)),
        fact("Points calculated", number::count(summary.points)),
        fact(
            "Blocks read",
            format!(
                "{} ({} bytes)",
                number::count(summary.blocks),
                number::count(summary.bytes_in)
            ),
        ),
    ];
    if let Some(flat) = &run_inputs.flat {
        rows.push(list("Written flat with", &flat.settings));
    }
    if run_inputs.compensated {
        rows.extend(written(result));
    } else {
        rows.push(fact("Blocks written", "none, analysis only".to_owned()));
    }
    rows.push(fact(
        "kinetostat",
        format!("version {}", or_unknown(&result.kinetostat_version)),
    ));
    rows
}

fn written(result: &Shown<'_>) -> Vec<Value> {
    let (summary, run_inputs) = (&result.summary, &result.run_inputs);
    // Every block read must be found again in one of the three counts.
    let carried = summary
        .blocks_split
        .saturating_add(summary.blocks_unchanged);
    let corrected = summary.blocks.saturating_sub(carried);
    vec![
        fact(
            "Blocks written",
            format!(
                "{} ({} bytes); of those read, {} were divided, {} corrected in one piece and {} \
                 carried over byte for byte",
                number::count(summary.blocks_out),
                number::count(summary.bytes_out),
                number::count(summary.blocks_split),
                number::count(corrected),
                number::count(summary.blocks_unchanged)
            ),
        ),
        fact(
            "Straight pieces written",
            match &result.figures.shortest_piece {
                Some(shortest) => format!(
                    "{}, the shortest of a divided block {shortest}",
                    number::count(summary.pieces)
                ),
                None => format!("{}, no block was divided", number::count(summary.pieces)),
            },
        ),
        fact(
            "Most blocks per second",
            match &result.figures.blocks_per_second {
                Some(most) => format!("{most} at the programmed feed"),
                None => "not known: it is that of 16 blocks in a row with a known time".to_owned(),
            },
        ),
        fact(
            "Speed along the part",
            match summary.feed_limited_pieces {
                0 => format!("within {} of the programmed one", result.figures.speed),
                pieces => format!(
                    "within {} of the programmed one, but for {} whose feed is limited: the slowest has {} % of it",
                    result.figures.speed,
                    number::counted(pieces, "piece"),
                    number::significant(
                        summary.slowest_limited_speed_percent.unwrap_or(f64::NAN),
                        2,
                        Rounding::Down
                    ),
                ),
            },
        ),
        fact(
            "Tolerance of the path",
            match text::clean(&run_inputs.tolerance_from) {
                from if from.is_empty() => number::length_setting(run_inputs.tolerance_mm),
                from => format!(
                    "{}: {from}",
                    number::length_setting(run_inputs.tolerance_mm)
                ),
            },
        ),
        fact(
            "Tolerance of chords in arcs",
            number::length_setting(run_inputs.chord_tolerance_mm),
        ),
        fact(
            "Decimals written, at least",
            run_inputs.decimals.to_string(),
        ),
        fact(
            "Error allowed in all",
            number::against(summary.max_position_error_after_mm, result.allowed_mm()).1,
        ),
    ]
}

fn extent(run_inputs: &RunInputs, length: &str) -> String {
    let axes: Vec<String> = ["X", "Y", "Z"]
        .iter()
        .enumerate()
        .map(|(axis, name)| {
            let corner = |value: f64| number::fixed(value, 3);
            format!(
                "{name} {} to {}",
                corner(run_inputs.box_min_mm[axis]),
                corner(run_inputs.box_max_mm[axis])
            )
        })
        .collect();
    format!(
        "{length} long; {} (mm, program coordinates)",
        axes.join(", ")
    )
}

fn actuator_names(run_inputs: &RunInputs) -> String {
    let names: Vec<String> = run_inputs
        .actuators
        .iter()
        .map(|a| or_unknown(&a.name))
        .collect();
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

/// Caption under every plot that does not show everything: points left out because they are many, and points that
/// cannot be drawn because they have no number.
pub(crate) fn caption(result: &Shown<'_>) -> Option<String> {
    let (shown, all) = (result.points.len(), result.summary.points);
    let mut sentences = Vec::new();
    if shown < all {
        let (shown, all) = (number::count(shown), number::count(all));
        sentences.push(format!(
            "{shown} of {all} points shown: the worst of every stretch are among them."
        ));
    }
    let missing = result
        .points
        .iter()
        .filter(|point| has_missing_numbers(point))
        .count();
    if missing > 0 {
        let missing = number::count(missing);
        sentences.push(format!(
            "Points without a number, which plots and their titles leave out: {missing}."
        ));
    }
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

fn has_missing_numbers(point: &PointResult) -> bool {
    let vectors = [
        point.position_mm,
        point.error_before_mm,
        point.error_after_mm,
    ];
    let single = [point.path_mm, point.smallest_stiffness_n_per_mm];
    let lists = point
        .actuator_force
        .iter()
        .chain(&point.actuator_correction);
    let mut values = vectors
        .iter()
        .flatten()
        .chain(&single)
        .chain(lists)
        .chain(&point.share_to_buckling);
    values.any(|value| number::drawable(*value).is_none())
}
