//! Compliance of the chain built so far, carried along in the axes and about the origin of the
//! frame reached: [R 3.8] as a recursion. `J K^-1 J^T` needs a column for every spring; the recursion
//! adds a spring's compliance where it sits and moves the sum with the frame, at a cost that grows
//! with the number of motions and stays within 21 numbers.

use pulp::Simd;

use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{
    Mat3, Vec3, cross, product, product_transposed, select, turn_columns,
};

/// Place of entry (i, j) of a symmetric 3 x 3 matrix among its six numbers.
pub(crate) const AT: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// A symmetric 6 x 6 matrix in blocks: `[a, b; b^T, d]`, linear part first.
pub(crate) struct Symmetric<S: Simd> {
    /// Linear-linear, m/N.
    pub a: [Lanes<S>; 6],
    /// Linear-angular, 3 x 3, 1/N.
    pub b: Mat3<S>,
    /// Angular-angular, rad/(N m).
    pub d: [Lanes<S>; 6],
}

impl<S: Simd> Clone for Symmetric<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Symmetric<S> {}

impl<S: Simd> Symmetric<S> {
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        let z = Lanes::new(simd, 0.0);
        Self {
            a: [z; 6],
            b: [z; 9],
            d: [z; 6],
        }
    }

    #[inline(always)]
    pub fn get(&self, i: usize, j: usize) -> Lanes<S> {
        match (i < 3, j < 3) {
            (true, true) => self.a[AT[i][j]],
            (false, false) => self.d[AT[i - 3][j - 3]],
            (true, false) => self.b[3 * i + j - 3],
            (false, true) => self.b[3 * j + i - 3],
        }
    }

    /// Sets entries (i, j) and (j, i).
    #[inline(always)]
    pub fn set(&mut self, i: usize, j: usize, value: Lanes<S>) {
        match (i < 3, j < 3) {
            (true, true) => self.a[AT[i][j]] = value,
            (false, false) => self.d[AT[i - 3][j - 3]] = value,
            (true, false) => self.b[3 * i + j - 3] = value,
            (false, true) => self.b[3 * j + i - 3] = value,
        }
    }

    /// Product with six numbers.
    #[inline(always)]
    pub fn times(&self, x: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
        let mut out = [x[0]; 6];
        for i in 0..6 {
            let mut sum = self.get(i, 0) * x[0];
            for j in 1..6 {
                sum = self.get(i, j).times_plus(x[j], sum);
            }
            out[i] = sum;
        }
        out
    }

    /// Adds a spring's compliance, 6 x 6 in the axes of the frame.
    #[inline(always)]
    pub fn add_constant(&mut self, c: &[f64; 36]) {
        for i in 0..6 {
            for j in i..6 {
                self.set(i, j, self.get(i, j) + c[6 * i + j]);
            }
        }
    }

    /// Adds another matrix.
    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        for i in 0..6 {
            self.a[i] = self.a[i] + other.a[i];
            self.d[i] = self.d[i] + other.d[i];
        }
        for i in 0..9 {
            self.b[i] = self.b[i] + other.b[i];
        }
    }

    /// Becomes another one in the lanes that are `wanted`.
    #[inline(always)]
    pub fn take(&mut self, wanted: Lanes<S>, other: &Self) {
        for k in 0..6 {
            self.a[k] = select(wanted, other.a[k], self.a[k]);
            self.d[k] = select(wanted, other.d[k], self.d[k]);
        }
        for k in 0..9 {
            self.b[k] = select(wanted, other.b[k], self.b[k]);
        }
    }

    /// Linear-linear block times `both`, linear-angular block times `one`.
    #[inline(always)]
    pub fn scaled(mut self, both: f64, one: f64) -> Self {
        for x in &mut self.a {
            *x = *x * both;
        }
        for x in &mut self.b {
            *x = *x * one;
        }
        self
    }

    /// A stiffness that knows forces through one point only (`a`), about another point from which
    /// `arm` leads there.
    #[inline(always)]
    pub fn move_force_line(&mut self, arm: &Vec3<S>) {
        for i in 0..3 {
            let row = [self.a[AT[i][0]], self.a[AT[i][1]], self.a[AT[i][2]]];
            let b = cross(arm, &row);
            self.b[3 * i..3 * i + 3].copy_from_slice(&b);
        }
        for j in 0..3 {
            let d = cross(arm, &[self.b[j], self.b[3 + j], self.b[6 + j]]);
            for i in 0..=j {
                self.d[AT[i][j]] = d[i];
            }
        }
    }

    /// The frame turns about its own axis: components in the turned axes.
    #[inline(always)]
    pub fn turn<const AXIS: usize>(&mut self, s: Lanes<S>, c: Lanes<S>) {
        turn_block::<S, AXIS>(&mut self.a, s, c);
        turn_block::<S, AXIS>(&mut self.d, s, c);
        let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
        for i in 0..3 {
            let (x, y) = (self.b[3 * j + i], self.b[3 * k + i]);
            self.b[3 * j + i] = c.times_plus(x, s * y);
            self.b[3 * k + i] = s.times_from(x, c * y);
        }
        turn_columns::<S, AXIS>(&mut self.b, s, c);
    }

    /// The frame moves by `l` (its own axes): compliance of the new point, `v' = v + w x l`.
    #[inline(always)]
    pub fn shift(&mut self, l: &Vec3<S>) {
        let mut moved = self.b;
        for c in 0..3 {
            let x = cross(&[self.d[AT[0][c]], self.d[AT[1][c]], self.d[AT[2][c]]], l);
            for r in 0..3 {
                moved[3 * r + c] = self.b[3 * r + c] + x[r];
            }
        }
        for r in 0..3 {
            let (b, m) = (&self.b, &moved);
            let before = cross(&[b[3 * r], b[3 * r + 1], b[3 * r + 2]], l);
            let after = cross(&[m[3 * r], m[3 * r + 1], m[3 * r + 2]], l);
            for c in 0..=r {
                self.a[AT[c][r]] = self.a[AT[c][r]] + before[c];
            }
            for c in r..3 {
                self.a[AT[r][c]] = self.a[AT[r][c]] + after[c];
            }
        }
        self.b = moved;
    }

    /// `diag(R, R) M diag(R, R)^T`: from the frame's axes to base axes.
    #[inline(always)]
    pub fn in_base_axes(&self, r: &Mat3<S>) -> Self {
        Self {
            a: rotated_symmetric(r, &self.a),
            b: rotated(r, &self.b),
            d: rotated_symmetric(r, &self.d),
        }
    }

    /// Inverse of a positive definite matrix, and its smallest pivot relative to the diagonal entry
    /// it comes from: near zero where the matrix is singular.
    #[inline(always)]
    pub fn inverse(&self, simd: S) -> (Self, Lanes<S>) {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let (mut l, mut v, mut reciprocal) = ([[zero; 6]; 6], [[zero; 6]; 6], [zero; 6]);
        let mut least = one;
        for j in 0..6 {
            let own = self.get(j, j);
            let mut pivot = own;
            for k in 0..j {
                pivot = l[j][k].times_from(l[j][k], pivot);
            }
            least = least.least_of(pivot / own.abs());
            let r = one / pivot.sqrt();
            reciprocal[j] = r;
            for i in j + 1..6 {
                let mut x = self.get(i, j);
                for k in 0..j {
                    x = l[i][k].times_from(l[j][k], x);
                }
                l[i][j] = x * r;
            }
        }
        for j in 0..6 {
            v[j][j] = reciprocal[j];
            for i in j + 1..6 {
                let mut x = l[i][j] * v[j][j];
                for k in j + 1..i {
                    x = l[i][k].times_plus(v[k][j], x);
                }
                v[i][j] = -(x * reciprocal[i]);
            }
        }
        let mut out = Self::zero(simd);
        for i in 0..6 {
            for j in i..6 {
                let mut x = v[j][i] * v[j][j];
                for k in j + 1..6 {
                    x = v[k][i].times_plus(v[k][j], x);
                }
                out.set(i, j, x);
            }
        }
        (out, least)
    }
}

