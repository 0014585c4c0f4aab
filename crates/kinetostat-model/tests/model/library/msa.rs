//! Matrix structural analysis, as an oracle: one dense system over all bodies of a machine.
//!
//! Every body is a node of six motions, every beam a 12 x 12 element, every joint leaves its own
//! directions to two nodes and ties the others by rows of constraints. Tied motions are eliminated
//! by pivots, free ones that the tool does not need condensed. No Jacobian of a chain, no product of
//! screws and no bordered system of the crate under test is used.

use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Rotation3, Vector3};

/// A linear function of the nodes' motions.
type Row = Vec<(usize, f64)>;

/// The base; it does not move.
pub const BASE: usize = 0;

/// Nodes, elements and constraints.
pub struct Structure {
    /// Reference point of every node, base axes, m; the base first.
    points: Vec<Vector3<f64>>,
    elements: Vec<(Vec<Row>, DMatrix<f64>)>,
    constraints: Vec<Row>,
}

/// What is left at the tool.
pub struct Condensed {
    /// Motions that it can make, 6 x r, orthonormal with rotations times `length`.
    pub reach: DMatrix<f64>,
    /// Stiffness in them, r x r, N/m.
    pub stiffness: DMatrix<f64>,
    /// m per rad.
    pub length: f64,
    /// Largest stiffness before anything gave way, N/m: what rounding is measured by.
    pub stiffest: f64,
}

/// A pivot below this share of the largest is no pivot.
const PIVOT: f64 = 1e-9;
/// A motion with less than this share of its own stiffness left by the others is free.
const FREE: f64 = 1e-11;

impl Structure {
    pub fn new() -> Self {
        Self {
            points: vec![Vector3::zeros()],
            elements: Vec::new(),
            constraints: Vec::new(),
        }
    }

    pub fn node(&mut self, point: Vector3<f64>) -> usize {
        self.points.push(point);
        self.points.len() - 1
    }

    /// Number of unknown motions.
    pub fn unknowns(&self) -> usize {
        6 * (self.points.len() - 1)
    }

    /// Motion of the point `at` of a node along `axis`.
    fn shift(&self, node: usize, at: &Vector3<f64>, axis: &Vector3<f64>) -> Row {
        if node == BASE {
            return Vec::new();
        }
        let lever = (at - self.points[node]).cross(axis);
        let parts = axis.iter().chain(lever.iter());
        parts
            .enumerate()
            .map(|(i, x)| (6 * (node - 1) + i, *x))
            .collect()
    }

    /// Rotation of a node about `axis`.
    fn turn(&self, node: usize, axis: &Vector3<f64>) -> Row {
        if node == BASE {
            return Vec::new();
        }
        let parts = axis.iter().enumerate();
        parts.map(|(i, x)| (6 * (node - 1) + 3 + i, *x)).collect()
    }

    /// Motion of `to` against `from` at a point.
    pub fn slide(&self, from: usize, to: usize, at: &Vector3<f64>, axis: &Vector3<f64>) -> Row {
        minus(&self.shift(to, at, axis), &self.shift(from, at, axis))
    }

    /// Rotation of `to` against `from`.
    pub fn twist(&self, from: usize, to: usize, axis: &Vector3<f64>) -> Row {
        minus(&self.turn(to, axis), &self.turn(from, axis))
    }

    /// Ties `to` to `from` at a point but for slides along and turns about the free axes.
    pub fn joint(
        &mut self,
        from: usize,
        to: usize,
        at: &Vector3<f64>,
        slides: &[Vector3<f64>],
        turns: &[Vector3<f64>],
    ) {
        for axis in across(slides) {
            let row = self.slide(from, to, at, &axis);
            self.constraints.push(row);
        }
        for axis in across(turns) {
            let row = self.twist(from, to, &axis);
            self.constraints.push(row);
        }
    }

    /// `row` is `ratio` times `other`.
    pub fn follow(&mut self, row: &Row, ratio: f64, other: &Row) {
        let scaled: Row = other.iter().map(|(i, x)| (*i, ratio * x)).collect();
        self.constraints.push(minus(row, &scaled));
    }

