//! A run in words: the verdict, then the figures in a table, readable at 80 columns.

use kinetostat_machining::{PointResult, RunResult};

use crate::screen::{columns, fixed, item, mm, number, triple, wrapped};

/// The result of a run for a person.
pub(crate) fn of_run(result: &RunResult) -> String {
    let mut out = String::new();
    let q = &result.question;
    out.push_str(&wrapped(
        &format!("{} on {} ({})", q.program, q.model, q.model_source),
        0,
    ));
    out.push('\n');
    out.push_str(&wrapped(&verdict(result), 2));
    out.push('\n');
    out.push_str(&figures(result));
    out.push('\n');
    out.push_str(&actuators(result));
    out.push_str(&worst(result));
    out.push_str(&warnings(&result.warnings));
    out
}

/// One or two sentences that answer the question.
pub(crate) fn verdict(result: &RunResult) -> String {
    let s = &result.summary;
    let before = s.max_position_error_before_mm;
    let mut text = if let Some(unchanged) = result.unchanged_in_words() {
        format!(
            "{unchanged} The tool is up to {} mm off its path.",
            fixed(s.max_position_error_after_mm, 5)
        )
    } else if result.question.compensated {
        let after = s.max_position_error_after_mm;
        let held = result.tolerance.held == Some(true);
        let first = match held {
            true => String::new(),
            false => format!("{} ", missed(result)),
        };
        let bound = match held {
            true => format!(
                ", inside the {} mm that are allowed",
                fixed(result.tolerance.allowed_mm, 5)
            ),
            false => String::new(),
        };
        format!(
            "{first}As programmed, the tool would be up to {} mm off its path. With the compensated program it stays within {} mm{bound}, solved again from the bytes as written. These figures are the model's: they are as true as its stiffnesses and masses.",
            mm(before),
            fixed(after, 5)
        )
    } else {
        format!(
            "As programmed, the tool is up to {} mm off its path.",
            mm(before)
        )
    };
    if let Some(corners) = result.corners_in_words() {
        text.push(' ');
        text.push_str(&corners);
    }
    if !s.stable {
        text.push_str(" THE MACHINE IS NOT STABLE under this load: do not run this program.");
    }
    text
}

/// That the tolerance is missed, where, by how much and why.
pub(crate) fn missed(result: &RunResult) -> String {
    let t = &result.tolerance;
    match &t.missed {
        Some(m) => format!(
            "THE TOLERANCE IS MISSED at line {} (line {} of the written program): the tool is {} mm off, more than the {} mm that are allowed; {}.",
            m.line,
            m.output_line,
            fixed(m.error_mm, 5),
            fixed(t.allowed_mm, 5),
            m.reason
        ),
        None => format!("THE TOLERANCE of {} mm IS MISSED.", fixed(t.allowed_mm, 5)),
    }
}

