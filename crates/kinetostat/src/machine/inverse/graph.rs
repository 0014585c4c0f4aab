//! Inverse kinematics of a graph: commands, passive joints and poses of all platforms for a pose of
//! the tool, from nominal geometry with springs at rest.
//!
//! The unknowns are eliminated limb by limb. With `c_i` the residual of the closure of limb `i`, `A_i` how
//! the motions `dP` of the platforms change that and `J_i` its motion by its own joints, the least
//! motion of joints that closes it is `J_i^T M_i s_i`, `M_i = (J_i J_i^T + damping)^-1`, `s_i = c_i +
//! A_i dP`. So a limb is a spring of matrix `M_i`, and the platforms find their places in a network
//! of such springs: `6 (P - 1)` unknowns, whatever the limbs are made of.
//!
//! Where actuators are redundant, the commands nearest to home are taken: the sum of squares of all
//! changes from home is least, rotations at the limb's natural length, passive joints counted with a
//! hundredth. It is a local minimum, found by the same network with limbs that are drawn home.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix6, Vector6};

use crate::error::{Error, Result};
use crate::linalg::block_elimination::{BlockFactors, FEW, Pivots};
use crate::linalg::sparse::{Sparse, largest};
use crate::machine::inverse::limb::{LimbPosture, inverse_kinematics};
use crate::model::chain::Role;
use crate::model::kinematics::Kinematics;
use crate::model::mechanism::Mechanism;
use crate::spatial::{MotionKind, Pose, Twist, moved, pose_residual, shift_matrix};

/// Joints of all limbs and poses of all platforms.
#[derive(Clone, Debug)]
pub(crate) struct GraphPosture {
    pub platforms: Vec<Pose>,
    pub limbs: Vec<LimbPosture>,
}

/// Weight of a passive joint relative to an actuator, in the sum of squares of motions.
const PASSIVE_WEIGHT: f64 = 1e-2;
/// Damping that leaves a step exact to ten digits.
const LEAST_DAMPING: f64 = 1e-10;
/// Steps of the way to a target next to the straight path.
const BESIDE_STEPS: u32 = 8;

/// The joints that bring the tool of the unloaded nominal machine to `target`, followed from
/// `start`, and failing that from home.
pub(crate) fn graph_inverse(
    mechanism: &Mechanism,
    target: &Pose,
    start: Option<&GraphPosture>,
) -> Result<GraphPosture> {
    let search = GraphSearch::new(mechanism);
    if let Some(start) = start {
        let mut at = start.clone();
        at.platforms[mechanism.tool()] = *target;
        if let Ok(found) = search.close(at) {
            return search.adjusted(found, true);
        }
        if let Ok(found) = search.by_continuation(start.clone(), target) {
            return search.adjusted(found, true);
        }
    }
    let home = search.home()?;
    let off = pose_residual(target, &home.platforms[mechanism.tool()]).0;
    if largest(&off) <= 1e-9 * search.length.max(1.0) {
        let mut found = home;
        found.platforms[mechanism.tool()] = *target;
        let found = search
            .close(found)
            .map_err(|_| search.unreachable(target, target))?;
        return search.adjusted(found, false);
    }
    let reached = match search.by_continuation(home.clone(), target) {
        Ok(found) => return search.adjusted(found, true),
        Err(reached) => reached,
    };
    match search.beside_the_line(home, target) {
        Some(found) => search.adjusted(found, true),
        None => Err(search.unreachable(target, &reached)),
    }
}

/// Tool pose after it is first brought as near to `target` as the joints can, then released so that all limbs close;
/// `None` where they do not.
pub(crate) fn graph_nearest(mechanism: &Mechanism, target: &Pose) -> Option<Pose> {
    let mut search = GraphSearch::new(mechanism);
    let mut platforms: Vec<Pose> = mechanism.platforms().iter().map(|p| p.home).collect();
    platforms[mechanism.tool()] = *target;
    let limbs = mechanism.limbs().iter().map(|limb| LimbPosture {
        commands: limb.nominal.home_commands(),
        coordinates: limb.nominal.home_coordinates(),
    });
    let start = GraphPosture {
        platforms,
        limbs: limbs.collect(),
    };
    let near = match search.close(start) {
        Ok(_) => return Some(*target),
        Err(near) => near,
    };
    search.tool_free = true;
    let closed = search.close(near).ok()?;
    Some(closed.platforms[mechanism.tool()])
}

