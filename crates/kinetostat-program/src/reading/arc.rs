//! From the words of a G2 or G3 block to its arc.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::closed_circle::{NearlyClosed, angle_about, last_digit_mm};
use crate::path::curve::Arc;
use crate::reading::block::Block;

/// Ends nearer than this are one point, in mm.
const SAME_POINT_MM: f64 = 1e-9;

/// Largest radius that is taken for a circle's, in mm.
const LARGEST_RADIUS_MM: f64 = 1e7;

/// An arc by radius whose chord is its diameter but for this share is half a circle (as LinuxCNC has it).
const HALF_CIRCLE: f64 = 1e-12;

/// Modal state against which an arc block is read.
pub(crate) struct ArcFrame {
    pub start: Vector3<f64>,
    pub end: Vector3<f64>,
    /// Axes of the plane and of its normal, right-handed: X Y Z for G17, Z X Y, Y Z X.
    pub axes: [usize; 3],
    pub clockwise: bool,
    /// G90.1: centre words are places.
    pub absolute_centre: bool,
    pub mm_per_unit: f64,
    /// Sum of work and position offset, in mm.
    pub offset_mm: Vector3<f64>,
    pub tolerance_mm: f64,
}

/// The arc of a block with R or with centre words, and whether a full circle may be meant by it.
pub(crate) fn read(block: &Block<'_>, frame: &ArcFrame) -> Result<(Arc, bool), ProgramError> {
    // Also where the P is meant for another code of the block: LinuxCNC gives it to both.
    if let Some(word) = block.words.iter().find(|word| word.letter == b'P') {
        return Err(block.refuse(
            ProgramErrorKind::Arc,
            Some(word),
            "P in an arc counts turns, and controllers disagree how",
            "write one block for each turn",
        ));
    }
    let centre_words = b"IJK".map(|letter| block.value(letter));
    let any_centre = centre_words.iter().any(Option::is_some);
    let centre = match (block.value(b'R'), any_centre) {
        (Some(_), true) => {
            return Err(block.refuse(
                ProgramErrorKind::Arc,
                block.word(b'R'),
                "the arc has a radius R and a centre I J K",
                "keep one of the two",
            ));
        }
        (None, false) => {
            return Err(block.refuse(
                ProgramErrorKind::Arc,
                None,
                "the arc has neither a radius R nor a centre I J K",
                "write I J K or R in every arc block",
            ));
        }
        (Some(radius), false) => centre_by_radius(block, frame, radius * frame.mm_per_unit)?,
        (None, true) => centre_by_words(block, frame, centre_words)?,
    };
    arc_about(block, frame, centre)
}

/// Coordinates in the plane and along its normal.
fn in_plane(frame: &ArcFrame, point: &Vector3<f64>) -> [f64; 3] {
    frame.axes.map(|axis| point[axis])
}

fn centre_by_words(
    block: &Block<'_>,
    frame: &ArcFrame,
    words: [Option<f64>; 3],
) -> Result<[f64; 2], ProgramError> {
    let [first, second, normal] = frame.axes;
    let names = ["I", "J", "K"];
    if let Some(value) = words[normal]
        && (value != 0.0 || frame.absolute_centre)
    {
        return Err(block.refuse(
            ProgramErrorKind::Arc,
            block.word(b"IJK"[normal]),
            &format!("{} is not in the plane of the arc", names[normal]),
            "select the plane with G17, G18 or G19, or remove the word",
        ));
    }
    let start = in_plane(frame, &frame.start);
    let mut centre = [0.0; 2];
    for (index, axis) in [first, second].into_iter().enumerate() {
        centre[index] = match (words[axis], frame.absolute_centre) {
            (Some(value), false) => start[index] + value * frame.mm_per_unit,
            (None, false) => start[index],
            (Some(value), true) => value * frame.mm_per_unit + frame.offset_mm[axis],
            (None, true) => {
                return Err(block.refuse(
                    ProgramErrorKind::Arc,
                    None,
                    &format!(
                        "with G90.1 the centre needs both words, {} is missing",
                        names[axis]
                    ),
                    "write both coordinates of the centre",
                ));
            }
        };
    }
    Ok(centre)
}

