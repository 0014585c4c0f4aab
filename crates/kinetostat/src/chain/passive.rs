//! Passive joints of a chain: which of their motions change nothing at the end [R 3.17].

use nalgebra::DMatrix;

use crate::chain::system::System;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{column_space, rows_certainly_independent};
use crate::model::chain::{Chain, Role};

/// Scaled Jacobian of the `n` coordinates, 6 x n.
pub fn scaled_jacobian(system: &System, scales: &[f64]) -> DMatrix<f64> {
    let n = system.spring_torque.len();
    DMatrix::from_fn(6, n, |i, j| {
        system.jacobian[(i, j)] * scales[i] * scales[6 + j]
    })
}

/// Basis of the coordinates' motions that move only passive joints and leave the tip where it is,
/// n x k, scaled.
pub(crate) fn passive_null_space(chain: &Chain, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let passive = chain.indices_of(Role::Passive);
    let n = jacobian.ncols();
    if passive.is_empty() {
        return DMatrix::zeros(n, 0);
    }
    let own = jacobian.select_columns(&passive);
    if rows_certainly_independent(&own.transpose()) {
        return DMatrix::zeros(n, 0);
    }
    let rows = column_space(&own.transpose());
    if rows.ncols() == passive.len() {
        return DMatrix::zeros(n, 0);
    }
    let null = complement(&rows);
    let mut basis = DMatrix::zeros(n, null.ncols());
    for (k, &index) in passive.iter().enumerate() {
        basis.row_mut(index).copy_from(&null.row(k));
    }
    basis
}

/// Names of the coordinates with a share of at least a tenth in any column.
pub(crate) fn names_in(chain: &Chain, basis: &DMatrix<f64>) -> Vec<String> {
    (0..basis.nrows())
        .filter(|&i| basis.row(i).amax() > 0.1)
        .map(|i| chain.coordinates()[i].name.clone())
        .collect()
}
