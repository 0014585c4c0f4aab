//! What smells of a wrong unit: each number as it is written, and figures that do not fit the rest
//! of the machine.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use kinetostat::number::short;

use kinetostat::{Mechanism, MotionKind, Role, SpringLaw};
use serde_json::Value;
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::load_path::{farthest, moments, size_of};
use crate::problem::{Finding, Place};
use crate::schema::{Document, Element};

/// Looks at every number under the unit of its key.
pub(crate) fn of_numbers(document: &Document, warnings: &mut Vec<Finding>) {
    let Ok(tree) = serde_json::to_value(document) else {
        return;
    };
    walk(&tree, "", &Place::root(), warnings);
}

/// Angles of a TOML text that were most likely written in the other unit: what is said, and its place in the text.
/// Empty for what is no TOML.
#[must_use]
pub fn odd_angles(text: &str) -> Vec<(Range<usize>, String)> {
    let mut found = Vec::new();
    if let Ok(table) = DeTable::parse(text) {
        let value = DeValue::Table(table.into_inner());
        angles(&Spanned::new(0..text.len(), value), "", &mut found);
    }
    found
}

fn angles(value: &Spanned<DeValue<'_>>, key: &str, found: &mut Vec<(Range<usize>, String)>) {
    let number = match value.get_ref() {
        DeValue::Table(table) => {
            for (key, inner) in table {
                angles(inner, key.get_ref(), found);
            }
            return;
        }
        DeValue::Array(list) => {
            for inner in list {
                angles(inner, key, found);
            }
            return;
        }
        DeValue::Float(number) => number.as_str(),
        DeValue::Integer(number) => number.as_str(),
        _ => return,
    };
    let angle = key.ends_with("_deg") || key.ends_with("_rad");
    let smelt = number.parse().ok().filter(|_| angle);
    if let Some((message, help)) = smelt.and_then(|x| smell(key, x)) {
        found.push((value.span(), format!("{key}: {message}; {help}")));
    }
}

fn walk(value: &Value, key: &str, place: &Place, warnings: &mut Vec<Finding>) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                walk(inner, key, &place.key(key), warnings);
            }
        }
        Value::Array(list) => {
            for (i, inner) in list.iter().enumerate() {
                walk(inner, key, &place.index(i), warnings);
            }
        }
        Value::Number(number) => {
            if let Some((message, help)) = number.as_f64().and_then(|x| smell(key, x)) {
                warnings.push(Finding::new(place, message, help));
            }
        }
        _ => {}
    }
}

/// Parts of a section, which may be thin but not that thin.
const SECTION_KEYS: [&str; 8] = [
    "outer_diameter",
    "inner_diameter",
    "diameter",
    "width",
    "height",
    "flange",
    "web",
    "wall",
];

fn smell(key: &str, x: f64) -> Option<(String, &'static str)> {
    if key == "repeatability_mm" && !(5e-4..=1.0).contains(&x) {
        return Some((
            format!("a repeatability of {} mm", short(x)),
            "arms repeat within 0.02 to 0.2 mm, machine tools within 0.001 to 0.01 mm; check the unit",
        ));
    }
    let compound = key.contains("_per_") || key.contains("n_m") || key.contains("kg_m");
    if x == 0.0 || compound {
        return None;
    }
    if key.ends_with("_rad") && x.abs() > 7.0 && (x.abs() > 40.0 || x % 5.0 == 0.0) {
        return Some((
            format!("{x} rad are {:.0} turns", (x / TAU).abs().max(1.0)),
            "this looks like degrees: write the key with _deg",
        ));
    }
    if key.ends_with("_deg") && looks_like_radians(x) {
        return Some((
            format!("{x} degrees are exactly {} in radians", share_of_pi(x)),
            "this looks like radians: write the key with _rad",
        ));
    }
    let moment = key.starts_with("second_moment") || key.starts_with("torsion_constant");
    let moment = moment.then(|| match key.strip_suffix("_mm4") {
        Some(_) => 1e-12 * x,
        None => x,
    });
    // Of a section 2 m wide.
    if let Some(m4) = moment.filter(|m4| *m4 > 1.0) {
        return Some((
            format!("a second moment of {} m^4", short(m4)),
            "no part of a robot has sections of metres; check the unit in the key: _mm4 or _m4",
        ));
    }
    let (name, metres) = match (key.strip_suffix("_mm"), key.strip_suffix("_m")) {
        (Some(name), _) => (name, 1e-3 * x),
        (None, Some(name)) => (name, x),
        _ => return None,
    };
    // Limits are often written far out where there are none.
    if metres.abs() > 50.0 && name != "limits" {
        return Some((
            format!("a length of {} m", short(metres.abs())),
            "robots are smaller; check the unit in the key: _mm or _m",
        ));
    }
    let least = match name {
        "length" => 1e-3,
        _ if SECTION_KEYS.iter().any(|k| name.ends_with(k)) => 5e-5,
        _ => return None,
    };
    (metres < least).then(|| {
        (
            format!(
                "the {} is {} mm",
                name.replace('_', " "),
                short(1e3 * metres)
            ),
            "parts of robots are larger; check the unit in the key: _mm or _m",
        )
    })
}

