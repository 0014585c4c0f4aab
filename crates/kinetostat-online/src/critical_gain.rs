//! Predicted critical gain of the sampled loop: command, drive, structure in contact, low pass, delay.
//!
//! ```text
//! lag x_u' = u - x_u
//! m x'' + d x' + K_r x = d x_u' + K_r x_u - K_e x,    kappa = K_e / K_r
//! u[k] = beta / K_r H(z) z^-delay K_e x[k]
//! ```
//!
//! The loop is stable without feedback, so that it loses stability at the smallest `beta` at which `beta g` is one somewhere on the
//! unit circle, `g(z) = kappa z^-delay H(z) [(z I - A)^-1 B]_x`: the largest real value that `g` takes there decides. At `z = 1` that is
//! the static gain `kappa / (1 + kappa)`. Source: theory note, on-line, section 4.

use nalgebra::{Complex, Matrix4};

/// Points of the unit circle at which the phase is looked at; a mode of 2 % damping at 10 Hz and 1 kHz covers a dozen.
const POINTS: usize = 16_384;

/// The sampled loop of one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledLoop {
    /// Process stiffness by that of the machine.
    pub kappa: f64,
    /// First natural frequency of the machine, Hz.
    pub mode_hz: f64,
    /// Damping ratio of the mode.
    pub damping: f64,
    /// Time constant of the drive, s.
    pub lag: f64,
    /// Cycles of delay; at least one.
    pub delay_cycles: u32,
    /// Cutoff of the low pass, Hz.
    pub cutoff_hz: f64,
    /// Order of the low pass, 1 or 2.
    pub order: u32,
    /// True if a notch of quality 1 sits at the mode as the contact loads it.
    pub notch: bool,
    /// Period, s.
    pub period: f64,
}

type C = Complex<f64>;

impl SampledLoop {
    /// The gain (1: exact compensation) from which on the loop is unstable; infinite without contact.
    #[must_use]
    pub fn critical_gain(&self) -> f64 {
        let plant = self.discrete_plant();
        let at = |angle: f64| self.transfer(&plant, C::from_polar(1.0, angle));
        let mut largest = self.kappa / (1.0 + self.kappa);
        // Angles crowd at zero, where a slow filter turns its phase.
        let angle = |k: usize| std::f64::consts::PI * (k as f64 / POINTS as f64).powi(3);
        let (mut before, mut value) = (angle(1), at(angle(1)));
        for k in 2..=POINTS {
            let (now, next) = (angle(k), at(angle(k)));
            if (value.im < 0.0) != (next.im < 0.0) && value.re.max(next.re) > 0.0 {
                largest = kinetostat::number::larger(largest, crossing(&at, before, now));
            }
            (before, value) = (now, next);
        }
        largest.max(value.re).recip()
    }

    /// `[A, B]` of servo, place and speed of the structure over one period of constant command: `exp([A, B; 0, 0] T)`.
    fn discrete_plant(&self) -> Matrix4<f64> {
        let w = std::f64::consts::TAU * self.mode_hz;
        let (d, spring) = (2.0 * self.damping * w, w * w);
        let rate = 1.0 / self.lag;
        #[rustfmt::skip]
        let continuous = Matrix4::new(
            -rate, 0.0, 0.0, rate,
            0.0, 0.0, 1.0, 0.0,
            spring - d * rate, -spring * (1.0 + self.kappa), -d, d * rate,
            0.0, 0.0, 0.0, 0.0,
        );
        exponential(&(continuous * self.period))
    }

    /// `g(z)` by the three states' own equations.
    fn transfer(&self, plant: &Matrix4<f64>, z: C) -> C {
        let entry = |i: usize, j: usize| C::from(plant[(i, j)]);
        let servo = entry(0, 3) / (z - entry(0, 0));
        // Place and speed under servo and command.
        let (push_x, push_v) = (
            entry(1, 0) * servo + entry(1, 3),
            entry(2, 0) * servo + entry(2, 3),
        );
        let (a, b, c, d) = (z - entry(1, 1), -entry(1, 2), -entry(2, 1), z - entry(2, 2));
        let place = (push_x * d - b * push_v) / (a * d - b * c);
        let delay = z.powi(-(self.delay_cycles.max(1) as i32));
        place * self.filter(z) * delay * self.kappa
    }

    /// Butterworth low pass by the bilinear transform with prewarping, and the notch.
    fn filter(&self, z: C) -> C {
        let s = (z - 1.0) / (z + 1.0);
        let tangent = |hz: f64| (std::f64::consts::PI * hz * self.period).tan();
        let k = tangent(self.cutoff_hz);
        let one = C::from(1.0);
        let low = match self.order {
            1 => one * k / (s + k),
            _ => one * k * k / (s * s + s * (std::f64::consts::SQRT_2 * k) + k * k),
        };
        if !self.notch {
            return low;
        }
        let k = tangent(self.mode_hz * (1.0 + self.kappa).sqrt());
        // scipy.signal.iirnotch of quality 1: its bandwidth is warped by itself and equals tan(w/2).
        let wide = (1.0 + k * k) * k;
        low * (s * s + k * k) / (s * s + s * wide + k * k)
    }
}

/// Value of `g` where it crosses the real axis between two angles.
fn crossing(at: &impl Fn(f64) -> C, mut low: f64, mut high: f64) -> f64 {
    let negative = at(low).im < 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match (at(middle).im < 0.0) == negative {
            true => low = middle,
            false => high = middle,
        }
    }
    at(low).re
}

/// Exponential of a small matrix: its series after halvings.
fn exponential(m: &Matrix4<f64>) -> Matrix4<f64> {
    let halvings = (m.norm().log2().ceil().max(0.0) + 4.0).min(60.0) as i32;
    let small = m / 2.0_f64.powi(halvings);
    let (mut sum, mut term) = (Matrix4::identity(), Matrix4::identity());
    for k in 1..=14 {
        term = term * small / f64::from(k);
        sum += term;
    }
    for _ in 0..halvings {
        sum *= sum;
    }
    sum
}
