//! Splines: G5 (cubic), G5.1 (quadratic), G5.2 and G5.3 (NURBS), as the chords that LinuxCNC's interpreter makes of them.
//!
//! Takes control points in program units; gives the ends of 15 chords for each control point (`docs/linuxcnc.md`, section 12).
//! The curve is a B-spline with knots one apart, closed at both ends, and weights. Source: LinuxCNC, `docs/src/gcode/g-code.adoc`,
//! G5 to G5.3; L. Piegl and W. Tiller, The NURBS Book, algorithms A2.1 and A4.1.

use crate::expanding::Wrong;
use crate::expanding::translate::MotionBlock;

/// Chords for each control point.
const CHORDS: usize = 15;

/// Largest order of a NURBS that is followed.
const LARGEST_ORDER: usize = 64;

/// A control point in the plane and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ControlPoint {
    pub at: [f64; 2],
    pub weight: f64,
}

/// A spline that following blocks go on with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Spline {
    /// G5: from the end of the last one to its second control point, turned round.
    Cubic { handle: [f64; 2] },
    /// G5.1.
    Quadratic,
    /// G5.2: the control points so far and the order.
    Open {
        points: Vec<ControlPoint>,
        order: usize,
    },
}

/// True if a code (in tenths) is one of a spline.
pub(crate) fn is_spline(code: u32) -> bool {
    matches!(code, 50..=53)
}

/// Chords of a block with a spline code.
pub(crate) struct Made {
    /// Ends of the chords.
    pub ends: Vec<[f64; 2]>,
    /// Spline that the next block may continue; `None` after G5.3.
    pub next: Option<Spline>,
}

/// Reads a block; the code is its own or that of the spline before.
pub(crate) fn spline(
    code: u32,
    block: &MotionBlock,
    before: Option<Spline>,
    start: [f64; 2],
    incremental: bool,
) -> Result<Made, Wrong> {
    check(code, block, before.as_ref())?;
    let end = [(0, b'X'), (1, b'Y')].map(|(axis, letter)| match block.value(letter) {
        Some(word) if incremental => start[axis] + word,
        Some(word) => word,
        None => start[axis],
    });
    let from = |place: [f64; 2], words: [u8; 2]| {
        let by = words.map(|letter| block.value(letter));
        match by {
            [Some(x), Some(y)] => Ok([place[0] + x, place[1] + y]),
            _ => Err((
                format!(
                    "the spline G{} needs {} and {}",
                    f64::from(code) / 10.0,
                    char::from(words[0]),
                    char::from(words[1])
                ),
                "write both",
            )),
        }
    };
    let plain = |points: &[[f64; 2]]| -> Vec<ControlPoint> {
        points
            .iter()
            .map(|at| ControlPoint {
                at: *at,
                weight: 1.0,
            })
            .collect()
    };
    match code {
        51 => {
            let points = plain(&[start, from(start, [b'I', b'J'])?, end]);
            Ok(Made {
                ends: chords(&points, 3),
                next: Some(Spline::Quadratic),
            })
        }
        50 => {
            let first = match (&before, block.value(b'I').or(block.value(b'J'))) {
                (Some(Spline::Cubic { handle }), None) => {
                    [start[0] + handle[0], start[1] + handle[1]]
                }
                _ => from(start, [b'I', b'J'])?,
            };
            let second = from(end, [b'P', b'Q'])?;
            Ok(Made {
                ends: chords(&plain(&[start, first, second, end]), 4),
                next: Some(Spline::Cubic {
                    handle: [end[0] - second[0], end[1] - second[1]],
                }),
            })
        }
        52 => open(block, before, start, end),
        _ => match before {
            Some(Spline::Open { points, order }) if points.len() >= order => Ok(Made {
                ends: chords(&points, order),
                next: None,
            }),
            Some(Spline::Open { points, order }) => Err((
                format!(
                    "a NURBS of order {order} needs as many control points, and has {}",
                    points.len()
                ),
                "write more blocks with G5.2, or a smaller L",
            )),
            _ => Err((
                "G5.3 ends a NURBS that no G5.2 has begun".to_owned(),
                "write its control points with G5.2 before it",
            )),
        },
    }
}