/// Twelfths of a half turn by which angles are usually written.
const USUAL: [f64; 7] = [2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 24.0];

fn looks_like_radians(x: f64) -> bool {
    USUAL
        .iter()
        .any(|k| (x.abs() / (k * PI / 12.0) - 1.0).abs() < 6e-4)
}

fn share_of_pi(x: f64) -> String {
    let degrees = (x.to_degrees() / 15.0).round() * 15.0;
    format!("{degrees} degrees")
}

/// Looks at figures beside the rest of the machine.
pub(crate) fn of_machine(document: &Document, mechanism: &Mechanism, warnings: &mut Vec<Finding>) {
    let size = size_of(mechanism);
    if size <= 0.0 || !size.is_finite() {
        return;
    }
    // Limbs of the same chain would say the same again.
    let mut seen: Vec<&str> = Vec::new();
    for (i, written) in document.limb.iter().enumerate() {
        if seen.contains(&written.chain.as_str()) {
            continue;
        }
        seen.push(&written.chain);
        let look = Look {
            document,
            mechanism,
            limb: i,
            size,
        };
        look.stiffnesses(warnings);
        look.windup(warnings);
        look.springs6(warnings);
        look.sag(warnings);
        look.masses(warnings);
        look.ranges(warnings);
    }
    workspace(document, mechanism, size, warnings);
    deviations(document, size, warnings);
    if let Ok(tree) = serde_json::to_value(document) {
        free_lengths(&tree, &Place::root(), size, warnings);
    }
}

/// Springs between points whose free length is nothing beside the machine, but not zero (the ideal compensator),
/// or several machines long.
fn free_lengths(value: &Value, place: &Place, size: f64, warnings: &mut Vec<Finding>) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                let unit = match key.as_str() {
                    "free_length_mm" => 1e-3,
                    "free_length_m" => 1.0,
                    _ => {
                        free_lengths(inner, &place.key(key), size, warnings);
                        continue;
                    }
                };
                let metres = inner.as_f64().unwrap_or(0.0) * unit;
                if metres > 0.0 && !(0.01 * size..=2.0 * size).contains(&metres) {
                    warnings.push(Finding::new(
                        &place.key(key),
                        format!(
                            "a spring with a free length of {} mm, in a machine of {} m",
                            short(1e3 * metres),
                            short(size)
                        ),
                        "check the unit in the key: _mm or _m; 0 is the ideal compensator",
                    ));
                }
            }
        }
        Value::Array(list) => {
            for (i, inner) in list.iter().enumerate() {
                free_lengths(inner, &place.index(i), size, warnings);
            }
        }
        _ => {}
    }
}

/// A drive that is softer than the next one by this was given per degree (57.3) or is odd anyhow.
const PER_DEGREE: f64 = 20.0;

/// A body that is heavier than the one that carries it by this was given in newtons (9.81) or is odd anyhow.
const CARRIED: f64 = 3.0;

/// A body that is lighter than those next to it by this was given in tonnes (1000) or is odd anyhow.
const BESIDE: f64 = 50.0;

/// One limb of a machine.
struct Look<'a> {
    document: &'a Document,
    mechanism: &'a Mechanism,
    limb: usize,
    /// Of the machine, m.
    size: f64,
}

