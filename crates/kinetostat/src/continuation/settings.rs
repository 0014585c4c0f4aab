//! Range and resolution of curves of equilibria.

use std::cmp::Ordering;
use std::f64::consts::PI;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Place, Result};
use crate::settings::{Settings, wrong};

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
