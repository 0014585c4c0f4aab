//! Fitted pieces of a move in place of those that its division gave, between the steps where the correction jumps.

use nalgebra::{Vector3, Vector6};

use crate::error::WriteError;
use crate::field::correction::Correction;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Span};
use crate::writing::output_state::OutputMove;
use crate::writing::short_blocks::ShortestBlock;

/// Arcs or circles in place of the long straight pieces between two jumps; `reached` is where the tool is before the move.
pub(crate) fn curved_pieces(
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
pub(crate) fn straight_pieces(
    fit: &Fit<'_>,
    (spans, steps): (&[OutputMove], &[OutputMove]),
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
