//! Limbs of a model: what they are made of, and what each of them holds.

use kinetostat::number::counted;
use kinetostat::{MotionKind, model::Role};
use kinetostat_model::Model;
use kinetostat_model::schema::{Convention, Element};
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::layout::{self, wrapped};
use crate::ui::numbers::{number, short};

#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbFinding {
    pub(crate) name: String,
    pub(crate) from: String,
    pub(crate) to: String,
    pub(crate) actuators: Vec<ActuatorFinding>,
    pub(crate) passive_joints: Vec<String>,
    pub(crate) springs: Vec<String>,
    pub(crate) spring_coordinates: usize,
    pub(crate) preloaded_springs: Vec<String>,
    pub(crate) links: Vec<LinkFinding>,
    pub(crate) loads: Vec<LoadFinding>,
    pub(crate) bodies: Vec<String>,
    pub(crate) mass_kg: f64,
    pub(crate) redundant_passive_joints: Vec<String>,
    /// Directions of the tool that this limb blocks for rigid links.
    pub(crate) constrained_directions: Option<usize>,
    pub(crate) stiffness_rank: Option<usize>,
}

/// An elastic link.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LinkFinding {
    pub(crate) name: String,
    pub(crate) length_mm: f64,
    pub(crate) segments: usize,
    pub(crate) convention: Convention,
    /// Pinned at both ends, in its softer plane.
    pub(crate) euler_load_n: f64,
}

/// A load on a limb or on platforms.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LoadFinding {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) in_words: String,
    pub(crate) conservative: bool,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ActuatorFinding {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) home: f64,
    pub(crate) limits: Option<[f64; 2]>,
    pub(crate) rigid_drive: bool,
}

pub(crate) fn limb(model: &Model, index: usize) -> LimbFinding {
    let m = &model.mechanism;
    let limb = &m.limbs()[index];
    let chain = &limb.nominal;
    let name = |i: usize| m.platforms()[i].name.clone();
    LimbFinding {
        name: limb.name.clone(),
        from: name(limb.from),
        to: name(limb.to),
        actuators: chain
            .actuators()
            .iter()
            .map(|a| {
                let (kind, unit, factor) = match a.kind {
                    MotionKind::Prismatic => ("slides", "mm", 1e3),
                    MotionKind::Revolute => ("turns", "deg", 1_f64.to_degrees()),
                };
                ActuatorFinding {
                    name: a.name.clone(),
                    kind,
                    unit,
                    home: factor * a.home,
                    limits: a.limits.map(|(low, high)| [factor * low, factor * high]),
                    rigid_drive: a.coordinate.is_none(),
                }
            })
            .collect(),
        passive_joints: chain
            .coordinates()
            .iter()
            .filter(|c| c.role == Role::Passive)
            .map(|c| c.name.clone())
            .collect(),
        springs: chain.springs().iter().map(|s| s.name.clone()).collect(),
        spring_coordinates: chain.springs().iter().map(|s| s.len()).sum(),
        preloaded_springs: chain
            .springs()
            .iter()
            .filter(|s| s.rest.iter().any(|x| *x != 0.0))
            .map(|s| s.name.clone())
            .collect(),
        links: links(model, index),
        loads: loads(model, index),
        bodies: chain.bodies().iter().map(|b| b.name.clone()).collect(),
        mass_kg: chain.mass(),
        redundant_passive_joints: Vec::new(),
        constrained_directions: None,
        stiffness_rank: None,
    }
}

fn links(model: &Model, index: usize) -> Vec<LinkFinding> {
    let chain = &model.mechanism.limbs()[index].nominal;
    let written = &model.document.limb[index].chain;
    let elements = model.document.chain.get(written).map(|c| c.elements.iter());
    let elements = elements.into_iter().flatten().enumerate();
    elements
        .filter_map(|(i, element)| {
            let Element::Link(link) = element else {
                return None;
            };
            let name = element
                .name()
                .map_or_else(|| format!("{} {}", element.word(), i + 1), str::to_owned);
            let own = |s: &&kinetostat::model::Segment| s.link == name;
            let pieces = || chain.springs().iter().filter_map(|s| s.segment.as_ref());
            let piece = pieces().find(own)?;
            let slenderness = std::f64::consts::PI / piece.link_length;
            Some(LinkFinding {
                length_mm: 1e3 * piece.link_length,
                segments: pieces().filter(own).count(),
                convention: link.convention.unwrap_or_default(),
                euler_load_n: slenderness * slenderness * piece.bending_stiffness,
                name,
            })
        })
        .collect()
}

