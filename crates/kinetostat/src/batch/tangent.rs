//! Tangent stiffness of a loaded serial chain, by one walk from its end to its base.
//!
//! With `t` the motion of what lies beyond a place and `y` the change of the wrench there (both at the tip's
//! place), rows and columns as in [`crate::sweep`]: along a stage of coordinates `x` with twists `S`,
//! `t = t' + S x` and `S^T (y + A t) = K x`, and a node adds `y' = y + g t`. What lies beyond answers
//! `y = P t + B w` to a change `w` of the wrench at the tip, whose own motion is `t_n = F t + D w`:
//!
//! ```text
//! (K - S^T P S - L) x = S^T (P + A) t' + S^T B w        L: S^T A S below the diagonal
//! P' = P (1 + S X_t) + g    B' = B + P S X_w    F' = F (1 + S X_t)    D' = D + F S X_w
//! ```
//!
//! At the base `t = 0`, so `D` is the compliance: exact under dead moments too, where it is not symmetric.

use pulp::Simd;

use super::lanes::{Lanes, cross, minus};
use super::loaded::{LoadedLimb, twist};
use super::plan::{Held, Plan, Step};

type Mat6<S> = [[Lanes<S>; 6]; 6];

struct Riccati<S: Simd> {
    p: Mat6<S>,
    b: Mat6<S>,
    f: Mat6<S>,
    d: Mat6<S>,
    /// Force and moment beyond, about the tip's place.
    force: [Lanes<S>; 3],
    moment: [Lanes<S>; 3],
    regular: Lanes<S>,
    simd: S,
}

/// Tangent stiffness at the tip, 6 x 6 by rows, and its smallest relative pivot.
#[inline(always)]
pub(super) fn stiffness<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &LoadedLimb<S>,
    gravity: &[f64; 3],
) -> (Mat6<S>, Lanes<S>) {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let nothing = [[zero; 6]; 6];
    let mut unit = nothing;
    for k in 0..6 {
        unit[k][k] = one;
    }
    let [fx, fy, fz, mx, my, mz] = limb.wrench;
    let mut walk = Riccati {
        p: nothing,
        b: unit,
        f: unit,
        d: nothing,
        force: [zero; 3],
        moment: [zero; 3],
        regular: one,
        simd,
    };
    walk.node(&[fx, fy, fz], &[zero; 3]);
    walk.moment = [mx, my, mz];
    let mut mass = limb.masses.len();
    for step in plan.steps.iter().rev() {
        match step {
            Step::Mass { mass: m, .. } => {
                mass -= 1;
                let weight = gravity.map(|g| one * (g * *m));
                let arm = minus(&limb.masses[mass], &limb.point);
                walk.node(&weight, &arm);
            }
            Step::Joint(joint) => {
                if let (Held::Spring(c), Some(_)) = (joint.held, joint.amount.coordinate) {
                    let mut s = [[zero; 6]; 6];
                    s[0] = twist(limb, plan, joint.screw);
                    let mut k = [0.0; 36];
                    k[0] = 1.0 / c;
                    walk.stage::<1>(&s, &k);
                }
            }
            Step::Spring(spring) => {
                let mut s = [[zero; 6]; 6];
                let mut screw = spring.screw;
                for d in 0..6 {
                    if spring.coordinates[d].is_some() {
                        s[d] = twist(limb, plan, screw);
                        screw += 1;
                    }
                }
                // A direction that does not move: a unit on the diagonal holds it.
                let mut k = *spring.stiffness;
                for d in 0..6 {
                    if spring.coordinates[d].is_none() {
                        k[7 * d] = 1.0;
                    }
                }
                walk.stage::<6>(&s, &k);
            }
            Step::Shift(_) | Step::Rotate(_) => {}
        }
    }
    let mut matrix = walk.d;
    let mut inverse = unit;
    let regular = solve(simd, &mut matrix, &mut inverse);
    (inverse, walk.regular.least_of(regular))
}

impl<S: Simd> Riccati<S> {
    /// A dead force at a point, from which the tip lies at `-arm`: `g = [0, 0; -hat(f), hat(f) hat(arm)]`.
    #[inline(always)]
    fn node(&mut self, force: &[Lanes<S>; 3], arm: &[Lanes<S>; 3]) {
        let [x, y, z] = *force;
        let zero = Lanes::new(self.simd, 0.0);
        // Rows of -hat(f).
        let rows = [[zero, z, -y], [-z, zero, x], [y, -x, zero]];
        for (i, row) in rows.iter().enumerate() {
            // hat(f) hat(arm) = -(rows hat(arm)); a row times hat(arm) is row x arm.
            let turned = cross(row, arm);
            for k in 0..3 {
                self.p[3 + i][k] = self.p[3 + i][k] + row[k];
                self.p[3 + i][3 + k] = self.p[3 + i][3 + k] - turned[k];
            }
        }
        let own = cross(arm, force);
        for k in 0..3 {
            self.force[k] = self.force[k] + force[k];
            self.moment[k] = self.moment[k] + own[k];
        }
    }

