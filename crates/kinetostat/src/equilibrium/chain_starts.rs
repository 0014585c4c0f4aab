//! Starts of a search of a chain's equilibria: postures that a person would try, variations of an equilibrium, and a
//! sequence that fills the coordinates' bounds evenly.

use nalgebra::DVector;

use crate::chain::equilibrium::Equilibrium;
use crate::chain::scaling::nudged;
use crate::continuation::chain::system::ChainSystem;
use crate::equilibrium::bounds::Bounds;
use crate::model::chain::{Chain, Role};
use crate::number::{larger, smaller};
use crate::spatial::MotionKind;

/// Starts that a person would try: the posture, home, their mirror images, the stretched chain.
pub(crate) fn structured(posture: &[f64], chain: &Chain) -> Vec<Vec<f64>> {
    let home = chain.home_coordinates();
    let mirrored = |x: &[f64]| x.iter().map(|v| -v).collect::<Vec<f64>>();
    let mut list = vec![mirrored(&home), home, mirrored(posture), posture.to_vec()];
    for size in [0.05, 0.5, -0.5] {
        list.push(nudged(chain, posture, size));
    }
    list
}

/// Starts suggested by an equilibrium: its mirror image, and in both directions along its critical mode.
pub(crate) fn around(known: &Equilibrium, chain: &Chain) -> Vec<Vec<f64>> {
    let x = &known.coordinates;
    let mut list = vec![x.iter().map(|v| -v).collect::<Vec<f64>>()];
    let mode = &known.stability.mode;
    if mode.len() == x.len() {
        for size in [0.4, -0.4, 1.2, -1.2] {
            let along = x.iter().zip(mode).zip(chain.coordinates());
            list.push(
                along
                    .map(|((x, m), c)| match c.kind {
                        MotionKind::Revolute => x + size * m,
                        MotionKind::Prismatic => x + size * m * chain.scale().length,
                    })
                    .collect(),
            );
        }
    }
    list
}

/// Point `index` of an additive recurrence that fills the bounds evenly. Springs are spread over
/// what the natural energy can deflect, a third of it, and a tenth of it in turn; where some are very much
/// stiffer than others, what a turn by one radian of the softest one stores.
pub(crate) fn spread(system: &ChainSystem<'_, '_>, bounds: &Bounds, index: usize) -> Vec<f64> {
    let chain = system.problem.chain;
    let n = chain.coordinate_count();
    // Root of g^(n+1) = g + 1: the most even recurrence in n dimensions.
    let mut g = 2.0_f64;
    for _ in 0..60 {
        g = (1.0 + g).powf(1.0 / (n as f64 + 1.0));
    }
    let share = [4.0, 1.5, 0.4][index % 3];
    let mut one = DVector::zeros(system.count() + 1);
    one.rows_mut(system.reactions(), n).fill(share);
    let mut reach = system.coordinates(&one);
    if spread_of_springs(chain, &reach) > UNEVEN {
        let rotations = chain.coordinates().iter().zip(&reach);
        let softest = rotations
            .filter(|(c, _)| c.role == Role::Spring && c.kind == MotionKind::Revolute)
            .fold(0.0_f64, |most, (_, x)| larger(most, *x));
        if softest > share {
            reach.iter_mut().for_each(|x| *x *= share / softest);
        }
    }
    let mut weight = 1.0;
    (0..n)
        .map(|i| {
            weight /= g;
            let u = (0.5 + index as f64 * weight).fract();
            let c = &chain.coordinates()[i];
            let (mut low, mut high) = (bounds.low[i], bounds.high[i]);
            if c.role == Role::Spring {
                low = larger(low, -reach[i]);
                high = high.min(reach[i]);
            }
            let wide = match c.kind {
                MotionKind::Revolute => std::f64::consts::PI,
                MotionKind::Prismatic => 2.0 * chain.scale().length,
            };
            (low, high) = (low.max(-wide.max(-high)), high.min(wide.max(low)));
            low + u * (high - low)
        })
        .collect()
}

/// Springs of which one is this many times as stiff as another are spread by the energy of the softest.
const UNEVEN: f64 = 1e4;

/// Stiffness of the stiffest spring over that of the softest, from deflections of equal energy.
fn spread_of_springs(chain: &Chain, reach: &[f64]) -> f64 {
    let length = chain.scale().length;
    let springs = chain.coordinates().iter().zip(reach);
    let springs = springs.filter(|(c, _)| c.role == Role::Spring);
    let moved = springs.map(|(c, x)| match c.kind {
        MotionKind::Prismatic => *x,
        MotionKind::Revolute => x * length,
    });
    let (least, most) = moved.fold((f64::INFINITY, 0.0_f64), |(a, b), x| {
        (smaller(a, x), larger(b, x))
    });
    (most / least).powi(2)
}
