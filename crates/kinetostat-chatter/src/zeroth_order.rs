//! The zeroth-order (single-frequency) approximation of Altintas and Budak [D 9].
//!
//! It replaces the directional matrix by its mean over the turn. It knows no flip, errs at low immersion, and is **not a
//! conservative bound**: on robots, whose structural modes meet half tooth frequencies at ordinary speeds, it was 1.6 to 3.7
//! times too optimistic (`dynamics.md` section 10). Screen with it, confirm with [`crate::Regeneration`]. For turning, whose
//! matrix is its mean, it is exact.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Matrix3};
use serde::{Deserialize, Serialize};

use crate::cut::Cut;
use crate::error::Result;
use crate::number::{Complex64, larger};
use crate::response::ToolResponse;
use crate::stability::Regeneration;

/// Frequencies that are looked at within half the width of a peak.
const PER_WIDTH: f64 = 12.0;
/// Frequencies that are looked at in each octave beside the peaks.
const PER_OCTAVE: f64 = 48.0;
/// How far above the fastest mode is looked.
const BEYOND: f64 = 4.0;
/// Eigenvalues smaller than this share of the largest that was found are none: the tool does not give way there.
const NONE: f64 = 1e-12;

/// A limit of zeroth order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ZerothOrderLimit {
    /// Depth of cut, m.
    pub depth: f64,
    /// Chatter frequency, Hz.
    pub frequency_hz: f64,
}

/// One eigenvalue of the receptance times the mean matrix, over the frequency.
struct Branch<'a> {
    response: &'a ToolResponse,
    mean: Matrix3<f64>,
    delay: f64,
}

/// A place on a branch: angular frequency, `lam = 1/mu` and its argument, unwrapped.
#[derive(Clone, Copy)]
struct Place {
    frequency: f64,
    mu: Complex64,
    argument: f64,
}

impl Branch<'_> {
    /// The two eigenvalues that are not 0 for certain: those in the plane of the chip.
    fn eigenvalues(&self, frequency: f64) -> [Complex64; 2] {
        // The mean matrix has rank 2 at most: G D0 and its part in the range of D0^T have the same eigenvalues but zeros.
        let product = self.response.at(frequency) * self.mean.map(Complex64::from);
        let basis = plane(&self.mean);
        let part = |i: usize, j: usize| {
            let (left, right) = (basis[i].map(Complex64::from), basis[j].map(Complex64::from));
            (left.transpose() * product * right)[(0, 0)]
        };
        let small = Matrix2::new(part(0, 0), part(0, 1), part(1, 0), part(1, 1));
        let half = (small[(0, 0)] + small[(1, 1)]) * 0.5;
        let root = (half * half - small.determinant()).sqrt();
        // The larger by a sum without cancellation, the smaller by the determinant.
        let larger = match (half + root).norm() >= (half - root).norm() {
            true => half + root,
            false => half - root,
        };
        match larger.norm() > 0.0 {
            true => [larger, small.determinant() / larger],
            false => [larger; 2],
        }
    }

    /// The eigenvalue nearest to the one before, by ratio.
    fn follow(&self, last: &Place, frequency: f64) -> Place {
        let near = |mu: &Complex64| (mu / last.mu).ln().norm();
        let [a, b] = self.eigenvalues(frequency);
        let mu = match near(&b) < near(&a) {
            true => b,
            false => a,
        };
        let turned = (last.mu / mu).arg();
        Place {
            frequency,
            mu,
            argument: last.argument + turned,
        }
    }

    /// `w tau + pi + 2 arg lam`: a whole number of turns where `e^(-i w tau) = 1 - lam/a_lim`.
    fn phase(&self, place: &Place) -> f64 {
        place.frequency * self.delay + PI + 2.0 * place.argument
    }
}

/// Two unit vectors at right angles that hold all displacements which change the mean chip.
fn plane(mean: &Matrix3<f64>) -> [nalgebra::Vector3<f64>; 2] {
    let rows = [0, 1, 2].map(|i| mean.row(i).transpose());
    let longest = rows.into_iter().fold(nalgebra::Vector3::zeros(), |a, b| {
        if b.norm() > a.norm() { b } else { a }
    });
    let Some(first) = longest.try_normalize(0.0) else {
        return [nalgebra::Vector3::x(), nalgebra::Vector3::y()];
    };
    let across = rows.map(|row| row - first * first.dot(&row));
    let second = across.into_iter().fold(nalgebra::Vector3::zeros(), |a, b| {
        if b.norm() > a.norm() { b } else { a }
    });
    let other = match second.norm() > 1e-12 * longest.norm() {
        true => second.normalize(),
        // Rank one: any direction across has a zero eigenvalue.
        false => first.cross(&first.map(|c| if c.abs() < 0.6 { 1.0 } else { 0.0 })).normalize(),
    };
    [first, other]
}

/// `a_lim = |lam|^2/(2 Re lam)` [D 9]; none where the real part of `lam = 1/mu` is not positive.
fn depth(mu: Complex64) -> Option<f64> {
    let lam = mu.inv();
    (lam.re > 0.0).then(|| lam.norm_sqr() / (2.0 * lam.re))
}

/// Frequencies at which the branches are followed, rad/s: close together at the peaks, in ratios elsewhere.
fn grid(response: &ToolResponse) -> Vec<f64> {
    let modes = response.modes();
    let fastest = modes.iter().map(|m| m.angular_frequency()).fold(0.0, larger);
    let slowest = modes.iter().map(|m| m.angular_frequency()).fold(fastest, f64::min);
    let (from, to) = (1e-3 * slowest, BEYOND * fastest);
    let mut all = vec![from];
    let mut w = from;
    while w < to {
        let mut step = w * ((2_f64).powf(PER_OCTAVE.recip()) - 1.0);
        for mode in modes {
            let (peak, zeta) = (mode.angular_frequency(), mode.damping_ratio());
            // The width of the peak, growing with the distance from it.
            let width = larger(zeta * peak, 0.15 * (w - peak).abs()) / PER_WIDTH;
            step = step.min(larger(width, 1e-9 * peak));
        }
        w += step;
        all.push(w);
    }
    all
}

