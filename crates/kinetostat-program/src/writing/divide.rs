//! Where a block must be divided so that straight pieces follow the corrected curve.
//!
//! The corrected curve of a move is `point(s) + c(s)`, `s` the share of its length. A piece from `a`
//! to `b` is good if `c` differs from the straight line between `c(a)` and `c(b)` by no more than the
//! tolerance; the whole vector is compared, so the bound holds along the path too.
//!
//! The field says where `c` or its slope may jump ([`Structure::breaks`]): those places are ends of
//! stretches before anything else. Arcs that become straight pieces are divided by their chords as well; for those to which
//! arcs are fitted ([`crate::writing::fitting`]) the correction is only found out, and how far it bends matters little. A stretch is then evaluated in
//! its middle, in the quarters where that does not decide it, and there at a place that follows no
//! pattern too. It is good if
//!
//! - the polynomial through these values stays within the tolerance ([`crate::writing::departure`], a bound and
//!   no sample);
//! - the error of that polynomial is below a tenth of the tolerance: nothing for a field of third
//!   degree, Hermite's remainder for a smooth one;
//! - at the irregular place the polynomial agrees with the field.
//!
//! Otherwise it is halved. Neighbouring pieces are joined again where the same bound allows it
//! ([`crate::writing::merge`]). All blocks are divided together, in rounds, so that the field is evaluated
//! in large batches.

use nalgebra::Vector6;

use crate::error::WriteError;
use crate::field::request::{CorrectionField, Course, Monitor, Request};
use crate::irregular::irregular;
use crate::number::larger;
use crate::path::curve::Curve;
use crate::path::moves::{Move, Path};
use crate::writing::corner::follow_turns;
use crate::writing::departure::{Values, departure, parabola, polynomial, remainder};
use crate::writing::jump::Jump;
use crate::writing::merge::{Accepted, merge};
use crate::writing::node::{Node, is_corrected_at_end, is_divided, taken_up};
use crate::writing::options::WriteOptions;
use crate::writing::queries::FieldQueries;

/// All nodes, by move and share.
pub(crate) struct Division {
    pub nodes: Vec<Node>,
    pub jumps: Vec<Jump>,
    /// The correction on the moves to which arcs are fitted, and on those whose straight pieces may be shared out anew, by move
    /// and share.
    pub courses: Vec<Accepted>,
    /// What is fitted to the moves.
    pub fitted: Vec<Fitted>,
    pub evaluations: usize,
    /// Largest part of a correction along axes that the program never states, in mm.
    pub left_out_mm: f64,
}

/// Seed of the irregular places of a division; a check takes another.
const SEED: u64 = 1;

/// Part of the tolerance that may be unknown between the places evaluated.
const UNKNOWN: f64 = 0.1;

/// Part of the tolerance by which the field may differ from the polynomial at the irregular place.
const SURPRISE: f64 = 0.25;

/// How many times the tolerance a correction may leave a straight line on a stretch that is no piece: a polynomial follows it.
const BENT: f64 = 20.0;

/// Stretches of an arc to which arcs are fitted are no longer than this, in rad, before anything is known of the correction.
const FIRST_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

/// A stretch of a move that is not accepted yet.
struct Stretch {
    move_index: usize,
    course: Course,
    /// The whole of a straight move, or a chord of an arc: what is good as it is needs no joining.
    entire: bool,
    /// Arcs are fitted to its move.
    fitted: bool,
    share: [f64; 2],
    ends: [Vector6<f64>; 2],
    /// Where the piece begins that the tool goes along; differs from the first end where a jump too
    /// small for a step is taken up.
    begins: Vector6<f64>,
    middle: Option<Vector6<f64>>,
    quarters: Option<[Vector6<f64>; 2]>,
    /// An irregular part of the stretch and the correction there.
    irregular: Option<(f64, Vector6<f64>)>,
}

/// What becomes of a stretch with the values known of it.
enum Decision {
    Accept,
    /// More places decide it.
    Refine,
    Halve,
    /// Too short to be halved, and still off: the correction jumps.
    Jump,
}

impl Stretch {
    fn at(&self, part: f64) -> f64 {
        self.share[0] + (self.share[1] - self.share[0]) * part
    }

    fn node_values(&self) -> Option<Values> {
        let middle = self.middle?;
        let [first, last] = self.ends;
        Some(match self.quarters {
            Some([low, high]) => [first, low, middle, high, last],
            None => parabola(first, middle, last),
        })
    }

    fn irregular_part(&self) -> f64 {
        // Not near the places that are evaluated anyway.
        let place = irregular(SEED, self.move_index as u64, self.share[0].to_bits());
        0.25 * ((4.0 * place).floor() + 0.2 + 0.6 * (4.0 * place).fract())
    }

