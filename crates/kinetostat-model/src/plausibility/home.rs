//! Figures that are possible but unlikely: usually a unit or a decimal point is wrong.

use kinetostat::number::{apart, larger, short};
use kinetostat::{Chain, Mechanism, Pose};

use crate::elements::placement::{corners, pose};
use crate::plausibility::LimbCheck;
use crate::plausibility::at_home::{conditioning, frames, machine_size};
use crate::plausibility::link_matrix::check as check_link_matrices;
use crate::plausibility::masses::{next_to_nothing, no_body};
use crate::plausibility::numbers::{numbers, of_numbers};
use crate::problem::{Finding, KeyPath};
use crate::schema::Document;

/// Pose of a chain's tip in its base at home, and how far (m) any of its frames lies from its first
/// one: the first offset only places the chain.
fn tip(chain: &Chain) -> (Pose, f64) {
    let frames = frames(chain);
    let at = |f: &Pose| f.translation.vector;
    let origin = frames.get(1).map_or_else(Default::default, at);
    let reach = frames.iter().skip(1).map(|f| (at(f) - origin).norm());
    (
        frames.last().copied().unwrap_or_default(),
        reach.fold(0.0, larger),
    )
}

/// Springs with more loss than any material.
const LOSSY: f64 = 1.0;

/// Finding of a machine in which nothing gives way.
pub(crate) const NOTHING_YIELDS: &str = "this model has no spring: nothing in it gives way, so that there is nothing to say of deflections and stiffness";

/// Says what is to be filled in where nothing gives way; none where something does.
pub(crate) fn without_stiffness(mechanism: &Mechanism) -> Option<String> {
    let limbs = mechanism.limbs();
    if limbs.iter().any(|limb| !limb.actual.springs().is_empty()) {
        return None;
    }
    let names: Vec<&str> = limbs
        .iter()
        .flat_map(|limb| limb.nominal.actuators())
        .map(|actuator| actuator.name.as_str())
        .collect();
    let more = match names.len().saturating_sub(8) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    let names = names[..names.len().min(8)].join(", ");
    Some(format!(
        "give the drives {names}{more} a stiffness_n_m_per_rad or stiffness_n_per_m in place of rigid_drive (an imported model says FILL IN \
         there; --joint-stiffness of `import urdf` writes them), and links that bend a stiffness"
    ))
}

