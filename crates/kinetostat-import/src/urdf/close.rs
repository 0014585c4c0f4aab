//! Where everything stands at home, and the passive joints that close the loops there.

use kinetostat::{Pose, pose_residual};
use nalgebra::{DMatrix, DVector};

use crate::urdf::robot::Robot;
use crate::urdf::tree::{Step, Tree};

/// Poses of all links in the base link's frame for values of the variables (m, rad).
pub(crate) fn frames(robot: &Robot, tree: &Tree, base: usize, values: &[f64]) -> Vec<Pose> {
    let mut from_root = vec![Pose::identity(); robot.links.len()];
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); robot.links.len()];
    for (i, (parent, _)) in tree.ends.iter().enumerate() {
        children[*parent].push(i);
    }
    let mut open = vec![tree.root];
    while let Some(link) = open.pop() {
        for &joint in &children[link] {
            let child = tree.ends[joint].1;
            from_root[child] = product(&tree.joint_steps(robot, joint), from_root[link], values);
            open.push(child);
        }
    }
    let root = from_root[base].inverse();
    from_root.into_iter().map(|pose| root * pose).collect()
}

/// `start` times the factors.
pub(crate) fn product(steps: &[Step], start: Pose, values: &[f64]) -> Pose {
    steps
        .iter()
        .fold(start, |pose, step| pose * step.pose(values))
}

/// How far every loop is open: six numbers each, m and rad.
fn gaps(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<Step>)],
    values: &[f64],
) -> DVector<f64> {
    let frames = frames(robot, tree, base, values);
    let mut gaps = DVector::zeros(6 * closings.len());
    for (k, ([parent, child], steps)) in closings.iter().enumerate() {
        let reached = product(steps, frames[*parent], values);
        let gap = pose_residual(&frames[*child], &reached);
        gaps.rows_mut(6 * k, 6).copy_from(&gap.0);
    }
    gaps
}

/// Moves the `free` variables until all loops are closed; returns the distance (m) and the angle
/// (rad) that stay open in the worst of them.
pub(crate) fn close(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<Step>)],
    free: &[usize],
    values: &mut [f64],
) -> (f64, f64) {
    let mut gap = gaps(robot, tree, base, closings, values);
    let mut damping = 1e-6;
    for _ in 0..200 {
        if gap.amax() < 1e-14 {
            break;
        }
        let step = 1e-6;
        let mut jacobian = DMatrix::zeros(gap.len(), free.len());
        for (column, &v) in free.iter().enumerate() {
            let at = values[v];
            values[v] = at + step;
            let ahead = gaps(robot, tree, base, closings, values);
            values[v] = at - step;
            let behind = gaps(robot, tree, base, closings, values);
            values[v] = at;
            jacobian.set_column(column, &((ahead - behind) / (2.0 * step)));
        }
        let mut normal = jacobian.transpose() * &jacobian;
        for i in 0..free.len() {
            normal[(i, i)] += damping;
        }
        let Some(factor) = normal.cholesky() else {
            break;
        };
        let change = factor.solve(&(jacobian.transpose() * &gap));
        let before: Vec<f64> = free.iter().map(|v| values[*v]).collect();
        // No joint turns more than half a radian in one step.
        let most = change.amax().max(1e-300);
        let share = (0.5 / most).min(1.0);
        for (&v, d) in free.iter().zip(change.iter()) {
            values[v] -= share * d;
        }
        let next = gaps(robot, tree, base, closings, values);
        if next.norm() < gap.norm() {
            gap = next;
            damping = (0.1 * damping).max(1e-14);
        } else {
            for (&v, value) in free.iter().zip(before) {
                values[v] = value;
            }
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    (0..closings.len()).fold((0.0, 0.0), |(distance, angle): (f64, f64), k| {
        (
            distance.max(gap.rows(6 * k, 3).norm()),
            angle.max(gap.rows(6 * k + 3, 3).norm()),
        )
    })
}
