//! From the document to the mechanism: the only module that knows the schema and the core's
//! builder. Every mistake found on the way is kept with its place, so that one run shows them all.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use kinetostat::{Chain, Limb, Mechanism, Platform, Pose};
use nalgebra::Vector3;

use crate::elastic::{Elastic, unknown};
use crate::part::{Part, inertia, mass, parts};
use crate::placement::pose;
use crate::plausible;
use crate::problem::{Finding, Place};
use crate::quantity::{MM, choice, need, vector};
use crate::schema::{Document, Element, LimbTable, SCHEMA_VERSION, Spring6};

/// Larger models are refused before anything of their size is allocated.
const MOST_PARTS: usize = 20_000;
const MOST_COORDINATES: usize = 1_000;

/// What went wrong and what looks wrong.
#[derive(Default)]
pub(crate) struct Findings {
    pub(crate) errors: Vec<Finding>,
    pub(crate) warnings: Vec<Finding>,
}

impl Findings {
    fn error(&mut self, place: &Place, message: impl Into<String>, help: impl Into<String>) {
        self.errors.push(Finding::new(place, message, help));
    }

    /// The value, or `None` with the reason kept.
    fn keep<T>(&mut self, result: Result<T, Finding>) -> Option<T> {
        result.map_err(|f| self.errors.push(f)).ok()
    }
}

/// A chain's parts, each with the index of the element it came from.
struct Template {
    parts: Vec<(usize, Part)>,
}

/// The mechanism, or `None` with errors in `findings`.
pub(crate) fn assemble(document: &Document, findings: &mut Findings) -> Option<Mechanism> {
    let root = Place::root();
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
    let elastic = Elastic::new(document, &mut findings.errors, &mut findings.warnings);
    let platforms = platforms(document, findings);
    let templates: BTreeMap<&str, Option<Template>> = document
        .chain
        .keys()
        .map(|key| (key.as_str(), template(document, key, &elastic, findings)))
        .collect();
    let limbs = limbs(document, &templates, findings);
    weights(document, findings);
    unused(document, findings);
    if !findings.errors.is_empty() {
        return None;
    }
    let gravity = Vector3::from(document.mechanism.gravity_m_per_s2.unwrap_or_default());
    let mut builder = Mechanism::builder(document.mechanism.name.as_str()).gravity(gravity);
    for platform in platforms {
        builder.platform(platform);
    }
    for limb in limbs {
        builder = builder.limb(limb);
    }
    let mechanism = findings.keep(builder.build().map_err(|e| {
        Finding::new(
            &root.key("mechanism"),
            e.to_string(),
            "correct the description of the machine",
        )
    }))?;
    plausible::check(&mechanism, &mut findings.warnings);
    Some(mechanism)
}

fn name(place: &Place, text: &str, findings: &mut Findings) {
    let reason = if text.trim().is_empty() {
        "the name is empty"
    } else if text.trim() != text {
        "the name begins or ends with a space"
    } else if text.chars().any(char::is_control) {
        "the name holds a control character"
    } else if text.chars().count() > 100 {
        "the name is longer than 100 characters"
    } else {
        return;
    };
    findings.error(place, reason, "write a short name in plain text");
}

fn workspace(document: &Document, findings: &mut Findings) {
    if let Some((from, to)) = findings.keep(corners(document)).flatten()
        && (0..3).any(|i| from[i] == to[i])
    {
        findings.error(
            &Place::root().key("workspace"),
            "the workspace has no volume",
            "write two opposite corners",
        );
    }
}

/// The workspace's corners, m.
pub(crate) fn corners(
    document: &Document,
) -> Result<Option<(Vector3<f64>, Vector3<f64>)>, Finding> {
    let Some(w) = &document.workspace else {
        return Ok(None);
    };
    let place = Place::root().key("workspace");
    let from = [
        choice("corner_mm", w.corner_mm, MM),
        choice("corner_m", w.corner_m, 1.0),
    ];
    let to = [
        choice("opposite_corner_mm", w.opposite_corner_mm, MM),
        choice("opposite_corner_m", w.opposite_corner_m, 1.0),
    ];
    let from = need(&place, "corner", &from)?.value;
    let to = need(&place, "opposite corner", &to)?.value;
    Ok(Some((from.into(), to.into())))
}

fn platforms(document: &Document, findings: &mut Findings) -> Vec<Platform> {
    let mut seen = HashSet::from(["base"]);
    let mut platforms = Vec::new();
    for (i, p) in document.platform.iter().enumerate() {
        let place = Place::root().key("platform").index(i);
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
        let centre = [
            choice("centre_of_mass_mm", p.centre_of_mass_mm, MM),
            choice("centre_of_mass_m", p.centre_of_mass_m, 1.0),
        ];
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
        if !document.limb.iter().any(held) {
            findings.error(
                &place.key("name"),
                format!("no limb holds the platform '{}'", p.name),
                format!("write a [[limb]] with to = \"{}\"", p.name),
            );
        }
    }
    platforms
}