/// Looks at sizes, masses, gravity and the home posture.
pub(crate) fn check_plausibility(
    document: &Document,
    mechanism: &Mechanism,
    warnings: &mut Vec<Finding>,
) {
    of_numbers(document, warnings);
    of_machine(document, mechanism, warnings);
    check_link_matrices(document, warnings);
    let root = KeyPath::root();
    if conditioning(mechanism).is_some_and(|ratio| ratio < 1e-4) {
        warnings.push(Finding::new(
            &root.key("platform").index(0).key("home"),
            "the arm is singular at home: two of its axes do the same there",
            "write home values of its joints at which it is not, as 30 degrees for joint 5; the search for joint values starts there",
        ));
    }
    if let Some(text) = without_stiffness(mechanism) {
        let place = root.key("limb").index(0);
        warnings.push(Finding::new(&place, NOTHING_YIELDS, text));
    }
    let loss = document
        .damping
        .as_ref()
        .and_then(|table| table.loss_factor);
    if let Some(loss) = loss.filter(|loss| *loss > LOSSY) {
        warnings.push(Finding::new(
            &root.key("damping").key("loss_factor"),
            format!(
                "a loss factor of {}: {} % of critical damping",
                short(loss),
                short(50.0 * loss)
            ),
            "structures of metal have 0.001 to 0.1, rubber up to 1, and from 2 on nothing swings; a ratio is half a loss factor",
        ));
    }
    let mut warn = |place: &KeyPath, message: String, help: &str| {
        warnings.push(Finding::new(place, message, help));
    };
    let gravity = mechanism.gravity();
    let size = gravity.norm();
    let place = root.key("mechanism").key("gravity_m_per_s2");
    if size > 0.0 && !(9.7..=9.9).contains(&size) {
        warn(
            &place,
            format!("gravity is {} m/s^2", short(size)),
            "on the ground it is 9.81 m/s^2; check the unit",
        );
    }
    if gravity.z > 0.5 * size {
        warn(
            &place,
            "gravity points up, along +z of the base".to_owned(),
            "write [0, 0, -9.81] for a base whose z points up; if the base hangs upside down, all is well",
        );
    }
    if size > 0.0 && gravity.z.abs() < 0.7 * size {
        let along = if gravity.x.abs() > gravity.y.abs() {
            "x"
        } else {
            "y"
        };
        warn(
            &place,
            format!("gravity points along {along} of the base, not along z"),
            "write [0, 0, -9.81] for a base whose z points up; if the base hangs on a wall, all is well",
        );
    }
    for (i, platform) in mechanism.platforms().iter().skip(1).enumerate() {
        let place = root.key("platform").index(i).key("inertia_kg_m2");
        if let Some(found) = no_body(&place, &platform.name, &platform.inertia) {
            warn(&place, found.message, &found.help);
        }
        let place = root.key("platform").index(i).key("mass_kg");
        if let Some(found) = next_to_nothing(&place, "the platform", platform.mass) {
            warn(&place, found.message, &found.help);
        }
        if platform.mass > 1e5 {
            warn(
                &root.key("platform").index(i).key("mass_kg"),
                format!("the platform weighs {} kg", short(platform.mass)),
                "check the unit",
            );
        }
    }
    for (i, limb) in mechanism.limbs().iter().enumerate() {
        let place = root.key("limb").index(i);
        let chain = &limb.nominal;
        let (tip, reach) = tip(chain);
        if reach > 100.0 || (reach > 0.0 && reach < 1e-3) {
            warn(
                &place,
                format!("the limb '{}' reaches over {} m", limb.name, short(reach)),
                "machines lie between a millimetre and 100 m; check the units of its chain",
            );
        }
        if let Some(body) = chain.bodies().iter().find(|b| b.mass > 1e5) {
            warn(
                &place,
                format!(
                    "the body '{}' of this limb weighs {} kg",
                    body.name,
                    short(body.mass)
                ),
                "check the unit",
            );
        }
        let (from, to) = (
            &mechanism.platforms()[limb.from].home,
            &mechanism.platforms()[limb.to].home,
        );
        let reached = from * tip;
        let wanted = to * limb.platform_from_tip;
        let distance = (reached.translation.vector - wanted.translation.vector).norm();
        let turn = reached.rotation.angle_to(&wanted.rotation);
        if distance > 1e-3 * reach.max(1e-3) || turn > 1e-2 {
            warn(
                &place,
                format!(
                    "at home the limb '{}' ends {} away from the platform '{}'",
                    limb.name,
                    apart(distance * 1e3, turn.to_degrees()),
                    mechanism.platforms()[limb.to].name
                ),
                "correct the home values of its joints, or the home pose of the platform; the search for joint values starts there",
            );
        }
    }
}

/// Looks at figures beside the rest of the machine.
fn of_machine(document: &Document, mechanism: &Mechanism, warnings: &mut Vec<Finding>) {
    let size = machine_size(mechanism);
    // A machine whose axes meet in one point has no size to compare with.
    let sized = size > 0.0 && size.is_finite();
    // Limbs of the same chain would say the same again.
    let mut seen: Vec<&str> = Vec::new();
    for (i, written) in document.limb.iter().enumerate() {
        if seen.contains(&written.chain.as_str()) {
            continue;
        }
        seen.push(&written.chain);
        let check = LimbCheck {
            document,
            mechanism,
            limb: i,
            size,
        };
        check.bodies(warnings);
        if !sized {
            continue;
        }
        check.stiffnesses(warnings);
        check.windup(warnings);
        check.springs6(warnings);
        check.sag(warnings);
        check.masses(warnings);
        check.ranges(warnings);
    }
    if !sized {
        return;
    }
    workspace(document, mechanism, size, warnings);
    deviations(document, size, warnings);
    free_lengths(document, size, warnings);
}

fn workspace(document: &Document, mechanism: &Mechanism, size: f64, warnings: &mut Vec<Finding>) {
    let Ok(Some((a, b))) = corners(document) else {
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
            &KeyPath::root().key("workspace"),
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
        let table = KeyPath::root().key("deviation").index(i);
        let moved =
            (deviation.moved_by.as_ref()).and_then(|m| pose(&table.key("moved_by"), m).ok());
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

/// Springs between points whose free length is nothing beside the machine, but not zero (the ideal compensator),
/// or several machines long.
fn free_lengths(document: &Document, size: f64, warnings: &mut Vec<Finding>) {
    let Ok(tree) = serde_json::to_value(document) else {
        return;
    };
    for number in numbers(&tree) {
        let unit = match number.key {
            "free_length_mm" => 1e-3,
            "free_length_m" => 1.0,
            _ => continue,
        };
        let metres = number.value * unit;
        if metres > 0.0 && !(0.01 * size..=2.0 * size).contains(&metres) {
            warnings.push(Finding::new(
                &number.place,
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
