//! A mechanism commanded for a target, and what it does there: `f(t | t0)`, `f^-1(F | t0)`,
//! stiffness, assembly [R 6.1-6.30].
//!
//! The thing right of the bar is a [`Posture`]; the thing left of it is an argument.

use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};

use crate::chain::compliance::{CartesianCompliance, stiffness_against_force};
use crate::chain::link_load::{LinkLoad, link_loads};
use crate::chain::potential::load_energy;
use crate::chain::problem::{ChainProblem, EndCondition};
use crate::chain::residual::Residual;
use crate::chain::scaling::gone;
use crate::chain::stability::ShapeStability;
use crate::chain::stiffness::{ChainStiffness, Direction, DirectionKind};
use crate::equilibrium::chain::{FAR, SHORT_STEP};
use crate::error::{Error, Result};
use crate::machine::directions::{
    balanced_directions, condensed_directions, none_diverges, others_hold,
};
use crate::machine::graded::GradedPlatforms;
use crate::machine::inverse::graph::{GraphPosture, graph_inverse};
use crate::machine::inverse::limb::{LimbPosture, inverse_kinematics};
use crate::machine::network::Network;
use crate::machine::platform_system::RigidRows;
use crate::machine::platforms::solver::{PlatformSolver, Unknowns};
use crate::machine::state::{MechanismState, check_state};
use crate::model::kinematics::unloaded_tip;
use crate::model::mechanism::Mechanism;
use crate::settings::Settings;
use crate::spatial::{CartesianStiffness, MotionKind, Pose, Twist, Wrench, pose_residual};

/// A mechanism whose actuators are commanded for a nominal target of the tool.
#[derive(Clone, Debug)]
pub struct Posture<'m> {
    pub(crate) mechanism: &'m Mechanism,
    settings: Settings,
    pub(crate) target: Pose,
    /// Nominal poses of all platforms, the base first.
    pub(crate) platforms: Vec<Pose>,
    pub(crate) limbs: Vec<LimbPosture>,
    /// Dead wrenches on platforms other than the tool.
    pub(crate) others: Vec<(usize, Wrench)>,
}

/// Whether the platform stays where it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlatformStability {
    /// Every motion of the free platform costs energy, or (see `free`) none; for loads without a potential: it does
    /// not go away (divergence), but see `may_flutter`.
    pub stable: bool,
    /// The loads have no potential, the platform does not go away, but it may swing with growing amplitude
    /// (flutter); whether it does depends on the masses.
    #[serde(default)]
    pub may_flutter: bool,
    /// Smallest principal stiffness, N/m (rotations referred to the natural length).
    pub smallest_stiffness_n_per_m: f64,
    /// Number of directions without stiffness.
    pub free: usize,
}

/// What one limb does in an equilibrium.
#[derive(Clone, Debug)]
pub struct LimbEquilibrium {
    /// Name of the limb.
    pub name: String,
    /// Wrench of the platform on the limb's tip, about it, base axes.
    pub wrench: Wrench,
    /// Coordinates, m or rad, in the chain's order.
    pub coordinates: Vec<f64>,
    /// Torque of every spring coordinate, N or N m; zero for passive joints.
    pub spring_torques: Vec<f64>,
    /// Energy in its springs, J.
    pub energy: f64,
    /// Potential energy of its loads and weights, J; the zero is arbitrary but the same in all
    /// equilibria of a posture. `None` where a load has no potential.
    pub load_energy: Option<f64>,
    /// All its loads have a potential; if not, statements about energy do not hold.
    pub conservative: bool,
    /// Axial load of its elastic links, relative to their Euler loads.
    pub link_loads: Vec<LinkLoad>,
    /// Poses of its nodes, base from node, in the chain's order.
    pub nodes: Vec<Pose>,
    /// Force (N) or torque (N m) of the loads on every actuator.
    pub actuator_forces: Vec<f64>,
    /// Tangent stiffness at its tip.
    pub stiffness: ChainStiffness,
    /// Stability of its shape with the tip held.
    pub stability: ShapeStability,
}

