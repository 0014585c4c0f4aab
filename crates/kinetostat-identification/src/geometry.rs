//! Errors of the geometry as numbers of a model: where they are, and how they are called.
//!
//! An error is a small motion `[v; w]` behind a rigid element or link, in the frame reached there; a model file has it as a
//! `[[deviation]]`, so that the identified geometry is a model like any other. There is one error before the first joint, one between two
//! joints, and one behind the last joint: `6 (n + 1)` numbers for an arm of `n` joints. The last one is that of the markers as well, so that
//! it is asked for by its path only. Readings of places decide only
//! `6 (n + 1) - 2 R - 4 P` of them for R revolute and P prismatic joints (Everett and Hsu 1988; theory: identification, section 3), see
//! [`crate::gauge`].

use kinetostat_model::schema::Element;
use kinetostat_model::{Model, Parameter};

use crate::error::IdentificationError;

/// Keys of the six numbers of an error, as a deviation that the file does not have yet would have them.
const KEYS: [&str; 2] = ["translation_mm", "rotation_vector_deg"];
/// Letters of the components.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Beginning of the paths of deviations.
pub(crate) const DEVIATION: &str = "deviation.";
/// Beginning of the names of markers.
pub(crate) const MARKER: &str = "marker ";

/// True for the name of an error or of the place of a marker.
pub(crate) fn is_geometry(name: &str) -> bool {
    name.starts_with(DEVIATION) || name.starts_with(MARKER)
}

/// Paths of the errors of all limbs in front of their last joints; `all` are the numbers that the file has.
pub(crate) fn error_paths(
    model: &Model,
    all: &[Parameter],
) -> Result<Vec<String>, IdentificationError> {
    let mut paths = Vec::new();
    for limb in &model.document.limb {
        let Some(chain) = model.document.chain.get(&limb.chain) else {
            continue;
        };
        let mut places = places(&limb.name, &chain.elements)?;
        // Behind the last joint an error moves the tool as it moves the markers: where both are free, none is known.
        places.pop();
        for at in places {
            let place = format!("{DEVIATION}{}.{at}.", limb.name);
            let known = all.iter().filter(|p| p.path.starts_with(&place));
            let known: Vec<String> = known.map(|p| p.path.clone()).collect();
            let new = KEYS.iter().flat_map(|key| AXES.map(|axis| (key, axis)));
            match known.is_empty() {
                true => paths.extend(new.map(|(key, axis)| format!("{place}{key}.{axis}"))),
                false => paths.extend(known),
            }
        }
    }
    Ok(paths)
}

/// Where the errors of a limb are, one for each of its bodies: behind the last named rigid element or link of the body.
fn places<'e>(limb: &str, elements: &'e [Element]) -> Result<Vec<&'e str>, IdentificationError> {
    let mut places = Vec::new();
    let mut own = Some("start");
    for element in elements {
        match element {
            Element::Rigid(_) | Element::Link(_) => own = element.name().or(own),
            Element::Actuator(_)
            | Element::Passive(_)
            | Element::Parallelogram(_)
            | Element::Coupled(_) => {
                places.push(own.ok_or_else(|| IdentificationError::NoPlace {
                    limb: limb.to_owned(),
                    joint: element.name().unwrap_or("a coupled joint").to_owned(),
                })?);
                own = None;
            }
            Element::Spring(_) | Element::Spring6(_) | Element::Node(_) | Element::Body(_) => {}
        }
    }
    places.push(own.unwrap_or("end"));
    Ok(places)
}
