//! The answer of `modes`, stable names with units.

use kinetostat_dynamics::{DirectionCounts, EnergyShare, ModeKind, Verdict};
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::place::query::AnswerHead;

#[derive(Serialize, JsonSchema)]
pub(crate) struct ModesAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// Directions of the tool that are held.
    pub(crate) hold: Option<String>,
    /// Damping in words.
    pub(crate) damping: String,
    pub(crate) total_mass_kg: f64,
    /// True if the equilibrium is stable: no unstable mode and no massless instability, or no pair that grows; null if that
    /// is not judged.
    pub(crate) stable: Option<bool>,
    /// Evolution of a small disturbance where loads have no potential (followers, a moment that does not turn with
    /// the tool). `modes` are complex pairs then.
    pub(crate) circulatory: Option<Circulatory>,
    /// Counts; under loads without a potential `vibrating` are pairs that do not grow, `unstable` those that do.
    pub(crate) directions: DirectionCounts,
    /// Joints and springs in neutral directions: neither mass nor stiffness.
    pub(crate) neutral: Vec<String>,
    /// Number of modes (or complex pairs); `modes` has the lowest of them.
    pub(crate) mode_count: usize,
    pub(crate) modes: Vec<ModeAnswer>,
    pub(crate) warnings: Vec<Warning>,
    /// Pair that grows fastest.
    #[serde(skip)]
    pub(crate) fastest_growing: Option<ComplexAnswer>,
    /// Damping that has no part in complex pairs.
    #[serde(skip)]
    pub(crate) structural: bool,
}

/// Complex modes under loads without a potential.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Circulatory {
    pub(crate) verdict: Verdict,
    /// Largest share of the imaginary part in a squared frequency without damping.
    pub(crate) complexity: f64,
    pub(crate) modes: Vec<ComplexAnswer>,
}

/// A complex mode: `e^(lambda t)`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ComplexAnswer {
    pub(crate) frequency_hz: f64,
    /// Real part of lambda: positive where it grows.
    pub(crate) growth_per_s: f64,
    /// Share of critical damping, negative where it grows.
    pub(crate) damping_ratio: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ModeAnswer {
    /// Number from 1, by ascending squared frequency.
    pub(crate) number: usize,
    pub(crate) kind: ModeKind,
    /// Negative where unstable, zero where free; of a complex pair that of its swing, zero where it does not swing.
    pub(crate) frequency_hz: f64,
    /// Real part of lambda of a complex pair, positive where it grows; null where loads have a potential.
    pub(crate) growth_per_s: Option<f64>,
    /// Signed square of the angular frequency; of a complex pair the real part of the square of -i lambda.
    pub(crate) squared_rad_per_s_2: f64,
    /// Share of critical damping, negative where a pair grows; null without damping, or where it has none.
    pub(crate) damping_ratio: Option<f64>,
    /// Motion of the tool's tip, base axes, of the shape normalised by mass.
    pub(crate) tool_translation_per_sqrt_kg: [f64; 3],
    pub(crate) tool_rotation_rad_per_m_sqrt_kg: [f64; 3],
    /// Shares that add to 1.
    pub(crate) kinetic_energy: Vec<EnergyShare>,
    /// Shares that add to 1, or are 0 where no spring is strained.
    pub(crate) elastic_energy: Vec<EnergyShare>,
}
