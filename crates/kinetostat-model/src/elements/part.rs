//! Elements of a chain in SI, before a limb gives them their deviations: one call of the core's builder each.

use kinetostat::{ActuatorSpec, ChainBuilder, LinkSpec, MotionKind, Pose, model::SpringLaw};
use nalgebra::{Matrix3, Matrix6, Vector3};

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
