//! The pieces of a stretch, in the order in which they are tried.

use crate::error::WriteError;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Shape, Span};
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

/// Parts of the length of the shortest block between two places.
const PLACES: usize = 8;

/// A way with more places is not looked for.
const MOST_PLACES: f64 = 2000.0;

/// Numbers of equal pieces that are tried between the fewest that fit and the most that are long enough.
const TRIALS: usize = 16;

/// Chords by which the length of a curve is taken.
const CHORDS: usize = 64;

/// Minimum length, over their mean, of equal pieces of the path as written: the correction varies along it.
const SHORTEST_OF_MEAN: f64 = 0.998;

/// Maximum number of pieces to try, over that needed.
const FINEST: f64 = 4.0;

/// Way by which a place is reached.
#[derive(Clone, Copy)]
struct Reached {
    /// The last piece of the way.
    piece: FittedPiece,
    pieces: usize,
    /// The place where that begins.
    before: usize,
}

/// Pieces that are as long as a controller wants its blocks, where the tolerances allow it.
///
/// The best fit has short pieces where the correction bends most, or at the end, where little is left. Others may do: with free ends
/// and a last piece of some length ([`crate::writing::fitting::free_ends`]), equally long ones, or a way through places of the
/// curve. The places stand so near each other that the shortest block spans eight of them. From every place that can be reached each
/// piece that fits and is long enough leads to another one; of the ways to the end the one with the fewest pieces is taken.
impl Fit<'_> {
    /// Pieces none of which is shorter than a block may be, if the tolerances allow them; else those that were found.
    pub fn long_enough(
        &self,
        span: &Span,
        found: Vec<FittedPiece>,
        shortest: &ShortestBlock,
    ) -> Vec<FittedPiece> {
        if self.short_ones(span, &found, shortest) == 0 {
            return found;
        }
        if let Some(free) = self.free_ends(span, Some(shortest)) {
            return free;
        }
        let equal = self.equal_and_long(span, found.len(), shortest);
        let few = |pieces: &Vec<FittedPiece>| pieces.len() <= found.len();
        match equal {
            Some(equal) if few(&equal) => equal,
            equal => {
                let through = self.through_places(span, shortest);
                let all = equal.into_iter().chain(through);
                all.min_by_key(Vec::len).unwrap_or(found)
            }
        }
    }

    /// Number of these pieces that are shorter than a block may be.
    pub fn short_ones(
        &self,
        span: &Span,
        pieces: &[FittedPiece],
        shortest: &ShortestBlock,
    ) -> usize {
        let mut from = FittedPiece::start(span);
        let short = pieces.iter().filter(|piece| {
            let before = std::mem::replace(&mut from, **piece);
            !self.is_long(&before, piece, shortest)
        });
        short.count()
    }

    /// True if a piece that begins where another ends is no shorter than a block may be.
    pub fn is_long(
        &self,
        before: &FittedPiece,
        piece: &FittedPiece,
        shortest: &ShortestBlock,
    ) -> bool {
        let axis = match self.shape {
            Shape::Arcs(arc, _) => arc.axis,
            Shape::Circles | Shape::Straight => nalgebra::Vector3::zeros(),
        };
        let motion = self.curve.motion;
        let on_part_mm = motion.length_between_mm(before.share_to, piece.share_to);
        shortest.allows(piece.length_mm(&before.target, &axis), on_part_mm)
    }

    /// Equal pieces, about as few as fit; `count` is how many fit if each is as long as it can be.
    fn equal_and_long(
        &self,
        span: &Span,
        count: usize,
        shortest: &ShortestBlock,
    ) -> Option<Vec<FittedPiece>> {
        let most = (SHORTEST_OF_MEAN * self.length_mm(span) / shortest.longer_mm())
            .min(FINEST * count as f64) as usize;
        let fewest = count.min(most).max(1);
        (0..TRIALS)
            .map(|trial| fewest + (most.max(1) - fewest) * trial / (TRIALS - 1))
            .filter_map(|count| self.equal(span, count))
            .find(|pieces| self.short_ones(span, pieces, shortest) == 0)
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

    /// The fewest pieces of a way through places of the curve.
    fn through_places(&self, span: &Span, shortest: &ShortestBlock) -> Option<Vec<FittedPiece>> {
        let [from, to] = span.share;
        let on_part_mm = self.curve.motion.length_between_mm(from, to);
        let count = (PLACES as f64 * on_part_mm / shortest.longer_mm()).ceil();
        if !(1.0..=MOST_PLACES).contains(&count) {
            return None;
        }
        let count = count as usize;
        let share = |place: usize| match place == count {
            true => to,
            false => from + (to - from) * place as f64 / count as f64,
        };
        let mut ways: Vec<Option<Reached>> = vec![None; count + 1];
        ways[0] = Some(Reached {
            piece: FittedPiece::start(span),
            pieces: 0,
            before: 0,
        });
        for place in 0..count {
            let Some(way) = ways[place] else {
                continue;
            };
            for next in further(place, count) {
                // A longer piece does not fit if this one does not.
                let Some(piece) = self.fitting(&self.part(span, &way.piece, share(next))) else {
                    break;
                };
                let pieces = way.pieces + 1;
                let fewer = ways[next].is_none_or(|known| pieces < known.pieces);
                if fewer && self.is_long(&way.piece, &piece, shortest) {
                    ways[next] = Some(Reached {
                        piece,
                        pieces,
                        before: place,
                    });
                }
            }
        }
        let mut pieces = Vec::new();
        let mut at = count;
        while at > 0 {
            let way = ways[at]?;
            pieces.push(way.piece);
            at = way.before;
        }
        pieces.reverse();
        Some(pieces)
    }
}

/// Places to which a piece may lead: every one up to twice the shortest block, as longer pieces could be divided there, and some of
/// those beyond, for fewer pieces.
fn further(place: usize, count: usize) -> impl Iterator<Item = usize> {
    let near = PLACES - 1..=2 * PLACES + 1;
    let far = (1..).map(|step: usize| 2 * PLACES + 1 + step * (step + 1));
    let all = near.chain(far).map(move |way| place + way);
    let inside = all.take_while(move |next| *next < count);
    // The end itself comes last: everything before it is nearer.
    inside.chain([count])
}
