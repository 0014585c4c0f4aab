//! The stretches of all moves before anything is known of the correction.

use nalgebra::Vector6;

use crate::error::WriteError;
use crate::field::Course;
use crate::path::curve::Curve;
use crate::path::moves::Move;
use crate::writing::directed_moves::DirectedMove;
use crate::writing::dividing::Stretch;
use crate::writing::node::{Node, is_corrected_at_end, is_divided, taken_up};
use crate::writing::options::WriteOptions;
use crate::writing::queries::FieldQueries;

/// Stretches of an arc to which arcs are fitted are no longer than this, in rad, before anything is known of the correction.
const FIRST_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

/// Curves that are fitted to the corrected curve of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fitted {
    Nothing,
    /// Arcs about its own axis, which rise evenly.
    Arcs,
    /// Circles through three places.
    Circles,
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
    options: &WriteOptions,
    fitted: Fitted,
    directed: Option<&DirectedMove<'_>>,
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
    // The end of a chord is kept if two entries are at one place.
    list.sort_by(|a, b| a.share.total_cmp(&b.share).then(b.fixed.cmp(&a.fixed)));
    list.dedup_by(|b, a| a.share == b.share);
    if let Some(own) = directed {
        for share in &own.approaching {
            insert(*share, false, &mut list);
        }
        for pole in &own.near_poles {
            around(pole, &mut list);
        }
    }
    Ok((list, structure.course))
}

/// Puts the two ends of a stretch across a pole in place of what lies between them; of an arc several chords stay.
fn around(pole: &[f64; 2], list: &mut Vec<Boundary>) {
    let inside = |boundary: &Boundary| boundary.share > pole[0] && boundary.share < pole[1];
    let several = list.iter().filter(|b| inside(b) && b.fixed).count() > 1;
    if several {
        return;
    }
    let fixed = list.iter().any(|b| inside(b) && b.fixed);
    // The ends of the move stay, wherever the pole is.
    list.retain(|b| !inside(b) || b.share == 0.0 || b.share == 1.0);
    for share in *pole {
        insert(share, fixed, list);
    }
}

fn insert(share: f64, fixed: bool, list: &mut Vec<Boundary>) {
    let at = list.partition_point(|boundary| boundary.share < share);
    if list.get(at).is_none_or(|boundary| boundary.share != share) {
        list.insert(at, Boundary { share, fixed });
    }
}

/// Share of the length over which a correction is smooth: the ends of shorter moves most often say all.
const SHORT: f64 = 0.01;

/// True if the middle of a move is requested only when its ends do not determine the correction.
fn is_short(
    motion: &Move,
    course: Course,
    list: &[Boundary],
    directed: Option<&DirectedMove<'_>>,
) -> bool {
    let Course::Steady { radius_mm } = course else {
        return false;
    };
    let is_line = motion.curve == Curve::Line && directed.is_none();
    is_line && list.len() == 2 && motion.length_mm() < SHORT * radius_mm
}

/// Asks for the ends of all first stretches, and for the middles between them where they are not very short.
pub(crate) fn first_round(
    queries: &mut FieldQueries<'_>,
    options: &WriteOptions,
    all_fitted: &[Fitted],
    directed: &[Option<DirectedMove<'_>>],
    nodes: &mut Vec<Node>,
) -> Result<Vec<Stretch>, WriteError> {
    let path = queries.path;
    let mut requests = Vec::with_capacity(2 * path.moves.len());
    let mut first = Vec::with_capacity(path.moves.len());
    for (move_index, motion) in path.moves.iter().enumerate() {
        if is_divided(motion) {
            let (list, course) = boundaries(
                queries,
                move_index,
                options,
                all_fitted[move_index],
                directed[move_index].as_ref(),
            )?;
            let middles = !is_short(motion, course, &list, directed[move_index].as_ref());
            for pair in list.windows(2) {
                let [from, to] = [pair[0].share, pair[1].share];
                requests.push(queries.request(move_index, from));
                if middles {
                    requests.push(queries.request(move_index, from + (to - from) * 0.5));
                }
            }
            requests.push(queries.request(move_index, 1.0));
            first.push((move_index, list, course, middles));
        } else if is_corrected_at_end(motion) {
            requests.push(queries.request(move_index, 1.0));
            first.push((move_index, Vec::new(), Course::Cubic, false));
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
    let mut open = Vec::with_capacity(first.len());
    nodes.reserve(requests.len());
    // Correction before a move: the last answer of the one before it.
    let mut before: Option<(usize, Vector6<f64>)> = None;
    for (move_index, list, course, middles) in first {
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
        let shared = motion.curve != Curve::Line && options.shortest_block(motion).is_some();
        let mut begins = taken_up(earlier.map(|(_, value)| value), value, options);
        nodes.push(Node {
            before: begins,
            fixed: true,
            ..Node::smooth(move_index, 0.0, value)
        });
        for pair in list.windows(2) {
            let (middle, end) = (middles.then(&mut answer), answer());
            nodes.push(Node {
                fixed: pair[1].fixed,
                ..Node::smooth(move_index, pair[1].share, end)
            });
            open.push(Stretch {
                move_index,
                course,
                entire: !fitted && !shared && (pair[0].fixed && pair[1].fixed || list.len() == 2),
                fitted,
                across_pole: directed[move_index]
                    .as_ref()
                    .is_some_and(|own| own.is_across_pole([pair[0].share, pair[1].share])),
                share: [pair[0].share, pair[1].share],
                ends: [value, end],
                begins,
                middle,
                quarters: None,
                irregular: None,
            });
            (value, begins) = (end, end);
        }
        before = Some((move_index, value));
    }
    Ok(open)
}
