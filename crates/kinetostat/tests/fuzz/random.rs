//! Random numbers from a seed (SplitMix64).

use nalgebra::{Matrix6, Vector3};

pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed ^ 0x6b69_6e65_746f_7374)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [-1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.signed() + 1.0)
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// True once in `count` times.
    pub fn once_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// Ten to a power between two.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }

    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::new(self.signed(), self.signed(), self.signed()) * size
    }

    pub fn axis(&mut self) -> Vector3<f64> {
        loop {
            let v = self.vector(1.0);
            if (0.3..1.0).contains(&v.norm()) {
                return v.normalize();
            }
        }
    }

    /// Symmetric and positive definite, every pair of directions coupled; sizes N/m and N m/rad.
    pub fn stiffness(&mut self, linear: f64, angular: f64) -> Matrix6<f64> {
        let a = Matrix6::from_fn(|_, _| 0.4 * self.signed());
        let m = Matrix6::identity() + a * a.transpose();
        let unit = |i: usize| if i < 3 { linear.sqrt() } else { angular.sqrt() };
        Matrix6::from_fn(|i, j| m[(i, j)] * unit(i) * unit(j))
    }
}
