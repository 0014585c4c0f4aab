//! The stiffness of the springs' material, without what their loads add, and the units in which it is one.

use nalgebra::DMatrix;

use crate::chain::system::System;
use crate::model::chain::Chain;

/// The springs' own stiffness, without what their loads add to it as they move (geometric), scaled, n x n.
pub(crate) fn material_springs(system: &System, scales: &[f64]) -> DMatrix<f64> {
    let n = system.spring_torque.len();
    let mut springs = DMatrix::from_fn(n, n, |i, j| {
        system.spring_tangent[(i, j)] * scales[6 + i] * scales[6 + j]
    });
    without_geometric(system, scales, &mut springs);
    springs
}

/// Takes the geometric stiffness of springs out of a scaled matrix, n x n.
pub(crate) fn without_geometric(system: &System, scales: &[f64], a: &mut DMatrix<f64>) {
    for &(first, matrix) in &system.spring_geometric {
        for i in 0..6 {
            for j in 0..6 {
                let (row, column) = (first + i, first + j);
                a[(row, column)] -= matrix[(i, j)] * scales[6 + row] * scales[6 + column];
            }
        }
    }
}

/// `C A C^T` of a change of rows `C`.
pub(crate) fn on_both_sides(
    mut a: DMatrix<f64>,
    of_rows: impl Fn(&mut DMatrix<f64>),
) -> DMatrix<f64> {
    for _ in 0..2 {
        of_rows(&mut a);
        a = a.transpose();
    }
    a
}

/// Units in which the material stiffness `K' = L L^T` of every spring is one: an axis that is worlds
/// stiffer than bending would otherwise drown it. Passive coordinates keep theirs.
pub(crate) struct MaterialUnits(Vec<(usize, DMatrix<f64>)>);

impl MaterialUnits {
    /// A block that is not positive definite keeps its units.
    pub fn of(chain: &Chain, springs: &DMatrix<f64>) -> Self {
        let blocks = chain.springs().iter().filter_map(|block| {
            let (first, len) = (block.first, block.len());
            let own = springs.view((first, first), (len, len)).into_owned();
            Some((first, own.cholesky()?.l()))
        });
        Self(blocks.collect())
    }

    /// Forces of the coordinates, one column each, in these units: `L^-1 f`.
    pub fn gather(&self, forces: &mut DMatrix<f64>) {
        for (first, l) in &self.0 {
            // A pivot of a Cholesky factor is positive.
            let _ = l.solve_lower_triangular_mut(&mut forces.rows_mut(*first, l.nrows()));
        }
    }

    /// A stiffness in these units: `L^-1 K L^-T`.
    pub fn both(&self, stiffness: DMatrix<f64>) -> DMatrix<f64> {
        on_both_sides(stiffness, |rows| self.gather(rows))
    }

    /// The material stiffness itself: one, but for the blocks that keep their units.
    pub fn stiffness(&self, mut springs: DMatrix<f64>) -> DMatrix<f64> {
        for (first, l) in &self.0 {
            let size = (l.nrows(), l.nrows());
            springs
                .view_mut((*first, *first), size)
                .fill_with_identity();
        }
        springs
    }

    /// Motions in these units, one column each, as those of the coordinates: `L^-T y`.
    pub fn motions(&self, mut motions: DMatrix<f64>) -> DMatrix<f64> {
        for (first, l) in &self.0 {
            let _ = l.tr_solve_lower_triangular_mut(&mut motions.rows_mut(*first, l.nrows()));
        }
        motions
    }
}