impl LimbEquilibrium {
    /// It has no motion while its end is held, so that its end's motions are all that it has.
    fn follows_its_end(&self) -> bool {
        self.stability.stable && self.stability.share_to_buckling.is_none()
    }
}

/// A mechanism in equilibrium.
#[derive(Clone, Debug)]
pub struct MechanismEquilibrium {
    /// Pose of the tool platform.
    pub tool: Pose,
    /// From the nominal target to that pose.
    pub displacement: Twist,
    /// External wrench on the tool, about its origin, base axes: given (`f^-1`) or found (`f`).
    pub wrench: Wrench,
    /// Energy of all springs and potential of all weights, loads on limbs and on platforms, J, without the
    /// wrench on the tool, whose work it is while the tool is moved. `None` where a load has no
    /// potential.
    pub energy: Option<f64>,
    /// All loads on limbs and the dead wrench on the tool (if it is not held) have a potential; if
    /// not, the machine
    /// may gain energy on a closed path, and stability judged by stiffness is not all of it.
    pub conservative: bool,
    /// Tangent stiffness of the tool with all other platforms free, at its origin, base axes.
    pub stiffness: CartesianStiffness,
    /// Its principal directions.
    pub directions: Vec<Direction>,
    /// Natural length, m: what a rotation is multiplied with to be compared with a translation.
    pub length: f64,
    /// Whether the free platform stays.
    pub platform: PlatformStability,
    /// Limbs in the mechanism's order.
    pub limbs: Vec<LimbEquilibrium>,
    /// How well the conditions of equilibrium hold.
    pub residual: Residual,
    /// State from which a neighbouring equilibrium can be started.
    pub state: MechanismState,
    /// Platforms other than the tool keep their places while the tool is held.
    pub(crate) others_hold: bool,
}

impl MechanismEquilibrium {
    /// Tangent compliance of the tool: it exists where the stiffness is infinite (rigid directions)
    /// or zero (free ones).
    #[must_use]
    pub fn compliance(&self) -> CartesianCompliance {
        CartesianCompliance::of(&self.stiffness.matrix, &self.directions, self.length)
    }

    /// Every limb keeps its shape while the tool is held.
    #[must_use]
    pub fn shapes_stable(&self) -> bool {
        self.limbs.iter().all(|l| l.stability.stable)
    }

    /// The motions of the tool are all that the machine has.
    pub(crate) fn moves_with_its_tool(&self) -> bool {
        self.state.platforms.len() == 2 && self.limbs.iter().all(LimbEquilibrium::follows_its_end)
    }

    /// Every limb keeps its shape and the platform its place.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.platform.stable && self.shapes_stable()
    }

    /// Under loads without a potential nothing goes away, but the machine may swing with growing amplitude
    /// (flutter), which depends on the masses.
    #[must_use]
    pub fn may_flutter(&self) -> bool {
        self.stable()
            && (self.platform.may_flutter || self.limbs.iter().any(|l| l.stability.may_flutter()))
    }

    /// Largest share of the way to buckling `mu` of all limbs; below 1 is stable.
    #[must_use]
    pub fn share_to_buckling(&self) -> Option<f64> {
        self.limbs
            .iter()
            .filter_map(|l| l.stability.share_to_buckling)
            .max_by(f64::total_cmp)
    }

    /// Force (N) that moves the tool's origin by 1 m in its softest direction while the tool may
    /// turn as it likes: what a person who pushes the tool feels. Zero if a direction is free,
    /// negative if the symmetric part of the stiffness lets some force move the tool against itself, infinite
    /// if no force moves it. It is no verdict: a tool that runs away may yet be moved along every force,
    /// see [`Self::stable`].
    #[must_use]
    pub fn stiffness_against_force(&self) -> f64 {
        stiffness_against_force(&self.stiffness.symmetric(), &self.directions, self.length)
    }

    /// Forces (N) or torques (N m) of the loads on all actuators, in the mechanism's order.
    #[must_use]
    pub fn actuator_forces(&self) -> Vec<f64> {
        self.limbs
            .iter()
            .flat_map(|l| l.actuator_forces.iter().copied())
            .collect()
    }
}

