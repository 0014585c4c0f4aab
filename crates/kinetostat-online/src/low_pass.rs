//! Second-order Butterworth low pass of the measured force.
//!
//! ```text
//! H(s) = w^2 / (s^2 + sqrt(2) w s + w^2),   s = (2/T) (1 - 1/z) / (1 + 1/z),   w = (2/T) tan(pi f T)
//! ```
//!
//! The bilinear transform with the cutoff prewarped, as `scipy.signal.butter` has it; transposed direct form II.

/// Coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LowPass {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Cutoff (Hz) at a period (s); the cutoff lies below half of the rate.
    pub(crate) fn new(cutoff_hz: f64, period: f64) -> Self {
        let k = (std::f64::consts::PI * cutoff_hz * period).tan();
        let scale = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
        let b = k * k * scale;
        Self {
            b: [b, 2.0 * b, b],
            a: [
                2.0 * (k * k - 1.0) * scale,
                (1.0 - std::f64::consts::SQRT_2 * k + k * k) * scale,
            ],
        }
    }
}

/// Memory of six components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LowPassState {
    z: [[f64; 2]; 6],
}

impl LowPassState {
    /// The next value of each component.
    pub(crate) fn next(&mut self, filter: &LowPass, input: &[f64; 6]) -> [f64; 6] {
        let mut output = [0.0; 6];
        for k in 0..6 {
            let (x, z) = (input[k], &mut self.z[k]);
            let y = filter.b[0] * x + z[0];
            z[0] = filter.b[1] * x - filter.a[0] * y + z[1];
            z[1] = filter.b[2] * x - filter.a[1] * y;
            output[k] = y;
        }
        output
    }
}