fn figures(result: &RunResult) -> String {
    let s = &result.summary;
    let compensated = result.question.compensated;
    let mut rows = Vec::new();
    let mut row = |cells: &[&str]| rows.push(cells.iter().map(|c| (*c).to_owned()).collect());
    if compensated {
        row(&["", "before", "after", ""]);
        row(&[
            "largest position error",
            &mm(s.max_position_error_before_mm),
            &fixed(s.max_position_error_after_mm, 5),
            "mm",
        ]);
        row(&[
            "root mean square of it",
            &mm(s.rms_position_error_before_mm),
            &fixed(s.rms_position_error_after_mm, 5),
            "mm",
        ]);
        row(&[
            "of that by rounding",
            "",
            &fixed(s.max_rounding_error_mm, 5),
            "mm",
        ]);
        row(&[
            "error allowed in all",
            "",
            &fixed(result.tolerance.allowed_mm, 5),
            "mm",
        ]);
        row(&["largest correction", "", &mm(s.max_correction_mm), "mm"]);
        row(&[
            "tool tilt that stays",
            "",
            &fixed(s.max_residual_rotation_deg, 4),
            "deg",
        ]);
        row(&[
            "speed along the part, error",
            "",
            &fixed(s.max_speed_deviation_percent, 3),
            "%",
        ]);
        if s.feed_limited_pieces > 0 {
            row(&[
                "pieces slower, feed limited",
                "",
                &s.feed_limited_pieces.to_string(),
                "",
            ]);
        }
        if s.corner_steps > 0 {
            row(&["corner steps", "", &s.corner_steps.to_string(), ""]);
            row(&["longest of them", "", &mm(s.largest_corner_step_mm), "mm"]);
            row(&[
                "longest way backwards",
                "",
                &mm(s.largest_backward_step_mm),
                "mm",
            ]);
        }
        row(&[
            "length at feed",
            &fixed(s.feed_length_before_mm, 1),
            &fixed(s.feed_length_after_mm, 1),
            "mm",
        ]);
        if let (Some(before), Some(after)) = (s.feed_time_before_s, s.feed_time_after_s) {
            row(&["time at feed", &fixed(before, 1), &fixed(after, 1), "s"]);
        }
        row(&[
            "blocks",
            &s.blocks.to_string(),
            &s.blocks_out.to_string(),
            "",
        ]);
        row(&[
            "bytes",
            &s.bytes_in.to_string(),
            &s.bytes_out.to_string(),
            "",
        ]);
        row(&[
            "shortest piece of a split block",
            "",
            &fixed(s.smallest_piece_mm, 3),
            "mm",
        ]);
        let per_second = |rate: Option<f64>| rate.map_or("-".to_owned(), |rate| number(rate, 3));
        row(&[
            "blocks per second",
            &per_second(s.mean_blocks_per_second_before),
            &per_second(s.mean_blocks_per_second_after),
            "1/s",
        ]);
        row(&[
            "most of 16 in a row",
            &per_second(s.peak_blocks_per_second_before),
            &per_second(s.peak_blocks_per_second_after),
            "1/s",
        ]);
    } else {
        row(&[
            "largest position error",
            &mm(s.max_position_error_before_mm),
            "mm",
        ]);
        row(&[
            "root mean square of it",
            &mm(s.rms_position_error_before_mm),
            "mm",
        ]);
        row(&[
            "tilt of the tool",
            &fixed(s.max_residual_rotation_deg, 4),
            "deg",
        ]);
        row(&["blocks", &s.blocks.to_string(), ""]);
    }
    let blank: &[&str] = if compensated { &[""] } else { &[] };
    let mut last = |name: &str, value: String, unit: &str| {
        let mut cells: Vec<String> = vec![name.to_owned()];
        cells.extend(blank.iter().map(|c| (*c).to_owned()));
        cells.extend([value, unit.to_owned()]);
        rows.push(cells);
    };
    last("path at feed", fixed(s.feed_length_mm, 1), "mm");
    last("points solved", s.points.to_string(), "");
    last(
        "smallest stiffness against a force",
        number(s.smallest_stiffness_n_per_mm, 4),
        "N/mm",
    );
    if let Some(mu) = s.largest_buckling_margin {
        last("share of the way to buckling", fixed(mu, 4), "of 1");
    }
    units_left(columns(&rows, 2), &rows)
}

/// Units stand left of each other, numbers right: the last column is set again.
fn units_left(text: String, rows: &[Vec<String>]) -> String {
    let width = rows
        .iter()
        .filter_map(|r| r.last())
        .map(|u| u.chars().count())
        .max()
        .unwrap_or(0);
    text.lines()
        .zip(rows)
        .map(|(line, row)| {
            let unit = row.last().map_or("", String::as_str);
            if unit.is_empty() {
                return format!("{}\n", line.trim_end());
            }
            let stem = line.strip_suffix(unit).unwrap_or(line);
            let gap = width - unit.chars().count();
            let stem = &stem[..stem.len().saturating_sub(gap)];
            format!("{stem}{unit}\n")
        })
        .collect()
}

fn actuators(result: &RunResult) -> String {
    let q = &result.question;
    let s = &result.summary;
    let mut rows = vec![vec![
        "actuator".to_owned(),
        "largest force".to_owned(),
        String::new(),
    ]];
    if q.compensated {
        rows[0].extend(["largest change".to_owned(), String::new()]);
    }
    for (i, a) in q.actuators.iter().enumerate() {
        let value = |list: &[f64]| list.get(i).copied().unwrap_or(0.0);
        let mut row = vec![
            a.name.clone(),
            fixed(value(&s.max_actuator_force), 2),
            a.force_unit.clone(),
        ];
        if q.compensated {
            row.extend([
                fixed(value(&s.max_actuator_correction), 4),
                a.motion_unit.clone(),
            ]);
        }
        rows.push(row);
    }
    columns(&rows, 2)
}

fn worst(result: &RunResult) -> String {
    if result.worst_points.is_empty() {
        return String::new();
    }
    let size = |p: &PointResult| p.error_before_mm.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut rows = vec![
        ["where it is worst", "program place, mm", "error, mm"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for point in result.worst_points.iter().take(3) {
        rows.push(vec![
            format!("line {}", point.line),
            triple(point.position_mm, |x| fixed(x, 2)),
            mm(size(point)),
        ]);
    }
    format!("\n{}", columns(&rows, 2))
}

/// Warnings as a list, or nothing.
pub(crate) fn warnings<W: std::fmt::Display>(list: &[W]) -> String {
    const SHOWN: usize = 8;
    if list.is_empty() {
        return String::new();
    }
    let mut out = format!(
        "\n{}\n",
        match list.len() {
            1 => "Warning".to_owned(),
            n => format!("{n} warnings"),
        }
    );
    for warning in list.iter().take(SHOWN) {
        out.push_str(&item(&warning.to_string()));
    }
    if list.len() > SHOWN {
        out.push_str(&format!(
            "  and {} more; the report and the JSON have them all\n",
            list.len() - SHOWN
        ));
    }
    out
}
