//! Models that come with the program.

use crate::problem::{ModelError, Problem};
use crate::text::hints;

/// Kind of machine of a preset: a family of the report's chapter 2 (figures 2.5 to 2.8), or an example of one effect.
/// The order is that of lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum PresetKind {
    /// A robot whose joints follow one another; compensators and parallelograms included.
    Serial,
    /// A robot whose platform is carried by several limbs.
    Parallel,
    /// A robot of parallel and serial parts.
    Hybrid,
    /// A machine as small as the effect allows that it shows.
    Teaching,
}

impl PresetKind {
    /// Every kind, in the order of lists.
    pub const ALL: [Self; 4] = [Self::Serial, Self::Parallel, Self::Hybrid, Self::Teaching];

    /// Heading of the presets of this kind in a list.
    #[must_use]
    pub fn heading(self) -> &'static str {
        match self {
            Self::Serial => "Serial robots",
            Self::Parallel => "Parallel robots",
            Self::Hybrid => "Hybrid robots",
            Self::Teaching => "Teaching examples",
        }
    }
}

/// A model that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, as taken by [`crate::Model::preset`].
    pub name: &'static str,
    /// Kind of machine.
    pub kind: PresetKind,
    /// Description in one line.
    pub description: &'static str,
    text: &'static str,
}

macro_rules! preset {
    ($kind:ident, $name:literal, $description:literal) => {
        Preset {
            name: $name,
            kind: PresetKind::$kind,
            description: $description,
            text: include_str!(concat!("../models/", $name, ".toml")),
        }
    };
}

// One line per preset and no count: branches that add machines merge.
const PRESETS: &[Preset] = &[
    preset!(
        Parallel,
        "orthoglide",
        "Orthoglide: three sliding legs with parallelograms, 200 mm cube, identified stiffness"
    ),
    preset!(
        Teaching,
        "stewart_gough_a",
        "Stewart-Gough platform, equal hexagons: singular at home"
    ),
    preset!(
        Parallel,
        "stewart_gough_b",
        "Stewart-Gough platform, paired joints: six stiff directions"
    ),
    preset!(
        Teaching,
        "two_link",
        "Two rigid links with a springy joint: the smallest machine that can snap through"
    ),
    preset!(
        Teaching,
        "three_link_s",
        "Three rigid links with springy joints, straight: buckles like a column"
    ),
    preset!(
        Teaching,
        "three_link_z",
        "Three rigid links with springy joints, at rest in a Z: buckles at a pitchfork"
    ),
    preset!(
        Teaching,
        "two_chains",
        "Two chains of three links carry one tool, straight at rest: figure 5.2 of the report"
    ),
    preset!(
        Teaching,
        "two_chains_pressed",
        "The two chains pressed by 150 mm each: 16 shapes with the tool held, four stable"
    ),
    preset!(
        Parallel,
        "puu3",
        "3-PUU: three sliders with struts and universal joints, moves without turning"
    ),
    preset!(
        Parallel,
        "hexapod",
        "Hanging 6-6 hexapod for milling: elastic telescoping legs, gimbals and ball joints"
    ),
    preset!(
        Parallel,
        "hexapod_with_screws",
        "The hexapod with screws between universal joints: length and turn of a leg are coupled"
    ),
    preset!(
        Parallel,
        "cubic_hexapod",
        "Stewart's cube: six legs along its edges, equally stiff in all directions at the centre"
    ),
    preset!(
        Parallel,
        "hexaglide",
        "Hexaglide: six struts of constant length on sliders of three parallel rails"
    ),
    preset!(
        Parallel,
        "delta",
        "Delta: three turning arms, six elastic rods; moves without turning"
    ),
    preset!(
        Parallel,
        "tripteron",
        "Tripteron: three slides with hinged bars; every coordinate is one command"
    ),
    preset!(
        Parallel,
        "rrr3_planar",
        "Planar 3-RRR: three cranks move a plate in its plane and turn it"
    ),
    preset!(
        Parallel,
        "prs3",
        "3-PRS spindle head: three upright sliders feed and tilt"
    ),
    preset!(
        Serial,
        "heavy_6r",
        "Heavy six-axis arm of the 200 kg class with drive and link compliances and weights"
    ),
    preset!(
        Serial,
        "kuka_kr270_like",
        "Six-axis arm of the KR 270 class: identified joints, spring compensator at axis 2"
    ),
    preset!(
        Serial,
        "abb_irb6640_like",
        "Six-axis arm of the IRB 6640 class: drives and castings bend, balancing spring"
    ),
    preset!(
        Serial,
        "fanuc_r2000ic_like",
        "Six-axis arm of the R-2000iC class: drives and castings bend, gas spring"
    ),
    preset!(
        Serial,
        "fanuc_m900ib_like",
        "Arm of the M-900iB class: parallelogram as an explicit loop, two balancers"
    ),
    preset!(
        Serial,
        "counterweight_arm",
        "Heavy arm: linear actuator at the shoulder, crank, bar and counterweight"
    ),
    preset!(
        Serial,
        "scara",
        "SCARA: two upright joints, a quill that slides and turns"
    ),
    preset!(
        Serial,
        "gantry",
        "Gantry: a bridge on two runways with a drive each, trolley and ram"
    ),
    preset!(
        Parallel,
        "parallel_wrist",
        "Spherical parallel wrist: three RRR legs turn a platform about one point"
    ),
    preset!(
        Hybrid,
        "tricept_like",
        "Tricept-like: three UPS legs, a central tube, a wrist of two axes in series"
    ),
    preset!(
        Hybrid,
        "arm_with_parallel_wrist",
        "Arm of three joints that carries a spherical parallel wrist"
    ),
    preset!(
        Hybrid,
        "gantry_with_tripod",
        "Gantry that carries a tripod of three hinged legs: five axes"
    ),
    preset!(
        Teaching,
        "compensated_arm",
        "Planar arm of three joints, its shoulder relieved by a spring; links that bow"
    ),
];

/// The presets in a fixed order.
#[must_use]
pub fn preset_names() -> &'static [Preset] {
    PRESETS
}

/// The model file of a preset.
#[must_use]
pub fn preset_text(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|p| p.name == name).map(|p| p.text)
}

pub(crate) fn unknown_preset(name: &str) -> ModelError {
    let names: Vec<&str> = PRESETS.iter().map(|p| p.name).collect();
    let list = names.join(", ");
    let help = match hints::nearest(name, &names) {
        Some(near) => format!("did you mean '{near}'? There are: {list}"),
        None => format!("there are: {list}; a file is named with its path, ./model.toml"),
    };
    ModelError::new(vec![Problem::without_text(
        &format!("preset {name}"),
        format!("there is no preset named '{name}'"),
        help,
    )])
}
