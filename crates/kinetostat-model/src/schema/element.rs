//! The words of a chain. Each element has exactly one word that says what it is; the word is the
//! key, so that a chain reads like the drawing.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::schema::joint::Knee;
use crate::schema::{Axis, JointKind, PassiveKind, Placement, RotorTable, Spring6};

/// One element of a chain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Element {
    /// Constant offset.
    Rigid(RigidElement),
    /// Commanded joint.
    Actuator(ActuatorElement),
    /// Joint that nothing holds.
    Passive(PassiveElement),
    /// Spring of one degree of freedom.
    Spring(SpringElement),
    /// Spring of six degrees of freedom.
    Spring6(Spring6Element),
    /// Straight elastic link.
    Link(LinkElement),
    /// Two parallel bars.
    Parallelogram(ParallelogramElement),
    /// Motion driven by an earlier coordinate.
    Coupled(CoupledElement),
    /// Named place.
    Node(NodeElement),
    /// Mass.
    Body(BodyElement),
}

/// Constant offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "rigid"))]
pub struct RigidElement {
    /// The offset.
    pub rigid: Placement,
    /// Name, by which a deviation finds it.
    pub name: Option<String>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Commanded joint with the spring of its drive in series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "actuator"))]
pub struct ActuatorElement {
    /// Slides, turns, or is a screw.
    pub actuator: ActuatorKind,
    /// Name, unique in the chain.
    pub name: Option<String>,
    /// Direction along which it slides or about which it turns.
    pub axis: Axis,
    /// Lead of a screw, mm per turn: turning its far end by one turn, right-handed about the axis,
    /// makes it longer by the lead; negative for a left-hand thread.
    pub lead_mm_per_turn: Option<f64>,
    /// Lead of a screw, m per turn.
    pub lead_m_per_turn: Option<f64>,
    /// true: the drive does not give way (then no stiffness is written).
    pub rigid_drive: Option<bool>,
    /// Stiffness of a sliding drive along its axis, N/m.
    pub stiffness_n_per_m: Option<f64>,
    /// Stiffness of a sliding drive along its axis, N/mm.
    pub stiffness_n_per_mm: Option<f64>,
    /// Stiffness of a turning drive about its axis, N m/rad.
    pub stiffness_n_m_per_rad: Option<f64>,
    /// Stiffness of a turning drive about its axis, N mm/rad.
    pub stiffness_n_mm_per_rad: Option<f64>,
    /// Largest force of a sliding drive, N: programs that need more are refused.
    pub rated_force_n: Option<f64>,
    /// Largest torque of a turning drive at its joint, N m: programs that need more are refused.
    pub rated_torque_n_m: Option<f64>,
    /// The motor's rotor, for vibrations.
    pub rotor: Option<RotorTable>,
    /// Damper beside the spring of a sliding drive, N s/m, for vibrations.
    pub damping_n_s_per_m: Option<f64>,
    /// Damper beside the spring of a turning drive, N m s/rad, for vibrations.
    pub damping_n_m_s_per_rad: Option<f64>,
    /// Deflection of the drive's spring at rest, mm (a preload where it is not zero).
    pub rest_mm: Option<f64>,
    /// Deflection of the drive's spring at rest, m.
    pub rest_m: Option<f64>,
    /// Deflection of the drive's spring at rest, degrees.
    pub rest_deg: Option<f64>,
    /// Deflection of the drive's spring at rest, rad.
    pub rest_rad: Option<f64>,
    /// Command at home, mm.
    pub home_mm: Option<f64>,
    /// Command at home, m.
    pub home_m: Option<f64>,
    /// Command at home, degrees.
    pub home_deg: Option<f64>,
    /// Command at home, rad.
    pub home_rad: Option<f64>,
    /// Smallest and largest command, mm.
    pub limits_mm: Option<[f64; 2]>,
    /// Smallest and largest command, m.
    pub limits_m: Option<[f64; 2]>,
    /// Smallest and largest command, degrees.
    pub limits_deg: Option<[f64; 2]>,
    /// Smallest and largest command, rad.
    pub limits_rad: Option<[f64; 2]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Motion that an actuator commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ActuatorKind {
    /// Slides along its axis.
    Prismatic,
    /// Turns about its axis.
    Revolute,
    /// Slides along its axis, its far end free to turn about it: turning changes the length by the
    /// lead. The turn is the passive joint `name.turn`.
    Screw,
}

/// Joint that nothing holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "passive"))]
pub struct PassiveElement {
    /// Kind of the joint.
    pub passive: PassiveKind,
    /// Name, unique in the chain; a universal joint has the coordinates `name.1` and `name.2`, a
    /// spherical one `name.x`, `name.y`, `name.z`.
    pub name: Option<String>,
    /// Axis of a prismatic or revolute joint.
    pub axis: Option<Axis>,
    /// The two axes of a universal joint, in order.
    pub axes: Option<[Axis; 2]>,
    /// Value at home of a prismatic joint, mm.
    pub home_mm: Option<f64>,
    /// Value at home of a prismatic joint, m.
    pub home_m: Option<f64>,
    /// Value at home of a revolute joint, degrees.
    pub home_deg: Option<f64>,
    /// Value at home of a revolute joint, rad.
    pub home_rad: Option<f64>,
    /// Values at home of a universal (two) or spherical (three) joint, degrees.
    #[schemars(length(min = 2, max = 3))]
    pub homes_deg: Option<Vec<f64>>,
    /// Values at home of a universal (two) or spherical (three) joint, rad.
    #[schemars(length(min = 2, max = 3))]
    pub homes_rad: Option<Vec<f64>>,
    /// Damper of a prismatic joint, N s/m, for vibrations.
    pub damping_n_s_per_m: Option<f64>,
    /// Damper of a joint that turns, N m s/rad, for vibrations; about every axis of a universal or spherical one.
    pub damping_n_m_s_per_rad: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Spring of one degree of freedom.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "spring"))]
