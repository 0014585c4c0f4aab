//! Singular values by one-sided Jacobi rotations: what every rank, range and least-norm solution of
//! the workspace rests on.
//!
//! nalgebra 0.35's own (`Matrix::svd` and what is built on it) is not used: it gives wrong vectors
//! where singular values are equal or nearly so, with recomposition errors up to 0.3 (its issue
//! 1172), and such values are the rule in machines with equal legs. `clippy.toml` forbids it.
//!
//! A large matrix is first brought to a triangle by Householder reflections with column pivoting
//! (Businger and Golub 1965), then the rows of the triangle are rotated pair by pair until all are
//! square to each other (Hestenes 1958). That order is the preconditioning of Drmac and Veselic (New
//! fast and accurate Jacobi SVD algorithm, SIAM J. Matrix Anal. Appl. 29, 2008). Every step is
//! orthogonal and is repeated until nothing is left to do, so clusters cannot spoil it.

use nalgebra::{DMatrix, DVector, Dim, Matrix, RawStorage};

use crate::linalg::complement::complement;
use crate::number::{larger, largest_size};

/// Matrices of at most so many columns are rotated as they are: what is exactly zero stays so, and
/// small values of graded matrices are right relative to themselves.
const DIRECT: usize = 16;

/// Sweeps over all pairs; ten are plenty (convergence is quadratic), more mean that rounding turns in
/// circles, and then the values are as good as they get.
const SWEEPS: usize = 40;

/// `A = left diag(values) right^T`, the short form: `k = min(rows, columns)` values.
///
/// Values are right to a few units of rounding of the largest one, vectors are orthonormal to
/// rounding whatever the values are. A matrix with a number that is not finite has values of NaN.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SingularValues {
    /// Falling, in the unit of the matrix.
    pub values: Vec<f64>,
    /// Orthonormal columns, rows x k.
    pub left: DMatrix<f64>,
    /// Orthonormal columns, columns x k.
    pub right: DMatrix<f64>,
}

impl SingularValues {
    /// Decomposes a matrix of any shape.
    #[must_use]
    pub fn of<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(a: &Matrix<f64, R, C, S>) -> Self {
        let (m, n) = a.shape();
        Self::of_owned(DMatrix::from_iterator(m, n, a.iter().copied()))
    }

    fn of_owned(a: DMatrix<f64>) -> Self {
        let (m, n) = a.shape();
        let k = m.min(n);
        let most = largest_size(a.iter());
        if !most.is_finite() {
            return Self {
                values: vec![f64::NAN; k],
                left: DMatrix::from_element(m, k, f64::NAN),
                right: DMatrix::from_element(n, k, f64::NAN),
            };
        }
        if k == 0 || most == 0.0 {
            return Self {
                values: vec![0.0; k],
                left: DMatrix::identity(m, k),
                right: DMatrix::identity(n, k),
            };
        }
        if m < n {
            let turned = Self::of_owned(a.transpose());
            return Self {
                values: turned.values,
                left: turned.right,
                right: turned.left,
            };
        }
        // Numbers of size one: no square overflows or vanishes.
        let unit = 2.0_f64.powi(most.log2().floor().clamp(-1000.0, 1000.0) as i32);
        let mut a = a.unscale(unit);
        if n <= DIRECT {
            let mut right = DMatrix::identity(n, n);
            let values = rotate(&mut a, &mut right);
            let left = directions(&a, &values);
            return Self {
                values: values.iter().map(|v| v * unit).collect(),
                left,
                right,
            };
        }
        let triangle = Triangle::of(a);
        let rank = triangle.rank;
        // Rows of the triangle as columns, n x rank, in the original order of the columns of A.
        let mut rows = DMatrix::zeros(n, rank);
        for j in 0..n {
            for i in 0..rank.min(j + 1) {
                rows[(triangle.order[j], i)] = triangle.a[(i, j)];
            }
        }
        let mut turns = DMatrix::identity(rank, rank);
        let mut values = rotate(&mut rows, &mut turns);
        let known = directions(&rows, &values);
        let mut left = DMatrix::zeros(m, k);
        let mut right = DMatrix::zeros(n, k);
        left.view_mut((0, 0), (rank, rank)).copy_from(&turns);
        right.columns_mut(0, rank).copy_from(&known);
        for j in rank..k {
            left[(j, j)] = 1.0;
        }
        triangle.reflect(&mut left);
        fill_up(&mut right, rank);
        values.resize(k, 0.0);
        Self {
            values: values.iter().map(|v| v * unit).collect(),
            left,
            right,
        }
    }

