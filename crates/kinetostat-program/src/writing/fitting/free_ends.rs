//! Arcs whose ends between two others may leave the curve along the axis: the fewest, and of those the nearest.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number::{larger, smaller};
use crate::path::curve::Arc;
use crate::writing::fitting::stretch::{Fit, FittedPiece, Shape, Span, Tube};
use crate::writing::short_blocks::ShortestBlock;

/// Parts of the longest piece at which the next one is tried to begin.
const BEGINNINGS: [f64; 3] = [1.0, 0.86, 0.6];

/// Maximum number of pieces of a stretch for this search, which takes long.
const MOST: usize = 100;

/// Factor over the shortest block, along the path, that is left for the last piece: the corrected arc may be shorter.
const MARGIN: f64 = 1.05;

/// Steps in the search for the least tolerance that as many pieces keep.
const NARROWINGS: u32 = 2;

/// The farthest that a piece can end from where it begins, and the heights there.
struct Reach {
    share: f64,
    tube: Tube,
    /// True if it ends where the stretch does.
    whole: bool,
}

/// Limits for the ends of the pieces of one stretch.
struct Search<'a> {
    fit: &'a Fit<'a>,
    arc: &'a Arc,
    span: &'a Span,
    within_mm: f64,
    /// Minimum length of a piece.
    shortest: Option<&'a ShortestBlock>,
}

impl Fit<'_> {
    /// Fits the fewest arcs that these tolerances allow, none of them shorter than a block may be, and of those the ones that
    /// leave the curve least; `None` if they are too many or if one would be straight.
    pub fn free_ends(
        &self,
        span: &Span,
        shortest: Option<&ShortestBlock>,
    ) -> Option<Vec<FittedPiece>> {
        let Shape::Arcs(arc, _) = self.shape else {
            return None;
        };
        let most = self.allowed_mm();
        let search = |within_mm: f64| Search {
            fit: self,
            arc,
            span,
            within_mm,
            shortest,
        };
        let mut best = search(most).pieces(MOST)?;
        let (mut low, mut high) = (0.5 * most, most);
        for _ in 0..NARROWINGS {
            let middle = 0.5 * (low + high);
            match search(middle).pieces(best.len()) {
                Some(pieces) => (best, high) = (pieces, middle),
                None => low = middle,
            }
        }
        Some(best)
    }
}

impl Search<'_> {
    fn pieces(&self, most: usize) -> Option<Vec<FittedPiece>> {
        let mut pieces: Vec<FittedPiece> = Vec::new();
        let mut last = FittedPiece::start(self.span);
        let mut reach = self.reach(&last, self.span.share[1] - last.share_to)?;
        while pieces.len() < most {
            if reach.whole {
                let target = self.span.ends[1];
                pieces.push(self.piece(self.span.share[1], target, reach.tube));
                return Some(pieces);
            }
            let mut best: Option<(Reach, FittedPiece)> = None;
            for (next, stride) in self.beginnings(&last, &reach) {
                let Some(further) = self.reach(&next, stride) else {
                    continue;
                };
                let better = best.as_ref().is_none_or(|(best, _)| {
                    (further.whole, further.share) > (best.whole, best.share)
                });
                if better {
                    best = Some((further, next));
                }
                if best.as_ref().is_some_and(|(best, _)| best.whole) {
                    break;
                }
            }
            let (further, next) = best?;
            // Nothing is gained by a piece that does not go on.
            if !further.whole && further.share <= reach.share {
                return None;
            }
            pieces.push(next);
            (last, reach) = (next, further);
        }
        None
    }

    /// The ends that a piece may have where the next one sees farthest, with the stride of the longest.
    fn beginnings(&self, last: &FittedPiece, reach: &Reach) -> Vec<(FittedPiece, f64)> {
        let from = last.share_to;
        let stride = reach.share - from;
        let start = last.target.dot(&self.arc.axis);
        let end = 0.5 * (reach.tube.heights[0] + reach.tube.heights[1]);
        let mut found = Vec::new();
        // The rest after the piece is long enough as well, and not empty.
        let [_, to] = self.span.share;
        let rest = larger(
            MARGIN * self.shortest.map_or(0.0, ShortestBlock::longer_mm)
                / self.fit.curve.motion.length_mm(),
            self.fit.shortest(),
        );
        for part in BEGINNINGS {
            let share = (from + stride * part).min(to - rest);
            if share <= from {
                continue;
            }
            let part = (share - from) / stride;
            let point = self.fit.curve.point(share);
            let Some(tube) = self.tube(last, share, point) else {
                continue;
            };
            let [low, high] = tube.heights;
            let on_way = (start + (end - start) * part).clamp(low, high);
            let heights = match high - low > 0.02 * self.within_mm {
                true => vec![on_way, low, high],
                false => vec![on_way],
            };
            for height in heights {
                let target = point + self.arc.axis * (height - point.dot(&self.arc.axis));
                let piece = self.piece(share, target, tube);
                if self.is_long(&piece, last) {
                    found.push((piece, stride));
                }
            }
        }
        found
    }

    /// The farthest end of a piece that begins where another ends.
    fn reach(&self, last: &FittedPiece, stride: f64) -> Option<Reach> {
        let from = last.share_to;
        let [_, to] = self.span.share;
        let end = self.span.ends[1];
        let whole = self.tube(last, to, end).filter(|tube| {
            let height = end.dot(&self.arc.axis);
            let piece = self.piece(to, end, *tube);
            (tube.heights[0]..=tube.heights[1]).contains(&height) && self.is_long(&piece, last)
        });
        if let Some(tube) = whole {
            return Some(Reach {
                share: to,
                tube,
                whole: true,
            });
        }
        // The accuracy of the search is a fraction of the stride.
        let shortest = larger(self.fit.shortest(), 2e-3 * stride);
        let (share, tube) = farthest([from, to], stride, shortest, |share| {
            self.tube(last, share, self.fit.curve.point(share))
        })?;
        Some(Reach {
            share,
            tube,
            whole: false,
        })
    }

    /// The arcs from the end of a piece to above and below a place; the place itself is within the tolerance, too.
    fn tube(&self, last: &FittedPiece, share: f64, place: Vector3<f64>) -> Option<Tube> {
        let part = Span {
            share: [last.share_to, share],
            ends: [last.target, place],
        };
        let mut tube = self.fit.tube(&part, self.within_mm)?;
        let height = place.dot(&self.arc.axis);
        tube.heights = [
            larger(tube.heights[0], height - self.within_mm),
            smaller(tube.heights[1], height + self.within_mm),
        ];
        (tube.heights[0] <= tube.heights[1]).then_some(tube)
    }

    fn piece(&self, share_to: f64, target: Vector3<f64>, tube: Tube) -> FittedPiece {
        FittedPiece {
            share_to,
            target,
            arc: Some(tube.arc),
            circle: None,
        }
    }

    fn is_long(&self, piece: &FittedPiece, last: &FittedPiece) -> bool {
        let is_long = |shortest| self.fit.is_long(last, piece, shortest);
        self.shortest.is_none_or(is_long)
    }
}

/// Halvings in the search for the longest stretch that fits.
const HALVINGS: u32 = 14;

/// The farthest share at which something is found: what fits is as long as `stride`, or longer, or shorter; a stretch as short as
/// `shortest` is not halved any more.
fn farthest<T>(
    [from, to]: [f64; 2],
    stride: f64,
    shortest: f64,
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
            let best = farthest([from, to], stride, shortest, |share| {
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
