//! The machine's tangent stiffness, and whether its equilibrium holds.

use pulp::Simd;

use super::lanes::{Lanes, carried, constant, dot};
use super::run::Machine;
use super::tangent::{self, Mat6};

impl<S: Simd> Machine<'_, S> {
    /// Tangent stiffness of the platform at its point, base axes, and the smallest relative pivot: of
    /// the limbs, less the change of the platform's own weight's moment.
    #[inline(always)]
    pub fn tangent(&self, simd: S) -> (Mat6<S>, Lanes<S>) {
        let zero = Lanes::new(simd, 0.0);
        let mut sum = [[zero; 6]; 6];
        let mut regular = Lanes::new(simd, 1.0);
        for (limb, plan) in self.limbs.iter().zip(self.actual) {
            let (own, pivot) = tangent::stiffness(simd, plan, limb, &self.gravity);
            regular = regular.least_of(pivot);
            for i in 0..6 {
                for j in 0..6 {
                    sum[i][j] = sum[i][j] + own[i][j];
                }
            }
        }
        let (centre, mass) = &self.body;
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
}