pub struct SpringElement {
    /// Slides or turns.
    pub spring: JointKind,
    /// Name, unique in the chain.
    pub name: Option<String>,
    /// Direction along which it slides or about which it turns.
    pub axis: Axis,
    /// Stiffness of a spring that slides, along its axis, N/m.
    pub stiffness_n_per_m: Option<f64>,
    /// Stiffness of a spring that slides, along its axis, N/mm.
    pub stiffness_n_per_mm: Option<f64>,
    /// Stiffness of a spring that turns, about its axis, N m/rad.
    pub stiffness_n_m_per_rad: Option<f64>,
    /// Stiffness of a spring that turns, about its axis, N mm/rad.
    pub stiffness_n_mm_per_rad: Option<f64>,
    /// Knee of the spring: deflection at which its stiffness changes, and the stiffness beyond it; the one written here
    /// is that at rest.
    pub knee: Option<Knee>,
    /// Damper beside a spring that slides, N s/m, for vibrations.
    pub damping_n_s_per_m: Option<f64>,
    /// Damper beside a spring that turns, N m s/rad, for vibrations.
    pub damping_n_m_s_per_rad: Option<f64>,
    /// Deflection at rest, mm (a preload where it is not zero).
    pub rest_mm: Option<f64>,
    /// Deflection at rest, m.
    pub rest_m: Option<f64>,
    /// Deflection at rest, degrees.
    pub rest_deg: Option<f64>,
    /// Deflection at rest, rad.
    pub rest_rad: Option<f64>,
    /// Deflection when the machine is at home without load, mm; zero if not given. Where it is
    /// not the one at rest, the spring is assembled with a preload.
    pub home_mm: Option<f64>,
    /// Deflection when the machine is at home without load, m.
    pub home_m: Option<f64>,
    /// Deflection when the machine is at home without load, degrees.
    pub home_deg: Option<f64>,
    /// Deflection when the machine is at home without load, rad.
    pub home_rad: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Spring of six degrees of freedom: three translations, then three rotations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "spring6"))]
pub struct Spring6Element {
    /// Name of a stiffness, or the stiffness written in place.
    pub spring6: Spring6,
    /// Name, unique in the chain; the coordinates are `name.x` to `name.rz`.
    pub name: Option<String>,
    /// Translations at rest, mm (a preload where they are not zero).
    pub rest_translation_mm: Option<[f64; 3]>,
    /// Translations at rest, m (a preload where they are not zero).
    pub rest_translation_m: Option<[f64; 3]>,
    /// Rotations at rest, degrees (a preload where they are not zero).
    pub rest_rotation_deg: Option<[f64; 3]>,
    /// Rotations at rest, rad (a preload where they are not zero).
    pub rest_rotation_rad: Option<[f64; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Straight elastic link: the offset, then the spring of its far end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "link"))]
pub struct LinkElement {
    /// Name of a section (the link is its cantilever) or of a stiffness (of the far end, as a
    /// finite element program gives it).
    pub link: String,
    /// Name, unique in the chain.
    pub name: Option<String>,
    /// Length along the local x axis, mm.
    pub length_mm: Option<f64>,
    /// Length along the local x axis, m.
    pub length_m: Option<f64>,
    /// From the near to the far end in the frame reached so far, mm. The frame does not turn; the
    /// section's x axis lies along the vector, its y axis as for `x_axis` of a pose.
    pub vector_mm: Option<[f64; 3]>,
    /// From the near to the far end in the frame reached so far, m.
    pub vector_m: Option<[f64; 3]>,
    /// Number of equal pieces, 1 if not given. One is enough far below the Euler load, 8 give
    /// buckling loads to 0.1 %, 32 give deflections as large as the link.
    pub segments: Option<u32>,
    /// Bending convention of a piece, 'bowing' if not given. All have the same unloaded stiffness.
    pub convention: Option<Convention>,
    /// Density of the material, kg/m^3: the link of a section gets its mass along it, which weighs and swings. Without it
    /// the link has no mass, and its bodies have it all.
    pub density_kg_m3: Option<f64>,
    /// Mass per length, kg/m, instead of a density: for links that are known by a matrix, by rigidities or by a shape that
    /// changes.
    pub mass_kg_per_m: Option<f64>,
    /// Distribution of the mass, 'along_the_link' if not given.
    pub mass_model: Option<MassModelWord>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Distribution of a link's mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MassModelWord {
    /// Along the link, moving as it bends.
    #[default]
    AlongTheLink,
    /// Half of every piece at each of its ends: coarser, and a link hinged at both ends has no vibration of its own in one
    /// piece.
    HalvesAtEnds,
}