    /// `A t = [0, hat(f); hat(f), hat(m)] t` for a twist.
    #[inline(always)]
    fn outer(&self, t: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
        let (v, w) = ([t[0], t[1], t[2]], [t[3], t[4], t[5]]);
        let top = cross(&self.force, &w);
        let (a, b) = (cross(&self.force, &v), cross(&self.moment, &w));
        [
            top[0],
            top[1],
            top[2],
            a[0] + b[0],
            a[1] + b[1],
            a[2] + b[2],
        ]
    }

    /// Coordinates with twists `s` (a row each) and stiffness `k`.
    #[inline(always)]
    fn stage<const N: usize>(&mut self, s: &Mat6<S>, k: &[f64; 36]) {
        let zero = Lanes::new(self.simd, 0.0);
        // P s_j, and A^T s_i = (s_i^T A)^T = -A s_i, since A is skew.
        let mut ps = [[zero; 6]; N];
        let mut sa = [[zero; 6]; N];
        for j in 0..N {
            for r in 0..6 {
                for c in 0..6 {
                    ps[j][r] = self.p[r][c].times_plus(s[j][c], ps[j][r]);
                }
            }
            sa[j] = self.outer(&s[j]).map(|x| -x);
        }
        let mut m = [[zero; N]; N];
        // Columns: t' (6), w (6).
        let mut x = [[zero; 12]; N];
        for i in 0..N {
            for j in 0..N {
                let mut sum = zero + k[if N == 1 { 0 } else { 6 * i + j }];
                for r in 0..6 {
                    sum = s[i][r].times_from(ps[j][r], sum);
                    if j < i {
                        sum = sa[i][r].times_from(s[j][r], sum);
                    }
                }
                m[i][j] = sum;
            }
            for c in 0..6 {
                let (mut t, mut w) = (sa[i][c], zero);
                for r in 0..6 {
                    t = s[i][r].times_plus(self.p[r][c], t);
                    w = s[i][r].times_plus(self.b[r][c], w);
                }
                (x[i][c], x[i][6 + c]) = (t, w);
            }
        }
        self.regular = self
            .regular
            .least_of(solve_small::<S, N, 12>(self.simd, &mut m, &mut x));
        // S X.
        let mut sx = [[zero; 12]; 6];
        for r in 0..6 {
            for c in 0..12 {
                for i in 0..N {
                    sx[r][c] = s[i][r].times_plus(x[i][c], sx[r][c]);
                }
            }
        }
        let (p, f) = (self.p, self.f);
        for r in 0..6 {
            for c in 0..6 {
                for i in 0..N {
                    self.p[r][c] = ps[i][r].times_plus(x[i][c], self.p[r][c]);
                    self.b[r][c] = ps[i][r].times_plus(x[i][6 + c], self.b[r][c]);
                }
                for q in 0..6 {
                    self.f[r][c] = f[r][q].times_plus(sx[q][c], self.f[r][c]);
                    self.d[r][c] = f[r][q].times_plus(sx[q][6 + c], self.d[r][c]);
                }
            }
        }
        let _ = p;
    }
}

/// `M X = B` in place without pivoting; the smallest pivot relative to its diagonal entry.
#[inline(always)]
pub(super) fn solve_small<S: Simd, const N: usize, const C: usize>(
    simd: S,
    m: &mut [[Lanes<S>; N]; N],
    x: &mut [[Lanes<S>; C]; N],
) -> Lanes<S> {
    let one = Lanes::new(simd, 1.0);
    let mut regular = one;
    let mut diagonal = [one; N];
    for i in 0..N {
        diagonal[i] = m[i][i].abs();
    }
    for k in 0..N {
        regular = regular.least_of(m[k][k].abs() / diagonal[k]);
        let reciprocal = one / m[k][k];
        for i in k + 1..N {
            let l = m[i][k] * reciprocal;
            for j in k + 1..N {
                m[i][j] = l.times_from(m[k][j], m[i][j]);
            }
            for c in 0..C {
                x[i][c] = l.times_from(x[k][c], x[i][c]);
            }
        }
        m[k][k] = reciprocal;
    }
    for i in (0..N).rev() {
        for c in 0..C {
            let mut y = x[i][c];
            for k in i + 1..N {
                y = m[i][k].times_from(x[k][c], y);
            }
            x[i][c] = y * m[i][i];
        }
    }
    regular
}

#[inline(always)]
fn solve<S: Simd>(simd: S, m: &mut Mat6<S>, x: &mut Mat6<S>) -> Lanes<S> {
    solve_small::<S, 6, 6>(simd, m, x)
}
