//! A run in words: the result, then the figures in a table, readable at 80 columns.

use kinetostat_machining::number::{
    MISSING, Rounding, against, largest, largest_length, significant, with_unit,
};
use kinetostat_machining::{Figures, PointResult, RunResult, Summary, WarningCode};

use crate::program::features::features_text;
use crate::program::flat_lines::listed_under;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, triple};
use crate::ui::warnings::warnings;

/// The result of a run for a person.
pub(crate) fn of_run(result: &RunResult) -> String {
    let mut out = String::new();
    let q = &result.run_inputs;
    out.push_str(&wrapped(
        &format!("{} on {} ({})", q.program, q.model, q.model_source),
        0,
    ));
    out.push('\n');
    out.push_str(&wrapped(&result_text(result), 2));
    out.push_str(&assumptions(result));
    out.push('\n');
    out.push_str(&figures(result));
    for sentence in result.summary.solving.sentences("point") {
        out.push_str(&wrapped(&sentence, 2));
    }
    out.push('\n');
    out.push_str(&actuators(result));
    out.push_str(&features_text(&result.features));
    out.push_str(&worst(result));
    out.push_str(&cutting_force(result));
    out.push_str(&warnings(&result.warnings));
    out.push_str(&listed_under(&out, q.flat.as_ref()));
    out
}

/// The beginning of what is said of a made program whose source starts the spindle.
pub(crate) const SPINDLE_NOT_STARTED: &str = "SPINDLE NOT STARTED by this program";

/// One or two sentences that answer the question.
pub(crate) fn result_text(result: &RunResult) -> String {
    let figures = Figures::of(result);
    let mut text = if let Some(unchanged) = result.unchanged_text() {
        format!(
            "{unchanged} The tool is up to {} off its path.",
            figures.error_after
        )
    } else if result.run_inputs.compensated {
        let held = result.tolerance.held == Some(true);
        let missed = result.tolerance.missed_text();
        let first = missed.map_or_else(String::new, |missed| format!("{missed} "));
        let (after, allowed) = against(
            result.summary.max_position_error_after_mm,
            result.tolerance.allowed_mm,
        );
        let bound = match held {
            true => format!(", inside the {allowed} that are allowed"),
            false => String::new(),
        };
        format!(
            "{first}As programmed, the tool would be up to {} off its path. With the compensated program it stays within {after}{bound}, solved again from the bytes as written. These figures are the model's: they are as true as its stiffnesses and masses.",
            figures.error_before
        )
    } else {
        format!(
            "As programmed, the tool is up to {} off its path.",
            figures.error_before
        )
    };
    if let Some(doubt) = result.at_worst_text() {
        text.push(' ');
        text.push_str(&doubt);
    }
    let mut warnings = result.warnings.iter();
    if warnings.any(|warning| warning.code == WarningCode::SpindleNotStarted) {
        text = format!("{SPINDLE_NOT_STARTED}. {text}");
    }
    if !result.summary.stable {
        text.push_str(" THE MACHINE IS NOT STABLE under this load: do not run this program.");
    }
    text
}

/// Assumptions of the run, the costliest first.
pub(crate) fn assumptions(result: &RunResult) -> String {
    let all = &result.assessment.assumptions;
    if all.is_empty() {
        return String::new();
    }
    let items = all.iter().map(|assumption| match assumption.up_to_um {
        Some(um) => item(&format!(
            "{}: {}",
            largest_length(1e-3 * um),
            assumption.text
        )),
        None => item(&assumption.text),
    });
    format!(
        "\nAssumptions, by the error of the tool if they fail\n{}",
        items.collect::<String>()
    )
}

/// Rows of figures: a name, and what it is before and after.
struct Table {
    compensated: bool,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn row(&mut self, name: &str, before: &str, after: &str) {
        let cells = match self.compensated {
            true => vec![name, before, after],
            false => vec![name, before],
        };
        self.rows
            .push(cells.into_iter().map(str::to_owned).collect());
    }

    /// A figure of the run, in the last column.
    fn last(&mut self, name: &str, value: &str) {
        match self.compensated {
            true => self.row(name, "", value),
            false => self.row(name, value, ""),
        }
    }
}

/// The figures: a name, and what it is before and after.
fn figures(result: &RunResult) -> String {
    let s = &result.summary;
    let f = Figures::of(result);
    let mut table = Table {
        compensated: result.run_inputs.compensated,
        rows: Vec::new(),
    };
    if table.compensated {
        table.row("", "before", "after");
    }
    table.row("largest position error", &f.error_before, &f.error_after);
    table.row("root mean square of it", &f.rms_before, &f.rms_after);
    match table.compensated {
        true => {
            corrections(&mut table, result, &f);
            steps(&mut table, s, &f);
            sizes(&mut table, s, &f);
        }
        false => {
            table.row("tilt of the tool", &f.rotation, "");
            table.row("blocks", &s.blocks.to_string(), "");
        }
    }
    table.last("path at feed", &f.feed_length);
    table.last("points solved", &s.points.to_string());
    table.last("smallest stiffness against a force", &f.stiffness);
    if let Some(share) = &f.share_to_buckling {
        table.last("share of the way to buckling", share);
    }
    if let Some(distance) = &f.nearest_limit {
        table.last("smallest distance to a limit", distance);
    }
    if let Some(share) = &f.share_of_rating {
        table.last("largest share of a rating", share);
    }
    columns(&table.rows, 2)
}

