//! The wrench that holds the tool, followed along a straight path of the tool: branches, limit points and
//! snap-through of a machine [R 5.5.3, Table 5.3].

use nalgebra::{DMatrix, DVector, Matrix6, Vector3};

use crate::error::Result;
use crate::linalg::complement::complement;
use crate::linalg::saddle::pseudo_inverse;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::{Guide, Unknowns};
use crate::machine::posture::Posture;
use crate::machine::state::{MechanismState, check_state};
use crate::spatial::{Pose, Twist, Wrench, moved, pose_residual};

/// One point of a curve.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DisplacementPoint {
    /// Distance along the direction from the nominal target, in units of the direction.
    pub along: f64,
    /// Component of the holding wrench in the direction, N (if the direction moves by 1 m), without
    /// the dead wrench.
    pub force: f64,
    /// Derivative of the force along the path, N/m: `direction^T K direction` for a tool held in all directions; for
    /// one pushed in one direction the stiffness with the others free.
    pub slope: f64,
    /// Equilibrium of the machine with its tool there.
    pub equilibrium: MechanismEquilibrium,
}

/// A curve of holding wrenches.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DisplacementCurve {
    /// Points in their order.
    pub points: Vec<DisplacementPoint>,
    /// Extrema of the force: under a dead load of that size and direction the tool snaps through.
    pub limits: Vec<DisplacementPoint>,
    /// Error that ended it early.
    pub ended: Option<crate::error::Error>,
}

impl Posture {
    /// Holds the tool like [`Posture::wrench_at`], continued from the state of a neighbouring equilibrium, so that its
    /// branch is kept: the tool is taken there directly, and if that fails in ever smaller steps; never from rest.
    ///
    /// # Errors
    /// [`crate::Error::NotConverged`] where the branch cannot be followed; the share of the load is
    /// that of the path.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # // A spring across a guide: it snaps through where the guide is as high as its far end.
    /// # let (b, h, k) = (0.5_f64, 0.1_f64, 1e5); // m, m, N/m
    /// # let free_length = b.hypot(h);
    /// # let chain = Chain::builder("guide").passive("slide", MotionKind::Prismatic, Vector3::z(), h).build()?;
    /// # let (post, tip) = (Anchor::Base(vector![b, 0.0, 0.0]), Anchor::node(chain.tip()));
    /// # let spring = Load::spring_between(post, tip, k, free_length);
    /// # let home = Pose::translation(0.0, 0.0, h);
    /// # let guide = Mechanism::serial(chain, home, Vector3::zeros())?.with_load("guide", spring)?;
    /// let posture = guide.posture(&home)?;
    /// let force = |z: f64| k * (b.hypot(z) - free_length) * z / b.hypot(z); // by hand
    /// let mut state = posture.rest_state();
    /// // Held, it is taken through the place where it would snap, and out on the other side.
    /// for z in [0.06, 0.02, -0.03, -0.08] {
    ///     let held = posture.wrench_at_from(&Pose::translation(0.0, 0.0, z), state)?; // each from the one before
    ///     assert!((held.wrench.force().z - force(z)).abs() < 1e-6);
    ///     state = held.state;
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn wrench_at_from(
        &self,
        pose: &Pose,
        start: MechanismState,
    ) -> Result<MechanismEquilibrium> {
        self.finite("the pose", pose.to_homogeneous().iter())?;
        check_state(&self.mechanism, &start)?;
        let tool = self.mechanism.tool();
        let from = start.platforms[tool];
        let motion = pose_residual(pose, &from);
        let mut solver = self.solver(start, Unknowns::Displacement);
        let (mut share, mut step, mut spent) = (0.0_f64, 1.0_f64, 0);
        loop {
            let next = (share + step).min(1.0);
            let kept = solver.state.clone();
            solver.state.platforms[tool] = if next == 1.0 {
                *pose
            } else {
                moved(&from, &Twist(motion.0 * next))
            };
            match solver.solve(1.0, 0) {
                Ok((iterations, norms)) => {
                    spent += iterations;
                    share = next;
                    if share == 1.0 {
                        let residual = norms.residual(spent);
                        return conclude(&mut solver, residual);
                    }
                }
                Err((iterations, norms)) => {
                    spent += iterations;
                    solver.state = kept;
                    step *= 0.5;
                    if step < 1.0 / 1024.0 {
                        return Err(solver.not_converged(spent, share, &norms));
                    }
                }
            }
        }
    }