impl Mechanism {
    /// Commands the actuators for a target of the tool (base from tool), from nominal geometry with
    /// springs at rest. Platforms between base and tool find their places with the joints. Where
    /// actuators are redundant, see [`Posture::redundancy`].
    ///
    /// # Errors
    /// [`Error::Unreachable`] with the nearest pose, naming the limb; for a graph of several moving
    /// platforms the nearest pose is the last one reached on the straight way from home.
    pub fn posture(&self, target: &Pose) -> Result<Posture<'_>> {
        self.posture_from(target, None)
    }

    /// As [`Self::posture`], searching near the joints of another posture.
    ///
    /// # Errors
    /// As [`Self::posture`].
    pub fn posture_near(&self, target: &Pose, near: &Posture<'_>) -> Result<Posture<'_>> {
        self.posture_from(target, Some(near))
    }

    fn posture_from(&self, target: &Pose, near: Option<&Posture<'_>>) -> Result<Posture<'_>> {
        let place = format!("mechanism '{}'", self.name);
        crate::model::limits::sensible_pose(&place, "the target pose", target)?;
        let mut platforms: Vec<Pose> = self.platforms.iter().map(|p| p.home).collect();
        platforms[self.tool] = *target;
        let limbs = if self.platforms.len() > 2 {
            let start = near.map(|near| GraphPosture {
                platforms: near.platforms.clone(),
                limbs: near.limbs.clone(),
            });
            let found = graph_inverse(self, target, start.as_ref())?;
            platforms = found.platforms;
            found.limbs
        } else {
            let mut limbs = Vec::with_capacity(self.limbs.len());
            for (i, limb) in self.limbs.iter().enumerate() {
                let tip = target * limb.platform_from_tip;
                let start = near.map(|near| &near.limbs[i]);
                let base = &platforms[limb.from];
                let found = inverse_kinematics(&limb.nominal, base, &tip, start);
                limbs.push(found.map_err(|error| of_tool(error, &limb.platform_from_tip))?);
            }
            limbs
        };
        Ok(Posture {
            mechanism: self,
            settings: Settings::default(),
            target: *target,
            platforms,
            limbs,
            others: Vec::new(),
        })
    }

    /// A posture from known joints: commands and passive coordinates of every limb, with the tool
    /// nominally at `target`. Platforms between base and tool are put where the limbs lead, along
    /// the fewest of them.
    ///
    /// # Errors
    /// Lists of the wrong length.
    pub fn posture_from_joints(
        &self,
        target: &Pose,
        limbs: Vec<LimbPosture>,
    ) -> Result<Posture<'_>> {
        if limbs.len() != self.limbs.len() {
            return Err(Error::Size {
                place: format!("mechanism '{}'", self.name),
                what: "limb postures",
                expected: self.limbs.len(),
                found: limbs.len(),
            });
        }
        for (limb, joints) in self.limbs.iter().zip(&limbs) {
            limb.nominal.check(&joints.coordinates, &joints.commands)?;
        }
        let platforms = self.platforms_from_joints(target, &limbs);
        Ok(Posture {
            mechanism: self,
            settings: Settings::default(),
            target: *target,
            platforms,
            limbs,
            others: Vec::new(),
        })
    }

    /// Nominal poses of the platforms: those of the base and the tool are known, the others follow
    /// along the limbs from what is known, nearest first.
    fn platforms_from_joints(&self, target: &Pose, limbs: &[LimbPosture]) -> Vec<Pose> {
        let mut platforms: Vec<Pose> = self.platforms.iter().map(|p| p.home).collect();
        platforms[self.tool] = *target;
        let mut known: Vec<bool> = (0..platforms.len())
            .map(|p| p == 0 || p == self.tool)
            .collect();
        loop {
            let before = known.clone();
            for (limb, joints) in self.limbs.iter().zip(limbs) {
                if before[limb.from] == before[limb.to] || (known[limb.from] && known[limb.to]) {
                    continue;
                }
                // Of the limb from its own base.
                let own = unloaded_tip(
                    &limb.nominal,
                    &Pose::identity(),
                    &joints.coordinates,
                    &joints.commands,
                ) * limb.platform_from_tip.inverse();
                if before[limb.from] {
                    platforms[limb.to] = platforms[limb.from] * own;
                    known[limb.to] = true;
                } else {
                    platforms[limb.from] = platforms[limb.to] * own.inverse();
                    known[limb.from] = true;
                }
            }
            if known == before {
                return platforms;
            }
        }
    }

    /// The same mechanism with its tool platform's reference point and axes moved to `tool`
    /// (platform from tool): a spindle's tip, say. Results then refer to that point.
    #[must_use]
    pub fn with_tool(&self, tool: &Pose) -> Self {
        let mut moved = self.clone();
        let inverse = tool.inverse();
        for limb in &mut moved.limbs {
            if limb.to == moved.tool {
                limb.platform_from_tip = inverse * limb.platform_from_tip;
            }
            if limb.from == moved.tool {
                for chain in [&mut limb.nominal, &mut limb.actual] {
                    chain
                        .elements
                        .insert(0, crate::model::chain::Element::Rigid(inverse));
                }
            }
        }
        for load in &mut moved.platform_loads {
            *load = load.reframed(moved.tool, tool);
        }
        let platform = &mut moved.platforms[moved.tool];
        platform.home *= *tool;
        platform.centre_of_mass =
            (inverse * nalgebra::Point3::from(platform.centre_of_mass)).coords;
        let turn = tool.rotation.to_rotation_matrix();
        platform.inertia = turn.matrix().transpose() * platform.inertia * turn.matrix();
        moved
    }
}

