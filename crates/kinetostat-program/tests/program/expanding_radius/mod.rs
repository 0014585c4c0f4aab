//! Cutter radius compensation: the way of the tool's centre by closed forms, what is refused, modes and words around it, and
//! the promises of every contour.

mod closed_forms;
mod contours;
mod modes;
mod refused;

use kinetostat_program::{Curve, ExpandOptions, Expanded, NoSubprograms, ProgramError, expand};

/// A program with compensation, run with tools n of 2 n mm.
pub fn try_flat(text: &str) -> Result<Expanded, ProgramError> {
    let mut options = ExpandOptions::default();
    options.tool_diameters_mm = (1..10).map(|tool| (tool, 2.0 * f64::from(tool))).collect();
    expand(text, &options, &NoSubprograms)
}

pub fn flat(text: &str) -> Expanded {
    try_flat(text).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// A motion of the flat program: where it ends and, for an arc, its centre and how far it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Made {
    pub line: usize,
    pub end: [f64; 3],
    pub arc: Option<([f64; 2], f64)>,
}

/// The motions, each with the line of the program that it came from.
pub fn made(flat: &Expanded) -> Vec<Made> {
    let moves = flat.path.moves.iter();
    moves
        .map(|motion| Made {
            line: flat.origins[motion.line - 1].line,
            end: motion.end.into(),
            arc: match motion.curve {
                Curve::Arc(arc) => Some(([arc.centre.x, arc.centre.y], arc.sweep)),
                Curve::Line => None,
            },
        })
        .collect()
}

/// Numbers that agree to 1e-9; not where one is none.
pub fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9
}

/// What a motion must be: x, y, and of arcs centre and sweep.
pub type Wanted = (f64, f64, Option<([f64; 2], f64)>);

/// The motions of a program behind its first line of `from`, as they must be.
pub fn assert_made(text: &str, from: usize, expected: &[Wanted]) {
    let all = made(&flat(text));
    let found: Vec<Made> = all.into_iter().filter(|made| made.line >= from).collect();
    assert_eq!(found.len(), expected.len(), "{text}\n{found:?}");
    for (found, (x, y, arc)) in found.iter().zip(expected) {
        let is_right = same(found.end[0], *x)
            && same(found.end[1], *y)
            && match (found.arc, arc) {
                (None, None) => true,
                (Some((centre, sweep)), Some((by, turn))) => {
                    same(centre[0], by[0]) && same(centre[1], by[1]) && same(sweep, *turn)
                }
                _ => false,
            };
        assert!(is_right, "{text}\n{found:?} instead of {x} {y} {arc:?}");
    }
}
