//! The free turn of a round tool along a path, against plain geometry, brute force and the mechanism's own kinematics.

mod anything;
mod closed_form;
mod moved;
mod no_way;
mod planted;
mod refused;
mod sequences;
mod smooth;
mod written;

use std::f64::consts::{FRAC_PI_2, PI};

use kinetostat::linalg::SingularValues;
use kinetostat::{Mechanism, Pose, PostureRequest};
use kinetostat_machining::{Placement, TurnTask};
use kinetostat_model::Model;
use kinetostat_program::{Path, Program, ReadOptions, interpret};
use nalgebra::{Matrix6, UnitQuaternion, Vector3, vector};

/// An arm of the library with a spindle at a right angle to its flange.
fn milling_arm(name: &str) -> Mechanism {
    let tilt = UnitQuaternion::from_euler_angles(0.0, FRAC_PI_2, 0.0);
    let tool = Pose::from_parts(vector![0.2, 0.0, 0.1].into(), tilt);
    let mechanism = Model::preset(name).expect("preset").mechanism;
    mechanism.with_tool(&tool)
}

fn tool_at(mechanism: &Mechanism, joints: &[f64; 6]) -> Pose {
    let posture = mechanism.posture(PostureRequest::commands(joints));
    *posture.expect("a posture").target()
}

fn path_of(text: &str) -> Path {
    let program = Program::read(text).expect("program");
    interpret(&program, &ReadOptions::default()).expect("path")
}

/// The smallest singular value of the motion of the tool of the heavy arm by the joints, by differences of the forward kinematics;
/// velocities by the mean of its upper arm, 1250 mm, and its forearm, 1100 mm out and 55 mm down.
fn singular_value_by_differences(mechanism: &Mechanism, joints: &[f64; 6]) -> f64 {
    let length = 0.5 * (1.25 + 1.1_f64.hypot(0.055));
    let step = 1e-5;
    let columns = [0, 1, 2, 3, 4, 5].map(|joint| {
        let at = |way: f64| {
            let mut moved = *joints;
            moved[joint] += way * step;
            tool_at(mechanism, &moved)
        };
        let (ahead, behind) = (at(1.0), at(-1.0));
        let velocity =
            (ahead.translation.vector - behind.translation.vector) / (2.0 * step * length);
        let turn = (ahead.rotation * behind.rotation.inverse()).scaled_axis() / (2.0 * step);
        nalgebra::Vector6::new(velocity.x, velocity.y, velocity.z, turn.x, turn.y, turn.z)
    });
    let values = SingularValues::of(&Matrix6::from_columns(&columns)).values;
    *values.last().expect("six values")
}

/// Program axes parallel to the base with their origin at a point (m), the tool downwards with its x along `x_deg` of the base.
fn downwards(origin: Vector3<f64>, x_deg: f64) -> Placement {
    let mut placement = Placement::at(origin);
    placement.tool_orientation =
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), x_deg.to_radians())
            * UnitQuaternion::from_euler_angles(PI, 0.0, 0.0);
    placement
}

/// Joint values of the heavy arm with its forearm level and its wrist straight, rad: axes 4 and 6 are in line.
const STRAIGHT: [f64; 6] = [0.0, 0.2, -0.2, 0.0, 0.0, 0.0];

/// A line across the front of the heavy arm with a spindle square to its flange, through [`STRAIGHT`] in its middle at no turn.
fn across_a_straight_wrist() -> (Mechanism, Path, Placement) {
    let mechanism = milling_arm("heavy_6r");
    let tool = tool_at(&mechanism, &STRAIGHT);
    let mut placement = Placement::at(tool.translation.vector);
    placement.tool_orientation = tool.rotation;
    let path = path_of("G21 G90\nG0 X0 Y-500 Z0\nG1 Y-300 F600\nG1 Y300\nG1 Y500\n");
    (mechanism, path, placement)
}

/// Most of a circle around the base of the heavy arm: the tool, which the program does not turn, would have to turn by 280 deg against the
/// arm, and the wrist would be straight on the way.
fn around_the_base() -> (Mechanism, Path, Placement) {
    let at = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        format!("X{:.6} Y{:.6}", 1500.0 * cosine, 1500.0 * sine)
    };
    let to_centre = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        format!("I{:.6} J{:.6}", -1500.0 * cosine, -1500.0 * sine)
    };
    let mut text = format!("G21 G90 G17\nG0 {} Z0\nF900\n", at(-140.0));
    for from in [-140.0, -70.0, 0.0, 70.0] {
        text.push_str(&format!("G3 {} {}\n", at(from + 70.0), to_centre(from)));
    }
    let placement = downwards(vector![0.0, 0.0, 0.8], 0.0);
    (milling_arm("heavy_6r"), path_of(&text), placement)
}

/// Turns along [`around_the_base`] that keep a rate of 0.06 deg/mm.
fn task_around<'a>(mechanism: &'a Mechanism, path: &'a Path, placement: Placement) -> TurnTask<'a> {
    let mut task = TurnTask::new(mechanism, path, placement);
    task.station_mm = 50.0;
    task.band.step_deg = 2.0;
    task.bounds.rate_deg_per_mm = 0.06;
    task.bounds.least_singular_value = 0.1;
    task
}
