//! Contours beside which the control leads the tool (RL, RR), written out as the way of the tool's centre where the program states
//! the tool's radius (`TOOL DEF .. R`, and `DR` of TOOL CALL).

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Vector3;

use crate::error::ProgramError;
use crate::flat_run::edited;
use crate::heidenhain::blocks::{is_numbered, numbered_again};
use crate::heidenhain::datum::Bend;
use crate::heidenhain::expand::centre_line::{AGAIN, Piece, Why, centre_line};
use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reading::reader::interpret;
use crate::heidenhain::reading::walker::{Found, Way};
use crate::heidenhain::words::{Word, decimals};
use crate::heidenhain::writing::words::{
    Part, Stated, stands, with_blanks, word_text, write_functions,
};
use crate::options::{CutterCompensation, ReadOptions};
use crate::text::source::{Edits, Finding, FlatText, SourceFile};

/// Arcs shorter than this become lines, mm: their digits would say a whole turn or none.
const LEAST_ARC_MM: f64 = 0.002;

/// A flat program with the way of the tool's centre in place of contours with RL and RR whose radius the program states.
///
/// # Errors
/// Contours that the tool does not follow, by file and line of the program as given.
pub(crate) fn led_aside(
    mut flat: FlatText,
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let mut pairs = flat.file.bytes().windows(2);
    let says = |pair: &[u8]| pair.eq_ignore_ascii_case(b"RL") || pair.eq_ignore_ascii_case(b"RR");
    if options.cutter_compensation != CutterCompensation::Refused || !pairs.any(says) {
        return Ok(flat);
    }
    let found = interpret(std::slice::from_ref(&flat.file), &options.as_written());
    let mut text = Text::default();
    let mut faults = Vec::new();
    let mut at = 0;
    while at < found.ways.len() {
        let sides = found.ways[at..]
            .iter()
            .take_while(|way| way.aside.is_some());
        let end = at + sides.count();
        let radius = found.ways[at].aside.and_then(|(_, radius)| radius);
        if let (Some(radius), true) = (radius, end > at) {
            let done = contour(&flat.file, &found, at..end, radius, &mut text);
            match done {
                Ok(()) => {
                    let finding = by_radius(&flat, &found.ways[at], radius);
                    flat.findings.push(finding);
                }
                Err((index, why, remedy)) => {
                    let place = found.ways[(at + index).min(found.ways.len() - 1)]
                        .block
                        .text
                        .start;
                    faults.push(ProgramError::of_flat(&flat, files, place, why, &remedy));
                }
            }
        }
        at = end.max(at + 1);
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    match text.is_empty() {
        true => Ok(flat),
        false => text.applied(flat, files),
    }
}

/// Finding on a contour with radius compensation: a control with a tool table takes the radius from there.
fn by_radius(flat: &FlatText, way: &Way, radius_mm: f64) -> Finding {
    let line = flat.file.line_of(way.block.text.start);
    let (file, line) = flat.origins.get(line - 1).copied().unwrap_or((0, line));
    let message = format!(
        "the way of the tool's centre is computed from its radius of {radius_mm} mm (TOOL DEF, DR): a radius in the control's tool table is not known here"
    );
    Finding {
        file,
        line,
        message,
    }
}

/// Edits of the blocks.
#[derive(Default)]
struct Text {
    edits: Edits,
    /// Lines before a block, by the start of the block.
    before: BTreeMap<usize, Vec<String>>,
}

impl Text {
    fn is_empty(&self) -> bool {
        self.before.is_empty()
    }

    fn applied(
        mut self,
        flat: FlatText,
        files: &[SourceFile],
    ) -> Result<FlatText, Vec<ProgramError>> {
        let file = &flat.file;
        let mut added = BTreeMap::new();
        for (start, lines) in &self.before {
            added.insert(file.line_of(*start), lines.len());
            let bytes = file.bytes();
            let head = bytes[*start..].iter();
            let head = head
                .take_while(|byte| byte.is_ascii_digit() || **byte == b' ')
                .count();
            let line = |text: &String| {
                [
                    &bytes[*start..*start + head],
                    text.as_bytes(),
                    file.line_ending(),
                ]
                .concat()
            };
            let lines: Vec<u8> = lines.iter().flat_map(line).collect();
            self.edits.replace(*start..*start, lines);
        }
        let mut flat = edited(flat, self.edits, &added, files, AGAIN)?;
        let bytes = flat.file.bytes();
        if let Some(bytes) = is_numbered(bytes).then(|| numbered_again(bytes)).flatten() {
            flat.file = SourceFile::new(flat.file.name(), bytes);
        }
        Ok(flat)
    }
}

/// Writes the motions of a contour, and states what the block behind it takes over.
fn contour(
    file: &SourceFile,
    found: &Found,
    motions: Range<usize>,
    radius_mm: f64,
    text: &mut Text,
) -> Result<(), Why> {
    let Range { start: first, end } = motions;
    let ways = &found.ways[first..end];
    let refused = |index: usize, why: &str| (index, why.to_owned(), AGAIN.to_owned());
    let Some((aside, _)) = ways[0].aside else {
        return Ok(());
    };
    for (index, way) in ways.iter().enumerate() {
        let words = way.block.words(file.bytes());
        let looks =
            |word: &Word| word.is("M") && matches!(word.whole(), Some(90 | 97 | 98 | 112 | 120));
        if way.aside != ways[0].aside {
            return Err(refused(
                index,
                "the side or the tool's radius changes along the contour",
            ));
        }
        if way.datum.bend != Bend::None || way.datum != ways[0].datum {
            return Err(refused(
                index,
                "the coordinates are mirrored, turned, scaled or shifted along the contour",
            ));
        }
        if words.iter().any(looks) {
            return Err(refused(
                index,
                "M90, M97, M98, M112 or M120 leads the tool along the contour otherwise",
            ));
        }
    }
    let plane = ways[0].working;
    let pieces = centre_line(&found.motions[first..end], ways, aside, radius_mm, plane)?;
    let behind = found.ways.get(end);
    if let Some(way) = behind {
        leaves(file, way, text).map_err(|why| refused(end - first, why))?;
    }
    let mut centred = false;
    for (way, pieces) in ways.iter().zip(&pieces) {
        centred |= pieces.iter().any(|piece| is_arc(piece, way));
        block(file, way, pieces, text);
    }
    // A pole that is counted from behind the contour is stated again.
    let count = ways.last().map_or(0, |way| way.pole.count);
    let mut later = found.ways[end..]
        .iter()
        .take_while(|way| way.pole.whole <= count);
    if let Some(way) = later.find(|way| way.pole.used && centred)
        && let Some(pole) = way.pole.at
    {
        let digits = decimals(way.unit_mm) + 2;
        let [u, v] = [0, 1].map(|at| {
            word_text(
                pole.plane.axes()[at],
                pole.at[at] / way.unit_mm,
                digits,
                true,
            )
        });
        let lines = text.before.entry(way.block.lines.start).or_default();
        lines.push(format!("CC {u} {v}"));
    }
    Ok(())
}

/// Has the block behind a contour state both axes of the plane: what it does not state is the contour's own place.
fn leaves(file: &SourceFile, way: &Way, text: &mut Text) -> Result<(), &'static str> {
    let words = way.block.words(file.bytes());
    let stated = Stated::of(&words);
    let in_plane = way.working.axes();
    if !words[0].is("L") || in_plane.iter().all(|axis| stated.word[*axis].is_none()) {
        return Err(
            "the compensation ends in a block that is no line (L) away from the contour in the plane",
        );
    }
    for axis in in_plane {
        let Some(end) = way.end[axis] else {
            return Err("where the line away from the contour ends is not known");
        };
        let own = word_text(axis, end / way.unit_mm, decimals(way.unit_mm), true);
        match stated.word[axis] {
            Some(_) if stated.absolute[axis] => {}
            Some(at) => text.edits.replace(words[at].span.clone(), own),
            None => text
                .edits
                .replace(words[0].span.end..words[0].span.end, format!(" {own}")),
        }
    }
    Ok(())
}

