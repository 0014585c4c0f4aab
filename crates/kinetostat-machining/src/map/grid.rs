//! Evenly spaced places.

/// Evenly spaced positions of the tool, base axes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// First position along x, y and z.
    pub from_mm: [f64; 3],
    /// Last position along x, y and z; that of an axis with one place does not count.
    pub to_mm: [f64; 3],
    /// Places along x, y and z, at least one each.
    pub counts: [usize; 3],
}

impl Grid {
    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        let [x, y, z] = self.counts;
        x.saturating_mul(y).saturating_mul(z)
    }

    /// True without places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of a place along each axis: x runs fastest, z slowest.
    #[must_use]
    pub fn index(&self, place: usize) -> [usize; 3] {
        let [x, y, _] = self.counts.map(|n| n.max(1));
        [place % x, place / x % y, place / x / y]
    }

    /// Position along one axis (0 to 2), mm.
    #[must_use]
    pub fn position_mm(&self, axis: usize, index: usize) -> f64 {
        let (from, to, count) = (self.from_mm[axis], self.to_mm[axis], self.counts[axis]);
        match index {
            0 => from,
            // Exactly what was requested.
            _ if index + 1 == count => to,
            _ => from + (to - from) * index as f64 / (count - 1) as f64,
        }
    }
}
