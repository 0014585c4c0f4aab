//! Links and parallelograms: an offset, an elasticity and the axes in which it is one.

use kinetostat::model::{LinkConvention, LinkMass, MassModel};
use kinetostat::number::short;
use kinetostat::spatial::turn_matrix;
use kinetostat::{LinkSpec, Pose};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::elements::elastic::{Elastic, Elasticity, along};
use crate::elements::part::Part;
use crate::elements::placement::frame_along;
use crate::elements::quantity::{DEG, MM, choices, forbid, pick, positive};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Convention, LinkElement, MassModelWord, ParallelogramElement};

/// Maximum number of pieces of one link; more are a typing error.
const MOST_SEGMENTS: u32 = 100;

pub(crate) fn link(
    place: &KeyPath,
    name: String,
    e: &LinkElement,
    elastic: &Elastic,
) -> Result<Vec<Part>, Option<Finding>> {
    let offset = offset(place, e)?;
    // Squares of a tiny length would vanish.
    let length = match e.vector_mm.or(e.vector_m) {
        Some(_) => offset.norm(),
        None => offset.x,
    };
    let segments = e.segments.unwrap_or(1);
    if !(1..=MOST_SEGMENTS).contains(&segments) {
        return Err(Some(Finding::new(
            &place.key("segments"),
            format!("the link has {segments} segments, 1 to {MOST_SEGMENTS} are possible"),
            "8 give buckling loads to 0.1 %, 32 give deflections as large as the link",
        )));
    }
    let slanted = e.vector_mm.or(e.vector_m).is_some();
    let axis = Unit::new_normalize(offset);
    let elasticity = elastic.named(&place.key("link"), &e.link)?;
    let convention = convention(e.convention.unwrap_or_default());
    let mass = mass(place, e, &elasticity)?;
    if convention == LinkConvention::TranslationsFirst && segments == 1 && mass.is_none() {
        // Matrix in the axes of the frame, which does not turn.
        let matrix = match elasticity {
            Elasticity::Matrix(matrix) => *matrix,
            section if slanted => along(&section.cantilever(place, length)?, &axis),
            section => section.cantilever(place, length)?,
        };
        return Ok(vec![
            Part::Rigid(
                Some(name.clone()),
                Pose::translation(offset.x, offset.y, offset.z),
            ),
            Part::LinkSpring(name, Box::new(matrix), offset),
        ]);
    }
    // Rotation to the link's own axes, and back.
    let turn = match slanted {
        true => UnitQuaternion::from_rotation_matrix(&frame_along(&axis)),
        false => UnitQuaternion::identity(),
    };
    let mut pieces = None;
    let spec = match elasticity {
        Elasticity::Section(section) | Elasticity::Rigidities(section) => {
            LinkSpec::beam(section, length)
        }
        Elasticity::Beam(beam) => {
            pieces = beam.pieces(place, length, segments)?;
            LinkSpec::matrix(beam.cantilever(place, length)?, length)
        }
        Elasticity::Matrix(matrix) => {
            let own = turn_matrix(&turn.to_rotation_matrix());
            LinkSpec::matrix(own.transpose() * *matrix * own, length)
        }
    };
    let mut spec = spec.segments(segments as usize).convention(convention);
    spec.mass = mass;
    let turned = |rotation| Pose::from_parts(Vector3::zeros().into(), rotation);
    let mut parts = Vec::new();
    if slanted {
        parts.push(Part::Rigid(None, turned(turn)));
    }
    parts.push(Part::Link(name.clone(), Box::new(spec), pieces));
    parts.push(Part::Rigid(Some(name), turned(turn.inverse())));
    Ok(parts)
}