impl Look<'_> {
    /// An element of the limb's chain and its place in the file, by its name.
    fn element(&self, name: &str) -> Option<(&Element, Place)> {
        let chain = &self.document.limb[self.limb].chain;
        let elements = &self.document.chain.get(chain)?.elements;
        let own = |e: &Element, i: usize| match e.name() {
            Some(given) => given == name,
            None => format!("{} {}", e.word(), i + 1) == name,
        };
        let index = (0..elements.len()).find(|&i| own(&elements[i], i))?;
        let place = Place::root().key("chain").key(chain);
        Some((&elements[index], place.key("elements").index(index)))
    }

    fn place(&self, name: &str, keys: &[&str]) -> Place {
        match self.element(name) {
            Some((element, place)) => {
                let written = serde_json::to_value(element).unwrap_or_default();
                let has = |key: &&&str| written.get(**key).is_some_and(|v| !v.is_null());
                keys.iter()
                    .find(has)
                    .map_or(place.clone(), |k| place.key(k))
            }
            None => Place::root().key("limb").index(self.limb),
        }
    }

    /// Drives with a stiffness of their own: name, kind, N/m or N m/rad.
    fn drives(&self) -> Vec<(&str, MotionKind, f64)> {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        chain
            .actuators()
            .iter()
            .filter_map(|a| {
                let coordinate = a.coordinate?;
                let spring = chain.springs().iter().find(|s| s.first == coordinate)?;
                match &spring.law {
                    SpringLaw::Linear(k) if k.len() == 1 => {
                        Some((a.name.as_str(), a.kind, k[(0, 0)]))
                    }
                    _ => None,
                }
            })
            .collect()
    }

    /// Drives that give way under their rating by what no drive does: gears wind up by 0.0004 to 0.02
    /// rad (cycloidal gears by 0.001 of their own, with joint and castings around them by 0.004; strain
    /// wave gears by 0.002 to 0.01), screws and motors by 0.003 to 1 mm.
    fn windup(&self, warnings: &mut Vec<Finding>) {
        for (name, kind, k) in self.drives() {
            let Some((Element::Actuator(a), place)) = self.element(name) else {
                continue;
            };
            let (key, rating, low, high, usual) = match kind {
                MotionKind::Revolute => (
                    "rated_torque_n_m",
                    a.rated_torque_n_m,
                    4e-4,
                    2e-2,
                    "gears wind up by 0.02 to 1 degree: check the units of stiffness (per radian, not per degree) and rating",
                ),
                MotionKind::Prismatic => (
                    "rated_force_n",
                    a.rated_force_n,
                    3e-6,
                    1e-3,
                    "screws and motors give way by 0.003 to 1 mm: check the units of stiffness and rating",
                ),
            };
            let Some(gives) = rating.map(|r| r / k) else {
                continue;
            };
            if !(low..=high).contains(&gives) {
                let amount = match kind {
                    MotionKind::Revolute => format!("{} degrees", short(gives.to_degrees())),
                    MotionKind::Prismatic => format!("{} mm", short(1e3 * gives)),
                };
                warnings.push(Finding::new(
                    &place.key(key),
                    format!("the drive '{name}' gives way by {amount} under its rating"),
                    usual,
                ));
            }
        }
    }

    /// Drives out of all proportion, by themselves and beside the others of the limb.
    fn stiffnesses(&self, warnings: &mut Vec<Finding>) {
        let drives = self.drives();
        const KEYS: [&str; 4] = [
            "stiffness_n_per_m",
            "stiffness_n_per_mm",
            "stiffness_n_m_per_rad",
            "stiffness_n_mm_per_rad",
        ];
        // Drives nearer to the base carry more and are stiffer.
        for pair in drives.windows(2) {
            let [(name, kind, k), (next, of_next, behind)] = pair else {
                continue;
            };
            if *kind == MotionKind::Revolute && kind == of_next && *behind > PER_DEGREE * k {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' is {:.0} times softer than '{next}' behind it, which carries less",
                        behind / k
                    ),
                    "check the unit: per radian, which is 57.3 times the figure per degree",
                ));
            }
        }
        for (name, kind, k) in &drives {
            let (low, high, unit, mistake) = match kind {
                // Belts from 1e5, screws 2e7 to 1e9, linear motors 1e7 to 1e9 N/m.
                MotionKind::Prismatic => (
                    5e4,
                    3e9,
                    "N/m",
                    "_n_per_mm or _n_per_m; belts have from 1e5, screws 2e7 to 1e9 N/m",
                ),
                // At the joint: strain wave gears of small arms 100 to 1e6, cycloidal (RV) gears 1e5
                // to 2e7 N m/rad.
                MotionKind::Revolute => (
                    100.0,
                    5e7,
                    "N m/rad",
                    "_n_m_per_rad or _n_mm_per_rad; strain wave gears have 100 to 1e6, cycloidal gears 1e5 to 2e7 N m/rad",
                ),
            };
            // Exactly 1 is the unit of a machine that teaches, not a figure of a drive.
            if (*k < low && *k != 1.0) || *k > high {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' has {} {unit}, {} than any machine's",
                        short(*k),
                        if *k < low { "softer" } else { "stiffer" }
                    ),
                    format!("check the unit in the key: {mistake}"),
                ));
            }
            let mut others: Vec<f64> = drives
                .iter()
                .filter(|(other, own, _)| own == kind && other != name)
                .map(|(_, _, k)| *k)
                .collect();
            if others.len() < 2 {
                continue;
            }
            others.sort_by(f64::total_cmp);
            let ratio = k / others[others.len() / 2];
            if !(1.0 / 300.0..=300.0).contains(&ratio) {
                warnings.push(Finding::new(
                    &self.place(name, &KEYS),
                    format!(
                        "the drive '{name}' is {:.0} times {} than the other drives of its limb",
                        ratio.max(1.0 / ratio),
                        if ratio < 1.0 { "softer" } else { "stiffer" }
                    ),
                    format!("check the unit in the key: {mistake}"),
                ));
            }
        }
    }

    /// Springs of six directions whose translations and rotations do not belong together: the square
    /// root of N m/rad by N/m is a length of the part.
    fn springs6(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        for spring in chain.springs().iter().filter(|s| s.segment.is_none()) {
            let SpringLaw::Linear(k) = &spring.law else {
                continue;
            };
            if k.nrows() != 6 {
                continue;
            }
            let mean =
                |range: std::ops::Range<usize>| range.map(|i| k[(i, i)]).product::<f64>().cbrt();
            let length = (mean(3..6) / mean(0..3)).sqrt();
            if !(1e-4 * self.size..=5.0 * self.size).contains(&length) {
                warnings.push(Finding::new(
                    &self.place(&spring.name, &["spring6"]),
                    format!(
                        "the translations and rotations of the spring '{}' belong to a part of {} m, in a machine of {} m",
                        spring.name,
                        short(length),
                        short(self.size)
                    ),
                    "check the unit of the matrix: _n_m_rad or _n_mm_rad",
                ));
            }
        }
    }

    /// Joints that give way far under the weight alone.
    fn sag(&self, warnings: &mut Vec<Finding>) {
        let limb = &self.mechanism.limbs()[self.limb];
        // With several limbs the others carry too.
        if self.mechanism.limbs().len() > 1 || limb.nominal.springs().is_empty() {
            return;
        }
        let loads = moments(self.mechanism, self.limb);
        for spring in limb.nominal.springs() {
            let SpringLaw::Linear(k) = &spring.law else {
                continue;
            };
            if k.len() != 1 {
                continue;
            }
            let Some(load) = loads.iter().find(|l| l.coordinate == spring.first) else {
                continue;
            };
            let gives = load.size / k[(0, 0)];
            let kind = limb.nominal.coordinates()[spring.first].kind;
            let (most, text) = match kind {
                MotionKind::Revolute => {
                    (0.1, format!("turns by {:.0} degrees", gives.to_degrees()))
                }
                MotionKind::Prismatic => (
                    0.03 * self.size,
                    format!("slides by {} mm", short((1e3 * gives).round())),
                ),
            };
            if gives > most
                && !limb
                    .nominal
                    .coordinates()
                    .iter()
                    .any(|c| c.role == Role::Passive)
            {
                warnings.push(Finding::new(
                    &self.place(
                        &spring.name,
                        &[
                            "stiffness_n_per_m",
                            "stiffness_n_per_mm",
                            "stiffness_n_m_per_rad",
                            "stiffness_n_mm_per_rad",
                        ],
                    ),
                    format!(
                        "the joint '{}' {text} under the machine's own weight",
                        spring.name
                    ),
                    "check the units of its stiffness and of the masses behind it",
                ));
            }
        }
    }

    fn masses(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        let bodies = chain.bodies();
        for body in bodies {
            let mut others: Vec<f64> = bodies
                .iter()
                .filter(|b| b.name != body.name && b.mass > 0.0)
                .map(|b| b.mass)
                .collect();
            others.sort_by(f64::total_cmp);
            let beside = others.get(others.len() / 2).copied();
            let alone = body.mass > 1500.0 * self.size.max(0.3);
            let odd = beside.is_some_and(|m| body.mass > 200.0 * m) && body.mass > 100.0;
            if alone || odd {
                let beside = match beside {
                    Some(m) if odd => format!(", most others about {} kg", short(m)),
                    _ => format!(", in a machine of {} m", short(self.size)),
                };
                warnings.push(Finding::new(
                    &self.place(&body.name, &["mass_kg"]),
                    format!(
                        "the body '{}' weighs {} kg{beside}",
                        body.name,
                        short(body.mass)
                    ),
                    "check the unit, and whether it is a placeholder",
                ));
            }
            let gyration = (body.inertia.diagonal().amax() / body.mass).sqrt();
            if body.mass > 0.0 && gyration > 2.0 * self.size.max(0.5) {
                warnings.push(Finding::new(
                    &self.place(&body.name, &["inertia_kg_m2"]),
                    format!(
                        "the inertia of the body '{}' is that of a part of {} m",
                        body.name,
                        short(gyration)
                    ),
                    "inertias are in kg m^2; statics does not use them",
                ));
            }
        }
        if let Some((body, centre)) = farthest(chain)
            && centre > self.size.max(0.3)
        {
            warnings.push(Finding::new(
                &self.place(&body, &["centre_of_mass_mm", "centre_of_mass_m"]),
                format!(
                    "the centre of mass of the body '{body}' is {} m away from any joint of its limb, in a machine of {} m",
                    short(centre),
                    short(self.size)
                ),
                "check the unit in the key: _mm or _m",
            ));
        }
        self.neighbours(warnings);
        self.density(warnings);
    }

    /// Bodies beside the next ones of their limb: what is carried weighs less than what carries it, and no
    /// part weighs next to nothing between others.
    fn neighbours(&self, warnings: &mut Vec<Finding>) {
        let limbs = self.mechanism.limbs();
        let chain = &limbs[self.limb].nominal;
        // Where other limbs carry too, a light bar may lead to a heavy arm.
        let alone = limbs.iter().filter(|l| l.to == limbs[self.limb].to).count() == 1;
        let mut bodies: Vec<&kinetostat::Body> = chain.bodies().iter().collect();
        bodies.retain(|b| b.mass > 0.0);
        bodies.sort_by_key(|b| b.node);
        for (i, body) in bodies.iter().enumerate() {
            let before = i.checked_sub(1).map(|k| bodies[k]);
            let after = bodies.get(i + 1).copied();
            let lightest = before.into_iter().chain(after);
            let lightest = lightest.min_by(|a, b| a.mass.total_cmp(&b.mass));
            let (other, said) = match (before, lightest) {
                // Beside one that weighs next to nothing it is that one which is told.
                (Some(before), _) if body.mass > BESIDE * before.mass => continue,
                (Some(before), _) if alone && body.mass > CARRIED * before.mass => {
                    (before, "which carries it")
                }
                (_, Some(lightest)) if body.mass * BESIDE < lightest.mass => {
                    (lightest, "which is next to it")
                }
                _ => continue,
            };
            warnings.push(Finding::new(
                &self.place(&body.name, &["mass_kg"]),
                format!(
                    "the body '{}' weighs {} kg, and '{}', {said}, {} kg",
                    body.name,
                    short(body.mass),
                    other.name,
                    short(other.mass)
                ),
                "check the unit: kg, not N (9.81 times as much), t or g",
            ));
        }
    }

    /// Bodies beside what the links of their stiffness would weigh: `rho / E` is 3.8e-8 s^2/m^2 for
    /// steel, aluminium and titanium alike.
    fn density(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.mechanism.limbs()[self.limb].nominal;
        let pieces = |link: &str| {
            let of =
                |s: &&kinetostat::SpringBlock| s.segment.as_ref().is_some_and(|g| g.link == link);
            chain.springs().iter().filter(of).count() as f64
        };
        let links: f64 = chain
            .springs()
            .iter()
            .filter_map(|s| {
                let segment = s.segment.as_ref()?;
                let k = s.stiffness_at(&vec![0.0; s.len()]);
                let axial = segment.along.transpose() * k.fixed_view::<3, 3>(0, 0) * segment.along;
                let length = segment.link_length / pieces(&segment.link);
                Some(3.8e-8 * axial[0] * length * length)
            })
            .sum();
        let bodies: f64 = chain.bodies().iter().map(|b| b.mass).sum();
        if links <= 0.0 || bodies <= 0.0 {
            return;
        }
        let ratio = bodies / links;
        if !(0.01..=300.0).contains(&ratio) {
            warnings.push(Finding::new(
                &self.place(&chain.bodies()[0].name, &["mass_kg"]),
                format!(
                    "the masses of the limb are {} kg, but links of that stiffness weigh about {} kg in any metal",
                    short(bodies),
                    short(links)
                ),
                "check the density behind the masses (steel: 7850 kg/m^3), and the moduli and sizes of the sections",
            ));
        }
    }

    /// Ranges of turning actuators too small to be degrees.
    fn ranges(&self, warnings: &mut Vec<Finding>) {
        let chain = &self.document.limb[self.limb].chain;
        let Some(table) = self.document.chain.get(chain) else {
            return;
        };
        let place = Place::root().key("chain").key(chain).key("elements");
        for (i, element) in table.elements.iter().enumerate() {
            let Element::Actuator(actuator) = element else {
                continue;
            };
            if let Some([low, high]) = actuator.limits_deg
                && high - low > 0.5
                && low.abs().max(high.abs()) <= TAU + 0.01
            {
                warnings.push(Finding::new(
                    &place.index(i).key("limits_deg"),
                    format!(
                        "the joint turns by only {} degrees in all",
                        short(high - low)
                    ),
                    "this looks like radians: write limits_rad",
                ));
            }
        }
    }
}

