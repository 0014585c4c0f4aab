//! Corners that are rounded or broken (RND, CHF, CHR), written out: the line before ends where the arc or the chamfer begins, which
//! is a block of its own, and the line behind states its own end.

use std::collections::BTreeMap;

use nalgebra::Vector2;

use crate::corner::{Corner, Cut, not_followed};
use crate::error::ProgramError;
use crate::flat_run::edited;
use crate::options::ReadOptions;
use crate::siemens::reader::scan_with;
use crate::siemens::state::Code;
use crate::siemens::walker::{Corners, Written};
use crate::siemens::writing::place::{LETTERS, number_text, without};
use crate::text::source::{Edits, FlatText, SourceFile};

const REMEDY: &str = "let the CAM system write the corner as a block between its lines";

/// Heights nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

/// A corner between two motions.
struct Found {
    corner: Corner,
    cut: Cut,
    /// Axes of the plane.
    axes: [usize; 2],
}

/// A flat program without RND, CHF and CHR.
///
/// # Errors
/// Corners that are not followed, by file and line of the program as given.
pub(super) fn written_out(
    flat: FlatText,
    files: &[SourceFile],
) -> Result<FlatText, Vec<ProgramError>> {
    let has_corners = flat.file.bytes().windows(3).any(|part| {
        [b"RND", b"CHF", b"CHR"]
            .iter()
            .any(|name| part.eq_ignore_ascii_case(*name))
    });
    if !has_corners {
        return Ok(flat);
    }
    let reading = ReadOptions::default().as_written();
    let file = std::slice::from_ref(&flat.file);
    let found = scan_with(file, &reading, Corners::Followed);
    if found.corner_words.is_empty() {
        return Ok(flat);
    }
    let mut faults = Vec::new();
    let mut made = BTreeMap::new();
    // Start of the line after its own corner, mm.
    let mut begins: Option<(usize, Vector2<f64>)> = None;
    let with_corners: BTreeMap<usize, usize> = (found.written.iter().enumerate())
        .filter_map(|(index, written)| Some((written.corner.as_ref()?.0.start, index)))
        .collect();
    let broken: BTreeMap<usize, &ProgramError> = (found.faults.iter().rev())
        .map(|fault| (fault.line, fault))
        .collect();
    for word in &found.corner_words {
        let index = with_corners.get(&word.start).copied();
        let corner = match index {
            Some(index) => {
                let from = begins.filter(|(at, _)| *at == index).map(|(_, from)| from);
                let behind = found.written.get(index + 1);
                let corner = corner(&found.written[index], behind, from);
                corner
                    .map(|corner| (index, corner))
                    .map_err(|why| (why, REMEDY))
            }
            // A block that is understood, or one with a word whose value is not known.
            None => Err(match broken.get(&flat.file.line_of(word.start)) {
                Some(fault) => (fault.reason.clone(), fault.remedy.as_str()),
                None => (
                    "its block is no straight line whose start and end are known".to_owned(),
                    REMEDY,
                ),
            }),
        };
        match corner {
            Ok((index, corner)) => {
                begins = Some((index + 1, corner.corner.ends[1]));
                made.insert(index, corner);
            }
            Err((why, remedy)) => {
                let why = not_followed(&why);
                let fault = ProgramError::of_flat(&flat, files, word.start, why, remedy);
                faults.push(fault);
            }
        }
    }
    if !faults.is_empty() {
        faults.dedup();
        return Err(faults);
    }
    let (edits, added) = edits_of(&flat.file, &found.written, &made);
    edited(flat, edits, &added, files, REMEDY)
}

