//! Coordinates of the machine's controller as a function of the model's joint values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Map of the controller: its coordinates are linear functions of the model's joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControllerTable {
    /// Name of the controller, in a few words.
    pub name: Option<String>,
    /// The axes in the order of the controller, one for every actuator, external axes included.
    #[schemars(length(min = 1, max = 1000))]
    pub axis: Vec<ControllerAxisTable>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// One axis of the controller: ratio times its joint, plus shares of other joints, plus an offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControllerAxisTable {
    /// Name as on the controller: A1, J1, E1.
    pub name: String,
    /// Name of its actuator; in a machine of several limbs LIMB.ACTUATOR.
    pub joint: String,
    /// true: the controller counts against the model's joint.
    pub reversed: Option<bool>,
    /// Motion on the controller per motion of the joint, above zero; 1 if not given.
    pub ratio: Option<f64>,
    /// Controller coordinate while the model's joints are at zero, mm.
    pub zero_offset_mm: Option<f64>,
    /// Controller coordinate while the model's joints are at zero, m.
    pub zero_offset_m: Option<f64>,
    /// Controller coordinate while the model's joints are at zero, degrees.
    pub zero_offset_deg: Option<f64>,
    /// Controller coordinate while the model's joints are at zero, rad.
    pub zero_offset_rad: Option<f64>,
    /// Unit that the controller shows; mm for a joint that slides, deg for one that turns if not given.
    pub unit: Option<ControllerUnit>,
    /// Other joints that move this axis on the controller, with their signs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub coupled: Vec<ControllerCoupling>,
}

/// The share of another joint in an axis of the controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControllerCoupling {
    /// The other actuator, of the model.
    pub joint: String,
    /// Motion on the controller per motion of that joint, both of one kind: -1 where the controller shows
    /// the difference.
    pub ratio: Option<f64>,
    /// For an axis that slides and a joint that turns.
    pub ratio_mm_per_deg: Option<f64>,
    /// For an axis that turns and a joint that slides.
    pub ratio_deg_per_mm: Option<f64>,
}

/// Unit of an axis of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ControllerUnit {
    /// Millimetres.
    Mm,
    /// Metres.
    M,
    /// Degrees.
    Deg,
    /// Radians.
    Rad,
}

impl ControllerUnit {
    /// Unit as written: `mm`, `m`, `deg`, `rad`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::M => "m",
            Self::Deg => "deg",
            Self::Rad => "rad",
        }
    }

    /// m or rad in one of it.
    #[must_use]
    pub fn in_si(self) -> f64 {
        match self {
            Self::Mm => 1e-3,
            Self::Deg => std::f64::consts::PI / 180.0,
            Self::M | Self::Rad => 1.0,
        }
    }
}
