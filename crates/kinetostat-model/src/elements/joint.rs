//! Joints and springs of one degree of freedom: lengths for those that slide, angles for those that
//! turn.

use kinetostat::{ActuatorSpec, MotionKind, model::SpringLaw};
use nalgebra::{DMatrix, Vector3};

use crate::elements::elastic::knee_law;
use crate::elements::part::Part;
use crate::elements::placement::direction;
use crate::elements::quantity::{
    Choice, DEG, Given, MM, ReadResult, by_kind, choice, choices, forbid, need,
};
use crate::elements::rotor::rotor;
use crate::problem::{Finding, KeyPath};
use crate::schema::{
    ActuatorElement, ActuatorKind, JointKind, PassiveElement, PassiveKind, SpringElement,
};

pub(crate) fn kind(joint: JointKind) -> MotionKind {
    match joint {
        JointKind::Prismatic => MotionKind::Prismatic,
        JointKind::Revolute => MotionKind::Revolute,
    }
}

fn stiffness_of(
    place: &KeyPath,
    kind: MotionKind,
    linear: [Option<f64>; 2],
    angular: [Option<f64>; 2],
) -> ReadResult<Option<f64>> {
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
            format!(
                "the stiffness is {} {}, a number above zero is needed",
                g.value,
                match kind {
                    MotionKind::Prismatic => "N/m",
                    MotionKind::Revolute => "N m/rad",
                }
            ),
            "a direction that nothing holds is a passive joint; a drive that does not give way is rigid_drive = true",
        )),
        given => Ok(given.map(|g| g.value)),
    }
}

pub(crate) fn actuator(place: &KeyPath, e: &ActuatorElement) -> ReadResult<ActuatorSpec> {
    let kind = match e.actuator {
        ActuatorKind::Prismatic | ActuatorKind::Screw => MotionKind::Prismatic,
        ActuatorKind::Revolute => MotionKind::Revolute,
    };
    let axis = direction(&place.key("axis"), &e.axis)?.into_inner();
    let stiffness = stiffness_of(
        place,
        kind,
        [e.stiffness_n_per_m, e.stiffness_n_per_mm],
        [e.stiffness_n_m_per_rad, e.stiffness_n_mm_per_rad],
    )?;
    check_rigid_or_elastic(place, kind, e.rigid_drive.unwrap_or(false), stiffness)?;
    check_rating(place, kind, e)?;
    let rotor = match &e.rotor {
        Some(table) => Some(rotor(&place.key("rotor"), kind, stiffness, table)?),
        None => None,
    };
    let rest = rest(place, kind, [e.rest_mm, e.rest_m, e.rest_deg, e.rest_rad])?;
    let home = by_kind(
        place,
        "home",
        kind,
        &choices!(e, (home_mm, MM), (home_m, 1.0)),
        &choices!(e, (home_deg, DEG), (home_rad, 1.0)),
    )?;
    Ok(ActuatorSpec {
        kind,
        axis,
        stiffness,
        rest,
        home: home.map_or(0.0, |h| h.value),
        limits: limits_around(place, kind, e, home)?,
        rotor,
    })
}

/// A drive is rigid or has a stiffness: neither is assumed.
fn check_rigid_or_elastic(
    place: &KeyPath,
    kind: MotionKind,
    rigid: bool,
    stiffness: Option<f64>,
) -> ReadResult<()> {
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
    Ok(())
}

fn check_rating(place: &KeyPath, kind: MotionKind, e: &ActuatorElement) -> ReadResult<()> {
    let rating = by_kind(
        place,
        "rating",
        kind,
        &choices!(e, (rated_force_n, 1.0)),
        &choices!(e, (rated_torque_n_m, 1.0)),
    )?;
    if let Some(Given { key, value }) = rating.filter(|r| r.value <= 0.0) {
        return Err(Finding::new(
            &place.key(key),
            format!("the rating is {value}, a number above zero is needed"),
            "write the largest load that the drive may carry, or leave the key out",
        ));
    }
    Ok(())
}

/// Limits of an actuator's command, m or rad, with its home between them.
fn limits_around(
    place: &KeyPath,
    kind: MotionKind,
    e: &ActuatorElement,
    home: Option<Given<f64>>,
) -> ReadResult<Option<(f64, f64)>> {
    let limits = by_kind(
        place,
        "limits",
        kind,
        &choices!(e, (limits_mm, MM), (limits_m, 1.0)),
        &choices!(e, (limits_deg, DEG), (limits_rad, 1.0)),
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
            let home = home.map_or("home is 0 (none is written), which".to_owned(), |h| {
                format!("'{}'", h.key)
            });
            return Err(Finding::new(
                &place.key(key),
                format!("{home} is outside '{key}'"),
                "correct one of them; the machine must be able to take its home posture",
            ));
        }
    }
    Ok(limits.map(|l| (l.value[0], l.value[1])))
}

