//! Damping of vibrations: one law for the machine, or dampers of joints and springs.

use kinetostat::MotionKind;
use kinetostat_dynamics::Damping;

use crate::elements::joint::kind;
use crate::elements::quantity::{ReadResult, by_kind, choice};
use crate::problem::{Finding, KeyPath};
use crate::schema::{ActuatorKind, DampingTable, Document, Element, PassiveKind};

/// Reads the damping of the file; [`Damping::Undamped`] if it has none.
pub(crate) fn damping(document: &Document) -> ReadResult<Damping> {
    let root = KeyPath::root();
    let dampers = dampers(document)?;
    let law = match (&document.damping, dampers.is_empty()) {
        (None, true) => return Ok(Damping::Undamped),
        (None, false) => Damping::Viscous(dampers),
        (Some(table), true) => law_of(&root.key("damping"), table)?,
        (Some(_), false) => {
            return Err(Finding::new(
                &root.key("damping"),
                format!(
                    "'{}' has a damper of its own, and here is a law for the whole machine",
                    dampers[0].0
                ),
                "keep one of them: nobody knows which part of a measured ratio is that of the joints",
            ));
        }
    };
    let checked = law.check();
    checked.map_err(|error| {
        Finding::new(
            &root.key("damping"),
            error.to_string(),
            "machines have 0.01 to 0.1 of critical damping: ratio = 0.03",
        )
    })?;
    Ok(law)
}

/// Place of the law of damping, or of the strongest of several dampers; `None` if there is none.
pub(crate) fn damping_place(document: &Document) -> Option<KeyPath> {
    let root = KeyPath::root();
    if let Some(table) = &document.damping {
        let place = root.key("damping");
        let keys = [
            ("ratio", table.ratio.is_some()),
            ("ratios", table.ratios.is_some()),
            ("rayleigh", table.rayleigh.is_some()),
            ("loss_factor", table.loss_factor.is_some()),
        ];
        let key = keys.iter().find(|(_, stated)| *stated);
        return Some(key.map_or(place.clone(), |(key, _)| place.key(key)));
    }
    let mut strongest: Option<(f64, KeyPath)> = None;
    for (name, chain) in &document.chain {
        let place = root.key("chain").key(name).key("elements");
        for (index, element) in chain.elements.iter().enumerate() {
            let place = place.index(index);
            let Ok(Some(value)) = damper(&place, element) else {
                continue;
            };
            if strongest.as_ref().is_none_or(|(most, _)| value > *most) {
                let written = serde_json::to_value(element).unwrap_or_default();
                let keys = ["damping_n_s_per_m", "damping_n_m_s_per_rad"];
                let key = keys
                    .iter()
                    .find(|key| written.get(**key).is_some_and(|v| !v.is_null()));
                strongest = Some((value, key.map_or(place.clone(), |key| place.key(key))));
            }
        }
    }
    strongest.map(|(_, place)| place)
}

fn law_of(place: &KeyPath, table: &DampingTable) -> ReadResult<Damping> {
    let laws = [
        table.ratio.map(Damping::Ratio),
        table.ratios.clone().map(Damping::Ratios),
        table.rayleigh.map(|shares| Damping::Rayleigh {
            mass_per_s: shares.mass_per_s,
            stiffness_s: shares.stiffness_s,
        }),
        table
            .loss_factor
            .map(|loss_factor| Damping::Structural { loss_factor }),
    ];
    let mut laws = laws.into_iter().flatten();
    match (laws.next(), laws.next()) {
        (Some(law), None) => Ok(law),
        (None, _) => Err(Finding::new(
            place,
            "no law of damping is stated",
            "write ratio = 0.03 (3 % of critical), ratios, rayleigh or loss_factor",
        )),
        (Some(_), Some(_)) => Err(Finding::new(
            place,
            "two laws of damping are stated",
            "keep one of ratio, ratios, rayleigh and loss_factor",
        )),
    }
}

/// Dampers by the names of the coordinates that they are at, N s/m or N m s/rad.
fn dampers(document: &Document) -> ReadResult<Vec<(String, f64)>> {
    let mut all = Vec::new();
    for limb in &document.limb {
        let prefix = match document.limb.len() {
            1 => String::new(),
            _ => format!("{}.", limb.name),
        };
        let place = KeyPath::root()
            .key("chain")
            .key(&limb.chain)
            .key("elements");
        let elements = document.chain.get(&limb.chain).map(|chain| &chain.elements);
        for (index, element) in elements.into_iter().flatten().enumerate() {
            let Some(value) = damper(&place.index(index), element)? else {
                continue;
            };
            let name = element.name_or_number(index + 1);
            all.extend(ends_of(element).map(|end| (format!("{prefix}{name}{end}"), value)));
        }
    }
    Ok(all)
}

/// Suffixes of the names of an element's coordinates.
fn ends_of(element: &Element) -> impl Iterator<Item = &'static str> {
    let ends: &[&str] = match element {
        Element::Passive(e) => match e.passive {
            PassiveKind::Universal => &[".1", ".2"],
            PassiveKind::Spherical => &[".x", ".y", ".z"],
            PassiveKind::Prismatic | PassiveKind::Revolute => &[""],
        },
        _ => &[""],
    };
    ends.iter().copied()
}

fn damper(place: &KeyPath, element: &Element) -> ReadResult<Option<f64>> {
    let (kind, linear, angular) = match element {
        Element::Actuator(e) => (
            match e.actuator {
                ActuatorKind::Prismatic | ActuatorKind::Screw => MotionKind::Prismatic,
                ActuatorKind::Revolute => MotionKind::Revolute,
            },
            e.damping_n_s_per_m,
            e.damping_n_m_s_per_rad,
        ),
        Element::Passive(e) => (
            match e.passive {
                PassiveKind::Prismatic => MotionKind::Prismatic,
                PassiveKind::Revolute | PassiveKind::Universal | PassiveKind::Spherical => {
                    MotionKind::Revolute
                }
            },
            e.damping_n_s_per_m,
            e.damping_n_m_s_per_rad,
        ),
        Element::Spring(e) => (kind(e.spring), e.damping_n_s_per_m, e.damping_n_m_s_per_rad),
        _ => return Ok(None),
    };
    let linear = [choice("damping_n_s_per_m", linear, 1.0)];
    let angular = [choice("damping_n_m_s_per_rad", angular, 1.0)];
    let Some(given) = by_kind(place, "damper", kind, &linear, &angular)? else {
        return Ok(None);
    };
    if given.value < 0.0 {
        return Err(Finding::new(
            &place.key(given.key),
            format!(
                "the damper is {}, a number not below zero is needed",
                given.value
            ),
            "a damper takes energy out: write its size without a sign",
        ));
    }
    if let Element::Actuator(e) = element
        && e.rigid_drive == Some(true)
    {
        return Err(Finding::new(
            &place.key(given.key),
            "the drive is rigid, so nothing moves beside its damper",
            "write the drive's stiffness, or leave the damper out",
        ));
    }
    Ok(Some(given.value))
}
