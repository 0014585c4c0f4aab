//! Motions that the end of a chain or the tool of a machine can make.

use kinetostat::{
    Chain, DirectionKind, MotionKind, Pose, Posture, linalg::SingularValues, model::Kinematics,
};
use nalgebra::{DMatrix, DVector, Vector6};

/// Directions in which a tool can be moved.
#[derive(Clone, Debug)]
pub struct MovableDirections {
    /// Columns of an orthonormal basis, translations as shares of the natural length; base axes.
    pub basis: DMatrix<f64>,
    /// Natural length, m.
    pub length: f64,
}

impl MovableDirections {
    /// Finds the movable directions of a machine: all but the rigid ones. A direction that only stretched limbs lock is
    /// movable if every limb can move that way near the posture: the limbs give way there as a single chain does.
    ///
    /// # Errors
    /// The stiffness cannot be computed.
    pub fn of(posture: &Posture) -> kinetostat::Result<Self> {
        let own = posture.stiffness()?;
        let rigid: Vec<DVector<f64>> = own
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Rigid)
            .map(|d| {
                let unit = |i: usize| if i < 3 { 1.0 } else { own.length };
                DVector::from_fn(6, |i, _| d.twist.0[i] * unit(i)).normalize()
            })
            .collect();
        let mut basis = without(&rigid);
        if let Some(beside) = beside_stretched_limbs(posture, own.length) {
            basis = Self::near(&[basis, beside], own.length).basis;
        }
        Ok(Self {
            basis,
            length: own.length,
        })
    }

    /// Finds the movable directions of a chain whose tip carries the tool, from all its motions near a posture. A
    /// missing direction is rigid everywhere: a planar chain does not leave its plane.
    pub(crate) fn near(steps: &[DMatrix<f64>], length: f64) -> Self {
        Self {
            basis: SingularValues::of(&side_by_side(steps)).range(1e-8),
            length,
        }
    }

    /// The part of a twist (m, rad; base axes) that the tool can make, as a share from 0 to 1.
    #[must_use]
    pub fn share(&self, twist: &Vector6<f64>) -> f64 {
        let unit = |i: usize| if i < 3 { 1.0 / self.length } else { 1.0 };
        let scaled = Vector6::from_fn(|i, _| twist[i] * unit(i));
        let size = scaled.norm();
        if size == 0.0 {
            return 1.0;
        }
        (self.basis.transpose() * scaled).norm() / size
    }
}

/// Motions of the tool per unit of each coordinate of a chain, translations as shares of the length, in a posture and in some
/// beside it. Each coordinate counts alike, in whatever unit it is.
pub(crate) fn motions_near(
    chain: &Chain,
    base: &Pose,
    posture: &[f64],
    commands: &[f64],
    tip_from_tool: &Pose,
    length: f64,
) -> Vec<DMatrix<f64>> {
    let scale = chain.scale().length;
    let beside = [0.0, 0.4, -0.9, 1.7].into_iter().enumerate();
    let motions = beside.map(|(k, size)| {
        let joints = posture.iter().zip(chain.coordinates()).enumerate();
        let x: Vec<f64> = joints
            .map(|(i, (x, c))| {
                let unit = match c.kind {
                    MotionKind::Revolute => 1.0,
                    MotionKind::Prismatic => 0.1 * scale,
                };
                // Irregular, so that no posture is singular by symmetry.
                x + size * unit * (0.4 + 0.6 * ((i + k) as f64 * 0.618_034).fract())
            })
            .collect();
        let kinematics = Kinematics::new(chain, base, &x, commands);
        let arm = kinematics.tip_pose().rotation * tip_from_tool.translation.vector;
        let mut jacobian = kinematics.jacobian(chain.tip());
        for mut column in jacobian.column_iter_mut() {
            let turn = column.fixed_rows::<3>(3).into_owned();
            let at_tool = (column.fixed_rows::<3>(0) + turn.cross(&arm)) / length;
            column.fixed_rows_mut::<3>(0).copy_from(&at_tool);
            let size = column.norm();
            if size > 0.0 {
                column.unscale_mut(size);
            }
        }
        DMatrix::from_iterator(6, jacobian.ncols(), jacobian.iter().copied())
    });
    motions.collect()
}

/// Common motions of all limbs from the base to the tool near the posture; `None` unless some limb has fewer motions of
/// the tool at the posture than near it.
fn beside_stretched_limbs(posture: &Posture, length: f64) -> Option<DMatrix<f64>> {
    let (limbs, tool) = (posture.mechanism().limbs(), posture.mechanism().tool());
    let (mut stretched, mut locked) = (false, DMatrix::zeros(6, 0));
    for (limb, joints) in limbs.iter().zip(posture.limbs()) {
        if limb.from != 0 || limb.to != tool {
            return None;
        }
        let motions = motions_near(
            &limb.actual,
            &posture.platforms()[0],
            &joints.coordinates,
            &joints.commands,
            &limb.platform_from_tip.inverse(),
            length,
        );
        let rank = |m: &DMatrix<f64>| SingularValues::of(m).rank(1e-8);
        stretched |= motions[1..].iter().any(|m| rank(m) > rank(&motions[0]));
        locked = side_by_side(&[locked, across(&side_by_side(&motions))]);
    }
    stretched.then(|| across(&locked))
}

fn side_by_side(parts: &[DMatrix<f64>]) -> DMatrix<f64> {
    let columns: Vec<f64> = parts.iter().flatten().copied().collect();
    DMatrix::from_column_slice(6, columns.len() / 6, &columns)
}

/// Everything across the columns, orthonormal columns.
fn across(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let singular = SingularValues::of(columns);
    let rank = singular.rank(1e-8);
    singular.all_left().columns(rank, 6 - rank).into_owned()
}

/// Everything across some directions (of length one, perhaps dependent), orthonormal columns.
fn without(directions: &[DVector<f64>]) -> DMatrix<f64> {
    let mut kept = DMatrix::<f64>::identity(6, 6);
    for d in directions {
        kept -= d * d.transpose();
    }
    let eigen = kept.symmetric_eigen();
    let columns: Vec<_> = (0..6).filter(|&k| eigen.eigenvalues[k] > 0.5).collect();
    eigen.eigenvectors.select_columns(&columns)
}