/// Lead of a screw, m per turn; `None` for another actuator.
pub(crate) fn lead(place: &KeyPath, e: &ActuatorElement) -> ReadResult<Option<f64>> {
    let leads = choices!(e, (lead_mm_per_turn, MM), (lead_m_per_turn, 1.0));
    if e.actuator == ActuatorKind::Screw {
        return Ok(Some(need(place, "lead of the screw", &leads)?.value));
    }
    forbid(
        place,
        &leads,
        "only a screw has a lead",
        "write actuator = \"screw\": its far end is then free to turn",
    )?;
    Ok(None)
}

/// Deflection at rest from its four keys: mm, m, deg, rad.
fn rest(place: &KeyPath, kind: MotionKind, [mm, m, deg, rad]: [Option<f64>; 4]) -> ReadResult<f64> {
    let lengths = [choice("rest_mm", mm, MM), choice("rest_m", m, 1.0)];
    let angles = [choice("rest_deg", deg, DEG), choice("rest_rad", rad, 1.0)];
    let given = by_kind(place, "deflection at rest", kind, &lengths, &angles)?;
    Ok(given.map_or(0.0, |g| g.value))
}

/// A passive joint as joints of one degree of freedom each, in the order of the product.
pub(crate) fn passive(place: &KeyPath, name: String, e: &PassiveElement) -> ReadResult<Vec<Part>> {
    match e.passive {
        PassiveKind::Prismatic => one_axis(place, name, MotionKind::Prismatic, e),
        PassiveKind::Revolute => one_axis(place, name, MotionKind::Revolute, e),
        PassiveKind::Universal | PassiveKind::Spherical => several_axes(place, &name, e),
    }
}

/// Home of a joint of one degree of freedom, by lengths and by angles.
fn home_choices(e: &PassiveElement) -> [[Choice<f64>; 2]; 2] {
    [
        choices!(e, (home_mm, MM), (home_m, 1.0)),
        choices!(e, (home_deg, DEG), (home_rad, 1.0)),
    ]
}

/// Homes of a joint of several angles: key, values and unit.
fn homes_choices(e: &PassiveElement) -> [(&'static str, Option<&Vec<f64>>, f64); 2] {
    [
        ("homes_deg", e.homes_deg.as_ref(), DEG),
        ("homes_rad", e.homes_rad.as_ref(), 1.0),
    ]
}

fn one_axis(
    place: &KeyPath,
    name: String,
    kind: MotionKind,
    e: &PassiveElement,
) -> ReadResult<Vec<Part>> {
    if e.axes.is_some() {
        return Err(Finding::new(
            &place.key("axes"),
            "'axes' belongs to a universal joint",
            "write axis = ...",
        ));
    }
    if let Some((key, ..)) = homes_choices(e).iter().find(|s| s.1.is_some()) {
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
    let [lengths, angles] = home_choices(e);
    let home = by_kind(place, "home", kind, &lengths, &angles)?;
    let home = home.map_or(0.0, |h| h.value);
    Ok(vec![Part::Passive(name, kind, axis, home)])
}

fn several_axes(place: &KeyPath, name: &str, e: &PassiveElement) -> ReadResult<Vec<Part>> {
    for choices in home_choices(e) {
        forbid(
            place,
            &choices,
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
    let joints = named_axes(place, name, e)?;
    let homes = homes(place, joints.len(), e)?;
    Ok(joints
        .into_iter()
        .zip(homes)
        .map(|((name, axis), home)| Part::Passive(name, MotionKind::Revolute, axis, home))
        .collect())
}

/// Names and axes of the joints that a universal or spherical joint is the product of.
fn named_axes(
    place: &KeyPath,
    name: &str,
    e: &PassiveElement,
) -> ReadResult<Vec<(String, Vector3<f64>)>> {
    Ok(match (e.passive, &e.axes) {
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
    })
}

/// Angles of a joint of several axes at home, rad; zero where none are written.
fn homes(place: &KeyPath, count: usize, e: &PassiveElement) -> ReadResult<Vec<f64>> {
    let given = homes_choices(e);
    if let [(_, Some(_), _), (key, Some(_), _)] = given {
        return Err(Finding::new(
            &place.key(key),
            "the home is given twice: 'homes_deg' and 'homes_rad'",
            "keep one of them",
        ));
    }
    let written = given
        .into_iter()
        .find_map(|(key, values, factor)| Some((key, values?, factor)));
    let Some((key, values, factor)) = written else {
        return Ok(vec![0.0; count]);
    };
    if values.len() != count {
        return Err(Finding::new(
            &place.key(key),
            format!("'{key}' needs {count} numbers, {} were found", values.len()),
            "one for each axis, in order",
        ));
    }
    Ok(values.iter().map(|v| v * factor).collect())
}

pub(crate) fn spring(place: &KeyPath, name: String, e: &SpringElement) -> ReadResult<Part> {
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
    let home = by_kind(
        place,
        "home",
        kind,
        &choices!(e, (home_mm, MM), (home_m, 1.0)),
        &choices!(e, (home_deg, DEG), (home_rad, 1.0)),
    )?;
    let home = home.map_or(0.0, |h| h.value);
    let law = match &e.knee {
        Some(knee) => knee_law(&place.key("knee"), kind, stiffness, knee)?,
        None => SpringLaw::Linear(DMatrix::from_element(1, 1, stiffness)),
    };
    Ok(Part::Spring(name, kind, axis, law, [rest, home]))
}
