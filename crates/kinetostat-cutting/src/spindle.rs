//! Limits of a spindle: torque and power over its speed.
//!
//! Takes the values of the data sheet, at the spindle's nose; returns the limit at a speed, and what a cut exceeds as a
//! finding.

use std::f64::consts::TAU;
use std::fmt;

use crate::error::{CutError, CutErrorKind, Result, within};

/// Maximum number of points of a curve.
const MOST_POINTS: usize = 10_000;

/// Torque of a spindle over its speed.
#[derive(Clone, Debug, PartialEq)]
pub struct SpindleCurve {
    points: Vec<SpindlePoint>,
    /// True if the power between the last two points is constant, not the slope of the torque.
    ends_at_constant_power: bool,
}

impl SpindleCurve {
    /// A curve through points of ascending speed, the torque being linear between them. Below the first point the torque is
    /// that of the first; the last point is at the largest speed.
    ///
    /// ```
    /// use kinetostat_cutting::{SpindleCurve, SpindlePoint};
    ///
    /// let points = [SpindlePoint::of_torque(1000.0, 20.0), SpindlePoint::of_torque(3000.0, 10.0)];
    /// let curve = SpindleCurve::new(&points)?;
    /// assert_eq!(curve.limit_at(500.0).unwrap().torque_n_m, 20.0);
    /// assert_eq!(curve.limit_at(2000.0).unwrap().torque_n_m, 15.0);
    /// assert!((curve.limit_at(2000.0).unwrap().power_w - 3141.59).abs() < 0.01);
    /// assert!(curve.limit_at(3001.0).is_none());
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// No point or more than 10 000, speeds that do not ascend, a speed outside 0 to 1e6 rpm (the last above 0), a torque
    /// outside 0 to 1e6 N m; each names the point, counted from 1.
    pub fn new(points: &[SpindlePoint]) -> Result<Self> {
        let machine = CutErrorKind::Machine;
        within(
            machine,
            "points of the spindle's curve",
            points.len() as f64,
            1.0..=MOST_POINTS as f64,
            "",
        )?;
        let mut before: Option<f64> = None;
        for (index, point) in points.iter().enumerate() {
            let number = index + 1;
            let speed = format!("speed of point {number}");
            let torque = format!("torque of point {number}");
            within(machine, &speed, point.speed_rpm, 0.0..=1e6, "rpm")?;
            within(machine, &torque, point.torque_n_m, 0.0..=1e6, "N m")?;
            if let Some(before) = before.filter(|before| *before >= point.speed_rpm) {
                let expected = format!("more than the {before} rpm of the point before it");
                return Err(CutError::new(
                    machine,
                    speed,
                    format!("{} rpm", point.speed_rpm),
                    expected,
                ));
            }
            before = Some(point.speed_rpm);
        }
        if before == Some(0.0) {
            let expected = "a largest speed above zero";
            return Err(CutError::new(
                machine,
                "speed of the last point",
                "0 rpm",
                expected,
            ));
        }
        Ok(Self {
            points: points.to_vec(),
            ends_at_constant_power: false,
        })
    }

    /// A spindle of constant torque up to its base speed and of constant power from there to its largest speed: rated power
    /// in W, speeds in rpm.
    ///
    /// ```
    /// use kinetostat_cutting::SpindleCurve;
    ///
    /// let curve = SpindleCurve::rated(7500.0, 1500.0, 12_000.0)?;
    /// assert!((curve.limit_at(1000.0).unwrap().torque_n_m - 47.746).abs() < 1e-3);
    /// assert!((curve.limit_at(1000.0).unwrap().power_w - 5000.0).abs() < 1e-9);
    /// assert!((curve.limit_at(6000.0).unwrap().power_w - 7500.0).abs() < 1e-9);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A power outside 0.1 W to 10 MW, a base speed outside 1 to 1e6 rpm, a largest speed below it or above 1e6 rpm.
    pub fn rated(power_w: f64, base_rpm: f64, most_rpm: f64) -> Result<Self> {
        let machine = CutErrorKind::Machine;
        within(machine, "rated power", power_w, 0.1..=1e7, "W")?;
        within(machine, "base speed", base_rpm, 1.0..=1e6, "rpm")?;
        within(machine, "largest speed", most_rpm, base_rpm..=1e6, "rpm")?;
        let mut points = vec![SpindlePoint::of_power(base_rpm, power_w)];
        if most_rpm > base_rpm {
            points.push(SpindlePoint::of_power(most_rpm, power_w));
        }
        let mut curve = Self::new(&points)?;
        curve.ends_at_constant_power = true;
        Ok(curve)
    }

