//! A machine under reference loads: how far its tool moves, and how wrong the stiffness at rest would be.

use kinetostat::{Error, MechanismEquilibrium, Posture, Wrench};
use kinetostat_machining::natural_length;
use nalgebra::Vector3;

/// Size of the loads that are assumed if none is given, N.
pub const REFERENCE_N: f64 = 1000.0;

/// A deflection by this share of the natural length is small: the unloaded stiffness is then off
/// by about as much.
pub const SMALL: f64 = 0.01;

/// Share of the natural length from which, to first order, an assumed load is not even tried.
pub const TOO_MUCH: f64 = 0.2;

/// Outcome of a load.
#[derive(Debug)]
pub enum LoadOutcome {
    /// Not tried: to first order the tool would move this far, m.
    TooMuch(f64),
    /// Not carried: the load acts in a free direction.
    Free,
    /// No equilibrium was found.
    NoEquilibrium(Error),
    /// The machine carries it.
    Carried(Box<CarriedLoad>),
}

/// A machine under a load.
#[derive(Debug)]
#[non_exhaustive]
pub struct CarriedLoad {
    /// Equilibrium under the force on the tool and the loads of the model.
    pub state: MechanismEquilibrium,
    /// Displacement of the tool from its place at rest, m.
    pub moved: f64,
    /// Error of the motion by the compliance at rest, as a share of the motion.
    pub linear_error: f64,
}

/// The loads that are assumed: [`REFERENCE_N`] both ways along the axes of the base.
#[must_use]
pub fn reference_forces() -> Vec<Vector3<f64>> {
    (0..6)
        .map(|k| {
            let sign = if k % 2 == 0 {
                REFERENCE_N
            } else {
                -REFERENCE_N
            };
            Vector3::ith(k / 2, sign)
        })
        .collect()
}

/// Source of forces on the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForcesFrom {
    /// They were given: each of them is answered.
    User,
    /// They are assumed: the first one that is far too much for the machine ends the list.
    Assumption,
}

/// A machine under forces on its tool (N, base axes), one after the other, from its equilibrium at rest.
#[must_use]
pub fn under_forces(
    posture: &Posture,
    rest: &MechanismEquilibrium,
    forces: &[Vector3<f64>],
    from: ForcesFrom,
) -> Vec<(Vector3<f64>, LoadOutcome)> {
    let compliance = rest.compliance();
    let length = natural_length(posture.mechanism());
    let mut list = Vec::new();
    for force in forces {
        let linear: Vector3<f64> = compliance.springs.fixed_view::<3, 3>(0, 0) * force;
        if from == ForcesFrom::Assumption && linear.norm() > TOO_MUCH * length {
            list.push((*force, LoadOutcome::TooMuch(linear.norm())));
            break;
        }
        let outcome = match posture.deflected_by(&Wrench::new(*force, Vector3::zeros())) {
            Ok(state) => {
                let moved = state.displacement.linear() - rest.displacement.linear();
                LoadOutcome::Carried(Box::new(CarriedLoad {
                    moved: moved.norm(),
                    linear_error: (moved - linear).norm() / moved.norm().max(1e-15),
                    state,
                }))
            }
            Err(Error::FreeDirection { .. }) => LoadOutcome::Free,
            Err(error) => LoadOutcome::NoEquilibrium(error),
        };
        list.push((*force, outcome));
    }
    list
}