fn workspace(document: &Document, mechanism: &Mechanism, size: f64, warnings: &mut Vec<Finding>) {
    let Ok(Some((a, b))) = crate::assemble::corners(document) else {
        return;
    };
    let home = mechanism.platforms()[mechanism.tool()]
        .home
        .translation
        .vector;
    let far = (a - home).norm().max((b - home).norm());
    let extent = (a - b).norm();
    if far > 5.0 * size || extent < 5e-3 * size {
        warnings.push(Finding::new(
            &Place::root().key("workspace"),
            format!(
                "the workspace is {} m large and lies up to {} m from the tool's home, in a machine of {} m",
                short(extent),
                short(far),
                short(size)
            ),
            "check the unit in its keys: _mm or _m",
        ));
    }
}

fn deviations(document: &Document, size: f64, warnings: &mut Vec<Finding>) {
    for (i, deviation) in document.deviation.iter().enumerate() {
        let table = Place::root().key("deviation").index(i);
        let moved = (deviation.moved_by.as_ref())
            .and_then(|m| crate::placement::pose(&table.key("moved_by"), m).ok());
        let (shift, turn, key) = match (moved, deviation.longer_by_mm, deviation.tilted_by_deg) {
            (Some(m), _, _) => (
                m.translation.vector.norm(),
                m.rotation.angle().to_degrees(),
                "moved_by",
            ),
            (_, Some(mm), _) => (1e-3 * mm.abs(), 0.0, "longer_by_mm"),
            (_, _, Some(deg)) => (0.0, deg.abs(), "tilted_by_deg"),
            _ => continue,
        };
        let place = table.key(key);
        if turn > 10.0 || shift > 0.05 * size {
            warnings.push(Finding::new(
                &place,
                format!(
                    "an error of assembly of {} mm and {} degrees",
                    short(1e3 * shift),
                    short(turn)
                ),
                "errors are small motions; check the unit in the key",
            ));
        }
    }
}
