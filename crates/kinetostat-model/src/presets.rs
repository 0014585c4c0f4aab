//! Models that come with the program.

use crate::hints;
use crate::problem::{ModelError, Problem};

/// A model that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, as taken by [`crate::Model::preset`].
    pub name: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
    text: &'static str,
}

macro_rules! preset {
    ($name:literal, $description:literal) => {
        Preset {
            name: $name,
            description: $description,
            text: include_str!(concat!("../models/", $name, ".toml")),
        }
    };
}

const PRESETS: [Preset; 9] = [
    preset!(
        "orthoglide",
        "Orthoglide: three sliding legs with parallelograms, 200 mm cube, identified stiffness"
    ),
    preset!(
        "stewart_gough_a",
        "Stewart-Gough platform, equal hexagons: singular at home"
    ),
    preset!(
        "stewart_gough_b",
        "Stewart-Gough platform, paired joints: six stiff directions"
    ),
    preset!(
        "two_link",
        "Two rigid links with a springy joint: the smallest machine that can snap through"
    ),
    preset!(
        "three_link_s",
        "Three rigid links with springy joints, straight: buckles like a column"
    ),
    preset!(
        "three_link_z",
        "Three rigid links with springy joints, at rest in a Z: buckles at a pitchfork"
    ),
    preset!(
        "puu3",
        "3-PUU: three sliders with struts and universal joints, moves without turning"
    ),
    preset!(
        "heavy_6r",
        "Heavy six-axis arm of the 200 kg class with drive and link compliances and weights"
    ),
    preset!(
        "compensated_arm",
        "Planar arm of three joints, its shoulder relieved by a spring; links that bow"
    ),
];

/// The presets in a fixed order.
#[must_use]
pub fn preset_names() -> &'static [Preset] {
    &PRESETS
}

/// The model file of a preset.
#[must_use]
pub fn preset_text(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|p| p.name == name).map(|p| p.text)
}

pub(crate) fn unknown(name: &str) -> ModelError {
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
