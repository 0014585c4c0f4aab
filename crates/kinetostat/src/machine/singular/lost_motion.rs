//! Nearest posture where a limb loses a motion, searched in its joints [R 5.5.3].
//!
//! A lost motion is a border of the workspace: in motions of the tool the singular value falls with
//! the root of the distance and beyond there is nothing. In motions of the joints it falls evenly and
//! goes on beyond, so Newton on all joints finds the place: least motion of the tool with the limbs
//! closed and the singular value zero.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::linalg::singular_values::{SingularValues, shortest_and_free};
use crate::linalg::sparse::largest;
use crate::machine::constraints::limb_motions;
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::network::ends;
use crate::machine::posture::Posture;
use crate::model::chain::{Chain, Role};
use crate::number::larger;
use crate::spatial::{MotionKind, Pose, Twist, moved, pose_residual};

/// A limb is singular where its singular value is at most this share of the largest.
pub(crate) const SINGULAR: f64 = 1e-8;

/// Below this share a singular vector is not distinguished from those that are always singular; from here
/// all of them are brought to zero together.
const UNCLEAR: f64 = 1e-6;

/// Motion that a limb loses.
pub(crate) struct LostMotion {
    pub limb: usize,
    /// Singular value here as a share of the largest.
    pub share: f64,
    /// Motion of the tool from here to there.
    pub towards: Vector6<f64>,
    /// The singular posture was found; if not, it is of first order.
    pub followed: bool,
    /// Motion of the limb's tip that is lost there.
    pub motion: Vector6<f64>,
}

/// Joint axes of one limb: singular values falling.
struct Axes {
    matrix: DMatrix<f64>,
    values: Vec<f64>,
    /// All six.
    left: DMatrix<f64>,
    /// All of the joints.
    right: DMatrix<f64>,
}

impl Axes {
    fn of(matrix: DMatrix<f64>) -> Option<Self> {
        if matrix.ncols() == 0 || matrix.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let own = SingularValues::of(&matrix);
        Some(Self {
            matrix,
            left: own.all_left(),
            right: own.all_right(),
            values: own.values,
        })
    }

    fn rank(&self) -> usize {
        self.values
            .iter()
            .filter(|v| **v > SINGULAR * self.values[0])
            .count()
    }
}

/// Joints of a limb in the order of [`limb_motions`], moved by scaled amounts.
fn step_joints(chain: &Chain, joints: &mut LimbPosture, by: &[f64], length: f64) {
    let unit = |kind: MotionKind| match kind {
        MotionKind::Prismatic => 1.0,
        MotionKind::Revolute => length,
    };
    let passive = chain.indices_of(Role::Passive);
    for (&i, x) in passive.iter().zip(by) {
        joints.coordinates[i] += x / unit(chain.coordinates()[i].kind);
    }
    let own = joints.commands.iter_mut().zip(chain.actuators());
    for ((command, a), x) in own.zip(&by[passive.len()..]) {
        *command += x / unit(a.kind);
    }
}

/// A search on all joints of the machine.
pub(crate) struct LostMotionSearch<'p> {
    pub(crate) at: Posture,
    start: &'p Posture,
    pub(crate) length: f64,
    /// Unknowns: motions of platforms, then joints limb by limb.
    first: Vec<usize>,
    count: usize,
    /// Self-motions of the joints: not used.
    idle: DMatrix<f64>,
}

impl<'p> LostMotionSearch<'p> {
    pub(crate) fn new(start: &'p Posture) -> Self {
        let m = &start.mechanism;
        let length = m.scale().length;
        let mut count = 6 * (m.platforms().len() - 1);
        let mut first = Vec::new();
        for limb in m.limbs() {
            first.push(count);
            count += limb.nominal.indices_of(Role::Passive).len() + limb.nominal.actuators().len();
        }
        Self {
            at: start.clone(),
            start,
            length,
            first,
            count,
            idle: DMatrix::zeros(0, count),
        }
    }

    /// Restarts the search.
    pub(crate) fn again(&self) -> Self {
        Self::new(self.start)
    }

    fn joints(&self, limb: usize) -> std::ops::Range<usize> {
        self.first[limb]..self.first.get(limb + 1).copied().unwrap_or(self.count)
    }

    /// First unknown of the tool's motion.
    pub(crate) fn tool(&self) -> usize {
        6 * (self.at.mechanism.tool() - 1)
    }

    fn scaled(&self, twist: &Twist) -> DVector<f64> {
        DVector::from_fn(6, |i, _| twist.0[i] * if i < 3 { 1.0 } else { self.length })
    }

    /// Motion of the tool since the start.
    fn gone(&self) -> Twist {
        let tool = self.at.mechanism.tool();
        pose_residual(&self.at.platforms[tool], &self.start.platforms[tool])
    }

