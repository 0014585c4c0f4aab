//! Machines, settings and random numbers that several tests share.

use kinetostat::nalgebra::Vector3;
use kinetostat::{Mechanism, Wrench};
use kinetostat_model::Model;
use kinetostat_online::{Input, Limits, MOST_JOINTS, Output, Plan, PlanSettings, State, step};

/// The mechanism of a preset.
pub fn preset(name: &str) -> Mechanism {
    Model::preset(name).unwrap().mechanism
}

/// Limits that let every deflection pass.
pub fn wide() -> Limits {
    Limits {
        position: 10.0,
        rotation: 10.0,
        force: 1e6,
        moment: 1e6,
        ..Limits::default()
    }
}

/// Settings without a probe and without a sensor, at 1 kHz.
pub fn feed_forward() -> PlanSettings {
    let mut settings = PlanSettings::new(1e-3);
    settings.probe = None;
    settings
}

/// Joints as an input has them.
pub fn joints(values: &[f64]) -> [f64; MOST_JOINTS] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

/// The next cycle of an input.
pub fn next(plan: &Plan, state: &mut State, input: &mut Input) -> Output {
    input.sequence += 1;
    step(plan, state, input)
}

/// Numbers in 0 to 1, the same in every run (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between minus and plus.
    pub fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.unit() - 1.0)
    }

    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.within(size))
    }

    pub fn wrench(&mut self, force: f64, moment: f64) -> Wrench {
        Wrench::new(self.vector(force), self.vector(moment))
    }
}
