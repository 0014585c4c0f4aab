//! What can go wrong. `Err` means a wrong input, or an iteration that did not converge; a physical
//! finding (singular, unstable, redundant) is a field of a result.

use crate::number;
use crate::spatial::{MotionKind, Pose, Twist, Wrench};

/// Joint values in the unit that people read; the unit comes once, at the end.
fn in_words<const N: usize>(kind: MotionKind, values: [f64; N]) -> String {
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

/// No equilibrium was found: beyond a limit point there is none on the branch, else one says how
/// far the iteration came.
fn not_converged(
    place: &str,
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
        None => format!(
            "{place}: no equilibrium found in {iterations} iterations (the largest share of the load with an equilibrium: {share:.3}; the last try left a gap of {} m, and torques of {} times the largest without balance)",
            // Below this a gap is the rounding of its arithmetic.
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

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Every variant says where, what was expected and what was found.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A list has the wrong length.
    #[error("{place}: {what} needs {expected} values, {found} were given")]
    Size {
        /// Chain, limb or function.
        place: String,
        /// Which list.
        what: &'static str,
        /// Needed length.
        expected: usize,
        /// Length found.
        found: usize,
    },
    /// A name is unknown.
    #[error("{place}: there is no {what} named '{name}' (there are: {known})")]
    UnknownName {
        /// Chain or mechanism.
        place: String,
        /// Kind of thing: node, limb, platform.
        what: &'static str,
        /// Name asked for.
        name: String,
        /// Names that exist, comma separated.
        known: String,
    },
    /// A description does not make a chain or mechanism.
    #[error("{place}: {reason}")]
    Model {
        /// Chain, joint or spring.
        place: String,
        /// What is wrong and what was expected.
        reason: String,
    },
    /// A number is not finite.
    #[error("{place}: {what} is {value}, a finite number is needed")]
    NotFinite {
        /// Where.
        place: String,
        /// Which quantity.
        what: String,
        /// Value found.
        value: f64,
    },
    /// An iteration did not converge; carries its last state so that it can be looked at.
    #[error("{}", not_converged(place, *iterations, [*residual_position_m, *residual_torque], *load_factor, limit.as_deref()))]
    NotConverged {
        /// Chain or mechanism.
        place: String,
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
        place: String,
        /// Distance of the nearest pose found, m.
        distance_m: f64,
        /// Its angle, rad.
        angle_rad: f64,
        /// Nearest pose found, base axes: of the limb's tip, or of the tool for a mechanism.
        nearest: Box<Pose>,
    },
    /// Loops that do not close with the commands that were given.
    #[error(
        "{place}: its loops do not close with these commands: from home they close up to {:.1} % of the way, then {} are missing",
        100.0 * share, number::apart(gap_m * 1e3, gap_rad.to_degrees())
    )]
    NoClosure {
        /// Mechanism.
        place: String,
        /// Share of the way from home's commands on which the loops close, 0 to 1.
        share: f64,
        /// Largest gap of a limb just behind it, m.
        gap_m: f64,
        /// Its angle, rad.
        gap_rad: f64,
    },
    /// A command lies outside the limits of its actuator.
    #[error("actuator '{actuator}': the command {} is outside its limits {}",
        in_words(*kind, [*command]), in_words(*kind, [*low, *high]))]
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
        place: String,
        /// Which direction.
        reason: String,
        /// The wrench.
        wrench: Box<Wrench>,
    },
}

impl Error {
    pub(crate) fn model(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Model {
            place: place.into(),
            reason: reason.into(),
        }
    }

    /// The same failure, told to be beyond a limit point of the load.
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

/// A limit point on the way from rest to a load: the branch that starts at rest carries no more,
/// and a dead load beyond it makes the machine snap to another equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadLimit {
    /// Share of the load that is carried, 0 to 1.
    pub share: f64,
    /// Displacement of the tool there, from the nominal target (m, rad).
    pub displacement: Twist,
}
