//! Passive joints taken out of a compliance.

use pulp::Simd;

use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::reflection::{reflect, reflection};
use crate::batch::numbers::symmetric::Symmetric;

/// Stiffness of a limb in base axes about the platform's point.
pub(crate) struct LimbStiffness<S: Simd> {
    pub matrix: Symmetric<S>,
    /// Smallest relative pivot of the elimination: near zero where a joint or a spring is redundant here.
    pub regular: Lanes<S>,
}

/// A compliance in axes whose first `m` are those of the passive joints: reflections and factors that
/// answer how a limb with passive joints yields.
pub(crate) struct Eliminated<S: Simd> {
    /// Dimensions: 3 (linear motions alone) or 6.
    d: usize,
    /// Passive joints.
    m: usize,
    /// Reflections `H_k = 1 - v u^T`.
    v: [[Lanes<S>; 6]; 6],
    u: [[Lanes<S>; 6]; 6],
    /// Column `k` of the reflected joints, upper triangular.
    r: [[Lanes<S>; 6]; 6],
    /// The reflected compliance.
    c: [[Lanes<S>; 6]; 6],
    /// Factor of its last block, reciprocals on the diagonal.
    l: [[Lanes<S>; 6]; 6],
    /// Smallest pivot relative to what it comes from: near zero where a joint or a spring is
    /// redundant here.
    pub regular: Lanes<S>,
}