/// Components of a symmetric tensor in axes turned about one of them.
#[inline(always)]
fn turn_block<S: Simd, const AXIS: usize>(m: &mut [Lanes<S>; 6], s: Lanes<S>, c: Lanes<S>) {
    let (i, j, k) = (AXIS, (AXIS + 1) % 3, (AXIS + 2) % 3);
    let (ij, ik) = (m[AT[i][j]], m[AT[i][k]]);
    m[AT[i][j]] = c.times_plus(ij, s * ik);
    m[AT[i][k]] = s.times_from(ij, c * ik);
    let (jj, jk, kk) = (m[AT[j][j]], m[AT[j][k]], m[AT[k][k]]);
    let (u, v) = (c.times_plus(jj, s * jk), c.times_plus(jk, s * kk));
    let (w, x) = (s.times_from(jk, c * kk), s.times_from(jj, c * jk));
    m[AT[j][j]] = c.times_plus(u, s * v);
    m[AT[j][k]] = s.times_from(u, c * v);
    m[AT[k][k]] = s.times_from(x, c * w);
}

/// Entry (i, j) of `M R^T`.
#[inline(always)]
fn right<S: Simd>(m: &Mat3<S>, r: &Mat3<S>, i: usize, j: usize) -> Lanes<S> {
    m[3 * i].times_plus(
        r[3 * j],
        m[3 * i + 1].times_plus(r[3 * j + 1], m[3 * i + 2] * r[3 * j + 2]),
    )
}

#[inline(always)]
fn rotated_symmetric<S: Simd>(r: &Mat3<S>, m: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let [xx, xy, xz, yy, yz, zz] = *m;
    let half = product(r, &[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    let mut out = *m;
    for i in 0..3 {
        for j in i..3 {
            out[AT[i][j]] = right(&half, r, i, j);
        }
    }
    out
}

#[inline(always)]
fn rotated<S: Simd>(r: &Mat3<S>, m: &Mat3<S>) -> Mat3<S> {
    product_transposed(&product(r, m), r)
}