    /// A spring (N/m or N m/rad) on one function of the motions.
    pub fn spring(&mut self, row: Row, stiffness: f64) {
        let k = DMatrix::from_element(1, 1, stiffness);
        self.elements.push((vec![row], k));
    }

    /// A spring of six directions between two nodes at one point.
    pub fn spring6(
        &mut self,
        ends: [usize; 2],
        at: &Vector3<f64>,
        axes: &Rotation3<f64>,
        stiffness: &Matrix6<f64>,
    ) {
        let axes = axes.matrix();
        let slides = (0..3).map(|i| self.slide(ends[0], ends[1], at, &axes.column(i).into_owned()));
        let turns = (0..3).map(|i| self.twist(ends[0], ends[1], &axes.column(i).into_owned()));
        let rows = slides.chain(turns).collect();
        let k = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)]);
        self.elements.push((rows, k));
    }

    /// A beam element, 12 x 12, between points of two nodes.
    pub fn beam(
        &mut self,
        ends: [usize; 2],
        at: [Vector3<f64>; 2],
        axes: &Rotation3<f64>,
        k: DMatrix<f64>,
    ) {
        let axes = axes.matrix();
        let mut rows = Vec::with_capacity(12);
        for (node, point) in ends.into_iter().zip(&at) {
            for i in 0..3 {
                rows.push(self.shift(node, point, &axes.column(i).into_owned()));
            }
            for i in 0..3 {
                rows.push(self.turn(node, &axes.column(i).into_owned()));
            }
        }
        self.elements.push((rows, k));
    }

    /// Everything but the tool eliminated.
    pub fn condense(&self, tool: usize) -> Condensed {
        let n = self.unknowns();
        let length = self.length();
        let unit = |i: usize| if i % 6 < 3 { 1.0 } else { 1.0 / length };
        let own = 6 * (tool - 1)..6 * tool;

        // What is tied: x[pivot] = -sum of the others in its row.
        let mut rows = DMatrix::zeros(self.constraints.len(), n);
        for (i, row) in self.constraints.iter().enumerate() {
            for (j, x) in row {
                rows[(i, *j)] += x * unit(*j);
            }
            let size = rows.row(i).norm();
            if size > 0.0 {
                rows.row_mut(i).unscale_mut(size);
            }
        }
        let inner: Vec<usize> = (0..n).filter(|i| !own.contains(i)).collect();
        let pivots = eliminate(&mut rows, &inner);
        let rest: Vec<usize> = (0..rows.nrows())
            .filter(|i| !pivots.iter().any(|(r, _)| r == i))
            .collect();
        let tied = rows.columns(own.start, 6).select_rows(&rest);
        let reach = null_space(&tied);
        let free: Vec<usize> = inner
            .iter()
            .copied()
            .filter(|i| !pivots.iter().any(|(_, c)| c == i))
            .collect();

        // All motions by the free ones and the tool's.
        let (k, r) = (free.len(), reach.ncols());
        let mut all = DMatrix::zeros(n, k + r);
        for (j, i) in free.iter().enumerate() {
            all[(*i, j)] = 1.0;
        }
        all.view_mut((own.start, k), (6, r)).copy_from(&reach);
        for (row, column) in &pivots {
            let follows = rows.columns(own.start, 6).row(*row) * &reach;
            for (j, i) in free.iter().enumerate() {
                all[(*column, j)] = -rows[(*row, *i)];
            }
            for j in 0..r {
                all[(*column, k + j)] = -follows[j];
            }
        }

        let mut stiffness = DMatrix::zeros(n, n);
        for (rows, k) in &self.elements {
            for (a, one) in rows.iter().enumerate() {
                for (b, other) in rows.iter().enumerate() {
                    for (i, x) in one {
                        for (j, y) in other {
                            stiffness[(*i, *j)] += x * unit(*i) * k[(a, b)] * y * unit(*j);
                        }
                    }
                }
            }
        }
        let reduced = all.transpose() * stiffness * &all;
        Condensed {
            reach,
            stiffest: reduced.diagonal().largest_entry(),
            stiffness: schur(reduced, k),
            length,
        }
    }

    /// A typical distance of nodes, m.
    fn length(&self) -> f64 {
        let count = self.points.len() as f64;
        let middle = self.points.iter().sum::<Vector3<f64>>() / count;
        let mean = self.points.iter().map(|p| (p - middle).norm()).sum::<f64>() / count;
        if mean > 0.0 { mean } else { 1.0 }
    }
}

