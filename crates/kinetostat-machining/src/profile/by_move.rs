//! Lists by move, and values that are linear between the places at which they are known.

/// Lists, one for each move, in one piece of memory.
#[derive(Clone, Debug)]
pub(crate) struct ByMove<T> {
    all: Vec<T>,
    /// Start of the list of each move; one more than there are moves.
    first: Vec<usize>,
}

/// Values at shares of moves, linear between them.
pub(crate) type Profile<const N: usize> = ByMove<(f64, [f64; N])>;

impl<T> ByMove<T> {
    pub fn new() -> Self {
        Self {
            all: Vec::new(),
            first: vec![0],
        }
    }

    /// The list of the next move.
    pub fn push(&mut self, list: impl IntoIterator<Item = T>) {
        self.all.extend(list);
        self.first.push(self.all.len());
    }

    pub fn of(&self, move_index: usize) -> &[T] {
        match self.first.get(move_index..move_index + 2) {
            Some(&[from, to]) => &self.all[from..to],
            _ => &[],
        }
    }
}

impl<const N: usize> Profile<N> {
    /// The value at a share of a move; `None` where nothing is known of the move.
    pub fn at(&self, move_index: usize, share: f64) -> Option<[f64; N]> {
        let vertices = self.of(move_index);
        let after = vertices.partition_point(|(at, _)| *at < share);
        let before = after.checked_sub(1).and_then(|i| vertices.get(i));
        match (before, vertices.get(after)) {
            (None, None) => None,
            (Some((_, value)), None) | (None, Some((_, value))) => Some(*value),
            (Some((from, a)), Some((to, b))) => {
                let part = match to > from {
                    true => (share - from) / (to - from),
                    false => 1.0,
                };
                Some(between(a, b, part))
            }
        }
    }

    /// Shares inside a move at which the value has another slope.
    pub fn breaks(&self, move_index: usize) -> impl Iterator<Item = f64> + '_ {
        let shares = self.of(move_index).iter().map(|(at, _)| *at);
        shares.filter(|at| *at > 0.0 && *at < 1.0)
    }
}

/// Linear interpolation between two values.
pub(crate) fn between<const N: usize>(from: &[f64; N], to: &[f64; N], part: f64) -> [f64; N] {
    std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
}

/// The vertices that are needed (Ramer, Douglas and Peucker): of the others, what lies between the needed ones differs by less
/// than what counts. `size` of a difference is 1 where it begins to count.
pub(crate) fn reduced<const N: usize>(
    vertices: &[(f64, [f64; N])],
    size: impl Fn(&[f64; N]) -> f64,
) -> Vec<(f64, [f64; N])> {
    let Some(first) = vertices.first() else {
        return Vec::new();
    };
    let mut needed = vec![*first];
    // Spans that are still to be looked at, the first on top.
    let mut open = vec![(0, vertices.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (&vertices[from], &vertices[to]);
        let mut worst = (1.0, 0);
        for i in from + 1..to {
            let (at, value) = &vertices[i];
            let part = match b.0 > a.0 {
                true => (at - a.0) / (b.0 - a.0),
                false => 0.0,
            };
            let line = between(&a.1, &b.1, part);
            let off = size(&std::array::from_fn(|k| value[k] - line[k]));
            if off > worst.0 {
                worst = (off, i);
            }
        }
        match worst.1 {
            0 if to > from => needed.push(*b),
            0 => {}
            middle => open.extend([(middle, to), (from, middle)]),
        }
    }
    needed
}
