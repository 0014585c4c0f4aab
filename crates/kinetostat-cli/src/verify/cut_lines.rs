//! Lines of cuts that both programs make, and what the original has behind them.

use std::collections::BTreeMap;

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

/// What the original has, each as often as it has it.
pub(crate) struct Left<K>(BTreeMap<K, usize>);

impl<K: Ord> Left<K> {
    pub(crate) fn of(all: impl IntoIterator<Item = K>) -> Self {
        let mut left = BTreeMap::new();
        for key in all {
            *left.entry(key).or_default() += 1;
        }
        Self(left)
    }

    /// Takes one of these, if one is left.
    pub(crate) fn take(&mut self, key: &K) -> bool {
        let left = self.0.get_mut(key).filter(|left| **left > 0);
        left.map(|left| *left -= 1).is_some()
    }
}