impl<'m> Posture<'m> {
    /// The mechanism.
    #[must_use]
    pub fn mechanism(&self) -> &'m Mechanism {
        self.mechanism
    }

    /// Nominal target of the tool, `t0`.
    #[must_use]
    pub fn target(&self) -> &Pose {
        &self.target
    }

    /// Joints of every limb.
    #[must_use]
    pub fn limbs(&self) -> &[LimbPosture] {
        &self.limbs
    }

    /// Commands of all actuators, m or rad, in the mechanism's order.
    #[must_use]
    pub fn commands(&self) -> Vec<f64> {
        self.limbs
            .iter()
            .flat_map(|l| l.commands.iter().copied())
            .collect()
    }

    /// The same posture with other tolerances.
    #[must_use]
    pub fn with_settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// The same posture with a dead wrench on a platform (its index), about the platform's origin,
    /// base axes, besides what acts already. It is there in every equilibrium of this posture.
    ///
    /// # Errors
    /// [`Error::Model`] for the base or a platform that does not exist; [`Error::NotFinite`].
    pub fn with_wrench_on(mut self, platform: usize, wrench: Wrench) -> Result<Self> {
        self.finite("the wrench on a platform", wrench.0.iter())?;
        let count = self.mechanism.platforms.len();
        if platform == 0 || platform >= count {
            return Err(Error::model(
                format!("mechanism '{}'", self.mechanism.name),
                format!(
                    "a wrench acts on platform {platform}; those that move are 1 to {}",
                    count - 1
                ),
            ));
        }
        self.others.push((platform, wrench));
        Ok(self)
    }

    /// Tolerances in force.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// `limb.actuator` of every command outside its limits, with command and limits (m or rad).
    #[must_use]
    pub fn limit_violations(&self) -> Vec<(String, f64, (f64, f64))> {
        let names = self.mechanism.actuator_names();
        let actuators = self
            .mechanism
            .limbs
            .iter()
            .flat_map(|l| &l.nominal.actuators);
        names
            .into_iter()
            .zip(self.commands())
            .zip(actuators)
            .filter_map(|((name, command), actuator)| {
                let (low, high) = actuator.limits?;
                (command < low || command > high).then_some((name, command, (low, high)))
            })
            .collect()
    }

    /// That no command lies outside its limits.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`] for the first that does.
    pub fn within_limits(&self) -> Result<()> {
        let Some((actuator, command, (low, high))) = self.limit_violations().into_iter().next()
        else {
            return Ok(());
        };
        let limbs = self.mechanism.limbs.iter();
        let kind = limbs
            .flat_map(|l| &l.nominal.actuators)
            .zip(self.mechanism.actuator_names())
            .find(|(_, name)| *name == actuator)
            .map_or(MotionKind::Prismatic, |(a, _)| a.kind);
        Err(Error::OutsideLimits {
            actuator,
            kind,
            command,
            low,
            high,
        })
    }

    /// Nominal poses of all platforms, base from platform, in the mechanism's order.
    #[must_use]
    pub fn platforms(&self) -> &[Pose] {
        &self.platforms
    }

    /// State with all springs at rest and the platforms where they are meant to be.
    #[must_use]
    pub fn rest_state(&self) -> MechanismState {
        MechanismState {
            platforms: self.platforms.clone(),
            coordinates: self.limbs.iter().map(|l| l.coordinates.clone()).collect(),
            wrenches: vec![Wrench::zero(); self.limbs.len()],
        }
    }

    pub(crate) fn solver(&self, state: MechanismState, unknowns: Unknowns) -> PlatformSolver<'m> {
        let mut solver = PlatformSolver::new(
            self.mechanism,
            self.settings,
            self.limbs.clone(),
            state,
            unknowns,
        );
        solver.target = self.target;
        solver.nominal.clone_from(&self.platforms);
        solver.others.clone_from(&self.others);
        solver
    }

    /// Unloaded stiffness of the nominal mechanism, at the tool's origin, base axes [R 3.10, 3.13],
    /// all other platforms free.
    ///
    /// # Errors
    /// Wrong sizes only; a singular stiffness is a result.
    pub fn stiffness(&self) -> Result<UnloadedStiffness> {
        let m = self.mechanism;
        let network = Network::new(self)?;
        let scale = m.scale();
        // Nothing acts: no more than the limbs' own.
        let scales = m.limbs.iter().map(|limb| limb.nominal.scale());
        let own = network.limbs.iter().zip(scales.clone());
        let own = own.zip(&network.motions).map(|((k, s), e)| (k, s, e));
        let graded = GradedPlatforms::of(scale, network.moving(), own);
        let (matrix, directions) = if m.platforms.len() > 2 {
            let (total, rigid) = (network.stiffness(), network.rows());
            condensed_directions(&total, graded.as_ref(), &rigid, m.tool - 1, scale)
        } else {
            let mut total = Matrix6::zeros();
            for (k, ends) in network.limbs.iter().zip(&network.motions) {
                total += ends.to.1.transpose() * k.cartesian.matrix * ends.to.1;
            }
            let arms = m
                .limbs
                .iter()
                .map(|limb| self.target.rotation * limb.platform_from_tip.translation.vector);
            let own = network.limbs.iter().zip(arms).zip(scales);
            let own = own.map(|((k, arm), scale)| (k, arm, scale));
            let directions = balanced_directions(&total, graded.as_ref(), scale, own);
            (total, directions)
        };
        let answer = UnloadedStiffness {
            length: scale.length,
            cartesian: CartesianStiffness { matrix },
            directions,
            limbs: network.limbs,
        };
        Ok(answer.named(self))
    }

    /// `f^-1(F | t0)`: where the tool goes under a dead wrench at its origin [R 6.28-6.30], with
    /// gravity, preloads and assembly errors of the model.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the last state and share of the load, and the limit point if
    /// one is on the way; [`Error::FreeDirection`] where the load pushes on along a motion that
    /// nothing holds, as far as it can be followed.
    pub fn deflected_by(&self, wrench: &Wrench) -> Result<MechanismEquilibrium> {
        self.deflected_from(wrench, self.rest_state())
    }

    /// The stable equilibrium to which the growing load leads, where one step found another that does not stay and
    /// which lies far: it may have passed the former.
    fn led_to(
        &self,
        wrench: &Wrench,
        found: &MechanismEquilibrium,
    ) -> Option<MechanismEquilibrium> {
        if found.stable() || !self.is_far(&found.state) {
            return None;
        }
        let (mut solver, residual) = self.grown(wrench).ok()?;
        let grown = conclude(&mut solver, residual).ok()?;
        grown.stable().then_some(grown)
    }

    /// The load grown from rest in short steps.
    pub(crate) fn grown(&self, wrench: &Wrench) -> Result<(PlatformSolver<'m>, Residual)> {
        let mut solver = self.solver(self.rest_state(), Unknowns::Pose);
        solver.wrench = *wrench;
        let at_rest = solver.evaluate().0;
        let residual = solver.grow_load(&at_rest, SHORT_STEP)?;
        Ok((solver, residual))
    }

    /// Whether one step may have passed the equilibrium to which the growing load leads.
    fn is_far(&self, state: &MechanismState) -> bool {
        let limbs = self.mechanism.limbs.iter().zip(&self.limbs);
        let ways = limbs
            .zip(&state.coordinates)
            .map(|((limb, home), there)| gone(&limb.actual, &home.coordinates, there));
        ways.sum::<f64>() > FAR
    }

    /// As [`Self::deflected_by`], starting from the state of a neighbouring equilibrium.
    ///
    /// # Errors
    /// As [`Self::deflected_by`].
    pub fn deflected_from(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> Result<MechanismEquilibrium> {
        let (mut solver, residual) = self.settled(wrench, start)?;
        let found = conclude(&mut solver, residual)?;
        Ok(self.led_to(wrench, &found).unwrap_or(found))
    }

    /// Only where the platforms and limbs come to rest: [`Self::deflected_from`] without stiffness
    /// and stability, for fields of many points.
    ///
    /// # Errors
    /// As [`Self::deflected_by`].
    pub fn rest_under(&self, wrench: &Wrench, start: MechanismState) -> Result<MechanismState> {
        let (mut solver, residual) = self.settled(wrench, start)?;
        if !self.is_far(&solver.state) {
            return Ok(solver.state);
        }
        let found = conclude(&mut solver, residual)?;
        Ok(self.led_to(wrench, &found).unwrap_or(found).state)
    }

    pub(crate) fn finite<'a>(
        &self,
        what: &str,
        mut values: impl Iterator<Item = &'a f64>,
    ) -> Result<()> {
        let place = format!("mechanism '{}'", self.mechanism.name);
        self.settings.check(&place)?;
        values.try_for_each(|value| {
            crate::model::limits::sensible(&place, || what.to_owned(), *value)
        })
    }

    pub(crate) fn settled(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> Result<(PlatformSolver<'m>, Residual)> {
        self.finite("the wrench", wrench.0.iter())?;
        check_state(self.mechanism, &start)?;
        let mut solver = self.solver(start, Unknowns::Pose);
        solver.wrench = *wrench;
        match solver.solve_robustly() {
            Ok(residual) => Ok((solver, residual)),
            Err(error) => self.found_otherwise(wrench, error),
        }
    }

    /// `f(t | t0)`: the wrench that holds the tool at `pose` [R 6.21].
    ///
    /// # Errors
    /// [`Error::NotConverged`], for instance for a pose that the limbs cannot follow.
    pub fn wrench_at(&self, pose: &Pose) -> Result<MechanismEquilibrium> {
        self.finite("the pose", pose.to_homogeneous().iter())?;
        let mut state = self.rest_state();
        state.platforms[self.mechanism.tool] = *pose;
        let mut solver = self.solver(state, Unknowns::Held);
        let residual = solver.solve_robustly()?;
        conclude(&mut solver, residual)
    }
}

