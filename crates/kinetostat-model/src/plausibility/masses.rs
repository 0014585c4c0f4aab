//! Bodies beside the other bodies of their limb, beside the links that carry them, and beside the machine.

use kinetostat::model::Body;
use kinetostat::number::short;
use nalgebra::Matrix3;

use crate::elements::part::inertia;
use crate::plausibility::LimbCheck;
use crate::plausibility::at_home::{farthest, reach};
use crate::problem::{Finding, KeyPath};

/// An inertia that no body has: a principal moment is larger than the sum of the others.
pub(crate) fn no_body(place: &KeyPath, name: &str, inertia: &Matrix3<f64>) -> Option<Finding> {
    let size = inertia.amax();
    if size == 0.0 {
        return None;
    }
    // Scaled first: squares of extreme numbers would not be finite.
    let mut moments = (inertia / size).symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    if moments[2] <= moments[0] + moments[1] + ROUNDING {
        return None;
    }
    let [least, middle, most] = [0, 1, 2].map(|k| short(moments[k] * size));
    Some(Finding::new(
        place,
        format!(
            "the inertia of '{name}' is that of no body: its principal moments are {least}, {middle} and {most} kg m^2, and the largest cannot exceed the sum of the others"
        ),
        "check the entries, their unit and the signs of the products; statics does not use it, vibrations refuse it",
    ))
}

