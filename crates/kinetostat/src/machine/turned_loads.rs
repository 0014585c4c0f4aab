//! Contribution of forces to the stiffness of platforms as limbs turn: the part of the platforms' tangent that is not
//! in the limbs' own stiffnesses.
//!
//! A limb holds its tip by `W = (f, m)`. Where its base turns by `phi`, the whole limb turns and `dW = (phi x f,
//! phi x m)`; where its ends move against each other, the arms of `f` change. A limb that carries loads of its
//! own does not turn with them: the rest of its tangent is added as it was computed.

use nalgebra::{DMatrix, Matrix3, Matrix6};

use crate::chain::stiffness::ChainStiffness;
use crate::linalg::sparse::Sparse;
use crate::machine::graded::GradedPlatforms;
use crate::machine::network::{Ends, ends};
use crate::machine::platforms::solver::PlatformSolver;
use crate::model::loads::load::Load;
use crate::spatial::hat;

impl PlatformSolver<'_> {
    /// Ends of the limbs now.
    fn ends(&self) -> Vec<Ends> {
        let limbs = 0..self.mechanism.limbs().len();
        limbs
            .map(|i| ends(self.mechanism, &self.state.platforms, i))
            .collect()
    }

    /// The platforms' stiffness by rows of the limbs; `None` where stiffnesses are of similar size.
    pub fn graded(&self, tangent: &Sparse, limbs: &[&ChainStiffness]) -> Option<GradedPlatforms> {
        let m = self.mechanism;
        let ends = self.ends();
        let scales = m.limbs().iter().map(|limb| limb.actual.scale());
        let own = limbs.iter().zip(scales).zip(&ends);
        let own = own.map(|((k, scale), ends)| (*k, scale, ends));
        let graded = GradedPlatforms::of(m.scale(), tangent.rows / 6, own)?;
        Some(graded.with(&self.turned_loads(tangent, limbs, &ends)))
    }

    /// Contribution of the limbs' forces and of loads on platforms to the limbs' stiffnesses at the present state, 6P x
    /// 6P; `tangent` is that of [`Self::tangents`].
    fn turned_loads(&self, tangent: &Sparse, limbs: &[&ChainStiffness], ends: &[Ends]) -> Sparse {
        let (m, at) = (self.mechanism, &self.state);
        let mut sum = Sparse::zeros(tangent.rows, tangent.columns);
        let mut loaded = false;
        for (i, limb) in m.limbs().iter().enumerate() {
            let to = 6 * (limb.to - 1);
            sum.add(to, to, &self.turned_force(i, at));
            if limb.from == 0 {
                continue;
            }
            let weightless =
                limb.actual.bodies().is_empty() && limb.actual.segment_masses().is_empty();
            loaded |= self.loads[i]
                .iter()
                .any(|load| !(weightless && matches!(load, Load::Gravity(_))));
            let from = 6 * (limb.from - 1);
            let (force, moment) = (at.wrenches[i].force(), at.wrenches[i].moment());
            let turned = columns(&hat(&-force), &hat(&-moment));
            let (by_to, by_from) = (ends[i].to.1, ends[i].from.1);
            sum.add(to, from, &(by_to.transpose() * turned));
            let arm = lower(&hat(&force));
            sum.add(from, from, &(by_from.transpose() * turned - arm));
            sum.add(from, to, &(arm * by_to));
        }
        self.add_platform_loads(at, |on, by, block| {
            sum.add(6 * (on - 1), 6 * (by - 1), block);
        });
        if loaded {
            let mut rest = tangent.dense() - sum.dense();
            for (k, ends) in limbs.iter().zip(ends) {
                let a = ends.matrix(tangent.rows / 6);
                let k = DMatrix::from_fn(6, 6, |i, j| k.cartesian.matrix[(i, j)]);
                rest -= a.transpose() * k * a;
            }
            sum.add(0, 0, &rest);
        }
        sum
    }
}

/// Force and moment by a turn.
fn columns(force: &Matrix3<f64>, moment: &Matrix3<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(force);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(moment);
    matrix
}

/// Moment by a displacement.
fn lower(moment: &Matrix3<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(moment);
    matrix
}
