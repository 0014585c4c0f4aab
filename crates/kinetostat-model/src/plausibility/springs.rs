//! Springs that do not fit the rest of their machine.

use kinetostat::number::short;
use kinetostat::{
    MotionKind,
    model::{Role, SpringLaw},
};

use crate::plausibility::LimbCheck;
use crate::plausibility::at_home::moments;
use crate::problem::Finding;

impl LimbCheck<'_> {
    /// Springs of six directions whose translations and rotations do not belong together: the square
    /// root of N m/rad by N/m is a length of the part.
    pub(crate) fn springs6(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        for spring in chain.springs().iter().filter(|s| s.segment.is_none()) {
            let SpringLaw::Linear(k) = &spring.law else {
                continue;
            };
            if k.nrows() != 6 {
                continue;
            }
            let mean =
                |range: std::ops::Range<usize>| range.map(|i| k[(i, i)]).product::<f64>().cbrt();
            let length = (mean(3..6) / mean(0..3)).sqrt();
            if !(1e-4 * self.size..=5.0 * self.size).contains(&length) {
                warnings.push(Finding::new(
                    &self.place(&spring.name, &["spring6"]),
                    format!(
                        "the translations and rotations of the spring '{}' belong to a part of {} m, in a machine of {} m",
                        spring.name,
                        short(length),
                        short(self.size)
                    ),
                    "check the unit of the matrix: _n_m_rad or _n_mm_rad",
                ));
            }
        }
    }

    /// Joints that give way far under the weight alone.
    pub(crate) fn sag(&self, warnings: &mut Vec<Finding>) {
        let limb = &self.mechanism.limbs()[self.limb];
        // The other limbs carry too, if there are several.
        if self.mechanism.limbs().len() > 1 || limb.nominal.springs().is_empty() {
            return;
        }
        let loads = moments(self.mechanism, self.limb);
        for spring in limb.nominal.springs() {
            let SpringLaw::Linear(k) = &spring.law else {
                continue;
            };
            if k.len() != 1 {
                continue;
            }
            let Some(load) = loads.iter().find(|l| l.coordinate == spring.first) else {
                continue;
            };
            let gives = load.size / k[(0, 0)];
            let kind = limb.nominal.coordinates()[spring.first].kind;
            let (most, text) = match kind {
                MotionKind::Revolute => {
                    (0.1, format!("turns by {:.0} degrees", gives.to_degrees()))
                }
                MotionKind::Prismatic => (
                    0.03 * self.size,
                    format!("slides by {} mm", short((1e3 * gives).round())),
                ),
            };
            if gives > most
                && !limb
                    .nominal
                    .coordinates()
                    .iter()
                    .any(|c| c.role == Role::Passive)
            {
                warnings.push(Finding::new(
                    &self.place(
                        &spring.name,
                        &[
                            "stiffness_n_per_m",
                            "stiffness_n_per_mm",
                            "stiffness_n_m_per_rad",
                            "stiffness_n_mm_per_rad",
                        ],
                    ),
                    format!(
                        "the joint '{}' {text} under the machine's own weight",
                        spring.name
                    ),
                    "check the units of its stiffness and of the masses behind it",
                ));
            }
        }
    }
}
