//! The pieces of a move, from the nodes of its division: geometry in whatever language they are written.

use std::ops::Range;

use nalgebra::{Vector3, Vector6};

use crate::error::WriteError;
use crate::field::Correction;
use crate::number::larger;
use crate::path::curve::Curve;
use crate::path::moves::{Move, Path};
use crate::writing::corrected_curve::CorrectedCurve;
use crate::writing::directed_moves::DirectedMove;
use crate::writing::dividing::beginning::Fitted;
use crate::writing::dividing::divide::Division;
use crate::writing::fitting::stretch::{ArcForm, Fit, FittedPiece, Shape, Span};
use crate::writing::merge::Accepted;
use crate::writing::node::{Jump, Node, Turn, is_corrected_at_end, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::output_state::OutputMove;
use crate::writing::short_blocks::ShortestBlock;

/// Nodes of a move that are ends of pieces.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    All,
    /// Ends of the move, and jumps of the correction.
    OfJumps,
}

/// Hands out the pieces of one move after the other.
pub(crate) struct Steps<'a> {
    path: &'a Path,
    options: &'a WriteOptions,
    pub nodes: Vec<Node>,
    jumps: Vec<Jump>,
    courses: Vec<Accepted>,
    fitted: Vec<Fitted>,
    next_node: usize,
    /// Last rotation of the tool, as [`OutputMove::tilt`].
    pub tilt: Vector3<f64>,
    /// Largest jump of the correction without a step of its own, in mm.
    pub largest_jump_taken_up_mm: f64,
}

impl<'a> Steps<'a> {
    pub fn new(path: &'a Path, options: &'a WriteOptions, division: Division) -> Self {
        Self {
            path,
            options,
            nodes: division.nodes,
            jumps: division.jumps,
            courses: division.courses,
            fitted: division.fitted,
            next_node: 0,
            tilt: Vector3::zeros(),
            largest_jump_taken_up_mm: 0.0,
        }
    }

    /// Begins with this move.
    pub fn skip_before(&mut self, move_index: usize) {
        self.next_node = self
            .nodes
            .partition_point(|node| node.move_index < move_index);
    }

    fn nodes_of(&mut self, move_index: usize) -> Range<usize> {
        let first = self.next_node;
        while self
            .nodes
            .get(self.next_node)
            .is_some_and(|node| node.move_index == move_index)
        {
            self.next_node += 1;
        }
        first..self.next_node
    }

    /// Correction between the nodes of a move to which arcs are fitted.
    pub fn course(&self, move_index: usize) -> &[Accepted] {
        let first = self
            .courses
            .partition_point(|stretch| stretch.move_index < move_index);
        let last = self
            .courses
            .partition_point(|stretch| stretch.move_index <= move_index);
        &self.courses[first..last]
    }

    /// The pieces of a move, of which those before are taken already, and its nodes; `reached` is where the tool was last to go,
    /// `form` how its arcs are written.
    pub fn of(
        &mut self,
        move_index: usize,
        reached: Vector3<f64>,
        form: ArcForm,
    ) -> Result<(Vec<OutputMove>, Range<usize>), WriteError> {
        let motion = &self.path.moves[move_index];
        let range = self.nodes_of(move_index);
        let steps = match self.nodes[range.clone()].last() {
            None => vec![OutputMove::whole(reached, Vector3::zeros(), false)],
            Some(end) if is_corrected_at_end(motion) || !is_divided(motion) => {
                let end = Correction::of_lengths(&end.after, self.options.turn_lever_mm);
                let target = motion.end + end.shift_mm;
                vec![OutputMove::whole(target, end.turn, true)]
            }
            Some(_) => {
                let known = !self.course(move_index).is_empty();
                let shape = match (&motion.curve, self.fitted[move_index]) {
                    (Curve::Arc(arc), Fitted::Arcs) => Some(Shape::Arcs(arc, form)),
                    (Curve::Arc(_), Fitted::Circles) => Some(Shape::Circles),
                    _ => None,
                };
                match shape {
                    Some(shape) if known => {
                        self.fitted(move_index, shape, range.clone(), reached)?
                    }
                    _ if known => self.straight(move_index, range.clone(), reached)?,
                    _ => self.divided(motion, range.clone(), reached, Ends::All),
                }
            }
        };
        self.tilt = steps.last().map_or(self.tilt, |step| step.tilt);
        Ok((steps, range))
    }

