//! Distance of a posture from a singular one, for people: distance and direction of the tool's motion, and the motion
//! lost or gained there [R 5.5.3].

use kinetostat::{
    Mechanism, Posture, Twist,
    machine::{NearSingularity, SingularityKind},
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::warning::{Warning, WarningCode};

/// Singular postures are reported when they are closer than this share of the machine's natural length
/// (the mean over its limbs); a rotation counts at that length, so for every machine it is 2.9
/// degrees of tool rotation.
///
/// Within it a singular value of the joint axes changes by as much as it measures, so a figure at
/// the posture says little about its surroundings. Wrists of arms are held farther away than that
/// by their controllers.
pub const NEAR_SINGULAR: f64 = 0.05;

/// A singular posture near the one that was requested.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct NearSingular {
    /// Passive joints let go (a motion gained), or joints cannot follow (a motion lost).
    pub kind: NearKind,
    /// Limb that loses the motion.
    pub limb: Option<String>,
    /// Distance that the tool's reference point moves to the singular posture, mm; zero if it is singular.
    pub distance_mm: f64,
    /// Angle by which the tool turns on the way, deg.
    pub rotation_deg: f64,
    /// Motion of the tool's reference point to the singular posture, base axes, mm.
    pub motion_mm: [f64; 3],
    /// Rotation vector of the tool on the way, base axes, deg.
    pub rotation_vector_deg: [f64; 3],
    /// The way was followed until the machine is singular; if not, the distance is a first-order
    /// estimate.
    pub followed: bool,
    /// All of it in a sentence.
    pub in_words: String,
}

impl NearSingular {
    /// A warning of the code [`WarningCode::NearSingular`] that says what `in_words` says.
    #[must_use]
    pub fn warning(&self) -> Warning {
        Warning::new(WarningCode::NearSingular, self.in_words.clone())
    }
}

/// Kind of a singular posture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NearKind {
    /// A motion that neither actuators nor limbs hold.
    Gained,
    /// A motion that a limb cannot make.
    Lost,
}

/// Natural length of a machine, m: the mean over its limbs.
#[must_use]
pub fn natural_length(mechanism: &Mechanism) -> f64 {
    mechanism.natural_length()
}

/// The nearest singular posture, if it is closer than [`NEAR_SINGULAR`].
#[must_use]
pub fn near_singular(posture: &Posture) -> Option<NearSingular> {
    let length = natural_length(posture.mechanism());
    let list = posture.near_singularities(NEAR_SINGULAR * length).ok()?;
    // A first-order distance that following corrected upwards may be far.
    let near = list
        .iter()
        .find(|n| n.distance_m <= NEAR_SINGULAR * length)?;
    Some(described(near, length))
}

fn described(near: &NearSingularity, length: f64) -> NearSingular {
    let motion = near.towards.linear() * (1e3 * near.distance_m);
    let turn = near.towards.angular().map(f64::to_degrees) * near.distance_m;
    let (kind, there) = match (near.kind, &near.limb) {
        (SingularityKind::Lost, Some(limb)) => (
            NearKind::Lost,
            format!(
                "there the joints of limb '{limb}' cannot {}: joints must move far for little, and figures change quickly around here",
                motion_of(&near.motion, length)
            ),
        ),
        _ if near.motion.0.norm() == 0.0 => (
            NearKind::Gained,
            "there platforms between base and tool are not held by anything: stiffness falls quickly towards it".to_owned(),
        ),
        _ => (
            NearKind::Gained,
            format!(
                "there no actuator and no limb holds the tool where it could {}: stiffness falls to zero towards it",
                motion_of(&near.motion, length)
            ),
        ),
    };
    let in_words = if near.distance_m == 0.0 {
        format!(
            "this posture is singular: {}",
            there.trim_start_matches("there ")
        )
    } else {
        let mut motions = Vec::new();
        let mut far = Vec::new();
        if motion.norm() > 1e-2 * 1e3 * near.distance_m {
            far.push(format!("{} mm", digits(motion.norm())));
            motions.push(format!("moves along {}", axis(&motion)));
        }
        if turn.norm().to_radians() * length > 1e-2 * near.distance_m {
            far.push(format!("{} deg", digits(turn.norm())));
            motions.push(format!("turns about {}", axis(&turn)));
        }
        format!(
            "a singular posture is near{}: {} of tool motion away, if the tool {}; {there}",
            if near.followed { "" } else { " (estimated)" },
            far.join(" and "),
            motions.join(" and "),
        )
    };
    NearSingular {
        kind,
        limb: near.limb.clone(),
        distance_mm: motion.norm(),
        rotation_deg: turn.norm(),
        motion_mm: motion.into(),
        rotation_vector_deg: turn.into(),
        followed: near.followed,
        in_words,
    }
}

/// Three digits, no more than four decimals.
fn digits(value: f64) -> String {
    if value.abs() < 1e-4 {
        return "less than 0.0001".to_owned();
    }
    let decimals = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 4);
    format!("{value:.*}", decimals as usize)
}

/// `x`, `-z`, or three components.
fn axis(v: &Vector3<f64>) -> String {
    let unit = v.normalize();
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        if unit[k].abs() > 0.999 {
            return format!("{}{name}", if unit[k] < 0.0 { "-" } else { "" });
        }
    }
    let clean = unit.map(|x| if x.abs() < 5e-3 { 0.0 } else { x });
    format!("({:.2}, {:.2}, {:.2})", clean.x, clean.y, clean.z)
}

/// A motion of the tool as what it does: `turn about z`, `move along x`.
fn motion_of(motion: &Twist, length: f64) -> String {
    let (linear, angular) = (motion.linear(), motion.angular());
    // Turning about an axis that far away is moving.
    if 2.0 * angular.norm() * length < linear.norm() {
        return format!("move along {}", axis(&linear));
    }
    let unit = angular.normalize();
    let arm = unit.cross(&linear).norm() / angular.norm();
    if arm < 1e-3 * length {
        format!("turn about {}", axis(&angular))
    } else {
        format!(
            "turn about {} on an axis {:.0} mm from its reference point",
            axis(&angular),
            1e3 * arm
        )
    }
}
