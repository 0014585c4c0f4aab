//! Lengths of moves by the axes that are known before them.

/// Lengths by the axes that are known before the moves: which of them count is clear only when all axes are that are stated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ByKnown([f64; 8]);

impl ByKnown {
    pub fn add(&mut self, known: [bool; 3], length_mm: f64) {
        self.0[index_of(known)] += length_mm;
    }

    /// Length of the moves from known places, in a program that states these axes.
    pub fn whole_mm(&self, stated: [bool; 3]) -> f64 {
        let counts = (0..8).filter(|index| covers(*index, stated));
        counts.map(|index| self.0[index]).sum()
    }
}

/// Index below 8 of a set of known axes.
pub(crate) fn index_of(known: [bool; 3]) -> usize {
    (0..3).map(|axis| usize::from(known[axis]) << axis).sum()
}

/// True if all axes that are stated are known.
pub(crate) fn covers(index: usize, stated: [bool; 3]) -> bool {
    (0..3).all(|axis| index >> axis & 1 == 1 || !stated[axis])
}
