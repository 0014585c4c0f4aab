//! Home postures and workspaces of the library's robots.

use kinetostat::{DirectionKind, Pose, Twist, spatial::moved};
use kinetostat_model::{PresetKind, preset_names};
use kinetostat_testing::Worst;
use nalgebra::Vector3;
use serde_json::json;

use crate::library::{Random, figure, machine, posture_near, preset, turns};

/// No singular posture is nearer to home than this, m (rotations times the machine's natural length).
const CLEAR_M: f64 = 0.02;

/// Robots of the library; teaching examples may be singular on purpose, as the report's platform A is.
fn robots() -> Vec<&'static str> {
    let robots = preset_names()
        .iter()
        .filter(|p| p.kind != PresetKind::Teaching);
    robots.map(|p| p.name).collect()
}

#[test]
fn no_robot_is_at_home_in_a_singular_posture() {
    let within = 0.5;
    let (mut nearest, mut which) = (within, "none is nearer".to_owned());
    for name in robots() {
        let model = preset(name);
        let mechanism = &model.mechanism;
        let home = mechanism.platforms()[mechanism.tool()].home;
        let posture = mechanism.posture(&home).expect("home");
        assert!(posture.limit_violations().is_empty(), "{name}");
        let directions = posture.stiffness().expect("a stiffness").directions;
        let free = directions.iter().find(|d| d.kind == DirectionKind::Free);
        assert!(free.is_none(), "{name}: {}", free.unwrap().description());
        let list = posture.near_singularities(within).expect("a list");
        if let Some(first) = list.first() {
            assert!(
                first.distance_m >= CLEAR_M,
                "{name}: {}",
                first.description()
            );
            if first.distance_m < nearest {
                nearest = first.distance_m;
                which = name.to_owned();
            }
        }
    }
    figure(
        &format!("Library: nearest singular posture to any home ({which})"),
        json!(nearest * 1e3),
        "at least 20",
        "mm",
        nearest >= CLEAR_M,
    );
}

/// Or a cube of 200 mm about home where none is stated.
#[test]
fn every_robot_reaches_its_stated_workspace() {
    let (mut closure_residual, mut count) = (Worst::new(), 0);
    for name in robots() {
        let model = preset(name);
        let mechanism = &model.mechanism;
        let home = mechanism.platforms()[mechanism.tool()].home;
        let about_home = || {
            let half = Vector3::repeat(0.1);
            let at = home.translation.vector;
            (at - half, at + half)
        };
        let (low, high) = model.workspace().unwrap_or_else(about_home);
        let at_home = mechanism.posture(&home).expect("home");
        let corner = home.translation.vector;
        assert!(
            (0..3).all(|i| low[i] - 1e-9 <= corner[i] && corner[i] <= high[i] + 1e-9),
            "{name}: home is outside the workspace"
        );
        let turning = turns(&at_home);
        let mut random = Random(20);
        for i in 0..50 {
            let share = random.vector().map(|x| 0.5 + 0.5 * x);
            let at = low + (high - low).component_mul(&share);
            let target = Pose::from_parts(at.into(), home.rotation);
            let mut posture = posture_near(&model, &target, &at_home);
            // Every fifth place turned by up to 3 degrees about each axis, where the machine turns.
            if turning && i % 5 == 0 {
                let turn = random.vector() * 3_f64.to_radians();
                let target = moved(posture.target(), &Twist::new(Vector3::zeros(), turn));
                posture = posture_near(&model, &target, &posture);
            }
            let outside = posture.limit_violations();
            assert!(outside.is_empty(), "{name} at {at}: {outside:?}");
            // Where the joints lead, by the file read a second time.
            closure_residual.add(machine::structure(&model, &posture).closure_residual);
            count += 1;
        }
    }
    let closure_residual = closure_residual.of(count);
    figure(
        &format!("Library: inverse kinematics there and back at {count} random places"),
        json!(closure_residual),
        "at most 1e-9",
        "m",
        closure_residual <= 1e-9,
    );
}
