//! Limbs: chains between platforms, as drawn and as built.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::{Chain, Limb, Load, Pose};
use nalgebra::Vector3;

use crate::assembly::deviation::{AsBuilt, Own, as_built, deviations};
use crate::assembly::load::{loads, named_places};
use crate::assembly::platform::platform_index;
use crate::assembly::template::Template;
use crate::elements::part::Part;
use crate::elements::placement::pose;
use crate::findings::{Findings, name};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, LimbTable};
use crate::text::hints::unknown;

/// Larger models are refused before anything of their size is allocated.
const MOST_PARTS: usize = 20_000;

pub(crate) fn limbs(
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
