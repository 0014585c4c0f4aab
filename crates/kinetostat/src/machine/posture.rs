//! A mechanism commanded for a target, and what it does there: `f(t | t0)`, `f^-1(F | t0)`,
//! stiffness, assembly [R 6.1-6.30].
//!
//! The thing right of the bar is a [`Posture`]; the thing left of it is an argument.

use crate::error::{Error, Result};
use crate::machine::inverse::graph::{GraphPosture, graph_inverse};
use crate::machine::inverse::limb::{LimbPosture, inverse_kinematics};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::state::MechanismState;
use crate::model::kinematics::unloaded_tip;
use crate::model::mechanism::Mechanism;
use crate::settings::Settings;
use crate::spatial::{MotionKind, Pose, Wrench};

/// A mechanism whose actuators are commanded for a nominal target of the tool.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let drive = |stiffness, limits| ActuatorSpec {
/// #     limits: Some(limits), // rad
/// #     home: 0.5,
/// #     ..ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness) // N m/rad
/// # };
/// # let chain = Chain::builder("arm")
/// #     .actuator("shoulder", drive(2e5, (-2.0, 2.0)))
/// #     .translation(vector![0.6, 0.0, 0.0])
/// #     .actuator("elbow", drive(1e5, (0.2, 2.5)))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// # let turn = Pose::rotation(vector![0.0, 0.0, 0.5]); // rad: both joints at home
/// # let home = turn * Pose::translation(0.6, 0.0, 0.0) * turn * Pose::translation(0.5, 0.0, 0.0);
/// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
/// // An arm of 0.6 m and 0.5 m, commanded so that its tool is at a distance r of the shoulder.
/// let posture = arm.posture(PostureRequest::position(&vector![0.5, 0.6, 0.0], &home.rotation))?;
/// let commands = posture.commands(); // rad
/// let cosine = (0.5 * 0.5 + 0.6 * 0.6 - 0.6 * 0.6 - 0.5 * 0.5) / (2.0 * 0.6 * 0.5);
/// assert!((commands[1].cos() - cosine).abs() < 1e-9, "the law of cosines");
/// assert_eq!(posture.limbs()[0].commands, commands, "one limb has them all");
/// assert_eq!(posture.platforms()[posture.mechanism().tool()], *posture.target());
/// assert!(posture.limit_violations().is_empty() && posture.within_limits().is_ok());
/// // Nothing is bent in its state of rest.
/// let rest = posture.rest_state();
/// assert!(rest.coordinates[0].iter().all(|deflection| *deflection == 0.0) && rest.wrenches[0] == Wrench::zero());
/// // A posture is asked with tolerances of its own.
/// let quick = posture.with_settings(Settings::default().with_iterations(20));
/// assert_eq!(quick.settings().iterations, 20);
///
/// // Stretched, its elbow passes its limit of 0.2 rad.
/// let straight = arm.posture(PostureRequest::commands(&[0.3, 0.1]))?;
/// assert_eq!(straight.limit_violations(), [("elbow".to_owned(), 0.1, (0.2, 2.5))]);
/// assert!(matches!(straight.within_limits(), Err(Error::OutsideLimits { .. })));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Posture {
    pub(crate) mechanism: Mechanism,
    settings: Settings,
    pub(crate) target: Pose,
    /// Nominal poses of all platforms, the base first.
    pub(crate) platforms: Vec<Pose>,
    pub(crate) limbs: Vec<LimbPosture>,
    /// Dead wrenches on platforms other than the tool.
    pub(crate) others: Vec<(usize, Wrench)>,
}