/// Kinematics and energy of a bent piece of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// Bending shortens the piece: pushed it buckles at its Euler load, pulled it stiffens.
    #[default]
    Bowing,
    /// A plain spring at the far end, translations before rotations: the report's.
    TranslationsFirst,
    /// A plain spring at the far end, rotations before translations.
    RotationsFirst,
    /// A plain spring in the middle of the piece, translations before rotations.
    Middle,
    /// A plain spring in exponential coordinates.
    Exponential,
    /// Strain constant along the piece; needs several pieces even for small deflections.
    ConstantStrain,
}

/// Two parallel bars along local x that swing about local y: the far end keeps its orientation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "parallelogram"))]
pub struct ParallelogramElement {
    /// Name of the section or of the stiffness of one bar (a stiffness: of its far end, root
    /// clamped).
    pub parallelogram: String,
    /// Name, unique in the chain: the passive coordinate of the swing. The springs are `name.bars`.
    pub name: Option<String>,
    /// Length of the bars, mm.
    pub length_mm: Option<f64>,
    /// Length of the bars, m.
    pub length_m: Option<f64>,
    /// Distance of the bars, mm.
    pub width_mm: Option<f64>,
    /// Distance of the bars, m.
    pub width_m: Option<f64>,
    /// Swing at home, degrees.
    pub home_deg: Option<f64>,
    /// Swing at home, rad.
    pub home_rad: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// One more motion driven by a joint that comes earlier in the chain: a mimic joint, a parallelogram.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "coupled"))]
pub struct CoupledElement {
    /// Name of the coordinate: an actuator (command and deflection of its drive), a passive joint or
    /// a spring.
    pub coupled: String,
    /// Slides or turns.
    pub motion: JointKind,
    /// Direction along which it slides or about which it turns.
    pub axis: Axis,
    /// Motion per motion of the coordinate, in m and rad.
    pub ratio: f64,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// A name for the frame reached so far; loads and results refer to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "node"))]
pub struct NodeElement {
    /// Name, unique in the chain; 'tip' is taken by the end.
    pub node: String,
}

/// A mass fixed to the frame reached so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "body"))]
pub struct BodyElement {
    /// Name, unique among the chain's nodes and bodies.
    pub body: String,
    /// Mass, kg, whose weight acts at the centre of mass.
    pub mass_kg: f64,
    /// Centre of mass in the frame reached so far, mm.
    pub centre_of_mass_mm: Option<[f64; 3]>,
    /// Centre of mass in the frame reached so far, m.
    pub centre_of_mass_m: Option<[f64; 3]>,
    /// Inertia about the centre of mass, axes of the frame reached so far, kg m^2, three rows.
    /// Statics does not use it.
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

impl Element {
    /// The word that says what the element is.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Rigid(_) => "rigid",
            Self::Actuator(_) => "actuator",
            Self::Passive(_) => "passive",
            Self::Spring(_) => "spring",
            Self::Spring6(_) => "spring6",
            Self::Link(_) => "link",
            Self::Parallelogram(_) => "parallelogram",
            Self::Coupled(_) => "coupled",
            Self::Node(_) => "node",
            Self::Body(_) => "body",
        }
    }

    /// The name, or word and number of an element without one.
    pub(crate) fn name_or_number(&self, number: usize) -> String {
        self.name()
            .map_or_else(|| format!("{} {number}", self.word()), str::to_owned)
    }

    /// The name as written, if it has one.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Rigid(e) => e.name.as_deref(),
            Self::Actuator(e) => e.name.as_deref(),
            Self::Passive(e) => e.name.as_deref(),
            Self::Spring(e) => e.name.as_deref(),
            Self::Spring6(e) => e.name.as_deref(),
            Self::Link(e) => e.name.as_deref(),
            Self::Parallelogram(e) => e.name.as_deref(),
            Self::Coupled(_) => None,
            Self::Node(e) => Some(&e.node),
            Self::Body(e) => Some(&e.body),
        }
    }
}
