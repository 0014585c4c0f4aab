//! A chain and its elements as its table describes them, converted once however many limbs use it.

use std::collections::BTreeSet;

use crate::elements::elastic::Elastic;
use crate::elements::joint::{actuator, kind, lead, passive, spring};
use crate::elements::link::{link, parallelogram};
use crate::elements::part::{Part, body};
use crate::elements::placement::{direction, pose};
use crate::elements::quantity::{DEG, MM, choices, vector};
use crate::findings::{Findings, name};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, Element, Spring6Element};
use crate::text::hints::unknown;

/// Longer chains are refused before anything of their size is allocated.
const MOST_COORDINATES: usize = 1_000;

/// A chain's parts, each with the index of the element it came from.
pub(crate) struct Template {
    pub(crate) parts: Vec<(usize, Part)>,
}

pub(crate) fn template(
    document: &Document,
    key: &str,
    elastic: &Elastic,
    findings: &mut Findings,
) -> Option<Template> {
    let chain = document.chain.get(key)?;
    let place = KeyPath::root().key("chain").key(key);
    name(&place, key, findings);
    let elements = place.key("elements");
    let mut template = Template { parts: Vec::new() };
    let mut names = Names::default();
    let mut complete = true;
    for (i, element) in chain.elements.iter().enumerate() {
        if findings.enough() {
            return None;
        }
        let place = elements.index(i);
        complete &= names.take(&place, element, findings);
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
    elements: BTreeSet<String>,
    count: usize,
}

impl Names {
    /// False where the core would refuse the name.
    fn take(&mut self, place: &KeyPath, element: &Element, findings: &mut Findings) -> bool {
        let Some(given) = element.name() else {
            return true;
        };
        let (taken, key, own) = match element {
            Element::Node(_) => (&mut self.nodes, "node", given == "tip"),
            Element::Body(_) => (&mut self.nodes, "body", given == "tip"),
            _ => (
                &mut self.elements,
                "name",
                ["start", "end"].contains(&given),
            ),
        };
        let place = place.key(key);
        name(&place, given, findings);
        let free = !own && taken.insert(given.to_owned());
        if !free {
            let message = match own {
                true => format!("the name '{given}' is taken"),
                false => format!("the name '{given}' is used twice in this chain"),
            };
            findings.error(&place, message, "choose another name");
        }
        free
    }

    /// False where the core would refuse the part.
    fn coordinates(
        &mut self,
        place: &KeyPath,
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

/// Everything an element turns into. `Err(None)` where the reason was reported elsewhere.
pub(crate) fn parts(
    place: &KeyPath,
    number: usize,
    element: &Element,
    elastic: &Elastic,
) -> Result<Vec<Part>, Option<Finding>> {
    let name = element.name_or_number(number);
    Ok(match element {
        Element::Rigid(e) => {
            let offset = pose(&place.key("rigid"), &e.rigid)?;
            vec![Part::Rigid(e.name.clone(), offset)]
        }
        Element::Actuator(e) => {
            let spec = actuator(place, e)?;
            vec![match lead(place, e)? {
                Some(lead) => Part::Screw(name, spec, lead),
                None => Part::Actuator(name, spec),
            }]
        }
        Element::Passive(e) => passive(place, name, e)?,
        Element::Spring(e) => vec![spring(place, name, e)?],
        Element::Spring6(e) => vec![spring6(place, name, e, elastic)?],
        Element::Link(e) => link(place, name, e, elastic)?,
        Element::Parallelogram(e) => vec![parallelogram(place, name, e, elastic)?],
        Element::Coupled(e) => vec![Part::Coupled(
            e.coupled.clone(),
            kind(e.motion),
            direction(&place.key("axis"), &e.axis)?.into_inner(),
            e.ratio,
        )],
        Element::Node(e) => vec![Part::Node(e.node.clone())],
        Element::Body(e) => vec![body(place, e)?],
    })
}

fn spring6(
    place: &KeyPath,
    name: String,
    e: &Spring6Element,
    elastic: &Elastic,
) -> Result<Part, Option<Finding>> {
    let matrix = elastic.spring6(&place.key("spring6"), &e.spring6)?;
    let translation = vector(
        place,
        "translation at rest",
        &choices!(e, (rest_translation_mm, MM), (rest_translation_m, 1.0)),
    )?;
    let rotation = vector(
        place,
        "rotation at rest",
        &choices!(e, (rest_rotation_deg, DEG), (rest_rotation_rad, 1.0)),
    )?;
    let (t, r) = (translation, rotation);
    Ok(Part::Spring6(
        name,
        Box::new(matrix),
        [t.x, t.y, t.z, r.x, r.y, r.z],
    ))
}