impl Mechanism {
    /// Commands the actuators for a target of the tool, from home or near the joints of another posture.
    pub(crate) fn posture_at_pose(&self, target: &Pose, near: Option<&Posture>) -> Result<Posture> {
        let place = self.place();
        crate::model::limits::check_pose(&place, "the target pose", target)?;
        let mut platforms: Vec<Pose> = self.platforms().iter().map(|p| p.home).collect();
        platforms[self.tool()] = *target;
        let limbs = if self.platforms().len() > 2 {
            let start = near.map(|near| GraphPosture {
                platforms: near.platforms.clone(),
                limbs: near.limbs.clone(),
            });
            let found = graph_inverse(self, target, start.as_ref())?;
            platforms = found.platforms;
            found.limbs
        } else {
            let mut limbs = Vec::with_capacity(self.limbs().len());
            for (i, limb) in self.limbs().iter().enumerate() {
                let tip = target * limb.platform_from_tip;
                let start = near.map(|near| &near.limbs[i]);
                let base = &platforms[limb.from];
                let found = inverse_kinematics(&limb.nominal, base, &tip, start);
                limbs.push(found.map_err(|error| of_tool(error, &limb.platform_from_tip))?);
            }
            limbs
        };
        Ok(Posture {
            mechanism: self.clone(),
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
    pub(crate) fn posture_from_joints(
        &self,
        target: &Pose,
        limbs: Vec<LimbPosture>,
    ) -> Result<Posture> {
        if limbs.len() != self.limbs().len() {
            return Err(Error::Size {
                place: self.place(),
                what: "limb postures",
                expected: self.limbs().len(),
                found: limbs.len(),
            });
        }
        for (limb, joints) in self.limbs().iter().zip(&limbs) {
            limb.nominal.check(&joints.coordinates, &joints.commands)?;
        }
        let platforms = self.platforms_from_joints(target, &limbs);
        Ok(Posture {
            mechanism: self.clone(),
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
        let mut platforms: Vec<Pose> = self.platforms().iter().map(|p| p.home).collect();
        platforms[self.tool()] = *target;
        let mut known: Vec<bool> = (0..platforms.len())
            .map(|p| p == 0 || p == self.tool())
            .collect();
        loop {
            let before = known.clone();
            for (limb, joints) in self.limbs().iter().zip(limbs) {
                if before[limb.from] == before[limb.to] || (known[limb.from] && known[limb.to]) {
                    continue;
                }
                // Tip of the limb from its own base.
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
}

impl Posture {
    /// The mechanism of which this is a posture, nominal and as built.
    #[must_use]
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// Nominal target of the tool, `t0`.
    #[must_use]
    pub fn target(&self) -> &Pose {
        &self.target
    }

    /// Commands and coordinates (m, rad) of every limb, in the mechanism's order.
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

    /// Sets other tolerances.
    #[must_use]
    pub fn with_settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// Adds a dead wrench on a platform (its index), about the platform's origin, base axes. It acts in every
    /// equilibrium of this posture.
    ///
    /// # Errors
    /// [`Error::Model`] for the base or a platform that does not exist; [`Error::NotFinite`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// # let rail = Chain::builder("rail").actuator("trolley", slide(Vector3::x(), 1e6)).build()?; // N/m
    /// # let boom = Chain::builder("boom").actuator("hoist", slide(Vector3::z(), 1e5)).build()?; // N/m
    /// # let mut machine = Mechanism::builder("crane");
    /// # let carriage = machine.platform(Platform::new("carriage", Pose::identity()));
    /// # let hook = machine.platform(Platform::new("hook", Pose::identity()));
    /// # let machine = machine.limb(Limb::between("rail", 0, carriage, rail));
    /// # let crane = machine.limb(Limb::between("boom", carriage, hook, boom)).build()?;
    /// let pull = Wrench::new(vector![-500.0, 70.0, 900.0], Vector3::zeros()); // N
    /// let pulled = crane.posture(&Pose::identity())?.with_wrench_on(carriage, pull)?;
    /// let load = Wrench::new(vector![200.0, 0.0, -300.0], Vector3::zeros());
    /// let moved = pulled.deflected_by(&load)?.displacement.linear();
    /// // The trolley's spring carries what acts on carriage and hook, the hoist's only what acts on the hook.
    /// assert!((moved - vector![(200.0 - 500.0) / 1e6, 0.0, -300.0 / 1e5]).norm() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn with_wrench_on(mut self, platform: usize, wrench: Wrench) -> Result<Self> {
        self.finite("the wrench on a platform", wrench.0.iter())?;
        let count = self.mechanism.platforms().len();
        if platform == 0 || platform >= count {
            return Err(Error::model(
                self.mechanism.place(),
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
            .limbs()
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

    /// Checks that no command lies outside its limits.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`] for the first that does.
    pub fn within_limits(&self) -> Result<()> {
        let Some((actuator, command, (low, high))) = self.limit_violations().into_iter().next()
        else {
            return Ok(());
        };
        let limbs = self.mechanism.limbs().iter();
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

    pub(crate) fn solver(&self, state: MechanismState, unknowns: Unknowns) -> PlatformSolver<'_> {
        let mut solver = PlatformSolver::new(
            &self.mechanism,
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

    pub(crate) fn finite<'a>(
        &self,
        what: &str,
        mut values: impl Iterator<Item = &'a f64>,
    ) -> Result<()> {
        let place = self.mechanism.place();
        self.settings.check(&place)?;
        values.try_for_each(|value| {
            crate::model::limits::check_number(&place, || what.to_owned(), *value)
        })
    }
}

/// A limb's nearest pose is reported as the pose that the tool would have with it.
fn of_tool(mut error: Error, platform_from_tip: &Pose) -> Error {
    if let Error::Unreachable { nearest, .. } = &mut error {
        **nearest *= platform_from_tip.inverse();
    }
    error
}
