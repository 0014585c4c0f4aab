//! The target that must be commanded so that the tool is where it should be under load
//! [R 7.7-7.13]: find `t0F` with `F = f(t_desired | t0F)`.
//!
//! The report's fixed point `t0F <- t0F + a (t_desired - f^-1(F | t0F))` solves one equilibrium per
//! step. Here the tool is held at the desired place in the directions that the machine can
//! correct, the nominal target becomes the unknown there, and one Newton iteration finds both.
//! What the machine cannot correct stays as a reported residual.

use crate::chain::residual::Residual;
use crate::error::{Error, Result};
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::{MechanismState, check_state};
use crate::model::limits::check_pose;
use crate::model::mechanism::Mechanism;
use crate::settings::Settings;
use crate::spatial::{Directions, Pose, Twist, Wrench, pose_residual};

/// A compensated target.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Compensation {
    /// Posture commanded for the modified target `t0F`.
    pub posture: Posture,
    /// Motion from the desired pose to the modified target: the correction of the program.
    pub correction: Twist,
    /// Motion from the desired pose to the pose reached under load: the uncorrected rest.
    pub left_over: Twist,
    /// The equilibrium at the modified target.
    pub equilibrium: MechanismEquilibrium,
}

/// The modified target for one desired pose and one dead wrench at the tool's origin.
///
/// `directions` (base axes `x y z rx ry rz`) are corrected; a milling program of three axes
/// corrects positions, [`Directions::POSITION`]; see [`Posture::correctable`].
///
/// # Errors
/// As [`Mechanism::posture`] and [`Posture::deflected_by`].
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// # let chain = Chain::builder("gantry")
/// #     .actuator("x", slide(Vector3::x()))
/// #     .actuator("y", slide(Vector3::y()))
/// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
/// #     .build()?;
/// # let home = Pose::translation(0.4, 0.0, 0.0);
/// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
/// let target = Pose::translation(0.45, 0.2, 0.0);
/// let cutting = Wrench::new(vector![300.0, -400.0, 0.0], Vector3::zeros()); // N
/// let plane = Directions::NONE.with(0).with(1); // what its two slides can correct
/// let answer = compensate(&gantry, &target, &cutting, plane, &Settings::default())?;
/// assert!(answer.correction.linear().y > 0.0, "it is commanded against the force");
/// assert!(answer.left_over.linear().norm() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
pub fn compensate(
    mechanism: &Mechanism,
    desired: &Pose,
    wrench: &Wrench,
    directions: Directions,
    settings: &Settings,
) -> Result<Compensation> {
    let posture = mechanism.posture(desired)?.with_settings(*settings);
    let start = posture.rest_state();
    compensate_from(&posture, desired, wrench, directions, start)
}

/// Compensates like [`compensate`], starting from the posture and state of a neighbouring answer.
///
/// # Errors
/// See [`compensate`].
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// # let chain = Chain::builder("table")
/// #     .actuator("x", slide(Vector3::x()))
/// #     .actuator("y", slide(Vector3::y()))
/// #     .build()?;
/// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
/// let mut posture = table.posture(&Pose::identity())?;
/// let mut state = posture.rest_state();
/// let plane = Directions::NONE.with(0).with(1);
/// for (step, force) in [(1.0, 100.0), (2.0, 180.0), (3.0, 240.0)] {
///     let wanted = Pose::translation(0.01 * step, -0.02 * step, 0.0); // m
///     let cutting = Wrench::new(vector![force, 0.4 * force, 0.0], Vector3::zeros()); // N
///     let answer = compensation::compensate_from(&posture, &wanted, &cutting, plane, state)?;
///     // Each drive is commanded to where its spring brings it back from: against the force, by F / k.
///     let against = answer.correction.linear() + vector![force, 0.4 * force, 0.0] / 5e7;
///     assert!(against.norm() < 1e-12);
///     (posture, state) = (answer.posture, answer.equilibrium.state); // the next point starts here
/// }
/// # Ok::<(), Error>(())
/// ```
pub fn compensate_from(
    near: &Posture,
    desired: &Pose,
    wrench: &Wrench,
    directions: Directions,
    start: MechanismState,
) -> Result<Compensation> {
    let (mut solver, residual) = solve_target(near, desired, wrench, directions, start)?;
    let equilibrium = conclude(&mut solver, residual)?;
    Ok(Compensation {
        correction: pose_residual(&solver.target, desired),
        left_over: pose_residual(&equilibrium.tool, desired),
        posture: commanded(near, &solver),
        equilibrium,
    })
}

