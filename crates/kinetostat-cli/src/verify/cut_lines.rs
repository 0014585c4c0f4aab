//! Lines of cuts that both programs make.

/// Lines of cuts: of the program verified and of the original.
pub(crate) struct CutLines {
    by_own: Vec<[usize; 2]>,
    by_original: Vec<[usize; 2]>,
}

impl CutLines {
    pub(crate) fn of(pairs: &[[usize; 2]]) -> Self {
        let (mut by_own, mut by_original) = (pairs.to_vec(), pairs.to_vec());
        by_own.sort_unstable();
        by_original.sort_unstable_by_key(|[_, there]| *there);
        Self {
            by_own,
            by_original,
        }
    }

    /// Behind which cut a line of the program verified stands, as a line of the original (zero before all cuts).
    pub(crate) fn before_own(&self, line: usize) -> usize {
        let before = self.by_own.partition_point(|[own, _]| *own < line);
        (before.checked_sub(1)).map_or(0, |last| self.by_own[last][1])
    }

    /// The same of a line of the original.
    pub(crate) fn before(&self, line: usize) -> usize {
        let before = self.by_original.partition_point(|[_, there]| *there < line);
        (before.checked_sub(1)).map_or(0, |last| self.by_original[last][1])
    }
}