/// Offset from the near to the far end of a link, m: along x, or as a vector.
fn offset(place: &KeyPath, e: &LinkElement) -> Result<Vector3<f64>, Option<Finding>> {
    let lengths = choices!(e, (length_mm, MM), (length_m, 1.0));
    let vectors = choices!(e, (vector_mm, MM), (vector_m, 1.0));
    Ok(match pick(place, "vector", &vectors)? {
        Some(given) => {
            forbid(
                place,
                &lengths,
                "the vector has a length already",
                "keep one of them",
            )?;
            let v = Vector3::from(given.value);
            if v.norm() < 1e-9 {
                return Err(Some(Finding::new(
                    &place.key(given.key),
                    "the link has no length",
                    "write the vector from its near to its far end",
                )));
            }
            v
        }
        None => {
            let length = positive(place, "length", &lengths).map_err(|mut f| {
                if lengths.iter().all(|choice| choice.value.is_none()) {
                    f.help.push_str(", or vector_mm");
                }
                f
            })?;
            Vector3::new(length.value, 0.0, 0.0)
        }
    })
}

/// The mass along a link, if one is written.
fn mass(
    place: &KeyPath,
    e: &LinkElement,
    elasticity: &Elasticity,
) -> Result<Option<LinkMass>, Option<Finding>> {
    let density = choices!(e, (density_kg_m3, 1.0));
    let per_length = choices!(e, (mass_kg_per_m, 1.0));
    let model = match e.mass_model.unwrap_or_default() {
        MassModelWord::AlongTheLink => MassModel::Consistent,
        MassModelWord::HalvesAtEnds => MassModel::HalvesAtEnds,
    };
    if pick(place, "density", &density)?.is_some() {
        forbid(
            place,
            &per_length,
            "the density gives the mass already",
            "keep one of them",
        )?;
        let given = positive(place, "density", &density)?;
        let refuse = |why: &str| {
            let help = "write mass_kg_per_m";
            Err(Some(Finding::new(&place.key(given.key), why, help)))
        };
        let section = match elasticity {
            Elasticity::Section(section) => section,
            Elasticity::Rigidities(_) => {
                return refuse("a density needs the area of the section, and rigidities have none");
            }
            Elasticity::Beam(_) | Elasticity::Matrix(_) => {
                return refuse(
                    "a density needs a section of one shape, and this link has a matrix or a shape that changes",
                );
            }
        };
        if !(100.0..=25_000.0).contains(&given.value) {
            return Err(Some(Finding::new(
                &place.key(given.key),
                format!(
                    "a density of {} kg/m^3 is that of no solid",
                    short(given.value)
                ),
                "steel has 7850 kg/m^3, aluminium 2700, carbon fibre 1600; check the unit",
            )));
        }
        return Ok(Some(
            LinkMass::of_section(section, given.value).with_model(model),
        ));
    }
    if pick(place, "mass per length", &per_length)?.is_some() {
        let given = positive(place, "mass per length", &per_length)?;
        return Ok(Some(LinkMass {
            per_length: given.value,
            rotary: [0.0; 3],
            model,
        }));
    }
    if e.mass_model.is_some() {
        return Err(Some(Finding::new(
            &place.key("mass_model"),
            "the link has no mass to put anywhere",
            "write density_kg_m3 or mass_kg_per_m beside it",
        )));
    }
    Ok(None)
}

fn convention(written: Convention) -> LinkConvention {
    match written {
        Convention::Bowing => LinkConvention::Bowing,
        Convention::TranslationsFirst => LinkConvention::TranslationsFirst,
        Convention::RotationsFirst => LinkConvention::RotationsFirst,
        Convention::Middle => LinkConvention::Middle,
        Convention::Exponential => LinkConvention::Exponential,
        Convention::ConstantStrain => LinkConvention::ConstantStrain,
    }
}

pub(crate) fn parallelogram(
    place: &KeyPath,
    name: String,
    e: &ParallelogramElement,
    elastic: &Elastic,
) -> Result<Part, Option<Finding>> {
    let length = positive(
        place,
        "length",
        &choices!(e, (length_mm, MM), (length_m, 1.0)),
    )?
    .value;
    let width = positive(place, "width", &choices!(e, (width_mm, MM), (width_m, 1.0)))?.value;
    let home = pick(
        place,
        "home",
        &choices!(e, (home_deg, DEG), (home_rad, 1.0)),
    )?
    .map_or(0.0, |g| g.value);
    let bar = elastic
        .named(&place.key("parallelogram"), &e.parallelogram)?
        .cantilever(place, length)?;
    Ok(Part::Parallelogram(
        name,
        length,
        width,
        Box::new(bar),
        home,
    ))
}
