//! Elements of a chain in SI, before a limb gives them their deviations.

use kinetostat::{
    ActuatorSpec, ChainBuilder, LinkConvention, LinkSpec, MotionKind, Pose, SpringLaw, turn_matrix,
};
use nalgebra::{Matrix3, Matrix6, Unit, UnitQuaternion, Vector3};

use crate::elastic::{Elastic, Elasticity, along};
use crate::joint::{actuator, kind, lead, passive, spring};
use crate::placement::{direction, frame_along, pose};
use crate::problem::{Finding, Place};
use crate::quantity::{DEG, Found, MM, choice, forbid, need, pick, positive, vector};
use crate::schema::{
    BodyElement, Convention, Element, LinkElement, ParallelogramElement, Spring6Element,
};

/// More pieces of one link are a slip of the pen.
const MOST_SEGMENTS: u32 = 100;

/// What the core's builder is told, one call each.
#[derive(Clone, Debug)]
pub(crate) enum Part {
    /// Offset; the name is where deviations attach.
    Rigid(Option<String>, Pose),
    Actuator(String, ActuatorSpec),
    /// Lead in m per turn.
    Screw(String, ActuatorSpec, f64),
    Passive(String, MotionKind, Vector3<f64>, f64),
    /// Then the deflections at rest and at home.
    Spring(String, MotionKind, Vector3<f64>, SpringLaw, [f64; 2]),
    Spring6(String, Box<Matrix6<f64>>, [f64; 6]),
    /// Along local x, with its offset; stiffnesses of its segments where they differ.
    Link(String, Box<LinkSpec>, Option<Vec<Matrix6<f64>>>),
    /// Matrix in the frame reached, offset from near to far end (written before it).
    LinkSpring(String, Box<Matrix6<f64>>, Vector3<f64>),
    Parallelogram(String, f64, f64, Box<Matrix6<f64>>, f64),
    Coupled(String, MotionKind, Vector3<f64>, f64),
    Node(String),
    Body(String, f64, Vector3<f64>, Matrix3<f64>),
}

impl Part {
    /// Tells the builder; `deviation` follows an offset.
    pub(crate) fn add(&self, builder: ChainBuilder, deviation: Option<&Pose>) -> ChainBuilder {
        match self {
            Self::Rigid(_, pose) => builder.rigid(match deviation {
                Some(deviation) => pose * deviation,
                None => *pose,
            }),
            Self::Actuator(name, spec) => builder.actuator(name, spec.clone()),
            Self::Screw(name, spec, lead) => builder.screw(name, spec.clone(), *lead),
            Self::Passive(name, kind, axis, home) => builder.passive(name, *kind, *axis, *home),
            Self::Spring(name, kind, axis, law, [rest, home]) => builder
                .spring_with_law(name, *kind, *axis, law.clone(), *rest)
                .home(name, *home),
            Self::Spring6(name, matrix, rest) => builder.spring6(name, matrix, *rest),
            Self::Link(name, spec, None) => builder.link_with(name, spec),
            Self::Link(name, spec, Some(pieces)) => builder.link_of_pieces(name, spec, pieces),
            Self::LinkSpring(name, matrix, offset) => builder.link_spring(name, matrix, offset),
            Self::Parallelogram(name, length, width, bar, home) => {
                builder.parallelogram(name, *length, *width, bar, *home)
            }
            Self::Coupled(name, kind, axis, ratio) => builder.coupled(name, *kind, *axis, *ratio),
            Self::Node(name) => builder.node(name),
            Self::Body(name, mass, centre, inertia) => builder.body(name, *mass, *centre, *inertia),
        }
    }

    /// Names of the coordinates that this part makes.
    pub(crate) fn coordinates(&self) -> Vec<String> {
        let six = ["x", "y", "z", "rx", "ry", "rz"];
        match self {
            Self::Actuator(name, _) | Self::Passive(name, ..) | Self::Spring(name, ..) => {
                vec![name.clone()]
            }
            Self::Screw(name, ..) => vec![name.clone(), format!("{name}.turn")],
            Self::Spring6(name, ..) | Self::LinkSpring(name, ..) => {
                six.iter().map(|d| format!("{name}.{d}")).collect()
            }
            Self::Link(name, spec, _) => (1..=spec.segments)
                .flat_map(|k| {
                    let own = match spec.segments {
                        1 => name.clone(),
                        _ => format!("{name}.{k}"),
                    };
                    six.iter().map(move |d| format!("{own}.{d}"))
                })
                .collect(),
            Self::Parallelogram(name, ..) => std::iter::once(name.clone())
                .chain(
                    six.iter()
                        .filter(|d| **d != "z")
                        .map(|d| format!("{name}.bars.{d}")),
                )
                .collect(),
            _ => Vec::new(),
        }
    }
}

