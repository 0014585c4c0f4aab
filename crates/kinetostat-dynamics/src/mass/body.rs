//! Rigid bodies: mass and inertia at a point, whether a body can have it, and whether the bodies of a machine do.

use kinetostat::model::Kinematics;
use kinetostat::spatial::hat;
use kinetostat::{Chain, Mechanism, Pose};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3};

use crate::error::{Error, Result};
use crate::mass::body;

/// Inertia of a body about its centre of mass in base axes, `blkdiag(m 1, R I R^T)` [D1].
pub(crate) fn at_centre(
    mass: f64,
    inertia: &Matrix3<f64>,
    rotation: &Matrix3<f64>,
) -> DMatrix<f64> {
    let turned = rotation * inertia * rotation.transpose();
    let mut matrix = DMatrix::zeros(6, 6);
    matrix.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    matrix.view_mut((0, 0), (3, 3)).scale_mut(mass);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turned);
    matrix
}

/// Inertia of a body about a point from which its centre of mass is at `arm` (base axes, m), as equation D2 of the theory has it: linear
/// before angular.
#[must_use]
pub fn about_point(
    mass: f64,
    inertia: &Matrix3<f64>,
    rotation: &Matrix3<f64>,
    arm: &Vector3<f64>,
) -> Matrix6<f64> {
    let turned = rotation * inertia * rotation.transpose();
    let mut matrix = Matrix6::zeros();
    matrix
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(Matrix3::identity() * mass));
    matrix
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&(hat(arm) * -mass));
    matrix
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&(hat(arm) * mass));
    let offset = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
    matrix
        .fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&(turned + offset * mass));
    matrix
}

/// Refuses what no body has: negative or unsymmetric inertia, and principal moments of which one is larger than the sum
/// of the two others. A millionth of the largest moment is allowed for rounding in files.
pub(crate) fn check(part: &str, mass: f64, inertia: &Matrix3<f64>) -> Result<()> {
    let fault = |reason: String| {
        Err(Error::Inertia {
            part: part.to_owned(),
            reason,
        })
    };
    if !(mass.is_finite() && mass >= 0.0) {
        return fault(format!(
            "its mass is {mass} kg, a number not below zero is needed"
        ));
    }
    let size = inertia.iter().fold(
        0.0_f64,
        |m, x| if x.is_nan() { f64::NAN } else { m.max(x.abs()) },
    );
    if !size.is_finite() {
        return fault("its inertia is not finite".to_owned());
    }
    if size == 0.0 {
        return Ok(());
    }
    let scaled = inertia / size;
    let skew = scaled - scaled.transpose();
    if skew.iter().any(|x| x.abs() > 1e-6) {
        return fault("its inertia is not symmetric".to_owned());
    }
    let mut moments = ((scaled + scaled.transpose()) * 0.5).symmetric_eigenvalues() * size;
    moments.as_mut_slice().sort_by(f64::total_cmp);
    let (least, middle, most) = (moments[0], moments[1], moments[2]);
    if least < -1e-6 * size {
        return fault(format!(
            "its inertia is {least} kg m^2 about one axis, which is below zero"
        ));
    }
    if most > least + middle + 1e-6 * size {
        return fault(format!(
            "its principal moments of inertia are {least}, {middle} and {most} kg m^2; the largest cannot exceed the sum of the others"
        ));
    }
    Ok(())
}

/// Checks that a machine can vibrate: something that moves has a mass, and every inertia is that of a body. Call it
/// once, before many postures.
///
/// # Errors
/// [`Error::NoMass`] and [`Error::Inertia`].
///
/// ```
/// # use kinetostat::nalgebra::Vector3;
/// # use kinetostat::*;
/// let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e6); // N/m
/// let rail = Chain::builder("rail").actuator("trolley", slide).build()?;
/// let mut crane = Mechanism::builder("crane");
/// let hook = crane.platform(Platform::new("hook", Pose::identity()));
/// let crane = crane.limb(Limb::between("rail", 0, hook, rail)).build()?;
/// let said = kinetostat_dynamics::check_masses(&crane).unwrap_err().to_string();
/// assert!(said.contains("'crane' has no mass anywhere"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_masses(machine: &Mechanism) -> Result<()> {
    let mut any = false;
    for limb in machine.limbs() {
        let chain = &limb.actual;
        for own in chain.bodies() {
            body::check(&own.name, own.mass, &own.inertia)?;
        }
        any = any || weighs(chain, limb.from > 0);
    }
    for platform in machine.platforms().iter().skip(1) {
        body::check(&platform.name, platform.mass, &platform.inertia)?;
        any = any || platform.mass > 0.0 || platform.inertia.iter().any(|x| *x != 0.0);
    }
    match any {
        true => Ok(()),
        false => Err(Error::NoMass(machine.name().to_owned())),
    }
}

/// Something with a mass moves.
fn weighs(chain: &Chain, base_moves: bool) -> bool {
    let own = (chain.home_coordinates(), chain.home_commands());
    let at_home = Kinematics::new(chain, &Pose::identity(), &own.0, &own.1);
    let moves = |node: usize| {
        let motions = at_home.jacobian(node);
        let of_coordinates = motions.columns(0, chain.coordinate_count());
        base_moves || of_coordinates.iter().any(|x| *x != 0.0)
    };
    let heavy = |mass: f64, inertia: &nalgebra::Matrix3<f64>| {
        mass > 0.0 || inertia.iter().any(|x| *x != 0.0)
    };
    let bodies = chain.bodies().iter();
    bodies
        .filter(|b| heavy(b.mass, &b.inertia))
        .any(|b| moves(b.node))
        || chain
            .segment_masses()
            .iter()
            .any(|s| s.total() > 0.0 && moves(s.far))
}