fn corner(
    before: &Written,
    behind: Option<&Written>,
    from: Option<Vector2<f64>>,
) -> Result<Found, String> {
    let line = |written: &Written| written.code == Code::Line && !written.machine;
    let behind = behind.filter(|behind| line(behind));
    let (true, Some(behind)) = (line(before), behind) else {
        return Err("the motions at it are not both straight lines at feed (G1)".to_owned());
    };
    let known = |place: [Option<f64>; 3]| Some([place[0]?, place[1]?, place[2]?]);
    let places = [before.start, before.end, behind.end].map(known);
    let [Some(start), Some(at), Some(to)] = places else {
        return Err("where a line at it starts or ends, is not known".to_owned());
    };
    let frames = (before.frame.translation.vector - behind.frame.translation.vector).norm()
        + before.frame.rotation.angle_to(&behind.frame.rotation);
    let follows = behind.start == before.end && frames < SAME_MM;
    if !follows || before.normal != behind.normal || before.unit_mm != behind.unit_mm {
        return Err("a frame, a tool, a plane or a unit changes at it".to_owned());
    }
    let normal = before.normal;
    if (start[normal] - at[normal]).abs() + (at[normal] - to[normal]).abs() > SAME_MM {
        return Err("a line at it leaves the plane of G17, G18 or G19".to_owned());
    }
    let feeds = [before, behind].map(|written| written.feed.as_ref().map(|feed| feed.value));
    if feeds[0] != feeds[1] {
        return Err(
            "its two lines have different feeds, and which of them holds on it machine data say"
                .to_owned(),
        );
    }
    let axes = [(normal + 1) % 3, (normal + 2) % 3];
    let flat = |place: [f64; 3]| Vector2::new(place[axes[0]], place[axes[1]]);
    let cut = before.corner.as_ref().map(|(_, cut)| *cut);
    let cut = cut.ok_or_else(|| "its size is not known".to_owned())?;
    let start = from.unwrap_or(flat(start));
    Ok(Found {
        corner: Corner::cut([start, flat(at), flat(to)], cut)?,
        cut,
        axes,
    })
}

/// The changes of a flat text, and the lines behind which there is a further one.
fn edits_of(
    file: &SourceFile,
    written: &[Written],
    made: &BTreeMap<usize, Found>,
) -> (Edits, BTreeMap<usize, usize>) {
    let mut edits = Edits::default();
    let mut added = BTreeMap::new();
    // End of each line in the plane; a line after a corner has its own end.
    let mut ends: BTreeMap<usize, [Option<f64>; 3]> = BTreeMap::new();
    for (index, found) in made {
        for (at, place) in [(*index, Some(found.corner.ends[0])), (index + 1, None)] {
            let end = ends.entry(at).or_default();
            for (k, axis) in found.axes.into_iter().enumerate() {
                end[axis] = match place {
                    Some(place) => Some(place[k]),
                    None => written[at].end[axis],
                };
            }
        }
        let own = &written[*index];
        let unit = own.unit_mm;
        let mut text = match found.cut {
            Cut::Rounded(_) if found.corner.sense > 0.0 => "G3",
            Cut::Rounded(_) => "G2",
            Cut::Sides(_) | Cut::Length(_) => "G1",
        }
        .to_owned();
        for (k, axis) in found.axes.into_iter().enumerate() {
            text += &word(own, axis, found.corner.ends[1][k] / unit);
        }
        if let Cut::Rounded(radius) = found.cut {
            text += &format!(" CR={}", number_text(radius / unit));
        }
        let line = [file.line_ending(), text.as_bytes()].concat();
        edits.replace(own.line.end..own.line.end, line);
        added.insert(file.line_of(own.line.start), 1);
        if let Some((span, _)) = &own.corner {
            edits.replace(without(file.bytes(), span, own.words_at), "");
        }
        let behind = &written[index + 1];
        if behind.code_word.is_none() {
            edits.replace(behind.words_at..behind.words_at, "G1 ");
        }
    }
    for (index, end) in ends {
        let own = &written[index];
        let mut missing = String::new();
        for (axis, value) in end.into_iter().enumerate() {
            let Some(value) = value else {
                continue;
            };
            let text = word(own, axis, value / own.unit_mm);
            match &own.axes[axis] {
                Some(stated) => edits.replace(stated.word.clone(), text.trim_start()),
                None => missing += &text,
            }
        }
        if !missing.is_empty() {
            let places = own.axes.iter().flatten().map(|stated| stated.word.end);
            let code = own.code_word.iter().map(|word| word.end);
            match places.max().or(code.max()) {
                Some(at) => edits.replace(at..at, missing),
                None => {
                    let text = format!("{} ", missing.trim_start());
                    edits.replace(own.words_at..own.words_at, text);
                }
            }
        }
    }
    (edits, added)
}

/// A word of an axis behind a blank, in units of the program.
fn word(written: &Written, axis: usize, value: f64) -> String {
    let (letter, value) = (LETTERS[axis], number_text(value));
    match written.steps {
        true => format!(" {letter}=AC({value})"),
        false => format!(" {letter}{value}"),
    }
}
