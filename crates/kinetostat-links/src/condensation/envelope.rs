//! A direct solver for symmetric positive definite sparse matrices: envelope Cholesky after reverse
//! Cuthill-McKee ordering [A. George, J. W. Liu, Computer Solution of Large Sparse Positive Definite
//! Systems, 1981]. Enough for the meshes of links, and it tells which row is not held.

/// Largest number of entries in the envelope (256 MB).
pub const MOST_ENVELOPE: usize = 32 << 20;

/// Share of a diagonal entry below which what elimination leaves of it counts as nothing.
const PIVOT: f64 = 1e-12;

/// Reason for which there is no factor.
#[derive(Clone, Debug, PartialEq)]
pub enum NoFactor {
    /// The envelope has this many entries.
    TooLarge(usize),
    /// The pivot of this row is zero or negative: share of the original entry.
    NotHeld(usize, f64),
}

/// `A = L L^T` in its own order.
pub struct Factor {
    /// New row of each old one.
    place: Vec<usize>,
    first: Vec<usize>,
    start: Vec<usize>,
    values: Vec<f64>,
    /// Smallest share that elimination left of a diagonal entry.
    pub(crate) least_pivot: f64,
}

/// Neighbours of each row.
struct Graph {
    start: Vec<usize>,
    list: Vec<u32>,
}

impl Graph {
    fn new(n: usize, entries: &[(u32, u32, f64)]) -> Self {
        let mut start = vec![0; n + 1];
        let off = || entries.iter().filter(|e| e.0 != e.1);
        for e in off() {
            start[e.0 as usize + 1] += 1;
            start[e.1 as usize + 1] += 1;
        }
        for i in 0..n {
            start[i + 1] += start[i];
        }
        let mut next = start.clone();
        let mut list = vec![0; start[n]];
        for e in off() {
            for (a, b) in [(e.0, e.1), (e.1, e.0)] {
                list[next[a as usize]] = b;
                next[a as usize] += 1;
            }
        }
        Self { start, list }
    }

    fn of(&self, i: usize) -> &[u32] {
        &self.list[self.start[i]..self.start[i + 1]]
    }

    /// Breadth first from `root`: the rows met, and the last of smallest degree in the last level.
    fn breadth_first(
        &self,
        root: usize,
        seen: &mut [u32],
        mark: u32,
    ) -> (Vec<usize>, usize, usize) {
        let mut order = vec![root];
        seen[root] = mark;
        let (mut level, mut depth) = (0, 0);
        loop {
            let end = order.len();
            for at in level..end {
                let mut near: Vec<usize> = Vec::new();
                for &j in self.of(order[at]) {
                    let j = j as usize;
                    if seen[j] != mark {
                        seen[j] = mark;
                        near.push(j);
                    }
                }
                near.sort_unstable_by_key(|&j| (self.of(j).len(), j));
                order.extend(near);
            }
            if order.len() == end {
                let far = order[level..end]
                    .iter()
                    .copied()
                    .min_by_key(|&j| self.of(j).len());
                return (order, far.unwrap_or(root), depth);
            }
            level = end;
            depth += 1;
        }
    }
}

fn reverse_cuthill_mckee(n: usize, graph: &Graph) -> Vec<usize> {
    let mut done = vec![false; n];
    let mut seen = vec![0; n];
    let mut mark = 0;
    let mut order = Vec::with_capacity(n);
    for start in 0..n {
        if done[start] {
            continue;
        }
        let mut root = start;
        let mut deepest = None;
        loop {
            mark += 1;
            let (found, far, depth) = graph.breadth_first(root, &mut seen, mark);
            if deepest.is_some_and(|d| depth <= d) {
                for &i in &found {
                    done[i] = true;
                }
                order.extend(found);
                break;
            }
            deepest = Some(depth);
            root = far;
        }
    }
    order.reverse();
    order
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Factor {
    /// `entries`: lower half, each pair once; `n` rows.
    pub fn new(n: usize, entries: &[(u32, u32, f64)]) -> Result<Self, NoFactor> {
        let order = reverse_cuthill_mckee(n, &Graph::new(n, entries));
        let mut place = vec![0; n];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let mut first: Vec<usize> = (0..n).collect();
        for e in entries {
            let (a, b) = (place[e.0 as usize], place[e.1 as usize]);
            let (i, j) = (a.max(b), a.min(b));
            first[i] = first[i].min(j);
        }
        let mut start = vec![0; n + 1];
        for i in 0..n {
            start[i + 1] = start[i] + (i - first[i] + 1);
        }
        if start[n] > MOST_ENVELOPE {
            return Err(NoFactor::TooLarge(start[n]));
        }
        let mut values = vec![0.0; start[n]];
        for e in entries {
            let (a, b) = (place[e.0 as usize], place[e.1 as usize]);
            let (i, j) = (a.max(b), a.min(b));
            values[start[i] + j - first[i]] += e.2;
        }
        let mut least_pivot = f64::INFINITY;
        for i in 0..n {
            let own = start[i + 1] - 1;
            let whole = values[own];
            for j in first[i]..i {
                let from = first[i].max(first[j]);
                let (head, tail) = values.split_at(start[i]);
                let row_j = &head[start[j] + from - first[j]..start[j] + j - first[j]];
                let row_i = &tail[from - first[i]..j - first[i]];
                let left = tail[j - first[i]] - dot(row_i, row_j);
                let pivot = head[start[j + 1] - 1];
                values[start[i] + j - first[i]] = left / pivot;
            }
            let row = &values[start[i]..own];
            let left = whole - dot(row, row);
            let share = if whole > 0.0 { left / whole } else { 0.0 };
            if share.is_nan() || share <= PIVOT {
                return Err(NoFactor::NotHeld(order[i], share));
            }
            least_pivot = least_pivot.min(share);
            values[own] = left.sqrt();
        }
        Ok(Self {
            place,
            first,
            start,
            values,
            least_pivot,
        })
    }

    /// `A^-1 b`.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.place.len();
        let mut x = vec![0.0; n];
        for (old, &new) in self.place.iter().enumerate() {
            x[new] = b[old];
        }
        for i in 0..n {
            let own = self.start[i + 1] - 1;
            let row = &self.values[self.start[i]..own];
            x[i] = (x[i] - dot(row, &x[self.first[i]..i])) / self.values[own];
        }
        for i in (0..n).rev() {
            let own = self.start[i + 1] - 1;
            x[i] /= self.values[own];
            let known = x[i];
            for (at, j) in (self.first[i]..i).enumerate() {
                x[j] -= self.values[self.start[i] + at] * known;
            }
        }
        self.place.iter().map(|&new| x[new]).collect()
    }
}
