//! Loads on limbs and platforms: from what is written to the core's.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::{Anchor, Chain, LengthLaw, Load, PlatformLoad, Wrench};
use nalgebra::Vector3;

use crate::assembly::platform::platform_index;
use crate::assembly::template::Template;
use crate::elements::part::Part;
use crate::elements::quantity::{MM, ReadResult, choice, choices, need, positive, vector};
use crate::findings::{Findings, name};
use crate::problem::{Finding, KeyPath};
use crate::schema::load::End;
use crate::schema::{
    self, ChainTable, Document, Element, GasSpringLoad, LimbTable, LoadTable, PlatformAxes,
    PlatformLoadTable, PlatformPoint, SpringLoad, WrenchAxes,
};
use crate::text::hints::unknown;

/// The machine's fixed base as a place for the end of a spring.
const BASE: &str = "base";

/// Places of a chain that loads refer to by the name of an element: index of the element, name.
/// Nodes and bodies need none. Names that do not exist are reported; `None` then.
pub(crate) fn named_places(
    place: &KeyPath,
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
    place: &KeyPath,
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

/// The loads on platforms; what is wrong is reported.
pub(crate) fn platform_loads(document: &Document, findings: &mut Findings) -> Vec<PlatformLoad> {
    let mut seen = BTreeSet::new();
    let mut list = Vec::new();
    for (i, load) in document.load.iter().enumerate() {
        let place = KeyPath::root().key("load").index(i);
        name(&place.key(load.word()), load.name(), findings);
        if !seen.insert(load.name()) {
            findings.error(
                &place.key(load.word()),
                format!("there is a load '{}' on platforms already", load.name()),
                "rename one of them",
            );
        }
        let places = load.places();
        let mut own = Vec::new();
        for (keys, target) in &places {
            let at = keys.iter().fold(place.clone(), |p, key| p.key(key));
            own.extend(platform_index(document, &at, target, findings));
        }
        match own.as_slice() {
            [0] if places.len() == 1 => {
                findings.error(
                    &place.key("platform"),
                    format!(
                        "the load '{}' acts on the base, which does not move",
                        load.name()
                    ),
                    "name a moving platform",
                );
            }
            [from, to] if from == to => {
                findings.error(
                    &place,
                    format!(
                        "the load '{}' begins and ends at '{}', so that it does nothing",
                        load.name(),
                        places[0].1
                    ),
                    "name two platforms, or write it under the limb whose nodes it joins",
                );
            }
            _ if own.len() == places.len() => {
                list.extend(findings.keep(on_platforms(&place, load, &own)));
            }
            _ => {}
        }
    }
    list
}

/// The load between or on platforms of these indices.
fn on_platforms(
    place: &KeyPath,
    load: &PlatformLoadTable,
    own: &[usize],
) -> ReadResult<PlatformLoad> {
    let end = |k: usize, key: &str, written: &PlatformPoint| {
        Ok(Anchor::on_platform(
            own[k],
            point(&place.key(key), written)?,
        ))
    };
    let between = |from: &PlatformPoint, to: &PlatformPoint, law| {
        Ok(PlatformLoad::strut(
            end(0, "from", from)?,
            end(1, "to", to)?,
            law,
        ))
    };
    match load {
        PlatformLoadTable::Wrench(l) => {
            let at = PlatformPoint {
                platform: l.platform.clone(),
                position_mm: l.position_mm,
                position_m: l.position_m,
            };
            Ok(PlatformLoad::Wrench {
                platform: own[0],
                point: point(place, &at)?,
                wrench: wrench(place, l.force_n, l.moment_n_m, l.moment_n_mm)?,
                turns: l.axes == PlatformAxes::Platform,
            })
        }
        PlatformLoadTable::Spring(l) => between(&l.from, &l.to, spring_law(place, l)?),
        PlatformLoadTable::GasSpring(l) => between(&l.from, &l.to, gas_law(place, l)?),
        PlatformLoadTable::ConstantTension(l) => between(
            &l.from,
            &l.to,
            LengthLaw::Constant {
                tension: l.tension_n,
            },
        ),
    }
}

fn wrench(
    place: &KeyPath,
    force_n: Option<[f64; 3]>,
    moment_n_m: Option<[f64; 3]>,
    moment_n_mm: Option<[f64; 3]>,
) -> ReadResult<Wrench> {
    let moment = vector(
        place,
        "moment",
        &[
            choice("moment_n_m", moment_n_m, 1.0),
            choice("moment_n_mm", moment_n_mm, MM),
        ],
    )?;
    let force = vector(place, "force", &[choice("force_n", force_n, 1.0)])?;
    if force_n.is_none() && moment_n_m.is_none() && moment_n_mm.is_none() {
        return Err(Finding::new(
            place,
            "the wrench has neither force nor moment",
            "write force_n, moment_n_m or moment_n_mm",
        ));
    }
    Ok(Wrench::new(force, moment))
}

fn spring_law<A>(place: &KeyPath, l: &SpringLoad<A>) -> ReadResult<LengthLaw> {
    let stiffness = choices!(l, (stiffness_n_per_m, 1.0), (stiffness_n_per_mm, 1.0 / MM));
    let free = choices!(l, (free_length_mm, MM), (free_length_m, 1.0));
    let free = need(place, "free length", &free)?;
    if free.value < 0.0 {
        return Err(Finding::new(
            &place.key(free.key),
            format!("the free length is {} m, which is below zero", free.value),
            "a spring that pulls even at length zero has free length 0 and a preload",
        ));
    }
    Ok(LengthLaw::Linear {
        stiffness: positive(place, "stiffness", &stiffness)?.value,
        free_length: free.value,
        preload: l.preload_n.unwrap_or(0.0),
    })
}

fn gas_law<A>(place: &KeyPath, l: &GasSpringLoad<A>) -> ReadResult<LengthLaw> {
    let length = choices!(l, (length_mm, MM), (length_m, 1.0));
    let column = choices!(l, (column_mm, MM), (column_m, 1.0));
    let given = |key, what, value| positive(place, what, &[choice(key, Some(value), 1.0)]);
    Ok(LengthLaw::Gas {
        force: given("force_n", "push", l.force_n)?.value,
        length: positive(place, "length", &length)?.value,
        column: positive(place, "column of gas", &column)?.value,
        exponent: given("exponent", "exponent", l.exponent)?.value,
    })
}

fn converted(
    place: &KeyPath,
    load: &LoadTable,
    chain: &Chain,
    gravity: Option<Vector3<f64>>,
) -> ReadResult<Load> {
    let anchor = |key: &str, written: &schema::Anchor| anchor(&place.key(key), written, chain);
    let between = |from: &schema::Anchor, to: &schema::Anchor, law| {
        Ok(Load::strut(anchor("from", from)?, anchor("to", to)?, law))
    };
    match load {
        LoadTable::Wrench(l) => {
            let node = node(&place.key("node"), &l.node, chain)?;
            let wrench = wrench(place, l.force_n, l.moment_n_m, l.moment_n_mm)?;
            Ok(match l.axes {
                WrenchAxes::Base => Load::dead(node, wrench),
                WrenchAxes::Node => Load::follower(node, wrench),
            })
        }
        LoadTable::Spring(l) => between(&l.from, &l.to, spring_law(place, l)?),
        LoadTable::GasSpring(l) => between(&l.from, &l.to, gas_law(place, l)?),
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

fn node(place: &KeyPath, name: &str, chain: &Chain) -> ReadResult<usize> {
    let unknown = |e: kinetostat::Error| {
        Finding::new(place, e.to_string(), "name a node of the limb's chain")
    };
    chain.node(name).map_err(unknown)
}

fn point(place: &KeyPath, end: &impl End) -> ReadResult<Vector3<f64>> {
    let (_, mm, m) = end.written();
    let written = [choice("position_mm", mm, MM), choice("position_m", m, 1.0)];
    vector(place, "position", &written)
}

fn anchor(place: &KeyPath, written: &schema::Anchor, chain: &Chain) -> ReadResult<Anchor> {
    let point = point(place, written)?;
    // A chain may have a node of that name; the limb's own comes first.
    if written.node == BASE && !chain.nodes().iter().any(|n| n == BASE) {
        return Ok(Anchor::Base(point));
    }
    let node = node(&place.key("node"), &written.node, chain)?;
    Ok(Anchor::Node { node, point })
}
