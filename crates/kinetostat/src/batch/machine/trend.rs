//! The last change of a machine along a path: the numbers of the posture at hand, and by how much they differ from the one before.

use pulp::Simd;

use crate::batch::limb::reach::Target;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::identity;

/// State at the posture before.
pub(crate) struct Trend<S: Simd> {
    /// One in the lanes where it was found.
    pub known: Lanes<S>,
    pub place: Target<S>,
    pub load: [Lanes<S>; 6],
    /// Numbers of the posture at hand, in the order of `Machine::note_all`, and by how much they have changed since the one before.
    last: Vec<Lanes<S>>,
    change: Vec<Lanes<S>>,
}

impl<S: Simd> Trend<S> {
    pub fn new(simd: S) -> Self {
        let zero = Lanes::new(simd, 0.0);
        Self {
            known: zero,
            place: Target {
                rotation: identity(simd),
                point: [zero; 3],
            },
            load: [zero; 6],
            last: Vec::new(),
            change: Vec::new(),
        }
    }

    /// Marks the next posture as one without a neighbour.
    #[inline(always)]
    pub fn forget(&mut self, simd: S) {
        self.known = Lanes::new(simd, 0.0);
    }

    #[inline(always)]
    pub fn note(&mut self, index: &mut usize, numbers: &[Lanes<S>]) {
        for now in numbers {
            if *index == self.last.len() {
                self.last.push(*now);
                self.change.push(*now);
            }
            self.change[*index] = *now - self.last[*index];
            self.last[*index] = *now;
            *index += 1;
        }
    }

    /// Changes numbers by a share of their last change.
    #[inline(always)]
    pub fn go_on(&self, from: &mut usize, share: Lanes<S>, numbers: &mut [Lanes<S>]) {
        let zero = share.same(0.0);
        for x in numbers {
            let to = self.change[*from].times_plus(share, *x);
            // Numbers of a posture that was not found may be NaN.
            *x = zero.where_less(share, to, *x);
            *from += 1;
        }
    }
}