    /// Pieces of a shape in place of the straight ones between two jumps of the correction.
    fn fitted(
        &mut self,
        move_index: usize,
        shape: Shape<'_>,
        range: Range<usize>,
        reached: Vector3<f64>,
    ) -> Result<Vec<OutputMove>, WriteError> {
        let motion = &self.path.moves[move_index];
        let spans = self.divided(motion, range, reached, Ends::OfJumps);
        let fit = Fit {
            curve: CorrectedCurve::new(motion, self.course(move_index)),
            shape,
            options: self.options,
        };
        curved_pieces(&fit, &spans, reached)
    }

    /// Straight pieces; where one is shorter than the controller takes, those between two jumps are shared out anew.
    fn straight(
        &mut self,
        move_index: usize,
        range: Range<usize>,
        reached: Vector3<f64>,
    ) -> Result<Vec<OutputMove>, WriteError> {
        let motion = &self.path.moves[move_index];
        let steps = self.divided(motion, range.clone(), reached, Ends::All);
        let turned = steps.iter().any(|step| step.tilt != Vector3::zeros());
        let shortest = self.options.shortest_block(motion);
        let (Some(shortest), true) = (shortest, motion.has_length() && !turned) else {
            // A curve of places says nothing of the orientation between them.
            return Ok(steps);
        };
        let spans = self.divided(motion, range, reached, Ends::OfJumps);
        let fit = Fit {
            curve: CorrectedCurve::new(motion, self.course(move_index)),
            shape: Shape::Straight,
            options: self.options,
        };
        let anew = straight_pieces(&fit, &spans, &steps, reached, &shortest)?;
        let says = |own: DirectedMove<'_>| {
            anew.iter()
                .all(|step| own.goes_on(step.share_from, step.share_to))
        };
        match DirectedMove::of(motion).is_none_or(says) {
            true => Ok(anew),
            // Short blocks are warned of; other ends would lead to other angles of the axes.
            false => Ok(steps),
        }
    }

    fn divided(
        &mut self,
        motion: &Move,
        range: Range<usize>,
        reached: Vector3<f64>,
        which: Ends,
    ) -> Vec<OutputMove> {
        let nodes = &self.nodes[range];
        let ends = [0, nodes.len() - 1];
        // Between two jumps pieces are fitted, wherever the nodes are.
        let all = nodes.iter().enumerate().filter(|(index, node)| {
            which == Ends::All || ends.contains(index) || node.before != node.after
        });
        let smallest_step = self.options.smallest_step_mm();
        let mut steps = Vec::with_capacity(nodes.len());
        let mut share_from = 0.0;
        let lever_mm = self.options.turn_lever_mm;
        let mut go = |point: Vector3<f64>,
                      correction: &Vector6<f64>,
                      share_to: f64,
                      corner_step: bool,
                      turn: Option<Turn>| {
            let correction = Correction::of_lengths(correction, lever_mm);
            steps.push(OutputMove {
                share_from,
                share_to,
                target: point + correction.shift_mm,
                tilt: correction.turn,
                corner_step,
                turn,
                arc: None,
                circle: None,
                corrected: true,
            });
            share_from = share_to;
        };
        let before = Correction {
            shift_mm: reached - motion.start,
            turn: self.tilt,
        };
        let mut last = before.in_lengths(lever_mm);
        for (index, node) in all {
            let point = motion.point(node.share);
            if index > 0 {
                last = node.before;
                go(point, &node.before, node.share, false, None);
            }
            if index + 1 == nodes.len() {
                continue;
            }
            let jump = (node.after - last).norm();
            if jump <= smallest_step {
                self.largest_jump_taken_up_mm = larger(self.largest_jump_taken_up_mm, jump);
                continue;
            }
            last = node.after;
            let jump = node.jump.map(|jump| &self.jumps[jump]);
            let mut done = 0.0;
            for &(part, correction) in jump.iter().flat_map(|jump| &jump.inner) {
                let turn = jump.map(|jump| jump.between(done, part));
                go(point, &correction, node.share, true, turn);
                done = part;
            }
            let turn = jump.map(|jump| jump.between(done, 1.0));
            go(point, &node.after, node.share, true, turn);
        }
        steps
    }
}

