//! All moves of a path together, in rounds: what is not good is halved.

use nalgebra::Vector6;

use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor, Request};
use crate::path::curve::Curve;
use crate::path::moves::Path;
use crate::writing::directed_moves::{DirectedMove, directed_moves, refuse_other_angles};
use crate::writing::dividing::beginning::{Fitted, first_round};
use crate::writing::dividing::{Decision, Place, Stretch};
use crate::writing::merge::{Accepted, merge};
use crate::writing::node::{Jump, Node, follow_turns, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::queries::FieldQueries;

/// All nodes, by move and share.
pub(crate) struct Division {
    pub nodes: Vec<Node>,
    pub jumps: Vec<Jump>,
    /// The correction on the moves to which arcs are fitted, and on those whose straight pieces may be shared out anew, by move
    /// and share.
    pub courses: Vec<Accepted>,
    /// Curves that are fitted to the moves.
    pub fitted: Vec<Fitted>,
    pub evaluations: usize,
    /// Largest part of a correction along axes that the program never states, in mm.
    pub left_out_mm: f64,
}

/// `wanted` says what is to be fitted to the arcs among the moves.
pub(crate) fn divide(
    path: &Path,
    field: &dyn CorrectionField,
    options: &WriteOptions,
    wanted: &dyn Fn(usize) -> Fitted,
    monitor: &dyn Monitor,
) -> Result<Division, WriteError> {
    let directed = directed_moves(path);
    let fitted: Vec<Fitted> = path
        .moves
        .iter()
        .enumerate()
        .map(|(index, motion)| match motion.curve {
            // Pieces end where directions say the angles.
            Curve::Arc(_) if directed[index].is_some() => Fitted::Nothing,
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
    let mut open = first_round(&mut queries, options, &fitted, &directed, &mut nodes)?;
    while !open.is_empty() {
        answer(&mut queries, &mut open, options)?;
        open = next_round(path, &directed, open, options, &mut nodes, &mut accepted);
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
    let mut nodes = merge(nodes, &accepted, &directed, options);
    refuse_other_angles(path, &nodes, &directed)?;
    let jumps = follow_turns(&mut queries, &mut nodes, options)?;
    accepted.retain(|stretch| {
        let motion = &path.moves[stretch.move_index];
        options.shortest_block(motion).is_some() || fitted[stretch.move_index] != Fitted::Nothing
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

/// Gets the values that decide what becomes of the open stretches.
fn answer(
    queries: &mut FieldQueries<'_>,
    open: &mut [Stretch],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let path = queries.path;
    loop {
        let wanted = open.iter().enumerate();
        let wanted: Vec<(usize, Place)> = wanted
            .flat_map(|(i, stretch)| stretch.lacks(path, options).map(move |place| (i, place)))
            .collect();
        if wanted.is_empty() {
            return Ok(());
        }
        let request = |(i, place): &(usize, Place)| {
            let stretch = &open[*i];
            queries.request(stretch.move_index, stretch.at(place.part()))
        };
        let requests: Vec<Request> = wanted.iter().map(request).collect();
        for ((i, place), value) in wanted.into_iter().zip(queries.evaluate(&requests)?) {
            open[i].learn(place, value);
        }
    }
}

/// Accepts the good stretches and halves the others.
fn next_round(
    path: &Path,
    directed: &[Option<DirectedMove<'_>>],
    open: Vec<Stretch>,
    options: &WriteOptions,
    nodes: &mut Vec<Node>,
    accepted: &mut Vec<Accepted>,
) -> Vec<Stretch> {
    let mut next = Vec::new();
    for stretch in open {
        let (Some(middle), move_index) = (stretch.middle, stretch.move_index) else {
            // The ends determine the correction.
            continue;
        };
        let [from, to] = stretch.share;
        let [first, last] = stretch.ends;
        let share = stretch.at(0.5);
        let decision = match (stretch.decide(path, options), &directed[move_index]) {
            (Decision::Accept | Decision::Confirm | Decision::Refine, Some(own))
                if !own.goes_on(from, to) && !stretch.is_shortest(path, options) =>
            {
                Decision::Halve
            }
            (decision, _) => decision,
        };
        match decision {
            Decision::Accept | Decision::Confirm | Decision::Refine => stretch.accepted(accepted),
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
                    across_pole: stretch.across_pole,
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
