//! Masses that were never meant: missing, equal everywhere, unit matrices, too heavy or too light for
//! the robot's size. They are imported as written and noticed.

use nalgebra::{Matrix3, Vector3};

use crate::log::{Log, some_names};
use crate::urdf::robot::{Inertial, Robot};

/// Looks at the inertials of the links that move; `reach` is the length of the moving arm, m.
pub(crate) fn look(robot: &Robot, moving: &[usize], reach: f64, log: &mut Log) {
    let named = |links: &[usize]| {
        let names: Vec<&str> = links
            .iter()
            .map(|l| robot.links[*l].name.as_str())
            .collect();
        some_names(&names)
    };
    let of = |l: &usize| robot.links[*l].inertial.as_ref();
    // Frames such as 'flange' and 'tool0' have neither mass nor shape.
    let without: Vec<usize> = moving
        .iter()
        .copied()
        .filter(|l| of(l).is_none() && !robot.links[*l].meshes.is_empty())
        .collect();
    let with: Vec<usize> = moving.iter().copied().filter(|l| of(l).is_some()).collect();
    if with.is_empty() {
        log.notice(
            &robot.at,
            "no moving link has a mass: the model bends under loads, but not under its own weight",
            "add { body = ... } elements to the chain, or <inertial> to the URDF",
        );
        return;
    }
    if !without.is_empty() {
        log.notice(
            &robot.links[without[0]].at,
            format!("links with a shape but without a mass: {}", named(&without)),
            "their weight is left out; add { body = ... } elements to the chain",
        );
    }
    for &link in &with {
        let Some(inertial) = of(&link) else { continue };
        one(inertial, reach, log);
    }
}

/// Checks one inertial by itself.
fn one(inertial: &Inertial, reach: f64, log: &mut Log) {
    let at = &inertial.at;
    let m = &inertial.inertia;
    if inertial.mass == 0.0 {
        log.notice(
            at,
            "the mass is zero",
            "its weight is left out; write the true mass into the URDF or the model",
        );
        return;
    }
    if *m == Matrix3::identity() {
        log.notice(
            at,
            "the inertia is the unit matrix: a placeholder",
            "statics does not use it; is the mass a placeholder too?",
        );
    }
    let centre = Vector3::from(inertial.origin.xyz).norm();
    if reach > 0.05 && centre > 2.0 * reach {
        log.notice(
            at,
            format!("the centre of mass lies {centre:.2} m away from the link's frame"),
            "lengths of a URDF are metres; are these millimetres?",
        );
    }
    let gyration = (m.diagonal().max() / inertial.mass).sqrt();
    if reach > 0.05 && gyration > 2.0 * reach && *m != Matrix3::identity() {
        log.notice(
            at,
            format!(
                "the inertia belongs to a body of about {gyration:.1} m, the arm has {reach:.1} m"
            ),
            "check its unit: kg m^2 (CAD programs like kg mm^2); statics does not use it",
        );
    }
}
