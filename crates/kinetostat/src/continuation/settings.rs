//! Parameter, range and resolution of curves of equilibria.

use std::cmp::Ordering;
use std::f64::consts::PI;

use nalgebra::Vector6;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::problem::EndCondition;
use crate::error::{Place, Result};
use crate::model::loads::load::Load;
use crate::settings::{Settings, wrong};
use crate::spatial::{Twist, Wrench, moved, turn_matrix};

/// Range and resolution of curves.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let settings = CurveSettings::within(0.0, 1.0)
///     .with_range((0.0, 400.0)) // the parameter: here N, as the pattern is 1 N
///     .with_conjugate_range((-2.0, 2.0)) // m
///     .with_largest_angle(1.0) // rad
///     .with_largest_turn(0.05) // rad in one step
///     .with_largest_change(Some(10.0)) // N in one step
///     .with_smallest_step(1e-6)
///     .with_points(60)
///     .with_branches(2)
///     .with_solver(Settings::default());
/// let free = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
/// let start = solve_chain(&free, &Settings::default())?;
/// let push = Parameter::end_wrench(Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros()));
/// let curves = follow(&free, &push, &start, 0.0, &settings)?;
/// assert_eq!(curves.branches.len(), 2, "straight, and buckled from the critical load on");
/// let buckled = curves.branches[1].points.iter();
/// assert!(buckled.flat_map(|point| &point.equilibrium.coordinates).all(|angle| angle.abs() < 1.1));
/// // Two equal bars on equal springs k buckle at (3 - sqrt(5)) / 2 * k / length.
/// let critical = 0.5 * (3.0 - 5.0_f64.sqrt()) * 100.0 / 0.5; // N
/// assert!((curves.specials[0].point.parameter / critical - 1.0).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct CurveSettings {
    /// The parameter stays between these values (m, rad or a factor).
    pub range: (f64, f64),
    /// Range of the conjugate (N, N m or J). Default: no limit.
    pub conjugate_range: (f64, f64),
    /// Joint rotations stay within plus and minus this angle, rad. Default pi.
    pub largest_angle: f64,
    /// Largest rotation of any joint in one step, rad (slides: as a share of the natural length).
    /// Default 0.1.
    pub largest_turn: f64,
    /// Largest change of the parameter in one step. Default: a twentieth of a finite range.
    pub largest_change: Option<f64>,
    /// Smallest step before a branch is given up, as a share of the natural one. Default 1e-7.
    pub smallest_step: f64,
    /// Points of one branch, in each direction. Default 400.
    pub points: usize,
    /// Branches followed at most; 1 is the start's own only. Default 1.
    pub branches: usize,
    /// Tolerances of each point.
    pub solver: Settings,
}

impl CurveSettings {
    /// Defaults for a range of the parameter.
    #[must_use]
    pub fn within(from: f64, to: f64) -> Self {
        Self {
            range: (from.min(to), from.max(to)),
            conjugate_range: (f64::NEG_INFINITY, f64::INFINITY),
            largest_angle: PI,
            largest_turn: 0.1,
            largest_change: None,
            smallest_step: 1e-7,
            points: 400,
            branches: 1,
            solver: Settings::default(),
        }
    }

    /// Refuses what no curve can be followed with, naming it.
    pub(crate) fn check(&self, place: &Place) -> Result<()> {
        for (what, (from, to)) in [
            ("range", self.range),
            ("conjugate_range", self.conjugate_range),
        ] {
            if from.partial_cmp(&to) != Some(Ordering::Less) {
                return Err(wrong(
                    place,
                    what,
                    (from, to),
                    "a smaller and a larger number",
                ));
            }
        }
        let largest_change = self.largest_change.unwrap_or(1.0);
        for (what, value, most, required) in [
            (
                "largest_angle",
                self.largest_angle,
                f64::INFINITY,
                "an angle above 0",
            ),
            (
                "largest_turn",
                self.largest_turn,
                PI,
                "an angle above 0 and up to pi",
            ),
            (
                "largest_change",
                largest_change,
                f64::INFINITY,
                "a number above 0",
            ),
            (
                "smallest_step",
                self.smallest_step,
                1.0,
                "a share above 0 and up to 1",
            ),
        ] {
            if !(value > 0.0 && value <= most) {
                return Err(wrong(place, what, value, required));
            }
        }
        for (what, count) in [("points", self.points), ("branches", self.branches)] {
            if count == 0 {
                return Err(wrong(place, what, 0, "at least 1"));
            }
        }
        self.solver.check(place)
    }
}

crate::settings::setters!(CurveSettings {
    with_range: range: (f64, f64),
    with_conjugate_range: conjugate_range: (f64, f64),
    with_largest_angle: largest_angle: f64,
    with_largest_turn: largest_turn: f64,
    with_largest_change: largest_change: Option<f64>,
    with_smallest_step: smallest_step: f64,
    with_points: points: usize,
    with_branches: branches: usize,
    with_solver: solver: Settings,
});

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
