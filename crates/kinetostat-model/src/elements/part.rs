//! Elements of a chain in SI, before a limb gives them their deviations: one call of the core's builder each; masses and inertias.

use kinetostat::model::SpringLaw;
use kinetostat::{ActuatorSpec, ChainBuilder, LinkSpec, MotionKind, Pose};
use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::elements::quantity::{MM, ReadResult, choice, choices, need, vector};
use crate::problem::{Finding, KeyPath};
use crate::schema::BodyElement;

/// The calls to the core's builder, one each.
#[derive(Clone, Debug)]
pub(crate) enum Part {
    /// Offset; the name is where deviations attach.
    Rigid(Option<String>, Pose),
    Actuator(String, ActuatorSpec),
    /// Lead in m per turn.
    Screw(String, ActuatorSpec, f64),
    Passive(String, MotionKind, Vector3<f64>, f64),
    /// Spring, then its deflections at rest and at home.
    Spring(String, MotionKind, Vector3<f64>, SpringLaw, [f64; 2]),
    Spring6(String, Box<Matrix6<f64>>, [f64; 6]),
    /// Link along local x, with its offset; stiffnesses of its segments where they differ.
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

pub(crate) fn body(place: &KeyPath, e: &BodyElement) -> ReadResult<Part> {
    let mass = mass(place, Some(e.mass_kg))?;
    let centre = vector(
        place,
        "centre of mass",
        &choices!(e, (centre_of_mass_mm, MM), (centre_of_mass_m, 1.0)),
    )?;
    let inertia = inertia(place, e.inertia_kg_m2)?;
    Ok(Part::Body(e.body.clone(), mass, centre, inertia))
}

pub(crate) fn mass(place: &KeyPath, mass: Option<f64>) -> ReadResult<f64> {
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

pub(crate) fn inertia(place: &KeyPath, rows: Option<[[f64; 3]; 3]>) -> ReadResult<Matrix3<f64>> {
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