/// Only the posture to command and the state under load: [`compensate_from`] without stiffness and
/// stability, for fields of many points.
///
/// # Errors
/// As [`compensate`].
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// # let chain = Chain::builder("table")
/// #     .actuator("x", slide(Vector3::x()))
/// #     .actuator("y", slide(Vector3::y()))
/// #     .build()?;
/// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
/// let mut posture = table.posture(&Pose::identity())?;
/// let mut state = posture.rest_state();
/// let plane = Directions::NONE.with(0).with(1);
/// for (step, force) in [(1.0, 100.0), (2.0, 180.0), (3.0, 240.0)] {
///     let wanted = Pose::translation(0.01 * step, -0.02 * step, 0.0); // m
///     let cutting = Wrench::new(vector![force, 0.4 * force, 0.0], Vector3::zeros()); // N
///     (posture, state) = compensation::target_under_load(&posture, &wanted, &cutting, plane, state)?;
///     let commanded = wanted.translation.vector - vector![force, 0.4 * force, 0.0] / 5e7; // against the force
///     assert!((posture.target().translation.vector - commanded).norm() < 1e-12);
///     assert!((state.platforms[table.tool()].translation.vector - wanted.translation.vector).norm() < 1e-12);
/// }
/// # Ok::<(), Error>(())
/// ```
pub fn target_under_load(
    near: &Posture,
    desired: &Pose,
    wrench: &Wrench,
    directions: Directions,
    start: MechanismState,
) -> Result<(Posture, MechanismState)> {
    let (solver, _) = solve_target(near, desired, wrench, directions, start)?;
    Ok((commanded(near, &solver), solver.state))
}

fn commanded(near: &Posture, solver: &PlatformSolver<'_>) -> Posture {
    let mut posture = near.clone();
    posture.target = solver.target;
    posture.platforms.clone_from(&solver.nominal);
    posture.platforms[solver.mechanism.tool()] = solver.target;
    posture.limbs.clone_from(&solver.posture);
    posture
}

fn solve_target<'m>(
    near: &'m Posture,
    desired: &Pose,
    wrench: &Wrench,
    directions: Directions,
    start: MechanismState,
) -> Result<(PlatformSolver<'m>, Residual)> {
    let mechanism = near.mechanism();
    near.finite("the wrench", wrench.0.iter())?;
    let place = mechanism.place();
    check_pose(&place, "the pose that is wanted", desired)?;
    check_state(mechanism, &start)?;
    let mut state = start;
    let tool = mechanism.tool();
    // Starts held directions exactly where they must end; the nominal target moves along with them and takes its other
    // directions from the desired pose.
    let mut pose = state.platforms[tool];
    let mut target = *near.target();
    for k in 0..3 {
        if directions[k] {
            let change = desired.translation.vector[k] - pose.translation.vector[k];
            pose.translation.vector[k] = desired.translation.vector[k];
            target.translation.vector[k] += change;
        } else {
            target.translation.vector[k] = desired.translation.vector[k];
        }
    }
    if (3..6).any(|k| directions[k]) {
        pose.rotation = desired.rotation;
    }
    target.rotation = desired.rotation;
    state.platforms[tool] = pose;
    let settings = *near.settings();
    let mut solver = PlatformSolver::new(
        mechanism,
        settings,
        near.limbs().to_vec(),
        state,
        Unknowns::Target(directions),
    );
    solver.wrench = *wrench;
    solver.target = target;
    solver.nominal.clone_from(&near.platforms);
    solver.others.clone_from(&near.others);
    let solved = if solver.retarget() {
        solver.solve(1.0, 0).ok()
    } else {
        None
    };
    let residual = match solved {
        Some((iterations, balance)) => balance.residual(iterations),
        None => match fixed_point(&mut solver, desired, directions) {
            Ok(residual) => residual,
            Err(error) => {
                // If nothing holds the tool, no target helps.
                return Err(match near.rest_under(wrench, near.rest_state()) {
                    Err(free @ Error::FreeDirection { .. }) => free,
                    _ => error,
                });
            }
        },
    };
    let residual = undo_drift(&mut solver, desired, directions, residual);
    Ok((solver, residual))
}