    /// Jacobian and residuals of the closures of all limbs.
    pub(crate) fn closure(&self) -> (DMatrix<f64>, DVector<f64>) {
        let m = &self.at.mechanism;
        let moving = m.platforms().len() - 1;
        let unit = |i: usize| if i % 6 < 3 { 1.0 } else { self.length };
        let mut rows = DMatrix::zeros(6 * m.limbs().len() + self.idle.nrows(), self.count);
        let mut residuals = DVector::zeros(rows.nrows());
        for (i, limb) in m.limbs().iter().enumerate() {
            let own = limb_motions(&self.at, i, true, self.length);
            rows.view_mut((6 * i, self.first[i]), own.shape())
                .copy_from(&own);
            let a = ends(&self.at.mechanism, &self.at.platforms, i).matrix(moving);
            for (r, c) in (0..6).flat_map(|r| (0..6 * moving).map(move |c| (r, c))) {
                rows[(6 * i + r, c)] = -a[(r, c)] * unit(r) / unit(c);
            }
            let joints = &self.at.limbs[i];
            let base = &self.at.platforms[limb.from];
            let tip = crate::model::kinematics::unloaded_tip(
                &limb.nominal,
                base,
                &joints.coordinates,
                &joints.commands,
            );
            let held: Pose = self.at.platforms[limb.to] * limb.platform_from_tip;
            let residual = self.scaled(&pose_residual(&held, &tip));
            residuals.rows_mut(6 * i, 6).copy_from(&residual);
        }
        rows.rows_mut(6 * m.limbs().len(), self.idle.nrows())
            .copy_from(&self.idle);
        (rows, residuals)
    }

    fn axes(&self, limb: usize) -> Option<Axes> {
        Axes::of(limb_motions(&self.at, limb, true, self.length))
    }

    /// Change of the joint axes with every joint of the limb, per scaled amount.
    fn changes(&self, limb: usize) -> Vec<DMatrix<f64>> {
        let step = 1e-5 * self.length;
        let chain = &self.at.mechanism.limbs()[limb].nominal;
        let n = self.joints(limb).len();
        let mut trial = self.at.clone();
        let mut moved_by = |j: usize, by: f64| {
            let mut amounts = vec![0.0; n];
            amounts[j] = by;
            trial.limbs[limb] = self.at.limbs[limb].clone();
            step_joints(chain, &mut trial.limbs[limb], &amounts, self.length);
            limb_motions(&trial, limb, true, self.length)
        };
        (0..n)
            .map(|j| (moved_by(j, step) - moved_by(j, -step)) / (2.0 * step))
            .collect()
    }

    /// Linear conditions on the joints of a limb that its singular value `which` be zero; rows over
    /// all unknowns, in metres.
    fn condition(&self, limb: usize, axes: &Axes, which: usize) -> (DMatrix<f64>, DVector<f64>) {
        let own = self.joints(limb);
        let changes = self.changes(limb);
        let value = axes.values[which];
        let clear = value > UNCLEAR * axes.values[0];
        // One entry, or where the vectors are unclear all that could make the rank larger.
        let last = |size: usize| if clear { which + 1 } else { size };
        let (rows, columns) = (last(axes.left.ncols()), last(axes.right.ncols()));
        let pairs: Vec<(usize, usize)> = (which..rows)
            .flat_map(|i| (which..columns).map(move |j| (i, j)))
            .collect();
        let mut all = DMatrix::zeros(pairs.len(), self.count);
        let mut values = DVector::zeros(pairs.len());
        for (row, &(i, j)) in pairs.iter().enumerate() {
            let (u, v) = (axes.left.column(i), axes.right.column(j));
            for (k, change) in changes.iter().enumerate() {
                all[(row, own.start + k)] = self.length * (change * v).dot(&u);
            }
            values[row] = self.length * (&axes.matrix * v).dot(&u);
        }
        if clear {
            return (all, values);
        }
        // Keeps those that really change.
        let u = SingularValues::of(&all).range(1e-4);
        (u.transpose() * all, u.transpose() * values)
    }