fn centre_by_radius(
    block: &Block<'_>,
    frame: &ArcFrame,
    radius: f64,
) -> Result<[f64; 2], ProgramError> {
    let start = in_plane(frame, &frame.start);
    let end = in_plane(frame, &frame.end);
    let chord = [end[0] - start[0], end[1] - start[1]];
    let length = chord[0].hypot(chord[1]);
    if length < SAME_POINT_MM {
        return Err(block.refuse(
            ProgramErrorKind::Arc,
            block.word(b'R'),
            "an arc by radius ends where it starts: its centre could be anywhere",
            "write full circles with I J K",
        ));
    }
    let half = 0.5 * length;
    if half > radius.abs() + frame.tolerance_mm {
        return Err(block.refuse(
            ProgramErrorKind::Arc, block.word(b'R'),
            &format!(
                "the radius {:.4} mm is too small: the ends are {length:.4} mm apart and need {half:.4} mm",
                radius.abs()
            ),
            "check R and the end point",
        ));
    }
    let height = match half > radius.abs() * (1.0 - HALF_CIRCLE) {
        // The root would make a rounding of the last digit one of the eighth.
        true => 0.0,
        false => (radius * radius - half * half).sqrt(),
    };
    // The centre of the shorter arc lies to the right of the chord when turning clockwise.
    let side = if frame.clockwise == (radius > 0.0) {
        -1.0
    } else {
        1.0
    };
    Ok([
        start[0] + 0.5 * chord[0] - side * height * chord[1] / length,
        start[1] + 0.5 * chord[1] + side * height * chord[0] / length,
    ])
}

/// The last digit of the words of an arc; 0 for one by radius, whose sign says which way it goes.
fn digit_mm(block: &Block<'_>, frame: &ArcFrame) -> f64 {
    let words = b"XYZIJK".iter().filter_map(|letter| block.value(*letter));
    match block.value(b'R') {
        Some(_) => 0.0,
        None => last_digit_mm(&words.collect::<Vec<f64>>(), frame.mm_per_unit),
    }
}

fn arc_about(
    block: &Block<'_>,
    frame: &ArcFrame,
    centre: [f64; 2],
) -> Result<(Arc, bool), ProgramError> {
    let start = in_plane(frame, &frame.start);
    let end = in_plane(frame, &frame.end);
    let to_start = [start[0] - centre[0], start[1] - centre[1]];
    let to_end = [end[0] - centre[0], end[1] - centre[1]];
    let start_radius = to_start[0].hypot(to_start[1]);
    let end_radius = to_end[0].hypot(to_end[1]);
    let difference = (start_radius - end_radius).abs();
    if difference > frame.tolerance_mm {
        return Err(block.refuse(
            ProgramErrorKind::Arc, None,
            &format!(
                "the arc's radius is {start_radius:.4} mm at its start and {end_radius:.4} mm at its \
                 end; they differ by {difference:.4} mm, {:.4} mm are allowed",
                frame.tolerance_mm
            ),
            "mend the block, or allow more with the arc tolerance (--arc-tolerance, or arc_tolerance_mm under [reading] in the job file)",
        ));
    }
    let smallest = start_radius.min(end_radius);
    if !(1e-6..LARGEST_RADIUS_MM).contains(&smallest) {
        return Err(block.refuse(
            ProgramErrorKind::Arc,
            None,
            &format!("the arc has a radius of {smallest} mm"),
            "write the block as a straight move, G1",
        ));
    }
    let start_angle = to_start[1].atan2(to_start[0]);
    let sense = match frame.clockwise {
        true => -1.0,
        false => 1.0,
    };
    let found = angle_about(to_start, to_end, sense, digit_mm(block, frame));
    let is_doubtful = found.is_err();
    let angle = found.or_else(|nearly| {
        let reason = nearly.to_string();
        let refused = || block.refuse(ProgramErrorKind::Arc, None, &reason, NearlyClosed::REMEDY);
        nearly.short.ok_or_else(refused)
    })?;

    let unit = |axis: usize| Vector3::ith(axis, 1.0);
    let [first, second, normal] = frame.axes;
    let arc = Arc {
        centre: unit(first) * centre[0] + unit(second) * centre[1] + unit(normal) * start[2],
        first: unit(first),
        second: unit(second),
        axis: unit(normal),
        start_angle,
        sweep: sense * angle,
        start_radius,
        end_radius,
        rise: end[2] - start[2],
    };
    Ok((arc, is_doubtful))
}
