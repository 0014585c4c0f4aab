//! Motions that the end of a chain or the tool of a machine can make.

use kinetostat::{DirectionKind, Posture};
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
    /// Of a machine: all directions but those in which it is rigid.
    ///
    /// # Errors
    /// Its stiffness cannot be computed.
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
        Ok(Self {
            basis: without(&rigid),
            length: own.length,
        })
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
