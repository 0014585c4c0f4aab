//! How the tool turns along motions.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

/// Rz(A) Ry(B) Rx(C), by hand.
fn abc(a: f64, b: f64, c: f64) -> UnitQuaternion<f64> {
    let about = |axis, degrees: f64| UnitQuaternion::from_axis_angle(&axis, degrees.to_radians());
    about(Vector3::z_axis(), a) * about(Vector3::y_axis(), b) * about(Vector3::x_axis(), c)
}

/// A turn of x about z by 40 deg and about x by 60 deg: LIN makes both evenly, SLIN turns about one axis.
#[test]
fn x_of_the_tool_swivels_in_lin_and_circ() {
    let swivelled = abc(20.0, 0.0, 30.0);
    let about_one = abc(40.0, 0.0, 60.0).powf(0.5);
    assert!(swivelled.angle_to(&about_one) > 0.02);
    for (statement, wanted) in [
        ("LIN {X 100,A 40,B 0,C 60}", swivelled),
        ("lin {X 100,A 40,B 0,C 60} C_DIS", swivelled),
        ("CIRC {X 50,Y 50},{X 100,Y 0,A 40,B 0,C 60}", swivelled),
        ("SLIN {X 100,A 40,B 0,C 60}", about_one),
    ] {
        let full = statement
            .replace("{X 100,A", "{X 100,Y 0,Z 0,A")
            .replace("{X 50,Y 50}", "{X 50,Y 50,Z 0,A 0,B 0,C 0}")
            .replace("{X 100,Y 0,A", "{X 100,Y 0,Z 0,A");
        let text = format!(
            "DEF part()\n$TOOL={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\nPTP {{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n{full}\nEND\n"
        );
        let files = vec![SourceFile::new("part.src", text)];
        let program =
            read_krl(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"));
        let path = path_of(&program, &PathOptions::default()).unwrap().path;
        let found = path.moves[1].orientation(0.5).unwrap();
        assert!(found.angle_to(&wanted) < 1e-7, "{statement}");
    }
}
