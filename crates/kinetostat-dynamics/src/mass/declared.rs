//! Masses as a machine declares them, before it stands anywhere.

use kinetostat::model::Kinematics;
use kinetostat::{Chain, Mechanism, Pose};

use crate::error::{Error, Result};
use crate::mass::body;

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