    fn decide(&self, path: &Path, options: &WriteOptions) -> Decision {
        let Some(values) = self.node_values() else {
            return Decision::Refine;
        };
        let motion = &path.moves[self.move_index];
        let [from, to] = self.share;
        // Of a move that turns the tool, the way of a point of the tool where that is longer.
        let turned = motion.way_with_turn_mm(options.turn_lever_mm) * (to - from);
        let length = larger(motion.length_between_mm(from, to), turned);
        let tolerance = options.tolerance_mm;
        let all_requested = self.quarters.is_some();
        let off = departure(&values, [self.begins, self.ends[1]]);
        let (unknown, needs_quarters) = match self.course {
            Course::Cubic if !self.fitted => (0.0, true),
            Course::Cubic => (self.unknown_round(motion, &values), true),
            Course::Smooth { radius_mm } => {
                // That nothing was seen yet does not make it small: it counts as the tolerance at least.
                let seen = self.irregular.iter().map(|(_, value)| value);
                let size = values
                    .iter()
                    .chain(seen)
                    .map(Vector6::norm)
                    .fold(tolerance, larger);
                let radius = match &motion.curve {
                    Curve::Line => radius_mm,
                    Curve::Arc(arc) => radius_mm.min(arc.start_radius.min(arc.end_radius)),
                };
                // A turn of the tool is a way as well.
                let turn = motion.turn_ratio(radius) * (to - from);
                let way = larger(motion.length_between_mm(from, to), turn * radius);
                let points = if all_requested { 5 } else { 3 };
                let change = (self.ends[1] - self.ends[0]).norm();
                (
                    remainder(points, size, way, radius),
                    off > 0.25 * tolerance || change > tolerance,
                )
            }
        };
        let surprised = self.irregular.is_some_and(|(part, value)| {
            (value - polynomial(&values, part)).norm() > SURPRISE * tolerance
        });
        let bent = match self.fitted && length > options.smallest_piece_mm {
            true => BENT * tolerance,
            false => tolerance,
        };
        if off > bent || surprised {
            let shortest =
                length <= options.smallest_piece_mm || self.at(0.5) <= from || self.at(0.5) >= to;
            return match (all_requested, shortest) {
                // As ever: what is off is looked at once more before it is halved.
                (false, _) => Decision::Refine,
                (true, true) => Decision::Jump,
                (true, false) => Decision::Halve,
            };
        }
        if !all_requested && (needs_quarters || unknown > UNKNOWN * tolerance) {
            return Decision::Refine;
        }
        if unknown > UNKNOWN * tolerance && length > options.smallest_piece_mm {
            return Decision::Halve;
        }
        Decision::Accept
    }

    /// What a polynomial through five values may be off from a correction that is one of third degree along straight lines, on an
    /// arc: along it the coordinates are no polynomials, and a stretch of an angle `a` is a straight line but for terms of `a^2`
    /// and more. They begin with those of the fifth degree.
    fn unknown_round(&self, motion: &Move, values: &Values) -> f64 {
        let Curve::Arc(arc) = &motion.curve else {
            return 0.0;
        };
        let angle = arc.sweep * (self.share[1] - self.share[0]);
        let varies = values.iter().map(|value| (value - values[0]).norm());
        0.02 * angle * angle * varies.fold(0.0, larger)
    }

    /// Remembers what was found inside, for [`merge`].
    fn accepted(&self, accepted: &mut Vec<Accepted>) {
        if self.entire {
            return;
        }
        if let Some(values) = self.node_values() {
            accepted.push(Accepted {
                move_index: self.move_index,
                share: self.share[0],
                values,
            });
        }
    }
}

/// What is fitted to the corrected curve of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fitted {
    Nothing,
    /// Arcs about its own axis, which rise evenly.
    Arcs,
    /// Circles through three places.
    Circles,
}

