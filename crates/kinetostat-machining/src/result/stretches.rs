//! A path of unknown length in equal stretches: never more than a stated number of them, however long it becomes.
//!
//! When the path leaves the last stretch, two neighbours become one and all are twice as long. The content of a stretch
//! depends on the points in it alone, not on when they came: a path that is gathered in parts gives the same stretches.

/// Content of a stretch of the path.
pub(crate) trait Joins: Default {
    /// Takes up what the next stretch has.
    fn join(&mut self, next: Self);
}

/// The stretches that the path has reached.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stretches<T> {
    most: usize,
    width_mm: f64,
    reached: Vec<T>,
}

/// Length of a stretch at first, mm: less than between two points of any program, and a power of two, so that twice as long is exact.
const FINEST_MM: f64 = 1.0 / 1024.0;

impl<T: Joins> Stretches<T> {
    /// Creates an empty path of at most `most` stretches, two at least; at the end there are more than half as many, or the path is shorter
    /// than `most` times 1/1024 mm.
    pub(crate) fn new(most: usize) -> Self {
        Self {
            most: most.max(2),
            width_mm: FINEST_MM,
            reached: Vec::new(),
        }
    }

    /// The stretch at a length of path, mm; a length that is no number belongs to the last one reached.
    pub(crate) fn at(&mut self, path_mm: f64) -> &mut T {
        let index = self.index_of(path_mm);
        if index >= self.reached.len() {
            self.reached.resize_with(index + 1, T::default);
        }
        &mut self.reached[index]
    }

    /// The stretches from one length of path to another, each with the length of its part of that way, mm.
    pub(crate) fn between(&mut self, from_mm: f64, to_mm: f64, mut each: impl FnMut(&mut T, f64)) {
        if !(to_mm > from_mm && from_mm.is_finite() && to_mm.is_finite()) {
            return;
        }
        // The end first: it may make the stretches longer.
        let last = self.index_of(to_mm);
        let first = self.index_of(from_mm);
        if last >= self.reached.len() {
            self.reached.resize_with(last + 1, T::default);
        }
        let width = self.width_mm;
        for (i, stretch) in (first..=last).zip(&mut self.reached[first..=last]) {
            let (start, end) = (i as f64 * width, (i as f64 + 1.0) * width);
            each(stretch, to_mm.min(end) - from_mm.max(start));
        }
    }

    fn index_of(&mut self, path_mm: f64) -> usize {
        if !path_mm.is_finite() {
            return self.reached.len().saturating_sub(1);
        }
        while path_mm / self.width_mm >= self.most as f64 {
            self.join_neighbours();
        }
        // Below zero is zero.
        (path_mm / self.width_mm) as usize
    }

    fn join_neighbours(&mut self) {
        self.width_mm *= 2.0;
        let mut fine = std::mem::take(&mut self.reached).into_iter();
        while let Some(mut first) = fine.next() {
            if let Some(second) = fine.next() {
                first.join(second);
            }
            self.reached.push(first);
        }
    }

    /// Length of every stretch, mm.
    pub(crate) fn width_mm(&self) -> f64 {
        self.width_mm
    }

    /// All stretches that were reached, in the order of the path, the first from zero on.
    pub(crate) fn reached(&self) -> &[T] {
        &self.reached
    }
}
