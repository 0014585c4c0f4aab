//! The tables of a model file, and the file as a whole.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::schema::elastic::{Section, Stiffness};
use crate::schema::element::Element;
use crate::schema::joint::DampingTable;
use crate::schema::load::{LoadTable, PlatformLoadTable};
use crate::schema::placement::{Axis, Placement};
use crate::schema::uncertain::{CorrelationTable, UncertainTable};

/// The version of the format that this crate reads and writes.
pub const SCHEMA_VERSION: u32 = 1;

/// A model file: the whole of one machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "kinetostat model")]
pub struct Document {
    /// Version of the format: 1.
    pub schema: u32,
    /// Name, origin and gravity of the machine.
    pub mechanism: MechanismTable,
    /// Workspace of the machine, a box in base axes; flat for a machine that moves in a plane.
    pub workspace: Option<Workspace>,
    /// Moving bodies. The base exists without being written; the last one carries the tool.
    #[schemars(length(min = 1, max = 64))]
    pub platform: Vec<PlatformTable>,
    /// Sections and materials of links, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("maxProperties" = 1000))]
    pub section: BTreeMap<String, Section>,
    /// Stiffnesses of six directions, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("maxProperties" = 1000))]
    pub stiffness: BTreeMap<String, Stiffness>,
    /// Chains, by name; several limbs may use the same one.
    #[schemars(extend("maxProperties" = 256))]
    pub chain: BTreeMap<String, ChainTable>,
    /// Chains between two platforms.
    #[schemars(length(min = 1, max = 256))]
    pub limb: Vec<LimbTable>,
    /// Loads on platforms: wrenches, and springs between bodies of different limbs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub load: Vec<PlatformLoadTable>,
    /// Errors of manufacture and assembly: the actual geometry where it differs from the nominal.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 2000))]
    pub deviation: Vec<Deviation>,
    /// Rotary axes of a machine of five axes, by their words in programs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 3))]
    pub rotary_axis: Vec<RotaryAxisTable>,
    /// Coordinates of the controller as a function of the model's joint values.
    pub controller: Option<ControllerTable>,
    /// Damping of vibrations, unless joints and springs have dampers of their own.
    pub damping: Option<DampingTable>,
    /// How far numbers may be off, as identified from measurements or stated: `tolerance` and `compensate` tell what follows.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub uncertain: Vec<UncertainTable>,
    /// Uncertain numbers that scatter together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100_000))]
    pub correlation: Vec<CorrelationTable>,
}

/// Name, origin and gravity of the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MechanismTable {
    /// Name of the machine.
    pub name: String,
    /// Description of the machine in a sentence.
    pub description: Option<String>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
    /// Gravity in base axes, m/s^2: [0, 0, -9.81] for a machine on the floor, z up. Needed as soon
    /// as anything has a mass; [0, 0, 0] leaves the weights out.
    pub gravity_m_per_s2: Option<[f64; 3]>,
    /// Repeatability of positions, mm: the spread when a place is approached again and again (ISO 9283
    /// for robots, ISO 230-2 for machine tools). A third of it is the tolerance of programs that state
    /// none.
    pub repeatability_mm: Option<f64>,
}

/// A box in base axes, given by two opposite corners.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// One corner of the box, base axes, mm.
    pub corner_mm: Option<[f64; 3]>,
    /// One corner of the box, base axes, m.
    pub corner_m: Option<[f64; 3]>,
    /// The corner diagonally opposite to it, base axes, mm.
    pub opposite_corner_mm: Option<[f64; 3]>,
    /// The corner diagonally opposite to it, base axes, m.
    pub opposite_corner_m: Option<[f64; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// A moving body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlatformTable {
    /// Name, unique; 'base' is taken.
    pub name: String,
    /// Pose in the base when the machine is at home.
    pub home: Placement,
    /// Mass, kg, whose weight acts at the centre of mass; 0 if not given.
    pub mass_kg: Option<f64>,
    /// Centre of mass in the platform's frame, mm.
    pub centre_of_mass_mm: Option<[f64; 3]>,
    /// Centre of mass in the platform's frame, m.
    pub centre_of_mass_m: Option<[f64; 3]>,
    /// Inertia about the centre of mass in platform axes, kg m^2, three rows.
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// An ordered list of elements: the product from the chain's base to its tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainTable {
    /// Description of the chain in a sentence.
    pub description: Option<String>,
    /// The elements from the base to the tip, each in the frame reached by those before it.
    #[schemars(length(min = 1, max = 2000))]
    pub elements: Vec<Element>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// A chain between two platforms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimbTable {
    /// Name, unique.
    pub name: String,
    /// Platform where it starts: 'base' or the name of a platform.
    pub from: String,
    /// Platform where it ends.
    pub to: String,
    /// Name of its chain.
    pub chain: String,
    /// Pose of the chain's base in the frame of `from`.
    pub start: Option<Placement>,
    /// Pose of the chain's tip in the frame of `to`.
    pub end: Option<Placement>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
    /// Loads on the limb besides its weight.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub load: Vec<LoadTable>,
}

/// An error of manufacture or assembly: the actual geometry differs at one place. Exactly one of
/// `moved_by`, `longer_by_mm` and `tilted_by_deg` is written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deviation {
    /// Name of the limb whose actual geometry differs.
    pub limb: String,
    /// Name of a rigid element, a link or (where its axis is tilted) a joint of its chain, or 'start'
    /// or 'end'.
    pub at: String,
    /// Moves all that follows, in the frame reached behind that element.
    pub moved_by: Option<Placement>,
    /// Excess length of a link, a parallelogram or the offset of a rigid element, mm; negative if shorter than drawn.
    pub longer_by_mm: Option<f64>,
    /// Tilt, degrees: of a joint's axis, where `at` names a joint (what follows stays in place while the
    /// joint is at zero); else of all that follows.
    pub tilted_by_deg: Option<f64>,
    /// Axis of the tilt, in the frame reached there.
    pub about: Option<Axis>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

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

/// The word of a rotary axis.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
pub enum RotaryWord {
    /// About x, as a rule.
    A,
    /// About y, as a rule.
    B,
    /// About z, as a rule.
    C,
}

impl RotaryWord {
    /// Letter of the axis in programs.
    ///
    /// ```
    /// assert_eq!(kinetostat_model::schema::RotaryWord::B.letter(), 'B');
    /// ```
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::A => 'A',
            Self::B => 'B',
            Self::C => 'C',
        }
    }
}

/// Body that a rotary axis turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CarriesWord {
    /// The tool: a head, whose joint is in the chain as well.
    Tool,
    /// The part: a table, which is taken to be rigid.
    Part,
}

/// A rotary axis of a machine of five axes, by its word in programs. Heads are joints of a chain as well; a table turns the part and is in no
/// chain. Of two heads, or two tables, the one that carries the other comes first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotaryAxisTable {
    /// Letter of the axis in programs.
    pub word: RotaryWord,
    /// Body that the axis turns.
    pub carries: CarriesWord,
    /// About which a positive word turns that, right-handed, base axes, where all rotary axes stand at zero. Where a table turns
    /// against its word (as ISO 841 has it), write the axis with a minus.
    pub axis: Axis,
    /// A point on the axis there, base axes, mm; needed of a table.
    pub point_mm: Option<[f64; 3]>,
    /// A point on the axis there, base axes, m.
    pub point_m: Option<[f64; 3]>,
    /// Lower and upper limit of its angle, deg; without them it turns without end, or a head as far as the joint of its
    /// chain does.
    pub limits_deg: Option<[f64; 2]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}
