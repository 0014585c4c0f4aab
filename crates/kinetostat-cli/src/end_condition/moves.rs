//! Motions that the end of a chain or a machine can make.

use kinetostat::Pose;
use nalgebra::{DMatrix, Vector6};

/// Motions that the tool of a chain or a machine can make.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    /// `chain` or `machine`.
    pub(crate) subject: &'static str,
    /// Where the tool is commanded to be.
    pub(crate) place: Pose,
    /// Columns of an orthonormal basis, translations as shares of the natural length.
    pub(crate) basis: DMatrix<f64>,
    /// Natural length, m.
    pub(crate) length: f64,
}

impl Moves {
    /// The part of a twist (m, rad; base axes) that the tool can make, as a share from 0 to 1.
    pub(crate) fn share(&self, twist: &Vector6<f64>) -> f64 {
        let unit = |i: usize| if i < 3 { 1.0 / self.length } else { 1.0 };
        let scaled = Vector6::from_fn(|i, _| twist[i] * unit(i));
        let size = scaled.norm();
        if size == 0.0 {
            return 1.0;
        }
        (self.basis.transpose() * scaled).norm() / size
    }
}
