//! Settings of a plan: what the machine, its sensor and its operator allow.

use kinetostat::Directions;
use kinetostat::spatial::Pose;
use nalgebra::Vector3;

use crate::error::{Error, Result};
use crate::probe::ProbeSettings;

/// Limits of the correction and of what it is computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest correction of the position, m. A larger one is clamped, one of more than twice this size ramps to zero.
    pub position: f64,
    /// Largest correction of the orientation, rad, in the same way.
    pub rotation: f64,
    /// Largest speed of the correction, m/s.
    pub speed: f64,
    /// Largest acceleration of the correction, m/s^2.
    pub acceleration: f64,
    /// Largest angular speed of the correction, rad/s.
    pub angular_speed: f64,
    /// Largest angular acceleration of the correction, rad/s^2.
    pub angular_acceleration: f64,
    /// Largest speed of the correction of a joint, rad/s or m/s: near a singular posture joints would jump.
    pub joint_speed: f64,
    /// Largest force that is believed, N.
    pub force: f64,
    /// Largest moment that is believed, N m.
    pub moment: f64,
}

impl Default for Limits {
    /// 2 mm, 0.5 degrees, 20 mm/s, 0.4 m/s^2, 5 kN.
    fn default() -> Self {
        Self {
            position: 2e-3,
            rotation: 0.5_f64.to_radians(),
            speed: 0.02,
            acceleration: 0.4,
            angular_speed: 0.02,
            angular_acceleration: 0.4,
            joint_speed: 0.1,
            force: 5e3,
            moment: 2e3,
        }
    }
}

/// A force sensor between the machine and its tool, and the process that it feels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Frame of the sensor, tool from sensor: the reading is about its origin, in its axes.
    pub tool_from_sensor: Pose,
    /// Mass of what hangs beyond the sensor, kg.
    pub mass: f64,
    /// Centre of that mass, sensor axes, m.
    pub centre_of_mass: Vector3<f64>,
    /// Gravity, base axes, m/s^2; given here because a mechanism without own loads has none.
    pub gravity: Vector3<f64>,
    /// Number of cycles over which the sensor is zeroed.
    pub zeroing_cycles: u32,
    /// Cutoff of the low pass, Hz; at most a quarter of the first natural frequency.
    pub cutoff_hz: f64,
    /// Lowest natural frequency of the machine with its tool in the postures of the program, Hz (`kinetostat-dynamics`).
    pub first_frequency_hz: f64,
    /// Largest stiffness with which the process or the part answers a motion of the tool along x, y and z of the base, N/m.
    /// Without it the plan stays in `Shadow`.
    pub process_stiffness: Option<Vector3<f64>>,
}

/// The drives as the sampled loop sees them, for the predicted critical gain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Time constant from command to motion, s.
    pub lag: f64,
    /// Cycles from a measured force to the command that answers it.
    pub delay_cycles: u32,
    /// Damping ratio of the first mode.
    pub damping: f64,
}

/// Everything that a plan is compiled from, besides the mechanism.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlanSettings {
    /// Period of a cycle, s.
    pub period: f64,
    /// Directions to correct, base axes; those that the machine cannot correct are left out and reported.
    pub directions: Directions,
    /// Limits.
    pub limits: Limits,
    /// Largest age of an input, s.
    pub most_age: f64,
    /// Longest time without a usable input before the correction is ramped to zero, s; at most 20 ms.
    pub hold: f64,
    /// Force sensor; without it the programmed force alone is compensated.
    pub sensor: Option<Sensor>,
    /// Probe at arming; without it the port vouches for the correction object.
    pub probe: Option<ProbeSettings>,
    /// Drives; without them no critical gain is predicted.
    pub drive: Option<Drive>,
}

