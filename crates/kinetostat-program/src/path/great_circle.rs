//! The tool's axis on a great circle, by rotary axes.
//!
//! If a program states directions of the tool, many controllers turn it from one to the next in the plane of both (ORIVECT of SINUMERIK,
//! tool posture control of Fanuc, PATHCTRL VECTOR of Heidenhain; what postprocessors of APT divide for). The rotary axes then do not
//! turn evenly, and near a pole fast. Their angles are followed along the circle once, in steps that are the smaller the nearer the tool
//! comes to a pole, and are found from the direction wherever they are asked for.

use nalgebra::{UnitQuaternion, Vector3};

use crate::number::{larger, smaller};
use crate::path::rotary::RotaryAxes;
use crate::path::rotary_angles::{Pointing, Unreached};

/// Largest angle of the circle from one step to the next, deg.
const STEP_DEG: f64 = 0.5;

/// Angle of the circle in a step over the area that the turns of the axes span there: so far, in rad, an axis turns in the step. Both ways
/// to a direction are half a turn apart, and are told apart by far smaller turns.
const TURN_IN_STEP: f64 = 0.2;

/// Smallest angle of the circle in a step, rad: a tool that passes a pole nearer goes through it.
const FINEST: f64 = 1e-6;

/// Maximum number of steps of one way that are refined: the way of a tool passes few poles.
const MOST_STEPS: usize = 20_000;

/// Directions as opposite as this have no circle of their own.
const OPPOSITE: f64 = 1e-6;

/// The way of the tool's axis from one direction to another one in their plane, evenly with the share, with the angles on it.
#[derive(Debug, Clone, PartialEq)]
pub struct GreatCircle {
    from: Vector3<f64>,
    /// Rotation vector to the other direction.
    turn: Vector3<f64>,
    /// Angles of the axes, from the first share to the last.
    guides: Vec<Guide>,
}

/// Angles of the axes at a share of the way.
#[derive(Debug, Clone, PartialEq)]
struct Guide {
    share: f64,
    angles_deg: Vec<f64>,
}

/// Reason for which the tool's axis cannot go on a great circle.
#[derive(Debug, Clone, PartialEq)]
pub enum OffCircle {
    /// The directions are opposite: over which side it goes is open.
    Opposite,
    /// The axes do not reach a direction on the way.
    Unreached(Vector3<f64>, Unreached),
}

impl GreatCircle {
    /// Great circle from the angles of the axes to a direction, a unit vector from the tip to the holder in axes of the part. If
    /// the tool begins along an axis (at the pole), that axis is turned at once to where the way leads.
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
    /// assert!(circle.way_deg()[0] > 89.0 && circle.fastest_deg([0.0, 1.0])[0] < 120.0);
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
        let sweep = turn.norm();
        let mut circle = Self {
            from,
            turn,
            guides: vec![Guide {
                share: 0.0,
                angles_deg: from_deg.to_vec(),
            }],
        };
        let (mut share, mut last) = (0.0, from_deg.to_vec());
        while share < 1.0 {
            let fine = match circle.guides.len() < MOST_STEPS {
                true => TURN_IN_STEP * axes.area_of_turns(&last),
                false => f64::INFINITY,
            };
            let way = smaller(larger(fine, FINEST), STEP_DEG.to_radians());
            let is_last = (1.0 - share) * sweep <= way;
            share = if is_last { 1.0 } else { share + way / sweep };
            let direction = match is_last {
                true => *to,
                false => circle.direction_at(share),
            };
            let off = |reason| OffCircle::Unreached(direction, reason);
            // From a pole the way leads to the angles of its end. Elsewhere the axes go on as they came: over to other angles they would
            // take the tool off its way.
            let begins_free = circle.guides.len() == 1 && at_pole(&axes.pointing(&from, from_deg));
            let near = match begins_free {
                true => &end,
                false => &last,
            };
            let Some(angles) = nearest(axes.pointing(&direction, near)) else {
                return Err(off(Unreached::Direction));
            };
            if axes.angle_outside(&angles).is_some() {
                return Err(off(Unreached::Limits(angles)));
            }
            if begins_free {
                let begun = axes.angles_towards(&from, &angles);
                circle.guides[0].angles_deg = begun.unwrap_or_else(|_| angles.clone());
            }
            last.clone_from(&angles);
            circle.guides.push(Guide {
                share,
                angles_deg: angles,
            });
        }
        Ok(circle)
    }

    /// Direction of the tool at a share, from its tip to its holder, axes of the part.
    #[must_use]
    pub fn direction_at(&self, share: f64) -> Vector3<f64> {
        UnitQuaternion::from_scaled_axis(self.turn * share) * self.from
    }

    /// Angles of the axes at a share of the way, deg.
    #[must_use]
    pub fn angles_at(&self, axes: &RotaryAxes, share: f64) -> Vec<f64> {
        let behind = self.guides.partition_point(|guide| guide.share <= share);
        let behind = behind.clamp(1, self.guides.len() - 1);
        let [below, above] = [&self.guides[behind - 1], &self.guides[behind]];
        let part = ((share - below.share) / (above.share - below.share)).clamp(0.0, 1.0);
        if part == 0.0 {
            return below.angles_deg.clone();
        }
        let both = below.angles_deg.iter().zip(&above.angles_deg);
        let between: Vec<f64> = both.map(|(a, b)| a + (b - a) * part).collect();
        nearest(axes.pointing(&self.direction_at(share), &between)).unwrap_or(between)
    }

    /// Angles of the axes at the beginning, deg.
    #[must_use]
    pub fn start_deg(&self) -> &[f64] {
        &self.guides[0].angles_deg
    }

    /// Angles of the axes at the end, deg.
    #[must_use]
    pub fn end_deg(&self) -> &[f64] {
        &self.guides[self.guides.len() - 1].angles_deg
    }

    /// Travel of each axis on the way, back and forth, deg.
    #[must_use]
    pub fn way_deg(&self) -> Vec<f64> {
        let mut ways = vec![0.0; self.start_deg().len()];
        for pair in self.guides.windows(2) {
            for (way, turned) in ways.iter_mut().zip(turned(pair)) {
                *way += turned;
            }
        }
        ways
    }

    /// Travel of each axis on the whole way at its largest rate between two shares, deg.
    #[must_use]
    pub fn fastest_deg(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let mut ways = vec![0.0; self.start_deg().len()];
        let first = self.guides.partition_point(|guide| guide.share <= from);
        let last = self.guides.partition_point(|guide| guide.share < to);
        let within = first.saturating_sub(1)..=last.min(self.guides.len() - 1);
        for pair in self.guides[within].windows(2) {
            let width = pair[1].share - pair[0].share;
            for (way, turned) in ways.iter_mut().zip(turned(pair)) {
                *way = larger(*way, turned / width);
            }
        }
        ways
    }
}

/// Travel of each axis between two guides, deg.
fn turned(pair: &[Guide]) -> impl Iterator<Item = f64> {
    let both = pair[0].angles_deg.iter().zip(&pair[1].angles_deg);
    both.map(|(a, b)| (b - a).abs())
}

/// True if an axis may have any angle.
fn at_pole(pointing: &[Pointing]) -> bool {
    pointing.iter().any(|found| found.free.contains(&true))
}

fn nearest(found: Vec<Pointing>) -> Option<Vec<f64>> {
    let best = found.into_iter().min_by(|a, b| a.way.total_cmp(&b.way));
    best.map(|pointing| pointing.angles_deg)
}
