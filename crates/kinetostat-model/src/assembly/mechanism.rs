//! Assembles the mechanism from the document: the only module that knows the schema and the core's builder. Every
//! mistake found on the way is kept with its place, so that one run shows them all.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::{Chain, Limb, Load, Mechanism, Pose};
use nalgebra::Vector3;

use crate::assembly::deviation::{AsBuilt, Own, as_built, deviations};
use crate::assembly::load::{loads, named_places, platform_loads};
use crate::assembly::platform::{platform_index, platforms};
use crate::assembly::template::{Template, template};
use crate::elements::damping::damping;
use crate::elements::elastic::Elastic;
use crate::elements::part::Part;
use crate::elements::placement::{corners, pose};
use crate::elements::rotary::rotary_axes;
use crate::findings::{Findings, name};
use crate::plausibility::home::check_plausibility;
use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, Element, LimbTable, SCHEMA_VERSION, Spring6};
use crate::text::hints::unknown;

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

/// Larger models are refused before anything of their size is allocated.
const MOST_PARTS: usize = 20_000;

fn limbs(
    document: &Document,
    templates: &BTreeMap<&str, Option<Template>>,
    findings: &mut Findings,
) -> Vec<(Limb, Vec<Load>)> {
    let mut deviations = deviations(document, findings);
    let mut seen = BTreeSet::new();
    let mut size = 0;
    let mut limbs = Vec::new();
    for (i, written) in document.limb.iter().enumerate() {
        let place = KeyPath::root().key("limb").index(i);
        name(&place.key("name"), &written.name, findings);
        if !seen.insert(written.name.as_str()) {
            findings.error(
                &place.key("name"),
                format!("the limb '{}' exists already", written.name),
                "rename one of them",
            );
        }
        let own = deviations.remove(&i).unwrap_or_default();
        let template = match templates.get(written.chain.as_str()) {
            Some(template) => template.as_ref(),
            None => {
                let known: Vec<&str> = templates.keys().copied().collect();
                findings.errors.push(unknown(
                    &place.key("chain"),
                    "chain",
                    &written.chain,
                    &known,
                    "write a table [chain.NAME]",
                ));
                None
            }
        };
        size += template.map_or(0, |t| t.parts.len());
        if size > MOST_PARTS {
            findings.error(
                &place,
                format!("the limbs have more than {MOST_PARTS} elements in all"),
                "use fewer limbs or shorter chains",
            );
            break;
        }
        limbs.extend(limb(document, &place, written, template, &own, findings));
    }
    limbs
}

fn limb(
    document: &Document,
    place: &KeyPath,
    written: &LimbTable,
    template: Option<&Template>,
    own: &Own<'_>,
    findings: &mut Findings,
) -> Option<(Limb, Vec<Load>)> {
    let from = platform_index(document, &place.key("from"), &written.from, findings);
    let to = platform_index(document, &place.key("to"), &written.to, findings);
    if to == Some(0) {
        findings.error(
            &place.key("to"),
            "a limb cannot end at the base",
            "write it from the base to the moving platform",
        );
    } else if from.is_some() && from == to {
        findings.error(
            &place.key("to"),
            format!("the limb begins and ends at '{}'", written.to),
            "a limb joins two different platforms",
        );
    }
    let mut placed = |key, placement: &Option<_>| match placement {
        Some(p) => findings.keep(pose(&place.key(key), p)),
        None => Some(Pose::identity()),
    };
    let start = placed("start", &written.start);
    let end = placed("end", &written.end);
    let template = template?;
    let built = findings.keep(as_built(own, &template.parts))?;
    let table = document.chain.get(&written.chain)?;
    let places = named_places(place, written, table, template, findings);
    let (start, end, places) = (start?, end?, places?);
    let mut build = |actual: bool| {
        let chain = chain(&written.name, template, &built, actual, &start, &places);
        chain
            .map_err(|e| findings.errors.push(locate(&e, &written.chain, document)))
            .ok()
    };
    let nominal = build(false)?;
    let actual = match own.is_empty() {
        true => nominal.clone(),
        false => build(true)?,
    };
    let gravity = document.mechanism.gravity_m_per_s2.map(Vector3::from);
    let loads = loads(place, written, &actual, gravity, findings);
    let limb = Limb::between(written.name.clone(), from?, to?, nominal)
        .with_actual(actual)
        .fixed_at(end);
    Some((limb, loads))
}

/// The chain as the core knows it. Nominal and actual chain have the same elements in the same
/// order, whatever the deviations. `places` are the elements behind which loads act.
fn chain(
    name: &str,
    template: &Template,
    built: &AsBuilt,
    actual: bool,
    start: &Pose,
    places: &BTreeMap<usize, String>,
) -> kinetostat::Result<Chain> {
    let mut builder = Chain::builder(name);
    if *start != Pose::identity() || built.start.is_some() {
        let part = Part::Rigid(None, *start);
        builder = part.add(builder, built.start.as_ref().filter(|_| actual));
    }
    for (k, (element, part)) in template.parts.iter().enumerate() {
        let part = built.instead.get(&k).filter(|_| actual).unwrap_or(part);
        builder = part.add(builder, built.behind.get(&k).filter(|_| actual));
        // Places of loads are behind all that their element is made of.
        let last = template.parts.get(k + 1).is_none_or(|(e, _)| e != element);
        if let Some(name) = places.get(element).filter(|_| last) {
            builder = builder.node(name);
        }
    }
    if let Some(end) = built.end {
        // The tip sits at `end * deviation` of the platform, which is the same as a chain that goes
        // on by the inverse deviation and sits at `end`.
        builder = builder.rigid(if actual {
            end.inverse()
        } else {
            Pose::identity()
        });
    }
    builder.build()
}

/// A refusal of the core, at the element whose name it mentions.
fn locate(error: &kinetostat::Error, chain: &str, document: &Document) -> Finding {
    let text = error.to_string();
    let place = KeyPath::root().key("chain").key(chain);
    let elements = document.chain.get(chain).map(|c| c.elements.as_slice());
    let index = elements.unwrap_or_default().iter().position(|e| {
        e.name()
            .is_some_and(|n| text.contains(&format!("'{n}'")) || text.contains(&format!("'{n}.")))
    });
    let place = match index {
        Some(i) => place.key("elements").index(i),
        None => place,
    };
    Finding::new(&place, text, "correct this element of the chain")
}
