//! The answer of `shares`, stable names with units.

use kinetostat_analysis::sensitivity::{Sensitivities, Sensitivity, Values};
use kinetostat_analysis::shares::stiffening::Stiffening;
use kinetostat_analysis::shares::{PartKind, Shares};
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::place::query::AnswerHead;

#[derive(Serialize, JsonSchema)]
pub(crate) struct SharesAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    /// Direction in words.
    pub(crate) direction: String,
    /// Unit force (its first three) or moment, base axes, about the tool's tip.
    pub(crate) direction_components: [f64; 6],
    pub(crate) loaded: bool,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// True if the equilibrium is stable.
    pub(crate) stable: bool,
    /// m/N, or rad/(N m) for a moment: that of the tangent.
    pub(crate) compliance_m_or_rad_per_n_or_n_m: f64,
    /// All shares of `parts` add to 1.
    pub(crate) parts: Vec<PartAnswer>,
    pub(crate) limbs: Vec<LimbAnswer>,
    /// Share of all loads that turn: geometric stiffness.
    pub(crate) geometric_share: f64,
    /// Sum of all parts by the motion of the tool, less 1.
    pub(crate) rounding: f64,
    /// Joints that store no energy.
    pub(crate) passive_joints: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stiffening: Option<StiffeningAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sensitivities: Option<SensitivitiesAnswer>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct PartAnswer {
    pub(crate) limb: Option<String>,
    pub(crate) name: String,
    pub(crate) kind: PartKind,
    pub(crate) share: f64,
    pub(crate) compliance_m_or_rad_per_n_or_n_m: f64,
}

