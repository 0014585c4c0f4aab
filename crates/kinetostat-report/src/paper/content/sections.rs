//! Sections of a paper: features, worst lines, drives, the cut, chatter and forced vibrations.

use kinetostat_machining::{CutPlace, FeatureResult, PointResult};

use crate::number::{self, Rounding, norm};
use crate::paper::block::{Block, Cell, Column, Remark, Table};
use crate::paper::content::of::{MOST, Of, more};
use crate::paper::words::table::fill;
use crate::run::chatter;
use crate::text::{clean, shorten};

/// The verdict for each feature.
pub(super) fn features(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    let all = &of.result.features;
    if all.is_empty() {
        return Vec::new();
    }
    let mut columns = vec![
        Column::words(words.feature),
        Column::short(words.lines),
        Column::figures(words.before),
    ];
    if of.has_after() {
        columns.push(Column::figures(words.after));
    }
    columns.push(Column::figures(words.allowed));
    columns.push(Column::short(words.verdict));
    let rows = all.iter().take(MOST).map(|f| feature(of, f)).collect();
    let mut blocks = vec![
        Block::Heading(words.head_features.to_owned()),
        Block::Table(Table { columns, rows }),
    ];
    blocks.extend(more(words.more_features, all.len()));
    blocks
}

fn feature(of: &Of<'_>, feature: &FeatureResult) -> Vec<Cell> {
    let words = of.words;
    let [name, _, before, after, allowed, _] = feature.cells();
    let length = |cell: String| match cell.is_empty() {
        true => of.words.figures.missing.to_owned(),
        false => of.figure(&number::typeset(&cell)),
    };
    let [first, last] = feature.lines.map(number::count);
    let lines = match first == last {
        true => first,
        false => fill(
            words.lines_to,
            &[("first", first.as_str()), ("last", &last)],
        ),
    };
    let mut cells: Vec<Cell> = vec![clean(&name).into(), lines.into(), length(before).into()];
    if of.has_after() {
        cells.push(length(after).into());
    }
    cells.push(length(allowed).into());
    cells.push(match feature.held {
        Some(true) => words.kept.to_owned().into(),
        Some(false) => Cell::strong(words.missed_here.to_owned()),
        None => words.nothing_cut.to_owned().into(),
    });
    cells
}

/// The worst lines: without compensation, and with it where something was compensated.
pub(super) fn worst(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    let result = of.result;
    if result.worst_points.is_empty() {
        return Vec::new();
    }
    let note = match of.paper.verified {
        Some(_) => words.worst_note_verified,
        None => words.worst_note,
    };
    let mut blocks = vec![
        Block::Heading(words.head_worst.to_owned()),
        Block::Note(note.to_owned()),
        worst_table(of, &result.worst_points),
    ];
    if !result.worst_points_after.is_empty() {
        blocks.push(Block::Note(words.worst_after_note.to_owned()));
        blocks.push(worst_table(of, &result.worst_points_after));
    }
    blocks
}

fn worst_table(of: &Of<'_>, points: &[PointResult]) -> Block {
    let words = of.words;
    let after = of.has_after();
    let mut columns = vec![Column::words(words.line)];
    columns.extend(["X,\u{a0}mm", "Y,\u{a0}mm", "Z,\u{a0}mm", words.before].map(Column::figures));
    if after {
        columns.extend([words.after, words.line_written].map(Column::figures));
    }
    let rows = points.iter().take(10).map(|point| {
        let mut cells = vec![Cell::from(line(of, point.line))];
        let places = point.position_mm.map(|mm| number::fixed(mm, 3));
        cells.extend(places.map(|text| Cell::from(of.figure(&text))));
        cells.push(of.length(norm(&point.error_before_mm)).into());
        if after {
            cells.push(of.length(norm(&point.error_after_mm)).into());
            cells.push(match point.output_line {
                0 => Cell::from(words.none.to_owned()),
                written => number::count(written).into(),
            });
        }
        cells
    });
    Block::Table(Table {
        columns,
        rows: rows.collect(),
    })
}

/// A line; of a flat program with the one that it came from.
fn line(of: &Of<'_>, line: usize) -> String {
    let flat = of.result.run_inputs.flat.as_ref();
    let number = number::count(line);
    match flat.and_then(|flat| flat.source_of(line)) {
        Some((file, from)) => {
            let (file, from) = (shorten(file, 40), number::count(from));
            let values = [("line", from.as_str()), ("file", &file)];
            format!("{number} ({})", fill(of.words.line_from, &values))
        }
        None => number,
    }
}

