//! Which motions of the tool the nominal machine has, and which of them its actuators drive.

use nalgebra::DMatrix;

use crate::inverse::{blocked_motions, command_rates};
use crate::posture::Posture;
use crate::saddle::column_space;
use crate::spatial::shift_matrix;

impl Posture<'_> {
    /// Motions that the nominal machine can command or make freely, as an orthonormal basis, 6 x k
    /// (rotations in units of the natural length).
    #[must_use]
    pub fn mobility(&self) -> DMatrix<f64> {
        let m = self.mechanism;
        let length = self.mechanism.scale().length;
        let mut blocked = DMatrix::zeros(6, 6);
        for (limb, joints) in m.limbs.iter().zip(&self.limbs) {
            let base = m.platforms[limb.from].home;
            let own = limb.nominal.scale().length;
            let t =
                shift_matrix(&(self.target.rotation * limb.platform_from_tip.translation.vector));
            // From the mechanism's units to SI, to the tip, to the limb's units.
            let mut to_limb = DMatrix::from_fn(6, 6, |i, j| t[(i, j)]);
            for k in 0..3 {
                to_limb.row_mut(3 + k).scale_mut(own);
                to_limb.column_mut(3 + k).unscale_mut(length);
            }
            let p = blocked_motions(&limb.nominal, &base, joints) * to_limb;
            blocked += p.transpose() * p;
        }
        let eigen = blocked.symmetric_eigen();
        let kept: Vec<_> = (0..6)
            .filter(|&i| eigen.eigenvalues[i].abs() < 1e-9)
            .map(|i| eigen.eigenvectors.column(i).into_owned())
            .collect();
        if kept.is_empty() {
            return DMatrix::zeros(6, 0);
        }
        DMatrix::from_columns(&kept)
    }

    /// Motions that the actuators drive, as an orthonormal basis, 6 x k (rotations in units of the
    /// natural length): [`Self::mobility`] without what passive joints allow on their own.
    #[must_use]
    pub fn commanded_motions(&self) -> DMatrix<f64> {
        let m = self.mechanism;
        let basis = self.mobility();
        let length = self.mechanism.scale().length;
        let mut driven = DMatrix::zeros(basis.ncols(), basis.ncols());
        for (limb, joints) in m.limbs.iter().zip(&self.limbs) {
            let t =
                shift_matrix(&(self.target.rotation * limb.platform_from_tip.translation.vector));
            let mut motions = basis.clone();
            motions.rows_mut(3, 3).unscale_mut(length);
            let rates =
                command_rates(&limb.nominal, &m.platforms[limb.from].home, joints) * t * motions;
            driven += rates.transpose() * rates;
        }
        basis * column_space(&driven)
    }

    /// Base directions `x y z rx ry rz` of the tool that the machine can correct by itself:
    /// a choice, translations first, of as many as its actuators drive.
    #[must_use]
    pub fn correctable(&self) -> [bool; 6] {
        let basis = self.commanded_motions();
        let mut chosen = [false; 6];
        let mut rows: Vec<nalgebra::DVector<f64>> = Vec::new();
        for (i, flag) in chosen.iter_mut().enumerate() {
            let mut row = basis.row(i).transpose();
            let size = row.norm();
            for r in &rows {
                let share = row.dot(r);
                row -= r * share;
            }
            if row.norm() > 1e-6 * size.max(1e-3) && row.norm() > 1e-6 {
                row.normalize_mut();
                rows.push(row);
                *flag = true;
            }
        }
        chosen
    }
}