/// Motion of every limb's commands per motion of the tool (base axes, at its origin), r x 6 each:
/// the least motion of joints where there are several.
pub(crate) fn graph_rates(mechanism: &Mechanism, at: &GraphPosture) -> Vec<DMatrix<f64>> {
    let search = GraphSearch::new(mechanism);
    let network = search.network(at, LEAST_DAMPING, None);
    let mut rates: Vec<DMatrix<f64>> = mechanism
        .limbs()
        .iter()
        .map(|l| DMatrix::zeros(l.nominal.actuators.len(), 6))
        .collect();
    let Some(factorised) = search.factorised(&network) else {
        return rates;
    };
    for direction in 0..6 {
        let mut unit = Vector6::zeros();
        unit[direction] = search.units()[direction];
        let Some((_, joints)) = search.solve(&factorised, Some(&unit)) else {
            continue;
        };
        for ((limb, own), (rate, own_joints)) in mechanism
            .limbs()
            .iter()
            .zip(&network)
            .zip(rates.iter_mut().zip(&joints))
        {
            let passive = own.kinds.len() - limb.nominal.actuators.len();
            for k in 0..rate.nrows() {
                rate[(k, direction)] = own_joints[passive + k] / own.weights[passive + k];
            }
        }
    }
    rates
}

/// A limb as a spring between two platforms, rotations at the natural length.
struct Linked {
    /// Motion of the tip by the weighted joints, 6 x k.
    jacobian: DMatrix<f64>,
    /// `(J J^T + damping)^-1`.
    matrix: Matrix6<f64>,
    /// Change of the closure with the motions of `to` and `from`.
    by_to: Matrix6<f64>,
    by_from: Matrix6<f64>,
    /// Closure residual of the tip, less what the pull to home closes.
    closure: Vector6<f64>,
    /// Pull to home, weighted joints.
    pull: DVector<f64>,
    /// Weight of every joint: passive ones, then actuators.
    weights: Vec<f64>,
    kinds: Vec<MotionKind>,
}

/// A network factorised for any residual.
struct Factorised<'n> {
    network: &'n [Linked],
    /// First unknown of every platform that is sought.
    place: Vec<Option<usize>>,
    factors: NetworkFactors,
}

enum NetworkFactors {
    Empty,
    Dense(Cholesky<f64, Dyn>),
    Blocks(BlockFactors),
}

/// Motions of all platforms and of the joints of all limbs.
type Moves = (Vec<Vector6<f64>>, Vec<DVector<f64>>);

struct GraphSearch<'m> {
    mechanism: &'m Mechanism,
    passive: Vec<Vec<usize>>,
    length: f64,
    /// The tool is sought like the other platforms.
    tool_free: bool,
}

impl<'m> GraphSearch<'m> {
    fn new(mechanism: &'m Mechanism) -> Self {
        Self {
            mechanism,
            passive: mechanism
                .limbs()
                .iter()
                .map(|l| l.nominal.indices_of(Role::Passive))
                .collect(),
            length: mechanism.scale().length,
            tool_free: false,
        }
    }

    fn units(&self) -> [f64; 6] {
        let l = self.length;
        [1.0, 1.0, 1.0, l, l, l]
    }

    /// Home of the model with every limb closed where the platforms are meant to be.
    fn home(&self) -> Result<GraphPosture> {
        let m = self.mechanism;
        let platforms: Vec<Pose> = m.platforms().iter().map(|p| p.home).collect();
        let closed: Result<Vec<LimbPosture>> = m
            .limbs()
            .iter()
            .map(|limb| {
                let tip = platforms[limb.to] * limb.platform_from_tip;
                inverse_kinematics(&limb.nominal, &platforms[limb.from], &tip, None)
            })
            .collect();
        let error = match closed {
            Ok(limbs) => return Ok(GraphPosture { platforms, limbs }),
            Err(error) => error,
        };
        // Platforms written down roughly: they find their own places, the tool excepted.
        let limbs = m.limbs().iter().map(|limb| LimbPosture {
            commands: limb.nominal.home_commands(),
            coordinates: limb.nominal.home_coordinates(),
        });
        let rough = GraphPosture {
            platforms,
            limbs: limbs.collect(),
        };
        self.close(rough).map_err(|_| error)
    }

