//! Elements of a chain in SI, before a limb gives them their deviations.

use kinetostat::{ActuatorSpec, ChainBuilder, MotionKind, Pose};
use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::elastic::{Elastic, Elasticity, along};
use crate::placement::{direction, pose};
use crate::problem::{Finding, Place};
use crate::quantity::{
    Choice, DEG, Found, Given, MM, Scaled, choice, forbid, need, pick, positive, vector,
};
use crate::schema::{
    ActuatorElement, BodyElement, Element, JointKind, LinkElement, ParallelogramElement,
    PassiveElement, PassiveKind, Spring6Element, SpringElement,
};

/// What the core's builder is told, one call each.
#[derive(Clone, Debug)]
pub(crate) enum Part {
    /// Offset; the name is where deviations attach.
    Rigid(Option<String>, Pose),
    Actuator(String, ActuatorSpec),
    Passive(String, MotionKind, Vector3<f64>, f64),
    Spring(String, MotionKind, Vector3<f64>, f64, f64),
    Spring6(String, Box<Matrix6<f64>>, [f64; 6]),
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
            Self::Passive(name, kind, axis, home) => builder.passive(name, *kind, *axis, *home),
            Self::Spring(name, kind, axis, stiffness, rest) => {
                builder.spring(name, *kind, *axis, *stiffness, *rest)
            }
            Self::Spring6(name, matrix, rest) => builder.spring6(name, matrix, *rest),
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
            Self::Spring6(name, ..) => six.iter().map(|d| format!("{name}.{d}")).collect(),
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

pub(crate) fn kind(joint: JointKind) -> MotionKind {
    match joint {
        JointKind::Prismatic => MotionKind::Prismatic,
        JointKind::Revolute => MotionKind::Revolute,
    }
}

/// Keys for a length and for an angle: the ones of the joint's kind count, the others are refused.
fn by_kind<T: Scaled>(
    place: &Place,
    what: &str,
    kind: MotionKind,
    lengths: &[Choice<T>],
    angles: &[Choice<T>],
) -> Found<Option<Given<T>>> {
    let (right, wrong, reason) = match kind {
        MotionKind::Prismatic => (
            lengths,
            angles,
            "the joint is prismatic: it slides along its axis",
        ),
        MotionKind::Revolute => (
            angles,
            lengths,
            "the joint is revolute: it turns about its axis",
        ),
    };
    let keys: Vec<&str> = right.iter().map(|c| c.key).collect();
    forbid(
        place,
        wrong,
        reason,
        &format!("write {}", keys.join(" or ")),
    )?;
    pick(place, what, right)
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
        Element::Actuator(e) => vec![Part::Actuator(name, actuator(place, e)?)],
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

fn stiffness_of(
    place: &Place,
    kind: MotionKind,
    linear: [Option<f64>; 2],
    angular: [Option<f64>; 2],
) -> Found<Option<f64>> {
    let linear = [
        choice("stiffness_n_per_m", linear[0], 1.0),
        choice("stiffness_n_per_mm", linear[1], 1.0 / MM),
    ];
    let angular = [
        choice("stiffness_n_m_per_rad", angular[0], 1.0),
        choice("stiffness_n_mm_per_rad", angular[1], MM),
    ];
    let given = by_kind(place, "stiffness", kind, &linear, &angular)?;
    match given {
        Some(g) if g.value <= 0.0 => Err(Finding::new(
            &place.key(g.key),
            format!("'{}' is not above zero", g.key),
            "a direction that nothing holds is a passive joint; a drive that does not give way is rigid_drive = true",
        )),
        given => Ok(given.map(|g| g.value)),
    }
}

fn actuator(place: &Place, e: &ActuatorElement) -> Found<ActuatorSpec> {
    let kind = kind(e.actuator);
    let axis = direction(&place.key("axis"), &e.axis)?.into_inner();
    let stiffness = stiffness_of(
        place,
        kind,
        [e.stiffness_n_per_m, e.stiffness_n_per_mm],
        [e.stiffness_n_m_per_rad, e.stiffness_n_mm_per_rad],
    )?;
    let rigid = e.rigid_drive.unwrap_or(false);
    if rigid && stiffness.is_some() {
        return Err(Finding::new(
            &place.key("rigid_drive"),
            "the drive is said to be rigid and to have a stiffness",
            "keep one of them",
        ));
    }
    if !rigid && stiffness.is_none() {
        let key = match kind {
            MotionKind::Prismatic => "stiffness_n_per_m or stiffness_n_per_mm",
            MotionKind::Revolute => "stiffness_n_m_per_rad or stiffness_n_mm_per_rad",
        };
        return Err(Finding::new(
            place,
            "the stiffness of the drive is missing",
            format!("write {key}, or rigid_drive = true for a drive that does not give way"),
        ));
    }
    let rest = rest(place, kind, [e.rest_mm, e.rest_m, e.rest_deg, e.rest_rad])?;
    let home = by_kind(
        place,
        "home",
        kind,
        &[
            choice("home_mm", e.home_mm, MM),
            choice("home_m", e.home_m, 1.0),
        ],
        &[
            choice("home_deg", e.home_deg, DEG),
            choice("home_rad", e.home_rad, 1.0),
        ],
    )?;
    let limits = by_kind(
        place,
        "limits",
        kind,
        &[
            choice("limits_mm", e.limits_mm, MM),
            choice("limits_m", e.limits_m, 1.0),
        ],
        &[
            choice("limits_deg", e.limits_deg, DEG),
            choice("limits_rad", e.limits_rad, 1.0),
        ],
    )?;
    let home_value = home.map_or(0.0, |h| h.value);
    if let Some(Given {
        key,
        value: [low, high],
    }) = limits
    {
        if low >= high {
            return Err(Finding::new(
                &place.key(key),
                "the limits are reversed or equal",
                "write the smallest command first: [smallest, largest]",
            ));
        }
        if !(low <= home_value && home_value <= high) {
            let home = home.map_or("home (0, since none is written)", |h| h.key);
            return Err(Finding::new(
                &place.key(key),
                format!("'{home}' is outside '{key}'"),
                "correct one of them; the machine must be able to stand at home",
            ));
        }
    }
    Ok(ActuatorSpec {
        kind,
        axis,
        stiffness,
        rest,
        home: home_value,
        limits: limits.map(|l| (l.value[0], l.value[1])),
    })
}

/// Deflection at rest from its four keys: mm, m, deg, rad.
fn rest(place: &Place, kind: MotionKind, [mm, m, deg, rad]: [Option<f64>; 4]) -> Found<f64> {
    let lengths = [choice("rest_mm", mm, MM), choice("rest_m", m, 1.0)];
    let angles = [choice("rest_deg", deg, DEG), choice("rest_rad", rad, 1.0)];
    let given = by_kind(place, "deflection at rest", kind, &lengths, &angles)?;
    Ok(given.map_or(0.0, |g| g.value))
}

fn passive(place: &Place, name: String, e: &PassiveElement) -> Found<Vec<Part>> {
    let lengths = [
        choice("home_mm", e.home_mm, MM),
        choice("home_m", e.home_m, 1.0),
    ];
    let angles = [
        choice("home_deg", e.home_deg, DEG),
        choice("home_rad", e.home_rad, 1.0),
    ];
    let several = [
        ("homes_deg", e.homes_deg.as_ref(), DEG),
        ("homes_rad", e.homes_rad.as_ref(), 1.0),
    ];
    let single = match e.passive {
        PassiveKind::Prismatic => Some(MotionKind::Prismatic),
        PassiveKind::Revolute => Some(MotionKind::Revolute),
        PassiveKind::Universal | PassiveKind::Spherical => None,
    };
    if let Some(kind) = single {
        if e.axes.is_some() {
            return Err(Finding::new(
                &place.key("axes"),
                "'axes' belongs to a universal joint",
                "write axis = ...",
            ));
        }
        if let Some((key, ..)) = several.iter().find(|s| s.1.is_some()) {
            return Err(Finding::new(
                &place.key(key),
                format!("'{key}' belongs to a universal or spherical joint"),
                "write home_deg = ... (one number)",
            ));
        }
        let Some(axis) = &e.axis else {
            return Err(Finding::new(
                place,
                "the axis is missing",
                "write axis = \"x\" (or another direction)",
            ));
        };
        let axis = direction(&place.key("axis"), axis)?.into_inner();
        let home = by_kind(place, "home", kind, &lengths, &angles)?;
        return Ok(vec![Part::Passive(
            name,
            kind,
            axis,
            home.map_or(0.0, |h| h.value),
        )]);
    }
    for choices in [&lengths, &angles] {
        forbid(
            place,
            choices,
            "the joint has several angles",
            "write homes_deg = [first, second, ...]",
        )?;
    }
    if e.axis.is_some() {
        return Err(Finding::new(
            &place.key("axis"),
            "'axis' belongs to a joint of one degree of freedom",
            "a universal joint has axes = [first, second]; a spherical one turns about x, y, z",
        ));
    }
    let joints: Vec<(String, Vector3<f64>)> = match (e.passive, &e.axes) {
        (PassiveKind::Spherical, None) => ["x", "y", "z"]
            .into_iter()
            .zip([Vector3::x(), Vector3::y(), Vector3::z()])
            .map(|(letter, axis)| (format!("{name}.{letter}"), axis))
            .collect(),
        (PassiveKind::Spherical, Some(_)) => {
            return Err(Finding::new(
                &place.key("axes"),
                "a spherical joint has no axes",
                "leave 'axes' out: it turns about x, y, z; or write passive = \"universal\"",
            ));
        }
        (_, Some([first, second])) => {
            let axes = place.key("axes");
            let one = direction(&axes.index(0), first)?.into_inner();
            let other = direction(&axes.index(1), second)?.into_inner();
            if one.cross(&other).norm() < 1e-6 {
                return Err(Finding::new(
                    &axes,
                    "the two axes of the universal joint are parallel",
                    "write two different axes, usually square to each other",
                ));
            }
            vec![(format!("{name}.1"), one), (format!("{name}.2"), other)]
        }
        (_, None) => {
            return Err(Finding::new(
                place,
                "the axes of the universal joint are missing",
                "write axes = [\"y\", \"z\"] (or other directions)",
            ));
        }
    };
    let mut homes = vec![0.0; joints.len()];
    if let [(_, Some(_), _), (key, Some(_), _)] = several {
        return Err(Finding::new(
            &place.key(key),
            "the home is given twice: 'homes_deg' and 'homes_rad'",
            "keep one of them",
        ));
    }
    for (key, values, factor) in several {
        if let Some(values) = values {
            if values.len() != joints.len() {
                return Err(Finding::new(
                    &place.key(key),
                    format!(
                        "'{key}' needs {} numbers, {} were found",
                        joints.len(),
                        values.len()
                    ),
                    "one for each axis, in order",
                ));
            }
            homes = values.iter().map(|v| v * factor).collect();
        }
    }
    Ok(joints
        .into_iter()
        .zip(homes)
        .map(|((name, axis), home)| Part::Passive(name, MotionKind::Revolute, axis, home))
        .collect())
}

fn spring(place: &Place, name: String, e: &SpringElement) -> Found<Part> {
    let kind = kind(e.spring);
    let axis = direction(&place.key("axis"), &e.axis)?.into_inner();
    let stiffness = stiffness_of(
        place,
        kind,
        [e.stiffness_n_per_m, e.stiffness_n_per_mm],
        [e.stiffness_n_m_per_rad, e.stiffness_n_mm_per_rad],
    )?
    .ok_or_else(|| {
        Finding::new(
            place,
            "the stiffness of the spring is missing",
            match kind {
                MotionKind::Prismatic => "write stiffness_n_per_m or stiffness_n_per_mm",
                MotionKind::Revolute => "write stiffness_n_m_per_rad or stiffness_n_mm_per_rad",
            },
        )
    })?;
    let rest = rest(place, kind, [e.rest_mm, e.rest_m, e.rest_deg, e.rest_rad])?;
    Ok(Part::Spring(name, kind, axis, stiffness, rest))
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
    let length = offset.norm();
    let matrix = match elastic.named(&place.key("link"), &e.link)? {
        Elasticity::Section(section) => {
            let local = section.cantilever(length);
            match e.vector_mm.or(e.vector_m) {
                Some(_) => along(&local, &nalgebra::Unit::new_normalize(offset)),
                None => local,
            }
        }
        Elasticity::Matrix(matrix) => matrix,
    };
    Ok(vec![
        Part::Rigid(
            Some(name.clone()),
            Pose::translation(offset.x, offset.y, offset.z),
        ),
        Part::Spring6(name, Box::new(matrix), [0.0; 6]),
    ])
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
    let bar = match elastic.named(&place.key("parallelogram"), &e.parallelogram)? {
        Elasticity::Section(section) => section.cantilever(length),
        Elasticity::Matrix(matrix) => matrix,
    };
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
    if m.symmetric_eigenvalues().min() < -1e-9 * size {
        return Err(Finding::new(
            &place,
            "the inertia is negative about some axis",
            "check the products of inertia and their signs",
        ));
    }
    Ok(m)
}