/// A limb's nearest pose is told as the pose that the tool would have with it.
fn of_tool(mut error: Error, platform_from_tip: &Pose) -> Error {
    if let Error::Unreachable { nearest, .. } = &mut error {
        **nearest *= platform_from_tip.inverse();
    }
    error
}

/// Unloaded stiffness of a mechanism and its limbs.
#[derive(Clone, Debug)]
pub struct UnloadedStiffness {
    /// `K_C` of the platform at the tool's origin, base axes.
    pub cartesian: CartesianStiffness,
    /// Its principal directions.
    pub directions: Vec<Direction>,
    /// `K_C^(i)` of every limb at its tip.
    pub limbs: Vec<ChainStiffness>,
    /// Natural length, m: what a rotation is multiplied with to be compared with a translation.
    pub length: f64,
}

impl UnloadedStiffness {
    /// Compliance of the tool: it exists where the stiffness is infinite (rigid directions) or zero
    /// (free ones).
    #[must_use]
    pub fn compliance(&self) -> CartesianCompliance {
        CartesianCompliance::of(&self.cartesian.matrix, &self.directions, self.length)
    }

    /// As [`MechanismEquilibrium::stiffness_against_force`].
    #[must_use]
    pub fn stiffness_against_force(&self) -> f64 {
        let own = self.cartesian.symmetric();
        stiffness_against_force(&own, &self.directions, self.length)
    }

