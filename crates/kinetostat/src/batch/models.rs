//! Machines that differ in parameters: stiffnesses, errors, masses, lengths.

use crate::batch::compiled::Batch;
use crate::error::Result;
use crate::model::mechanism::Mechanism;
use crate::parallel;

/// Computes the same of `count` machines: `machine(i)` makes the i-th, which is compiled, given to
/// `compute` and dropped, so that memory does not grow with their number. Machines are spread over the
/// threads, the postures of each over the lanes. Answers are in order, and one machine's
/// answer depends on no other machine and not on the number of threads; a machine that cannot be
/// made or computed leaves the others alone.
///
/// ```
/// use kinetostat::batch::over_machines;
/// # use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose};
/// # use nalgebra::{Matrix6, Vector3};
/// // An arm whose drive is 1 % softer with every draw.
/// let arm = |i: usize| {
///     let drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e6 * 0.99_f64.powi(i as i32));
///     let chain = Chain::builder("arm")
///         .actuator("joint", drive)
///         .translation(Vector3::new(0.5, 0.0, 0.2))
///         .spring6("link", &Matrix6::from_diagonal_element(1e7), [0.0; 6])
///         .build()?;
///     Mechanism::serial(chain, Pose::translation(0.5, 0.0, 0.2), Vector3::zeros())
/// };
/// let across = over_machines(100, arm, |_, batch| {
///     Ok(batch.stiffness_at_joints(&[0.0])?.stiffness.get(0, 7))
/// });
/// let first = across[0].as_ref().unwrap();
/// assert!(across.iter().all(|k| k.as_ref().unwrap() <= first));
/// ```
///
/// # Errors
/// Of each machine its own.
pub fn over_machines<T: Send>(
    count: usize,
    machine: impl Fn(usize) -> Result<Mechanism> + Sync,
    compute: impl Fn(usize, &Batch) -> Result<T> + Sync,
) -> Vec<Result<T>> {
    parallel::map((0..count).collect(), |i| {
        let own = machine(i)?;
        compute(i, &Batch::new(&own))
    })
}
