//! The equilibrium of one chain: directly, by growing the load, or from another start.

use crate::chain::directions::DirectionKind;
use crate::chain::equilibrium::{Equilibrium, Solution};
use crate::chain::newton::{Attempt, EndPath};
use crate::chain::problem::{ChainProblem, Prescribed, check_problem};
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::scaling::{FAR, LEAST_LOAD, SHORT_STEP, aside, gone, natural, nudged};
use crate::chain::sweep::stages::ChainMethod;
use crate::continuation::chain::stability::stability_as_prescribed;
use crate::error::{Error, Result};
use crate::model::kinematics::Kinematics;
use crate::model::loads::load::lagged_steps;
use crate::settings::Settings;
use crate::spatial::{Wrench, pose_residual};

/// Solves for the equilibrium of a chain: `tau(q) + J^T F = 0` with the end where it is prescribed. The report iterates
/// [R 4.16] (with the erratum: [`crate::reference`] has it bare); here steps are those of Newton's iteration on the
/// whole tangent ([`crate::chain`]), with the load grown where they do not converge.
///
/// # Errors
/// [`Error::Size`], [`Error::NotFinite`] for wrong input; [`Error::NotConverged`] with the last
/// iterate where no equilibrium was found.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let push = Wrench::new(vector![-50.0, 1.0, 0.0], Vector3::zeros()); // N
/// let problem = ChainProblem::new(&chain, EndCondition::wrench(push));
/// let equilibrium = solve_chain(&problem, &Settings::default())?;
/// assert!(equilibrium.stability.stable);
/// assert!(equilibrium.tip.translation.vector.y > 0.0);
/// # Ok::<(), Error>(())
/// ```
pub fn solve_chain(problem: &ChainProblem<'_>, settings: &Settings) -> Result<Equilibrium> {
    solve_along(problem, settings, None).map(|(equilibrium, _)| equilibrium)
}

/// [`solve_chain`] by an algorithm of choice (dense or by sweeps); with the one that was used at the end.
pub fn solve_along(
    problem: &ChainProblem<'_>,
    settings: &Settings,
    method: Option<ChainMethod>,
) -> Result<(Equilibrium, ChainMethod)> {
    check_problem(problem)?;
    let chain = problem.chain;
    settings.check(&chain.place())?;
    let mut attempt = Attempt::new(problem, settings, method);
    let mut spent = 0;
    let lagged = lagged_steps(problem.loads.iter(), settings.picard_steps);
    let mut direct = |attempt: &mut Attempt<'_, '_>, nudge: f64| {
        let mut x: Vec<f64> = nudged(chain, &problem.posture, nudge);
        let mut wrench = Wrench::zero();
        match attempt.newton(&mut x, &mut wrench, 1.0, lagged) {
            Ok((iterations, norms)) => Some(Solution {
                coordinates: x,
                wrench,
                iterations,
                norms,
            }),
            Err((iterations, _)) => {
                spent += iterations;
                None
            }
        }
    };
    // Starts as given; then slightly out of line, because a straight or flat posture has no linear answer.
    for nudge in [0.0, 1e-3, 3e-2] {
        let Some(solution) = direct(&mut attempt, nudge) else {
            continue;
        };
        let by = match nudge == 0.0 {
            true => FoundBy::Directly,
            false => FoundBy::OutOfLine,
        };
        let found = attempt.finish(solution, by);
        return Ok(by_growing_load(problem, settings, method, &found.0).unwrap_or(found));
    }
    let mut failure = match grow_load(&mut attempt, false, 1.0) {
        Ok(solution) => return Ok(attempt.finish(solution, FoundBy::GrowingLoad)),
        Err(failure) => failure,
    };
    // The chain is pressed on a straight path to a bent shape, and buckles; on a screw it is pulled.
    if problem.end.prescribed == [Prescribed::Pose; 6] {
        match grow_load(&mut attempt, true, 1.0) {
            Ok(solution) => return Ok(attempt.finish(solution, FoundBy::GrowingLoad)),
            Err(other) => {
                failure.iterations += other.iterations;
                if other.share > failure.share {
                    failure = Failure {
                        iterations: failure.iterations,
                        ..other
                    };
                }
            }
        }
    }
    // The path from rest may end at a fold although equilibria exist elsewhere.
    for nudge in [0.3, 0.8, 1.5, 2.5] {
        if let Some(solution) = direct(&mut attempt, nudge) {
            return Ok(attempt.finish(solution, FoundBy::OtherStart));
        }
    }
    if let Some(reason) = crate::equilibrium::no_equilibrium::why(problem) {
        return Err(reason);
    }
    Err(Error::NotConverged {
        place: chain.place(),
        iterations: spent + failure.iterations,
        residual_position_m: failure.norms.closure / chain.scale().stiffness.sqrt(),
        residual_torque: failure.norms.torque
            / failure.norms.loads.max(LEAST_LOAD * natural(chain)),
        load_factor: failure.share,
        last: failure.last,
        limit: None,
    })
}