/// `wanted` says what is to be fitted to the arcs among the moves.
pub(crate) fn divide(
    path: &Path,
    field: &dyn CorrectionField,
    (options, wanted): (&WriteOptions, &dyn Fn(usize) -> Fitted),
    monitor: &dyn Monitor,
) -> Result<Division, WriteError> {
    let fitted: Vec<Fitted> = path
        .moves
        .iter()
        .enumerate()
        .map(|(index, motion)| match motion.curve {
            Curve::Arc(_) if is_divided(motion) => wanted(index),
            _ => Fitted::Nothing,
        })
        .collect();
    let mut queries = FieldQueries {
        path,
        field,
        monitor,
        answered: 0,
        left_out_mm: 0.0,
        lever_mm: options.turn_lever_mm,
    };
    let mut nodes = Vec::new();
    let mut accepted = Vec::new();
    let mut open = first_round(&mut queries, (options, &fitted), &mut nodes)?;
    while !open.is_empty() {
        answer(&mut queries, &mut open, options)?;
        open = next_round(path, open, options, &mut nodes, &mut accepted);
        if nodes.len() + open.len() > options.max_pieces {
            let line = open
                .first()
                .map_or(0, |stretch| path.moves[stretch.move_index].line);
            return Err(WriteError::TooManyPieces {
                line,
                limit: options.max_pieces,
            });
        }
    }
    nodes.sort_by(|a, b| {
        a.move_index
            .cmp(&b.move_index)
            .then(a.share.total_cmp(&b.share))
    });
    accepted.sort_by(|a, b| {
        a.move_index
            .cmp(&b.move_index)
            .then(a.share.total_cmp(&b.share))
    });
    let mut nodes = merge(nodes, &accepted, options);
    let jumps = follow_turns(&mut queries, &mut nodes, options)?;
    accepted.retain(|stretch| {
        let motion = &path.moves[stretch.move_index];
        options.shortest_block_mm(motion).is_some() || fitted[stretch.move_index] != Fitted::Nothing
    });
    Ok(Division {
        nodes,
        jumps,
        courses: accepted,
        fitted,
        evaluations: queries.answered,
        left_out_mm: queries.left_out_mm,
    })
}

/// A place at which a move is divided before anything is known of the correction.
struct Boundary {
    share: f64,
    fixed: bool,
}

/// Ends of chords and breaks of the field, in order, with the field's course between them.
fn boundaries(
    queries: &FieldQueries<'_>,
    move_index: usize,
    (options, fitted): (&WriteOptions, Fitted),
) -> Result<(Vec<Boundary>, Course), WriteError> {
    let motion = &queries.path.moves[move_index];
    let too_many = WriteError::TooManyPieces {
        line: motion.line,
        limit: options.max_pieces,
    };
    let (chords, fixed) = match &motion.curve {
        Curve::Line => (1, false),
        Curve::Arc(arc) if fitted != Fitted::Nothing => (
            (arc.sweep.abs() / FIRST_ANGLE).ceil().max(1.0) as usize,
            false,
        ),
        Curve::Arc(arc) => (arc.chords_within(options.chord_tolerance_mm), true),
    };
    if chords > options.max_pieces {
        return Err(too_many);
    }
    let structure = queries.field.structure(move_index, motion);
    if structure.breaks.len() > options.max_pieces {
        return Err(too_many);
    }
    let mut list: Vec<Boundary> = (0..=chords)
        .map(|chord| Boundary {
            share: chord as f64 / chords as f64,
            fixed,
        })
        .collect();
    let breaks = structure.breaks.into_iter();
    list.extend(
        breaks
            .filter(|share| *share > 0.0 && *share < 1.0)
            .map(|share| Boundary {
                share,
                fixed: false,
            }),
    );
    // Of two at one place the end of a chord stays.
    list.sort_by(|a, b| a.share.total_cmp(&b.share).then(b.fixed.cmp(&a.fixed)));
    list.dedup_by(|b, a| a.share == b.share);
    Ok((list, structure.course))
}

/// Asks for the ends of all first stretches, and the middles between them.
fn first_round(
    queries: &mut FieldQueries<'_>,
    (options, all_fitted): (&WriteOptions, &[Fitted]),
    nodes: &mut Vec<Node>,
) -> Result<Vec<Stretch>, WriteError> {
    let path = queries.path;
    let mut requests = Vec::new();
    let mut first = Vec::new();
    for (move_index, motion) in path.moves.iter().enumerate() {
        if is_divided(motion) {
            let (list, course) =
                boundaries(queries, move_index, (options, all_fitted[move_index]))?;
            for pair in list.windows(2) {
                let [from, to] = [pair[0].share, pair[1].share];
                requests.push(queries.request(move_index, from));
                requests.push(queries.request(move_index, from + (to - from) * 0.5));
            }
            requests.push(queries.request(move_index, 1.0));
            first.push((move_index, list, course));
        } else if is_corrected_at_end(motion) {
            requests.push(queries.request(move_index, 1.0));
            first.push((move_index, Vec::new(), Course::Cubic));
        }
        if requests.len() / 2 > options.max_pieces {
            return Err(WriteError::TooManyPieces {
                line: motion.line,
                limit: options.max_pieces,
            });
        }
    }
    let mut answers = queries.evaluate(&requests)?.into_iter();
    let mut answer = || answers.next().unwrap_or_default();
    let mut open = Vec::new();
    // What holds before a move: the last answer of the one before it.
    let mut before: Option<(usize, Vector6<f64>)> = None;
    for (move_index, list, course) in first {
        let mut value = answer();
        if list.is_empty() {
            nodes.push(Node::smooth(move_index, 1.0, value));
            before = Some((move_index, value));
            continue;
        }
        let earlier = before.filter(|(index, _)| *index + 1 == move_index);
        let motion = &path.moves[move_index];
        let fitted = all_fitted[move_index] != Fitted::Nothing;
        // The chords of an arc may become longer ones.
        let shared = motion.curve != Curve::Line && options.shortest_block_mm(motion).is_some();
        let mut begins = taken_up(earlier.map(|(_, value)| value), value, options);
        nodes.push(Node {
            before: begins,
            fixed: true,
            ..Node::smooth(move_index, 0.0, value)
        });
        for pair in list.windows(2) {
            let (middle, end) = (answer(), answer());
            nodes.push(Node {
                fixed: pair[1].fixed,
                ..Node::smooth(move_index, pair[1].share, end)
            });
            open.push(Stretch {
                move_index,
                course,
                entire: !fitted && !shared && (pair[0].fixed && pair[1].fixed || list.len() == 2),
                fitted,
                share: [pair[0].share, pair[1].share],
                ends: [value, end],
                begins,
                middle: Some(middle),
                quarters: None,
                irregular: None,
            });
            (value, begins) = (end, end);
        }
        before = Some((move_index, value));
    }
    Ok(open)
}

