//! Parameter of a curve of equilibria: a displacement of the end, or a pattern of loads.

use nalgebra::Vector6;

use crate::chain::problem::EndCondition;
use crate::model::loads::load::Load;
use crate::spatial::{Twist, Wrench, moved, turn_matrix};

/// Loads that grow together: at factor `f` the chain carries its own loads plus `f` times these.
#[derive(Clone, Debug, Default)]
pub struct LoadPattern {
    /// Wrench on the end, about its origin, base axes (N, N m); only directions in which the end
    /// condition prescribes the wrench.
    pub end: Wrench,
    /// Loads on the nodes at factor 1.
    pub loads: Vec<Load>,
}

impl LoadPattern {
    /// A wrench on the end, and nothing on the nodes.
    #[must_use]
    pub fn on_end(wrench: Wrench) -> Self {
        Self {
            end: wrench,
            loads: Vec::new(),
        }
    }
}

/// Parameter of a curve of equilibria.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let home = Pose::translation(0.4, 0.1, 0.2);
/// let axes = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_6);
/// let aside = Parameter::along(&axes, 1); // the y axis of the turned axes
/// let there = aside.end_at(&EndCondition::pose(home), 0.02); // 20 mm on
/// let gone = there.pose.translation.vector - home.translation.vector;
/// assert!((gone - vector![-0.01, 0.02 * 0.75_f64.sqrt(), 0.0]).norm() < 1e-15);
/// // A load times its factor is added to what acts anyhow.
/// let (weight, cut) = (vector![0.0, 0.0, -30.0], vector![8.0, -2.0, 0.0]); // N
/// let pattern = Parameter::end_wrench(Wrench::new(cut, Vector3::zeros()));
/// let carried = EndCondition::wrench(Wrench::new(weight, Vector3::zeros()));
/// assert_eq!(pattern.end_at(&carried, 2.5).wrench.force(), vector![20.0, -5.0, -30.0]);
/// ```
#[derive(Clone, Debug)]
pub enum Parameter {
    /// The end is moved by `value * twist` from the pose that the problem prescribes: base axes, at
    /// the end's origin, only directions in which the pose is prescribed. With a unit twist the
    /// parameter is in m (rad) and its conjugate, the end's force (moment) along the twist, in N
    /// (N m).
    Displacement(Twist),
    /// A pattern of loads is multiplied by the parameter (a pure number). The conjugate is the
    /// displacement along the pattern since the curve's start: factor times it is work (J).
    Load(LoadPattern),
}

impl Parameter {
    /// Motion of the end along one of the six directions `x y z rx ry rz` of the end condition's
    /// axes, 1 m or 1 rad per unit.
    #[must_use]
    pub fn along(axes: &nalgebra::Rotation3<f64>, direction: usize) -> Self {
        let unit = Vector6::from_fn(|i, _| f64::from(u8::from(i == direction)));
        Self::Displacement(Twist(turn_matrix(axes) * unit))
    }

    /// The end condition at a value of the parameter, from that at 0: the end moved, or loaded.
    #[must_use]
    pub fn end_at(&self, end: &EndCondition, value: f64) -> EndCondition {
        let mut there = end.clone();
        match self {
            Self::Displacement(twist) => there.pose = moved(&end.pose, &Twist(twist.0 * value)),
            Self::Load(pattern) => there.wrench = end.wrench + pattern.end * value,
        }
        there
    }

    /// A wrench on the end, base axes.
    #[must_use]
    pub fn end_wrench(wrench: Wrench) -> Self {
        Self::Load(LoadPattern::on_end(wrench))
    }
}
