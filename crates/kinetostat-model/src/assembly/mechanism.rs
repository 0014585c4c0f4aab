//! Assembles the mechanism from the document: the only module that knows the schema and the core's builder. Every
//! mistake found on the way is kept with its place, so that one run shows them all.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::Mechanism;
use nalgebra::Vector3;

use crate::assembly::limb::limbs;
use crate::assembly::load::platform_loads;
use crate::assembly::platform::platforms;
use crate::assembly::template::{Template, template};
use crate::elements::damping::damping;
use crate::elements::elastic::Elastic;
use crate::elements::rotary::rotary_axes;
use crate::elements::workspace::corners;
use crate::findings::{Findings, name};
use crate::plausibility::home::check_plausibility;
use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, Element, SCHEMA_VERSION, Spring6};

/// Plausible repeatability of a machine, mm: from that of stages for optics to more than any machine has.
const REPEATABILITY_MM: [f64; 2] = [1e-5, 10.0];

/// The mechanism, or `None` with errors in `findings`; looked at for what is implausible.
pub(crate) fn assemble(document: &Document, findings: &mut Findings) -> Option<Mechanism> {
    let mechanism = mechanism_of(document, findings)?;
    check_plausibility(document, &mechanism, &mut findings.warnings);
    Some(mechanism)
}

/// The mechanism, or `None` with errors in `findings`.
pub(crate) fn mechanism_of(document: &Document, findings: &mut Findings) -> Option<Mechanism> {
    let root = KeyPath::root();
    if document.schema != SCHEMA_VERSION {
        findings.error(
            &root.key("schema"),
            format!(
                "this is version {} of the format; version {SCHEMA_VERSION} is read here",
                document.schema
            ),
            "use the program that wrote the file, or convert the file",
        );
        return None;
    }
    name(
        &root.key("mechanism").key("name"),
        &document.mechanism.name,
        findings,
    );
    workspace(document, findings);
    for axis in rotary_axes(document) {
        findings.keep(axis);
    }
    findings.keep(damping(document));
    let [least, most] = REPEATABILITY_MM;
    let repeats = document.mechanism.repeatability_mm;
    if let Some(mm) = repeats.filter(|mm| !(least..=most).contains(mm)) {
        findings.error(
            &root.key("mechanism").key("repeatability_mm"),
            format!("the repeatability is {mm} mm, {least} to {most} mm are possible"),
            "write the figure of the data sheet in mm, or leave the key out: arms repeat within 0.02 to 0.2 mm, machine tools within 0.001 to 0.01 mm",
        );
    }
    let elastic = Elastic::new(document, &mut findings.errors, &mut findings.warnings);
    let platforms = platforms(document, findings);
    let templates: BTreeMap<&str, Option<Template>> = document
        .chain
        .keys()
        .map(|key| (key.as_str(), template(document, key, &elastic, findings)))
        .collect();
    let limbs = limbs(document, &templates, findings);
    let platform_loads = platform_loads(document, findings);
    weights(document, findings);
    unused(document, findings);
    if findings.incomplete || !findings.errors.is_empty() {
        return None;
    }
    let gravity = Vector3::from(document.mechanism.gravity_m_per_s2.unwrap_or_default());
    let mut builder = Mechanism::builder(document.mechanism.name.as_str()).gravity(gravity);
    for platform in platforms {
        builder.platform(platform);
    }
    for (limb, loads) in limbs {
        let name = limb.name.clone();
        builder = builder.limb(limb);
        for load in loads {
            builder = builder.load(name.as_str(), load);
        }
    }
    for load in platform_loads {
        builder = builder.platform_load(load);
    }
    findings.keep(builder.build().map_err(|e| {
        Finding::new(
            &root.key("mechanism"),
            e.to_string(),
            "correct the description of the machine",
        )
    }))
}

fn workspace(document: &Document, findings: &mut Findings) {
    if let Some((from, to)) = findings.keep(corners(document)).flatten()
        && (0..3).all(|i| from[i] == to[i])
    {
        findings.error(
            &KeyPath::root().key("workspace"),
            "the workspace is a single point",
            "write two opposite corners",
        );
    }
}

/// Masses without gravity are a question, not a default.
fn weights(document: &Document, findings: &mut Findings) {
    if document.mechanism.gravity_m_per_s2.is_some() {
        return;
    }
    let root = KeyPath::root();
    let on_platform = document
        .platform
        .iter()
        .position(|p| p.mass_kg.is_some_and(|m| m > 0.0))
        .map(|i| root.key("platform").index(i).key("mass_kg"));
    let in_chain = document.chain.iter().find_map(|(key, chain)| {
        let heavy = |e: &Element| matches!(e, Element::Body(b) if b.mass_kg > 0.0);
        let i = chain.elements.iter().position(heavy)?;
        Some(
            root.key("chain")
                .key(key)
                .key("elements")
                .index(i)
                .key("mass_kg"),
        )
    });
    if let Some(place) = on_platform.or(in_chain) {
        findings.error(
            &place,
            "there is a mass, but gravity is not given",
            "write gravity_m_per_s2 = [0, 0, -9.81] under [mechanism] (base axes), or [0, 0, 0] to leave the weights out",
        );
    }
}

/// Tables that nothing refers to are usually a misspelt name.
fn unused(document: &Document, findings: &mut Findings) {
    let elements = || document.chain.values().flat_map(|c| &c.elements);
    let mut names: BTreeSet<&str> = BTreeSet::new();
    let inline = elements().filter_map(|e| match e {
        Element::Spring6(s) => match &s.spring6 {
            Spring6::Inline(inline) => inline.section.as_deref(),
            Spring6::Named(name) => Some(name.as_str()),
        },
        Element::Link(l) => Some(l.link.as_str()),
        Element::Parallelogram(p) => Some(p.parallelogram.as_str()),
        _ => None,
    });
    names.extend(inline);
    names.extend(
        document
            .stiffness
            .values()
            .filter_map(|s| s.section.as_deref()),
    );
    let used_chains: BTreeSet<&str> = document.limb.iter().map(|l| l.chain.as_str()).collect();
    let tables = [
        (
            "section",
            document.section.keys().collect::<Vec<_>>(),
            &names,
        ),
        ("stiffness", document.stiffness.keys().collect(), &names),
        ("chain", document.chain.keys().collect(), &used_chains),
    ];
    for (table, keys, used) in tables {
        for key in keys.into_iter().filter(|k| !used.contains(k.as_str())) {
            findings.warnings.push(Finding::new(
                &KeyPath::root().key(table).key(key),
                format!("nothing uses the {table} '{key}'"),
                "remove it, or correct the name where it should be used",
            ));
        }
    }
}
