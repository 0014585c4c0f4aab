//! The target that must be commanded for a position of a machine that turns its tool as it moves: the orientation
//! follows, the position is corrected where the machine can move it.

use nalgebra::{DVector, UnitQuaternion, Vector3};

use crate::chain::residual::Residual;
use crate::compensation::target::Compensation;
use crate::error::{Error, Result};
use crate::machine::equilibrium::conclude;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::spatial::{Pose, Wrench, pose_residual};

/// Steps of the correction before it counts as failed.
const CORRECTIONS: usize = 40;

/// The modified target for a desired position of a machine whose orientation follows: the position
/// is corrected in the directions that the machine can move its tool in, the orientation at every
/// target is the one nearest to `wanted` (see [`PostureRequest::position`](crate::machine::PostureRequest::position)). `near` stands at or
/// near the desired position.
///
/// [`Compensation::correction`] and [`Compensation::left_over`] are from the pose that the unloaded
/// machine has at the desired position.
///
/// # Errors
/// As [`PostureRequest::position`](crate::machine::PostureRequest::position) and [`Posture::deflected_by`].
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
/// let wanted = home.rotation;
/// let position = vector![0.8, 0.4, 0.0];
/// let near = arm.posture(PostureRequest::position(&position, &wanted))?;
/// let cutting = Wrench::new(vector![60.0, -40.0, 0.0], Vector3::zeros()); // N
/// let start = near.rest_state();
/// let answer = compensation::compensate_following(&near, &position, &wanted, &cutting, start)?;
/// assert!(answer.left_over.linear().norm() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
pub fn compensate_following(
    near: &Posture,
    position: &Vector3<f64>,
    wanted: &UnitQuaternion<f64>,
    wrench: &Wrench,
    start: MechanismState,
) -> Result<Compensation> {
    let (posture, desired, equilibrium) =
        corrected(near, position, wanted, wrench, start, conclude)?;
    Ok(Compensation {
        correction: pose_residual(posture.target(), &desired),
        left_over: pose_residual(&equilibrium.tool, &desired),
        posture,
        equilibrium,
    })
}

/// Only the posture to command and the state under load: [`compensate_following`] without stiffness
/// and stability, for fields of many points.
///
/// # Errors
/// As [`compensate_following`].
pub fn target_under_load_following(
    near: &Posture,
    position: &Vector3<f64>,
    wanted: &UnitQuaternion<f64>,
    wrench: &Wrench,
    start: MechanismState,
) -> Result<(Posture, MechanismState)> {
    let state = |solver: &mut PlatformSolver<'_>, _| Ok(solver.state.clone());
    let (posture, _, state) = corrected(near, position, wanted, wrench, start, state)?;
    Ok((posture, state))
}

/// The report's own iteration with `a = 1` [R 7.13] on the position: the posture to command, the pose of the unloaded
/// machine at the desired position, and what is concluded from the equilibrium.
fn corrected<T>(
    near: &Posture,
    position: &Vector3<f64>,
    wanted: &UnitQuaternion<f64>,
    wrench: &Wrench,
    start: MechanismState,
    conclude: impl FnOnce(&mut PlatformSolver<'_>, Residual) -> Result<T>,
) -> Result<(Posture, Pose, T)> {
    let mechanism = near.mechanism();
    let tool = mechanism.tool();
    let length = mechanism.scale().length;
    let carry = |mut posture: Posture| {
        posture.others.clone_from(&near.others);
        posture.with_settings(*near.settings())
    };
    let mut posture = carry(mechanism.posture_following(position, wanted, Some(near))?);
    let desired = *posture.target();
    let free = posture.position_freedoms();
    let (mut goal, mut state) = (*position, start);
    let (mut spent, mut left) = (0, f64::INFINITY);
    for step in 1..=CORRECTIONS {
        let (mut solver, residual) = posture.converged_solver(wrench, state)?;
        spent += residual.iterations;
        let distance = position - solver.state.platforms[tool].translation.vector;
        let distance = DVector::from_column_slice(distance.as_slice());
        let distance = &free * (free.transpose() * distance);
        let before = left;
        left = distance.norm();
        let converged = left < 1e-11 * length && left > 0.5 * before;
        if left < 1e-13 * length || converged || (step == CORRECTIONS && left < 1e-9 * length) {
            let residual = Residual {
                iterations: spent,
                ..residual
            };
            solver.target = *posture.target();
            let concluded = conclude(&mut solver, residual)?;
            drop(solver);
            return Ok((posture, desired, concluded));
        }
        state = solver.state.clone();
        goal += Vector3::new(distance[0], distance[1], distance[2]);
        // The goal lies beside a curved surface of places by second order.
        let (next, _) = mechanism.followed_to_nearest(&posture, &goal, wanted)?;
        posture = carry(next);
    }
    Err(Error::NotConverged {
        place: mechanism.place().during("compensation on "),
        iterations: spent,
        residual_position_m: left,
        residual_torque: 0.0,
        load_factor: 1.0,
        last: state.coordinates.concat(),
        limit: None,
    })
}
