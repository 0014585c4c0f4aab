//! The walk along the one motion that the conditions leave to a chain (a four-bar between its supports): where the loads
//! do no work along it, there is an equilibrium. On a closed path two minima of the energy have maxima between them,
//! which starts spread over the coordinates may miss.

use nalgebra::DVector;

use crate::continuation::chain::system::ChainSystem;
use crate::continuation::tracing::system::wrapped;
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::Chain;
use crate::number::{larger, largest_size};
use crate::spatial::MotionKind;

/// Largest turn of a step (rad), and largest slide in natural lengths of the chain.
const STEP: f64 = 0.05;

/// Steps each way: five turns of the fastest joint.
const STEPS: usize = 600;

/// Closure that is left open (scaled) at a place of the path.
const CLOSED: f64 = 1e-8;

/// Coordinates near each place where the work along the inner motion changes its sign; none where the conditions leave no
/// motion, or more than one. `turns`: full turns of the unknowns, in their units.
pub(crate) fn places_without_work(
    system: &mut ChainSystem<'_, '_>,
    from: &DVector<f64>,
    turns: &[f64],
) -> Vec<Vec<f64>> {
    let mut places = Vec::new();
    if system.coordinates_count() != system.reactions() + 1 {
        return places;
    }
    for sense in [1.0, -1.0] {
        if walk(system, from, turns, sense, &mut places) {
            break;
        }
    }
    places
}

/// A place on the path: its state, the direction of the inner motion, the work of all loads along it.
struct Place {
    z: DVector<f64>,
    direction: DVector<f64>,
    work: f64,
}

/// Walks one way; true if the path came back to where it began.
fn walk(
    system: &mut ChainSystem<'_, '_>,
    from: &DVector<f64>,
    turns: &[f64],
    sense: f64,
    places: &mut Vec<Vec<f64>>,
) -> bool {
    let mut previous: Option<Place> = None;
    let (mut z, mut ahead) = (from.clone(), None);
    for step in 0..STEPS {
        let Some(place) = place_at(system, z, ahead.as_ref()) else {
            return false;
        };
        let direction = match step {
            0 => &place.direction * sense,
            _ => place.direction.clone(),
        };
        if let Some(last) = previous
            .as_ref()
            .filter(|last| last.work * place.work < 0.0)
        {
            let share = last.work / (last.work - place.work);
            let between = &last.z + wrapped(&place.z, &last.z, turns) * share;
            places.push(system.coordinates(&between));
        }
        let chain = system.problem.chain;
        let back = system.motion(&wrapped(&place.z, from, turns));
        if step > 2 && size(chain, &back) < 0.6 * STEP {
            return true;
        }
        z = &place.z + &direction * (STEP / size(chain, &system.motion(&direction)));
        ahead = Some(direction);
        // The shape from which the walk begins is known.
        previous = (step > 0).then_some(place);
    }
    false
}

/// Largest turn (rad) or slide (natural lengths) of a motion.
fn size(chain: &Chain, motion: &[f64]) -> f64 {
    let length = chain.scale().length;
    let moved = chain
        .coordinates()
        .iter()
        .zip(motion)
        .map(|(c, dx)| match c.kind {
            MotionKind::Revolute => *dx,
            MotionKind::Prismatic => dx / length,
        });
    larger(largest_size(moved), f64::MIN_POSITIVE)
}

/// Closes the chain at a state; `None` where it does not close, or where it may move in more than one way.
fn place_at(
    system: &mut ChainSystem<'_, '_>,
    mut z: DVector<f64>,
    ahead: Option<&DVector<f64>>,
) -> Option<Place> {
    let (r, n) = (system.reactions(), system.coordinates_count());
    for _ in 0..8 {
        let (residual, norms) = system.evaluate(&z);
        let rows = system.matrix().view((0, r), (r, n)).into_owned();
        if !rows.iter().chain(residual.iter()).all(|v| v.is_finite()) {
            return None;
        }
        let motions = SingularValues::of(&rows);
        if norms.closure < CLOSED {
            let free = motions.null_space(1e-8);
            if free.ncols() != 1 {
                return None;
            }
            let mut direction = DVector::zeros(z.len());
            direction.rows_mut(r, n).copy_from(&free.column(0));
            if ahead.is_some_and(|ahead| ahead.dot(&direction) < 0.0) {
                direction.neg_mut();
            }
            let work = residual.rows(r, n).dot(&direction.rows(r, n));
            return Some(Place { z, direction, work });
        }
        let cut = 1e-8 * motions.largest();
        let step = motions.shortest(&residual.rows(0, r).into_owned(), cut);
        let mut own = z.rows_mut(r, n);
        own -= step;
    }
    None
}