/// Gets the values that the open stretches need next.
fn answer(
    queries: &mut FieldQueries<'_>,
    open: &mut [Stretch],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let requests: Vec<Request> = open
        .iter()
        .filter(|stretch| stretch.middle.is_none())
        .map(|stretch| queries.request(stretch.move_index, stretch.at(0.5)))
        .collect();
    let mut answers = queries.evaluate(&requests)?.into_iter();
    for stretch in open.iter_mut().filter(|stretch| stretch.middle.is_none()) {
        stretch.middle = answers.next();
    }

    let wants: Vec<usize> = (0..open.len())
        .filter(|i| matches!(open[*i].decide(queries.path, options), Decision::Refine))
        .collect();
    let mut requests = Vec::new();
    for stretch in wants.iter().map(|i| &open[*i]) {
        for part in [0.25, 0.75] {
            requests.push(queries.request(stretch.move_index, stretch.at(part)));
        }
        if stretch.course != Course::Cubic || stretch.fitted {
            requests
                .push(queries.request(stretch.move_index, stretch.at(stretch.irregular_part())));
        }
    }
    let mut answers = queries.evaluate(&requests)?.into_iter();
    let mut answer = || answers.next().unwrap_or_default();
    for i in wants {
        let stretch = &mut open[i];
        stretch.quarters = Some([answer(), answer()]);
        if stretch.course != Course::Cubic || stretch.fitted {
            stretch.irregular = Some((stretch.irregular_part(), answer()));
        }
    }
    Ok(())
}

/// Accepts the good stretches and halves the others.
fn next_round(
    path: &Path,
    open: Vec<Stretch>,
    options: &WriteOptions,
    nodes: &mut Vec<Node>,
    accepted: &mut Vec<Accepted>,
) -> Vec<Stretch> {
    let mut next = Vec::new();
    for stretch in open {
        let (Some(middle), move_index) = (stretch.middle, stretch.move_index) else {
            continue;
        };
        let [from, to] = stretch.share;
        let [first, last] = stretch.ends;
        let share = stretch.at(0.5);
        match stretch.decide(path, options) {
            Decision::Accept | Decision::Refine => stretch.accepted(accepted),
            Decision::Jump => {
                // No piece is short enough: the correction jumps here. The tool steps at one place.
                nodes.push(Node {
                    before: first,
                    after: last,
                    bracket: stretch.share,
                    ..Node::smooth(move_index, share, first)
                });
                for (share, value) in [(from, first), (share, last)] {
                    accepted.push(Accepted {
                        move_index,
                        share,
                        values: [value; 5],
                    });
                }
            }
            Decision::Halve => {
                nodes.push(Node::smooth(move_index, share, middle));
                let [low, high] = match stretch.quarters {
                    Some([low, high]) => [Some(low), Some(high)],
                    None => [None, None],
                };
                let half = |share, ends: [Vector6<f64>; 2], begins, middle| Stretch {
                    share,
                    ends,
                    begins,
                    middle,
                    move_index,
                    course: stretch.course,
                    entire: false,
                    fitted: stretch.fitted,
                    quarters: None,
                    irregular: None,
                };
                next.push(half([from, share], [first, middle], stretch.begins, low));
                next.push(half([share, to], [middle, last], middle, high));
            }
        }
    }
    next
}
