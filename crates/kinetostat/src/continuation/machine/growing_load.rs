//! Equilibrium of a machine under a load: by Newton's iteration, along a motion that needs no force without load, or
//! with a load that grows [R 5.5.3].

use crate::chain::problem::EndCondition;
use crate::chain::residual::{FoundBy, Residual};
use crate::chain::scaling::{FAR, SHORT_STEP, gone};
use crate::continuation::machine::free_motion::{Converged, NoRest};
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::continuation::settings::{CurveSettings, LoadPattern, Parameter};
use crate::error::{Error, LoadLimit, Result};
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::{MechanismState, check_state};
use crate::number::largest_size;
use crate::spatial::{Wrench, pose_residual};

/// A limit below this share of the load is none.
const LEAST_SHARE: f64 = 1e-9;

/// Points times coordinates of a path that only explains why there is no equilibrium.
const EFFORT: usize = 20_000;

/// Secant and tangent compliances along a load that differ less belong to one smooth branch.
const SMOOTH: f64 = 2.0;

impl Posture {
    /// Detects a limit point that a load from rest meets before it is whole, though `loaded` was found beyond it: then
    /// the machine snaps before, and `loaded` lies on another branch. `rest` is the equilibrium without the wrench of
    /// `loaded`. The load is followed only where secant and tangents disagree or their stability differs.
    ///
    /// # Errors
    /// Those of the equilibrium without load.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # // A spring across a guide: it snaps through where the guide is as high as its far end.
    /// # let (b, h, k, own) = (0.5_f64, 0.1_f64, 1e5, 100.0); // m, m, N/m, N/m
    /// # let free_length = b.hypot(h);
    /// # let chain = Chain::builder("guide")
    /// #     .spring("slide", MotionKind::Prismatic, Vector3::z(), own, h)
    /// #     .home("slide", h)
    /// #     .build()?;
    /// # let (post, tip) = (Anchor::Base(vector![b, 0.0, 0.0]), Anchor::node(chain.tip()));
    /// # let spring = Load::spring_between(post, tip, k, free_length);
    /// # let home = Pose::translation(0.0, 0.0, h);
    /// # let guide = Mechanism::serial(chain, home, Vector3::zeros())?.with_load("guide", spring)?;
    /// let posture = guide.posture(&home)?;
    /// let rest = posture.deflected_by(&Wrench::zero())?;
    /// // The force is largest where length^3 = b^2 times the free length, a little less for the slide's own spring.
    /// let top = (free_length * b * b / (1.0 + own / k)).powf(2.0 / 3.0); // length^2
    /// let (z, length) = ((top - b * b).sqrt(), top.sqrt());
    /// let largest = k * (free_length - length) * z / length + own * (h - z); // N
    /// for share in [0.9, -3.0] {
    ///     let push = Wrench::new(vector![0.0, 0.0, -share * largest], Vector3::zeros());
    ///     let loaded = posture.deflected_by(&push)?;
    ///     assert_eq!(posture.snaps_before(&rest, &loaded)?, None, "below the limit, or pulled up");
    /// }
    /// let push = Wrench::new(vector![0.0, 0.0, -20.0 * largest], Vector3::zeros());
    /// let beyond = posture.deflected_by(&push)?;
    /// assert!(beyond.stable() && beyond.tool.translation.z < -0.2, "it hangs on the other side");
    /// let limit = posture.snaps_before(&rest, &beyond)?.expect("it has snapped on the way");
    /// assert!((limit.share * 20.0 - 1.0).abs() < 1e-6);
    /// assert!((limit.displacement.linear().z - (z - h)).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn snaps_before(
        &self,
        rest: &MechanismEquilibrium,
        loaded: &MechanismEquilibrium,
    ) -> Result<Option<LoadLimit>> {
        let wrench = loaded.wrench;
        if wrench.0.norm() == 0.0 {
            return Ok(None);
        }
        let by = |e: &MechanismEquilibrium| wrench.0.dot(&(e.compliance().springs * wrench.0));
        let secant = pose_residual(&loaded.tool, &rest.tool).dot(&wrench);
        let yields = [by(rest), by(loaded), secant];
        let most = largest_size(yields);
        let smooth = yields.iter().all(|y| *y * SMOOTH > most) || most == 0.0;
        if smooth && loaded.stable() >= rest.stable() {
            return Ok(None);
        }
        Ok(self.under_growing_load(&wrench)?.1)
    }

    /// Newton's equilibrium under a wrench from a state; where it finds none, along motions that cost nothing, or with
    /// the load growing from rest.
    pub(crate) fn converged_solver(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> Result<Converged<'_>> {
        self.finite("the wrench", wrench.0.iter())?;
        check_state(&self.mechanism, &start)?;
        let none = match self.reached_directly(wrench, start) {
            Ok(found) => return Ok(found),
            Err(none) => *none,
        };
        if let NoRest::Lost(newton, _) = &none
            && wrench.0.norm() > 0.0
            && let Ok((state, limit)) = self.under_growing_load(wrench)
        {
            if let Some(found) =
                state.and_then(|state| self.finished(state, wrench, FoundBy::GrowingLoad))
            {
                return Ok(found);
            }
            if let Some(limit) = limit {
                return Err(newton.clone().at_limit(limit));
            }
            if let Ok(found) = self.grown(wrench) {
                return Ok(found);
            }
        }
        Err(self.no_rest(none, wrench))
    }

    /// Equilibrium that Newton finds from a state, or to which a free motion leads.
    fn reached_directly(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> std::result::Result<Converged<'_>, Box<NoRest>> {
        let from = |state: MechanismState| {
            let mut solver = self.solver(state, Unknowns::Pose);
            solver.wrench = *wrench;
            solver
        };
        let mut solver = from(start.clone());
        match solver.solve_robustly() {
            Ok(residual) => Ok((solver, residual)),
            Err(newton) => {
                let mut solver = from(start);
                match solver.relax() {
                    Some(residual) => Ok((solver, residual)),
                    None => self.along_free_motions(wrench, newton),
                }
            }
        }
    }

    fn no_rest(&self, none: NoRest, wrench: &Wrench) -> Error {
        match none {
            NoRest::Endless(motion) | NoRest::Lost(_, Some(motion)) => {
                self.free_direction(&motion, wrench)
            }
            NoRest::Lost(newton, None) => newton,
        }
    }

    /// Equilibrium of the machine without a wrench on its tool.
    fn rest_without_wrench(&self) -> Result<MechanismState> {
        let none = Wrench::zero();
        match self.reached_directly(&none, self.rest_state()) {
            Ok((solver, residual)) => self.stable_state(&none, solver, residual),
            Err(reason) => Err(self.no_rest(*reason, &none)),
        }
    }

    /// The state at which a solver arrived, or the stable one to which the growing load leads where that lies far.
    pub(crate) fn stable_state(
        &self,
        wrench: &Wrench,
        mut solver: PlatformSolver<'_>,
        residual: Residual,
    ) -> Result<MechanismState> {
        if !self.is_far(&solver.state) {
            return Ok(solver.state);
        }
        let found = conclude(&mut solver, residual)?;
        Ok(self.by_growing_load(wrench, &found).unwrap_or(found).state)
    }

    /// The load grown from rest in short steps.
    pub(crate) fn grown(&self, wrench: &Wrench) -> Result<Converged<'_>> {
        let mut solver = self.solver(self.rest_state(), Unknowns::Pose);
        solver.wrench = *wrench;
        let at_rest = solver.evaluate().0;
        let residual = solver.grow_load(&at_rest, SHORT_STEP)?;
        Ok((solver, residual))
    }

    /// The stable equilibrium to which the growing load leads, where one step found another that does not stay and
    /// which lies far: it may have passed the former.
    pub(crate) fn by_growing_load(
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

    /// True if one step may have passed the equilibrium to which the growing load leads.
    fn is_far(&self, state: &MechanismState) -> bool {
        let limbs = self.mechanism.limbs().iter().zip(&self.limbs);
        let moved = limbs
            .zip(&state.coordinates)
            .map(|((limb, home), there)| gone(&limb.actual, &home.coordinates, there));
        moved.sum::<f64>() > FAR
    }

    /// State at the whole load, if the branch from rest reaches it without a limit; the first limit
    /// at which it stops being stable.
    fn under_growing_load(
        &self,
        wrench: &Wrench,
    ) -> Result<(Option<MechanismState>, Option<LoadLimit>)> {
        let load = Parameter::Load(LoadPattern {
            end: *wrench,
            loads: Vec::new(),
        });
        // The cost is bounded: this only explains why there is no equilibrium.
        let limbs = self.mechanism.limbs().iter();
        let coordinates: usize = limbs.map(|l| l.actual.coordinate_count()).sum();
        let mut settings = CurveSettings::within(0.0, 1.0);
        settings.points = (EFFORT / coordinates.max(1)).clamp(10, settings.points);
        let end = EndCondition::wrench(Wrench::zero());
        let path = ToolConditions::new(self, &load, &end, &settings)?;
        // Motions that cost nothing have no limit but rounding.
        let rest = self.rest_without_wrench()?;
        let (whole, limit) = path.growing(rest, |p| p.parameter <= LEAST_SHARE)?;
        let limit = limit.map(|p| LoadLimit {
            share: p.parameter,
            displacement: p.equilibrium.displacement,
        });
        Ok((whole.map(|p| p.equilibrium.state), limit))
    }
}

