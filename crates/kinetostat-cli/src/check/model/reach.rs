//! Reach of the tool as reported by `check`.

use kinetostat::Posture;
use kinetostat_analysis::reach::{ArmReach, Reach, ReachAlongAxes, ReachError, reach};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::layout::item;
use crate::ui::numbers::{number, short, triple};

/// Reach of a machine.
#[derive(Default, Serialize, JsonSchema)]
pub(crate) struct ReachFinding {
    /// Farthest the tool's reference point gets from the base's origin, mm: of an arm, and of a machine
    /// that moves only while its tool turns.
    pub(crate) from_base_mm: Option<f64>,
    /// Largest distance from the first axis, for an arm whose first actuator is revolute, mm.
    pub(crate) from_first_axis_mm: Option<f64>,
    /// The tool turns on these ways as the machine turns it, kept as near to its orientation at home as can be.
    pub(crate) orientation_follows: bool,
    /// Else: how far it gets from home along -x, +x, -y, +y, -z, +z of the base, mm; the tool does not turn
    /// where the machine can move it so.
    pub(crate) along_axes_mm: Option<[[f64; 2]; 3]>,
    /// Cause of the ends of these ways: an actuator at its limit, or the limbs themselves.
    pub(crate) ends: Option<[[String; 2]; 3]>,
    /// A box around home of which corners, edges and faces were reached, mm.
    pub(crate) box_mm: Option<[[f64; 3]; 2]>,
    /// Smallest and largest coordinates of the tool's reference point if it moves only while the tool turns, mm.
    pub(crate) positions_span_mm: Option<[[f64; 3]; 2]>,
    /// Method by which all this was found.
    pub(crate) how: String,
}

impl From<Result<Reach, ReachError>> for ReachFinding {
    fn from(found: Result<Reach, ReachError>) -> Self {
        match found {
            Ok(Reach::Arm(arm)) => of_arm(&arm),
            Ok(Reach::AlongAxes(reach)) => along_axes(&reach),
            Err(error) => Self {
                how: match error {
                    ReachError::NoLimits => format!("{error}; write limits_mm or limits_deg"),
                    _ => error.to_string(),
                },
                ..Self::default()
            },
        }
    }
}

/// Reach of a machine from its posture at home.
pub(crate) fn reach_from(home: &Posture) -> ReachFinding {
    reach(home).into()
}

fn of_arm(arm: &ArmReach) -> ReachFinding {
    ReachFinding {
        from_base_mm: Some(1e3 * arm.from_base),
        from_first_axis_mm: arm.from_first_axis.map(|r| 1e3 * r),
        how: format!(
            "the largest distance found by a search over the ranges of {}, from {} start{}; collisions are not looked at",
            if arm.with_passive_joints {
                "all joints, the passive ones too"
            } else {
                "its actuators"
            },
            arm.starts,
            if arm.starts == 1 { "" } else { "s" }
        ),
        ..ReachFinding::default()
    }
}

fn along_axes(reach: &ReachAlongAxes) -> ReachFinding {
    let mm = |v: Vector3<f64>| <[f64; 3]>::from(v * 1e3);
    ReachFinding {
        from_base_mm: reach.by_commands.map(|r| 1e3 * r.from_base),
        positions_span_mm: reach.by_commands.map(|r| r.span.map(mm)),
        along_axes_mm: Some(reach.along_axes_mm),
        ends: Some(
            reach
                .ends
                .each_ref()
                .map(|pair| pair.each_ref().map(ToString::to_string)),
        ),
        box_mm: reach.box_mm,
        orientation_follows: reach.orientation_follows,
        how: format!(
            "by inverse kinematics from home within the limits of the actuators, the tool {}; collisions and limits of passive joints are not looked at",
            if reach.orientation_follows {
                "turning as the machine turns it"
            } else {
                "not turning"
            }
        ),
        ..ReachFinding::default()
    }
}

/// The reach in words.
pub(crate) fn reach_text(reach: &ReachFinding) -> String {
    let mut out = String::new();
    let rounded = |x: f64| short((10.0 * x).round() / 10.0);
    if let (Some(far), None) = (reach.from_base_mm, reach.along_axes_mm) {
        let axis = reach.from_first_axis_mm.map_or_else(String::new, |r| {
            format!(", and up to {} mm from its first axis", rounded(r))
        });
        out.push_str(&item(&format!(
            "reach: the tool gets up to {} mm from the base's origin{axis} ({})",
            rounded(far),
            reach.how
        )));
        return out;
    }
    let Some(along) = &reach.along_axes_mm else {
        return item(&format!("reach: {}", reach.how));
    };
    let reaches: Vec<String> = ["x", "y", "z"]
        .iter()
        .zip(along)
        .map(|(name, [back, ahead])| match (*back, *ahead) {
            (0.0, 0.0) => format!("{name} none"),
            _ => format!("{name} -{} .. +{}", number(*back, 4), number(*ahead, 4)),
        })
        .collect();
    let turning = if reach.orientation_follows {
        ", the tool turning as the machine turns it"
    } else {
        ""
    };
    let mut text = format!("reach from home{turning}, mm: {}", reaches.join(", "));
    if let Some([low, high]) = reach.box_mm {
        text.push_str(&format!(
            "; the largest box of these proportions that it fills is from {} to {} mm",
            triple(low, rounded),
            triple(high, rounded)
        ));
    }
    out.push_str(&item(&text));
    let mut reasons: Vec<&str> = Vec::new();
    for end in reach.ends.iter().flatten().flatten() {
        if !reasons.contains(&end.as_str()) && !end.starts_with("the machine ") {
            reasons.push(end);
        }
    }
    let limits = reasons.iter().filter(|r| r.starts_with("limit of")).count();
    let what = if limits > 2 {
        let others: Vec<&str> = reasons
            .iter()
            .filter(|r| !r.starts_with("limit of"))
            .copied()
            .collect();
        let mut list = vec!["limits of actuators"];
        list.extend(others);
        list.join(", or ")
    } else {
        reasons.join(", or ")
    };
    let end = match what.as_str() {
        "" => String::new(),
        what => format!("; what ends it: {what}"),
    };
    out.push_str(&item(&format!("found {}{end}", reach.how)));
    if let (Some(far), Some([low, high])) = (reach.from_base_mm, reach.positions_span_mm) {
        out.push_str(&item(&format!(
            "reach by all its ways: up to {} mm from the base's origin; its positions lie between {} and {} mm (the farthest found by a search over the ranges of the actuators)",
            rounded(far),
            triple(low, rounded),
            triple(high, rounded)
        )));
    }
    out
}