    fn unreachable(&self, target: &Pose, nearest: &Pose) -> Error {
        let residual = pose_residual(target, nearest);
        Error::Unreachable {
            place: self.mechanism.place(),
            distance_m: residual.linear().norm(),
            angle_rad: residual.angular().norm(),
            nearest: Box::new(*nearest),
        }
    }

    /// Follows the straight path to the target; `Err` holds the last pose of the tool reached.
    fn by_continuation(
        &self,
        from: GraphPosture,
        target: &Pose,
    ) -> std::result::Result<GraphPosture, Pose> {
        let tool = self.mechanism.tool();
        let start = from.platforms[tool];
        let motion = pose_residual(target, &start);
        let (mut at, mut share, mut step) = (from, 0.0_f64, 0.125_f64);
        while share < 1.0 {
            let next = (share + step).min(1.0);
            let mut trial = at.clone();
            trial.platforms[tool] = if next == 1.0 {
                *target
            } else {
                moved(&start, &Twist(motion.0 * next))
            };
            match self.close(trial) {
                Ok(found) => {
                    (at, share) = (found, next);
                    step = (1.5 * step).min(0.25);
                }
                Err(_) => {
                    step *= 0.5;
                    if step < 1.0 / 512.0 {
                        return Err(at.platforms[tool]);
                    }
                }
            }
        }
        Ok(at)
    }

    /// Follows the poses that the machine can take next to the straight path to the target. With fewer than six freedoms it
    /// cannot take those on the path, though it can take both ends.
    fn beside_the_line(&self, from: GraphPosture, target: &Pose) -> Option<GraphPosture> {
        let free = Self {
            tool_free: true,
            ..Self::new(self.mechanism)
        };
        let tool = self.mechanism.tool();
        let start = from.platforms[tool];
        let motion = pose_residual(target, &start);
        let mut at = from;
        for step in 1..BESIDE_STEPS {
            let share = f64::from(step) / f64::from(BESIDE_STEPS);
            at.platforms[tool] = moved(&start, &Twist(motion.0 * share));
            at = match self.close(at) {
                Ok(on_the_path) => on_the_path,
                // The joints are as near to the path as they come: let go, the tool is where they lead.
                Err(near) => free.close(near).ok()?,
            };
        }
        at.platforms[tool] = *target;
        self.close(at).ok()
    }