fn template(
    document: &Document,
    key: &str,
    elastic: &Elastic,
    findings: &mut Findings,
) -> Option<Template> {
    let chain = document.chain.get(key)?;
    let place = Place::root().key("chain").key(key);
    name(&place, key, findings);
    let elements = place.key("elements");
    let mut template = Template { parts: Vec::new() };
    let mut names = Names::default();
    let mut complete = true;
    for (i, element) in chain.elements.iter().enumerate() {
        let place = elements.index(i);
        names.take(&place, element, findings);
        let made = match parts(&place, i + 1, element, elastic) {
            Ok(made) => made,
            Err(reason) => {
                findings.errors.extend(reason);
                complete = false;
                continue;
            }
        };
        for part in made {
            complete &= names.coordinates(&place, element, &part, findings);
            template.parts.push((i, part));
        }
    }
    if names.count > MOST_COORDINATES {
        findings.error(
            &place,
            format!(
                "the chain has {} joints and springs, at most {MOST_COORDINATES} are read",
                names.count
            ),
            "use fewer elements",
        );
        return None;
    }
    complete.then_some(template)
}

/// Names that are taken in one chain.
#[derive(Default)]
struct Names {
    coordinates: BTreeSet<String>,
    nodes: BTreeSet<String>,
    offsets: BTreeSet<String>,
    count: usize,
}

impl Names {
    fn take(&mut self, place: &Place, element: &Element, findings: &mut Findings) {
        let Some(given) = element.name() else {
            return;
        };
        let (taken, key, own) = match element {
            Element::Node(_) => (&mut self.nodes, "node", given == "tip"),
            Element::Body(_) => (&mut self.nodes, "body", given == "tip"),
            Element::Rigid(_) | Element::Link(_) => {
                (&mut self.offsets, "name", ["start", "end"].contains(&given))
            }
            _ => return name(&place.key("name"), given, findings),
        };
        let place = place.key(key);
        name(&place, given, findings);
        if own || !taken.insert(given.to_owned()) {
            let message = match own {
                true => format!("the name '{given}' is taken"),
                false => format!("the name '{given}' is used twice in this chain"),
            };
            findings.error(&place, message, "choose another name");
        }
    }

    /// False where the core would refuse the part.
    fn coordinates(
        &mut self,
        place: &Place,
        element: &Element,
        part: &Part,
        findings: &mut Findings,
    ) -> bool {
        if let Part::Coupled(to, ..) = part
            && !self.coordinates.contains(to)
        {
            let known: Vec<&str> = self.coordinates.iter().map(String::as_str).collect();
            findings.errors.push(unknown(
                &place.key("coupled"),
                "coordinate before this element",
                to,
                &known,
                "write the joint before the motion that follows it",
            ));
            return false;
        }
        let made = part.coordinates();
        self.count += made.len();
        let twice = made.iter().find(|c| self.coordinates.contains(*c));
        if let Some(twice) = twice {
            let at = match element.name() {
                Some(_) => place.key("name"),
                None => place.clone(),
            };
            findings.error(
                &at,
                format!("the name '{twice}' is used twice in this chain"),
                "choose another name",
            );
            return false;
        }
        self.coordinates.extend(made);
        true
    }
}

fn limbs(
    document: &Document,
    templates: &BTreeMap<&str, Option<Template>>,
    findings: &mut Findings,
) -> Vec<Limb> {
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
) -> Option<Limb> {
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
    let (start, end) = (start?, end?);
    let mut build = |actual: bool| {
        let chain = chain(&written.name, template, own, actual.then_some(()), &start);
        chain
            .map_err(|e| findings.errors.push(locate(&e, &written.chain, document)))
            .ok()
    };
    let nominal = build(false)?;
    let actual = match own.is_empty() {
        true => nominal.clone(),
        false => build(true)?,
    };
    Some(Limb {
        name: written.name.clone(),
        from: from?,
        to: to?,
        platform_from_tip: end,
        nominal,
        actual,
    })
}

/// The chain as the core knows it. Nominal and actual chain have the same elements in the same
/// order, whatever the deviations.
fn chain(
    name: &str,
    template: &Template,
    own: &BTreeMap<&str, (Place, Pose)>,
    actual: Option<()>,
    start: &Pose,
) -> kinetostat::Result<Chain> {
    let deviation = |at: &str| actual.and_then(|()| own.get(at)).map(|(_, pose)| pose);
    let mut builder = Chain::builder(name);
    if *start != Pose::identity() || own.contains_key("start") {
        let part = Part::Rigid(None, *start);
        builder = part.add(builder, deviation("start"));
    }
    for (_, part) in &template.parts {
        let moved = match part {
            Part::Rigid(Some(name), _) => deviation(name),
            _ => None,
        };
        builder = part.add(builder, moved);
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

/// Masses without gravity are a question, not a default.
fn weights(document: &Document, findings: &mut Findings) {
    if document.mechanism.gravity_m_per_s2.is_some() {
        return;
    }
    let root = Place::root();
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
    let mut names: HashSet<&str> = HashSet::new();
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
    let used_chains: HashSet<&str> = document.limb.iter().map(|l| l.chain.as_str()).collect();
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
                &Place::root().key(table).key(key),
                format!("nothing uses the {table} '{key}'"),
                "remove it, or correct the name where it should be used",
            ));
        }
    }
}