/// A rotation about one axis is held to second order only while the tool turns about others: the
/// rest is taken out and the machine solved again.
fn undo_drift(
    solver: &mut PlatformSolver<'_>,
    desired: &Pose,
    directions: Directions,
    mut residual: Residual,
) -> Residual {
    let tool = solver.mechanism.tool();
    for _ in 0..4 {
        let deviation = pose_residual(desired, &solver.state.platforms[tool]);
        let mut drift = Twist::zero();
        for k in (3..6).filter(|&k| directions[k]) {
            drift.0[k] = deviation.0[k];
        }
        if drift.angular().norm() < 1e-14 || solver.unknowns == Unknowns::Pose {
            break;
        }
        let kept = (solver.state.clone(), solver.posture.clone(), solver.target);
        let nominal = solver.nominal.clone();
        solver.state.platforms[tool] = crate::spatial::moved(&solver.state.platforms[tool], &drift);
        match solver.solve(1.0, 0) {
            Ok((iterations, balance)) => {
                residual = balance.residual(residual.iterations + iterations);
            }
            Err(_) => {
                // The answer before is an equilibrium; a failed refinement is not.
                (solver.state, solver.posture, solver.target) = kept;
                solver.nominal = nominal;
                break;
            }
        }
    }
    residual
}

/// Steps of the report's iteration before it counts as failed.
const STEPS: usize = 40;

/// The report's own iteration with `a = 1` [R 7.13], each step a robust equilibrium.
fn fixed_point(
    solver: &mut PlatformSolver<'_>,
    desired: &Pose,
    directions: Directions,
) -> Result<Residual> {
    let mechanism = solver.mechanism;
    let tool = mechanism.tool();
    solver.unknowns = Unknowns::Pose;
    let mut target = *desired;
    let length = mechanism.scale().length;
    let (mut spent, mut left) = (0, f64::INFINITY);
    for step in 1..=STEPS {
        let posture = mechanism.posture(&target)?;
        solver.target = target;
        solver.posture = posture.limbs().to_vec();
        solver.nominal = posture.platforms().to_vec();
        solver.state = posture.rest_state();
        let residual = solver.solve_robustly()?;
        spent += residual.iterations;
        let mut deviation = pose_residual(desired, &solver.state.platforms[tool]);
        for k in 0..6 {
            if !directions[k] {
                deviation.0[k] = 0.0;
            }
        }
        left = deviation.linear().norm() + deviation.angular().norm() * length;
        // The last steps may turn in rounding; what is left then is no failure.
        if left < 1e-12 * length || (step == STEPS && left < 1e-9 * length) {
            return Ok(Residual {
                iterations: spent,
                ..residual
            });
        }
        target = crate::spatial::moved(&target, &deviation);
    }
    // Each step was an equilibrium under the full load; it is the target that was not found.
    Err(Error::NotConverged {
        place: mechanism.place().during("compensation on "),
        iterations: spent,
        residual_position_m: left,
        residual_torque: 0.0,
        load_factor: 1.0,
        last: solver.state.coordinates.concat(),
        limit: None,
    })
}
