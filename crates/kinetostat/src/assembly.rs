//! Limbs with errors of manufacture and assembly, to first order [R 6.15-6.20]. The exact answer is
//! an equilibrium of the actual geometry without a load.

use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::error::{Error, Result};
use crate::posture::Posture;
use crate::spatial::{Twist, Wrench, pose_residual, shift_matrix};

/// First-order assembly of limbs with errors, no external load [R 6.15-6.20].
#[derive(Clone, Debug)]
pub struct LinearAssembly {
    /// Motion of the tool from its nominal target.
    pub shift: Twist,
    /// Wrench on every limb's tip, base axes; their sum about the tool is zero.
    pub wrenches: Vec<Wrench>,
    /// Change of the passive joints of every limb, m or rad.
    pub passive: Vec<Vec<f64>>,
    /// Deflection of the springs of every limb, m or rad.
    pub springs: Vec<Vec<f64>>,
}

impl Posture<'_> {
    /// How far the tip of every unloaded actual limb is from its nominal place, `eps_i`, base axes.
    #[must_use]
    pub fn assembly_errors(&self) -> Vec<Twist> {
        let m = self.mechanism;
        m.limbs
            .iter()
            .zip(&self.limbs)
            .map(|(limb, joints)| {
                let base = m.platforms[limb.from].home;
                let tip = |chain| {
                    crate::equilibrium::unloaded_tip(
                        chain,
                        &base,
                        &joints.coordinates,
                        &joints.commands,
                    )
                };
                pose_residual(&tip(&limb.actual), &tip(&limb.nominal))
            })
            .collect()
    }

    /// First-order platform shift and internal wrenches for given limb errors `eps_i` (base axes,
    /// at each limb's tip), no external load:
    /// `Dt = (sum T^T K T)^-1 sum T^T K eps`, `F_i = K_i (T_i Dt - eps_i)`.
    ///
    /// # Errors
    /// Wrong sizes only.
    pub fn linear_assembly(&self, errors: &[Twist]) -> Result<LinearAssembly> {
        let m = self.mechanism;
        if errors.len() != m.limbs.len() {
            return Err(Error::Size {
                place: format!("mechanism '{}'", m.name),
                what: "limb errors",
                expected: m.limbs.len(),
                found: errors.len(),
            });
        }
        let own = self.stiffness()?;
        let shifts: Vec<Matrix6<f64>> = m
            .limbs
            .iter()
            .map(|l| shift_matrix(&(self.target.rotation * l.platform_from_tip.translation.vector)))
            .collect();
        let mut pull = Vector6::zeros();
        for ((k, t), e) in own.limbs.iter().zip(&shifts).zip(errors) {
            pull += t.transpose() * k.cartesian.matrix * e.0;
        }
        let length = self.mechanism.scale().length;
        let scale = [1.0, 1.0, 1.0, 1.0 / length, 1.0 / length, 1.0 / length];
        let total = own.cartesian.matrix;
        let mut b = DMatrix::from_column_slice(6, 1, pull.as_slice());
        crate::saddle::Saddle::new(DMatrix::from_fn(6, 6, |i, j| total[(i, j)]), &scale, &scale)
            .solve(&mut b);
        let shift = Twist(b.fixed_view::<6, 1>(0, 0).into_owned());
        let mut result = LinearAssembly {
            shift,
            wrenches: Vec::new(),
            passive: Vec::new(),
            springs: Vec::new(),
        };
        for ((k, t), e) in own.limbs.iter().zip(&shifts).zip(errors) {
            let motion = t * shift.0 - e.0;
            result.wrenches.push(Wrench(k.cartesian.matrix * motion));
            result
                .passive
                .push((&k.passive * motion).iter().copied().collect());
            result
                .springs
                .push((&k.springs * motion).iter().copied().collect());
        }
        Ok(result)
    }
}