impl PartAnswer {
    /// `limb: name`, the limb only where there are several.
    pub(crate) fn full_name(&self, several: bool) -> String {
        match (&self.limb, several) {
            (Some(limb), true) => format!("{limb}: {}", self.name),
            _ => self.name.clone(),
        }
    }
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbAnswer {
    /// Absent for loads on platforms.
    pub(crate) name: Option<String>,
    pub(crate) share: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct StiffeningAnswer {
    pub(crate) assumption: &'static str,
    pub(crate) target: f64,
    /// False where no stiffening of springs is enough.
    pub(crate) possible: bool,
    /// Sum of all `factor - 1`.
    pub(crate) cost: Option<f64>,
    pub(crate) compliance_ratio_reached: Option<f64>,
    pub(crate) parts: Vec<StiffenedAnswer>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct StiffenedAnswer {
    pub(crate) limb: Option<String>,
    pub(crate) name: String,
    pub(crate) factor: f64,
}

impl StiffeningAnswer {
    pub(crate) fn of(found: Option<&Stiffening>, target: f64) -> Self {
        Self {
            assumption: "the price of a part is its relative increase of stiffness, for all parts alike; parts are chosen for the way that the load takes in the stiffened machine, unloaded, as drawn",
            target,
            possible: found.is_some(),
            cost: found.map(|f| f.cost),
            compliance_ratio_reached: found.map(|f| f.after / f.before),
            parts: found.map_or_else(Vec::new, |f| {
                let parts = f.parts.iter().map(|p| StiffenedAnswer {
                    limb: p.part.limb.clone(),
                    name: p.part.name.clone(),
                    factor: p.factor,
                });
                parts.collect()
            }),
        }
    }
}

#[derive(Serialize, JsonSchema, Default)]
pub(crate) struct SensitivitiesAnswer {
    /// Differentiation method.
    pub(crate) method: &'static str,
    pub(crate) deflection_m_or_rad: f64,
    pub(crate) stiffness_n_or_n_m_per_m_or_rad: f64,
    pub(crate) share_to_buckling: Option<f64>,
    /// The strongest first; numbers that change none of the figures are left out.
    pub(crate) numbers: Vec<SensitivityAnswer>,
    /// Numbers that could not be differentiated, with the reason.
    pub(crate) not_differentiated: Vec<(String, String)>,
    pub(crate) without_effect: Vec<String>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct SensitivityAnswer {
    pub(crate) path: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
    /// Per unit of the number.
    #[serde(flatten)]
    pub(crate) derivatives: DerivativesAnswer,
    /// Change by 1 % more of the number; of a number that is zero there is none.
    pub(crate) deflection_by_percent_m_or_rad: f64,
    pub(crate) stiffness_by_percent_relative: f64,
    /// Difference of these derivatives of sixth order from those of fourth: an estimate of the discretisation error.
    pub(crate) estimated_errors: Option<DerivativesAnswer>,
}

/// Derivatives by a number, or their errors in the same units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DerivativesAnswer {
    pub(crate) deflection: f64,
    pub(crate) displacement: [f64; 6],
    pub(crate) compliance: f64,
    pub(crate) stiffness: f64,
    /// Absent if two directions are equally soft and the number changes them differently.
    pub(crate) stiffness_against_force: Option<f64>,
    /// Absent without a load that buckles, and if two limbs or shapes are equally near and the number changes them differently.
    pub(crate) share_to_buckling: Option<f64>,
}

impl DerivativesAnswer {
    /// Derivatives; absent where they do not exist.
    fn of(s: &Sensitivity, v: &Values) -> Self {
        Self {
            deflection: v.deflection,
            displacement: v.displacement,
            compliance: v.compliance,
            stiffness: v.stiffness,
            stiffness_against_force: (!s.sharp.stiffness_against_force)
                .then_some(v.stiffness_against_force),
            share_to_buckling: v.share_to_buckling.filter(|_| !s.sharp.share_to_buckling),
        }
    }
}

impl SensitivityAnswer {
    fn of(s: &Sensitivity, d: &Values, now: f64) -> Self {
        Self {
            path: s.parameter.path.clone(),
            value: s.parameter.value,
            unit: s.parameter.unit,
            derivatives: DerivativesAnswer::of(s, d),
            deflection_by_percent_m_or_rad: s.deflection_by_percent(),
            stiffness_by_percent_relative: s.stiffness_by_percent(now),
            estimated_errors: s.errors.as_ref().map(|e| DerivativesAnswer::of(s, e)),
        }
    }
}

impl SensitivitiesAnswer {
    pub(crate) fn of(found: &Sensitivities) -> Self {
        let now = found.values.stiffness;
        let mut answer = Self {
            method: "implicit function theorem at the equilibrium; what is explicit (residual, stiffness, margin) by central differences extrapolated to sixth order",
            deflection_m_or_rad: found.values.deflection,
            stiffness_n_or_n_m_per_m_or_rad: now,
            share_to_buckling: found.values.share_to_buckling,
            ..Self::default()
        };
        for s in &found.list {
            let path = s.parameter.path.clone();
            match &s.derivatives {
                Err(reason) => answer.not_differentiated.push((path, reason.clone())),
                Ok(d) => {
                    let size = s
                        .parameter
                        .value
                        .abs()
                        .max(1.0 / s.parameter.in_si.max(1.0));
                    match !s.sharp.any() && d.is_nothing(size, &found.values) {
                        true => answer.without_effect.push(path),
                        false => answer.numbers.push(SensitivityAnswer::of(s, d, now)),
                    }
                }
            }
        }
        let effect = |s: &SensitivityAnswer| {
            (s.deflection_by_percent_m_or_rad / found.values.deflection)
                .abs()
                .max(s.stiffness_by_percent_relative.abs())
        };
        answer
            .numbers
            .sort_by(|a, b| effect(b).total_cmp(&effect(a)));
        answer
    }
}

/// Parts and limbs of shares.
pub(crate) fn parts(shares: &Shares) -> (Vec<PartAnswer>, Vec<LimbAnswer>) {
    let mut parts: Vec<PartAnswer> = (shares.parts.iter())
        .map(|p| PartAnswer {
            limb: p.limb.clone(),
            name: p.name.clone(),
            kind: p.kind,
            share: p.share,
            compliance_m_or_rad_per_n_or_n_m: p.compliance,
        })
        .collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let limbs = shares
        .by_limb()
        .into_iter()
        .map(|(name, share)| LimbAnswer {
            name: name.map(str::to_owned),
            share,
        });
    (parts, limbs.collect())
}
