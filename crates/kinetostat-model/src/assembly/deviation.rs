//! Errors of manufacture and assembly: where the actual geometry of a limb differs from the drawn one.

use std::collections::BTreeMap;

use kinetostat::{Pose, number};
use nalgebra::{UnitQuaternion, Vector3};

use crate::elements::part::Part;
use crate::elements::placement::{direction, pose};
use crate::elements::quantity::{DEG, MM, ReadResult};
use crate::findings::Findings;
use crate::problem::{Finding, KeyPath};
use crate::schema::{Deviation, Document};
use crate::text::hints::unknown;

/// Geometric error at one place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Misfit {
    /// Everything behind it is moved.
    Moved(Pose),
    /// The part is longer, m.
    Longer(f64),
    /// A joint's axis is tilted, or all that follows.
    Tilted(UnitQuaternion<f64>),
}

/// Advice against a second deviation of one element.
const ONE_DEVIATION: &str =
    "write both as one [[deviation]]: moved_by states a shift and a turn at once, in their order";

/// Deviations of one limb, by the name of their place.
pub(crate) type Own<'d> = BTreeMap<&'d str, (KeyPath, Misfit)>;

/// Deviations of the actual chain from the nominal one.
#[derive(Default)]
pub(crate) struct AsBuilt {
    pub(crate) start: Option<Pose>,
    pub(crate) end: Option<Pose>,
    /// Motions behind parts.
    pub(crate) behind: BTreeMap<usize, Pose>,
    /// Parts that are themselves otherwise: joints with a tilted axis, longer parallelograms.
    pub(crate) instead: BTreeMap<usize, Part>,
}

/// Deviations by limb and place in the limb.
pub(crate) fn deviations<'d>(
    document: &'d Document,
    findings: &mut Findings,
) -> BTreeMap<usize, Own<'d>> {
    let mut found: BTreeMap<usize, Own<'_>> = BTreeMap::new();
    for (i, d) in document.deviation.iter().enumerate() {
        if findings.enough() {
            break;
        }
        let place = KeyPath::root().key("deviation").index(i);
        let misfit = findings.keep(misfit(&place, d));
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
                ONE_DEVIATION,
            );
        } else if let Some(misfit) = misfit {
            taken.insert(&d.at, (place, misfit));
        }
    }
    found
}

fn misfit(place: &KeyPath, d: &Deviation) -> ReadResult<Misfit> {
    if d.about.is_some() && d.tilted_by_deg.is_none() {
        return Err(Finding::new(
            &place.key("about"),
            "'about' is given without 'tilted_by_deg'",
            "write tilted_by_deg = ..., or leave 'about' out",
        ));
    }
    match (&d.moved_by, d.longer_by_mm, d.tilted_by_deg) {
        (Some(motion), None, None) => Ok(Misfit::Moved(pose(&place.key("moved_by"), motion)?)),
        (None, Some(longer), None) => Ok(Misfit::Longer(MM * longer)),
        (None, None, Some(angle)) => {
            let Some(axis) = &d.about else {
                return Err(Finding::new(
                    place,
                    "the axis of the tilt is missing",
                    "write about = \"x\" (or another direction)",
                ));
            };
            let axis = direction(&place.key("about"), axis)?;
            Ok(Misfit::Tilted(UnitQuaternion::from_axis_angle(
                &axis,
                DEG * angle,
            )))
        }
        (None, None, None) => Err(Finding::new(
            place,
            "the deviation does not say what is wrong",
            "write moved_by = { ... }, longer_by_mm = ..., or tilted_by_deg = ... with about = ...",
        )),
        _ => Err(Finding::new(
            place,
            "the deviation is given in two ways",
            "keep one of moved_by, longer_by_mm, tilted_by_deg; a motion says everything at once",
        )),
    }
}