/// Forces and torques of drives against their ratings, and joints between their limits.
pub(super) fn drives(of: &Of<'_>) -> Vec<Block> {
    let (words, result) = (of.words, of.result);
    let actuators = &result.run_inputs.actuators;
    let mut blocks = vec![Block::Heading(words.head_drives.to_owned())];
    let rated = actuators.iter().any(|a| a.rating.is_some());
    let limited = actuators.iter().any(|a| a.limits.is_some());
    let corrected = result.run_inputs.compensated;
    let mut columns = vec![
        Column::words(words.drive),
        Column::figures(words.largest_force),
    ];
    if rated {
        columns.extend([words.rating, words.share].map(Column::figures));
    }
    if corrected {
        columns.push(Column::figures(words.correction));
    }
    columns.push(Column::figures(words.range));
    if limited {
        columns.push(Column::figures(words.limits));
    }
    let missing = || Cell::from(words.figures.missing.to_owned());
    let span = |[low, high]: [f64; 2], unit: &str| {
        let tenth = |value: f64| number::fixed(value, 1);
        let text = format!("{} … {}", tenth(low), number::with_unit(&tenth(high), unit));
        Cell::from(of.figure(&text))
    };
    let figures = &result.figures;
    let cell = |list: &[String], at: usize| {
        list.get(at)
            .map_or_else(missing, |text| of.figure(text).into())
    };
    let rows = actuators.iter().enumerate().map(|(at, actuator)| {
        let unit = clean(&actuator.motion_unit);
        let mut cells = vec![
            Cell::from(of.text(&actuator.name)),
            cell(&figures.actuator_force, at),
        ];
        if rated {
            let force = result.summary.max_actuator_force.get(at);
            let rating = actuator.rating.filter(|rating| *rating > 0.0);
            cells.push(rating.map_or_else(missing, |rating| {
                let text = number::with_unit(&number::setting(rating), &actuator.force_unit);
                of.figure(&text).into()
            }));
            let share = force
                .zip(rating)
                .map(|(force, rating)| force.abs() / rating);
            cells.push(share.map_or_else(missing, |share| {
                let text = kinetostat_machining::number::share(share);
                let text = of.figure(&number::typeset(&text));
                match share > 1.0 {
                    true => Cell::strong(text),
                    false => text.into(),
                }
            }));
        }
        if corrected {
            cells.push(cell(&figures.actuator_correction, at));
        }
        let range = result.joints.ranges.get(at);
        cells.push(range.map_or_else(missing, |range| span(*range, &unit)));
        if limited {
            let limits = actuator.limits;
            cells.push(limits.map_or_else(missing, |limits| span(limits, &unit)));
        }
        cells
    });
    let rows = rows.collect();
    blocks.push(Block::Table(Table { columns, rows }));
    if !rated {
        blocks.push(Block::Note(words.no_ratings.to_owned()));
    }
    let remarks = joints(of);
    if !remarks.is_empty() {
        blocks.push(Block::Remarks(remarks));
    }
    blocks
}

/// Joint nearest to its limit, most loaded joint, and configuration of an arm.
fn joints(of: &Of<'_>) -> Vec<Remark> {
    let (words, result) = (of.words, of.result);
    let name = |at: usize| {
        let actuator = result.run_inputs.actuators.get(at);
        of.text(actuator.map_or("", |a| a.name.as_str()))
    };
    let mut remarks = Vec::new();
    let mut remark = |name, size, text| remarks.push(Remark::new(name, size, text));
    if let (Some(found), Some(size)) = (&result.joints.nearest_limit, &result.figures.nearest_limit)
    {
        let (drive, line) = (name(found.limit.actuator), number::count(found.line));
        let end = words.end(found.limit.end);
        let values = [("drive", drive.as_str()), ("end", end), ("line", &line)];
        let text = fill(words.nearest_limit_text, &values);
        remark(words.nearest_limit, of.figure(size), text);
    }
    if let (Some(found), Some(size)) = (&result.joints.most_loaded, &result.figures.share_of_rating)
    {
        let (drive, line) = (name(found.drive.actuator), number::count(found.line));
        let values = [("drive", drive.as_str()), ("line", &line)];
        let text = fill(words.most_loaded_text, &values);
        remark(words.most_loaded, of.figure(size), text);
    }
    if let Some(arm) = &result.joints.configuration {
        let changes = match result.joints.change_count {
            0 => String::new(),
            count => {
                let count = number::count(count);
                fill(words.configuration_changes, &[("count", count.as_str())])
            }
        };
        remark(words.configuration, words.arm(arm), changes);
    }
    remarks
}

