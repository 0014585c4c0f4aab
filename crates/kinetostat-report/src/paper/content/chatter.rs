//! Where the program chatters, and how the teeth shake the tool.

use crate::number::{self, Rounding};
use crate::paper::block::{Block, Cell, Column, Remark, Table};
use crate::paper::content::of::Of;
use crate::paper::words::table::fill;
use crate::run::chatter::cells;
use crate::text::clean;

/// Most stretches shown; more are in the result file.
const MOST: usize = 20;

/// The section; nothing where chatter was not judged.
pub(super) fn chatter(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    let Some(found) = &of.result.chatter else {
        return Vec::new();
    };
    let digits = |value: f64, digits: usize, unit: &str| {
        let text = number::significant(value, digits, Rounding::Nearest);
        of.figure(&number::typeset(&format!("{text} {unit}")))
    };
    let mut blocks = vec![Block::Heading(words.head_chatter.to_owned())];
    let verdict = match (found.stretches.len(), found.places_judged) {
        (0, 0) => words.chatter_unjudged,
        (0, _) => words.chatter_none,
        _ => words.chatter_some,
    };
    blocks.push(Block::Paragraph(verdict.to_owned()));
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
    let mut remark = |name: &str, size: String, text: String| {
        remarks.push(Remark {
            name: name.to_owned(),
            size,
            text,
        });
    };
    if let Some((place, limit)) = found.nearest.as_ref().and_then(|p| Some((p, p.limit_mm?))) {
        let (line, depth) = (number::count(place.line), digits(place.depth_mm, 3, "mm"));
        let values = [("line", line.as_str()), ("depth", &depth)];
        remark(
            words.chatter_nearest,
            digits(limit, 3, "mm"),
            fill(words.chatter_nearest_text, &values),
        );
    }
    let shaken = found.most_shaken.as_ref();
    if let Some((place, rms)) = shaken.and_then(|p| Some((p, p.vibration_rms_um?))) {
        let (line, hz) = (
            number::count(place.line),
            digits(place.strongest_hz.unwrap_or(f64::NAN), 3, "Hz"),
        );
        let mode = digits(place.nearest_mode_hz.unwrap_or(f64::NAN), 3, "Hz");
        let values = [("line", line.as_str()), ("frequency", &hz), ("mode", &mode)];
        remark(
            words.shaken,
            digits(rms, 3, "um"),
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
            digits(wall.abs(), 3, "um"),
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
