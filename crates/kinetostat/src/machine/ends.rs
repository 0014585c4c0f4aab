//! Motion of a limb's tip by those of the two platforms that it joins: `A_i dP = T_to dP_to - B_from dP_from`.

use nalgebra::{DMatrix, Matrix6, Vector3};

use crate::model::mechanism::Mechanism;
use crate::spatial::{Pose, Twist, shift_matrix};

/// Motion of a limb's tip by those of its two platforms; platform 0 does not move.
pub(crate) struct Ends {
    pub to: (usize, Matrix6<f64>),
    pub from: (usize, Matrix6<f64>),
}

impl Ends {
    /// `A_i dP` of the motions of all platforms, the base included.
    pub fn of(&self, motions: &[Twist]) -> Twist {
        Twist(self.to.1 * motions[self.to.0].0 + self.from.1 * motions[self.from.0].0)
    }

    /// `A_i`, 6 x 6P.
    pub fn matrix(&self, moving: usize) -> DMatrix<f64> {
        let mut a = DMatrix::zeros(6, 6 * moving);
        for (platform, block) in [&self.to, &self.from] {
            if *platform > 0 {
                let mut view = a.fixed_view_mut::<6, 6>(0, 6 * (platform - 1));
                view += block;
            }
        }
        a
    }
}

/// Ends of a limb while the platforms are in these poses.
pub(crate) fn ends(mechanism: &Mechanism, platforms: &[Pose], limb: usize) -> Ends {
    let l = &mechanism.limbs()[limb];
    let (base, end) = (&platforms[l.from], &platforms[l.to]);
    let arm: Vector3<f64> = end.rotation * l.platform_from_tip.translation.vector;
    let tip = end.translation.vector + arm;
    Ends {
        to: (l.to, shift_matrix(&arm)),
        from: (l.from, -shift_matrix(&(tip - base.translation.vector))),
    }
}
