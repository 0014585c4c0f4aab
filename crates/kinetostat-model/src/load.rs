//! Loads on limbs: from what is written to the core's.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::{Anchor, Chain, LengthLaw, Load, Wrench};
use nalgebra::Vector3;

use crate::assemble::{Findings, name};
use crate::elastic::unknown;
use crate::part::Part;
use crate::problem::{Finding, Place};
use crate::quantity::{Found, MM, choice, need, positive, vector};
use crate::schema::{self, ChainTable, Element, LimbTable, LoadTable, WrenchAxes};
use crate::template::Template;

/// The machine's fixed base as a place for the end of a spring.
const BASE: &str = "base";

/// Places of a chain that loads refer to by the name of an element: index of the element, name.
/// Nodes and bodies need none. Names that do not exist are reported; `None` then.
pub(crate) fn named_places(
    place: &Place,
    written: &LimbTable,
    chain: &ChainTable,
    template: &Template,
    findings: &mut Findings,
) -> Option<BTreeMap<usize, String>> {
    let nodes: BTreeSet<&str> = std::iter::once("tip")
        .chain(template.parts.iter().filter_map(|(_, p)| match p {
            Part::Node(name) | Part::Body(name, ..) => Some(name.as_str()),
            _ => None,
        }))
        .collect();
    let elements: BTreeMap<&str, usize> = chain
        .elements
        .iter()
        .enumerate()
        .filter(|(_, e)| !matches!(e, Element::Node(_) | Element::Body(_)))
        .filter_map(|(i, e)| Some((e.name()?, i)))
        .collect();
    let mut named = BTreeMap::new();
    let mut seen = BTreeSet::new();
    let mut complete = true;
    for (i, load) in written.load.iter().enumerate() {
        let place = place.key("load").index(i);
        name(&place.key(load.word()), load.name(), findings);
        if !seen.insert(load.name()) {
            findings.error(
                &place.key(load.word()),
                format!("the limb has a load '{}' already", load.name()),
                "rename one of them",
            );
        }
        let places = load.places();
        if places.len() == 2 && places.iter().all(|p| p.1 == BASE) && !nodes.contains(BASE) {
            findings.error(
                &place,
                format!("the load '{}' begins and ends at the base", load.name()),
                "name a node of the limb at one end",
            );
            complete = false;
        }
        for (keys, target) in &places {
            let at = keys.iter().fold(place.clone(), |p, key| p.key(key));
            if nodes.contains(target) {
                continue;
            }
            if *target == BASE {
                if places.len() == 1 {
                    findings.error(
                        &at,
                        format!(
                            "the load '{}' acts on the base, which does not move",
                            load.name()
                        ),
                        "name a node of the limb",
                    );
                    complete = false;
                }
            } else if let Some(element) = elements.get(target) {
                named.insert(*element, (*target).to_owned());
            } else {
                let known: BTreeSet<&str> = nodes
                    .iter()
                    .copied()
                    .chain(elements.keys().copied())
                    .chain([BASE])
                    .collect();
                let known: Vec<&str> = known.into_iter().collect();
                findings.errors.push(unknown(
                    &at,
                    "node or element",
                    target,
                    &known,
                    "name the element of the chain, or write { node = \"NAME\" } behind it",
                ));
                complete = false;
            }
        }
    }
    complete.then_some(named)
}

/// The loads of a limb; what is wrong is reported.
pub(crate) fn loads(
    place: &Place,
    written: &LimbTable,
    chain: &Chain,
    gravity: Option<Vector3<f64>>,
    findings: &mut Findings,
) -> Vec<Load> {
    let list = written.load.iter().enumerate();
    list.filter_map(|(i, load)| {
        let place = place.key("load").index(i);
        findings.keep(converted(&place, load, chain, gravity))
    })
    .collect()
}

