//! Equilibrium of the platforms of a mechanism [R 6.21-6.30].
//!
//! Each limb is condensed to what it answers at its end, `F_i` and its tangent; the platforms are
//! solved; the limbs follow. One such step equals one Newton step of the whole flattened system, so
//! nothing is lost, and a limb that fails is named.
//!
//! ```text
//! W = sum T_i^T F_i,     T_i = [I, -hat(s_i); 0, I]
//! K = sum T_i^T K_i T_i + sum blkdiag(0, hat(f_i) hat(s_i))      (second sum: missing in [R 5.28])
//! ```
//!
//! A limb that starts at a moving platform loads it with everything that acts on the limb; that
//! reaction and its derivative come from six motions of the limb's base.

use nalgebra::{DMatrix, Vector3, Vector6};

use crate::chain::directions::scaled_jacobian;
use crate::chain::equilibrium::{System, rounding, scales_of};
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::scaling::LEAST_LOAD;
use crate::chain::stability::{ShapeStability, shape_stability};
use crate::chain::stiffness::{ChainStiffness, chain_stiffness, motions_of_end};
use crate::chain::system::Hessian;
use crate::linalg::sparse::{Sparse, largest};
use crate::machine::inverse::graph::{GraphPosture, graph_inverse, graph_rates};
use crate::machine::inverse::limb::{LimbPosture, command_rates, inverse_kinematics};
use crate::machine::platforms::limb::Linear;
use crate::machine::platforms::parts::{EquilibriumRows, Guide, Unknowns};
use crate::machine::state::MechanismState;
use crate::model::chain::{Chain, Scale};
use crate::model::loads::load::Load;
use crate::model::mechanism::Mechanism;
use crate::number::larger;
use crate::settings::Settings;
use crate::spatial::{Pose, Twist, Wrench, pose_residual, shift_matrix};

/// A mechanism's equilibrium being solved.
pub(crate) struct PlatformSolver<'m> {
    pub mechanism: &'m Mechanism,
    pub settings: Settings,
    /// Wrench on the tool, about its origin, base axes.
    pub wrench: Wrench,
    /// Dead wrenches on other platforms, about their origins, base axes.
    pub others: Vec<(usize, Wrench)>,
    /// Joints of the commanded, unloaded posture.
    pub posture: Vec<LimbPosture>,
    pub unknowns: Unknowns,
    pub guide: Guide,
    /// Pose of the tool for which the limbs are commanded, t0.
    pub target: Pose,
    /// Poses of all platforms for which the limbs are commanded.
    pub nominal: Vec<Pose>,
    /// Motion of the commands per motion of the nominal target at its origin, per limb, r x 6.
    pub rates: Vec<DMatrix<f64>>,
    pub state: MechanismState,
    pub scales: Vec<Vec<f64>>,
    /// Loads on every limb between its ends: gravity and its own.
    pub loads: Vec<Vec<Load>>,
    pub linear: Vec<Linear>,
    /// Unbalanced wrench of the tool of a machine that is one chain, as it was linearised.
    pub equilibrium: Option<EquilibriumRows>,
    /// Closure at the start, kept while the load grows.
    pub offsets: Vec<Twist>,
    /// Limbs from the base outwards, where every moving platform has a single limb to it; else none.
    tree: Vec<usize>,
    /// The tool is moved to its place while the load grows, its limb after it.
    pub leads: bool,
    pub share: f64,
    /// Stiffness against motions of the platforms during a step, by the machine's.
    pub damping: f64,
    /// Method by which the state was found.
    pub found_by: FoundBy,
    /// See [`crate::chain::Residual::rate`], of the limbs' wrenches and coordinates.
    pub rate: Option<f64>,
    pub length: f64,
    pub stiffness: f64,
}

/// Largest residuals of all limbs and platforms, scaled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MechanismResiduals {
    pub merit: f64,
    pub closure_m: f64,
    pub torque: f64,
    pub loads: f64,
    pub force: f64,
    pub forces: f64,
    /// Lower bound of the loads, see [`LEAST_LOAD`].
    pub least: f64,
    /// Largest unbalanced torque without what is rounding, see [`rounding`].
    pub exceeding: f64,
}

impl MechanismResiduals {
    /// Closure in metres and unbalanced share.
    pub fn residual(&self, iterations: usize) -> crate::chain::residual::Residual {
        crate::chain::residual::Residual {
            closure_m: self.closure_m,
            torque: (self.torque / self.loads.max(self.least))
                .max(self.force / self.forces.max(self.least)),
            iterations,
            rate: None,
        }
    }
}

