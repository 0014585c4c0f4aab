//! Figures that are possible but unlikely: usually a unit or a decimal point is wrong.

use kinetostat::number::larger;
use kinetostat::number::{apart, short};
use kinetostat::{Chain, Mechanism, Pose};

use crate::plausibility::at_home::{conditioning, frames};
use crate::plausibility::link_matrix::check as check_link_matrices;
use crate::plausibility::machine::of_machine;
use crate::plausibility::masses::{next_to_nothing, no_body};
use crate::plausibility::numbers::of_numbers;
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
