//! The pieces of a stretch, in the order in which they are tried.

use crate::error::WriteError;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Span};
use crate::writing::short_blocks::ShortestBlock;

/// Equal stretches that are tried before all else.
const FEW: usize = 3;

/// Stretches that are taken equally long if so many equal ones fit.
const MOST_EQUAL: usize = 64;

impl Fit<'_> {
    /// The pieces of a stretch without a jump; none of them is shorter than a block may be, if that can be within the tolerances.
    pub fn pieces(
        &self,
        span: &Span,
        shortest: Option<&ShortestBlock>,
    ) -> Result<Vec<FittedPiece>, WriteError> {
        let fewest = self.fewest(span)?;
        Ok(match shortest {
            Some(shortest) => self.long_enough(span, fewest, shortest),
            None => fewest,
        })
    }

    /// Replaces straight pieces by others with fewer short ones, or fewer at all; none of them is shorter than a block may be, if
    /// that can be within the tolerances.
    pub fn instead_of(
        &self,
        span: &Span,
        own: Vec<FittedPiece>,
        shortest: &ShortestBlock,
    ) -> Result<Vec<FittedPiece>, WriteError> {
        let fewest = self.fewest(span)?;
        let rank = |pieces: &[FittedPiece]| (self.short_ones(span, pieces, shortest), pieces.len());
        let better = match rank(&fewest) < rank(&own) {
            true => fewest,
            false => own,
        };
        Ok(self.long_enough(span, better, shortest))
    }

    /// About as few pieces as fit.
    fn fewest(&self, span: &Span) -> Result<Vec<FittedPiece>, WriteError> {
        for count in 1..=FEW {
            if let Some(pieces) = self.equal(span, count) {
                return Ok(pieces);
            }
        }
        if let Some(pieces) = self.free_ends(span, None) {
            return Ok(pieces);
        }
        let longest = self.longest(span)?;
        let equal = match longest.len() <= MOST_EQUAL {
            true => self.equal(span, longest.len()),
            false => None,
        };
        Ok(equal.unwrap_or(longest))
    }
}