impl<'m> PlatformSolver<'m> {
    pub fn new(
        mechanism: &'m Mechanism,
        settings: Settings,
        posture: Vec<LimbPosture>,
        state: MechanismState,
        unknowns: Unknowns,
    ) -> Self {
        let limbs = &mechanism.limbs();
        let scales: Vec<Vec<f64>> = limbs
            .iter()
            .zip(&posture)
            .map(|(l, p)| scales_of(&l.actual, &p.coordinates))
            .collect();
        let linear = limbs
            .iter()
            .zip(&posture)
            .zip(&scales)
            .map(|((l, p), scales)| {
                let base = &state.platforms[l.from];
                // Effects of commands and of a moving base are computed with dense matrices.
                let dense = matches!(unknowns, Unknowns::Target(_)) || l.from != 0;
                let (x, commands) = (&p.coordinates, &p.commands);
                Linear::new(match dense {
                    true => System::new(&l.actual, base, x, commands, l.from != 0),
                    false => System::of_chain(&l.actual, base, x, commands, scales, None),
                })
            })
            .collect();
        let loads = (0..limbs.len()).map(|i| mechanism.acting(i)).collect();
        let Scale { length, stiffness } = mechanism.scale();
        Self {
            mechanism,
            settings,
            wrench: Wrench::zero(),
            others: Vec::new(),
            target: state.platforms[mechanism.tool()],
            nominal: mechanism.platforms().iter().map(|p| p.home).collect(),
            posture,
            unknowns,
            guide: Guide::none(),
            rates: Vec::new(),
            state,
            scales,
            loads,
            linear,
            equilibrium: None,
            offsets: vec![Twist::zero(); limbs.len()],
            tree: tree(mechanism),
            leads: false,
            share: 1.0,
            damping: 0.0,
            found_by: FoundBy::Directly,
            rate: None,
            length,
            stiffness,
        }
    }

    /// Arm from the reference point of `to` to the limb's tip at a state, base axes, m.
    pub fn arm(&self, limb: usize, at: &MechanismState) -> Vector3<f64> {
        let l = &self.mechanism.limbs()[limb];
        at.platforms[l.to].rotation * l.platform_from_tip.translation.vector
    }

    /// Platforms go where their limbs lead: every one has a single limb, which alone says where.
    pub fn follows(&self) -> bool {
        let free = matches!(self.unknowns, Unknowns::Pose | Unknowns::Guided);
        free && !self.tree.is_empty() && !self.leads
    }

    /// Evaluates a limb at the present state.
    pub fn evaluate_limb(&mut self, i: usize) {
        let limb = &self.mechanism.limbs()[i];
        let system = &mut self.linear[i].system;
        for _ in 0..2 {
            system.evaluate(
                &limb.actual,
                &self.state.platforms[limb.from],
                &self.posture[i].coordinates,
                &self.posture[i].commands,
                &self.loads[i],
                &self.state.coordinates[i],
                &self.state.wrenches[i],
                self.share,
            );
            if system.sweep.as_ref().is_none_or(|s| s.serial) {
                break;
            }
            system.make_dense();
        }
    }

    pub fn evaluate_limbs(&mut self) {
        if !self.follows() {
            (0..self.linear.len()).for_each(|i| self.evaluate_limb(i));
            return;
        }
        for k in 0..self.tree.len() {
            let i = self.tree[k];
            self.evaluate_limb(i);
            let limb = &self.mechanism.limbs()[i];
            let tip = self.linear[i].system.kinematics.tip_pose();
            self.state.platforms[limb.to] = tip * limb.platform_from_tip.inverse();
        }
    }

