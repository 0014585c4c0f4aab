//! Poses of all links at home, and the passive joints that close the loops there.

use kinetostat::{Pose, number::larger, spatial::pose_residual};
use nalgebra::{DMatrix, DVector};

use crate::urdf::robot::Robot;
use crate::urdf::tree::{Tree, TreeStep};

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
pub(crate) fn product(steps: &[TreeStep], start: Pose, values: &[f64]) -> Pose {
    steps
        .iter()
        .fold(start, |pose, step| pose * step.pose(values))
}

/// Closure error of every loop: six numbers each, m and rad.
fn residuals(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<TreeStep>)],
    values: &[f64],
) -> DVector<f64> {
    let frames = frames(robot, tree, base, values);
    let mut residuals = DVector::zeros(6 * closings.len());
    for (k, ([parent, child], steps)) in closings.iter().enumerate() {
        let reached = product(steps, frames[*parent], values);
        let residual = pose_residual(&frames[*child], &reached);
        residuals.rows_mut(6 * k, 6).copy_from(&residual.0);
    }
    residuals
}

/// A variable that may move to close the loops, and what it is allowed.
pub(crate) struct Free {
    pub(crate) variable: usize,
    pub(crate) turns: bool,
    pub(crate) limits: Option<(f64, f64)>,
    /// A joint of the tree: of several ways to close the loops, the one in which these are nearest to
    /// their start is taken. Closing joints come as they come.
    pub(crate) in_tree: bool,
}

/// Starts besides the given one, from which other assemblies are looked for.
const STARTS: u64 = 40;
/// Robots with more links or free joints are closed from the given start only.
const MOST_LINKS: usize = 60;
const MOST_FREE: usize = 24;

/// Moves the `free` variables until all loops are closed; returns the distance (m) and the angle
/// (rad) that stay open in the worst of them. Most loops close in several ways: joints stay within
/// their limits and near to where they started, if they can.
pub(crate) fn close(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<TreeStep>)],
    free: &[Free],
    values: &mut [f64],
) -> (f64, f64) {
    let start = values.to_vec();
    let variables: Vec<usize> = free.iter().map(|f| f.variable).collect();
    let open = |residual: (f64, f64)| residual.0 > 1e-9 || residual.1 > 1e-9;
    // Open loops, joints outside their limits, distance from the start, in this order.
    let cost = |values: &[f64], residual: (f64, f64)| {
        let outside = free
            .iter()
            .filter(|f| {
                let x = values[f.variable];
                f.limits.is_some_and(|(low, high)| x < low || x > high)
            })
            .count();
        let away: f64 = free
            .iter()
            .filter(|f| f.in_tree)
            .map(|f| (values[f.variable] - start[f.variable]).powi(2))
            .sum();
        (open(residual), outside, away)
    };
    let mut residual = search(robot, tree, base, closings, &variables, values);
    wrap(free, values);
    let mut best = (cost(values, residual), values.to_vec());
    let starts = if robot.links.len() <= MOST_LINKS && free.len() <= MOST_FREE {
        STARTS
    } else {
        0
    };
    for attempt in 1..=starts {
        let mut trial = start.clone();
        for (k, f) in free.iter().enumerate() {
            // Evenly spread numbers in [-1, 1], the same in every run.
            let number =
                (attempt as f64 * 0.754_877_666 + (k as f64 + 1.0) * 0.569_840_291).fract();
            let spread = if f.turns { std::f64::consts::PI } else { 0.5 };
            trial[f.variable] += spread * (2.0 * number - 1.0);
        }
        let found = search(robot, tree, base, closings, &variables, &mut trial);
        wrap(free, &mut trial);
        let candidate = cost(&trial, found);
        if candidate.partial_cmp(&best.0) == Some(std::cmp::Ordering::Less) {
            residual = found;
            best = (candidate, trial);
        }
    }
    values.copy_from_slice(&best.1);
    residual
}

/// Turning joints within half a turn of zero.
fn wrap(free: &[Free], values: &mut [f64]) {
    for f in free.iter().filter(|f| f.turns) {
        let turn = std::f64::consts::TAU;
        values[f.variable] -= turn * (values[f.variable] / turn).round();
    }
}

fn search(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<TreeStep>)],
    free: &[usize],
    values: &mut [f64],
) -> (f64, f64) {
    let mut residual = residuals(robot, tree, base, closings, values);
    let mut damping = 1e-6;
    for _ in 0..200 {
        if residual.iter().all(|x| x.abs() < 1e-14) {
            break;
        }
        let step = 1e-6;
        let mut jacobian = DMatrix::zeros(residual.len(), free.len());
        for (column, &v) in free.iter().enumerate() {
            let at = values[v];
            values[v] = at + step;
            let ahead = residuals(robot, tree, base, closings, values);
            values[v] = at - step;
            let back = residuals(robot, tree, base, closings, values);
            values[v] = at;
            jacobian.set_column(column, &((ahead - back) / (2.0 * step)));
        }
        let mut normal = jacobian.transpose() * &jacobian;
        for i in 0..free.len() {
            normal[(i, i)] += damping;
        }
        let Some(factor) = normal.cholesky() else {
            break;
        };
        let change = factor.solve(&(jacobian.transpose() * &residual));
        let before: Vec<f64> = free.iter().map(|v| values[*v]).collect();
        // No joint turns more than half a radian in one step.
        let most = change.amax().max(1e-300);
        let share = (0.5 / most).min(1.0);
        for (&v, d) in free.iter().zip(change.iter()) {
            values[v] -= share * d;
        }
        let next = residuals(robot, tree, base, closings, values);
        if next.norm() < residual.norm() {
            residual = next;
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
            larger(distance, residual.rows(6 * k, 3).norm()),
            larger(angle, residual.rows(6 * k + 3, 3).norm()),
        )
    })
}