    /// The holding wrench along `moved(target, direction * s)` for the given `s` in their order,
    /// each point from the one before, the first from `start` or from rest. The tool is held in all
    /// directions. Limit points are found between points of opposite slope.
    ///
    /// # Errors
    /// Those of the first point; a curve that ends later says so in [`DisplacementCurve::ended`].
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
    /// let sideways = Twist::new(vector![0.0, 1.0, 0.0], Vector3::zeros());
    /// let curve = arm.posture(&home)?.displaced_along(&sideways, &[0.0, 1e-3, 2e-3], None)?;
    /// let forces: Vec<f64> = curve.points.iter().map(|point| point.equilibrium.wrench.force().y).collect();
    /// assert!(forces[0].abs() < 1e-6 && forces[2] > forces[1]);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn displaced_along(
        &self,
        direction: &Twist,
        distances: &[f64],
        start: Option<MechanismState>,
    ) -> Result<DisplacementCurve> {
        self.curve(&Drive::Displacement(*direction), distances, start)
    }

    /// The force that holds the tool's origin at the `distances` (m, from the nominal target)
    /// along a direction, while the tool is free in all others under the dead wrench `dead`: what a
    /// press measures that pushes by a pin. Limit points are those of the machine: under a dead
    /// force along the direction the tool snaps there.
    ///
    /// # Errors
    /// [`crate::Error::Model`] for a direction without length; else as [`Self::displaced_along`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
    /// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
    /// # let chain = Chain::builder("boom").link("bar", &bar, length).build()?;
    /// # let home = Pose::translation(length, 0.0, 0.0);
    /// # let boom = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = boom.posture(&home)?;
    /// let (across, distances) = (vector![0.0, 0.6, 0.8], [0.0, 1e-5, 2e-5]); // m
    /// let pushed = posture.pushed_along(&across, &distances, &Wrench::zero(), None)?;
    /// let held = posture.displaced_along(&Twist::new(across, Vector3::zeros()), &distances, None)?;
    /// // By a pin, the end turns as the bar likes: 3 E I / L^3. Held so that it cannot turn: 12 E I / L^3.
    /// let bending = ei / length.powi(3); // N/m
    /// assert!((pushed.points[2].force / (2e-5 * 3.0 * bending) - 1.0).abs() < 1e-3);
    /// assert!((held.points[2].force / (2e-5 * 12.0 * bending) - 1.0).abs() < 1e-3);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn pushed_along(
        &self,
        direction: &Vector3<f64>,
        distances: &[f64],
        dead: &Wrench,
        start: Option<MechanismState>,
    ) -> Result<DisplacementCurve> {
        self.finite("the wrench", dead.0.iter())?;
        self.finite("the direction", direction.iter())?;
        let Some(direction) = direction.try_normalize(1e-12) else {
            return Err(crate::Error::model(
                self.mechanism.place(),
                "the direction of a push has no length",
            ));
        };
        self.curve(&Drive::Pushed(direction, *dead), distances, start)
    }

    fn curve(
        &self,
        kind: &Drive,
        distances: &[f64],
        start: Option<MechanismState>,
    ) -> Result<DisplacementCurve> {
        if let Some(start) = &start {
            check_state(&self.mechanism, start)?;
        }
        self.finite("a distance along the path", distances.iter())?;
        let mut curve = DisplacementCurve {
            points: Vec::with_capacity(distances.len()),
            limits: Vec::new(),
            ended: None,
        };
        for &along in distances {
            let point = match (curve.points.last(), &start, kind) {
                (Some(last), ..) => self.next(kind, along, Some(last), &last.equilibrium.state),
                (None, Some(state), _) => self.next(kind, along, None, state),
                (None, None, Drive::Displacement(direction)) => {
                    let pose = moved(&self.target, &Twist(direction.0 * along));
                    self.wrench_at(&pose).map(|e| kind.point(along, e))
                }
                // Applies the dead wrench first, then pushes.
                (None, None, Drive::Pushed(_, dead)) => self
                    .deflected_by(dead)
                    .and_then(|e| self.next(kind, along, None, &e.state)),
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
                && let Some(limit) = self.limit_between(kind, &pair[0], &pair[1])
            {
                curve.limits.push(limit);
            }
        }
        Ok(curve)
    }

    fn next(
        &self,
        kind: &Drive,
        along: f64,
        last: Option<&DisplacementPoint>,
        state: &MechanismState,
    ) -> Result<DisplacementPoint> {
        let equilibrium = match kind {
            Drive::Displacement(direction) => {
                let pose = moved(&self.target, &Twist(direction.0 * along));
                self.wrench_at_from(&pose, state.clone())?
            }
            Drive::Pushed(direction, dead) => {
                let force = last.map_or(0.0, |l| l.force);
                self.pushed(direction, dead, along, force, state)?
            }
        };
        Ok(kind.point(along, equilibrium))
    }

    fn pushed(
        &self,
        direction: &Vector3<f64>,
        dead: &Wrench,
        along: f64,
        force: f64,
        start: &MechanismState,
    ) -> Result<MechanismEquilibrium> {
        let tool = self.mechanism.tool();
        let mut solver = self.solver(start.clone(), Unknowns::Guided);
        let push = DMatrix::from_fn(6, 1, |i, _| if i < 3 { direction[i] } else { 0.0 });
        solver.guide = Guide {
            from: self.target,
            rows: push.transpose(),
            goals: DVector::zeros(1),
            hands: push,
        };
        solver.wrench = *dead + Wrench::new(direction * force, Vector3::zeros());
        let place = |pose: &Pose| {
            direction.dot(&(pose.translation.vector - self.target.translation.vector))
        };
        let mut step = along - place(&start.platforms[tool]);
        let least = step.abs() / 1024.0;
        let mut spent = 0;
        loop {
            let kept = (solver.state.clone(), solver.wrench);
            let left = along - place(&solver.state.platforms[tool]);
            let last = step.abs() >= left.abs();
            let go = if last { left } else { step };
            solver.guide.goals[0] = place(&solver.state.platforms[tool]) + go;
            solver.state.platforms[tool].translation.vector += direction * go;
            match solver.solve(1.0, 0) {
                Ok((iterations, norms)) => {
                    spent += iterations;
                    if last {
                        let residual = norms.residual(spent);
                        return conclude(&mut solver, residual);
                    }
                }
                Err((iterations, norms)) => {
                    spent += iterations;
                    (solver.state, solver.wrench) = kept;
                    step = 0.5 * go;
                    if step.abs() <= least {
                        let share = 1.0 - left.abs() / (1024.0 * least).max(1e-300);
                        return Err(solver.not_converged(spent, share, &norms));
                    }
                }
            }
        }
    }

    /// Zero of the slope, by false position with halving (Illinois).
    fn limit_between(
        &self,
        kind: &Drive,
        a: &DisplacementPoint,
        b: &DisplacementPoint,
    ) -> Option<DisplacementPoint> {
        let (mut a, mut b) = (a.clone(), b.clone());
        let (mut fa, mut fb) = (a.slope, b.slope);
        let range = (b.along - a.along).abs();
        let size = fa.abs().max(fb.abs());
        for _ in 0..60 {
            let along = (fa * b.along - fb * a.along) / (fa - fb);
            let next = self
                .next(kind, along, Some(&a), &a.equilibrium.state)
                .ok()?;
            if next.slope.abs() <= 1e-10 * size || (b.along - a.along).abs() <= 1e-12 * range {
                // A pole of the slope changes its sign too; there is no limit point at one.
                return (next.slope.abs() <= 1e-3 * size).then_some(next);
            }
            if next.slope * b.slope < 0.0 {
                (a, fa) = (b, fb);
            } else {
                fa *= 0.5;
            }
            fb = next.slope;
            b = next;
        }
        None
    }
}