/// Arcs or circles in place of the long straight pieces between two jumps; `reached` is where the tool is before the move.
fn curved_pieces(
    fit: &Fit<'_>,
    spans: &[OutputMove],
    reached: Vector3<f64>,
) -> Result<Vec<OutputMove>, WriteError> {
    let shortest = fit.options.shortest_block(fit.curve.motion);
    let mut all = Vec::with_capacity(spans.len());
    let mut from = reached;
    for step in spans {
        match step.corner_step {
            true => all.push(*step),
            false => {
                let pieces = fit.pieces(&span_of(step, from), shortest.as_ref())?;
                all.extend(in_place_of(step, pieces, fit));
            }
        }
        from = step.target;
    }
    Ok(all)
}

/// The straight pieces of a division; where one of them between two jumps is shorter than a block may be, all of them there are
/// shared out anew. `spans` has one long piece between two jumps.
fn straight_pieces(
    fit: &Fit<'_>,
    spans: &[OutputMove],
    steps: &[OutputMove],
    reached: Vector3<f64>,
    shortest: &ShortestBlock,
) -> Result<Vec<OutputMove>, WriteError> {
    let mut all = Vec::with_capacity(steps.len());
    let (mut from, mut rest) = (reached, steps);
    for step in spans {
        let count = match step.corner_step {
            true => 1,
            false => rest.iter().take_while(|piece| !piece.corner_step).count(),
        };
        let (own, others) = rest.split_at(count.min(rest.len()));
        rest = others;
        let span = span_of(step, from);
        from = step.target;
        let pieces: Vec<FittedPiece> = own.iter().map(as_fitted).collect();
        match step.corner_step || fit.short_ones(&span, &pieces, shortest) == 0 {
            true => all.extend_from_slice(own),
            false => {
                let pieces = fit.instead_of(&span, pieces, shortest)?;
                all.extend(in_place_of(step, pieces, fit));
            }
        }
    }
    Ok(all)
}

fn span_of(step: &OutputMove, from: Vector3<f64>) -> Span {
    Span {
        share: [step.share_from, step.share_to],
        ends: [from, step.target],
    }
}

/// A straight piece, without what is the same for all pieces between two jumps.
fn as_fitted(step: &OutputMove) -> FittedPiece {
    FittedPiece {
        share_to: step.share_to,
        target: step.target,
        arc: None,
        circle: None,
    }
}

/// The pieces in place of a long one.
fn in_place_of<'a>(
    step: &'a OutputMove,
    pieces: Vec<FittedPiece>,
    fit: &'a Fit<'_>,
) -> impl Iterator<Item = OutputMove> + 'a {
    let mut share_from = step.share_from;
    let tilt = |share: f64| match fit.curve.turn(share) {
        Some(turn) if share < step.share_to => {
            let turn = Vector6::new(0.0, 0.0, 0.0, turn.x, turn.y, turn.z);
            Correction::of_lengths(&turn, fit.options.turn_lever_mm).turn
        }
        _ => step.tilt,
    };
    pieces.into_iter().map(move |piece| OutputMove {
        share_from: std::mem::replace(&mut share_from, piece.share_to),
        share_to: piece.share_to,
        target: piece.target,
        tilt: tilt(piece.share_to),
        arc: piece.arc,
        circle: piece.circle,
        ..*step
    })
}