impl Posture {
    /// `f^-1(F | t0)`: where the tool goes under a dead wrench at its origin [R 6.28-6.30], with
    /// gravity, preloads and assembly errors of the model.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the last state and share of the load, and the limit point if
    /// one lies before it; [`Error::FreeDirection`] where the load pushes on along a motion that
    /// nothing holds, as far as it can be followed.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let pull = Wrench::new(vector![0.0, 200.0, 0.0], Vector3::zeros()); // N, N m
    /// let loaded = arm.posture(&home)?.deflected_by(&pull)?;
    /// assert!(loaded.stable());
    /// let shift = 1e3 * loaded.displacement.linear().y; // mm
    /// assert!(shift > 0.0 && shift < 5.0);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn deflected_by(&self, wrench: &Wrench) -> Result<MechanismEquilibrium> {
        self.deflected_from(wrench, self.rest_state())
    }

    /// Deflects like [`Self::deflected_by`], starting from the state of a neighbouring equilibrium.
    ///
    /// # Errors
    /// See [`Self::deflected_by`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = arm.posture(&home)?;
    /// let pull = Wrench::new(vector![0.0, 200.0, 0.0], Vector3::zeros()); // N, N m
    /// let first = posture.deflected_by(&pull)?;
    /// let next = posture.deflected_from(&(1.1 * pull), first.state.clone())?;
    /// assert!(next.displacement.linear().y > first.displacement.linear().y);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn deflected_from(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> Result<MechanismEquilibrium> {
        let (mut solver, residual) = self.converged_solver(wrench, start)?;
        let found = conclude(&mut solver, residual)?;
        Ok(self.by_growing_load(wrench, &found).unwrap_or(found))
    }

    /// Only where the platforms and limbs come to rest: [`Self::deflected_from`] without stiffness
    /// and stability, for fields of many points.
    ///
    /// # Errors
    /// As [`Self::deflected_by`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .build()?;
    /// # let home = Pose::translation(0.1, -0.2, 0.0);
    /// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = gantry.posture(&home)?;
    /// let mut state = posture.rest_state();
    /// for force in [100.0, 250.0, 400.0] {
    ///     let cutting = Wrench::new(vector![force, -0.5 * force, 0.0], Vector3::zeros()); // N
    ///     state = posture.rest_under(&cutting, state)?; // each from the one before
    ///     let gone = state.platforms[gantry.tool()].translation.vector - home.translation.vector;
    ///     assert!((gone - vector![force, -0.5 * force, 0.0] / 5e7).norm() < 1e-15, "the springs of its drives");
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn rest_under(&self, wrench: &Wrench, start: MechanismState) -> Result<MechanismState> {
        let (solver, residual) = self.converged_solver(wrench, start)?;
        self.stable_state(wrench, solver, residual)
    }
}
