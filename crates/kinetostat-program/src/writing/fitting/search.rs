//! Pieces that end on the curve: equally long ones, or each as long as it can be.

use crate::error::WriteError;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Span};

/// Halvings in the search for the longest stretch that fits.
const HALVINGS: u32 = 14;

/// The farthest share at which something is found: what fits is as long as `stride`, or longer, or shorter; a stretch as short as
/// `shortest` is not halved any more.
pub(crate) fn farthest<T>(
    [from, to]: [f64; 2],
    (stride, shortest): (f64, f64),
    found: impl Fn(f64) -> Option<T>,
) -> Option<(f64, T)> {
    let mut best = None;
    let mut high = (from + 2.0 * stride).min(to);
    let mut low = from;
    for _ in 0..HALVINGS {
        let Some(piece) = found(high) else {
            break;
        };
        best = Some((high, piece));
        if high >= to {
            return best;
        }
        low = high;
        high = (high + 2.0 * (high - from)).min(to);
    }
    for _ in 0..HALVINGS {
        if high - low <= shortest {
            break;
        }
        let middle = 0.5 * (low + high);
        match found(middle) {
            Some(piece) => (best, low) = (Some((middle, piece)), middle),
            None => high = middle,
        }
    }
    best
}

impl Fit<'_> {
    /// Returns `count` pieces of equal length, if all of them fit.
    pub fn equal(&self, span: &Span, count: usize) -> Option<Vec<FittedPiece>> {
        let [from, to] = span.share;
        let mut pieces = Vec::with_capacity(count);
        let mut last = FittedPiece::start(span);
        for piece in 1..=count {
            let share = match piece == count {
                true => to,
                false => from + (to - from) * piece as f64 / count as f64,
            };
            last = self.fitting(&self.part(span, &last, share))?;
            pieces.push(last);
        }
        Some(pieces)
    }

    /// The shortest stretch that is looked at, as a share.
    pub fn shortest(&self) -> f64 {
        self.options.smallest_piece_mm / self.curve.motion.length_mm()
    }

    /// Pieces that are each as long as they can be.
    pub fn longest(&self, span: &Span) -> Result<Vec<FittedPiece>, WriteError> {
        let to = span.share[1];
        let shortest = self.shortest();
        let mut pieces: Vec<FittedPiece> = Vec::new();
        let mut last = FittedPiece::start(span);
        let mut stride = to - span.share[0];
        while last.share_to < to {
            if pieces.len() >= self.options.max_pieces {
                return Err(WriteError::TooManyPieces {
                    line: self.curve.motion.line,
                    limit: self.options.max_pieces,
                });
            }
            let from = last.share_to;
            let best = farthest([from, to], (stride, shortest), |share| {
                self.fitting(&self.part(span, &last, share))
            });
            // Shorter than the shortest piece the curve is followed as it is, with an end where it may have a corner.
            let corner = self.curve.quarters(from, to).next();
            let next = (from + shortest).min(corner.unwrap_or(to)).min(to);
            let mut piece = best.map_or_else(
                || FittedPiece {
                    share_to: next,
                    target: self.point(span, next),
                    arc: None,
                    circle: None,
                },
                |(_, piece)| piece,
            );
            stride = piece.share_to - from;
            if stride <= 0.0 {
                // A share so near the end that the sum does not reach it.
                piece = FittedPiece {
                    share_to: to,
                    target: span.ends[1],
                    arc: None,
                    circle: None,
                };
            }
            pieces.push(piece);
            last = piece;
        }
        Ok(pieces)
    }
}