fn check(code: u32, block: &MotionBlock, before: Option<&Spline>) -> Result<(), Wrong> {
    if block.polar.is_there() {
        return Err((
            "polar words in a spline".to_owned(),
            "write the place with X and Y",
        ));
    }
    if let Some(letter) = b"ZABCUVW".iter().find(|l| block.value(**l).is_some()) {
        return Err((
            format!("a spline does not move {}", char::from(*letter)),
            "move it in a block of its own",
        ));
    }
    match before {
        Some(Spline::Open { .. }) if !matches!(code, 52 | 53) => Err((
            "the NURBS before it is not ended".to_owned(),
            "write G5.3 behind its last control point",
        )),
        _ => Ok(()),
    }
}

/// Adds a control point.
fn open(
    block: &MotionBlock,
    before: Option<Spline>,
    start: [f64; 2],
    end: [f64; 2],
) -> Result<Made, Wrong> {
    let weight = block.value(b'P').filter(|weight| *weight > 0.0).ok_or((
        "a control point of a NURBS has no weight above zero (P)".to_owned(),
        "write P into the block",
    ));
    let has = [b'X', b'Y'].map(|letter| block.value(letter).is_some());
    let (mut points, mut order) = match before {
        Some(Spline::Open { points, order }) => (points, order),
        _ => {
            let alone = has == [false; 2];
            let own = match alone {
                true => weight.clone()?,
                false => 1.0,
            };
            let first = ControlPoint {
                at: start,
                weight: own,
            };
            (vec![first], 3)
        }
    };
    let is_first = points.len() == 1 && has == [false; 2];
    match has {
        [true, true] => points.push(ControlPoint {
            at: end,
            weight: weight?,
        }),
        [false, false] if is_first => {}
        _ => {
            return Err((
                "a control point of a NURBS needs X and Y".to_owned(),
                "write both; P alone is the weight of the first point, where the tool is",
            ));
        }
    }
    if let Some(wanted) = block.value(b'L') {
        if wanted.fract() != 0.0 || !(1.0..=LARGEST_ORDER as f64).contains(&wanted) {
            return Err((
                format!("L{wanted} is no order of a NURBS that is followed"),
                "write a whole number from 3 to 64",
            ));
        }
        // An order of three or less leaves the one in force.
        order = if wanted > 3.0 { wanted as usize } else { order };
    }
    Ok(Made {
        ends: Vec::new(),
        next: Some(Spline::Open { points, order }),
    })
}

/// The ends of the chords; there are as many points as the order, or more.
fn chords(points: &[ControlPoint], order: usize) -> Vec<[f64; 2]> {
    let last = points.len() - 1;
    let most = (last + 2 - order) as f64;
    let count = CHORDS * points.len();
    let step = most / count as f64;
    let mut ends = Vec::with_capacity(count + 1);
    let mut parameter = 0.0;
    // LinuxCNC sums the parameter in this way: the last chord may have nearly no length.
    while parameter + step < most {
        ends.push(point(points, order, parameter + step));
        parameter += step;
    }
    ends.push(points[last].at);
    ends
}

/// The point of the curve at a parameter (de Boor, with weights).
fn point(points: &[ControlPoint], order: usize, parameter: f64) -> [f64; 2] {
    let last = points.len() - 1;
    let knot = |index: usize| (index.max(order - 1).min(last + 1) - (order - 1)) as f64;
    let span = (parameter as usize + order - 1).min(last);
    let first = span + 1 - order;
    let mut row: Vec<[f64; 3]> = points[first..=span]
        .iter()
        .map(|p| [p.at[0] * p.weight, p.at[1] * p.weight, p.weight])
        .collect();
    for level in 1..order {
        for index in (level..order).rev() {
            let low = knot(first + index);
            let high = knot(first + index + order - level);
            let share = (parameter - low) / (high - low);
            let before = row[index - 1];
            for (own, other) in row[index].iter_mut().zip(before) {
                *own = share * *own + (1.0 - share) * other;
            }
        }
    }
    let [x, y, weight] = row[order - 1];
    [x / weight, y / weight]
}
