//! Rounded corners and chamfers written out: the line before ends where the arc or the chamfer begins, the block RND becomes the
//! arc, the block CHF a line, and the line behind states its own end.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector2;

use crate::corner::{Cut, not_followed};
use crate::error::ProgramError;
use crate::flat_run::edited;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reading::reader::interpret;
use crate::heidenhain::reading::walker::{AS_ARC, Rounded, has_corners};
use crate::heidenhain::words::decimals;
use crate::heidenhain::writing::words::{
    Stated, before_functions, feed_text, stands, with_blanks, word_text,
};
use crate::options::ReadOptions;
use crate::text::source::{Edits, FlatText, SourceFile};

/// End of a line and the feed that it has to state.
#[derive(Default)]
struct Wanted {
    end: Option<(Vector2<f64>, f64)>,
    feed: Option<f64>,
}

/// A flat program without RND and CHF.
///
/// # Errors
/// Corners that are not followed, by file and line of the program as given.
pub(crate) fn written_out(
    flat: FlatText,
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    if !has_corners(flat.file.bytes()) {
        return Ok(flat);
    }
    let file = [flat.file.clone()];
    let found = interpret(&file, &options.as_written());
    if found.corners.is_empty() {
        return Ok(flat);
    }
    let (mut corners, mut faults) = (Vec::new(), Vec::new());
    for corner in found.corners {
        match corner {
            Ok(corner) => corners.push(corner),
            Err((span, why, remedy)) => {
                let why = not_followed(&why);
                let fault = ProgramError::of_flat(&flat, files, span.start, why, remedy);
                faults.push(fault);
            }
        }
    }
    if !faults.is_empty() {
        faults.dedup();
        return Err(faults);
    }
    let edits = edits_of(&flat.file, &corners, &found.polar);
    edited(flat, edits, &BTreeMap::new(), files, AS_ARC)
}

/// The changes of a flat text; `polar` holds the LP blocks that count on a radius or an angle of before, with their ends.
fn edits_of(file: &SourceFile, corners: &[Rounded], polar: &[(Block, Vector2<f64>, f64)]) -> Edits {
    let mut edits = Edits::default();
    let mut lines: BTreeMap<usize, (Block, Wanted)> = BTreeMap::new();
    let mut touched = BTreeSet::new();
    for corner in corners {
        let [before, own, behind] = &corner.blocks;
        let mut line = |block: &Block| -> usize {
            lines
                .entry(block.lines.start)
                .or_insert_with(|| (block.clone(), Wanted::default()));
            block.lines.start
        };
        let (before, behind) = (line(before), line(behind));
        let [first, second] = corner.corner.ends;
        if let Some((_, wanted)) = lines.get_mut(&before) {
            wanted.end = Some((first, corner.unit_mm));
        }
        if let Some((_, wanted)) = lines.get_mut(&behind) {
            wanted.end = Some((corner.to, corner.unit_mm));
            wanted.feed = corner.feed.and(corner.feed_behind);
        }
        edits.replace(own.text.clone(), corner_block(corner, second));
        touched.extend([before, behind]);
    }
    // A polar block behind one that is not polar any more has no radius of before.
    let first = touched.first().copied().unwrap_or(0);
    for (block, end, unit_mm) in polar.iter().filter(|(block, ..)| block.lines.start > first) {
        let entry = lines.entry(block.lines.start);
        let (_, wanted) = entry.or_insert_with(|| (block.clone(), Wanted::default()));
        wanted.end.get_or_insert((*end, *unit_mm));
    }
    for (block, wanted) in lines.values() {
        line_ends(file, block, wanted, &mut edits);
    }
    edits
}

/// The arc in place of RND, or the line in place of CHF.
fn corner_block(corner: &Rounded, end: Vector2<f64>) -> String {
    let digits = decimals(corner.unit_mm);
    let [x, y] = [0, 1].map(|axis| word_text(axis, end[axis] / corner.unit_mm, digits, true));
    let block = match corner.cut {
        Cut::Rounded(radius) => {
            let radius = stands("R", radius / corner.unit_mm, digits, true);
            let turn = match corner.corner.sense < 0.0 {
                true => "DR-",
                false => "DR+",
            };
            format!("CR {x} {y} {radius} {turn}")
        }
        Cut::Sides(_) | Cut::Length(_) => format!("L {x} {y}"),
    };
    match corner.feed {
        Some(feed) => format!("{block} F{}", feed_text(feed)),
        None => block,
    }
}

/// A line with another end.
fn line_ends(file: &SourceFile, block: &Block, wanted: &Wanted, edits: &mut Edits) {
    let words = block.words(file.bytes());
    let (Some((end, unit_mm)), Some(first)) = (wanted.end, words.first()) else {
        return;
    };
    let stated = Stated::of(&words);
    let digits = decimals(unit_mm);
    let stays = |at: &&usize| ["Z", "IZ", "DR"].iter().any(|name| words[**at].is(name));
    for at in stated.places.iter().filter(|at| !stays(at)) {
        edits.replace(with_blanks(&words, *at), "");
    }
    let texts = [0, 1].map(|axis| word_text(axis, end[axis] / unit_mm, digits, true));
    if first.is("LP") {
        edits.replace(first.span.clone(), "L");
    } else if first.is("CP") {
        edits.replace(first.span.clone(), "C");
    }
    let at = first.span.end;
    edits.replace(at..at, format!(" {} {}", texts[0], texts[1]));
    if let (Some(feed), FeedWord::None) = (wanted.feed, stated.feed) {
        let at = before_functions(&words);
        edits.replace(at..at, format!(" F{}", feed_text(feed)));
    }
}