/// True if a piece is written as an arc: its digits must be able to express it.
fn is_arc(piece: &Piece, way: &Way) -> bool {
    piece.arc.is_some_and(|(centre, angle)| {
        angle.abs() * (way.working.flat(&piece.to) - centre).norm() > LEAST_ARC_MM
    })
}

/// A block as the pieces of its way: the last in its place, the others before it.
fn block(file: &SourceFile, way: &Way, pieces: &[Piece], text: &mut Text) {
    let words = way.block.words(file.bytes());
    for (order, piece) in pieces.iter().enumerate() {
        let part = match (order, pieces.len() - order) {
            (0, 1) => Part::Only,
            (0, _) => Part::First,
            (_, 1) => Part::Last,
            _ => Part::Middle,
        };
        let (centre, edits) = block_of(&words, way, piece, part);
        let lines = text.before.entry(way.block.lines.start).or_default();
        lines.extend(centre);
        if matches!(part, Part::Only | Part::Last) {
            text.edits.append(edits);
        } else if let Some(bytes) = edits.applied_to_part(file.bytes(), &way.block.text) {
            // A comment stands behind the last piece.
            let bytes = bytes
                .split(|byte| *byte == b';')
                .next()
                .unwrap_or_default()
                .to_vec();
            lines.push(String::from_utf8_lossy(bytes.trim_ascii_end()).into_owned());
        }
    }
}