    /// All limbs linearised; `home` draws their joints there.
    fn network(&self, at: &GraphPosture, damping: f64, home: Option<&GraphPosture>) -> Vec<Linked> {
        let m = self.mechanism;
        let units = self.units();
        (0..m.limbs().len())
            .map(|i| {
                let (limb, joints) = (&m.limbs()[i], &at.limbs[i]);
                let chain = &limb.nominal;
                let base = &at.platforms[limb.from];
                let (x, commands) = (&joints.coordinates, &joints.commands);
                let kinematics = Kinematics::of_limb(chain, base, x, commands, limb.from != 0);
                let all = kinematics.jacobian(chain.tip());
                let (n, r) = (chain.coordinate_count(), commands.len());
                let own = chain.scale().length;
                let (mut columns, mut kinds, mut weights) = (Vec::new(), Vec::new(), Vec::new());
                let size = |kind: MotionKind| match kind {
                    MotionKind::Prismatic => 1.0,
                    MotionKind::Revolute => own,
                };
                for &j in &self.passive[i] {
                    let kind = chain.coordinates()[j].kind;
                    columns.push(j);
                    weights.push(size(kind) * PASSIVE_WEIGHT.sqrt());
                    kinds.push(kind);
                }
                for (j, actuator) in chain.actuators().iter().enumerate() {
                    columns.push(n + j);
                    weights.push(size(actuator.kind));
                    kinds.push(actuator.kind);
                }
                let jacobian = DMatrix::from_fn(6, columns.len(), |k, j| {
                    all[(k, columns[j])] * units[k] / weights[j]
                });
                let tip = kinematics.tip_pose();
                let target = at.platforms[limb.to] * limb.platform_from_tip;
                let residual = pose_residual(&target, &tip).0;
                let mut closure = Vector6::from_fn(|k, _| residual[k] * units[k]);
                let mut pull = DVector::zeros(columns.len());
                if let Some(home) = home {
                    let there = &home.limbs[i];
                    let passive = self.passive[i].len();
                    for (j, weight) in weights.iter().enumerate() {
                        let distance = match self.passive[i].get(j) {
                            Some(&c) => {
                                let d = there.coordinates[c] - joints.coordinates[c];
                                match kinds[j] {
                                    MotionKind::Revolute => shortest(d),
                                    MotionKind::Prismatic => d,
                                }
                            }
                            None => there.commands[j - passive] - joints.commands[j - passive],
                        };
                        pull[j] = distance * weight;
                    }
                    closure -= &jacobian * &pull;
                }
                let gram = &jacobian * jacobian.transpose();
                let gram = Matrix6::from_fn(|a, b| gram[(a, b)]);
                let size = gram.trace().max(1.0);
                let matrix = (gram + Matrix6::identity() * (damping * size))
                    .cholesky()
                    .map_or_else(Matrix6::identity, |c| c.inverse());
                let scaled =
                    |t: Matrix6<f64>| Matrix6::from_fn(|a, b| t[(a, b)] * units[a] / units[b]);
                let arm =
                    at.platforms[limb.to].rotation * limb.platform_from_tip.translation.vector;
                let by_from = if limb.from == 0 {
                    Matrix6::zeros()
                } else {
                    scaled(-all.fixed_columns::<6>(n + r).into_owned())
                };
                Linked {
                    jacobian,
                    matrix,
                    by_to: scaled(shift_matrix(&arm)),
                    by_from,
                    closure,
                    pull,
                    weights,
                    kinds,
                }
            })
            .collect()
    }

