//! Intervals from resampled postures (bootstrap): what would have been found from other postures of the same kind.

use rayon::prelude::*;

use crate::identifiability::Knowledge;
use crate::least_squares::{PostureRows, Start, fit};
use crate::random::SplitMix64;
use crate::result::Identification;
use crate::unknown::Unknowns;

/// Shares of the resampled numbers below the bounds of an interval of 95 %.
const BOUNDS: [f64; 2] = [0.025, 0.975];

impl Identification {
    /// The same with intervals between percentiles of `resamples` fits, each to as many postures as there are, drawn from them with
    /// repetition (Efron 1979): they hold for numbers near their bounds, too, where a normal distribution does not. Each fit is the last
    /// linear one with other postures in it; a draw that sees fewer combinations than all postures do is left out.
    #[must_use]
    pub fn with_resampled_intervals(mut self, unknowns: &Unknowns, resamples: usize) -> Self {
        let (nominal, sizes) = (unknowns.nominal(), unknowns.sizes());
        let constraints = unknowns.constraints();
        let start = Start {
            from: &nominal,
            sizes: &sizes,
            constraints: &constraints,
        };
        let found = &self.fit;
        let postures = &found.postures;
        let drawn = |seed: usize| {
            let mut random = SplitMix64(seed as u64);
            let own = (0..postures.len()).map(|_| random.below(postures.len()));
            let own: Vec<PostureRows> = own.map(|i| postures[i].clone()).collect();
            let all: Vec<PostureRows> = own.into_iter().chain(found.prior.clone()).collect();
            let again = fit(&all, &start, self.robust).ok()?;
            (again.rank == found.linear.rank).then(|| unknowns.in_file(&again.estimate))
        };
        let fits: Vec<Vec<f64>> = (0..resamples).into_par_iter().filter_map(drawn).collect();
        for (k, number) in self.numbers.iter_mut().enumerate() {
            let mut values: Vec<f64> = fits.iter().filter_map(|f| f.get(k).copied()).collect();
            if number.knowledge == Knowledge::Unseen || values.len() < 2 {
                continue;
            }
            values.sort_by(f64::total_cmp);
            let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
            // A stiffness beyond all numbers is one of a rigid spring.
            number.interval = Some(BOUNDS.map(|share| Some(at(share)).filter(|x| x.is_finite())));
        }
        self.resamples = fits.len();
        self
    }
}
