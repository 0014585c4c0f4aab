//! Figures that are possible but unlikely: usually a unit or a decimal point is wrong.

use kinetostat::{Chain, Element, Mechanism, MotionKind, Pose};
use nalgebra::{Translation3, UnitQuaternion};

use crate::problem::{Finding, Place};

/// Pose of a chain's tip in its base, for given coordinates and commands (m, rad), and how far (m)
/// any of its frames lies from its first one.
fn tip(chain: &Chain, coordinates: &[f64], commands: &[f64]) -> (Pose, f64) {
    let mut pose = Pose::identity();
    let mut origin = None;
    let mut reach = 0.0_f64;
    for element in chain.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Motion(m) => {
                let share = |drive: Option<kinetostat::Drive>, values: &[f64]| {
                    drive.map_or(0.0, |d| {
                        d.ratio * values.get(d.index).copied().unwrap_or(0.0)
                    })
                };
                let amount = share(m.coordinate, coordinates) + share(m.command, commands);
                match m.kind {
                    MotionKind::Prismatic => {
                        pose *= Translation3::from(m.axis.into_inner() * amount);
                    }
                    MotionKind::Revolute => {
                        pose *= UnitQuaternion::from_axis_angle(&m.axis, amount);
                    }
                }
            }
            Element::Node(_) => {}
        }
        // The first offset only places the chain.
        let here = pose.translation.vector;
        reach = reach.max((here - *origin.get_or_insert(here)).norm());
    }
    (pose, reach)
}

/// Looks at sizes, masses, gravity and the home posture.
pub(crate) fn check(mechanism: &Mechanism, warnings: &mut Vec<Finding>) {
    let root = Place::root();
    let mut warn = |place: &Place, message: String, help: &str| {
        warnings.push(Finding::new(place, message, help));
    };
    let gravity = mechanism.gravity().norm();
    if gravity > 0.0 && !(1.0..=30.0).contains(&gravity) {
        warn(
            &root.key("mechanism").key("gravity_m_per_s2"),
            format!("gravity is {gravity} m/s^2"),
            "on the ground it is 9.81 m/s^2; check the unit",
        );
    }
    for (i, platform) in mechanism.platforms().iter().skip(1).enumerate() {
        if platform.mass > 1e5 {
            warn(
                &root.key("platform").index(i).key("mass_kg"),
                format!("the platform weighs {} kg", platform.mass),
                "check the unit",
            );
        }
    }
    for (i, limb) in mechanism.limbs().iter().enumerate() {
        let place = root.key("limb").index(i);
        let chain = &limb.nominal;
        let (tip, reach) = tip(chain, &chain.home_coordinates(), &chain.home_commands());
        if reach > 100.0 || (reach > 0.0 && reach < 1e-3) {
            warn(
                &place,
                format!("the limb '{}' reaches over {reach:.6} m", limb.name),
                "machines lie between a millimetre and 100 m; check the units of its chain",
            );
        }
        if let Some(body) = chain.bodies().iter().find(|b| b.mass > 1e5) {
            warn(
                &place,
                format!(
                    "the body '{}' of this limb weighs {} kg",
                    body.name, body.mass
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
        let gap = (reached.translation.vector - wanted.translation.vector).norm();
        let turn = reached.rotation.angle_to(&wanted.rotation);
        if gap > 1e-3 * reach.max(1e-3) || turn > 1e-2 {
            warn(
                &place,
                format!(
                    "at home the limb '{}' ends {:.4} mm and {:.3} degrees away from the platform '{}'",
                    limb.name,
                    gap * 1e3,
                    turn.to_degrees(),
                    mechanism.platforms()[limb.to].name
                ),
                "correct the home values of its joints, or the home pose of the platform; the search for joint values starts there",
            );
        }
    }
}
