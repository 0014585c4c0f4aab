//! Forced vibration: teeth that come and go shake the tool, and what it does at the moment a tooth makes the wall is left on it.
//!
//! `force` is a periodic force by its harmonics; `vibration` what a tool does under it; `steady` the force of a cut with
//! regeneration. Source: `dynamics.md` section 9.
//!
//! The force of a cut whose chips vibrate.
//!
//! A vibration that comes back with every tooth leaves each tooth the track that it makes itself: the chip is that of the feed
//! alone, and regeneration changes nothing, however near a lobe is. What differs from tooth to tooth (run-out) is regenerated:
//! it comes back with the revolution, and a multiplier near the circle makes it large.

mod force;
mod vibration;

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Vector3};

use crate::cut::{Cut, checked_depth};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::forced::force::checked_harmonics;
use crate::number::{Complex64, cis};
use crate::stability::{Chebyshev, Operator, Period, Regeneration};

pub use force::PeriodicForce;
pub use vibration::{Vibration, VibrationHarmonic};

/// The steady state of a cut with regeneration.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyCut {
    /// Force on the tool, in the axes of the cut.
    pub force: PeriodicForce,
    /// Size of the largest multiplier: at 1 and above the steady state does not stay, and the cut chatters.
    pub multiplier: f64,
}

impl Regeneration {
    /// The steady force of a milling cut with straight teeth, with regeneration: `r = (1 - U^N)^-1 ...` over the `N` teeth of a
    /// revolution, U the monodromy operator (`dynamics.md` section 9).
    ///
    /// `stands_out` is by how much each tooth stands out from the mean, m; all zero without run-out. The feed per tooth
    /// and the depth are in m.
    ///
    /// # Errors
    /// Turning, helical teeth or more than one tooth in the cut at a time (the run-out's chip is then no displacement), another
    /// number of teeth than the cut has, a run-out larger than the feed (a tooth would miss its chip).
    pub fn steady(
        &self,
        speed_rpm: f64,
        depth: f64,
        feed_per_tooth: f64,
        stands_out: &[f64],
        harmonics: usize,
    ) -> Result<SteadyCut> {
        checked_harmonics(harmonics)?;
        checked_depth(depth)?;
        let setting = ChatterErrorKind::Setting;
        let feed = above(setting, "feed per tooth", feed_per_tooth, 0.0, false, "m")?;
        let steps = self.steps(feed, stands_out)?;
        let period = self.period(speed_rpm, depth, 1.5)?;
        let single = period
            .stretches
            .iter()
            .filter_map(|stretch| stretch.cutting.as_ref())
            .all(|cutting| cutting.factors.iter().all(|factors| factors.len() == 1));
        if !single {
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "teeth in the cut at a time",
                "more than one, or a helix",
                "one straight tooth at a time",
            ));
        }
        let operator = Operator::new(&period, depth);
        let multiplier = self.multiplier(speed_rpm, depth)?.size();
        let chips = steady_chips(&operator, feed, &steps)?;
        let harmonics = of_chips(&period, depth, &chips, harmonics);
        Ok(SteadyCut {
            force: PeriodicForce::new(1, harmonics),
            multiplier,
        })
    }

    /// Offset of each tooth relative to the one before it, m.
    fn steps(&self, feed: f64, stands_out: &[f64]) -> Result<Vec<f64>> {
        let kind = ChatterErrorKind::Cut;
        let teeth = match self.cut() {
            Cut::Milling(cut) => cut.teeth(),
            Cut::Turning(_) => {
                let expected = "milling: turning has no teeth that come and go";
                return Err(ChatterError::new(kind, "process", "turning", expected));
            }
        };
        if stands_out.len() != teeth {
            let found = format!("{} numbers for {teeth} teeth", stands_out.len());
            return Err(ChatterError::new(
                kind,
                "run-out",
                found,
                "one for each tooth",
            ));
        }
        // A tooth passes the place of tooth 0 one pitch after the tooth with the next number: `turn + j pitch` grows to it.
        let steps: Vec<f64> = (0..teeth)
            .map(|j| stands_out[j] - stands_out[(j + 1) % teeth])
            .collect();
        if let Some(step) = steps.iter().find(|step| step.is_nan() || step.abs() > feed) {
            return Err(ChatterError::new(
                kind,
                "run-out",
                format!("{step} m from tooth to tooth at a feed of {feed} m"),
                "less than the feed per tooth: else a tooth misses its chip, and the law is no longer linear",
            ));
        }
        Ok(steps)
    }
}