    /// Shortest motion of the tool from the start to the conditions, linearised: motion of all to the conditions, and
    /// motion on them.
    fn step(&self, condition: &DMatrix<f64>, value: &DVector<f64>) -> Option<[DVector<f64>; 2]> {
        let (closure, residuals) = self.closure();
        let count = closure.nrows() + condition.nrows();
        let mut rows = DMatrix::zeros(count, self.count);
        rows.rows_mut(0, closure.nrows()).copy_from(&closure);
        rows.rows_mut(closure.nrows(), condition.nrows())
            .copy_from(condition);
        let mut wanted = DVector::zeros(count);
        wanted.rows_mut(0, residuals.len()).copy_from(&residuals);
        wanted
            .rows_mut(residuals.len(), value.len())
            .copy_from(&-value);
        let (particular, free) = solve(&rows, &wanted)?;
        let tool = self.tool();
        let left = self.scaled(&self.gone()) + particular.rows(tool, 6);
        let moves = free.rows(tool, 6).into_owned();
        if moves.is_empty() {
            return Some([particular, DVector::zeros(self.count)]);
        }
        let own = SingularValues::of(&moves);
        let z = own.shortest(&-left, 1e-4 * own.largest().max(1e-3));
        Some([particular, free * z])
    }

    pub(crate) fn go(&mut self, step: &DVector<f64>) {
        let m = &self.at.mechanism;
        for p in 1..m.platforms().len() {
            let part = step.rows(6 * (p - 1), 6);
            let unit = |i: usize| if i < 3 { 1.0 } else { self.length };
            let twist = Twist(Vector6::from_fn(|i, _| part[i] / unit(i)));
            self.at.platforms[p] = moved(&self.at.platforms[p], &twist);
        }
        for (i, limb) in m.limbs().iter().enumerate() {
            let own = self.joints(i);
            let amounts = &step.as_slice()[own];
            step_joints(&limb.nominal, &mut self.at.limbs[i], amounts, self.length);
        }
        self.at.target = self.at.platforms[m.tool()];
    }

    /// Newton from the start with a limb's singular value `which` of `rank`; true if it ends at a
    /// singular posture, no farther than `most` (scaled).
    fn run(&mut self, limb: usize, which: usize, rank: usize, most: f64) -> Option<bool> {
        self.at = self.start.clone();
        let mut axes = self.axes(limb)?;
        let mut which = which;
        let mut before: Option<(DVector<f64>, DVector<f64>)> = None;
        for _ in 0..40 {
            if axes.values.len() < rank {
                return None;
            }
            // Follows the previous one, wherever it is in the order.
            if let Some((u, v)) = &before {
                let alike =
                    |k: &usize| (axes.left.column(*k).dot(u) * axes.right.column(*k).dot(v)).abs();
                which = (0..rank).max_by(|i, j| alike(i).total_cmp(&alike(j)))?;
            }
            if axes.values[rank - 1] <= UNCLEAR * axes.values[0] {
                which = rank - 1;
            }
            before = Some((
                axes.left.column(which).into_owned(),
                axes.right.column(which).into_owned(),
            ));
            let (condition, value) = self.condition(limb, &axes, which);
            let parts = self.step(&condition, &value)?;
            let size = parts.iter().map(largest).fold(0.0, larger);
            if !size.is_finite() {
                return None;
            }
            // Each in its bounds: near a lost motion the second may be long and must not hold up
            // the first.
            let short = |part: &DVector<f64>| part * (0.3 * self.length / part.amax()).min(1.0);
            self.go(&(short(&parts[0]) + short(&parts[1])));
            if self.scaled(&self.gone()).norm() > most {
                return Some(false);
            }
            axes = self.axes(limb)?;
            let singular = axes.values[rank - 1] <= SINGULAR * axes.values[0];
            let closed = largest(&self.closure().1) <= 1e-9 * self.length;
            if singular && closed && size <= 1e-7 * self.length {
                return Some(true);
            }
        }
        Some(false)
    }
}

/// Shortest solution and an orthonormal basis of what is left free.
pub(crate) fn solve(
    rows: &DMatrix<f64>,
    wanted: &DVector<f64>,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    shortest_and_free(rows, wanted, 1e-9)
}

