//! The tool's axis on a great circle, by rotary axes.
//!
//! Where a program states directions of the tool, many controllers turn it from one to the next in the plane of both (ORIVECT of
//! SINUMERIK, tool posture control of Fanuc, PATHCTRL VECTOR of Heidenhain; what postprocessors of APT divide for). The rotary axes then
//! do not turn evenly, and near a pole fast. Their angles are followed along the circle once, in small steps, and are found from the
//! direction wherever they are asked for.

use nalgebra::{UnitQuaternion, Vector3};

use crate::path::rotary::RotaryAxes;
use crate::path::rotary_angles::{Pointing, Unreached};

/// Angle of the circle from one step to the next, deg.
const STEP_DEG: f64 = 0.5;

/// Directions as opposite as this have no circle of their own.
const OPPOSITE: f64 = 1e-6;

/// The way of the tool's axis from one direction to another one in their plane, evenly with the share, with the angles on it.
#[derive(Debug, Clone, PartialEq)]
pub struct GreatCircle {
    from: Vector3<f64>,
    /// Rotation vector to the other direction.
    turn: Vector3<f64>,
    /// Where the axes stand at even shares, deg.
    guides: Vec<Vec<f64>>,
}

/// Why the tool's axis cannot go on a great circle.
#[derive(Debug, Clone, PartialEq)]
pub enum OffCircle {
    /// The directions are opposite: over which side it goes is open.
    Opposite,
    /// At a direction on the way the axes do not reach it.
    Unreached(Vector3<f64>, Unreached),
}

impl GreatCircle {
    /// From the angles at which the axes stand to a direction, a unit vector from the tip to the holder in axes of the part. Where the
    /// tool begins along an axis (at the pole), that axis is turned at once to where the way leads.
    ///
    /// ```
    /// use kinetostat_program::{Carries, GreatCircle, RotaryAxes, RotaryAxis};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let head = |letter, direction| RotaryAxis {
    ///     letter,
    ///     carries: Carries::Tool,
    ///     direction,
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: None,
    /// };
    /// let axes = vec![head('C', Vector3::z_axis()), head('B', Vector3::y_axis())];
    /// let axes = RotaryAxes { axes, tool_at_zero: UnitQuaternion::identity() };
    /// // From 30 degrees towards x to 30 degrees towards y.
    /// let half = 0.75_f64.sqrt();
    /// let circle = GreatCircle::new(&axes, &[0.0, 30.0], &Vector3::new(0.0, 0.5, half)).unwrap();
    /// let [c, b] = circle.angles_at(&axes, 0.5)[..] else { unreachable!() };
    /// // Halfway the tool is steeper: tan b = tan 30 / sqrt 2, where B and C turning evenly had 30 degrees.
    /// assert!((c - 45.0).abs() < 1e-9);
    /// assert!((b.to_radians().tan() - 30_f64.to_radians().tan() / 2_f64.sqrt()).abs() < 1e-9);
    /// assert!((circle.direction_at(0.5) - Vector3::new(0.25, 0.25, half) / (0.875_f64).sqrt()).norm() < 1e-12);
    /// assert!(circle.start_deg()[0].abs() < 1e-9 && (circle.end_deg()[0] - 90.0).abs() < 1e-9);
    /// assert!(circle.way_deg()[0] > 89.0 && circle.fastest_deg()[0] < 120.0);
    /// ```
    ///
    /// # Errors
    /// Where there is no such way, or the axes cannot follow it within their limits.
    pub fn new(axes: &RotaryAxes, from_deg: &[f64], to: &Vector3<f64>) -> Result<Self, OffCircle> {
        let from = axes.tool_direction_at(from_deg, &(axes.tool_at_zero.inverse() * Vector3::z()));
        if (from + to).norm() < OPPOSITE {
            return Err(OffCircle::Opposite);
        }
        // An end that is not reached says more than a place on the way to it.
        let end = (axes.angles_towards(to, from_deg))
            .map_err(|reason| OffCircle::Unreached(*to, reason))?;
        let across = from.cross(to);
        let (sine, cosine) = (across.norm(), from.dot(to));
        let turn = across
            .try_normalize(0.0)
            .map_or_else(Vector3::zeros, |axis| axis * sine.atan2(cosine));
        let steps = (turn.norm().to_degrees() / STEP_DEG).ceil();
        let steps = crate::number::larger(1.0, steps) as usize;
        let mut circle = Self {
            from,
            turn,
            guides: vec![from_deg.to_vec()],
        };
        for step in 1..=steps {
            let direction = match step == steps {
                true => *to,
                false => circle.direction_at(step as f64 / steps as f64),
            };
            let off = |reason| OffCircle::Unreached(direction, reason);
            // From a pole the way leads to the angles of its end. Elsewhere the axes go on as they came: over to other angles they would
            // take the tool off its way.
            let begins_free = step == 1 && at_pole(&axes.pointing(&from, from_deg));
            let near = match begins_free {
                true => &end,
                false => &circle.guides[step - 1],
            };
            let Some(angles) = nearest(axes.pointing(&direction, near)) else {
                return Err(off(Unreached::Direction));
            };
            if axes.angle_outside(&angles).is_some() {
                return Err(off(Unreached::Limits(angles)));
            }
            circle.guides.push(angles);
            if begins_free {
                let first = circle.guides[1].clone();
                let begun = axes.angles_towards(&from, &first);
                circle.guides[0] = begun.unwrap_or(first);
            }
        }
        Ok(circle)
    }