/// Inertia of a body about its centre of mass from its rows, kg m^2.
///
/// ```
/// let flat = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.1]];
/// let (message, _) = kinetostat_model::inertia_of_body(flat).unwrap_err();
/// assert!(message.contains("the largest cannot exceed the sum of the others"));
/// ```
///
/// # Errors
/// The fault and what to do: rows that are not symmetric, moments below zero or beyond the sum of the others.
pub fn inertia_of_body(rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, (String, String)> {
    let place = KeyPath::root();
    let read = inertia(&place, Some(rows)).and_then(|inertia| {
        let fault = no_body(&place, "tool", &inertia);
        fault.map_or(Ok(inertia), Err)
    });
    read.map_err(|found| (found.message, found.help))
}

/// An inertia without a mass: no body turns hard and weighs nothing.
fn without_mass(place: &KeyPath, body: &Body) -> Option<Finding> {
    let name = &body.name;
    (body.mass == 0.0 && body.inertia.amax() > 0.0).then(|| {
        Finding::new(
            place,
            format!("the body '{name}' has an inertia and no mass"),
            "write its mass_kg, or leave out its inertia_kg_m2; that of a drive's rotor is written with the drive",
        )
    })
}

/// Rounding of inertias in files, the same as in the dynamics.
const ROUNDING: f64 = 1e-6;

/// A body that weighs next to nothing, kg: a hundredth of a gram. What has no mass is written with 0.
const LIGHT: f64 = 1e-5;

/// A mass that no part of a machine has.
pub(crate) fn next_to_nothing(place: &KeyPath, what: &str, mass: f64) -> Option<Finding> {
    (mass > 0.0 && mass < LIGHT).then(|| {
        Finding::new(
            place,
            format!("{what} weighs {} kg", short(mass)),
            "check the unit: kg; a part without mass is written with 0",
        )
    })
}

impl LimbCheck<'_> {
    /// Bodies by themselves, whatever the size of the machine.
    pub(crate) fn bodies(&self, warnings: &mut Vec<Finding>) {
        for body in self.mechanism.limbs()[self.limb].nominal.bodies() {
            let place = self.place(&body.name, &["inertia_kg_m2"]);
            warnings.extend(no_body(&place, &body.name, &body.inertia));
            let place = self.place(&body.name, &["mass_kg"]);
            warnings.extend(without_mass(&place, body));
            let what = format!("the body '{}'", body.name);
            warnings.extend(next_to_nothing(&place, &what, body.mass));
        }
    }

    pub(crate) fn masses(&self, warnings: &mut Vec<Finding>) {
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
            let heavy = body.mass > 1500.0 * self.size.max(0.3);
            let odd = beside.is_some_and(|m| body.mass > 200.0 * m) && body.mass > 100.0;
            if heavy || odd {
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
        self.placeholders(warnings);
    }

    /// Masses of an arm that were never meant: equal everywhere, or too heavy or too light for its reach.
    fn placeholders(&self, warnings: &mut Vec<Finding>) {
        let limbs = self.mechanism.limbs();
        let masses: Vec<f64> = limbs[self.limb]
            .nominal
            .bodies()
            .iter()
            .map(|b| b.mass)
            .collect();
        let Some(first) = limbs[self.limb].nominal.bodies().first() else {
            return;
        };
        let mut warn = |message: String| {
            warnings.push(Finding::new(
                &self.place(&first.name, &["mass_kg"]),
                message,
                "gravity will be wrong if these are placeholders: write the true masses, or gravity_m_per_s2 = [0, 0, 0] under [mechanism]",
            ));
        };
        let same = |mass: &f64| (mass - first.mass).abs() <= 1e-9 * first.mass;
        if masses.len() >= 3 && first.mass > 0.0 && masses.iter().all(same) {
            warn(format!(
                "all {} bodies of this limb have the same mass, {} kg",
                masses.len(),
                short(first.mass)
            ));
        }
        let reach = reach(&limbs[self.limb].nominal);
        let total: f64 = masses.iter().sum();
        let ratio = total / (reach * reach);
        let is_arm = limbs.len() == 1 && masses.len() >= 3 && reach > 0.05;
        if is_arm && total > 0.0 && !(LIGHTEST..=HEAVIEST).contains(&ratio) {
            let (word, side, usual) = match ratio > HEAVIEST {
                true => ("much", "heaviest", 250.0),
                false => ("little", "lightest", 10.0),
            };
            warn(format!(
                "the bodies weigh {} kg in all, {word} for an arm of {reach:.2} m: those of the {side} that are built have about {:.0} kg",
                short(total),
                usual * reach * reach
            ));
        }
    }

    /// Bodies beside the next ones of their limb: what is carried weighs less than what carries it, and no
    /// part weighs next to nothing between others.
    fn neighbours(&self, warnings: &mut Vec<Finding>) {
        let limbs = self.mechanism.limbs();
        let chain = &limbs[self.limb].nominal;
        // If other limbs carry too, a light bar may lead to a heavy arm.
        let only_limb = limbs.iter().filter(|l| l.to == limbs[self.limb].to).count() == 1;
        let mut bodies: Vec<&Body> = chain.bodies().iter().collect();
        bodies.retain(|b| b.mass > 0.0);
        bodies.sort_by_key(|b| b.node);
        for (i, body) in bodies.iter().enumerate() {
            let before = i.checked_sub(1).map(|k| bodies[k]);
            let after = bodies.get(i + 1).copied();
            let lightest = before.into_iter().chain(after);
            let lightest = lightest.min_by(|a, b| a.mass.total_cmp(&b.mass));
            let (other, said) = match (before, lightest) {
                // If the neighbour is almost massless, the neighbour is reported.
                (Some(before), _) if body.mass > BESIDE * before.mass => continue,
                (Some(before), _) if only_limb && body.mass > CARRIED * before.mass => {
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
            let of = |s: &&kinetostat::model::SpringBlock| {
                s.segment.as_ref().is_some_and(|g| g.link == link)
            };
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
}

/// A body that is heavier than the one that carries it by this was given in newtons (9.81) or is odd anyhow.
const CARRIED: f64 = 3.0;

/// A body that is lighter than those next to it by this was given in tonnes (1000) or is odd anyhow.
const BESIDE: f64 = 50.0;

/// Moving mass per reach squared, kg/m^2, of arms as they are built: 10 (light collaborative arms) to 250 (heavy ones of 700 kg
/// payload); a factor of about 1.3 to 3 beside these is let pass.
const LIGHTEST: f64 = 3.0;
const HEAVIEST: f64 = 330.0;
