//! Elements of a chain in SI, before a limb gives them their deviations.

use crate::elements::elastic::Elastic;
use crate::elements::joint::{actuator, kind, lead, passive, spring};
use crate::elements::link::{link, parallelogram};
use crate::elements::part::{Part, body};
use crate::elements::placement::{direction, pose};
use crate::elements::quantity::{DEG, MM, choices, vector};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Element, Spring6Element};

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
