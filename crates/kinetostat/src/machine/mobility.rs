//! Motions of the tool of the nominal machine, and those of them that its actuators drive.

use nalgebra::DMatrix;

use crate::linalg::saddle::{column_space, independent_columns};
use crate::machine::inverse::limb::blocked_motions;
use crate::machine::network::ends;
use crate::machine::platforms::solver::rates_of;
use crate::machine::posture::Posture;
use crate::spatial::{Directions, MotionKind};

impl Posture {
    /// Motions that the nominal machine can command or make freely, as an orthonormal basis, 6 x k
    /// (rotations in units of the natural length).
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("table")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .translation(vector![0.2, 0.1, 0.0])
    /// #     .passive("pivot", MotionKind::Revolute, Vector3::z(), 0.0)
    /// #     .build()?;
    /// # let home = Pose::translation(0.2, 0.1, 0.0);
    /// # let table = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// // Two slides, and a pivot that nothing drives.
    /// let posture = table.posture(&home)?;
    /// let basis = posture.mobility();
    /// assert_eq!(basis.ncols(), 3);
    /// assert!((basis.transpose() * &basis - nalgebra::DMatrix::identity(3, 3)).amax() < 1e-12);
    /// for blocked in [2, 3, 4] {
    ///     assert!(basis.row(blocked).amax() < 1e-9, "it neither lifts nor tilts");
    /// }
    /// let driven = posture.commanded_motions();
    /// assert!(driven.ncols() == 2 && driven.row(5).amax() < 1e-9, "no slide turns it");
    /// assert_eq!(posture.correctable().to_string(), "x y");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn mobility(&self) -> DMatrix<f64> {
        let m = &self.mechanism;
        let moving = m.platforms().len() - 1;
        let length = m.scale().length;
        let mut blocked = DMatrix::zeros(6 * moving, 6 * moving);
        for (i, (limb, joints)) in m.limbs().iter().zip(&self.limbs).enumerate() {
            let own = limb.nominal.scale().length;
            // Converts from the mechanism's units to SI, to the tip, to the limb's units.
            let mut to_limb = ends(&self.mechanism, &self.platforms, i).matrix(moving);
            to_limb.rows_mut(3, 3).scale_mut(own);
            for (j, mut column) in to_limb.column_iter_mut().enumerate() {
                if j % 6 >= 3 {
                    column.unscale_mut(length);
                }
            }
            let base = &self.platforms[limb.from];
            let p = blocked_motions(&limb.nominal, base, joints) * to_limb;
            blocked += p.transpose() * p;
        }
        let eigen = blocked.symmetric_eigen();
        let kept: Vec<_> = (0..6 * moving)
            .filter(|&i| eigen.eigenvalues[i].abs() < 1e-9)
            .map(|i| eigen.eigenvectors.column(i).into_owned())
            .collect();
        if kept.is_empty() {
            return DMatrix::zeros(6, 0);
        }
        let all = DMatrix::from_columns(&kept);
        if moving == 1 {
            return all;
        }
        let tool = all.rows(6 * (m.tool() - 1), 6).into_owned();
        // Motions of other platforms alone leave rounding here, which is no motion.
        if tool.amax() < 1e-6 {
            return DMatrix::zeros(6, 0);
        }
        independent_columns(&tool)
    }

    /// Motions that the actuators drive, as an orthonormal basis, 6 x k (rotations in units of the
    /// natural length): [`Self::mobility`] without what passive joints allow on their own.
    #[must_use]
    pub fn commanded_motions(&self) -> DMatrix<f64> {
        let basis = self.mobility();
        let rates = self.rates_by(&basis);
        basis * column_space(&(rates.transpose() * rates))
    }

    /// Rates of the commands (rows) by motions of the tool (columns, rotations in units of the natural length).
    fn rates_by(&self, motions: &DMatrix<f64>) -> DMatrix<f64> {
        let m = &self.mechanism;
        let mut motions = motions.clone();
        motions.rows_mut(3, 3).unscale_mut(m.scale().length);
        let limbs = rates_of(m, &self.platforms, &self.limbs);
        let rows: Vec<_> = limbs
            .iter()
            .flat_map(|rates| {
                let rates = rates * &motions;
                rates
                    .row_iter()
                    .map(|row| row.into_owned())
                    .collect::<Vec<_>>()
            })
            .collect();
        match rows.is_empty() {
            true => DMatrix::zeros(0, motions.ncols()),
            false => DMatrix::from_rows(&rows),
        }
    }

    /// Rates of the commands (rows, in their order) by [`Self::commanded_motions`] (columns), all as lengths: commands of
    /// actuators that turn are multiplied with the natural length, too.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("table")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .translation(vector![0.2, 0.1, 0.0])
    /// #     .build()?;
    /// # let home = Pose::translation(0.2, 0.1, 0.0);
    /// # let table = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// // Each slide moves the tool as far as itself.
    /// let rates = table.posture(&home)?.command_rates();
    /// let same = rates.transpose() * &rates - nalgebra::DMatrix::identity(2, 2);
    /// assert!(rates.shape() == (2, 2) && same.amax() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn command_rates(&self) -> DMatrix<f64> {
        let mut rates = self.rates_by(&self.commanded_motions());
        let length = self.mechanism.scale().length;
        let actuators = self.mechanism.limbs().iter();
        let actuators = actuators.flat_map(|l| l.nominal.actuators());
        for (mut row, actuator) in rates.row_iter_mut().zip(actuators) {
            if actuator.kind == MotionKind::Revolute {
                row.scale_mut(length);
            }
        }
        rates
    }

    /// Base directions `x y z rx ry rz` of the tool that the machine can correct by itself:
    /// a choice, translations first, of as many as its actuators drive.
    #[must_use]
    pub fn correctable(&self) -> Directions {
        let basis = self.commanded_motions();
        let mut chosen = Directions::NONE;
        let mut rows: Vec<nalgebra::DVector<f64>> = Vec::new();
        for i in 0..6 {
            let mut row = basis.row(i).transpose();
            let size = row.norm();
            for r in &rows {
                let share = row.dot(r);
                row -= r * share;
            }
            if row.norm() > 1e-6 * size.max(1e-3) && row.norm() > 1e-6 {
                row.normalize_mut();
                rows.push(row);
                chosen = chosen.with(i);
            }
        }
        chosen
    }
}
