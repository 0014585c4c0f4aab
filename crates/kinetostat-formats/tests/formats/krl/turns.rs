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

/// `$ORI_TYPE=#CONSTANT` lets the tool keep the orientation with which a motion begins: no matter where it ends with it.
#[test]
fn what_keeps_its_orientation_is_taken_where_nothing_turns() {
    let faults = |statements: &str| {
        let text = format!("DEF part()\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n{statements}\nEND\n");
        let files = vec![SourceFile::new("part.src", text)];
        let read = read_krl(files, &ReadOptions::default());
        read.map_or_else(
            |faults| {
                faults
                    .iter()
                    .map(|fault| (fault.line, fault.to_string()))
                    .collect()
            },
            |program| {
                assert!(path_of(&program, &PathOptions::default()).is_ok());
                Vec::new()
            },
        )
    };
    let lines = |statements: &str| -> Vec<usize> {
        let found: Vec<(usize, String)> = faults(statements);
        assert!(
            found.iter().all(|(_, text)| text.contains("#CONSTANT")),
            "{found:?}"
        );
        found.into_iter().map(|(line, _)| line).collect()
    };
    let start = "PTP {X 0,Y 0,Z 0,A 10,B 0,C 180}";
    let along = "LIN {X 50,Y 0,Z 0,A 10,B 0,C 180}\nLIN {X 60}\nCIRC {X 80,Y 20,Z 0},{X 100,Y 0}";
    let turn = "LIN {X 50,Y 0,Z 0,A 20,B 0,C 180}";
    let kept = "$ORI_TYPE=#CONSTANT";
    assert_eq!(lines(&format!("{kept}\n{start}\n{along}")), [0; 0]);
    assert_eq!(
        lines(&format!("{kept}\n{start}\n{along}\n{turn}\n{turn}")),
        [9]
    );
    assert_eq!(
        lines(&format!("{kept}\n{start}\n$ORI_TYPE=#VAR\n{turn}")),
        [0; 0]
    );
    assert_eq!(
        lines(&format!(
            "{start}\n{kept}\nPTP {{X 0,Y 0,Z 0,A 30,B 0,C 180}}"
        )),
        [0; 0]
    );
    assert_eq!(
        lines(&format!("{start}\nIF TRUE THEN\n{kept}\nENDIF\n{turn}")),
        [8]
    );
    assert_eq!(
        lines(&format!(
            "{start}\n$ORI_TYPE=#VAR\nsub()\n{turn}\nEND\nDEF sub()\n{kept}"
        )),
        [7]
    );
    // With which orientation it begins is not said by joints, nor where nothing was before.
    assert_eq!(
        lines(&format!(
            "{kept}\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}}\n{along}"
        )),
        [6]
    );
    assert_eq!(lines(&format!("{kept}\n{turn}")), [5]);
    let slin = format!("{} WITH {kept}", turn.replace("LIN", "SLIN"));
    assert_eq!(lines(&format!("{start}\n{slin}")), [5]);
    // Data of inline forms.
    let data = "LDAT_ACT={VEL 2.0,ACC 100.0,APO_DIST 5.0,ORI_TYP #CONSTANT}\nBAS(#CP_PARAMS,0.1)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME";
    assert_eq!(lines(&format!("{data}\n{start}\n{along}\n{turn}")), [12]);
}
