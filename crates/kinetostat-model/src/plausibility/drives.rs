//! Drives: their stiffness, how far they give way under their rating, and how far they turn.

use std::f64::consts::TAU;

use kinetostat::number::short;
use kinetostat::{MotionKind, model::SpringLaw};

use crate::plausibility::LimbCheck;
use crate::problem::{Finding, KeyPath};
use crate::schema::Element;

impl LimbCheck<'_> {
    /// Drives with a stiffness of their own: name, kind, N/m or N m/rad.
    fn drives(&self) -> Vec<(&str, MotionKind, f64)> {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        chain
            .actuators()
            .iter()
            .filter_map(|a| {
                let coordinate = a.coordinate?;
                let spring = chain.springs().iter().find(|s| s.first == coordinate)?;
                match &spring.law {
                    SpringLaw::Linear(k) if k.len() == 1 => {
                        Some((a.name.as_str(), a.kind, k[(0, 0)]))
                    }
                    _ => None,
                }
            })
            .collect()
    }

    /// Drives that give way under their rating by what no drive does: gears wind up by 0.0004 to 0.02
    /// rad (cycloidal gears by 0.001 of their own, with joint and castings around them by 0.004; strain
    /// wave gears by 0.002 to 0.01), screws and motors by 0.003 to 1 mm.
    pub(crate) fn windup(&self, warnings: &mut Vec<Finding>) {
        for (name, kind, k) in self.drives() {
            let Some((Element::Actuator(a), place)) = self.element(name) else {
                continue;
            };
            let (key, rating, low, high, usual) = match kind {
                MotionKind::Revolute => (
                    "rated_torque_n_m",
                    a.rated_torque_n_m,
                    4e-4,
                    2e-2,
                    "gears wind up by 0.02 to 1 degree: check the units of stiffness (per radian, not per degree) and rating",
                ),
                MotionKind::Prismatic => (
                    "rated_force_n",
                    a.rated_force_n,
                    3e-6,
                    1e-3,
                    "screws and motors give way by 0.003 to 1 mm: check the units of stiffness and rating",
                ),
            };
            let Some(gives) = rating.map(|r| r / k) else {
                continue;
            };
            if !(low..=high).contains(&gives) {
                let amount = match kind {
                    MotionKind::Revolute => format!("{} degrees", short(gives.to_degrees())),
                    MotionKind::Prismatic => format!("{} mm", short(1e3 * gives)),
                };
                warnings.push(Finding::new(
                    &place.key(key),
                    format!("the drive '{name}' gives way by {amount} under its rating"),
                    usual,
                ));
            }
        }
    }

    /// Drives out of all proportion, by themselves and beside the others of the limb.
    pub(crate) fn stiffnesses(&self, warnings: &mut Vec<Finding>) {
        let drives = self.drives();
        const KEYS: [&str; 4] = [
            "stiffness_n_per_m",
            "stiffness_n_per_mm",
            "stiffness_n_m_per_rad",
            "stiffness_n_mm_per_rad",
        ];
        // Drives nearer to the base carry more and are stiffer.
        for pair in drives.windows(2) {
            let [(name, kind, k), (next, of_next, behind)] = pair else {
                continue;
            };
            if *kind == MotionKind::Revolute && kind == of_next && *behind > PER_DEGREE * k {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' is {:.0} times softer than '{next}' behind it, which carries less",
                        behind / k
                    ),
                    "check the unit: per radian, which is 57.3 times the figure per degree",
                ));
            }
        }
        for (name, kind, k) in &drives {
            let (low, high, unit, mistake) = match kind {
                // Belts from 1e5, screws 2e7 to 1e9, linear motors 1e7 to 1e9 N/m.
                MotionKind::Prismatic => (
                    5e4,
                    3e9,
                    "N/m",
                    "_n_per_mm or _n_per_m; belts have from 1e5, screws 2e7 to 1e9 N/m",
                ),
                // At the joint: strain wave gears of small arms 100 to 1e6, cycloidal (RV) gears 1e5
                // to 2e7 N m/rad.
                MotionKind::Revolute => (
                    100.0,
                    5e7,
                    "N m/rad",
                    "_n_m_per_rad or _n_mm_per_rad; strain wave gears have 100 to 1e6, cycloidal gears 1e5 to 2e7 N m/rad",
                ),
            };
            // Exactly 1 is the unit of a machine that teaches, not a figure of a drive.
            if (*k < low && *k != 1.0) || *k > high {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' has {} {unit}, {} than any machine's",
                        short(*k),
                        if *k < low { "softer" } else { "stiffer" }
                    ),
                    format!("check the unit in the key: {mistake}"),
                ));
            }
            let mut others: Vec<f64> = drives
                .iter()
                .filter(|(other, own, _)| own == kind && other != name)
                .map(|(_, _, k)| *k)
                .collect();
            if others.len() < 2 {
                continue;
            }
            others.sort_by(f64::total_cmp);
            let ratio = k / others[others.len() / 2];
            if !(1.0 / 300.0..=300.0).contains(&ratio) {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' is {:.0} times {} than the other drives of its limb",
                        ratio.max(1.0 / ratio),
                        if ratio < 1.0 { "softer" } else { "stiffer" }
                    ),
                    format!("check the unit in the key: {mistake}"),
                ));
            }
        }
    }

    /// Ranges of turning actuators too small to be degrees.
    pub(crate) fn ranges(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.document.limb[self.limb].chain;
        let Some(table) = self.document.chain.get(chain) else {
            return;
        };
        let place = KeyPath::root().key("chain").key(chain).key("elements");
        for (i, element) in table.elements.iter().enumerate() {
            let Element::Actuator(actuator) = element else {
                continue;
            };
            if let Some([low, high]) = actuator.limits_deg
                && high - low > 0.5
                && low.abs().max(high.abs()) <= TAU + 0.01
            {
                warnings.push(Finding::new(
                    &place.index(i).key("limits_deg"),
                    format!(
                        "the joint turns by only {} degrees in all",
                        short(high - low)
                    ),
                    "this looks like radians: write limits_rad",
                ));
            }
        }
    }
}

/// A drive that is softer than the next one by this was given per degree (57.3) or is odd anyhow.
const PER_DEGREE: f64 = 20.0;