/// Adds rows of the corrections and their residuals.
fn corrections(table: &mut Table, result: &RunResult, f: &Figures) {
    let s = &result.summary;
    table.row("of that by rounding", "", &f.rounding);
    let allowed = against(s.max_position_error_after_mm, result.tolerance.allowed_mm).1;
    table.row("error allowed in all", "", &allowed);
    table.row("largest correction", "", &f.correction);
    if let (Some(value), Some(change)) = (&f.change, &s.largest_change_mm_per_mm) {
        table.row(
            &format!("largest change outside steps, line {}", change.line),
            "",
            value,
        );
        if let Some(stated) = change.stated {
            table.row("largest one stated", "", &format!("{stated} mm/mm"));
        }
    }
    table.row("tool tilt that stays", "", &f.rotation);
    // Pieces whose feed is limited are slower, and have a row of their own.
    let speed = match s.feed_limited_pieces {
        0 => "speed along the part, error",
        _ => "its error where no feed is limited",
    };
    if s.feed_limited_pieces > 0 {
        let slowest = s.slowest_limited_speed_percent.unwrap_or(f64::NAN);
        let slowest = with_unit(&significant(slowest, 2, Rounding::Down), "%");
        table.row("slowest speed along the part", "", &slowest);
    }
    table.row(speed, "", &f.speed);
    let of = |count: usize| count.to_string();
    if s.feed_limited_pieces > 0 {
        table.row(
            "pieces slower, feed limited",
            "",
            &of(s.feed_limited_pieces),
        );
    }
}

/// Steps that the corrected path has at corners and at ends of rapids.
fn steps(table: &mut Table, s: &Summary, f: &Figures) {
    let of = |count: usize| count.to_string();
    if let Some(longest) = &f.corner_step {
        table.row("corner steps", "", &of(s.corner_steps));
        table.row("longest of them", "", longest);
    }
    if let Some(longest) = &f.entry_step {
        table.row("steps where a rapid ends", "", &of(s.entry_steps));
        table.row("longest of these", "", longest);
    }
    if s.corner_steps + s.entry_steps > 0 {
        let backwards = largest_length(s.largest_backward_step_mm);
        table.row("longest way backwards", "", &backwards);
    }
}

/// Length, time and blocks of the program before and after.
fn sizes(table: &mut Table, s: &Summary, f: &Figures) {
    let of = |count: usize| count.to_string();
    let mm = |value: f64| with_unit(&significant(value, 5, Rounding::Nearest), "mm");
    let (before, after) = (mm(s.feed_length_before_mm), mm(s.feed_length_after_mm));
    table.row("length at feed", &before, &after);
    if let (Some(before), Some(after)) = (s.feed_time_before_s, s.feed_time_after_s) {
        let seconds = |value: f64| with_unit(&significant(value, 4, Rounding::Nearest), "s");
        table.row("time at feed", &seconds(before), &seconds(after));
    }
    table.row("blocks", &of(s.blocks), &of(s.blocks_out));
    table.row("bytes", &of(s.bytes_in), &of(s.bytes_out));
    if let Some(shortest) = &f.shortest_piece {
        table.row("shortest piece of a divided block", "", shortest);
    }
    let rate = |rate: Option<f64>| rate.map_or_else(|| MISSING.to_owned(), |r| largest(r, "1/s"));
    let mean = |rate: Option<f64>| {
        let nearest = |r| with_unit(&significant(r, 3, Rounding::Nearest), "1/s");
        rate.map_or_else(|| MISSING.to_owned(), nearest)
    };
    table.row(
        "blocks per second",
        &mean(s.mean_blocks_per_second_before),
        &mean(s.mean_blocks_per_second_after),
    );
    table.row(
        "most of 16 in a row",
        &rate(s.peak_blocks_per_second_before),
        &rate(s.peak_blocks_per_second_after),
    );
}

fn actuators(result: &RunResult) -> String {
    let f = Figures::of(result);
    let compensated = result.run_inputs.compensated;
    let mut rows = vec![vec!["actuator".to_owned(), "largest force".to_owned()]];
    if compensated {
        rows[0].push("largest change".to_owned());
    }
    for (i, actuator) in result.run_inputs.actuators.iter().enumerate() {
        let mut row = vec![actuator.name.clone(), f.actuator_force[i].clone()];
        if compensated {
            row.push(f.actuator_correction[i].clone());
        }
        rows.push(row);
    }
    let mut text = columns(&rows, 2);
    text.push_str(&joints(&f));
    text
}

/// Describes the nearest limits and ratings, and the configuration of an arm.
fn joints(f: &Figures) -> String {
    let mut sentences = Vec::new();
    if f.nearest_limit.is_some() {
        sentences.push(format!("nearest to a limit: {}", f.nearest_limit_at));
    }
    if f.share_of_rating.is_some() {
        sentences.push(format!(
            "most loaded by its rating: {}",
            f.share_of_rating_at
        ));
    }
    let configuration = f.configuration.iter();
    sentences.extend(configuration.map(|found| format!("configuration: {found}")));
    let text: String = sentences.iter().map(|said| wrapped(said, 2)).collect();
    match text.is_empty() {
        true => text,
        false => format!("\n{text}"),
    }
}

/// Lists the assumptions of a force that is computed from the cut.
fn cutting_force(result: &RunResult) -> String {
    let words = &result.run_inputs.cut;
    if words.is_empty() {
        return String::new();
    }
    let mut out = "\nCutting force\n".to_owned();
    out.extend(words.iter().map(|sentence| item(sentence)));
    out
}

fn worst(result: &RunResult) -> String {
    if result.worst_points.is_empty() {
        return String::new();
    }
    let size = |p: &PointResult| p.error_before_mm.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut rows = vec![
        ["where it is worst", "program place, mm", "error"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for point in result.worst_points.iter().take(3) {
        rows.push(vec![
            format!("line {}", point.line),
            triple(point.position_mm, |x| fixed(x, 2)),
            largest_length(size(point)),
        ]);
    }
    format!("\n{}", columns(&rows, 2))
}
