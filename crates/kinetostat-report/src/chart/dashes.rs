//! Dashed lines that lie on each other: mirrored shapes have the same curve, and two rows of dashes
//! out of step look like a solid line.

use crate::chart::outline::distance;
use crate::svg::Pixel;

/// Nearer than this two lines are drawn as one, pixels.
const NEAR: f64 = 0.6;

/// Lines drawn so far in one style.
#[derive(Default)]
pub(crate) struct Drawn {
    pieces: Vec<(Pixel, Pixel)>,
}

impl Drawn {
    /// The parts of a line that are not drawn yet; they count as drawn from now on.
    pub(crate) fn fresh(&mut self, points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
        let mut out: Vec<Option<Pixel>> = Vec::new();
        let mut lifted = true;
        for pair in points.windows(2) {
            let [Some(a), Some(b)] = *pair else {
                lifted = true;
                continue;
            };
            if a == b {
                continue;
            }
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            // The piece before ends where this one begins and hides none of it.
            let known = &self.pieces[..self.pieces.len().saturating_sub(usize::from(!lifted))];
            let hidden = [a, middle, b]
                .iter()
                .all(|p| known.iter().any(|(c, d)| distance(*p, *c, *d) < NEAR));
            if hidden {
                lifted = true;
                continue;
            }
            if lifted {
                out.extend([None, Some(a)]);
            }
            out.push(Some(b));
            lifted = false;
            self.pieces.push((a, b));
        }
        if points.len() == 1 {
            out.extend(points);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_comes_back_is_drawn_once() {
        let there: Vec<_> = (0..=100)
            .map(|i| Some([f64::from(i), 0.5 * f64::from(i)]))
            .collect();
        let mut both = there.clone();
        both.extend(there.iter().rev());
        let mut drawn = Drawn::default();
        let fresh = drawn.fresh(&both);
        let count = fresh.iter().flatten().count();
        assert!((100..=104).contains(&count), "{count}");
        assert!(drawn.fresh(&there).iter().flatten().next().is_none());
        // Another line stays whole.
        let other: Vec<_> = (0..=10).map(|i| Some([f64::from(i), 30.0])).collect();
        assert_eq!(drawn.fresh(&other).iter().flatten().count(), 11);
    }
}