    /// Largest speed, rpm.
    #[must_use]
    pub fn most_rpm(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.speed_rpm)
    }

    /// Limit of the spindle at a speed in rpm; `None` above its largest speed, below zero and for NaN.
    #[must_use]
    pub fn limit_at(&self, speed_rpm: f64) -> Option<SpindleLimit> {
        if !(0.0..=self.most_rpm()).contains(&speed_rpm) {
            return None;
        }
        let above = self
            .points
            .partition_point(|point| point.speed_rpm < speed_rpm);
        let upper = self.points.get(above)?;
        let torque_n_m = match above.checked_sub(1).map(|below| self.points[below]) {
            None => upper.torque_n_m,
            Some(lower) if self.ends_at_constant_power => {
                lower.torque_n_m * lower.speed_rpm / speed_rpm
            }
            Some(lower) => {
                let share = (speed_rpm - lower.speed_rpm) / (upper.speed_rpm - lower.speed_rpm);
                // This form is exact at both points.
                (1.0 - share) * lower.torque_n_m + share * upper.torque_n_m
            }
        };
        Some(SpindleLimit {
            torque_n_m,
            power_w: torque_n_m * turn_rate(speed_rpm),
        })
    }

    /// Limit that a cut of a torque (N mm, as [`crate::DrillForce`] and the forces of milling give it) at a speed (rpm)
    /// exceeds; `None` if the spindle can drive it.
    ///
    /// ```
    /// use kinetostat_cutting::{SpindleCurve, SpindleFinding};
    ///
    /// let curve = SpindleCurve::rated(2200.0, 8000.0, 24_000.0)?;
    /// assert_eq!(curve.exceeded_by(12_000.0, 1500.0), None); // 1.5 N m of 1.75 N m
    /// let finding = curve.exceeded_by(12_000.0, 2000.0).unwrap();
    /// assert!(finding.to_string().starts_with("the cut needs 2.000 N m (2513 W) at 12000 rpm"));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn exceeded_by(&self, speed_rpm: f64, torque_n_mm: f64) -> Option<SpindleFinding> {
        let Some(limit) = self.limit_at(speed_rpm) else {
            let most_rpm = self.most_rpm();
            return Some(SpindleFinding::Speed {
                speed_rpm,
                most_rpm,
            });
        };
        let torque_n_m = 1e-3 * torque_n_mm;
        // A torque that is no number is not one that the spindle gives.
        match torque_n_m <= limit.torque_n_m {
            true => None,
            false => Some(SpindleFinding::Torque {
                speed_rpm,
                torque_n_m,
                limit,
            }),
        }
    }
}

/// A point of a spindle's curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindlePoint {
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// Torque that the spindle gives there, N m.
    pub torque_n_m: f64,
}

impl SpindlePoint {
    /// A point given by its torque, N m.
    #[must_use]
    pub fn of_torque(speed_rpm: f64, torque_n_m: f64) -> Self {
        Self {
            speed_rpm,
            torque_n_m,
        }
    }

    /// A point given by its power, W; its speed must be above zero.
    ///
    /// ```
    /// use kinetostat_cutting::SpindlePoint;
    ///
    /// let point = SpindlePoint::of_power(9549.3, 5000.0);
    /// assert!((point.torque_n_m - 5.0).abs() < 1e-5);
    /// ```
    #[must_use]
    pub fn of_power(speed_rpm: f64, power_w: f64) -> Self {
        Self::of_torque(speed_rpm, power_w / turn_rate(speed_rpm))
    }
}

/// Limit of a spindle at a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleLimit {
    /// Largest torque, N m.
    pub torque_n_m: f64,
    /// Largest power, W.
    pub power_w: f64,
}

/// Limit of a spindle that a cut exceeds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpindleFinding {
    /// A speed above the largest, below zero or no number.
    Speed {
        /// Speed of the cut, rpm.
        speed_rpm: f64,
        /// Largest speed of the spindle, rpm.
        most_rpm: f64,
    },
    /// A torque, and with it a power, that the spindle does not have at this speed: it slows down or stops.
    Torque {
        /// Speed of the cut, rpm.
        speed_rpm: f64,
        /// Torque of the cut, N m.
        torque_n_m: f64,
        /// Available torque and power.
        limit: SpindleLimit,
    },
}

impl fmt::Display for SpindleFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Speed {
                speed_rpm,
                most_rpm,
            } => {
                write!(
                    f,
                    "the cut needs {speed_rpm} rpm, the spindle turns from 0 to {most_rpm} rpm"
                )
            }
            Self::Torque {
                speed_rpm,
                torque_n_m,
                limit,
            } => write!(
                f,
                "the cut needs {torque_n_m:.3} N m ({:.0} W) at {speed_rpm} rpm, the spindle gives {:.3} N m ({:.0} W)",
                torque_n_m * turn_rate(*speed_rpm),
                limit.torque_n_m,
                limit.power_w,
            ),
        }
    }
}

/// rad/s of rpm.
pub(crate) fn turn_rate(rpm: f64) -> f64 {
    TAU * rpm / 60.0
}
