//! Correctors of the passes of an equilibrium, kept in a table: machines that differ a little from a drawn one use its
//! correctors. An iteration whose residuals are measured converges to the same result.
//!
//! Columns of each limb: stiffness (21 numbers), `joints` and `among` of its passive joints, rounding; then of the
//! platform: compliance (21), smallest relative pivot.

use pulp::Simd;

use crate::batch::machine::group::Group;
use crate::batch::machine::loaded::Machine;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::plan::steps::Plan;
use crate::batch::table::Columns;

/// Numbers of a posture.
pub(crate) fn width(actual: &[Plan]) -> usize {
    let limb = |plan: &Plan| 22 + 12 * plan.passive.len().min(6);
    actual.iter().map(limb).sum::<usize>() + 22
}

impl<S: Simd> Machine<S> {
    /// Keeps what corrects these postures.
    #[inline(always)]
    pub fn keep_correctors(&self, group: &Group, table: &mut [f64]) {
        let mut from = 0;
        let mut put = |numbers: &[Lanes<S>]| {
            group.put(table, from, numbers);
            from += numbers.len();
        };
        for attached in &self.attached {
            let own = &attached.corrector;
            for part in parts(&own.stiffness) {
                put(part);
            }
            for k in 0..own.count {
                put(&own.joints[k]);
                put(&own.among[k]);
            }
            put(&[attached.noise]);
        }
        for part in parts(&self.compliance) {
            put(part);
        }
        put(&[self.regular]);
    }

    /// Takes what corrects these postures: the smallest relative pivot met when it was found.
    #[inline(always)]
    pub fn take_correctors(&mut self, simd: S, group: &Group, table: Columns<'_>) -> Lanes<S> {
        let mut from = 0;
        let mut take = |numbers: &mut [Lanes<S>]| {
            group.numbers(simd, table, from, numbers);
            from += numbers.len();
        };
        for (attached, plan) in self.attached.iter_mut().zip(self.actual.iter()) {
            let own = &mut attached.corrector;
            own.count = plan.passive.len().min(6);
            for part in parts_mut(&mut own.stiffness) {
                take(part);
            }
            for k in 0..own.count {
                take(&mut own.joints[k]);
                take(&mut own.among[k]);
            }
            take(std::slice::from_mut(&mut attached.noise));
        }
        for part in parts_mut(&mut self.compliance) {
            take(part);
        }
        take(std::slice::from_mut(&mut self.regular));
        // These numbers are those of the drawn machine: no path continues with them.
        self.compliance_at.point = [Lanes::new(simd, f64::NAN); 3];
        self.regular
    }
}

fn parts<S: Simd>(matrix: &Symmetric<S>) -> [&[Lanes<S>]; 3] {
    [&matrix.a, &matrix.b, &matrix.d]
}

fn parts_mut<S: Simd>(matrix: &mut Symmetric<S>) -> [&mut [Lanes<S>]; 3] {
    [&mut matrix.a, &mut matrix.b, &mut matrix.d]
}