/// The deviations of a limb on the parts of its chain.
pub(crate) fn as_built(own: &Own<'_>, parts: &[(usize, Part)]) -> ReadResult<AsBuilt> {
    let mut built = AsBuilt::default();
    for (at, (place, misfit)) in own {
        let no_length = || {
            Finding::new(
                &place.key("longer_by_mm"),
                format!("'{at}' has no length that could be longer"),
                "name a link, a parallelogram, or a rigid element with an offset",
            )
        };
        if ["start", "end"].contains(at) {
            let motion = match misfit {
                Misfit::Moved(motion) => *motion,
                Misfit::Tilted(turn) => turned(turn),
                Misfit::Longer(_) => return Err(no_length()),
            };
            *(if *at == "start" {
                &mut built.start
            } else {
                &mut built.end
            }) = Some(motion);
            continue;
        }
        let behind = |p: &Part| matches!(p, Part::Rigid(Some(n), _) if n == at);
        if let Some(k) = parts.iter().position(|(_, p)| behind(p)) {
            let Part::Rigid(_, offset) = &parts[k].1 else {
                continue;
            };
            let motion = match misfit {
                Misfit::Moved(motion) => *motion,
                Misfit::Tilted(turn) => turned(turn),
                Misfit::Longer(by) => {
                    // A link in its own axes ends in a turn back from them.
                    let link =
                        k > 0 && matches!(&parts[k - 1].1, Part::Link(name, ..) if name == at);
                    let along = match link {
                        true => Vector3::x(),
                        false => offset.translation.vector,
                    };
                    let along = along.try_normalize(1e-12).ok_or_else(no_length)?;
                    let by = offset.rotation.inverse() * along * *by;
                    Pose::translation(by.x, by.y, by.z)
                }
            };
            built.behind.insert(k, motion);
            continue;
        }
        let named: Vec<usize> = (0..parts.len())
            .filter(|&k| joint(&parts[k].1).is_some_and(|n| n == *at || stem(n) == *at))
            .collect();
        if named.is_empty() {
            return Err(nowhere(place, at, misfit, parts));
        }
        for k in named {
            // An axis of a joint has its own name and that of the joint.
            if built.instead.contains_key(&k) {
                return Err(Finding::new(
                    &place.key("at"),
                    format!(
                        "'{}' has a deviation already, by another name than '{at}'",
                        joint(&parts[k].1).unwrap_or_default()
                    ),
                    ONE_DEVIATION,
                ));
            }
            let part = instead(&parts[k].1, misfit).ok_or_else(|| {
                let (key, help) = match misfit {
                    Misfit::Moved(_) => ("moved_by", "write tilted_by_deg and about for its axis, or name the rigid element or link in front of it"),
                    Misfit::Longer(_) => ("longer_by_mm", "name a link, a parallelogram, or a rigid element with an offset"),
                    Misfit::Tilted(_) => ("tilted_by_deg", "name a joint that turns or slides about one axis, or the rigid element or link in front"),
                };
                Finding::new(
                    &place.key(key),
                    format!("this kind of deviation is not possible at '{at}'"),
                    help,
                )
            })?;
            built.instead.insert(k, part);
        }
    }
    Ok(built)
}

fn turned(turn: &UnitQuaternion<f64>) -> Pose {
    Pose::from_parts(Vector3::zeros().into(), *turn)
}

/// Name of a part that can itself be made otherwise.
fn joint(part: &Part) -> Option<&str> {
    match part {
        Part::Actuator(name, _)
        | Part::Passive(name, ..)
        | Part::Spring(name, ..)
        | Part::Parallelogram(name, ..) => Some(name),
        _ => None,
    }
}

/// `foot joint` of the axis `foot joint.2` of a universal joint.
fn stem(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, "1" | "2" | "x" | "y" | "z")) => stem,
        _ => name,
    }
}

/// The part as it was made.
fn instead(part: &Part, misfit: &Misfit) -> Option<Part> {
    match (part, *misfit) {
        (Part::Actuator(name, spec), Misfit::Tilted(turn)) => {
            let mut spec = spec.clone();
            spec.axis = turn * spec.axis;
            Some(Part::Actuator(name.clone(), spec))
        }
        (Part::Passive(name, kind, axis, home), Misfit::Tilted(turn)) => {
            Some(Part::Passive(name.clone(), *kind, turn * axis, *home))
        }
        (Part::Spring(name, kind, axis, law, homes), Misfit::Tilted(turn)) => Some(Part::Spring(
            name.clone(),
            *kind,
            turn * axis,
            law.clone(),
            *homes,
        )),
        (Part::Parallelogram(name, length, width, bar, home), Misfit::Longer(by)) => {
            let length = Some(length + by).filter(|l| *l > 0.0)?;
            Some(Part::Parallelogram(
                name.clone(),
                length,
                *width,
                bar.clone(),
                *home,
            ))
        }
        _ => None,
    }
}