/// Drive of the tool.
enum Drive {
    Displacement(Twist),
    Pushed(Vector3<f64>, Wrench),
}

impl Drive {
    fn point(&self, along: f64, equilibrium: MechanismEquilibrium) -> DisplacementPoint {
        let k = &equilibrium.stiffness.matrix;
        let (force, slope) = match self {
            Self::Displacement(direction) => (
                direction.dot(&equilibrium.wrench),
                direction.0.dot(&(k * direction.0)),
            ),
            Self::Pushed(direction, dead) => {
                let own = Wrench(equilibrium.wrench.0 - dead.0);
                (
                    direction.dot(&own.force()),
                    stiffness_with_others_free(k, direction, equilibrium.length),
                )
            }
        };
        DisplacementPoint {
            along,
            force,
            slope,
            equilibrium,
        }
    }
}

/// Stiffness against a force in one direction with the others free, N/m: Schur complement. What is
/// rigid or free among the others has no share in it.
fn stiffness_with_others_free(k: &Matrix6<f64>, direction: &Vector3<f64>, length: f64) -> f64 {
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    let scaled = DMatrix::from_fn(6, 6, |i, j| k[(i, j)] / (unit(i) * unit(j)));
    let d = DMatrix::from_fn(6, 1, |i, _| if i < 3 { direction[i] } else { 0.0 });
    let others = complement(&d);
    let (inverse, _) = pseudo_inverse(&(others.transpose() * &scaled * &others));
    let coupling = d.transpose() * &scaled * &others;
    let back = others.transpose() * &scaled * &d;
    (d.transpose() * &scaled * &d - coupling * inverse * back)[(0, 0)]
}
