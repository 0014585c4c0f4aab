//! Platforms: rigid bodies that limbs join.

use std::collections::BTreeSet;

use kinetostat::Platform;

use crate::elements::part::{inertia, mass};
use crate::elements::placement::pose;
use crate::elements::quantity::{MM, choices, vector};
use crate::findings::{Findings, name};
use crate::problem::KeyPath;
use crate::schema::{Document, LimbTable};
use crate::text::hints::unknown;

pub(crate) fn platforms(document: &Document, findings: &mut Findings) -> Vec<Platform> {
    let mut seen = BTreeSet::from(["base"]);
    let mut platforms = Vec::new();
    // A limb that goes nowhere is reported itself; the platform it misses is not a second mistake.
    let exists = |name: &str| document.platform.iter().any(|p| p.name == name);
    let sound = document
        .limb
        .iter()
        .all(|l| exists(&l.to) && (l.from == "base" || exists(&l.from)));
    for (i, p) in document.platform.iter().enumerate() {
        let place = KeyPath::root().key("platform").index(i);
        name(&place.key("name"), &p.name, findings);
        if !seen.insert(&p.name) {
            let help = match p.name.as_str() {
                "base" => "the base exists without being written; this table is for moving bodies",
                _ => "rename one of them",
            };
            findings.error(
                &place.key("name"),
                format!("the platform '{}' exists already", p.name),
                help,
            );
        }
        let centre = choices!(p, (centre_of_mass_mm, MM), (centre_of_mass_m, 1.0));
        let home = findings.keep(pose(&place.key("home"), &p.home));
        let mass = findings.keep(mass(&place, p.mass_kg));
        let centre_of_mass = findings.keep(vector(&place, "centre of mass", &centre));
        let inertia = findings.keep(inertia(&place, p.inertia_kg_m2));
        if let (Some(home), Some(mass), Some(centre_of_mass), Some(inertia)) =
            (home, mass, centre_of_mass, inertia)
        {
            platforms.push(Platform {
                name: p.name.clone(),
                home,
                mass,
                centre_of_mass,
                inertia,
            });
        }
        let held = |l: &LimbTable| l.from == p.name || l.to == p.name;
        if !document.limb.iter().any(held) && sound {
            findings.error(
                &place.key("name"),
                format!("no limb holds the platform '{}'", p.name),
                format!("write a [[limb]] with to = \"{}\"", p.name),
            );
        }
    }
    platforms
}

pub(crate) fn platform_index(
    document: &Document,
    place: &KeyPath,
    name: &str,
    findings: &mut Findings,
) -> Option<usize> {
    if name == "base" {
        return Some(0);
    }
    let index = document.platform.iter().position(|p| p.name == name);
    if index.is_none() {
        let known: Vec<&str> = std::iter::once("base")
            .chain(document.platform.iter().map(|p| p.name.as_str()))
            .collect();
        findings.errors.push(unknown(
            place,
            "platform",
            name,
            &known,
            "write a table [[platform]]",
        ));
    }
    index.map(|i| i + 1)
}