fn nowhere(place: &KeyPath, at: &str, misfit: &Misfit, parts: &[(usize, Part)]) -> Finding {
    let mut known = vec!["start", "end"];
    if let Misfit::Longer(_) = misfit {
        known.clear();
    }
    known.extend(parts.iter().filter_map(|(_, p)| match (p, misfit) {
        (Part::Rigid(name, _), _) => name.as_deref(),
        (Part::Parallelogram(name, ..), Misfit::Longer(_)) => Some(name.as_str()),
        (Part::Actuator(name, _) | Part::Passive(name, ..), Misfit::Tilted(_)) => {
            Some(name.as_str())
        }
        _ => None,
    }));
    let what = match misfit {
        Misfit::Moved(_) => "rigid element or link",
        Misfit::Longer(_) => "link, parallelogram or rigid element",
        Misfit::Tilted(_) => "joint, rigid element or link",
    };
    unknown(
        &place.key("at"),
        what,
        at,
        &known,
        "name the element that is out of place",
    )
}

/// Describes the deviation in a sentence without the limb's name.
fn words(d: &Deviation) -> String {
    let place = match d.at.as_str() {
        "start" => "at its start".to_owned(),
        "end" => "at its end".to_owned(),
        name => format!("behind '{name}'"),
    };
    let limb = &d.limb;
    let fixed = |x: f64| {
        let text = number::fixed(x, 4);
        number::without_zeros(&text).to_owned()
    };
    if let Some(by) = d.longer_by_mm {
        let word = if by < 0.0 { "shorter" } else { "longer" };
        return format!("limb '{limb}': '{}' is {} mm {word}", d.at, fixed(by.abs()));
    }
    if let Some(angle) = d.tilted_by_deg {
        let about = d
            .about
            .as_ref()
            .and_then(|axis| direction(&KeyPath::root(), axis).ok())
            .map_or_else(String::new, |u| {
                let letter = ["x", "y", "z"]
                    .iter()
                    .zip(u.iter())
                    .find(|(_, c)| **c == 1.0);
                match letter {
                    Some((letter, _)) => format!(" about {letter}"),
                    None => format!(" about ({}, {}, {})", fixed(u.x), fixed(u.y), fixed(u.z)),
                }
            });
        return match ["start", "end"].contains(&d.at.as_str()) {
            true => format!(
                "limb '{limb}' is tilted by {} deg{about} {place}",
                fixed(angle)
            ),
            false => format!(
                "limb '{limb}': '{}' is tilted by {} deg{about}",
                d.at,
                fixed(angle)
            ),
        };
    }
    let motion = d
        .moved_by
        .as_ref()
        .and_then(|motion| pose(&KeyPath::root(), motion).ok());
    let Some(motion) = motion else {
        return format!("limb '{limb}' is out of place {place}");
    };
    let triple = |v: Vector3<f64>| format!("({}, {}, {})", fixed(v.x), fixed(v.y), fixed(v.z));
    let shift = motion.translation.vector / MM;
    let turn = motion.rotation.scaled_axis() / DEG;
    let mut parts = Vec::new();
    if shift.norm() > 0.0 {
        parts.push(format!("shifted by {} mm", triple(shift)));
    }
    if turn.norm() > 0.0 {
        parts.push(format!("turned by {} deg", triple(turn)));
    }
    if parts.is_empty() {
        parts.push("not moved".to_owned());
    }
    format!("limb '{limb}' is {} {place}", parts.join(" and "))
}

impl Deviation {
    /// Describes the deviation in a sentence: `limb 'leg x': 'bar' is 0.2 mm longer`.
    #[must_use]
    pub fn description(&self) -> String {
        words(self)
    }
}
