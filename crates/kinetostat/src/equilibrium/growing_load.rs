//! Where a machine comes to rest when Newton does not find it from the unloaded posture: followed along
//! a motion that costs nothing without load, or with a load that grows [R 5.5.3].

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::{Direction, DirectionKind, motion_description};
use crate::chain::found_by::FoundBy;
use crate::chain::problem::EndCondition;
use crate::chain::residual::Residual;
use crate::chain::scaling::SHORT_STEP;
use crate::continuation::parameter::{LoadPattern, Parameter};
use crate::continuation::settings::CurveSettings;
use crate::continuation::tool_conditions::ToolConditions;
use crate::error::{Error, LoadLimit, Result};
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::number::larger;
use crate::spatial::{Twist, Wrench, pose_residual};

/// How far a tool is followed, in natural lengths: more than half a turn about any axis nearby.
const FARTHEST: f64 = 12.0;

/// The logarithm of a rotation ends at half a turn.
const LARGEST_TURN: f64 = 3.0;

/// Steps by which a tool is followed, at most.
const STEPS: usize = 2000;

/// A limit below this share of the load is none.
const LEAST_SHARE: f64 = 1e-9;

/// Points times coordinates of a path that only explains why there is no equilibrium.
const EFFORT: usize = 20_000;

/// Secant and tangent compliances along a load that differ less belong to one smooth branch.
const SMOOTH: f64 = 2.0;

/// How following a tool along a motion ends.
enum FollowedTo {
    /// No hand is needed any more.
    Rest(MechanismState),
    /// The load pushes on however far one follows.
    Endless,
    /// No neighbour was found; whether the load still pushed nearly as at the start.
    Lost(bool),
}

