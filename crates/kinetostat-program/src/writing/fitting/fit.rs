//! The pieces of a stretch, in the order in which they are tried.

use crate::error::WriteError;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Shape, Span};

/// Equal stretches that are tried before all else.
const FEW: usize = 3;

/// Stretches that are taken equally long if so many equal ones fit.
const MOST_EQUAL: usize = 64;

/// Numbers of equal stretches that are tried between the fewest that fit and the most that are long enough.
const TRIALS: usize = 16;

/// Chords by which the length of a curve is taken.
const CHORDS: usize = 64;

/// How much shorter than their mean equal pieces of the path may be where they are written: the correction varies along it.
const SHORTEST_OF_MEAN: f64 = 0.998;

/// How many times the pieces that are needed are looked for at most.
const FINEST: f64 = 4.0;

impl Fit<'_> {
    /// The pieces of a stretch without a jump; none of them is shorter than `shortest_block_mm`, if that can be within the tolerances.
    pub fn pieces(
        &self,
        span: &Span,
        shortest_block_mm: f64,
    ) -> Result<Vec<FittedPiece>, WriteError> {
        for count in 1..=FEW {
            if let Some(pieces) = self.equal(span, count) {
                return Ok(pieces);
            }
        }
        if let Some(pieces) = self.free_ends(span, shortest_block_mm) {
            return Ok(pieces);
        }
        let longest = self.longest(span)?;
        if self.has_shorter(span, &longest, shortest_block_mm) {
            let equal = self.equal_and_long(span, (longest.len(), shortest_block_mm));
            let fewest = || self.free_ends(span, 0.0);
            return Ok(equal.or_else(fewest).unwrap_or(longest));
        }
        let equal = match longest.len() <= MOST_EQUAL {
            true => self.equal(span, longest.len()),
            false => None,
        };
        Ok(equal.unwrap_or(longest))
    }

    /// Equal pieces, about as few as fit, that are as long as asked; `count` is how many fit if each is as long as it can be.
    pub fn equal_and_long(
        &self,
        span: &Span,
        (count, shortest_block_mm): (usize, f64),
    ) -> Option<Vec<FittedPiece>> {
        let most = (SHORTEST_OF_MEAN * self.length_mm(span) / shortest_block_mm)
            .min(FINEST * count as f64) as usize;
        let fewest = count.min(most).max(1);
        (0..TRIALS)
            .map(|trial| fewest + (most.max(1) - fewest) * trial / (TRIALS - 1))
            .filter_map(|count| self.equal(span, count))
            .find(|pieces| !self.has_shorter(span, pieces, shortest_block_mm))
    }

    /// About the length of the corrected curve, mm.
    fn length_mm(&self, span: &Span) -> f64 {
        let [from, to] = span.share;
        let mut last = span.ends[0];
        let chords = (1..=CHORDS).map(|chord| {
            let next = self.point(span, from + (to - from) * chord as f64 / CHORDS as f64);
            (next - std::mem::replace(&mut last, next)).norm()
        });
        chords.sum()
    }

    /// Whether one of these pieces is shorter than a length.
    pub fn has_shorter(&self, span: &Span, pieces: &[FittedPiece], shortest_mm: f64) -> bool {
        let axis = match self.shape {
            Shape::Arcs(arc, _) => arc.axis,
            Shape::Circles | Shape::Straight => nalgebra::Vector3::zeros(),
        };
        let mut from = span.ends[0];
        pieces.iter().any(|piece| {
            let short = piece.length_mm(&from, &axis) < shortest_mm;
            from = piece.target;
            short
        })
    }
}
