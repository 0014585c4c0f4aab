//! Orientations by every convention, directions and poses.

use kinetostat_model::internal::{direction, pose};
use kinetostat_model::schema::{Axis, Placement};
use nalgebra::{UnitQuaternion, Vector3};

fn orientation_of(toml: &str) -> UnitQuaternion<f64> {
    let written: Placement = toml::from_str(toml).expect("placement");
    let made = pose(&written);
    made.unwrap_or_else(|message| panic!("{message}")).rotation
}

/// Columns of the rotation matrix, by hand, for 90 degrees about two axes: the order shows.
#[test]
fn every_convention_turns_as_its_name_says() {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    for (toml, columns) in [
        // Rx(90) Ry(90): x -> -z -> y, y -> y -> z, z -> x -> x.
        ("rotation_intrinsic_xyz_deg = [90, 90, 0]", [y, z, x]),
        // Ry(90) Rx(90): x -> x -> -z, y -> z -> x, z -> -y -> -y.
        ("roll_pitch_yaw_urdf_deg = [90, 90, 0]", [-z, x, -y]),
        ("w_p_r_fanuc_deg = [90, 90, 0]", [-z, x, -y]),
        ("a_b_c_kuka_deg = [0, 90, 90]", [-z, x, -y]),
        // Rz(90) Rx(90): x -> x -> y, y -> z -> z, z -> -y -> x.
        ("roll_pitch_yaw_urdf_deg = [90, 0, 90]", [y, z, x]),
        ("a_b_c_kuka_deg = [90, 0, 90]", [y, z, x]),
        ("rotation_vector_deg = [0, 0, 90]", [y, -x, z]),
        (
            "rotation_vector_rad = [0, 0, 1.5707963267948966]",
            [y, -x, z],
        ),
        ("quaternion_wxyz = [0.5, 0.5, 0.5, 0.5]", [y, z, x]),
        (
            "quaternion_wxyz = [0.70710678, 0.70710678, 0, 0]",
            [x, z, -y],
        ),
        (
            "quaternion_xyzw = [0.70710678, 0, 0, 0.70710678]",
            [x, z, -y],
        ),
        ("x_axis = \"y\"\ny_axis = \"z\"", [y, z, x]),
        ("x_axis = \"-z\"\ny_axis = [0, 2, 0]", [-z, y, x]),
        ("x_axis = [3, 0, 0]", [x, y, z]),
        ("x_axis = \"z\"", [z, x, y]),
    ] {
        let turn = orientation_of(toml);
        for (axis, column) in [x, y, z].iter().zip(columns) {
            assert!((turn * axis - column).norm() < 1e-8, "{toml}: {turn}");
        }
    }
}

#[test]
fn angles_of_many_turns_are_no_orientation() {
    for (toml, fine) in [
        ("rotation_vector_rad = [0, 5400, 0]", false),
        ("a_b_c_kuka_deg = [0, -1e9, 0]", false),
        ("a_b_c_kuka_deg = [-360, 540, 0]", true),
    ] {
        let written: Placement = toml::from_str(toml).expect(toml);
        assert_eq!(pose(&written).is_ok(), fine, "{toml}");
    }
}

#[test]
fn huge_and_tiny_directions_are_directions() {
    for scale in [1e-11, 1e300] {
        let axis = Axis::Vector([scale, scale, 0.0]);
        let found = direction(&axis);
        let unit = found.unwrap_or_else(|message| panic!("{message}"));
        assert!((unit.x - 0.5f64.sqrt()).abs() < 1e-15);
    }
}

#[test]
fn a_pose_of_a_file_is_taken_as_it_is_however_small_its_parts() {
    for size in [1e-9, 1e-4, 0.05, 0.18, 3.0, 40.0] {
        let table = Placement {
            position_mm: Some([0.3 * size, -0.7 * size, size]),
            rotation_vector_deg: Some([0.2 * size, size, -0.5 * size]),
            ..Placement::default()
        };
        let pose = table.pose().expect("a pose");
        let off = pose.translation.vector * 1e3 - Vector3::new(0.3, -0.7, 1.0) * size;
        assert!(off.norm() <= 1e-15 * size, "{size}: {off}");
        let turned = pose.rotation.scaled_axis() * (180.0 / std::f64::consts::PI);
        let off = turned - Vector3::new(0.2, 1.0, -0.5) * size;
        assert!(off.norm() <= 1e-12 * size, "{size}: {off}");
    }
}