fn loads(model: &Model, index: usize) -> Vec<LoadFinding> {
    let m = &model.mechanism;
    let written = &model.document.limb[index].load;
    let both = written.iter().zip(m.loads(index));
    both.map(|(written, load)| LoadFinding {
        name: written.name().to_owned(),
        kind: written.word(),
        in_words: written.description(),
        conservative: m.load_conservative(index, load),
    })
    .collect()
}

/// Loads on platforms, those between limbs included.
pub(crate) fn platform_loads(model: &Model) -> Vec<LoadFinding> {
    let written = model.document.load.iter();
    let both = written.zip(model.mechanism.platform_loads());
    both.map(|(written, load)| LoadFinding {
        name: written.name().to_owned(),
        kind: written.word(),
        in_words: written.description(),
        conservative: load.conservative(),
    })
    .collect()
}

pub(crate) fn load_description(load: &LoadFinding) -> String {
    let flag = if load.conservative {
        ""
    } else {
        " (not conservative)"
    };
    format!("load '{}': {}{flag}", load.name, load.in_words)
}

pub(crate) fn limb_text(l: &LimbFinding) -> String {
    let mut rows = Vec::new();
    for a in &l.actuators {
        rows.push(vec![
            format!("actuator '{}' {}", a.name, a.kind),
            format!("home {}", short(a.home)),
            match a.limits {
                Some([low, high]) => format!("limits {} .. {}", short(low), short(high)),
                None => "no limits".to_owned(),
            },
            format!(
                "{}{}",
                a.unit,
                if a.rigid_drive { ", rigid drive" } else { "" }
            ),
        ]);
    }
    let mut out = layout::listed(&rows, 2);
    let list = |names: &[String]| {
        if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        }
    };
    out.push_str(&wrapped(
        &format!("passive joints: {}", list(&l.passive_joints)),
        2,
    ));
    let mut springs = format!(
        "springs: {} ({})",
        list(&l.springs),
        counted(l.spring_coordinates, "coordinate")
    );
    if !l.preloaded_springs.is_empty() {
        springs.push_str(&format!("; preloaded: {}", list(&l.preloaded_springs)));
    }
    out.push_str(&wrapped(&springs, 2));
    for link in &l.links {
        let pieces = match link.segments {
            1 => String::new(),
            n => format!(" in {n} segments"),
        };
        out.push_str(&wrapped(
            &format!(
                "link '{}': {} mm{pieces}, {}; Euler load {} N",
                link.name,
                short(link.length_mm),
                convention_description(link.convention),
                number(link.euler_load_n, 4)
            ),
            2,
        ));
    }
    for load in &l.loads {
        out.push_str(&wrapped(&load_description(load), 2));
    }
    if l.mass_kg > 0.0 {
        out.push_str(&wrapped(
            &format!(
                "masses: {}, {} kg in all",
                list(&l.bodies),
                number(l.mass_kg, 5)
            ),
            2,
        ));
    }
    if let (Some(rank), Some(blocked)) = (l.stiffness_rank, l.constrained_directions) {
        out.push_str(&wrapped(
            &format!(
                "stiffness of rank {rank} at its end; blocks {blocked} of the tool's directions"
            ),
            2,
        ));
    }
    if !l.redundant_passive_joints.is_empty() {
        out.push_str(&wrapped(
            &format!(
                "redundant: {} can move while the end is held",
                list(&l.redundant_passive_joints)
            ),
            2,
        ));
    }
    out
}

fn convention_description(convention: Convention) -> &'static str {
    match convention {
        Convention::Bowing => "bows",
        Convention::TranslationsFirst => "plain spring, translations first",
        Convention::RotationsFirst => "plain spring, rotations first",
        Convention::Middle => "plain spring in the middle",
        Convention::Exponential => "plain spring, exponential coordinates",
        Convention::ConstantStrain => "constant strain",
    }
}