    /// Number of directions with stiffness.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.directions
            .iter()
            .filter(|d| d.kind != DirectionKind::Free)
            .count()
    }
}

/// Stiffness, stability and limbs at a solved state.
pub(crate) fn conclude(
    solver: &mut PlatformSolver<'_>,
    residual: Residual,
) -> Result<MechanismEquilibrium> {
    let (tangent, lack) = solver.finish();
    let m = solver.mechanism;
    let tool = m.tool;
    let scale = m.scale();
    // What a held tool lacks is what its holder must apply.
    let wrench = match solver.unknowns {
        Unknowns::Held => Wrench(-lack[tool].0),
        _ => solver.wrench,
    };
    let rigid = match m.platforms.len() {
        2 => RigidRows::none(1),
        _ => solver.rigid_rows(&solver.state).0,
    };
    if let Some(&(.., value)) = tangent.entries.iter().find(|(.., x)| !x.is_finite()) {
        return Err(Error::NotFinite {
            place: format!("mechanism '{}'", m.name),
            what: "its tangent stiffness".into(),
            value,
        });
    }
    let verdicts: Vec<_> = (0..m.limbs.len()).map(|i| solver.verdicts(i)).collect();
    let limbs: Vec<LimbEquilibrium> = m
        .limbs
        .iter()
        .zip(verdicts)
        .enumerate()
        .map(|(i, (limb, (stiffness, stability)))| {
            let system = solver.limb_system(i);
            let n = limb.actual.coordinate_count();
            let r = limb.actual.actuators().len();
            let joints = &solver.posture[i];
            let loaded = ChainProblem {
                chain: &limb.actual,
                base: solver.state.platforms[limb.from],
                commands: joints.commands.clone(),
                posture: joints.coordinates.clone(),
                loads: solver.loads[i].clone(),
                end: EndCondition::pose(system.kinematics.tip_pose()),
            };
            Ok(LimbEquilibrium {
                load_energy: load_energy(&loaded, &solver.state.coordinates[i])?,
                conservative: m.loads_conservative(i),
                link_loads: link_loads(&limb.actual, &system.spring_torque),
                nodes: (0..limb.actual.nodes().len())
                    .map(|node| system.kinematics.node_pose(node))
                    .collect(),
                name: limb.name.clone(),
                wrench: solver.state.wrenches[i],
                coordinates: solver.state.coordinates[i].clone(),
                spring_torques: system.spring_torque.clone(),
                energy: system.energy,
                actuator_forces: system.torque[n..n + r].to_vec(),
                stiffness,
                stability,
            })
        })
        .collect::<Result<_>>()?;
    let weights: f64 = m
        .platforms
        .iter()
        .zip(&solver.state.platforms)
        .skip(1)
        .map(|(p, pose)| {
            let centre = pose * nalgebra::Point3::from(p.centre_of_mass);
            -p.mass * m.gravity.dot(&centre.coords)
        })
        .sum();
    // A dead force has a potential; a dead moment is not asked for one here.
    let dead = solver.others.iter().map(|(platform, wrench)| {
        let place = solver.state.platforms[*platform].translation.vector;
        (wrench.moment() == nalgebra::Vector3::zeros()).then(|| -wrench.force().dot(&place))
    });
    let between = m.platform_loads.iter();
    let between = between.map(|load| load.energy(&solver.state.platforms));
    let outside = dead.chain(between).sum::<Option<f64>>();
    let outside = outside.map(|outside| outside + weights);
    let energy = limbs.iter().fold(outside, |sum, limb| {
        Some(sum? + limb.energy + limb.load_energy?)
    });
    // With platforms in between, what blocks the tool is not one limb's affair.
    let own: Vec<&ChainStiffness> = limbs.iter().map(|limb| &limb.stiffness).collect();
    let graded = solver.graded(&tangent, &own);
    let (stiffness, directions) = if m.platforms.len() > 2 {
        condensed_directions(&tangent, graded.as_ref(), &rigid, tool - 1, scale)
    } else {
        let mut stiffness = Matrix6::zeros();
        for &(i, j, value) in &tangent.entries {
            stiffness[(i, j)] += value;
        }
        let own = own.into_iter().zip(&m.limbs).map(|(limb, description)| {
            let arm = solver.state.platforms[tool].rotation
                * description.platform_from_tip.translation.vector;
            (limb, arm, description.actual.scale())
        });
        let directions = balanced_directions(&stiffness, graded.as_ref(), scale, own);
        (stiffness, directions)
    };
    let least = directions
        .iter()
        .map(|d| d.stiffness_n_per_m)
        .fold(f64::INFINITY, f64::min);
    let free = directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Free)
        .count();
    let conservative = outside.is_some()
        && limbs.iter().all(|l| l.conservative)
        && (solver.unknowns == Unknowns::Held
            || m.tool_moment_has_potential(&solver.dead_moment(&wrench)));
    let held = solver.unknowns == Unknowns::Held;
    let hold = |held| others_hold(&tangent, graded.as_ref(), &rigid, tool - 1, scale, held);
    let whole = limbs.iter().all(LimbEquilibrium::follows_its_end);
    let stays = |held| {
        !conservative && none_diverges(&tangent, &directions, &rigid, tool - 1, scale, held, whole)
    };
    let definite = least >= 0.0 && hold(held);
    let stable = definite || stays(held);
    let others_hold = hold(true) || stays(true);
    let answer = MechanismEquilibrium {
        tool: solver.state.platforms[tool],
        displacement: pose_residual(&solver.state.platforms[tool], &solver.target),
        conservative,
        energy,
        wrench,
        stiffness: CartesianStiffness { matrix: stiffness },
        platform: PlatformStability {
            stable,
            may_flutter: stable && !definite,
            smallest_stiffness_n_per_m: least,
            free,
        },
        others_hold,
        directions,
        length: scale.length,
        limbs,
        residual,
        state: solver.state.clone(),
    };
    Ok(answer.named(m))
}