    /// Evaluates every limb and the equilibrium of every platform at the present state.
    pub fn evaluate(&mut self) -> (MechanismResiduals, Vec<Wrench>) {
        let m = self.mechanism;
        self.evaluate_limbs();
        let (mut merit, mut closure_m, mut torque, mut loads, mut forces) =
            (0.0, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut exceeding = 0.0_f64;
        // Wrench still missing on each platform, about its origin.
        let mut unbalanced: Vec<Wrench> = m
            .platforms()
            .iter()
            .zip(&self.state.platforms)
            .map(|(p, pose)| {
                let weight = m.gravity() * (p.mass * self.share);
                Wrench::new(weight, (pose.rotation * p.centre_of_mass).cross(&weight))
            })
            .collect();
        unbalanced[m.tool()] = unbalanced[m.tool()] + self.wrench * self.share;
        let mut others = self.others.clone();
        for load in m.platform_loads() {
            load.wrenches(&self.state.platforms, &mut others);
        }
        for (platform, wrench) in others {
            unbalanced[platform] += wrench * self.share;
        }
        let root = self.stiffness.sqrt();
        let unit = [
            root,
            root,
            root,
            root * self.length,
            root * self.length,
            root * self.length,
        ];
        let size = |w: &Wrench| {
            w.0.iter()
                .zip(&unit)
                .map(|(x, u)| (x / u).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        forces = unbalanced.iter().skip(1).map(size).fold(forces, larger);
        for (i, limb) in m.limbs().iter().enumerate() {
            let arm = self.arm(i, &self.state);
            let (x, f) = (&self.state.coordinates[i], &self.state.wrenches[i]);
            let linear = &mut self.linear[i];
            let target = self.state.platforms[limb.to] * limb.platform_from_tip;
            let tip = linear.system.kinematics.tip_pose();
            linear.closure =
                Twist(pose_residual(&target, &tip).0 - self.offsets[i].0 * (1.0 - self.share));
            let b = measure(
                &limb.actual,
                &linear.system,
                &linear.closure,
                f,
                &self.scales[i],
            );
            merit += b.closure.powi(2) + b.torque.powi(2);
            closure_m = larger(closure_m, b.closure / limb.actual.scale().stiffness.sqrt());
            torque = larger(torque, b.torque);
            loads = larger(loads, b.loads);
            exceeding = larger(exceeding, b.exceeding());
            unbalanced[limb.to] += Wrench(-(shift_matrix(&arm).transpose() * f.0));
            if limb.from != 0 {
                let n = x.len() + limb.actual.actuators().len();
                let reaction = Vector6::from_fn(|k, _| linear.system.torque[n + k]);
                unbalanced[limb.from] += Wrench(reaction);
            }
            forces = larger(forces, size(f));
        }
        let mut force = 0.0_f64;
        if self.unknowns == Unknowns::Guided {
            let guide_residual = self.guide.residual(&self.state.platforms[m.tool()]);
            let guide_residual = largest(&guide_residual);
            merit += (guide_residual * root).powi(2);
            closure_m = larger(closure_m, guide_residual);
        }
        for (k, w) in unbalanced.iter().enumerate().skip(1) {
            // The holder of the tool supplies its unbalanced wrench under displacement control.
            if self.unknowns != Unknowns::Displacement || k != m.tool() {
                force = larger(force, size(w));
                merit += size(w).powi(2);
            }
        }
        let norms = MechanismResiduals {
            merit,
            closure_m,
            torque,
            loads,
            force,
            forces,
            least: LEAST_LOAD * root * self.length,
            exceeding,
        };
        (norms, unbalanced)
    }

    pub fn converged(&self, b: &MechanismResiduals) -> bool {
        let unit = self.stiffness.sqrt() * self.length;
        b.torque.is_finite()
            && b.closure_m <= self.settings.closure * self.length
            && b.exceeding <= self.settings.torque * b.loads + 1e-16 * unit
            && b.force <= self.settings.torque * b.forces + 1e-16 * unit
    }

    /// Commands every limb for the present nominal target; false where it cannot be reached.
    pub fn retarget(&mut self) -> bool {
        let m = self.mechanism;
        if m.platforms().len() > 2 {
            let start = GraphPosture {
                platforms: self.nominal.clone(),
                limbs: self.posture.clone(),
            };
            let Ok(found) = graph_inverse(m, &self.target, Some(&start)) else {
                return false;
            };
            (self.nominal, self.posture) = (found.platforms, found.limbs);
            return true;
        }
        for (i, limb) in m.limbs().iter().enumerate() {
            let tip = self.target * limb.platform_from_tip;
            let base = m.platforms()[limb.from].home;
            match inverse_kinematics(&limb.nominal, &base, &tip, Some(&self.posture[i])) {
                Ok(found) => self.posture[i] = found,
                Err(_) => return false,
            }
        }
        self.nominal[m.tool()] = self.target;
        true
    }

    /// Rates of the commands at the present posture.
    pub fn refresh_rates(&mut self) {
        self.nominal[self.mechanism.tool()] = self.target;
        self.rates = rates_of(self.mechanism, &self.nominal, &self.posture);
    }

    /// Exact tangents at the present state: evaluates, linearises and returns `K` of the platforms,
    /// 6P x 6P, together with the limbs' own systems for stiffness and stability.
    pub fn finish(&mut self) -> (Sparse, Vec<Wrench>) {
        self.share = 1.0;
        let (_, unbalanced) = self.evaluate();
        self.linearise_exactly();
        (self.tangents(&self.state).0, unbalanced)
    }

    /// Exact tangents of all limbs at the state evaluated last.
    pub fn linearise_exactly(&mut self) {
        self.linearise(Hessian::Kept);
        for (linear, (limb, scales)) in self
            .linear
            .iter_mut()
            .zip(self.mechanism.limbs().iter().zip(&self.scales))
        {
            // A limb that cannot move in all directions has no regular system: its end apart from them.
            let swept = linear.system.sweep.is_some();
            if limb.from == 0 && !swept && linear.rigid.ncols() > 0 {
                let jacobian = scaled_jacobian(&linear.system, scales);
                let (_, answer) = motions_of_end(&limb.actual, &linear.system, scales, &jacobian);
                linear.solution.columns_mut(1, 6).copy_from(&answer);
            }
        }
    }

    /// The moment of the wrench on the tool without the reactions of what guides it.
    pub fn dead_moment(&self, wrench: &Wrench) -> Vector3<f64> {
        let held = self.guide.hands.rows(3, 3);
        let held = crate::linalg::singular_values::SingularValues::of(&held);
        let mut moment = wrench.moment();
        for (column, value) in held.left.column_iter().zip(&held.values) {
            if *value > 1e-9 {
                moment -= column * column.dot(&wrench.moment());
            }
        }
        moment
    }

    /// System of a limb after [`Self::finish`].
    pub fn limb_system(&self, limb: usize) -> &System {
        &self.linear[limb].system
    }

    /// Stiffness at its tip and stability of its shape of a limb after [`Self::finish`].
    pub fn stiffness_and_stability(&mut self, limb: usize) -> (ChainStiffness, ShapeStability) {
        let chain = &self.mechanism.limbs()[limb].actual;
        // Wrench and coordinates per unit motion of the tip, (6 + n) x 6.
        let units = self.linear[limb].solution.columns(1, 6).into_owned();
        let system = &self.linear[limb].system;
        let conservative = self.mechanism.loads_conservative(limb);
        let found = system.swept_stiffness_and_stability(chain, &self.scales[limb], Some(&units));
        if let Some(found) = found.filter(|(_, s)| conservative || s.stable) {
            return found;
        }
        let swept = system.sweep.is_some();
        if swept {
            self.linear[limb].system.make_dense();
            self.evaluate_limb(limb);
        }
        let (system, scales) = (&self.linear[limb].system, &self.scales[limb]);
        let units = (!swept).then_some(units);
        let stiffness = chain_stiffness(chain, system, scales, units);
        let stability = shape_stability(chain, system, scales, conservative);
        (stiffness, stability)
    }
}

/// Motion of every limb's commands per motion of the nominal tool (base axes, at its origin), r x 6.
pub(crate) fn rates_of(
    mechanism: &Mechanism,
    platforms: &[Pose],
    limbs: &[LimbPosture],
) -> Vec<DMatrix<f64>> {
    if mechanism.platforms().len() > 2 {
        let at = GraphPosture {
            platforms: platforms.to_vec(),
            limbs: limbs.to_vec(),
        };
        return graph_rates(mechanism, &at);
    }
    // The tip of a limb moves like the tool that it is fixed to.
    let rates = mechanism.limbs().iter().zip(limbs).map(|(l, p)| {
        let arm = platforms[l.to].rotation * l.platform_from_tip.translation.vector;
        let rates = command_rates(&l.nominal, &platforms[l.from], p) * shift_matrix(&arm);
        DMatrix::from_fn(rates.nrows(), 6, |i, j| rates[(i, j)])
    });
    rates.collect()
}

/// Limbs from the base outwards; none where a platform has another number of limbs to it than one.
fn tree(mechanism: &Mechanism) -> Vec<usize> {
    let mut placed = vec![false; mechanism.platforms().len()];
    placed[0] = true;
    let mut order = Vec::new();
    while let Some(next) = mechanism
        .limbs()
        .iter()
        .position(|l| placed[l.from] && !placed[l.to])
    {
        placed[mechanism.limbs()[next].to] = true;
        order.push(next);
    }
    if order.len() != mechanism.limbs().len() || placed.contains(&false) {
        order.clear();
    }
    order
}

fn measure(
    chain: &Chain,
    system: &System,
    closure: &Twist,
    wrench: &Wrench,
    scales: &[f64],
) -> ResidualNorms {
    let (torque, mut loads) = system.unbalanced_torques(scales);
    let mut closure_squared = 0.0;
    for k in 0..6 {
        closure_squared += (closure.0[k] * scales[k]).powi(2);
        loads = larger(loads, (wrench.0[k] / scales[k]).abs());
    }
    ResidualNorms {
        closure: closure_squared.sqrt(),
        torque: torque.sqrt(),
        loads,
        rounding: rounding(chain, system, scales),
    }
}
