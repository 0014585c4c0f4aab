//! Programs that state positions, or axes along z, in several work objects that are turned: in axes of the base the tool leans.

use kinetostat_formats::*;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Rotation about an axis of the coordinates, as a matrix.
fn about(axis: usize, deg: f64) -> Matrix3<f64> {
    let (sin, cos) = deg.to_radians().sin_cos();
    match axis {
        0 => Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, -sin, 0.0, sin, cos),
        1 => Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos),
        _ => Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0),
    }
}

fn frame(at: [f64; 3], turn: Matrix3<f64>) -> Isometry3<f64> {
    let turn = Rotation3::from_matrix_unchecked(turn);
    Isometry3::from_parts(
        Translation3::from(Vector3::from(at)),
        UnitQuaternion::from_rotation_matrix(&turn),
    )
}

/// The axis from the tip to the holder at the end of each move, in axes of the path.
fn axes(robot: &RobotPath) -> Vec<Vector3<f64>> {
    let moves = robot.path.moves.iter();
    let axis = robot.path.tool_axis;
    moves
        .map(|motion| motion.orientation(1.0).unwrap() * axis)
        .collect()
}

fn near(found: &Vector3<f64>, expected: Vector3<f64>) -> bool {
    (found - expected).norm() < 1e-9
}

/// Operation A lies on its side, B upright; with axes along z, and with none at all.
#[test]
fn two_systems_of_nx_turn_the_tool_with_their_places() {
    for axis in ["", ",0.0,0.0,1.0"] {
        let text = format!(
            "TOOL PATH/A,TOOL,MILL_10\nMSYS/3,-4,50,1,0,0,0,0,1\nRAPID\nGOTO/10,20,50{axis}\nFEDRAT/MMPM,250\nGOTO/10,20,-1{axis}\n\
             TOOL PATH/B,TOOL,MILL_10\nMSYS/0,0,0,1,0,0,0,1,0\nRAPID\nGOTO/10,20,50{axis}\nGOTO/10,20,-1{axis}\n"
        );
        let mut options = ReadOptions::default();
        let part = about(2, 33.0);
        options
            .frames
            .insert("PART".to_owned(), frame([1000.0, 7.0, 500.0], part));
        let files = vec![SourceFile::new("a.cls", text)];
        let program = read_apt(files, &options).unwrap();
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        assert!(robot.axis_alone && robot.work_object.is_none());
        let found = axes(&robot);
        // z of A is x cross y of the MSYS: -y of the part.
        assert!(near(&found[1], part * -Vector3::y()), "{found:?}");
        assert!(near(&found[3], Vector3::z()), "{found:?}");
        let place = robot.path.moves[1].end;
        let expected = part * Vector3::new(13.0, -3.0, 70.0) + Vector3::new(1000.0, 7.0, 500.0);
        assert!((place - expected).norm() < 1e-9, "{place}");
        let mut warnings = robot.path.warnings.iter();
        assert!(
            warnings.any(|one| one.line == 4 && one.text.contains("z of the robot's base")),
            "{:?}",
            robot.path.warnings
        );
        // The made program is read again, and the tool lies there along the same axes.
        let made = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl);
        let (name, bytes) = made.unwrap().files.remove(0);
        let files = vec![SourceFile::new(name, bytes)];
        let again = read_krl(files, &ReadOptions::default()).unwrap();
        let z = |motion: &Motion| motion.target.pose().unwrap().orientation * -Vector3::z();
        assert!((z(&again.motions[1]) - part * -Vector3::y()).norm() < 1e-7);
        assert!((z(&again.motions[3]) - Vector3::z()).norm() < 1e-7);
    }
}

#[test]
fn settable_frames_that_lean_turn_the_tool() {
    let text = "G90 G71 G17 G54\nT1 D1\nG0 X0 Y0 Z10\nG1 X10 Y5 F100\nG55\nG0 X0 Y0 Z10\nG1 X10 Y5 Z1\nM30\n";
    let read = |lean: f64| {
        let mut options = ReadOptions::default();
        for (name, turn) in [("G54", about(2, 30.0)), ("G55", about(1, lean))] {
            options
                .frames
                .insert(name.to_owned(), frame([1000.0, 50.0, 500.0], turn));
        }
        read_siemens(vec![SourceFile::new("a.mpf", text)], &options).unwrap()
    };
    let program = read(20.0);
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let found = axes(&robot);
    assert!(near(&found[1], Vector3::z()), "{found:?}");
    assert!(near(&found[3], about(1, 20.0) * Vector3::z()), "{found:?}");
    // A template that says the tool stands otherwise is heard of.
    let said = |template: &Template| {
        let made = make_of_robot(&program, &robot, template, MakeLanguage::Krl).unwrap();
        let mut findings = made.findings.into_iter();
        findings.any(|one| {
            one.message
                .contains("tool_orientation of the template is not used")
        })
    };
    let mut template = Template::default();
    template.tool_orientation = Some(UnitQuaternion::from_euler_angles(
        std::f64::consts::PI,
        0.0,
        0.0,
    ));
    assert!(!said(&template));
    template.tool_orientation = Some(UnitQuaternion::from_euler_angles(2.9, 0.0, 0.3));
    assert!(said(&template));
    // Upright frames leave a program of positions one of positions.
    let program = read(0.0);
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    assert!(!robot.axis_alone);
    assert!(robot.path.moves.iter().all(|one| one.tool_turn.is_none()));
}