/// Progress of the growing load.
struct Failure {
    /// Largest share with an equilibrium.
    share: f64,
    /// Coordinates of that equilibrium.
    last: Vec<f64>,
    /// Residual of that equilibrium at the full load.
    norms: ResidualNorms,
    iterations: usize,
}

/// The shape that stays and to which the growing load leads, where one step found another that does not and is
/// far: it may have passed the former. A straight column, pressed, stays straight.
fn by_growing_load(
    problem: &ChainProblem<'_>,
    settings: &Settings,
    method: Option<ChainMethod>,
    found: &Equilibrium,
) -> Option<(Equilibrium, ChainMethod)> {
    let near = gone(problem.chain, &problem.posture, &found.coordinates) <= FAR;
    if near || stays(problem, settings, found) {
        return None;
    }
    let mut attempt = Attempt::new(problem, settings, method);
    let mut solution = grow_load(&mut attempt, false, SHORT_STEP).ok()?;
    solution.iterations += found.residual.iterations;
    let grown = attempt.finish(solution, FoundBy::GrowingLoad);
    stays(problem, settings, &grown.0).then_some(grown)
}

/// True if an equilibrium is stable under its end condition: free where a wrench is prescribed, held where the pose is.
fn stays(problem: &ChainProblem<'_>, settings: &Settings, found: &Equilibrium) -> bool {
    let held = problem.end.prescribed == [Prescribed::Pose; 6];
    if held || !found.stability.stable {
        return found.stability.stable;
    }
    // If no motion of the end is unstable, none of the free ones is.
    if found.stiffness.count(DirectionKind::Negative) == 0 {
        return true;
    }
    stability_as_prescribed(problem, settings, found).is_none_or(|stability| stability.stable)
}

/// Loads, preloads and closure grow together from the unloaded posture; the closure straight, or on
/// a screw; in steps up to the `longest` share.
fn grow_load(
    attempt: &mut Attempt<'_, '_>,
    on_screw: bool,
    longest: f64,
) -> std::result::Result<Solution, Failure> {
    let problem = attempt.problem;
    let mut x = nudged(problem.chain, &problem.posture, aside(longest));
    let mut wrench = Wrench::zero();
    let start = Kinematics::new(problem.chain, &problem.base, &x, &problem.commands).tip_pose();
    attempt.path = if on_screw {
        EndPath::Screw(start)
    } else {
        EndPath::Straight(pose_residual(&problem.end.pose, &start))
    };
    let (mut share, mut step, mut iterations) = (0.0_f64, longest.min(0.125), 0);
    let mut last = ResidualNorms {
        loads: 1.0,
        ..ResidualNorms::default()
    };
    while share < 1.0 {
        let next = (share + step).min(1.0);
        let (mut trial, mut trial_wrench) = (x.clone(), wrench);
        match attempt.newton(&mut trial, &mut trial_wrench, next, 0) {
            Ok((spent, norms)) => {
                iterations += spent;
                (x, wrench, share, last) = (trial, trial_wrench, next, norms);
                step = (1.5 * step).min(longest);
            }
            Err((spent, _)) => {
                iterations += spent;
                step *= 0.5;
                if step < attempt.settings.smallest_load_step.max(1e-9) {
                    let (closure, residual) = attempt.evaluate(&x, &wrench, 1.0);
                    let norms = attempt.measure(&attempt.end_rows(&closure, &residual), &wrench);
                    return Err(Failure {
                        share,
                        last: x,
                        norms,
                        iterations,
                    });
                }
            }
        }
    }
    Ok(Solution {
        coordinates: x,
        wrench,
        iterations,
        norms: last,
    })
}
