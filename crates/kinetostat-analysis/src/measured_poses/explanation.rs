//! Candidate explanations for the difference between measured and computed poses: a sign, an offset, a coupling, a frame.

use kinetostat::Pose;
use kinetostat::number::larger;
use kinetostat::spatial::pose_residual;
use nalgebra::{UnitQuaternion, Vector3};

/// A frame that is elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Model's base from the machine's: measured = base * computed.
    Base(Pose),
    /// Tool frame after the model's tool: measured = computed * tool.
    Tool(Pose),
}

/// Forward kinematics: tool pose of the model at controller coordinates (m, rad).
pub type Forward<'a> = dyn Fn(&[f64]) -> Option<Pose> + 'a;

/// An axis of the controller, as the file declares it; m and rad.
#[derive(Clone, Debug)]
pub struct Axis {
    /// True for a revolute axis, false for a prismatic one.
    pub turns: bool,
    /// Controller coordinate while the model's joints are at zero.
    pub zero: f64,
    /// Controller coordinate per unit of the axis' own joint.
    pub ratio: f64,
    /// Axes whose joints it shows too, with what it shows per unit of theirs. Only axes that show
    /// nothing but their own joint.
    pub coupled: Vec<(usize, f64)>,
}

/// Assumed error in the coupling of an axis with another joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coupling {
    /// Undeclared coupling: the other axis' joint has to be added to the controller coordinate, `share` times.
    Missing {
        /// Index of the coupled axis, from 0.
        axis: usize,
        /// Index of the axis whose joint it shows too, from 0.
        other: usize,
        /// Factor of the other joint.
        share: f64,
    },
    /// Declared, and the machine has it with the other sign.
    Reversed {
        /// Index of the coupled axis, from 0.
        axis: usize,
        /// Index of the axis whose joint it shows too, from 0.
        other: usize,
    },
    /// Declared, and the machine has none.
    Absent {
        /// Index of the axis that is declared to be coupled, from 0.
        axis: usize,
        /// Index of the axis whose joint it is declared to show too, from 0.
        other: usize,
    },
}

/// Assumed controller map instead of the declared one: `s x + o`, one axis with a share of another; and a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Explanation {
    /// Axes whose sign is the other one.
    pub reversed: Vec<usize>,
    /// Axis and offset, m or rad.
    pub offsets: Vec<(usize, f64)>,
    /// Assumed error of a coupling; at most one.
    pub coupling: Option<Coupling>,
    /// Constant frame; at most one.
    pub frame: Option<Frame>,
}

impl Explanation {
    /// Returns the coordinates of the controller if the machine were as the file declares it. The machine shows
    /// `x = s a q + k c p + z` for its joint `q` and the coupled joint `p`; the file declares `a q + c p + z`, which is
    /// `s (x - z) + z + (1 - s k) c p`.
    pub(crate) fn applied(&self, joints: &[f64], axes: &[Axis]) -> Vec<f64> {
        let mut out = joints.to_vec();
        for &i in &self.reversed {
            out[i] = 2.0 * axes[i].zero - joints[i];
        }
        for &(i, by) in &self.offsets {
            out[i] += by;
        }
        // Only axes without a coupling of their own are read here: they are done already.
        let joint = |out: &[f64], j: usize| (out[j] - axes[j].zero) / axes[j].ratio;
        for (i, axis) in axes.iter().enumerate() {
            for &(j, ratio) in &axis.coupled {
                let sign = if self.reversed.contains(&i) {
                    -1.0
                } else {
                    1.0
                };
                let has = match self.coupling {
                    Some(Coupling::Reversed { axis, other }) if (axis, other) == (i, j) => -1.0,
                    Some(Coupling::Absent { axis, other }) if (axis, other) == (i, j) => 0.0,
                    _ => 1.0,
                };
                let missing = 1.0 - sign * has;
                if missing != 0.0 {
                    out[i] += missing * ratio * joint(&out, j);
                }
            }
        }
        if let Some(Coupling::Missing { axis, other, share }) = self.coupling {
            out[axis] += share * (out[other] - axes[other].zero);
        }
        out
    }

    /// Fewer and plainer changes first; a fitted number is dearer than a quarter turn.
    pub(crate) fn cost(&self) -> usize {
        let offsets: usize = self
            .offsets
            .iter()
            .map(|o| if quarter(o.1) { 2 } else { 3 })
            .sum();
        2 * self.reversed.len()
            + offsets
            + 2 * usize::from(self.coupling.is_some())
            + 3 * usize::from(self.frame.is_some())
    }
}

/// A whole number of quarter turns.
pub(crate) fn quarter(angle: f64) -> bool {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    (quarters - quarters.round()).abs() < 1e-6
}

/// A pose that was measured: joints as the controller shows them (m, rad) and the tool's place.
#[derive(Clone, Debug)]
pub struct MeasuredPose {
    /// Joints as the controller shows them, m or rad.
    pub joints: Vec<f64>,
    /// Position of the tool in the base, m.
    pub position: Vector3<f64>,
    /// Orientation of the tool in the base, where one was measured.
    pub rotation: Option<UnitQuaternion<f64>>,
}

/// A difference of two poses, m and rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Distance of the positions, m.
    pub distance: f64,
    /// Angle between the orientations, rad; `None` where no orientation was measured.
    pub angle: Option<f64>,
}

impl Difference {
    /// The largest distance and the largest angle of several.
    #[must_use]
    pub fn largest(differences: &[Self]) -> Self {
        let angles = differences.iter().filter_map(|d| d.angle);
        Self {
            distance: differences.iter().map(|d| d.distance).fold(0.0, larger),
            angle: angles.fold(None, |most, a| Some(most.map_or(a, |most| larger(most, a)))),
        }
    }
}

/// Tolerance for equal poses, m and rad.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Largest distance of the positions, m.
    pub distance: f64,
    /// Largest angle between the orientations, rad.
    pub angle: f64,
}

impl Tolerance {
    /// The larger of both differences, 1 at the tolerance.
    pub(crate) fn share(&self, difference: &Difference) -> f64 {
        let angle = difference.angle.unwrap_or(0.0) / self.angle;
        (difference.distance / self.distance).max(angle)
    }
}

/// Distance (m) and angle (rad) from a measured pose to a computed one; no angle where no orientation was measured.
#[must_use]
pub fn difference(measured: &MeasuredPose, computed: &Pose) -> Difference {
    let target = Pose::from_parts(
        measured.position.into(),
        measured.rotation.unwrap_or(computed.rotation),
    );
    let residual = pose_residual(&target, computed);
    Difference {
        distance: residual.linear().norm(),
        angle: measured.rotation.map(|_| residual.angular().norm()),
    }
}
