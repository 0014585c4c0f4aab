//! Errors of this crate. `Err` means a wrong input, or an iteration that did not converge; a physical finding
//! (singular, unstable, redundant) is a field of a result.
//!
//! Independent of the other modules. Provides one `Error`, with the place (`place`: mechanism, chain or limb and the
//! part at fault) as types that a program can match, and the sentences for people.

mod place;

use crate::number;
use crate::spatial::{MotionKind, Pose, Twist, Wrench};

pub(crate) use place::SHAPE_CRITERION;
pub use place::{Part, Place, Whole};

/// A limit point on the way from rest to a load: the branch that starts at rest carries no more,
/// and a dead load beyond it makes the machine snap to another equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LoadLimit {
    /// Share of the load that is carried, 0 to 1.
    pub share: f64,
    /// Displacement of the tool there, from the nominal target (m, rad).
    pub displacement: Twist,
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Every variant says where, what was expected and what was found.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// # let chain = Chain::builder("gantry")
/// #     .actuator("x", slide(Vector3::x()))
/// #     .actuator("y", slide(Vector3::y()))
/// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
/// #     .build()?;
/// # let home = Pose::translation(0.4, 0.0, 0.0);
/// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
/// let high = Pose::translation(0.5, 0.2, 0.1); // two slides move it in a plane
/// let error = gantry.posture(&high).unwrap_err();
/// assert!(error.is_unanswered(), "the question is fine, the machine does not go there");
/// let Error::Unreachable { distance_m, .. } = &error else { panic!("{error}") };
/// assert!((distance_m - 0.1).abs() < 1e-9, "0.1 m below is the plane that it can reach");
///
/// let mistyped = gantry.limb_named("gantri").unwrap_err();
/// assert!(!mistyped.is_unanswered());
/// let place = mistyped.place().expect("an unknown name has a place");
/// assert_eq!(place.to_string(), "mechanism 'gantry'");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A list has the wrong length.
    #[error("{place}: {what} needs {expected} values, {found} were given")]
    Size {
        /// Chain, limb or function.
        place: Place,
        /// Name of the list.
        what: &'static str,
        /// Needed length.
        expected: usize,
        /// Length found.
        found: usize,
    },
    /// No node, limb, platform or other thing has the name that was requested.
    #[error("{place}: there is no {what} named '{name}' (there are: {known})")]
    UnknownName {
        /// Chain or mechanism.
        place: Place,
        /// Kind of thing: node, limb, platform.
        what: &'static str,
        /// Name requested.
        name: String,
        /// Names that exist, comma separated.
        known: String,
    },
    /// A description does not make a chain or mechanism.
    #[error("{place}: {reason}")]
    Model {
        /// Chain, joint or spring.
        place: Place,
        /// Description of the fault and of what was expected.
        reason: String,
    },
    /// A number is not finite.
    #[error("{place}: {what} is {value}, a finite number is needed")]
    NotFinite {
        /// Place of the number.
        place: Place,
        /// Name of the quantity.
        what: String,
        /// Value found.
        value: f64,
    },
    /// An iteration did not converge; carries its last state so that it can be looked at.
    #[error("{}", not_converged(place, *iterations, [*residual_position_m, *residual_torque], *load_factor, limit.as_deref()))]
    NotConverged {
        /// Chain or mechanism.
        place: Place,
        /// Iterations spent.
        iterations: usize,
        /// Closure left over, m.
        residual_position_m: f64,
        /// Equilibrium residual, relative to the loads.
        residual_torque: f64,
        /// Largest share of the load for which an equilibrium was found.
        load_factor: f64,
        /// Last iterate of all coordinates.
        last: Vec<f64>,
        /// The limit point of the load at which the branch from rest ends, if there is one.
        limit: Option<Box<LoadLimit>>,
    },
    /// The actuators cannot bring the end there.
    #[error("{place}: the target cannot be reached; {}", nearest_found(*distance_m, *angle_rad, nearest))]
    Unreachable {
        /// Limb or mechanism.
        place: Place,
        /// Distance of the nearest pose found, m.
        distance_m: f64,
        /// Angle between the nearest pose found and the target, rad.
        angle_rad: f64,
        /// Nearest pose found, base axes: of the limb's tip, or of the tool for a mechanism.
        nearest: Box<Pose>,
    },
    /// Loops that do not close with the commands that were given.
    #[error(
        "{place}: its loops do not close with these commands: from home they close up to {:.1} % of the way, then {} are missing",
        100.0 * share, crate::number::apart(gap_m * 1e3, gap_rad.to_degrees())
    )]
    NoClosure {
        /// Mechanism.
        place: Place,
        /// Share of the way from home's commands on which the loops close, 0 to 1.
        share: f64,
        /// Largest closure residual of a limb just beyond that share, m.
        gap_m: f64,
        /// Angle of the gap, rad.
        gap_rad: f64,
    },
    /// A command lies outside the limits of its actuator.
    #[error("actuator '{actuator}': the command {} is outside its limits {}",
        joint_values(*kind, [*command]), joint_values(*kind, [*low, *high]))]
    OutsideLimits {
        /// Name of the actuator.
        actuator: String,
        /// Slide or rotation.
        kind: MotionKind,
        /// Command needed, m or rad.
        command: f64,
        /// Lower limit.
        low: f64,
        /// Upper limit.
        high: f64,
    },
    /// The platform is free to move under this wrench: no position is an equilibrium.
    #[error(
        "{place}: the wrench pushes in a free direction, so the platform has no equilibrium ({reason})"
    )]
    FreeDirection {
        /// Mechanism.
        place: Place,
        /// Description of the direction.
        reason: String,
        /// Wrench that pushes there, N and N m.
        wrench: Box<Wrench>,
    },
}

