//! Programs are read, and without pieces every byte comes back.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{EVERYTHING, place, program};

#[test]
fn places_are_those_of_the_part() {
    let program = program(EVERYTHING);
    let at = |line: usize| {
        let motion = program.motions.iter().find(|motion| motion.line == line);
        motion.unwrap().target.pose().map(|pose| pose.position_mm)
    };
    let near = |line: usize, x: f64, y: f64, z: f64| {
        let found = at(line).unwrap();
        assert!(
            (found - Vector3::new(x, y, z)).norm() < 1e-9,
            "line {line}: {found}"
        );
    };
    // SUPA, and X Y without Z behind it.
    assert_eq!((at(8), at(13)), (None, None));
    near(14, 0.0, 0.0, 5.0);
    near(15, 0.0, 0.0, -2.5);
    near(16, 50.0, 0.0, -2.5);
    near(20, 40.0, 25.0, -2.5);
    near(21, 45.0, 23.5, -2.5);
    near(22, 10.0, 23.5, -2.0);
    // TRANS X100 Y50, then a quarter turn about Z.
    near(25, 100.0, 50.0, 5.0);
    near(27, 100.0, 50.0, -1.0);
    near(28, 100.0, 60.0, -1.0);
    near(29, 90.0, 50.0, -1.0);
    near(30, 100.0, 40.0, -1.0);
    near(31, 100.0, 30.0, -1.0);
    assert_eq!(program.motions.last().unwrap().line, 42);
}

#[test]
fn tools_frames_speeds_and_directions() {
    let program = program(EVERYTHING);
    let on = |line: usize| {
        program
            .motions
            .iter()
            .find(|motion| motion.line == line)
            .unwrap()
    };
    assert_eq!(on(14).tool.name, "T MILL 12");
    assert_eq!(on(14).work_object.name, "G54");
    assert_eq!(
        (on(14).speed.mm_per_s, on(14).speed.text.as_str()),
        (None, "G0")
    );
    assert_eq!(on(15).speed.mm_per_s, Some(5.0));
    assert_eq!(
        (on(16).speed.mm_per_s, on(16).speed.text.as_str()),
        (Some(20.0), "F1200.")
    );
    // Where a block begins is known behind known places alone.
    assert_eq!(on(14).follows, None);
    assert!(on(15).follows.is_some());
    let axis = |line: usize| on(line).target.pose().unwrap().orientation * Vector3::z();
    for line in [37, 38] {
        let lean = 10.0_f64.to_radians();
        assert!((axis(line) - Vector3::new(lean.sin(), 0.0, lean.cos())).norm() < 1e-6);
    }
    assert!((axis(39) - Vector3::z()).norm() < 1e-9);
}

#[test]
fn inches_and_their_feeds() {
    for (code, feed) in [("G70", 10.0), ("G700", 254.0)] {
        let program = program(&format!("{code} G90 G94\nG0 X0 Y0 Z1\nG1 X2 F600\n"));
        assert_eq!(place(&program, 1), [50.8, 0.0, 25.4]);
        let found = program.motions[1].speed.mm_per_s.unwrap();
        assert!((found - feed).abs() < 1e-9, "{found}");
    }
}

#[test]
fn the_language_is_known_by_ending_or_words() {
    for (name, text, expected) in [
        ("A.MPF", "G1 X1\n", Some(Language::Siemens)),
        ("a.spf", "", Some(Language::Siemens)),
        ("a.nc", "%_N_A_MPF\nG1\n", Some(Language::Siemens)),
        ("a.nc", "N10 TRAORI\n", Some(Language::Siemens)),
        ("a.nc", "N10 CYCLE832(0.01,1)\n", Some(Language::Siemens)),
        ("a.nc", "DEF REAL A\n", Some(Language::Siemens)),
        ("a.nc", "%\nO1 (TRAORI)\nG21 G90\nCYCLE800\n", None),
        ("a.ngc", "G21 G90\nG1 X1 (DEF REAL)\n", None),
        ("a.arc", "%_N_A_MPF\n", None),
    ] {
        assert_eq!(
            language_of(name, text.as_bytes()),
            expected,
            "{name} {text}"
        );
    }
}

/// Without M6 a T changes the tool; an M6 in a remark or in a text is none.
#[test]
fn a_remark_on_m6_changes_no_tool() {
    for (beside, second) in [("", "T2"), (" ;M6 by hand", "T2"), (" m6", "T1")] {
        let text = format!(
            "G17 G90 G94 F600\nT1{beside}\nMSG(\"M6 is next\")\nG1 X0 Y0 Z0\nT2\nG1 X5 Y0 Z0\n"
        );
        assert_eq!(program(&text).motions[1].tool.name, second, "{text}");
    }
}