impl Posture {
    /// Whether a load from rest meets a limit point before it is whole, though `loaded` was found
    /// beyond it: then the machine snaps before, and `loaded` lies on another branch. `rest` is
    /// the equilibrium without the wrench of `loaded`. The load is followed only where secant and
    /// tangents disagree or their stability differs.
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
        let most = yields.iter().fold(0.0_f64, |most, y| larger(most, y.abs()));
        let smooth = yields.iter().all(|y| *y * SMOOTH > most) || most == 0.0;
        if smooth && loaded.stable() >= rest.stable() {
            return Ok(None);
        }
        Ok(self.under_growing_load(&wrench)?.1)
    }

    /// The equilibrium under a wrench that Newton did not find, and why there is none.
    pub(crate) fn found_otherwise(
        &self,
        wrench: &Wrench,
        error: Error,
    ) -> Result<(PlatformSolver<'_>, Residual)> {
        let mut pushed = None;
        for motion in self.costless_motions(wrench) {
            match self.follow_free_motion(&motion, wrench) {
                FollowedTo::Rest(state) => {
                    if let Some(found) = self.finished(state, wrench, FoundBy::OtherStart) {
                        return Ok(found);
                    }
                }
                FollowedTo::Endless => return Err(self.free_direction(&motion, wrench)),
                FollowedTo::Lost(true) => pushed = pushed.or(Some(motion)),
                FollowedTo::Lost(false) => {}
            }
        }
        if wrench.0.norm() > 0.0
            && let Ok((state, limit)) = self.under_growing_load(wrench)
        {
            if let Some(found) =
                state.and_then(|state| self.finished(state, wrench, FoundBy::GrowingLoad))
            {
                return Ok(found);
            }
            if let Some(limit) = limit {
                return Err(error.at_limit(limit));
            }
            if let Ok(found) = self.grown(wrench) {
                return Ok(found);
            }
        }
        Err(match pushed {
            Some(motion) => self.free_direction(&motion, wrench),
            None => error,
        })
    }

    /// The load grown from rest in short steps.
    pub(crate) fn grown(&self, wrench: &Wrench) -> Result<(PlatformSolver<'_>, Residual)> {
        let mut solver = self.solver(self.rest_state(), Unknowns::Pose);
        solver.wrench = *wrench;
        let at_rest = solver.evaluate().0;
        let residual = solver.grow_load(&at_rest, SHORT_STEP)?;
        Ok((solver, residual))
    }

    /// Newton from a state near the equilibrium.
    fn finished(
        &self,
        state: MechanismState,
        wrench: &Wrench,
        found_by: FoundBy,
    ) -> Option<(PlatformSolver<'_>, Residual)> {
        let mut solver = self.solver(state, Unknowns::Pose);
        solver.wrench = *wrench;
        let (iterations, norms) = solver.solve(1.0, 0).ok()?;
        solver.found_by = found_by;
        Some((solver, norms.residual(iterations)))
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
        // What it may cost is bounded: it only says why there is no equilibrium.
        let limbs = self.mechanism.limbs().iter();
        let coordinates: usize = limbs.map(|l| l.actual.coordinate_count()).sum();
        let mut settings = CurveSettings::within(0.0, 1.0);
        settings.points = (EFFORT / coordinates.max(1)).clamp(10, settings.points);
        let end = EndCondition::wrench(Wrench::zero());
        let path = ToolConditions::new(self, &load, &end, &settings)?;
        // Motions that cost nothing have no limit but rounding.
        let (whole, limit) = path.growing(|p| p.parameter <= LEAST_SHARE)?;
        let limit = limit.map(|p| LoadLimit {
            share: p.parameter,
            displacement: p.equilibrium.displacement,
        });
        Ok((whole.map(|p| p.equilibrium.state), limit))
    }

    /// Motions of the tool that cost nothing without load: the one that all that acts pushes along,
    /// or if it pushes along none, each by itself.
    fn costless_motions(&self, wrench: &Wrench) -> Vec<Twist> {
        let Ok(own) = self.stiffness() else {
            return Vec::new();
        };
        let free: Vec<&Direction> = (own.directions.iter())
            .filter(|d| d.kind == DirectionKind::Free)
            .collect();
        if free.is_empty() {
            return Vec::new();
        }
        // Weights and preloads push besides: what a held tool does not need of its holder.
        let push = match self.wrench_at(&self.target) {
            Ok(held) => Wrench(wrench.0 - held.wrench.0),
            Err(_) => *wrench,
        };
        let unit = |i: usize| if i < 3 { 1.0 } else { own.length };
        let size = (0..6).fold(0.0_f64, |size, i| size.hypot(push.0[i] / unit(i)));
        let columns: Vec<DVector<f64>> = free
            .iter()
            .map(|d| DVector::from_fn(6, |i, _| d.twist.0[i] * unit(i)))
            .collect();
        let basis = DMatrix::from_columns(&columns).qr().q();
        let scaled = DVector::from_fn(6, |i, _| push.0[i] / unit(i));
        let along = &basis * (basis.transpose() * scaled);
        if along.norm() > 1e-9 * size {
            let motion = along.normalize();
            return vec![Twist(Vector6::from_fn(|i, _| motion[i] / unit(i)))];
        }
        free.iter().map(|d| d.twist).collect()
    }

    /// Takes the tool along a motion while the whole load acts, in the direction in which it is pushed, until it needs
    /// no hand.
    fn follow_free_motion(&self, motion: &Twist, wrench: &Wrench) -> FollowedTo {
        let Ok(free) = ToolConditions::at_displacement(self, &EndCondition::wrench(*wrench)) else {
            return FollowedTo::Lost(false);
        };
        let path = free.driven(
            &free.scaled(&motion.0).normalize(),
            CurveSettings::within(0.0, 1.0),
        );
        let Ok(start) = path.first(0.0) else {
            return FollowedTo::Lost(false);
        };
        let hand = start.conjugate;
        let size = wrench.force().norm() + wrench.moment().norm() / path.length;
        if hand.abs() <= 1e-12 * size {
            return FollowedTo::Rest(start.equilibrium.state);
        }
        let length = path.length;
        let (mut here, mut by, mut gone) = (start, 0.05 * length, 0.0);
        for _ in 0..STEPS {
            // The hand holds back.
            let step = -hand.signum() * by;
            let Some(next) = path.step(&here, step) else {
                by *= 0.5;
                if by < 1e-7 * length {
                    return FollowedTo::Lost(here.conjugate.abs() > 0.5 * hand.abs());
                }
                continue;
            };
            if next.conjugate * hand <= 0.0 {
                let rest = path.between(&here, step, |p| p.conjugate).unwrap_or(next);
                return FollowedTo::Rest(rest.equilibrium.state);
            }
            gone += by;
            let turned = next.equilibrium.displacement.angular().norm();
            if gone > FARTHEST * length || turned > LARGEST_TURN {
                return FollowedTo::Endless;
            }
            by = (1.5 * by).min(0.1 * length);
            here = next;
        }
        FollowedTo::Lost(false)
    }

    fn free_direction(&self, motion: &Twist, wrench: &Wrench) -> Error {
        Error::FreeDirection {
            place: self.mechanism.place(),
            reason: format!(
                "no force is needed where the tool {}, and the load pushes on as far as it could be followed",
                motion_description(motion)
            ),
            wrench: Box::new(*wrench),
        }
    }
}