    /// The network of springs, factorised for the platforms that are sought: not the base, and the
    /// tool only where it is free.
    fn factorised<'n>(&self, network: &'n [Linked]) -> Option<Factorised<'n>> {
        let m = self.mechanism;
        let count = m.platforms().len();
        let place: Vec<Option<usize>> = (0..count)
            .scan(0, |next, p| {
                Some((p != 0 && (self.tool_free || p != m.tool())).then(|| {
                    *next += 6;
                    *next - 6
                }))
            })
            .collect();
        let size = 6 * place.iter().flatten().count();
        let mut a = Sparse::zeros(size, size);
        for (limb, own) in m.limbs().iter().zip(network) {
            let ends = [
                (place[limb.to], &own.by_to),
                (place[limb.from], &own.by_from),
            ];
            for (row, by_row) in ends {
                let Some(row) = row else { continue };
                let pull = by_row.transpose() * own.matrix;
                for (column, by_column) in ends {
                    let Some(column) = column else { continue };
                    a.add(row, column, &(pull * by_column));
                }
            }
        }
        let factors = if size > 6 * FEW {
            let nodes: Vec<usize> = (0..size).map(|i| i / 6).collect();
            let blocks = BlockFactors::new(&a, &nodes, &vec![1.0; size], Pivots::Definite)?;
            NetworkFactors::Blocks(blocks)
        } else if size > 0 {
            NetworkFactors::Dense(a.dense().cholesky()?)
        } else {
            NetworkFactors::Empty
        };
        Some(Factorised {
            network,
            place,
            factors,
        })
    }

    /// Motions of all platforms (scaled; base and tool do not move, or the tool by `tool_motion`
    /// with all closures at zero) and of all weighted joints.
    fn solve(&self, own: &Factorised<'_>, tool_motion: Option<&Vector6<f64>>) -> Option<Moves> {
        let m = self.mechanism;
        let (network, place) = (own.network, &own.place);
        let count = m.platforms().len();
        let mut b = DMatrix::zeros(6 * place.iter().flatten().count(), 1);
        let closure_of = |limb: usize| match tool_motion {
            None => network[limb].closure,
            Some(motion) => {
                let (description, own) = (&m.limbs()[limb], &network[limb]);
                let mut s = Vector6::zeros();
                if description.to == m.tool() {
                    s += own.by_to * motion;
                }
                if description.from == m.tool() {
                    s += own.by_from * motion;
                }
                s
            }
        };
        for (i, (limb, own)) in m.limbs().iter().zip(network).enumerate() {
            let pull = own.matrix * closure_of(i);
            for (row, by_row) in [
                (place[limb.to], &own.by_to),
                (place[limb.from], &own.by_from),
            ] {
                let Some(row) = row else { continue };
                let mut part = b.fixed_view_mut::<6, 1>(row, 0);
                part -= by_row.transpose() * pull;
            }
        }
        match &own.factors {
            NetworkFactors::Empty => {}
            NetworkFactors::Dense(factors) => factors.solve_mut(&mut b),
            NetworkFactors::Blocks(factors) => factors.solve(&mut b),
        }
        let mut motions = vec![Vector6::zeros(); count];
        for (motion, place) in motions.iter_mut().zip(place) {
            if let Some(at) = place {
                motion.copy_from(&b.fixed_view::<6, 1>(*at, 0));
            }
        }
        let joints: Vec<DVector<f64>> = m
            .limbs()
            .iter()
            .zip(network)
            .enumerate()
            .map(|(i, (limb, own))| {
                let s =
                    closure_of(i) + own.by_to * motions[limb.to] + own.by_from * motions[limb.from];
                let pull = if tool_motion.is_some() { 0.0 } else { 1.0 };
                own.jacobian.transpose() * (own.matrix * s) + &own.pull * pull
            })
            .collect();
        let finite = joints.iter().all(|j| j.iter().all(|x| x.is_finite()));
        finite.then_some((motions, joints))
    }

    /// The step that closes all limbs.
    fn step(&self, network: &[Linked]) -> Option<Moves> {
        self.solve(&self.factorised(network)?, None)
    }

    fn moved_by(
        &self,
        at: &GraphPosture,
        network: &[Linked],
        motions: &[Vector6<f64>],
        joints: &[DVector<f64>],
        length: f64,
    ) -> GraphPosture {
        let units = self.units();
        let mut next = at.clone();
        for (pose, motion) in next.platforms.iter_mut().zip(motions) {
            if *motion != Vector6::zeros() {
                let twist = Vector6::from_fn(|k, _| length * motion[k] / units[k]);
                *pose = moved(pose, &Twist(twist));
            }
        }
        for (i, own) in network.iter().enumerate() {
            let passive = &self.passive[i];
            for (k, step) in joints[i].iter().enumerate() {
                let change = length * step / own.weights[k];
                match passive.get(k) {
                    Some(&c) => next.limbs[i].coordinates[c] += change,
                    None => next.limbs[i].commands[k - passive.len()] += change,
                }
            }
        }
        next
    }

    /// Share of a step that keeps rotations below half a radian and slides below the length.
    fn limit(&self, network: &[Linked], motions: &[Vector6<f64>], joints: &[DVector<f64>]) -> f64 {
        let mut length = 1.0_f64;
        for (own, steps) in network.iter().zip(joints) {
            for ((step, weight), kind) in steps.iter().zip(&own.weights).zip(&own.kinds) {
                let most = match kind {
                    MotionKind::Revolute => 0.5,
                    MotionKind::Prismatic => self.length,
                };
                length = length.min(most * weight / step.abs().max(1e-300));
            }
        }
        for motion in motions {
            let turn = motion.fixed_rows::<3>(3).norm() / self.length;
            let slide = motion.fixed_rows::<3>(0).norm();
            length = length.min(0.5 / turn.max(1e-300));
            length = length.min(self.length / slide.max(1e-300));
        }
        length
    }

    fn closure_residual(network: &[Linked]) -> f64 {
        network
            .iter()
            .map(|l| l.closure.norm_squared())
            .sum::<f64>()
            .sqrt()
    }

    /// Closes all limbs with the tool where it is, unless it is free. `Err` holds the best that was
    /// found.
    fn close(&self, mut at: GraphPosture) -> std::result::Result<GraphPosture, GraphPosture> {
        let mut damping = LEAST_DAMPING;
        let mut network = self.network(&at, damping, None);
        let goal = 1e-13 * self.length * (network.len() as f64).sqrt();
        let mut polished = false;
        for _ in 0..100 {
            let closure_residual = Self::closure_residual(&network);
            if closure_residual <= goal || (polished && closure_residual <= 100.0 * goal) {
                return Ok(at);
            }
            let Some((motions, joints)) = self.step(&network) else {
                return Err(at);
            };
            let length = self.limit(&network, &motions, &joints);
            let trial = self.moved_by(&at, &network, &motions, &joints, length);
            let next = self.network(&trial, damping, None);
            let left = Self::closure_residual(&next);
            if left < closure_residual {
                polished = left > 0.5 * closure_residual;
                at = trial;
                network = next;
                if damping > LEAST_DAMPING {
                    damping = (0.1 * damping).max(LEAST_DAMPING);
                    network = self.network(&at, damping, None);
                }
            } else {
                if closure_residual <= 1e3 * goal {
                    return Ok(at);
                }
                damping = (10.0 * damping).max(1e-8);
                if damping > 1e6 || damping.is_nan() {
                    return Err(at);
                }
                network = self.network(&at, damping, None);
            }
        }
        Err(at)
    }

    /// Distance from home in weighted joints.
    fn away(&self, at: &GraphPosture, home: &GraphPosture) -> f64 {
        let network = self.network(at, LEAST_DAMPING, Some(home));
        network
            .iter()
            .map(|l| l.pull.norm_squared())
            .sum::<f64>()
            .sqrt()
    }

    /// The joints nearest to home among those that close, in the turn that the limits ask for.
    fn adjusted(&self, at: GraphPosture, redundant: bool) -> Result<GraphPosture> {
        let mut at = at;
        if redundant && self.can_move_inside(&at) {
            let home = self.home()?;
            let mut distance = self.away(&at, &home);
            let mut share = 1.0_f64;
            for _ in 0..200 {
                let network = self.network(&at, LEAST_DAMPING, Some(&home));
                let Some((motions, joints)) = self.step(&network) else {
                    break;
                };
                let size = joints.iter().map(DVector::norm_squared).sum::<f64>().sqrt();
                if size <= 1e-9 * self.length {
                    break;
                }
                let length = share * self.limit(&network, &motions, &joints);
                let trial = self.moved_by(&at, &network, &motions, &joints, length);
                let nearer = self.close(trial).ok().and_then(|next| {
                    let left = self.away(&next, &home);
                    (left < distance).then_some((next, left))
                });
                match nearer {
                    Some((next, left)) => {
                        (at, distance) = (next, left);
                        share = (2.0 * share).min(1.0);
                    }
                    None => {
                        share *= 0.5;
                        if share < 1e-3 {
                            break;
                        }
                    }
                }
            }
        }
        Ok(self.wrapped(at))
    }

    /// Joints can move while the tool stays: a probe, not a count.
    fn can_move_inside(&self, at: &GraphPosture) -> bool {
        let mut drawn = at.clone();
        for (i, limb) in drawn.limbs.iter_mut().enumerate() {
            for (k, command) in limb.commands.iter_mut().enumerate() {
                *command += 0.1 + 0.07 * ((i * 7 + k * 3 + 1) as f64 * 0.618_034).fract();
            }
        }
        let network = self.network(at, LEAST_DAMPING, Some(&drawn));
        self.step(&network).is_some_and(|(_, joints)| {
            let moved = joints.iter().map(DVector::norm_squared).sum::<f64>().sqrt();
            let drawn = network.iter().map(|l| l.pull.norm_squared()).sum::<f64>();
            moved > 1e-6 * drawn.sqrt()
        })
    }

    /// Passive rotations in (-pi, pi]; actuators with limits in the turn nearest to their range.
    fn wrapped(&self, mut at: GraphPosture) -> GraphPosture {
        for (limb, joints) in self.mechanism.limbs().iter().zip(&mut at.limbs) {
            crate::machine::inverse::limb::wrap(&limb.nominal, joints);
        }
        at
    }
}

/// Equivalent angle in (-pi, pi].
fn shortest(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * (angle / turn).round()
}
