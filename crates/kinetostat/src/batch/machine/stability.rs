//! The machine's tangent stiffness, and whether its equilibrium holds.

use pulp::Simd;

use crate::batch::limb::tangent;
use crate::batch::machine::loaded::{Machine, PlatformMass};
use crate::batch::numbers::apart::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::{AT, Symmetric};
use crate::batch::numbers::vectors::{carried, constant, dot};
use crate::batch::numbers::wrenches::Mat6;

impl<S: Simd> Machine<S> {
    /// Tangent stiffness of the platform at its point, base axes, and the smallest relative pivot: of
    /// the limbs, less the change of the platform's own weight's moment.
    #[inline(always)]
    pub fn tangent(&self, simd: S) -> (Mat6<S>, Lanes<S>) {
        let zero = Lanes::new(simd, 0.0);
        let mut sum = [[zero; 6]; 6];
        let mut regular = Lanes::new(simd, 1.0);
        for (limb, plan) in self.limbs.iter().zip(self.actual.iter()) {
            let (own, pivot) = tangent::stiffness(simd, plan, limb, &self.gravity);
            regular = regular.least_of(pivot);
            for i in 0..6 {
                for j in 0..6 {
                    sum[i][j] = sum[i][j] + own[i][j];
                }
            }
        }
        let PlatformMass { centre, mass } = &self.body;
        if *mass != 0.0 {
            let [x, y, z] = &self.gravity;
            let weight = constant(simd, &[x * mass, y * mass, z * mass]);
            let arm = carried(&self.rotation, &constant(simd, centre), &[zero; 3]);
            let along = dot(&weight, &arm);
            for i in 0..3 {
                sum[3 + i][3 + i] = sum[3 + i][3 + i] + along;
                for j in 0..3 {
                    sum[3 + i][3 + j] = arm[i].times_from(weight[j], sum[3 + i][3 + j]);
                }
            }
        }
        (sum, regular)
    }

    /// Returns stability (one or zero), force per motion in the softest direction of the tool, load factor (NaN without
    /// internal motions), as in [`crate::batch::PostureStability`]; and the smallest relative pivot, by which the
    /// platform is left to the general engine where nothing holds it or it diverges.
    #[inline(always)]
    pub fn stability(&mut self, simd: S, k: &Mat6<S>) -> ([Lanes<S>; 3], Lanes<S>) {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let mut own = Symmetric::zero(simd);
            for i in 0..6 {
                for j in i..6 {
                    own.set(i, j, (k[i][j] + k[j][i]) * 0.5);
                }
            }
            let (compliance, mut regular) = own.inverse(simd);
            let softest = largest(compliance.a);
            let mut share_to_buckling = None;
            let limbs = self
                .shapes
                .iter_mut()
                .zip(self.actual.iter())
                .zip(&self.limbs);
            for ((shape, plan), limb) in limbs {
                if let Some((own, pivot)) = shape.share_to_buckling(plan, limb, &self.gravity) {
                    regular = regular.least_of(pivot);
                    share_to_buckling = Some(match share_to_buckling {
                        Some(other) => own.max(other),
                        None => own,
                    });
                }
            }
            let stable = match share_to_buckling {
                Some(share_to_buckling) => share_to_buckling.where_less(one, one, zero),
                None => one,
            };
            let share_to_buckling = match share_to_buckling {
                Some(share_to_buckling) => share_to_buckling,
                None => zero + f64::NAN,
            };
            ([stable, one / softest, share_to_buckling], regular)
        })
    }
}

/// Sweeps of Jacobi's rotations: each squares what is beside the diagonal.
const SWEEPS: usize = 6;

/// Largest eigenvalue of a symmetric 3 x 3 matrix in six numbers.
#[inline(always)]
fn largest<S: Simd>(mut m: [Lanes<S>; 6]) -> Lanes<S> {
    for _ in 0..SWEEPS {
        rotate::<S, 0, 1, 2>(&mut m);
        rotate::<S, 0, 2, 1>(&mut m);
        rotate::<S, 1, 2, 0>(&mut m);
    }
    m[AT[0][0]].max(m[AT[1][1]]).max(m[AT[2][2]])
}

/// Jacobi's rotation that takes entry (I, J) to zero; K is the third axis.
#[inline(always)]
fn rotate<S: Simd, const I: usize, const J: usize, const K: usize>(m: &mut [Lanes<S>; 6]) {
    let x = m[AT[I][J]];
    let (zero, one) = (x.same(0.0), x.same(1.0));
    // tan 2a = 2 x / d; t the smaller root, finite where both are zero.
    let d = m[AT[J][J]] - m[AT[I][I]];
    let root = d.times_plus(d, x * x * 4.0).sqrt();
    let under = d.abs() + root;
    let t = x * d.where_less(zero, -one, one) * 2.0 / under.max(one * f64::MIN_POSITIVE);
    let c = one / t.times_plus(t, one).sqrt();
    let s = t * c;
    m[AT[I][I]] = t.times_from(x, m[AT[I][I]]);
    m[AT[J][J]] = t.times_plus(x, m[AT[J][J]]);
    m[AT[I][J]] = zero;
    let (a, b) = (m[AT[I][K]], m[AT[J][K]]);
    m[AT[I][K]] = s.times_from(b, c * a);
    m[AT[J][K]] = s.times_plus(a, c * b);
}