/// Everything an element turns into. `Err(None)` where the reason was reported elsewhere.
pub(crate) fn parts(
    place: &Place,
    number: usize,
    element: &Element,
    elastic: &Elastic,
) -> Result<Vec<Part>, Option<Finding>> {
    let name = element
        .name()
        .map_or_else(|| format!("{} {number}", element.word()), str::to_owned);
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
    place: &Place,
    name: String,
    e: &Spring6Element,
    elastic: &Elastic,
) -> Result<Part, Option<Finding>> {
    let matrix = elastic.spring6(&place.key("spring6"), &e.spring6)?;
    let translation = vector(
        place,
        "translation at rest",
        &[
            choice("rest_translation_mm", e.rest_translation_mm, MM),
            choice("rest_translation_m", e.rest_translation_m, 1.0),
        ],
    )?;
    let rotation = vector(
        place,
        "rotation at rest",
        &[
            choice("rest_rotation_deg", e.rest_rotation_deg, DEG),
            choice("rest_rotation_rad", e.rest_rotation_rad, 1.0),
        ],
    )?;
    let (t, r) = (translation, rotation);
    Ok(Part::Spring6(
        name,
        Box::new(matrix),
        [t.x, t.y, t.z, r.x, r.y, r.z],
    ))
}

fn link(
    place: &Place,
    name: String,
    e: &LinkElement,
    elastic: &Elastic,
) -> Result<Vec<Part>, Option<Finding>> {
    let lengths = [
        choice("length_mm", e.length_mm, MM),
        choice("length_m", e.length_m, 1.0),
    ];
    let vectors = [
        choice("vector_mm", e.vector_mm, MM),
        choice("vector_m", e.vector_m, 1.0),
    ];
    let offset = match pick(place, "vector", &vectors)? {
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
                if f.message.ends_with("missing") {
                    f.help.push_str(", or vector_mm");
                }
                f
            })?;
            Vector3::new(length.value, 0.0, 0.0)
        }
    };
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
    if convention == LinkConvention::TranslationsFirst && segments == 1 {
        // In the axes of the frame, which does not turn.
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
    // In the link's own axes, there and back.
    let turn = match slanted {
        true => UnitQuaternion::from_rotation_matrix(&frame_along(&axis)),
        false => UnitQuaternion::identity(),
    };
    let mut pieces = None;
    let spec = match elasticity {
        Elasticity::Section(section) => LinkSpec::beam(section, length),
        Elasticity::Beam(beam) => {
            pieces = beam.pieces(place, length, segments)?;
            LinkSpec::matrix(beam.cantilever(place, length)?, length)
        }
        Elasticity::Matrix(matrix) => {
            let own = turn_matrix(&turn.to_rotation_matrix());
            LinkSpec::matrix(own.transpose() * *matrix * own, length)
        }
    };
    let spec = spec.segments(segments as usize).convention(convention);
    let turned = |rotation| Pose::from_parts(Vector3::zeros().into(), rotation);
    let mut parts = Vec::new();
    if slanted {
        parts.push(Part::Rigid(None, turned(turn)));
    }
    parts.push(Part::Link(name.clone(), Box::new(spec), pieces));
    parts.push(Part::Rigid(Some(name), turned(turn.inverse())));
    Ok(parts)
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

fn parallelogram(
    place: &Place,
    name: String,
    e: &ParallelogramElement,
    elastic: &Elastic,
) -> Result<Part, Option<Finding>> {
    let length = positive(
        place,
        "length",
        &[
            choice("length_mm", e.length_mm, MM),
            choice("length_m", e.length_m, 1.0),
        ],
    )?
    .value;
    let width = positive(
        place,
        "width",
        &[
            choice("width_mm", e.width_mm, MM),
            choice("width_m", e.width_m, 1.0),
        ],
    )?
    .value;
    let home = pick(
        place,
        "home",
        &[
            choice("home_deg", e.home_deg, DEG),
            choice("home_rad", e.home_rad, 1.0),
        ],
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

fn body(place: &Place, e: &BodyElement) -> Found<Part> {
    let mass = mass(place, Some(e.mass_kg))?;
    let centre = vector(
        place,
        "centre of mass",
        &[
            choice("centre_of_mass_mm", e.centre_of_mass_mm, MM),
            choice("centre_of_mass_m", e.centre_of_mass_m, 1.0),
        ],
    )?;
    let inertia = inertia(place, e.inertia_kg_m2)?;
    Ok(Part::Body(e.body.clone(), mass, centre, inertia))
}

pub(crate) fn mass(place: &Place, mass: Option<f64>) -> Found<f64> {
    let given = need(place, "mass", &[choice("mass_kg", mass.or(Some(0.0)), 1.0)])?;
    if given.value < 0.0 {
        return Err(Finding::new(
            &place.key(given.key),
            format!(
                "the mass is {} kg, a number not below zero is needed",
                given.value
            ),
            "correct 'mass_kg'",
        ));
    }
    Ok(given.value)
}

pub(crate) fn inertia(place: &Place, rows: Option<[[f64; 3]; 3]>) -> Found<Matrix3<f64>> {
    let Some(rows) = rows else {
        return Ok(Matrix3::zeros());
    };
    let place = place.key("inertia_kg_m2");
    let m = Matrix3::from_fn(|i, j| rows[i][j]);
    let size = m.amax();
    if (m - m.transpose()).amax() > 1e-9 * size {
        return Err(Finding::new(
            &place,
            "the inertia is not symmetric",
            "write three rows [Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz, Izz]; products of inertia carry their minus sign",
        ));
    }
    // Scaled first: squares of extreme numbers would not be finite.
    if size > 0.0 && (m / size).symmetric_eigenvalues().min() < -1e-9 {
        return Err(Finding::new(
            &place,
            "the inertia is negative about some axis",
            "check the products of inertia and their signs",
        ));
    }
    Ok(m)
}