fn no_steady_state() -> ChatterError {
    ChatterError::new(
        ChatterErrorKind::NotConverged,
        "steady state of the cut",
        "none: a multiplier of the revolution is 1",
        "another depth or speed",
    )
}

/// Chips at all nodes of each tooth period of a revolution, m, in the steady state.
fn steady_chips(operator: &Operator<'_>, feed: f64, steps: &[f64]) -> Result<Vec<DVector<f64>>> {
    let size = operator.size();
    let teeth = steps.len();
    let at_nodes = |step: f64| {
        let mut fed = Vec::new();
        for cutting in operator
            .period
            .stretches
            .iter()
            .filter_map(|s| s.cutting.as_ref())
        {
            for factors in &cutting.factors {
                fed.extend(factors.iter().map(|(_, along)| feed * along.x + step));
            }
        }
        DVector::from_vec(fed)
    };
    // Tooth j cuts in the place of tooth 0 after j pitches back: the periods of a revolution take teeth downwards.
    let order: Vec<DVector<f64>> = (0..teeth)
        .map(|p| at_nodes(steps[(teeth - p) % teeth]))
        .collect();
    let monodromy = operator.dense()?;
    let mut product = DMatrix::identity(size, size);
    let mut driven = DVector::zeros(size);
    for fed in &order {
        product = &monodromy * product;
        driven = operator.driven(&driven, Some(fed))?.0;
    }
    let start = (DMatrix::identity(size, size) - product)
        .lu()
        .solve(&driven)
        .ok_or_else(no_steady_state)?;
    let mut state = start;
    let mut chips = Vec::with_capacity(teeth);
    for fed in &order {
        let (next, chip) = operator.driven(&state, Some(fed))?;
        state = next;
        chips.push(chip);
    }
    Ok(chips)
}

/// Harmonics of the revolution of the force that chips make.
fn of_chips(
    period: &Period,
    depth: f64,
    chips: &[DVector<f64>],
    harmonics: usize,
) -> Vec<Vector3<Complex64>> {
    let teeth = chips.len();
    let speed = TAU / (period.delay * teeth as f64);
    let mut sums = vec![Vector3::from_element(Complex64::default()); harmonics + 1];
    let mut at = 0;
    for stretch in &period.stretches {
        let Some(cutting) = &stretch.cutting else {
            continue;
        };
        // The highest harmonic needs more points than the chips do: the force is carried over to them.
        let turn = speed * stretch.duration;
        let points = 20.0 + 4.0 * harmonics as f64 * turn / TAU;
        let fine = Chebyshev::new(points.min(1500.0) as usize);
        let weights = fine.weights(turn);
        let nodes = cutting.factors.len();
        let carried = Chebyshev::new(nodes).to(&fine.nodes);
        for (p, chips) in chips.iter().enumerate() {
            let forces = DMatrix::from_fn(nodes, 3, |i, component| {
                let (pushed, _) = cutting.factors[i][0];
                pushed[component] * depth * chips[at + i]
            });
            let forces = &carried * forces;
            for (i, weight) in weights.iter().enumerate() {
                let time = stretch.begins + stretch.duration * fine.nodes[i];
                let turn = period.starts + speed * (time + period.delay * p as f64);
                let force = forces.row(i).transpose();
                for (k, sum) in sums.iter_mut().enumerate() {
                    let scale = if k == 0 { 1.0 } else { 2.0 } / TAU;
                    let turned = cis(-(k as f64) * turn) * (scale * weight);
                    *sum += force.map(|value| turned * value);
                }
            }
        }
        at += nodes;
    }
    sums
}
