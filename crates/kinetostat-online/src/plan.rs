//! The plan: everything that a cycle needs and that never changes.

use std::sync::atomic::{AtomicU64, Ordering};

use kinetostat::{Directions, Mechanism};
use nalgebra::Vector3;

use crate::critical_gain::SampledLoop;
use crate::error::{Error, Result};
use crate::gain::{LARGEST_LOOP_GAIN, stiffness_ratios};
use crate::limiter::Rate;
use crate::low_pass::LowPass;
use crate::machine::equilibrium::MachineState;
use crate::machine::model::MachinePlan;
use crate::machine::supported;
use crate::settings::PlanSettings;

/// Joints without limits are believed up to this size, rad or m.
const LARGEST_JOINT: f64 = 1e3;

/// Remark about a plan that is compiled nevertheless.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Directions that were asked for and that the actuators cannot correct; their deflection is reported.
    NotCorrected(Directions),
    /// The process stiffness is not known: arming is refused.
    OnlyShadow,
    /// The feedback of some direction is scaled at home: the static loop gain would be above 0.7.
    Scaled {
        /// Static loop gain without scaling.
        loop_gain: f64,
    },
    /// The sampled loop is predicted to be unstable, or nearly, in some direction at home.
    CriticalGain {
        /// Stiffness of the process by that of the machine.
        kappa: f64,
        /// Gain with which the plan works there.
        gain: f64,
        /// Gain from which on the loop is unstable.
        critical: f64,
    },
}

/// A machine, its sensor and its limits, compiled once. Shared by any number of [`crate::State`]s.
#[derive(Clone, Debug)]
pub struct Plan {
    /// States know their plan by it.
    pub(crate) id: u64,
    pub(crate) settings: PlanSettings,
    pub(crate) machine: MachinePlan,
    pub(crate) filter: Option<LowPass>,
    pub(crate) joint_limits: Vec<(f64, f64)>,
    pub(crate) linear: Rate,
    pub(crate) angular: Rate,
    pub(crate) most_held: u32,
    /// Unit direction of the probe.
    pub(crate) probe_direction: Vector3<f64>,
    warnings: Vec<Warning>,
}

impl Plan {
    /// Compiles a plan. Own loads of the mechanism (gravity, compensators) are compensated like any other; for a controller
    /// that corrects them itself, give [`Mechanism::without_own_loads`].
    ///
    /// # Errors
    /// [`Error::Unsupported`] with the feature of the machine, [`Error::FilterTooFast`] with both frequencies,
    /// [`Error::Setting`] with the value found and what is allowed, errors of the statics at home.
    pub fn compile(mechanism: &Mechanism, settings: &PlanSettings) -> Result<Self> {
        settings.check()?;
        supported::check(mechanism)?;
        let (directions, left) = supported::correctable(mechanism, settings.directions)?;
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let limits = &settings.limits;
        let actuators = mechanism.limbs().iter();
        let actuators = actuators.flat_map(|l| l.nominal.actuators());
        let mut plan = Self {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            machine: MachinePlan::new(mechanism, directions),
            filter: settings
                .sensor
                .map(|sensor| LowPass::new(sensor.cutoff_hz, settings.period)),
            joint_limits: actuators
                .map(|a| a.limits.unwrap_or((-LARGEST_JOINT, LARGEST_JOINT)))
                .collect(),
            linear: Rate {
                speed: limits.speed,
                acceleration: limits.acceleration,
            },
            angular: Rate {
                speed: limits.angular_speed,
                acceleration: limits.angular_acceleration,
            },
            most_held: (settings.hold / settings.period * (1.0 + 1e-9)) as u32,
            probe_direction: settings
                .probe
                .map_or_else(Vector3::z, |probe| probe.direction.normalize()),
            settings: settings.clone(),
            warnings: Vec::new(),
        };
        let unsupported = |reason: &str| Error::Unsupported {
            machine: mechanism.name().to_owned(),
            reason: reason.to_owned(),
        };
        let mut state = MachineState::new(&plan.machine)
            .ok_or_else(|| unsupported("a spring has no stiffness at rest"))?;
        let home = mechanism
            .posture(&mechanism.platforms()[mechanism.tool()].home)?
            .commands();
        // Loops are closed step by step.
        let found = (0..50).any(|_| state.prepare(&plan.machine, &home));
        if !found {
            return Err(unsupported(
                "at its home pose it is singular, or a limb has redundant passive joints",
            ));
        }
        let compliance = state.compliance.fixed_view::<3, 3>(0, 0).into_owned();
        plan.warn(left, &compliance);
        Ok(plan)
    }

    fn warn(&mut self, left: Directions, compliance: &nalgebra::Matrix3<f64>) {
        if !left.is_empty() {
            self.warnings.push(Warning::NotCorrected(left));
        }
        let Some(sensor) = self.settings.sensor else {
            return;
        };
        let Some(process) = sensor.process_stiffness else {
            self.warnings.push(Warning::OnlyShadow);
            return;
        };
        let Some((ratios, _)) = stiffness_ratios(compliance, &process) else {
            return;
        };
        for kappa in ratios {
            let loop_gain = kappa / (1.0 + kappa);
            let gain = (LARGEST_LOOP_GAIN / loop_gain).min(1.0);
            if gain < 1.0 {
                self.warnings.push(Warning::Scaled { loop_gain });
            }
            let Some(drive) = self.settings.drive else {
                continue;
            };
            let sampled = SampledLoop {
                kappa,
                mode_hz: sensor.first_frequency_hz,
                damping: drive.damping,
                lag: drive.lag,
                delay_cycles: drive.delay_cycles,
                cutoff_hz: sensor.cutoff_hz,
                order: 2,
                notch: false,
                period: self.settings.period,
            };
            let critical = sampled.critical_gain();
            // The margin of the static rule is asked of the sampled loop, too.
            if critical * LARGEST_LOOP_GAIN < gain * (1.0 - 1e-9) {
                self.warnings.push(Warning::CriticalGain {
                    kappa,
                    gain,
                    critical,
                });
            }
        }
    }

    /// Name of the mechanism.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.machine.name
    }

    /// Number of joints, the first of those of [`crate::Input`].
    #[must_use]
    pub fn joints(&self) -> usize {
        self.machine.joints
    }

    /// Directions that are corrected.
    #[must_use]
    pub fn directions(&self) -> Directions {
        self.machine.directions
    }

    /// Settings that it was compiled from.
    #[must_use]
    pub fn settings(&self) -> &PlanSettings {
        &self.settings
    }

    /// Remarks of the compilation.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }
}