    /// Number of values above `share` of the largest (and above the smallest normal number).
    #[must_use]
    pub fn rank(&self, share: f64) -> usize {
        let most = self.values.first().copied().unwrap_or(0.0);
        let cut = (share * most).max(f64::MIN_POSITIVE);
        self.values.iter().filter(|v| **v > cut).count()
    }

    /// The largest value; zero of an empty matrix.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.values.first().copied().unwrap_or(0.0)
    }

    /// The smallest of the `min(rows, columns)` values; zero of an empty matrix.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.values.last().copied().unwrap_or(0.0)
    }

    /// Orthonormal basis of the span of the columns, rows x rank.
    #[must_use]
    pub fn range(&self, share: f64) -> DMatrix<f64> {
        self.left.columns(0, self.rank(share)).into_owned()
    }

    /// All right vectors, columns x columns: those of the values, then what the matrix takes to zero
    /// because it has fewer rows than columns.
    #[must_use]
    pub fn all_right(&self) -> DMatrix<f64> {
        completed(&self.right)
    }

    /// All left vectors, rows x rows.
    #[must_use]
    pub fn all_left(&self) -> DMatrix<f64> {
        completed(&self.left)
    }

    /// Orthonormal basis of what the matrix takes to zero, columns x (columns - rank).
    #[must_use]
    pub fn null_space(&self, share: f64) -> DMatrix<f64> {
        let rank = self.rank(share);
        let all = self.all_right();
        all.columns(rank, all.ncols() - rank).into_owned()
    }

    /// Moore-Penrose inverse over the values above `share` of the largest.
    #[must_use]
    pub fn pseudo_inverse(&self, share: f64) -> DMatrix<f64> {
        let rank = self.rank(share);
        let mut right = self.right.columns(0, rank).into_owned();
        for (mut column, value) in right.column_iter_mut().zip(&self.values) {
            column.unscale_mut(*value);
        }
        right * self.left.columns(0, rank).transpose()
    }

    /// Shortest `x` with the least `|A x - b|`, over the values above `cut` (in the unit of the
    /// matrix, not a share).
    #[must_use]
    pub fn shortest(&self, b: &DVector<f64>, cut: f64) -> DVector<f64> {
        let mut x = DVector::zeros(self.right.nrows());
        for (k, &value) in self.values.iter().enumerate() {
            if value > cut.max(f64::MIN_POSITIVE) {
                x.axpy(
                    self.left.column(k).dot(b) / value,
                    &self.right.column(k),
                    1.0,
                );
            }
        }
        x
    }
}

/// Orthonormal basis of the span of the columns, rows x rank, by the values above `share` of the
/// largest; no columns if a number is not finite.
pub(crate) fn range(a: &DMatrix<f64>, share: f64) -> DMatrix<f64> {
    if a.ncols() > LARGE
        && let Some(range) = certain_range(a, share)
    {
        return range;
    }
    SingularValues::of(a).range(share)
}

/// Matrices of more columns are first tested for certainty.
const LARGE: usize = 60;

/// Shortest `x` with the least `|A x - b|`, and an orthonormal basis of what `A` takes to zero, columns x
/// (columns - rank), by the values above `share` of the largest; none if a number is not finite.
///
/// A complete orthogonal decomposition `A = P R^T Q^T` where the triangle leaves no doubt about the rank,
/// singular values elsewhere: they cost ten times as much.
pub fn shortest_and_free(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    share: f64,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let n = a.ncols();
    if n == 0 {
        return Some((DVector::zeros(0), DMatrix::zeros(0, 0)));
    }
    if a.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let Some((triangle, rank)) = certain_triangle(a.transpose(), share) else {
        let own = SingularValues::of(a);
        let shortest = own.shortest(b, share * own.largest());
        return Some((shortest, own.null_space(share)));
    };
    // Rows of A in the order of the triangle: R^T y = b with rank columns, then x = Q y.
    let ordered = DVector::from_fn(a.nrows(), |i, _| b[triangle.order[i]]);
    let mut shares = triangle.a.rows(0, rank).transpose();
    for i in 0..rank {
        shares.view_mut((0, i), (i, 1)).fill(0.0);
    }
    let decomposed = shares.qr();
    let mut y = decomposed.q().transpose() * ordered;
    if !decomposed.r().solve_upper_triangular_mut(&mut y) {
        return None;
    }
    let mut both = DMatrix::zeros(n, 1 + n - rank);
    both.view_mut((0, 0), (rank, 1)).copy_from(&y);
    both.view_mut((rank, 1), (n - rank, n - rank))
        .fill_with_identity();
    triangle.reflect(&mut both);
    let free = both.columns(1, n - rank).into_owned();
    Some((both.column(0).into_owned(), free))
}