impl PlanSettings {
    /// Positions are corrected, from the programmed force alone, with the default limits and a probe at arming.
    #[must_use]
    pub fn new(period: f64) -> Self {
        Self {
            period,
            directions: Directions::POSITION,
            limits: Limits::default(),
            most_age: 0.012,
            hold: 0.020,
            sensor: None,
            probe: Some(ProbeSettings::default()),
            drive: None,
        }
    }

    /// Refuses what no cycle can work with.
    pub(crate) fn check(&self) -> Result<()> {
        let l = &self.limits;
        let least = f64::MIN_POSITIVE;
        check(&[
            ("the period (s)", self.period, 1e-6, 0.1),
            ("the largest age of an input (s)", self.most_age, least, 1e3),
            ("the longest hold (s)", self.hold, 0.0, 0.020),
            ("the largest correction (m)", l.position, least, 1e3),
            ("the largest rotation (rad)", l.rotation, least, 1e3),
            ("the largest speed (m/s)", l.speed, least, 1e9),
            (
                "the largest acceleration (m/s^2)",
                l.acceleration,
                least,
                1e9,
            ),
            (
                "the largest angular speed (rad/s)",
                l.angular_speed,
                least,
                1e9,
            ),
            (
                "the largest angular acceleration (rad/s^2)",
                l.angular_acceleration,
                least,
                1e9,
            ),
            ("the largest speed of a joint", l.joint_speed, least, 1e9),
            ("the largest force (N)", l.force, least, 1e12),
            ("the largest moment (N m)", l.moment, least, 1e12),
        ])?;
        if let Some(probe) = &self.probe {
            // The sum of its steps stays below 0.25 mm, and each one is within the limit of speed.
            let sum = 0.2e-3 / f64::from(probe.cycles.max(1));
            let most = sum.min(l.speed * self.period) * (1.0 + 1e-9);
            check(&[
                (
                    "the amplitude of the probe (m)",
                    probe.amplitude,
                    1e-7,
                    most,
                ),
                (
                    "the length of the probe's direction",
                    probe.direction.norm(),
                    1e-9,
                    1e9,
                ),
            ])?;
        }
        if let Some(sensor) = &self.sensor {
            sensor.check(self.period)?;
        }
        self.drive.map_or(Ok(()), |drive| {
            check(&[
                ("the lag of the drives (s)", drive.lag, 1e-6, 10.0),
                ("the damping of the first mode", drive.damping, 0.0, 10.0),
            ])
        })
    }
}

impl Sensor {
    fn check(&self, period: f64) -> Result<()> {
        let (f, first) = (self.cutoff_hz, self.first_frequency_hz);
        let frame = self.tool_from_sensor.to_homogeneous();
        let weight = self.centre_of_mass.iter().chain(self.gravity.iter());
        let numbers = frame.iter().chain(weight);
        let numbers = numbers.map(|x| ("a number of the sensor's frame or weight", *x, -1e6, 1e6));
        let process = self.process_stiffness.iter().flat_map(|k| k.iter());
        let process = process.map(|k| ("the process stiffness (N/m)", *k, 0.0, 1e12));
        check(&numbers.chain(process).collect::<Vec<_>>())?;
        check(&[
            ("the first natural frequency (Hz)", first, 1e-3, 1e6),
            ("the cutoff of the low pass (Hz)", f, 1e-3, 0.2 / period),
            ("the mass beyond the sensor (kg)", self.mass, 0.0, 1e6),
        ])?;
        match f > 0.25 * first {
            true => Err(Error::FilterTooFast {
                cutoff_hz: f,
                first_hz: first,
            }),
            false => Ok(()),
        }
    }
}

/// Refuses the first number outside its range.
fn check(numbers: &[(&'static str, f64, f64, f64)]) -> Result<()> {
    let mut wrong = numbers
        .iter()
        .filter(|(_, x, low, high)| !(*low..=*high).contains(x));
    wrong.next().map_or(Ok(()), |&(what, found, low, high)| {
        Err(Error::Setting {
            what,
            found,
            low,
            high,
        })
    })
}