impl Error {
    pub(crate) fn model(place: impl Into<Place>, reason: impl Into<String>) -> Self {
        Self::Model {
            place: place.into(),
            reason: reason.into(),
        }
    }

    /// Reports the failure as one beyond a limit point of the load.
    pub(crate) fn at_limit(mut self, found: LoadLimit) -> Self {
        if let Self::NotConverged {
            load_factor, limit, ..
        } = &mut self
        {
            *load_factor = found.share;
            *limit = Some(Box::new(found));
        }
        self
    }

    /// Place of the fault; `None` for an actuator's limits, which name the actuator.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Size { place, .. }
            | Self::UnknownName { place, .. }
            | Self::Model { place, .. }
            | Self::NotFinite { place, .. }
            | Self::NotConverged { place, .. }
            | Self::Unreachable { place, .. }
            | Self::NoClosure { place, .. }
            | Self::FreeDirection { place, .. } => Some(place),
            Self::OutsideLimits { .. } => None,
        }
    }

    /// The variants that mean "could not be answered" rather than "wrong input".
    #[must_use]
    pub fn is_unanswered(&self) -> bool {
        matches!(
            self,
            Self::NotConverged { .. }
                | Self::Unreachable { .. }
                | Self::NoClosure { .. }
                | Self::OutsideLimits { .. }
                | Self::FreeDirection { .. }
        )
    }
}

/// Joint values in the unit that people read; the unit comes once, at the end.
fn joint_values<const N: usize>(kind: MotionKind, values: [f64; N]) -> String {
    let (factor, unit) = match kind {
        MotionKind::Prismatic => (1e3, "mm"),
        MotionKind::Revolute => (1_f64.to_degrees(), "deg"),
    };
    let number = |value: &f64| {
        let text = number::fixed(value * factor, 4);
        number::without_zeros(&text).to_owned()
    };
    let numbers: Vec<String> = values.iter().map(number).collect();
    format!("{} {unit}", numbers.join(" .. "))
}

/// Error without an equilibrium: beyond a limit point there is none on the branch, else it tells how far the iteration
/// came.
fn not_converged(
    place: &Place,
    iterations: usize,
    [closure, torque]: [f64; 2],
    share: f64,
    limit: Option<&LoadLimit>,
) -> String {
    match limit {
        Some(limit) => {
            // Rounded before it is printed, so that there is no minus zero.
            let d = limit
                .displacement
                .linear()
                .map(|x| (x * 1e7).round() * 1e-4 + 0.0);
            let share = number::setting(limit.share);
            format!(
                "{place}: from rest it carries only {share} of this load: a limit point of the load lies at the displacement [{:.4} {:.4} {:.4}] mm, and there it snaps to another equilibrium",
                d.x, d.y, d.z
            )
        }
        None if !(closure.is_finite() && torque.is_finite()) => format!(
            "{place}: no equilibrium found in {iterations} iterations: with these numbers the deflections grow beyond all limits; the largest share of the load with an equilibrium is {share:.3}. Look for a load, a length or a stiffness in the wrong unit"
        ),
        None if share > 0.999 => format!(
            "{place}: equilibria were found up to the whole load, and still the iteration did not converge in {iterations} steps: a limit of the load is near, or the correction is too large"
        ),
        None => format!(
            "{place}: no equilibrium found in {iterations} iterations (the largest share of the load with an equilibrium: {share:.3}; the last try left a closure of {} m, and torques of {} times the largest out of equilibrium)",
            // A smaller residual is the rounding of its arithmetic.
            number::short(if closure < 1e-12 { 0.0 } else { closure }),
            number::short(torque)
        ),
    }
}

fn nearest_found(distance_m: f64, angle_rad: f64, nearest: &Pose) -> String {
    if !(distance_m.is_finite() && angle_rad.is_finite()) {
        return "no pose near it was found: look for a length in the wrong unit".to_owned();
    }
    let [x, y, z]: [f64; 3] = (nearest.translation.vector * 1e3).into();
    let shown = |x: f64| number::fixed(x, 3);
    format!(
        "the nearest pose found is {} away, at ({}, {}, {}) mm in base axes",
        number::apart(distance_m * 1e3, angle_rad.to_degrees()),
        shown(x),
        shown(y),
        shown(z)
    )
}