fn minus(one: &Row, other: &Row) -> Row {
    let other = other.iter().map(|(i, x)| (*i, -x));
    one.iter().copied().chain(other).collect()
}

/// Orthonormal directions square to all of `axes`.
fn across(axes: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    match axes {
        [] => Matrix3::identity()
            .column_iter()
            .map(|c| c.into_owned())
            .collect(),
        [axis] => {
            let helper = Vector3::ith(axis.iamin(), 1.0);
            let one = axis.cross(&helper).normalize();
            vec![one, axis.cross(&one).normalize()]
        }
        [one, other] => vec![one.cross(other).normalize()],
        _ => Vec::new(),
    }
}

/// Gauss-Jordan elimination with complete pivoting among `columns`: the pivots' rows and columns.
fn eliminate(rows: &mut DMatrix<f64>, columns: &[usize]) -> Vec<(usize, usize)> {
    let mut left: Vec<usize> = (0..rows.nrows()).collect();
    let mut open: Vec<usize> = columns.to_vec();
    let mut pivots = Vec::new();
    loop {
        let mut best = (0.0, 0, 0);
        for (c, column) in open.iter().enumerate() {
            for (r, row) in left.iter().enumerate() {
                let x = rows[(*row, *column)].abs();
                if x > best.0 {
                    best = (x, r, c);
                }
            }
        }
        if best.0 <= PIVOT {
            return pivots;
        }
        let (row, column) = (left.swap_remove(best.1), open.swap_remove(best.2));
        let pivot = rows.row(row) / rows[(row, column)];
        rows.set_row(row, &pivot);
        for i in (0..rows.nrows()).filter(|i| *i != row) {
            let x = rows[(i, column)];
            if x != 0.0 {
                for j in 0..rows.ncols() {
                    let p = pivot[j];
                    if p != 0.0 {
                        rows[(i, j)] -= x * p;
                    }
                }
            }
            rows[(i, column)] = 0.0;
        }
        pivots.push((row, column));
    }
}

/// Orthonormal motions that six columns of constraints leave.
fn null_space(tied: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = (tied.transpose() * tied).symmetric_eigen();
    let kept: Vec<DVector<f64>> = (0..6)
        .filter(|i| eigen.eigenvalues[*i] <= PIVOT)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    match kept.is_empty() {
        true => DMatrix::zeros(6, 0),
        false => DMatrix::from_columns(&kept),
    }
}

/// The first `count` unknowns of a positive semi-definite matrix condensed, the stiffest first.
fn schur(mut k: DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let n = k.nrows();
    let own: Vec<f64> = (0..n).map(|i| k[(i, i)].abs()).collect();
    let mut left: Vec<usize> = (0..count).collect();
    loop {
        let share = |i: usize| k[(i, i)] / own[i].max(f64::MIN_POSITIVE);
        let best = (0..left.len()).max_by(|a, b| share(left[*a]).total_cmp(&share(left[*b])));
        let Some(best) = best.filter(|b| share(left[*b]) > FREE) else {
            return k.view((count, count), (n - count, n - count)).into_owned();
        };
        let i = left.swap_remove(best);
        let pivot = k.row(i) / k[(i, i)];
        for a in left.iter().copied().chain(count..n) {
            let x = k[(a, i)];
            for b in left.iter().copied().chain(count..n) {
                k[(a, b)] -= x * pivot[b];
            }
        }
    }
}
