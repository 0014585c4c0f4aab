//! Machines next to the drawing: how their stability goes along with uncertain numbers.
//!
//! The stability of an equilibrium takes as long to find as the equilibrium itself, and hardly a machine of thousands differs from
//! the drawn one in that. Its margins and their derivatives say which may be: only those are looked at.

use kinetostat::Wrench;
use kinetostat::batch::{Batch, BatchEquilibrium, Commanded, Details};
use kinetostat::nalgebra::Matrix6;

/// Safety factor on the change that derivatives predict: a machine with a larger margin is taken as stable without a check.
const SAFETY: f64 = 10.0;

/// Uncertain numbers whose derivatives tell where a machine stands: to read those of more takes longer than they save.
pub(crate) const MOST_DERIVATIVES: usize = 16;

/// The equilibria of a machine, with stability.
pub(crate) fn with_stability(
    batch: &Batch,
    places: &Commanded,
    loads: &[Wrench],
) -> kinetostat::Result<BatchEquilibrium> {
    let mut found = BatchEquilibrium::default();
    batch.equilibrium_commanded_into(places, loads, Details::Stability, &mut found)?;
    Ok(found)
}

/// Stability margins of the equilibria at all places, and their derivatives by the uncertain numbers.
#[derive(Clone, Debug)]
pub(crate) struct Margins {
    as_drawn: Vec<[f64; 2]>,
    /// Slopes of every number, place by place, per its own unit.
    slopes: Vec<Vec<[f64; 2]>>,
}

impl Margins {
    /// Margins of the machine as drawn, with stability; `length` (m) is the factor that makes rotations comparable with
    /// translations.
    pub fn new(drawn: &BatchEquilibrium, length: f64) -> Self {
        Self {
            as_drawn: of_places(drawn, length),
            slopes: Vec::new(),
        }
    }

    /// Learns of one more number, from machines with more and less of it that lie `apart`.
    pub fn go_along(
        &mut self,
        more: &BatchEquilibrium,
        less: &BatchEquilibrium,
        apart: f64,
        length: f64,
    ) {
        let both = of_places(more, length)
            .into_iter()
            .zip(of_places(less, length));
        let slope = |more: f64, less: f64| {
            if apart == 0.0 {
                0.0
            } else {
                (more - less) / apart
            }
        };
        let of_place = |(more, less): ([f64; 2], [f64; 2])| [0, 1].map(|k| slope(more[k], less[k]));
        self.slopes.push(both.map(of_place).collect());
    }

    /// Machines that differ by so much in their numbers hold at all places, by far. Not known is no.
    pub fn hold(&self, deviations: &[f64]) -> bool {
        if deviations.len() != self.slopes.len() {
            return false;
        }
        let mut places = self.as_drawn.iter().enumerate();
        places.all(|(place, margin)| {
            [0, 1].iter().all(|k| {
                let each = self.slopes.iter().zip(deviations);
                let change: f64 = each.map(|(slope, by)| (slope[place][*k] * by).abs()).sum();
                margin[*k] > SAFETY * change
            })
        })
    }
}

/// Margins at every place: the remaining part of the way to buckling, and the smallest principal stiffness (N/m). NaN without an
/// answer.
fn of_places(found: &BatchEquilibrium, length: f64) -> Vec<[f64; 2]> {
    let of_place = |i: usize| {
        let Some(stability) = found.stability(i) else {
            return [f64::NAN; 2];
        };
        let unit = |k: usize| if k < 3 { 1.0 } else { 1.0 / length };
        let k = Matrix6::from_fn(|r, c| {
            let both = found.stiffness.get(i, 6 * r + c) + found.stiffness.get(i, 6 * c + r);
            0.5 * both * unit(r) * unit(c)
        });
        let left = 1.0 - stability.share_to_buckling.unwrap_or(0.0);
        match stability.stable && k.iter().all(|x| x.is_finite()) {
            true => [left, k.symmetric_eigenvalues().min()],
            false => [f64::NAN; 2],
        }
    };
    (0..found.status.len()).map(of_place).collect()
}
