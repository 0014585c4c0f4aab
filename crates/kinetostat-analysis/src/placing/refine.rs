//! A local search without derivatives.
//!
//! The largest figure of a program has kinks where another place becomes the worst one: a search along fixed directions ends on
//! them. The directions therefore change with every step (a mirrored frame, from a sequence that fills the sphere densely) and
//! both ways along each are tried, as in mesh adaptive direct search [Abramson, Audet, Dennis, Le Digabel 2009]; a step is halved
//! if none is better.

use nalgebra::DVector;
use rayon::prelude::*;
use sobol_burley::sample;

use crate::placing::answer::Evaluated;
use crate::placing::space::{Place, Space};
use crate::placing::value::Value;

/// The search ends with steps below this share of the ranges.
const SMALLEST: f64 = 2e-4;

/// Rounds at most.
const ROUNDS: u32 = 60;

/// Seed of the directions.
const SEED: u32 = 77;

/// The better of two; of equal ones the first.
fn better(a: Evaluated, b: Evaluated) -> Evaluated {
    match b.value.order(&a.value).is_lt() {
        true => b,
        false => a,
    }
}

/// The best placement that is found from one on, with steps that begin at a share of the ranges.
pub(crate) fn refined(
    space: &Space,
    start: Evaluated,
    step: f64,
    worth: impl Fn(&Place) -> Value + Sync,
) -> Evaluated {
    let size = space.ranges().len();
    let mut best = start;
    if size == 0 {
        return best;
    }
    let mut step = step;
    for round in 0..ROUNDS {
        let shares = DVector::from_vec(space.shares(&best.place));
        let frame = frame(size, round);
        let tried: Vec<Place> = frame
            .iter()
            .flat_map(|direction| [1.0, -1.0].map(|sign| &shares + direction * (sign * step)))
            .map(|shares| space.at(best.place.fixture, shares.as_slice()))
            .filter(|place| *place != best.place)
            .collect();
        let found: Vec<Evaluated> = tried
            .into_par_iter()
            .map(|place| {
                let value = worth(&place);
                Evaluated { place, value }
            })
            .collect();
        let next = found.into_iter().fold(best.clone(), better);
        match next.place == best.place {
            true => step /= 2.0,
            false => {
                step *= 1.5;
                best = next;
            }
        }
        if step < SMALLEST {
            break;
        }
    }
    best
}

/// Orthogonal directions of length 1: the axes, mirrored at a plane that is another one in every round.
fn frame(size: usize, round: u32) -> Vec<DVector<f64>> {
    let axis = |k: usize| {
        let mut axis = DVector::zeros(size);
        axis[k] = 1.0;
        axis
    };
    // Every third round goes along the variables themselves.
    if size == 1 || round.is_multiple_of(3) {
        return (0..size).map(axis).collect();
    }
    let number = |k: usize| f64::from(sample(round, k as u32, SEED)) - 0.5;
    let normal = DVector::from_fn(size, |k, _| number(k));
    let normal = match normal.norm() > 1e-6 {
        true => normal.normalize(),
        false => axis(0),
    };
    (0..size)
        .map(|k| {
            let axis = axis(k);
            let along = 2.0 * normal.dot(&axis);
            axis - &normal * along
        })
        .collect()
}