impl Posture {
    /// Finds for every limb the nearest posture at most `within_m` away (scaled) where it loses a motion that its
    /// joints have in general.
    pub(crate) fn lost_motions(&self, within_m: f64) -> Vec<LostMotion> {
        let mut search = LostMotionSearch::new(self);
        let length = search.length;
        let motions = |search: &LostMotionSearch<'_>| {
            let (closure, residuals) = search.closure();
            let free = solve(&closure, &DVector::zeros(residuals.len()))?.1;
            let moves = free.rows(search.tool(), 6).into_owned();
            Some((free, moves))
        };
        let Some((mut free, mut moves)) = motions(&search) else {
            return Vec::new();
        };
        // Joints that move while the tool stays: they could take redundant limbs anywhere, and
        // platforms in series bring each other to a singular posture at no motion of the tool.
        if let Some((_, idle)) = solve(&moves, &DVector::zeros(6))
            && idle.ncols() > 0
        {
            search.idle = (&free * idle).transpose();
            let Some(others) = motions(&search) else {
                return Vec::new();
            };
            (free, moves) = others;
        }
        let mut found = Vec::new();
        for limb in 0..self.mechanism.limbs().len() {
            let (Some(here), rank) = (search.axes(limb), self.general_rank(limb, 0.05)) else {
                continue;
            };
            if rank == 0 {
                continue;
            }
            let share = here.values[rank - 1] / here.values[0];
            let singular = LostMotion {
                limb,
                share: 0.0,
                towards: Vector6::zeros(),
                followed: true,
                motion: Vector6::zeros(),
            };
            if share <= SINGULAR {
                let motion = self.lost(limb, rank);
                found.push(LostMotion { motion, ..singular });
                continue;
            }
            let mut nearest: Option<LostMotion> = None;
            let size = |towards: &Vector6<f64>| {
                towards
                    .fixed_rows::<3>(0)
                    .norm()
                    .max(towards.fixed_rows::<3>(3).norm() * length)
            };
            for which in (rank.saturating_sub(3)..rank).rev() {
                let (condition, value) = search.condition(limb, &here, which);
                let Some(first) = first_order(&moves, &(condition * &free), &value) else {
                    continue;
                };
                // Half as far where the singular value falls with the root of the distance; and
                // curved ways may be shorter still.
                if first.norm() > 8.0 * within_m {
                    continue;
                }
                let followed = search.run(limb, which, rank, 8.0 * within_m) == Some(true);
                let (way, motion) = if followed {
                    (search.gone().0, search.at.lost(limb, rank))
                } else if which + 1 == rank {
                    let unit = |i: usize| if i < 3 { 1.0 } else { length };
                    let u = here.left.column(which);
                    (
                        Vector6::from_fn(|i, _| first[i] / unit(i)),
                        Vector6::from_fn(|i, _| u[i] / unit(i)),
                    )
                } else {
                    continue;
                };
                search.at = self.clone();
                if size(&way) > within_m {
                    continue;
                }
                let next = LostMotion {
                    limb,
                    share,
                    towards: way,
                    followed,
                    motion,
                };
                let better = |old: &LostMotion| match (old.followed, followed) {
                    (false, true) => true,
                    (true, false) => false,
                    _ => size(&next.towards) < size(&old.towards),
                };
                if nearest.as_ref().is_none_or(better) {
                    nearest = Some(next);
                }
            }
            found.extend(nearest);
        }
        found
    }

    /// A limb with its joints moved a little, irregularly; the same amounts every time.
    fn beside(&self, limb: usize, by: f64, round: usize) -> Self {
        let length = self.mechanism.scale().length;
        let chain = &self.mechanism.limbs()[limb].nominal;
        let n = chain.indices_of(Role::Passive).len() + chain.actuators().len();
        let amounts: Vec<f64> = (0..n)
            .map(|j| by * length * (((round * 7 + j + 1) as f64 * 0.618_034).fract() - 0.5))
            .collect();
        let mut beside = self.clone();
        step_joints(chain, &mut beside.limbs[limb], &amounts, length);
        beside
    }

    /// Number of motions that a limb's joints have in general, around here.
    fn general_rank(&self, limb: usize, by: f64) -> usize {
        let length = self.mechanism.scale().length;
        let rank = |posture: &Self| {
            Axes::of(limb_motions(posture, limb, true, length)).map_or(0, |a| a.rank())
        };
        let around = (0..3).map(|round| rank(&self.beside(limb, by, round)));
        around.fold(rank(self), usize::max)
    }

    /// Motion of the tip that a limb cannot make at a singular posture and can make nearby.
    fn lost(&self, limb: usize, rank: usize) -> Vector6<f64> {
        let length = self.mechanism.scale().length;
        let near = self.beside(limb, 1e-6, 0);
        let axes = Axes::of(limb_motions(&near, limb, true, length));
        axes.map_or_else(Vector6::zeros, |axes| {
            let u = axes.left.column(rank - 1);
            Vector6::from_fn(|i, _| u[i] / if i < 3 { 1.0 } else { length })
        })
    }
}

/// Shortest motion of the tool (scaled) that brings `value` to zero, first order: `moves` of the tool and `change` of
/// the values, both per free motion.
fn first_order(
    moves: &DMatrix<f64>,
    change: &DMatrix<f64>,
    value: &DVector<f64>,
) -> Option<DVector<f64>> {
    if change.ncols() == 0 || value.is_empty() {
        return None;
    }
    let mut weights = moves.transpose() * moves;
    for i in 0..weights.nrows() {
        weights[(i, i)] += 1e-8;
    }
    let inverse = weights.cholesky()?.solve(&change.transpose());
    let across = (change * &inverse).try_inverse()?;
    Some(-(moves * inverse * across * value))
}
