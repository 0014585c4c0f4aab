//! Reasons why a chain has no equilibrium that follow from the problem itself.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::{motion_description, scaled_twist};
use crate::chain::potential::prescribed_wrench;
use crate::chain::problem::{ChainProblem, Prescribed};
use crate::chain::system::System;
use crate::error::Error;
use crate::linalg::complement::complement;
use crate::linalg::singular_values::range;
use crate::model::chain::Role;
use crate::model::kinematics::{Kinematics, unloaded_tip};
use crate::number::larger;
use crate::spatial::{MotionKind, pose_residual, turn_matrix};

/// The reason, if it is one of those that no iteration can change.
pub(crate) fn why(problem: &ChainProblem<'_>) -> Option<Error> {
    held_outside(problem).or_else(|| pushed_slide(problem))
}

/// Directions of the end condition that are of one kind, base axes, 6 x k.
fn directions_of(problem: &ChainProblem<'_>, wanted: Prescribed) -> DMatrix<f64> {
    let turn = turn_matrix(&problem.end.axes);
    let own: Vec<usize> = (0..6)
        .filter(|&k| problem.end.prescribed[k] == wanted)
        .collect();
    DMatrix::from_fn(6, own.len(), |i, j| turn[(i, own[j])])
}

/// The end is held beside everything that the chain can reach (a planar chain out of its plane).
fn held_outside(problem: &ChainProblem<'_>) -> Option<Error> {
    let chain = problem.chain;
    let (n, length) = (chain.coordinate_count(), chain.scale().length);
    let held = directions_of(problem, Prescribed::Pose);
    if held.ncols() == 0 || n == 0 {
        return None;
    }
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    // Motions of the end in irregular postures around the given one.
    let mut all = DMatrix::zeros(6, 3 * n);
    for k in 0..3 {
        let moved = |(i, x): (usize, &f64)| {
            let unit = match chain.coordinates()[i].kind {
                MotionKind::Prismatic => 0.1 * length,
                MotionKind::Revolute => 1.0,
            };
            x + k as f64 * unit * (0.2 + 0.6 * ((i + k) as f64 * 0.618_034).fract())
        };
        let x: Vec<f64> = problem.posture.iter().enumerate().map(moved).collect();
        let here = Kinematics::new(chain, &problem.base, &x, &problem.commands);
        let jacobian = here.jacobian(chain.tip());
        for j in 0..n {
            let column = DVector::from_fn(6, |i, _| jacobian[(i, j)] * unit(i));
            let size = column.norm();
            if size > 0.0 {
                all.set_column(k * n + j, &(column / size));
            }
        }
    }
    let normals = complement(&range(&(held.transpose() * all), 1e-8));
    if normals.ncols() == 0 {
        return None;
    }
    let tip = unloaded_tip(chain, &problem.base, &problem.posture, &problem.commands);
    let off = pose_residual(&problem.end.pose, &tip);
    let off = DVector::from_fn(6, |i, _| off.0[i] * unit(i));
    let outside = &normals * (normals.transpose() * (held.transpose() * off));
    let outside = held * outside;
    if outside.norm() <= 1e-7 * length {
        return None;
    }
    let off = Vector6::from_fn(|i, _| outside[i]);
    let (distance, angle) = (
        off.fixed_rows::<3>(0).norm(),
        off.fixed_rows::<3>(3).norm() / length,
    );
    let motion = motion_description(&scaled_twist(chain.scale(), &off));
    Some(Error::model(
        chain.place(),
        format!(
            "the end is held {:.4} mm and {:.4} deg beside everything that the chain can reach: nothing in it {motion}; hold the end where the chain can take it, or prescribe a wrench in that direction",
            distance * 1e3,
            angle.to_degrees()
        ),
    ))
}

/// A load pushes a passive slide that nothing holds.
fn pushed_slide(problem: &ChainProblem<'_>) -> Option<Error> {
    let chain = problem.chain;
    let wrench = prescribed_wrench(problem);
    let held = directions_of(problem, Prescribed::Pose);
    let mut system = System::new(
        chain,
        &problem.base,
        &problem.posture,
        &problem.commands,
        false,
    );
    system.evaluate_problem(problem, &problem.posture, &wrench, 1.0);
    let length = chain.scale().length;
    let torques = (0..chain.coordinate_count()).map(|i| system.unbalanced(i).abs());
    let most = torques.fold(0.0_f64, larger);
    let free = chain.coordinates().iter().enumerate().find(|(i, c)| {
        let push = system.unbalanced(*i).abs();
        let column = DVector::from_fn(6, |k, _| system.jacobian[(k, *i)]);
        let other = (0..chain.coordinate_count()).map(|j| system.hessian[(*i, j)].abs());
        c.role == Role::Passive
            && c.kind == MotionKind::Prismatic
            && push > 1e-6 * most
            && (held.transpose() * column).norm() <= 1e-9
            && other.fold(0.0_f64, larger) * length <= 1e-9 * push
    })?;
    let push = system.unbalanced(free.0).abs();
    Some(Error::FreeDirection {
        place: chain.place(),
        reason: format!(
            "the load pushes the passive slide '{}' with {push:.4} N, and nothing holds it",
            free.1.name
        ),
        wrench: Box::new(wrench),
    })
}