/// Lines with the largest forces of the cut.
pub(super) fn cut(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    let cut = of.result.cutting.as_ref();
    let Some(cut) = cut.filter(|cut| !cut.worst_lines.is_empty()) else {
        return Vec::new();
    };
    let limited = cut.nearest_to_spindle.is_some();
    let mut columns = vec![Column::words(words.line)];
    columns.extend([words.cut_force, words.cut_torque].map(Column::figures));
    if limited {
        columns.push(Column::figures(words.cut_share));
    }
    columns.extend([words.cut_power, words.cut_depth].map(Column::figures));
    let digits = |value: f64, unit: &str| Cell::from(of.significant(value, 3, unit));
    let row = |place: &CutPlace| {
        let mut cells = vec![
            Cell::from(line(of, place.line)),
            digits(place.force_n(), "N"),
            digits(place.torque_n_m, "N m"),
        ];
        if limited {
            let share = place.share_of_spindle().unwrap_or(f64::NAN);
            cells.push(digits(100.0 * share, "%"));
        }
        cells.extend([digits(place.power_w, "W"), digits(place.depth_mm, "mm")]);
        cells
    };
    let rows = cut.worst_lines.iter().map(row).collect();
    let mut blocks = vec![
        Block::Heading(words.head_cut.to_owned()),
        Block::Table(Table { columns, rows }),
    ];
    if cut.spread_percent > 0.0 {
        let percent = number::significant(cut.spread_percent, 2, Rounding::Nearest);
        let percent = of.figure(&percent);
        let text = fill(words.cut_spread, &[("percent", percent.as_str())]);
        blocks.push(Block::Note(text));
    }
    let nearest = cut.nearest_to_spindle.as_ref();
    if nearest
        .and_then(CutPlace::share_of_spindle)
        .is_some_and(|share| share > 1.0)
    {
        blocks.push(Block::Paragraph(words.cut_spindle.to_owned()));
    }
    blocks
}

/// The section; nothing where chatter was not judged.
pub(super) fn chatter(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    let Some(found) = &of.result.chatter else {
        return Vec::new();
    };
    let digits = |value: f64, unit: &str| of.significant(value, 3, unit);
    let mut blocks = vec![Block::Heading(words.head_chatter.to_owned())];
    let verdict = match (found.stretches.len(), found.places_judged) {
        (0, 0) => words.chatter_unjudged,
        (0, _) => words.chatter_none,
        _ => words.chatter_some,
    };
    let without = found.without_answer();
    let verdict = match without {
        0 => verdict.to_owned(),
        _ => {
            let count = number::count(without);
            let said = fill(words.chatter_without, &[("count", count.as_str())]);
            format!("{verdict} {said}")
        }
    };
    blocks.push(Block::Paragraph(verdict));
    if !found.stretches.is_empty() {
        let mut columns = vec![Column::words(words.lines)];
        columns.extend(words.chatter_columns.map(Column::figures));
        let row = |stretch| {
            let numbers = chatter::cells(stretch).map(|text| Cell::from(of.figure(&text)));
            numbers.to_vec()
        };
        let rows = found
            .stretches
            .iter()
            .take(chatter::MOST)
            .map(row)
            .collect();
        blocks.push(Block::Table(Table { columns, rows }));
    }
    let mut remarks = Vec::new();
    let mut remark = |name, size, text| remarks.push(Remark::new(name, size, text));
    if let Some((place, limit)) = found.nearest.as_ref().and_then(|p| Some((p, p.limit_mm?))) {
        let (line, depth) = (number::count(place.line), digits(place.depth_mm, "mm"));
        let values = [("line", line.as_str()), ("depth", &depth)];
        let mut text = fill(words.chatter_nearest_text, &values);
        if let (true, Some(least)) = (place.is_within_spread(), place.limit_with_more_force_mm()) {
            let (spread, least) = (digits(place.force_spread_percent, "%"), digits(least, "mm"));
            let values = [("spread", spread.as_str()), ("limit", &least)];
            text.push_str(&fill(words.chatter_spread_text, &values));
        }
        remark(words.chatter_nearest, digits(limit, "mm"), text);
    }
    let shaken = found.most_shaken.as_ref();
    if let Some((place, rms)) = shaken.and_then(|p| Some((p, p.vibration_rms_um?))) {
        let (line, hz) = (
            number::count(place.line),
            digits(place.strongest_hz.unwrap_or(f64::NAN), "Hz"),
        );
        let mode = digits(place.nearest_mode_hz.unwrap_or(f64::NAN), "Hz");
        let values = [("line", line.as_str()), ("frequency", &hz), ("mode", &mode)];
        remark(
            words.shaken,
            digits(rms, "µm"),
            fill(words.shaken_text, &values),
        );
    }
    let wall = found.worst_wall.as_ref();
    if let Some((place, wall)) = wall.and_then(|p| Some((p, p.wall_um?))) {
        let line = number::count(place.line);
        let [deep, standing] = words.wall_sides;
        let side = if wall > 0.0 { deep } else { standing };
        let values = [("line", line.as_str()), ("side", side)];
        remark(
            words.wall,
            digits(wall.abs(), "µm"),
            fill(words.wall_text, &values),
        );
    }
    if !remarks.is_empty() {
        blocks.push(Block::Remarks(remarks));
    }
    let damping = clean(&found.damping);
    let values = [("damping", damping.as_str())];
    blocks.push(Block::Note(fill(words.chatter_note, &values)));
    blocks
}
