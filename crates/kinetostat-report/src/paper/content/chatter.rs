//! Chatter of the program, and forced vibrations of the tool.

use crate::number;
use crate::paper::block::{Block, Cell, Column, Remark, Table};
use crate::paper::content::of::Of;
use crate::paper::words::table::fill;
use crate::run::chatter::{MOST, cells};
use crate::text::clean;

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
            let numbers = cells(stretch).map(|text| Cell::from(of.figure(&text)));
            numbers.to_vec()
        };
        let rows = found.stretches.iter().take(MOST).map(row).collect();
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
