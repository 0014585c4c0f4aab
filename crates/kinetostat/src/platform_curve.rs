//! The wrench that holds the tool, followed along a way of the tool: branches, limit points and
//! snap-through of a machine [R 5.5.3, Table 5.3].

use crate::error::Result;
use crate::platform::{MechanismState, Unknowns};
use crate::posture::{MechanismEquilibrium, Posture, conclude};
use crate::spatial::{Pose, Twist, moved, pose_residual};

/// One point of a curve.
#[derive(Clone, Debug)]
pub struct HeldPoint {
    /// Along the direction from the nominal target, in units of the direction.
    pub along: f64,
    /// Component of the holding wrench in the direction: `direction . wrench`, N (if the direction
    /// moves by 1 m).
    pub force: f64,
    /// Its derivative along the way, `direction^T K direction`, N/m.
    pub slope: f64,
    /// The equilibrium.
    pub equilibrium: MechanismEquilibrium,
}

/// A curve of holding wrenches.
#[derive(Clone, Debug)]
pub struct HeldCurve {
    /// Points in the order of the way.
    pub points: Vec<HeldPoint>,
    /// Where the force has a maximum or minimum: under a dead load of that size and direction the
    /// tool snaps through.
    pub limits: Vec<HeldPoint>,
    /// Why it ended early.
    pub ended: Option<crate::error::Error>,
}

impl<'m> Posture<'m> {
    /// As [`Posture::wrench_at`], continued from the state of a neighbouring equilibrium, so that
    /// its branch is kept: the tool is taken there directly, and if that fails in ever smaller
    /// steps; never from rest.
    ///
    /// # Errors
    /// [`crate::Error::NotConverged`] where the branch cannot be followed; the share of the load is
    /// that of the way.
    pub fn wrench_at_from(
        &self,
        pose: &Pose,
        start: MechanismState,
    ) -> Result<MechanismEquilibrium> {
        self.finite("the pose", pose.to_homogeneous().iter())?;
        let tool = self.mechanism.tool;
        let from = start.platforms[tool];
        let way = pose_residual(pose, &from);
        let mut solver = self.solver(start, Unknowns::Held);
        let (mut share, mut step, mut spent) = (0.0_f64, 1.0_f64, 0);
        loop {
            let next = (share + step).min(1.0);
            let kept = solver.state.clone();
            solver.state.platforms[tool] = if next == 1.0 {
                *pose
            } else {
                moved(&from, &Twist(way.0 * next))
            };
            match solver.solve(1.0, 0) {
                Ok((iterations, balance)) => {
                    spent += iterations;
                    share = next;
                    if share == 1.0 {
                        let residual = balance.residual(spent);
                        return conclude(&mut solver, residual);
                    }
                }
                Err((iterations, balance)) => {
                    spent += iterations;
                    solver.state = kept;
                    step *= 0.5;
                    if step < 1.0 / 1024.0 {
                        return Err(solver.not_converged(spent, share, &balance));
                    }
                }
            }
        }
    }

    /// The holding wrench along `moved(target, direction * s)` for the given `s` in their order,
    /// each point from the one before, the first from `start` or from rest. Limit points are found
    /// between points of opposite slope.
    ///
    /// # Errors
    /// Those of the first point; a curve that ends later says so in [`HeldCurve::ended`].
    pub fn held_along(
        &self,
        direction: &Twist,
        way: &[f64],
        start: Option<MechanismState>,
    ) -> Result<HeldCurve> {
        let mut curve = HeldCurve {
            points: Vec::with_capacity(way.len()),
            limits: Vec::new(),
            ended: None,
        };
        for &along in way {
            let point = match (curve.points.last(), &start) {
                (Some(last), _) => self.held(direction, along, &last.equilibrium.state),
                (None, Some(state)) => self.held(direction, along, state),
                (None, None) => {
                    let pose = moved(&self.target, &Twist(direction.0 * along));
                    let equilibrium = self.wrench_at(&pose)?;
                    Ok(point(direction, along, equilibrium))
                }
            };
            match point {
                Ok(point) => curve.points.push(point),
                Err(error) if curve.points.is_empty() => return Err(error),
                Err(error) => {
                    curve.ended = Some(error);
                    break;
                }
            }
        }
        for pair in curve.points.windows(2) {
            if pair[0].slope * pair[1].slope < 0.0
                && let Some(limit) = self.limit_between(direction, &pair[0], &pair[1])
            {
                curve.limits.push(limit);
            }
        }
        Ok(curve)
    }

    fn held(&self, direction: &Twist, along: f64, state: &MechanismState) -> Result<HeldPoint> {
        let pose = moved(&self.target, &Twist(direction.0 * along));
        let equilibrium = self.wrench_at_from(&pose, state.clone())?;
        Ok(point(direction, along, equilibrium))
    }

    /// Zero of the slope, by false position with halving (Illinois).
    fn limit_between(&self, direction: &Twist, a: &HeldPoint, b: &HeldPoint) -> Option<HeldPoint> {
        let (mut a, mut b) = (a.clone(), b.clone());
        let (mut fa, mut fb) = (a.slope, b.slope);
        let range = (b.along - a.along).abs();
        let size = fa.abs().max(fb.abs());
        for _ in 0..60 {
            let along = (fa * b.along - fb * a.along) / (fa - fb);
            let next = self.held(direction, along, &a.equilibrium.state).ok()?;
            if next.slope.abs() <= 1e-10 * size || (b.along - a.along).abs() <= 1e-12 * range {
                return Some(next);
            }
            if next.slope * b.slope < 0.0 {
                (a, fa) = (b, fb);
            } else {
                fa *= 0.5;
            }
            fb = next.slope;
            b = next;
        }
        Some(b)
    }
}

fn point(direction: &Twist, along: f64, equilibrium: MechanismEquilibrium) -> HeldPoint {
    HeldPoint {
        along,
        force: direction.dot(&equilibrium.wrench),
        slope: direction.0.dot(&(equilibrium.stiffness.matrix * direction.0)),
        equilibrium,
    }
}
