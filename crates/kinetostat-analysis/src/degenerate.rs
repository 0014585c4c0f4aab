//! Equilibria at a limit, locked, or free to move.

use kinetostat::{
    ChainProblem, Prescribed, equilibrium::FoundEquilibrium, linalg::SingularValues,
    model::Kinematics, reference::shape_criterion, spatial::turn_matrix,
};
use nalgebra::DMatrix;

use crate::serial_chain::SerialChain;

/// True if an equilibrium is at a limit, locked, or one of a family of neutral equilibria.
///
/// The search calls an equilibrium singular by the condition of its equations, which is poor already where a chain is
/// nearly stretched and its forces are large. This function tells two causes apart: a held direction in which the chain
/// is locked (its joints move the tool there 1e-4 times less than elsewhere: within 0.006 degrees of the straight
/// line), or a motion that needs no force.
#[must_use]
pub fn is_degenerate(
    chain: &SerialChain,
    problem: &ChainProblem<'_>,
    f: &FoundEquilibrium,
) -> bool {
    if !f.singular {
        return false;
    }
    let e = &f.equilibrium;
    let length = chain.chain.scale().length;
    let Ok(criterion) = shape_criterion(problem, e, length) else {
        return true;
    };
    if !criterion.matrix.is_empty() {
        let modes = criterion.matrix.symmetric_eigen();
        let most = modes.eigenvalues.amax();
        let free = (0..modes.eigenvalues.len())
            .filter(|&k| modes.eigenvalues[k].abs() < 1e-7 * most)
            // A hinge at a free end turns alone and for nothing: that is no limit.
            .any(|k| (&criterion.basis * modes.eigenvectors.column(k)).amax() < 1.0 - 1e-6);
        if free {
            return true;
        }
    }
    // Motions of the end in the held directions: those that the chain can make somewhere, and here.
    let end = &problem.end;
    let held: Vec<usize> = (0..6)
        .filter(|&k| end.prescribed[k] == Prescribed::Pose)
        .collect();
    let turn = turn_matrix(&end.axes).transpose();
    let turn = DMatrix::from_fn(held.len(), 6, |i, j| turn[(held[i], j)]);
    let sizes = |motions: DMatrix<f64>| SingularValues::of(&(&turn * motions)).values;
    if held.is_empty() {
        return false;
    }
    let anywhere = sizes(chain.movable().basis);
    let rank = anywhere.iter().filter(|s| **s > 1e-6 * anywhere[0]).count();
    let kinematics = Kinematics::new(
        problem.chain,
        &problem.base,
        &e.coordinates,
        &problem.commands,
    );
    let mut here = kinematics.jacobian(problem.chain.tip());
    for mut column in here.column_iter_mut() {
        column.rows_mut(0, 3).unscale_mut(length);
        let size = column.norm();
        if size > 0.0 {
            column.unscale_mut(size);
        }
    }
    let here = sizes(DMatrix::from_fn(6, here.ncols(), |i, j| here[(i, j)]));
    rank > 0 && here.get(rank - 1).is_none_or(|s| *s < 1e-4 * here[0])
}

/// Rotations (rad) and displacements of springs (m) that differ by less are the same.
const SAME: f64 = 1e-6;

/// Keeps, among degenerate equilibria with equal coordinates, the one with the smallest wrench, and adds the starts
/// that ended at the others: a stretched, locked chain has one shape under every force along itself.
pub fn keep_one_of_each_shape(found: &mut Vec<FoundEquilibrium>) {
    let mut kept: Vec<FoundEquilibrium> = Vec::with_capacity(found.len());
    for next in found.drain(..) {
        let same = |own: &&mut FoundEquilibrium| {
            let pairs = own.equilibrium.coordinates.iter();
            let mut pairs = pairs.zip(&next.equilibrium.coordinates);
            own.singular && next.singular && pairs.all(|(a, b)| (a - b).abs() < SAME)
        };
        match kept.iter_mut().find(same) {
            Some(own) => {
                let size = |f: &FoundEquilibrium| f.equilibrium.wrench.0.norm();
                let hits = own.hits + next.hits;
                if size(&next) < size(own) {
                    *own = next;
                }
                own.hits = hits;
            }
            None => kept.push(next),
        }
    }
    *found = kept;
}
