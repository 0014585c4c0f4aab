//! Limbs: chains between platforms, as drawn and as built.

use std::collections::{BTreeMap, HashSet};

use kinetostat::{Chain, Limb, Load, Pose};
use nalgebra::Vector3;

use crate::assemble::{Findings, name};
use crate::elastic::unknown;
use crate::load::{loads, named_places};
use crate::part::Part;
use crate::placement::pose;
use crate::problem::{Finding, Place};
use crate::schema::{Document, LimbTable};
use crate::template::Template;

/// Larger models are refused before anything of their size is allocated.
const MOST_PARTS: usize = 20_000;

pub(crate) fn limbs(
    document: &Document,
    templates: &BTreeMap<&str, Option<Template>>,
    findings: &mut Findings,
) -> Vec<(Limb, Vec<Load>)> {
    let mut deviations = deviations(document, findings);
    let mut seen = HashSet::new();
    let mut size = 0;
    let mut limbs = Vec::new();
    for (i, written) in document.limb.iter().enumerate() {
        let place = Place::root().key("limb").index(i);
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
    place: &Place,
    written: &LimbTable,
    template: Option<&Template>,
    own: &BTreeMap<&str, (Place, Pose)>,
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
    for (at, (place, _)) in own {
        let named = |p: &Part| matches!(p, Part::Rigid(Some(n), _) if n == at);
        if !["start", "end"].contains(at) && !template.parts.iter().any(|(_, p)| named(p)) {
            let known: Vec<&str> = ["start", "end"]
                .into_iter()
                .chain(template.parts.iter().filter_map(|(_, p)| match p {
                    Part::Rigid(name, _) => name.as_deref(),
                    _ => None,
                }))
                .collect();
            findings.errors.push(unknown(
                &place.key("at"),
                "rigid element or link",
                at,
                &known,
                "name the element that is out of place",
            ));
            return None;
        }
    }
    let table = document.chain.get(&written.chain)?;
    let places = named_places(place, written, table, template, findings);
    let (start, end, places) = (start?, end?, places?);
    let mut build = |actual: bool| {
        let chain = chain(&written.name, template, own, actual, &start, &places);
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
    let limb = Limb {
        name: written.name.clone(),
        from: from?,
        to: to?,
        platform_from_tip: end,
        nominal,
        actual,
    };
    Some((limb, loads))
}

/// The chain as the core knows it. Nominal and actual chain have the same elements in the same
/// order, whatever the deviations. `places` are the elements behind which loads act.
fn chain(
    name: &str,
    template: &Template,
    own: &BTreeMap<&str, (Place, Pose)>,
    actual: bool,
    start: &Pose,
    places: &BTreeMap<usize, String>,
) -> kinetostat::Result<Chain> {
    let deviation = |at: &str| own.get(at).filter(|_| actual).map(|(_, pose)| pose);
    let mut builder = Chain::builder(name);
    if *start != Pose::identity() || own.contains_key("start") {
        let part = Part::Rigid(None, *start);
        builder = part.add(builder, deviation("start"));
    }
    for (k, (element, part)) in template.parts.iter().enumerate() {
        let moved = match part {
            Part::Rigid(Some(name), _) => deviation(name),
            _ => None,
        };
        builder = part.add(builder, moved);
        // Places of loads are behind all that their element is made of.
        let last = template.parts.get(k + 1).is_none_or(|(e, _)| e != element);
        if let Some(name) = places.get(element).filter(|_| last) {
            builder = builder.node(name);
        }
    }
    if own.contains_key("end") {
        // The tip sits at `end * deviation` of the platform, which is the same as a chain that goes
        // on by the inverse deviation and sits at `end`.
        let back = deviation("end").map_or_else(Pose::identity, Pose::inverse);
        builder = builder.rigid(back);
    }
    builder.build()
}

/// A refusal of the core, at the element whose name it mentions.
fn locate(error: &kinetostat::Error, chain: &str, document: &Document) -> Finding {
    let text = error.to_string();
    let place = Place::root().key("chain").key(chain);
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

fn platform_index(
    document: &Document,
    place: &Place,
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

/// Deviations by limb and place in the limb.
fn deviations<'d>(
    document: &'d Document,
    findings: &mut Findings,
) -> BTreeMap<usize, BTreeMap<&'d str, (Place, Pose)>> {
    let mut found: BTreeMap<usize, BTreeMap<&str, (Place, Pose)>> = BTreeMap::new();
    for (i, d) in document.deviation.iter().enumerate() {
        if findings.enough() {
            break;
        }
        let place = Place::root().key("deviation").index(i);
        let motion = findings.keep(pose(&place.key("moved_by"), &d.moved_by));
        let Some(limb) = document.limb.iter().position(|l| l.name == d.limb) else {
            let known: Vec<&str> = document.limb.iter().map(|l| l.name.as_str()).collect();
            findings.errors.push(unknown(
                &place.key("limb"),
                "limb",
                &d.limb,
                &known,
                "write a table [[limb]]",
            ));
            continue;
        };
        let taken = found.entry(limb).or_default();
        if taken.contains_key(d.at.as_str()) {
            findings.error(
                &place.key("at"),
                format!(
                    "the limb '{}' has a deviation at '{}' already",
                    d.limb, d.at
                ),
                "write their product as one deviation",
            );
        } else if let Some(motion) = motion {
            taken.insert(&d.at, (place, motion));
        }
    }
    found
}
