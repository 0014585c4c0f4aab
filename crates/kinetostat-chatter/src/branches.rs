//! Eigenvalues of the receptance times a process matrix, followed over the frequency.

use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::number::{Complex64, larger, smaller};
use crate::response::ToolResponse;

/// Frequencies that are looked at within half the width of a peak.
const PER_WIDTH: f64 = 12.0;
/// Frequencies that are looked at in each octave beside the peaks.
const PER_OCTAVE: f64 = 48.0;
/// Upper end of the search, as a multiple of the fastest mode's frequency.
const BEYOND: f64 = 4.0;
/// Eigenvalues smaller than this share of the largest that was found are none: the tool does not give way there.
const NONE: f64 = 1e-12;

/// A tool and a process that pushes back without delay: force by displacement.
pub(crate) struct Branches<'a> {
    pub(crate) response: &'a ToolResponse,
    /// Receptance of the tool at an angular frequency, rad/s, m/N.
    pub(crate) receptance: Box<dyn Fn(f64) -> Matrix3<Complex64> + 'a>,
    /// Mean matrix of the process, of rank 2 at most.
    pub(crate) mean: Matrix3<f64>,
}

/// A place on a branch: angular frequency, `lam = 1/mu` and its argument, unwrapped.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// rad/s.
    pub(crate) frequency: f64,
    pub(crate) mu: Complex64,
    pub(crate) argument: f64,
}

impl Branches<'_> {
    /// The two eigenvalues that are not 0 for certain: those in the plane of the chip.
    pub(crate) fn eigenvalues(&self, frequency: f64) -> [Complex64; 2] {
        // The mean matrix has rank 2 at most: G D0 and its part in the range of D0^T have the same eigenvalues but zeros.
        let product = (self.receptance)(frequency) * self.mean.map(Complex64::from);
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
    pub(crate) fn follow(&self, last: &Place, frequency: f64) -> Place {
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

    /// Follows both branches over all frequencies; `at` gets the ends of every step on each.
    pub(crate) fn walk(&self, mut at: impl FnMut(&Place, &Place)) {
        let frequencies = grid(self.response);
        let first = frequencies[0];
        let start = self.eigenvalues(first);
        let mut places = start.map(|mu| Place {
            frequency: first,
            mu,
            argument: turned(Complex64::from(1.0), mu),
        });
        let mut largest = 0.0;
        for frequency in frequencies.into_iter().skip(1) {
            let next = self.followed(&places, frequency);
            largest = larger(largest, larger(next[0].mu.norm(), next[1].mu.norm()));
            for (from, to) in places.iter().zip(&next) {
                if from.mu.norm() > NONE * largest && to.mu.norm() > NONE * largest {
                    at(from, to);
                }
            }
            places = next;
        }
    }

    /// Place between two places of a branch at which a monotonic function passes 0.
    pub(crate) fn closed_in(&self, from: &Place, to: &Place, of: impl Fn(&Place) -> f64) -> Place {
        // Illinois' rule: secants that stay inside.
        let (mut a, mut b) = (*from, *to);
        let (mut low, mut high) = (of(from), of(to));
        let mut side = 0;
        for _ in 0..60 {
            let share = (low / (low - high)).clamp(1e-6, 1.0 - 1e-6);
            let place = self.follow(&a, a.frequency + share * (b.frequency - a.frequency));
            let value = of(&place);
            if value.abs() < 1e-13 * (1.0 + place.argument.abs())
                || b.frequency - a.frequency <= 1e-14 * b.frequency
            {
                return place;
            }
            if (value < 0.0) == (low < 0.0) {
                (a, low) = (place, value);
                if side == -1 {
                    high *= 0.5;
                }
                side = -1;
            } else {
                (b, high) = (place, value);
                if side == 1 {
                    low *= 0.5;
                }
                side = 1;
            }
        }
        a
    }

    /// Both branches at the next frequency: each eigenvalue goes to one of them.
    fn followed(&self, places: &[Place; 2], frequency: f64) -> [Place; 2] {
        let [a, b] = self.eigenvalues(frequency);
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
}

/// Two unit vectors at right angles that hold all displacements which change the mean chip.
fn plane(mean: &Matrix3<f64>) -> [Vector3<f64>; 2] {
    let rows = [0, 1, 2].map(|i| mean.row(i).transpose());
    let longest = rows.into_iter().fold(
        Vector3::zeros(),
        |a, b| {
            if b.norm() > a.norm() { b } else { a }
        },
    );
    let Some(first) = longest.try_normalize(0.0) else {
        return [Vector3::x(), Vector3::y()];
    };
    let across = rows.map(|row| row - first * first.dot(&row));
    let second = across.into_iter().fold(
        Vector3::zeros(),
        |a, b| {
            if b.norm() > a.norm() { b } else { a }
        },
    );
    let other = match second.norm() > 1e-12 * longest.norm() {
        true => second.normalize(),
        // Rank one: any direction across has a zero eigenvalue.
        false => first
            .cross(&first.map(|c| if c.abs() < 0.6 { 1.0 } else { 0.0 }))
            .normalize(),
    };
    [first, other]
}

/// Frequencies at which the branches are followed, rad/s: close together at the peaks, in ratios elsewhere.
pub(crate) fn grid(response: &ToolResponse) -> Vec<f64> {
    let modes = response.modes();
    let fastest = modes
        .iter()
        .map(|m| m.angular_frequency())
        .fold(0.0, larger);
    let slowest = modes
        .iter()
        .map(|m| m.angular_frequency())
        .fold(fastest, smaller);
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

/// Rotation of `1/mu`, rad.
fn turned(before: Complex64, now: Complex64) -> f64 {
    let angle = (before / now).arg();
    if angle.is_finite() { angle } else { 0.0 }
}