/// The range where the triangle leaves no doubt about the rank.
fn certain_range(a: &DMatrix<f64>, share: f64) -> Option<DMatrix<f64>> {
    let (triangle, rank) = certain_triangle(a.clone(), share)?;
    let mut basis = DMatrix::identity(a.nrows(), rank);
    triangle.reflect(&mut basis);
    Some(basis)
}

/// The triangle and the rank, where it leaves no doubt about that: what is left beside it is far below
/// `share` (and bounds all further singular values from above), and the inverse of its regular part
/// bounds the others from below.
fn certain_triangle(a: DMatrix<f64>, share: f64) -> Option<(Triangle, usize)> {
    let n = a.ncols();
    let most = largest_size(a.iter());
    if !(1e-100..1e100).contains(&most) {
        return None;
    }
    let triangle = Triangle::of(a);
    let first = triangle.a[(0, 0)].abs();
    let regular = |i: &usize| triangle.a[(*i, *i)].abs() > share * first;
    let rank = (0..triangle.rank).take_while(regular).count();
    let mut left = 0.0_f64;
    for j in rank..n {
        let rows = rank..triangle.rank.min(j + 1).max(rank);
        left += rows.map(|i| triangle.a[(i, j)].powi(2)).sum::<f64>();
    }
    let square = triangle.a.view((0, 0), (rank, rank)).upper_triangle();
    let mut inverse = DMatrix::identity(rank, rank);
    if !square.solve_upper_triangular_mut(&mut inverse) {
        return None;
    }
    let below = first * (n as f64).sqrt();
    if left.sqrt() > 0.01 * share * first || inverse.norm() * 10.0 * share * below > 1.0 {
        return None;
    }
    Some((triangle, rank))
}

/// Unit columns; beside a size that is rounding a column has no direction, and gets one that is
/// square to all others.
fn directions(columns: &DMatrix<f64>, sizes: &[f64]) -> DMatrix<f64> {
    let mut units = columns.clone();
    let most = sizes.first().copied().unwrap_or(0.0);
    let cut = zero(columns.nrows()) * most;
    let sure = sizes.iter().take_while(|s| **s > cut).count();
    for (mut column, size) in units.column_iter_mut().zip(sizes).take(sure) {
        column.unscale_mut(*size);
    }
    fill_up(&mut units, sure);
    units
}

/// Share of the largest below which a column is rounding.
fn zero(n: usize) -> f64 {
    f64::EPSILON * (n as f64).sqrt()
}

/// Householder triangle with column pivoting: `A P = Q R`.
struct Triangle {
    /// `R` above the diagonal, the reflections below it.
    a: DMatrix<f64>,
    /// First entries and sizes of the reflections.
    heads: Vec<(f64, f64)>,
    /// Column of A at each place of R.
    order: Vec<usize>,
    /// Rows of R that are more than rounding.
    rank: usize,
}

impl Triangle {
    fn of(mut a: DMatrix<f64>) -> Self {
        let (m, n) = a.shape();
        let mut order: Vec<usize> = (0..n).collect();
        let mut heads = Vec::with_capacity(n);
        let mut first = 0.0;
        for k in 0..m.min(n) {
            let rest = |j: usize| a.view((k, j), (m - k, 1)).norm_squared();
            let (mut best, mut size) = (k, rest(k));
            for j in k + 1..n {
                let other = rest(j);
                if other > size {
                    (best, size) = (j, other);
                }
            }
            let size = size.sqrt();
            if k == 0 {
                first = size;
            }
            // Smaller remainders change no value by more than rounding.
            if size <= f64::EPSILON * first {
                break;
            }
            a.swap_columns(k, best);
            order.swap(k, best);
            let diagonal = if a[(k, k)] > 0.0 { -size } else { size };
            // v = (head, rest of the column), I - v v^T / half with half = |v|^2 / 2.
            let head = a[(k, k)] - diagonal;
            let half = size * (size + a[(k, k)].abs());
            let (own, mut others) = a.columns_range_pair_mut(k, k + 1..n);
            let tail = own.rows(k + 1, m - k - 1);
            for mut column in others.column_iter_mut() {
                let share = (head * column[k] + tail.dot(&column.rows(k + 1, m - k - 1))) / half;
                column[k] -= share * head;
                column.rows_mut(k + 1, m - k - 1).axpy(-share, &tail, 1.0);
            }
            a[(k, k)] = diagonal;
            heads.push((head, half));
        }
        Self {
            rank: heads.len(),
            a,
            heads,
            order,
        }
    }