    /// Direction of the tool at a share, from its tip to its holder, axes of the part.
    #[must_use]
    pub fn direction_at(&self, share: f64) -> Vector3<f64> {
        UnitQuaternion::from_scaled_axis(self.turn * share) * self.from
    }

    /// Where the axes stand at a share of the way, deg.
    #[must_use]
    pub fn angles_at(&self, axes: &RotaryAxes, share: f64) -> Vec<f64> {
        let last = self.guides.len() - 1;
        let place = share.clamp(0.0, 1.0) * last as f64;
        let below = (place.floor() as usize).min(last.saturating_sub(1));
        let part = place - below as f64;
        let both = self.guides[below].iter().zip(&self.guides[below + 1]);
        let between: Vec<f64> = both.map(|(a, b)| a + (b - a) * part).collect();
        if part == 0.0 {
            return self.guides[below].clone();
        }
        nearest(axes.pointing(&self.direction_at(share), &between)).unwrap_or(between)
    }

    /// Where the axes stand at the beginning, deg.
    #[must_use]
    pub fn start_deg(&self) -> &[f64] {
        &self.guides[0]
    }

    /// Where the axes stand at the end, deg.
    #[must_use]
    pub fn end_deg(&self) -> &[f64] {
        &self.guides[self.guides.len() - 1]
    }

    /// How far each axis turns on the way, back and forth, deg.
    #[must_use]
    pub fn way_deg(&self) -> Vec<f64> {
        let mut ways = vec![0.0; self.guides[0].len()];
        for pair in self.guides.windows(2) {
            for (way, (a, b)) in ways.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
                *way += (b - a).abs();
            }
        }
        ways
    }

    /// How far each axis would turn if it went on throughout as fast as where it is fastest, deg.
    #[must_use]
    pub fn fastest_deg(&self) -> Vec<f64> {
        let mut ways = vec![0.0; self.guides[0].len()];
        for pair in self.guides.windows(2) {
            for (way, (a, b)) in ways.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
                *way = crate::number::larger(*way, (b - a).abs());
            }
        }
        let steps = (self.guides.len() - 1) as f64;
        ways.into_iter().map(|way| way * steps).collect()
    }
}

/// Whether an axis may stand anywhere.
fn at_pole(pointing: &[Pointing]) -> bool {
    pointing.iter().any(|found| found.free.contains(&true))
}

fn nearest(found: Vec<Pointing>) -> Option<Vec<f64>> {
    let best = found.into_iter().min_by(|a, b| a.way.total_cmp(&b.way));
    best.map(|pointing| pointing.angles_deg)
}
