//! The equilibrium of one chain: directly, by growing the load, or from another start; and the reason where there is none.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::{DirectionKind, motion_description, scaled_twist};
use crate::chain::equilibrium::{Equilibrium, Solution};
use crate::chain::newton::{Attempt, EndPath};
use crate::chain::problem::{ChainProblem, Prescribed, check_problem, prescribed_wrench};
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::scaling::{FAR, LEAST_LOAD, SHORT_STEP, aside, gone, natural, nudged};
use crate::chain::sweep::stages::ChainMethod;
use crate::chain::system::System;
use crate::continuation::chain::stability::stability_as_prescribed;
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::linalg::singular_values::range;
use crate::model::chain::Role;
use crate::model::kinematics::{Kinematics, unloaded_tip};
use crate::model::loads::load::lagged_steps;
use crate::number::larger;
use crate::settings::Settings;
use crate::spatial::{MotionKind, Wrench, pose_residual, turn_matrix};

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
    if let Some(reason) = crate::equilibrium::chain::why(problem) {
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

/// The reason, if it is one of those that no iteration can change.
pub(crate) fn why(problem: &ChainProblem<'_>) -> Option<Error> {
    held_outside(problem).or_else(|| pushed_slide(problem))
}

/// Directions of the end condition that are of one kind, base axes, 6 x k.
fn directions_of(problem: &ChainProblem<'_>, wanted: Prescribed) -> DMatrix<f64> {
    let turn = turn_matrix(&problem.end.axes);
    let own: Vec<usize> = (0..6)
        .filter(|&k| problem.end.prescribed[k] == wanted)
        .collect();
    DMatrix::from_fn(6, own.len(), |i, j| turn[(i, own[j])])
}

/// The end is held beside everything that the chain can reach (a planar chain out of its plane).
fn held_outside(problem: &ChainProblem<'_>) -> Option<Error> {
    let chain = problem.chain;
    let (n, length) = (chain.coordinate_count(), chain.scale().length);
    let held = directions_of(problem, Prescribed::Pose);
    if held.ncols() == 0 || n == 0 {
        return None;
    }
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    // Motions of the end in irregular postures around the given one.
    let mut all = DMatrix::zeros(6, 3 * n);
    for k in 0..3 {
        let moved = |(i, x): (usize, &f64)| {
            let unit = match chain.coordinates()[i].kind {
                MotionKind::Prismatic => 0.1 * length,
                MotionKind::Revolute => 1.0,
            };
            x + k as f64 * unit * (0.2 + 0.6 * ((i + k) as f64 * 0.618_034).fract())
        };
        let x: Vec<f64> = problem.posture.iter().enumerate().map(moved).collect();
        let here = Kinematics::new(chain, &problem.base, &x, &problem.commands);
        let jacobian = here.jacobian(chain.tip());
        for j in 0..n {
            let column = DVector::from_fn(6, |i, _| jacobian[(i, j)] * unit(i));
            let size = column.norm();
            if size > 0.0 {
                all.set_column(k * n + j, &(column / size));
            }
        }
    }
    let normals = complement(&range(&(held.transpose() * all), 1e-8));
    if normals.ncols() == 0 {
        return None;
    }
    let tip = unloaded_tip(chain, &problem.base, &problem.posture, &problem.commands);
    let off = pose_residual(&problem.end.pose, &tip);
    let off = DVector::from_fn(6, |i, _| off.0[i] * unit(i));
    let outside = &normals * (normals.transpose() * (held.transpose() * off));
    let outside = held * outside;
    if outside.norm() <= 1e-7 * length {
        return None;
    }
    let off = Vector6::from_fn(|i, _| outside[i]);
    let (distance, angle) = (
        off.fixed_rows::<3>(0).norm(),
        off.fixed_rows::<3>(3).norm() / length,
    );
    let motion = motion_description(&scaled_twist(chain.scale(), &off));
    Some(Error::model(
        chain.place(),
        format!(
            "the end is held {:.4} mm and {:.4} deg beside everything that the chain can reach: nothing in it {motion}; hold the end where the chain can take it, or prescribe a wrench in that direction",
            distance * 1e3,
            angle.to_degrees()
        ),
    ))
}

/// A load pushes a passive slide that nothing holds.
fn pushed_slide(problem: &ChainProblem<'_>) -> Option<Error> {
    let chain = problem.chain;
    let wrench = prescribed_wrench(problem);
    let held = directions_of(problem, Prescribed::Pose);
    let mut system = System::new(
        chain,
        &problem.base,
        &problem.posture,
        &problem.commands,
        false,
    );
    system.evaluate_problem(problem, &problem.posture, &wrench, 1.0);
    let length = chain.scale().length;
    let torques = (0..chain.coordinate_count()).map(|i| system.unbalanced(i).abs());
    let most = torques.fold(0.0_f64, larger);
    let free = chain.coordinates().iter().enumerate().find(|(i, c)| {
        let push = system.unbalanced(*i).abs();
        let column = DVector::from_fn(6, |k, _| system.jacobian[(k, *i)]);
        let other = (0..chain.coordinate_count()).map(|j| system.hessian[(*i, j)].abs());
        c.role == Role::Passive
            && c.kind == MotionKind::Prismatic
            && push > 1e-6 * most
            && (held.transpose() * column).norm() <= 1e-9
            && other.fold(0.0_f64, larger) * length <= 1e-9 * push
    })?;
    let push = system.unbalanced(free.0).abs();
    Some(Error::FreeDirection {
        place: chain.place(),
        reason: format!(
            "the load pushes the passive slide '{}' with {push:.4} N, and nothing holds it",
            free.1.name
        ),
        wrench: Box::new(wrench),
    })
}