    /// `b` becomes `Q b`.
    fn reflect(&self, b: &mut DMatrix<f64>) {
        let m = self.a.nrows();
        for (k, &(head, half)) in self.heads.iter().enumerate().rev() {
            let own = self.a.column(k);
            let tail = own.rows(k + 1, m - k - 1);
            for mut column in b.column_iter_mut() {
                let share = (head * column[k] + tail.dot(&column.rows(k + 1, m - k - 1))) / half;
                column[k] -= share * head;
                column.rows_mut(k + 1, m - k - 1).axpy(-share, &tail, 1.0);
            }
        }
    }
}

/// Rotates pairs of columns until all are square to each other, and `turns` with them; then sorts
/// both by falling size. The sizes.
fn rotate(columns: &mut DMatrix<f64>, turns: &mut DMatrix<f64>) -> Vec<f64> {
    let (n, k) = columns.shape();
    let mut squares: Vec<f64> = Vec::with_capacity(k);
    for _ in 0..SWEEPS {
        squares.clear();
        squares.extend(columns.column_iter().map(|c| c.norm_squared()));
        let most = squares.iter().fold(0.0_f64, |m, x| larger(m, *x));
        let nothing = most * zero(n).powi(2);
        let mut turned = false;
        for i in 0..k {
            for j in i + 1..k {
                let (p, q) = (squares[i], squares[j]);
                if p.min(q) <= nothing {
                    continue;
                }
                let (mut a, mut b) = pair(columns, i, j);
                let dot = dot(a, b);
                if dot.abs() <= 0.5 * f64::EPSILON * (n as f64).sqrt().max(2.0) * (p * q).sqrt() {
                    continue;
                }
                turned = true;
                let slope = (q - p) / (2.0 * dot);
                // Squares that overflow belong to rotations by nothing.
                let tangent = slope.signum() / (slope.abs() + (slope * slope + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = cosine * tangent;
                turn(a, b, cosine, sine);
                squares[i] = (p - tangent * dot).max(0.0);
                squares[j] = q + tangent * dot;
                (a, b) = pair(turns, i, j);
                turn(a, b, cosine, sine);
            }
        }
        if !turned {
            break;
        }
    }
    let sizes: Vec<f64> = columns.column_iter().map(|c| c.norm()).collect();
    let mut order: Vec<usize> = (0..k).collect();
    order.sort_by(|&i, &j| sizes[j].total_cmp(&sizes[i]));
    *columns = columns.select_columns(&order);
    *turns = turns.select_columns(&order);
    // Removes the accumulated rounding of many rotations, by one step towards the nearest orthonormal matrix.
    let off = turns.transpose() * &*turns - DMatrix::identity(k, k);
    *turns -= &*turns * off * 0.5;
    order.into_iter().map(|i| sizes[i]).collect()
}

/// Two columns, `i < j`.
fn pair(a: &mut DMatrix<f64>, i: usize, j: usize) -> (&mut [f64], &mut [f64]) {
    let n = a.nrows();
    let (before, after) = a.as_mut_slice().split_at_mut(j * n);
    (&mut before[i * n..(i + 1) * n], &mut after[..n])
}

/// Four sums at once: the compiler keeps them in one register.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (left, right) = (a.chunks_exact(4), b.chunks_exact(4));
    let tail: f64 = left
        .remainder()
        .iter()
        .zip(right.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in left.zip(right) {
        for i in 0..4 {
            sums[i] += x[i] * y[i];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}

fn turn(a: &mut [f64], b: &mut [f64], cosine: f64, sine: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        let old = *x;
        *x = cosine * old - sine * *y;
        *y = sine * old + cosine * *y;
    }
}

/// Columns from `from` on become orthonormal and square to those before.
fn fill_up(basis: &mut DMatrix<f64>, from: usize) {
    let (n, k) = basis.shape();
    if from >= k {
        return;
    }
    let rest = complement(&basis.columns(0, from).into_owned());
    debug_assert_eq!(rest.ncols(), n - from);
    for j in from..k {
        basis.set_column(j, &rest.column(j - from));
    }
}

/// Orthonormal columns and what is square to them.
fn completed(basis: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, k) = basis.shape();
    let mut all = DMatrix::zeros(n, n);
    all.columns_mut(0, k).copy_from(basis);
    fill_up(&mut all, k);
    all
}
