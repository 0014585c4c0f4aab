//! Equilibrium of a machine along a motion of its tool that needs no force without load.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::{Direction, DirectionKind, motion_description};
use crate::chain::problem::EndCondition;
use crate::chain::residual::{FoundBy, Residual};
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::continuation::settings::CurveSettings;
use crate::error::Error;
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::spatial::{Twist, Wrench};

/// Largest distance over which a tool is followed, in natural lengths: more than half a turn about any axis nearby.
const FARTHEST: f64 = 12.0;

/// The logarithm of a rotation ends at half a turn.
const LARGEST_TURN: f64 = 3.0;

/// Steps by which a tool is followed, at most.
const STEPS: usize = 2000;

/// Outcome of following a tool along a motion.
enum FollowedTo {
    /// No hand is needed any more.
    Rest(MechanismState),
    /// The load pushes on however far one follows.
    Endless,
    /// No neighbour was found; whether the load still pushed nearly as at the start.
    Lost(bool),
}

/// A solver at an equilibrium, and its residual.
pub(crate) type Converged<'p> = (PlatformSolver<'p>, Residual);

/// Reason why there is no equilibrium where Newton found none and no free motion led to one.
pub(crate) enum NoRest {
    /// The load pushes on along a motion however far one follows.
    Endless(Twist),
    /// Newton's error, and the first motion along which the load still pushed nearly as at the start.
    Lost(Error, Option<Twist>),
}

impl Posture {
    /// The equilibrium under a wrench that Newton did not find: one motion after the other may lead to it.
    pub(crate) fn along_free_motions(
        &self,
        wrench: &Wrench,
        newton: Error,
    ) -> std::result::Result<Converged<'_>, Box<NoRest>> {
        let mut pushed = None;
        for motion in self.costless_motions(wrench) {
            match self.follow_free_motion(&motion, wrench) {
                FollowedTo::Rest(state) => {
                    if let Some(found) = self.finished(state, wrench, FoundBy::OtherStart) {
                        return Ok(found);
                    }
                }
                FollowedTo::Endless => return Err(Box::new(NoRest::Endless(motion))),
                FollowedTo::Lost(true) => pushed = pushed.or(Some(motion)),
                FollowedTo::Lost(false) => {}
            }
        }
        Err(Box::new(NoRest::Lost(newton, pushed)))
    }

    /// Newton from a state near the equilibrium.
    pub(crate) fn finished(
        &self,
        state: MechanismState,
        wrench: &Wrench,
        found_by: FoundBy,
    ) -> Option<Converged<'_>> {
        let mut solver = self.solver(state, Unknowns::Pose);
        solver.wrench = *wrench;
        let (iterations, norms) = solver.solve(1.0, 0).ok()?;
        solver.found_by = found_by;
        Some((solver, norms.residual(iterations)))
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
            here = next.onwards_from(&here);
        }
        FollowedTo::Lost(false)
    }

    /// Error of a load that pushes on along a motion.
    pub(crate) fn free_direction(&self, motion: &Twist, wrench: &Wrench) -> Error {
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