impl<S: Simd> Eliminated<S> {
    /// Householder reflections lead the first `m` columns to the first `m` axes; the last rows and
    /// columns of the reflected `C` are `N^T C N`, `N` the complement of the columns.
    #[inline(always)]
    pub fn new(
        simd: S,
        d: usize,
        m: usize,
        compliance: &Symmetric<S>,
        columns: &[[Lanes<S>; 6]; 6],
    ) -> Self {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let (d, m) = (d.min(6), m.min(d).min(6));
            let nothing = [[zero; 6]; 6];
            let mut own = Self {
                d,
                m,
                v: nothing,
                u: nothing,
                r: *columns,
                c: nothing,
                l: nothing,
                regular: one,
            };
            for i in 0..d {
                for j in 0..d {
                    own.c[i][j] = compliance.get(i, j);
                }
            }
            for k in 0..m {
                own.reflect(simd, k);
            }
            // The last block as L L^T.
            for j in m..d {
                let diagonal = own.c[j][j];
                let mut pivot = diagonal;
                for k in m..j {
                    pivot = own.l[j][k].times_from(own.l[j][k], pivot);
                }
                own.regular = own.regular.least_of(pivot / diagonal.abs());
                let reciprocal = one / pivot.sqrt();
                own.l[j][j] = reciprocal;
                for i in j + 1..d {
                    let mut x = own.c[i][j];
                    for k in m..j {
                        x = own.l[i][k].times_from(own.l[j][k], x);
                    }
                    own.l[i][j] = x * reciprocal;
                }
            }
            own
        })
    }

    /// Reflection `k`: of the columns and of the compliance.
    #[inline(always)]
    fn reflect(&mut self, simd: S, k: usize) {
        let zero = Lanes::new(simd, 0.0);
        let (d, m) = (self.d, self.m);
        let (mut v, mut u) = (self.r[k], [zero; 6]);
        let image = reflection(k, &mut v[..d], &mut u[..d]);
        self.regular = self.regular.least_of(image.share);
        self.r[k][k] = image.number;
        for column in &mut self.r[k + 1..m] {
            reflect(k..d, &v, &u, column);
        }
        // C <- H C H = C - v w^T - w v^T with w = C u - v (u^T C u) / 2.
        let mut w = [zero; 6];
        let mut along = zero;
        for i in 0..d {
            for j in k..d {
                w[i] = self.c[i][j].times_plus(u[j], w[i]);
            }
            along = w[i].times_plus(u[i], along);
        }
        let half = along * 0.5;
        for i in k..d {
            w[i] = half.times_from(v[i], w[i]);
        }
        for i in 0..d {
            for j in k..d {
                let x = w[i].times_from(v[j], v[i].times_from(w[j], self.c[i][j]));
                self.c[i][j] = x;
                if i < k {
                    self.c[j][i] = x;
                }
            }
        }
        (self.v[k], self.u[k]) = (v, u);
    }

    /// `H_(m-1) ... H_0 x`: into the reflected axes.
    #[inline(always)]
    pub fn reflected(&self, mut x: [Lanes<S>; 6]) -> [Lanes<S>; 6] {
        for k in 0..self.m {
            x = self.through(k, x);
        }
        x
    }

    /// `H_0 ... H_(m-1) x`: out of the reflected axes.
    #[inline(always)]
    pub fn reflected_back(&self, mut x: [Lanes<S>; 6]) -> [Lanes<S>; 6] {
        for k in (0..self.m).rev() {
            x = self.through(k, x);
        }
        x
    }

    #[inline(always)]
    fn through(&self, k: usize, mut x: [Lanes<S>; 6]) -> [Lanes<S>; 6] {
        reflect(k..self.d, &self.v[k], &self.u[k], &mut x);
        x
    }

    /// `N (N^T C N)^-1 N^T`: stiffness of the limb.
    #[inline(always)]
    pub fn stiffness(&self, simd: S) -> LimbStiffness<S> {
        let zero = Lanes::new(simd, 0.0);
        let mut matrix = Symmetric::zero(simd);
        for e in self.m..self.d {
            // Column e of N L^-T.
            let mut y = [zero; 6];
            y[e] = self.l[e][e];
            for i in (self.m..e).rev() {
                let mut x = zero;
                for k in i + 1..=e {
                    x = self.l[k][i].times_plus(y[k], x);
                }
                y[i] = -(x * self.l[i][i]);
            }
            let y = self.reflected_back(y);
            for i in 0..6 {
                for j in i..6 {
                    matrix.set(i, j, y[i].times_plus(y[j], matrix.get(i, j)));
                }
            }
        }
        LimbStiffness {
            matrix,
            regular: self.regular,
        }
    }

    /// Wrench and passive motions, both in units of the compliance and the columns, with which the
    /// limb's end moves by `motion` while the passive joints bear `torque` (in place: joints as
    /// given, wrench returned): `C w + J_q dq = motion, J_q^T w = torque`.
    #[inline(always)]
    pub fn answer(
        &self,
        simd: S,
        motion: [Lanes<S>; 6],
        torque: &[Lanes<S>],
        joints: &mut [Lanes<S>],
    ) -> [Lanes<S>; 6] {
        apart!(simd, {
            let zero = Lanes::new(simd, 0.0);
            let (d, m) = (self.d, self.m);
            let g = self.reflected(motion);
            let mut w = [zero; 6];
            // R^T w_1 = torque.
            for k in 0..m {
                let mut x = torque[k];
                for i in 0..k {
                    x = self.r[k][i].times_from(w[i], x);
                }
                w[k] = x / self.r[k][k];
            }
            // L L^T w_2 = g_2 - C_21 w_1.
            for i in m..d {
                let mut x = g[i];
                for k in 0..m {
                    x = self.c[i][k].times_from(w[k], x);
                }
                for k in m..i {
                    x = self.l[i][k].times_from(w[k], x);
                }
                w[i] = x * self.l[i][i];
            }
            for i in (m..d).rev() {
                let mut x = w[i];
                for k in i + 1..d {
                    x = self.l[k][i].times_from(w[k], x);
                }
                w[i] = x * self.l[i][i];
            }
            // R dq = g_1 - C_1. w.
            for k in (0..m).rev() {
                let mut x = g[k];
                for j in 0..d {
                    x = self.c[k][j].times_from(w[j], x);
                }
                for j in k + 1..m {
                    x = self.r[j][k].times_from(joints[j], x);
                }
                joints[k] = x / self.r[k][k];
            }
            self.reflected_back(w)
        })
    }
}