fn converted(
    place: &Place,
    load: &LoadTable,
    chain: &Chain,
    gravity: Option<Vector3<f64>>,
) -> Found<Load> {
    let anchor = |key: &str, written: &schema::Anchor| anchor(&place.key(key), written, chain);
    let between = |from: &schema::Anchor, to: &schema::Anchor, law| {
        Ok(Load::strut(anchor("from", from)?, anchor("to", to)?, law))
    };
    match load {
        LoadTable::Wrench(l) => {
            let node = node(&place.key("node"), &l.node, chain)?;
            let moment = vector(
                place,
                "moment",
                &[
                    choice("moment_n_m", l.moment_n_m, 1.0),
                    choice("moment_n_mm", l.moment_n_mm, MM),
                ],
            )?;
            let force = vector(place, "force", &[choice("force_n", l.force_n, 1.0)])?;
            if l.force_n.is_none() && l.moment_n_m.is_none() && l.moment_n_mm.is_none() {
                return Err(Finding::new(
                    place,
                    "the wrench has neither force nor moment",
                    "write force_n, moment_n_m or moment_n_mm",
                ));
            }
            let wrench = Wrench::new(force, moment);
            Ok(match l.axes {
                WrenchAxes::Base => Load::dead(node, wrench),
                WrenchAxes::Node => Load::follower(node, wrench),
            })
        }
        LoadTable::Spring(l) => {
            let stiffness = [
                choice("stiffness_n_per_m", l.stiffness_n_per_m, 1.0),
                choice("stiffness_n_per_mm", l.stiffness_n_per_mm, 1.0 / MM),
            ];
            let free = [
                choice("free_length_mm", l.free_length_mm, MM),
                choice("free_length_m", l.free_length_m, 1.0),
            ];
            let free = need(place, "free length", &free)?;
            if free.value < 0.0 {
                return Err(Finding::new(
                    &place.key(free.key),
                    format!("the free length is {} m, which is below zero", free.value),
                    "a spring that pulls even at length zero has free length 0 and a preload",
                ));
            }
            let law = LengthLaw::Linear {
                stiffness: positive(place, "stiffness", &stiffness)?.value,
                free_length: free.value,
                preload: l.preload_n.unwrap_or(0.0),
            };
            between(&l.from, &l.to, law)
        }
        LoadTable::GasSpring(l) => {
            let length = [
                choice("length_mm", l.length_mm, MM),
                choice("length_m", l.length_m, 1.0),
            ];
            let column = [
                choice("column_mm", l.column_mm, MM),
                choice("column_m", l.column_m, 1.0),
            ];
            let given = |key, what, value| positive(place, what, &[choice(key, Some(value), 1.0)]);
            let law = LengthLaw::Gas {
                force: given("force_n", "push", l.force_n)?.value,
                length: positive(place, "length", &length)?.value,
                column: positive(place, "column of gas", &column)?.value,
                exponent: given("exponent", "exponent", l.exponent)?.value,
            };
            between(&l.from, &l.to, law)
        }
        LoadTable::ConstantTension(l) => between(
            &l.from,
            &l.to,
            LengthLaw::Constant {
                tension: l.tension_n,
            },
        ),
        LoadTable::Counterweight(l) => {
            let mass = positive(place, "mass", &[choice("mass_kg", Some(l.mass_kg), 1.0)])?.value;
            let Some(gravity) = gravity else {
                return Err(Finding::new(
                    &place.key("mass_kg"),
                    "there is a counterweight, but gravity is not given",
                    "write gravity_m_per_s2 = [0, 0, -9.81] under [mechanism] (base axes)",
                ));
            };
            let node = node(&place.key("at").key("node"), &l.at.node, chain)?;
            let point = point(&place.key("at"), &l.at)?;
            Ok(Load::counterweight(node, point, mass, gravity))
        }
    }
}

fn node(place: &Place, name: &str, chain: &Chain) -> Found<usize> {
    let unknown = |e: kinetostat::Error| {
        Finding::new(place, e.to_string(), "name a node of the limb's chain")
    };
    chain.node(name).map_err(unknown)
}

fn point(place: &Place, anchor: &schema::Anchor) -> Found<Vector3<f64>> {
    let written = [
        choice("position_mm", anchor.position_mm, MM),
        choice("position_m", anchor.position_m, 1.0),
    ];
    vector(place, "position", &written)
}

fn anchor(place: &Place, written: &schema::Anchor, chain: &Chain) -> Found<Anchor> {
    let point = point(place, written)?;
    // A chain may have a node of that name; the limb's own comes first.
    if written.node == BASE && !chain.nodes().iter().any(|n| n == BASE) {
        return Ok(Anchor::Base(point));
    }
    let node = node(&place.key("node"), &written.node, chain)?;
    Ok(Anchor::Node { node, point })
}