/// The centre of a piece, where it is an arc, and the changes of its block.
fn block_of(words: &[Word], way: &Way, piece: &Piece, part: Part) -> (Option<String>, Edits) {
    let (unit, digits, plane) = (way.unit_mm, decimals(way.unit_mm), way.working);
    let [u, v] = plane.axes();
    let word =
        |axis: usize, place: &Vector3<f64>| word_text(axis, place[axis] / unit, digits, true);
    let rise = piece.to[plane.0] - piece.from[plane.0];
    let rises = rise.abs() > 1e-9;
    let mut own = format!(" {} {}", word(u, &piece.to), word(v, &piece.to));
    let (mut keyword, mut centre) = ("L", None);
    if rises {
        own = format!("{own} {}", word(plane.0, &piece.to));
    }
    if let Some((at, angle)) = piece.arc.filter(|_| is_arc(piece, way)) {
        let at = plane.place(at, 0.0);
        centre = Some(format!("CC {} {}", word(u, &at), word(v, &at)));
        let turn = if angle > 0.0 { "DR+" } else { "DR-" };
        keyword = "C";
        own = format!("{own} {turn}");
        if rises {
            let step = stands(["IX", "IY", "IZ"][plane.0], rise / unit, digits, true);
            (keyword, own) = (
                "CP",
                format!(
                    " {} {step} {turn}",
                    stands("IPA", angle.to_degrees(), 4, true)
                ),
            );
        }
    }
    let stated = Stated::of(words);
    let mut edits = Edits::default();
    edits.replace(words[0].span.clone(), keyword);
    edits.replace(words[0].span.end..words[0].span.end, own);
    let once = |word: &Word| {
        let feeds = matches!(stated.feed, FeedWord::Number(..)) && word.is("F");
        feeds && matches!(part, Part::Middle | Part::Last)
    };
    for (at, word) in words.iter().enumerate().skip(1) {
        let sides = ["RL", "RR"].iter().any(|side| word.is(side));
        if stated.places.contains(&at) || sides || once(word) {
            edits.replace(with_blanks(words, at), "");
        }
    }
    write_functions(words, part, &mut edits);
    (centre, edits)
}
