//! First-order semi-discretisation (Insperger, Stepan & Turi 2008), written here again: shares no code with the crate.

use std::f64::consts::TAU;

use kinetostat_chatter::ToolResponse;
use nalgebra::{Complex, DMatrix, DVector, linalg::Schur};

/// A milling cut in plain numbers: coefficients N/m^2, angles rad, helix lag rad/m.
#[derive(Clone, Copy)]
pub struct Plain {
    pub teeth: usize,
    pub entry: f64,
    pub exit: f64,
    pub kt: f64,
    pub kr: f64,
    pub lag: f64,
    /// Slices along the depth.
    pub slices: usize,
}

impl Plain {
    /// `[xx, xy, yx, yy]` of the sum over teeth and the mean over slices.
    fn matrix(&self, turn: f64, depth: f64) -> [f64; 4] {
        let mut sum = [0.0; 4];
        for tooth in 0..self.teeth {
            for slice in 0..self.slices {
                let z = depth * (slice as f64 + 0.5) / self.slices as f64;
                let phi =
                    (turn + TAU * tooth as f64 / self.teeth as f64 - self.lag * z).rem_euclid(TAU);
                if phi < self.entry || phi > self.exit {
                    continue;
                }
                let (s, c) = phi.sin_cos();
                let (fx, fy) = (-self.kt * c - self.kr * s, self.kt * s - self.kr * c);
                for (entry, value) in sum.iter_mut().zip([fx * s, fx * c, fy * s, fy * c]) {
                    *entry += value / self.slices as f64;
                }
            }
        }
        sum
    }
}

/// Size of the largest multiplier with so many steps a tooth period.
pub fn multiplier(
    tool: &ToolResponse,
    cut: &Plain,
    speed_rpm: f64,
    depth: f64,
    steps: usize,
) -> f64 {
    let own =
        |k: usize| 2.0 * tool.modes()[k].damping_ratio() * tool.modes()[k].angular_frequency();
    let m = tool.modes().len();
    let rates = DMatrix::from_fn(m, m, |i, j| if i == j { own(i) } else { 0.0 });
    multiplier_with((tool, &rates), cut, speed_rpm, depth, steps)
}

/// The same with rates of damping between the modes, 1/s.
fn multiplier_with(
    (tool, rates): (&ToolResponse, &DMatrix<f64>),
    cut: &Plain,
    speed_rpm: f64,
    depth: f64,
    steps: usize,
) -> f64 {
    let m = tool.modes().len();
    let tau = 60.0 / speed_rpm / cut.teeth as f64;
    let h = tau / steps as f64;
    let pitch = TAU / cut.teeth as f64;
    let shape = |mode: usize| tool.modes()[mode].shape();
    // Exponential of [A + B a D C, -B a D (before), -B a D (change)] over a step, before and change held as states.
    let n = 2 * m;
    let maps: Vec<DMatrix<f64>> = (0..steps)
        .map(|i| {
            let mut mean = [0.0; 4];
            let fine = 40;
            for k in 0..fine {
                let turn = pitch * (i as f64 + (k as f64 + 0.5) / fine as f64) / steps as f64;
                for (sum, value) in mean.iter_mut().zip(cut.matrix(turn, depth)) {
                    *sum += value * depth / fine as f64;
                }
            }
            let push = |mode: usize| {
                let s = shape(mode);
                [s.x * mean[0] + s.y * mean[2], s.x * mean[1] + s.y * mean[3]]
            };
            let mut big = DMatrix::zeros(n + 4, n + 4);
            for a in 0..m {
                let w = tool.modes()[a].angular_frequency();
                big[(a, m + a)] = 1.0;
                big[(m + a, a)] -= w * w;
                for b in 0..m {
                    big[(m + a, m + b)] = -rates[(a, b)];
                }
                let [px, py] = push(a);
                for b in 0..m {
                    big[(m + a, b)] += px * shape(b).x + py * shape(b).y;
                }
                (big[(m + a, n)], big[(m + a, n + 1)]) = (-px, -py);
            }
            // The displacement before runs in a line: its rate is the last two states.
            (big[(n, n + 2)], big[(n + 1, n + 3)]) = (1.0, 1.0);
            (big * h).exp()
        })
        .collect();
    // State: modes now, displacements at the last `steps + 1` places, the newest first.
    let size = n + 2 * (steps + 1);
    let period = |x: DVector<f64>| {
        let mut y: Vec<f64> = x.rows(0, n).iter().copied().collect();
        let mut track: std::collections::VecDeque<[f64; 2]> = (0..=steps)
            .map(|k| [x[n + 2 * k], x[n + 2 * k + 1]])
            .collect();
        for map in &maps {
            let (old, next) = (track[steps], track[steps - 1]);
            let mut full = y.clone();
            full.extend([
                old[0],
                old[1],
                (next[0] - old[0]) / h,
                (next[1] - old[1]) / h,
            ]);
            let after = map * DVector::from_vec(full);
            y = after.rows(0, n).iter().copied().collect();
            let place = (0..m).fold([0.0; 2], |p, a| {
                [p[0] + shape(a).x * y[a], p[1] + shape(a).y * y[a]]
            });
            track.pop_back();
            track.push_front(place);
        }
        let mut out = DVector::zeros(size);
        out.rows_mut(0, n).copy_from_slice(&y);
        for (k, place) in track.iter().enumerate() {
            (out[n + 2 * k], out[n + 2 * k + 1]) = (place[0], place[1]);
        }
        out
    };
    let columns: Vec<DVector<f64>> = (0..size)
        .map(|k| {
            let mut unit = DVector::zeros(size);
            unit[k] = 1.0;
            period(unit)
        })
        .collect();
    let schur = Schur::try_new(DMatrix::from_columns(&columns), f64::EPSILON, 100_000).unwrap();
    let all = schur.complex_eigenvalues();
    let mut sizes = kinetostat_testing::Worst::new();
    all.iter()
        .for_each(|mu: &Complex<f64>| sizes.add(mu.norm()));
    sizes.value()
}

/// The limit of ever more steps, second order assumed.
pub fn extrapolated(
    tool: &ToolResponse,
    cut: &Plain,
    speed_rpm: f64,
    depth: f64,
    steps: usize,
) -> f64 {
    let [coarse, fine] = [steps, steps * 3 / 2].map(|k| multiplier(tool, cut, speed_rpm, depth, k));
    fine + (fine - coarse) / (2.25 - 1.0)
}

/// The same with rates of damping between the modes, 1/s.
pub fn extrapolated_with(
    tool: (&ToolResponse, &DMatrix<f64>),
    cut: &Plain,
    speed_rpm: f64,
    depth: f64,
    steps: usize,
) -> f64 {
    let of = |k: usize| multiplier_with(tool, cut, speed_rpm, depth, k);
    let [coarse, fine] = [steps, steps * 3 / 2].map(of);
    fine + (fine - coarse) / (2.25 - 1.0)
}