/// The limit of zeroth order at a spindle speed, rpm; `None` where no frequency has a limit at this speed.
///
/// Each eigenvalue of `G(i w) D0` is followed over the frequency; wherever the phase equation of [D 9] holds for this speed,
/// its depth counts, and the smallest is the limit.
///
/// # Errors
/// A speed that is not positive.
pub fn limit(regeneration: &Regeneration, speed_rpm: f64) -> Result<Option<ZerothOrderLimit>> {
    let delay = regeneration.cut().delay(speed_rpm)?;
    let branch = Branch {
        response: regeneration.response(),
        mean: mean_of(regeneration.cut()),
        delay,
    };
    let frequencies = grid(branch.response);
    let mut best: Option<ZerothOrderLimit> = None;
    let start = branch.eigenvalues(frequencies[0]);
    let mut places = start.map(|mu| Place {
        frequency: frequencies[0],
        mu,
        argument: mu.inv().arg(),
    });
    let none = NONE * start[0].norm();
    for frequency in frequencies.into_iter().skip(1) {
        let next = followed(&branch, &places, frequency);
        for (from, to) in places.iter().zip(&next) {
            if from.mu.norm() > none && to.mu.norm() > none {
                within(&branch, from, to, &mut best);
            }
        }
        places = next;
    }
    Ok(best)
}

fn mean_of(cut: &Cut) -> Matrix3<f64> {
    cut.mean_matrix()
}

/// Both branches at the next frequency: each eigenvalue goes to one of them.
fn followed(branch: &Branch<'_>, places: &[Place; 2], frequency: f64) -> [Place; 2] {
    let [a, b] = branch.eigenvalues(frequency);
    let apart = |place: &Place, mu: Complex64| {
        // An eigenvalue that is zero stays so: it is near to another zero only.
        match (mu.norm() > 0.0, place.mu.norm() > 0.0) {
            (true, true) => (mu / place.mu).ln().norm(),
            (false, false) => 0.0,
            _ => 1e3,
        }
    };
    let kept = apart(&places[0], a) + apart(&places[1], b);
    let crossed = apart(&places[0], b) + apart(&places[1], a);
    let order = if crossed < kept { [b, a] } else { [a, b] };
    [0, 1].map(|i| Place {
        frequency,
        mu: order[i],
        argument: places[i].argument + turned(places[i].mu, order[i]),
    })
}

/// By how much `1/mu` turns.
fn turned(before: Complex64, now: Complex64) -> f64 {
    let angle = (before / now).arg();
    if angle.is_finite() { angle } else { 0.0 }
}

/// The smallest depth of all frequencies between two places at which the phase equation holds.
fn within(branch: &Branch<'_>, from: &Place, to: &Place, best: &mut Option<ZerothOrderLimit>) {
    let (low, high) = (branch.phase(from), branch.phase(to));
    let (least, most) = if low < high { (low, high) } else { (high, low) };
    // No depth between two places is far below the smaller of theirs; most turns need no closer look.
    let mut turn = (least / TAU).ceil();
    while turn * TAU < most {
        let wanted = turn * TAU;
        let (mut a, mut b) = (*from, *to);
        for _ in 0..60 {
            let middle = branch.follow(&a, 0.5 * (a.frequency + b.frequency));
            if (branch.phase(&middle) < wanted) == (low < wanted) {
                a = middle;
            } else {
                b = middle;
            }
        }
        if let Some(depth) = depth(a.mu)
            && best.is_none_or(|best| depth < best.depth)
        {
            *best = Some(ZerothOrderLimit {
                depth,
                frequency_hz: a.frequency / TAU,
            });
        }
        turn += 1.0;
    }
}

/// The smallest limit at any speed, m: the absolute minimum of zeroth order, and its frequency.
#[must_use]
pub fn absolute_minimum(regeneration: &Regeneration) -> Option<ZerothOrderLimit> {
    let branch = Branch {
        response: regeneration.response(),
        mean: mean_of(regeneration.cut()),
        delay: 0.0,
    };
    let at = |frequency: f64| {
        let depths = branch.eigenvalues(frequency).map(depth);
        depths.into_iter().flatten().reduce(f64::min)
    };
    let frequencies = grid(branch.response);
    let mut best: Option<(usize, f64)> = None;
    for (i, frequency) in frequencies.iter().enumerate() {
        if let Some(depth) = at(*frequency)
            && best.is_none_or(|(_, least)| depth < least)
        {
            best = Some((i, depth));
        }
    }
    let (i, _) = best?;
    let (mut low, mut high) = (
        frequencies[i.saturating_sub(1)],
        frequencies[(i + 1).min(frequencies.len() - 1)],
    );
    // Golden section: the depth has one minimum between neighbours of the least.
    let share = 0.5 * (5_f64.sqrt() - 1.0);
    for _ in 0..80 {
        let (a, b) = (high - share * (high - low), low + share * (high - low));
        let of = |frequency| at(frequency).unwrap_or(f64::INFINITY);
        if of(a) < of(b) { high = b } else { low = a }
    }
    let frequency = 0.5 * (low + high);
    at(frequency).map(|depth| ZerothOrderLimit {
        depth,
        frequency_hz: frequency / TAU,
    })
}
