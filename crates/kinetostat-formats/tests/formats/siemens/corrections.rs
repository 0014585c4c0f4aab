//! Corrected places, further blocks, modes that are stated again.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{EVERYTHING, place, program, written};

fn shifted(program: &RobotProgram, motion: usize, by: [f64; 3]) -> Piece {
    Piece::to(
        motion,
        Vector3::from(place(program, motion)) + Vector3::from(by),
    )
}

/// The text with pieces, each for a motion by its index and its shift.
fn bent(text: &str, shifts: &[(usize, [f64; 3])]) -> String {
    let program = program(text);
    let pieces: Vec<Piece> = shifts
        .iter()
        .map(|(motion, by)| shifted(&program, *motion, *by))
        .collect();
    written(&program, &pieces)
}

#[test]
fn only_the_numbers_change_and_decimals_stay() {
    let text = "G54\nN10 G0 X10 Y.5 Z+5.0000 ; start\nN20 G1 Z-1.25 F100\n";
    let output = bent(text, &[(0, [0.0101, 0.02, -0.00004])]);
    // Z is stated again where it would be another one: N20 states it.
    assert_eq!(
        output,
        "G54\nN10 G0 X10.010 Y.520 Z+5.0000 ; start\nN20 G1 Z-1.25 X10.000 Y0.500 F100\n"
    );
    let output = bent(text, &[(1, [0.0, 0.0, 0.0123])]);
    assert_eq!(output, text.replace("Z-1.25", "Z-1.238"));
}

#[test]
fn places_that_are_not_stated_are_written_where_they_change() {
    let text = "G0 X0 Y0 Z0\nG1 X10 F100\nX20\nX30\n";
    let output = bent(text, &[(1, [0.0, 0.0, 0.1])]);
    assert_eq!(output, "G0 X0 Y0 Z0\nG1 X10 Z0.100 F100\nX20 Z0.000\nX30\n");
    assert_eq!(place(&program(&output), 2), [20.0, 0.0, 0.0]);
}

#[test]
fn further_blocks_have_no_number_and_ends_go_to_the_last() {
    let text = "N5 G0 X0 Y0 Z0\nN10 G1 X10 F100 M0 ; stop\nN20 X20\n";
    let program = program(text);
    let pieces = [
        Piece::to(1, Vector3::new(5.0, 0.01, 0.0)),
        Piece::to(1, Vector3::new(10.0, 0.02, 0.0)),
    ];
    assert_eq!(
        written(&program, &pieces),
        "N5 G0 X0 Y0 Z0\nN10 G1 X5.000 Y0.010 F100 ; stop\nG1 X10.000 Y0.020 Z0.000 M0\nN20 X20 Y0.000\n"
    );
}

#[test]
fn a_corrected_arc_becomes_straight_and_its_code_is_stated_again() {
    let text = "G17 G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F100\nX-10 Y0 I0 J-10\nX0 Y-10 I10 J0\n";
    let program = program(text);
    let half = 10.0 * 0.5_f64.sqrt();
    let pieces = [
        Piece::to(1, Vector3::new(half, half, 0.1)),
        Piece::to(1, Vector3::new(0.0, 10.0, 0.0)),
    ];
    assert_eq!(
        written(&program, &pieces),
        "G17 G0 X10 Y0 Z0\nG1 X7.071 Y7.071 Z0.100 F100\nG1 X0.000 Y10.000 Z0.000\nG3 X-10 Y0 I0 J-10\nX0 Y-10 I10 J0\n"
    );
    // An arc that begins elsewhere is none about its centre.
    let moved = [Piece::to(1, Vector3::new(0.0, 10.1, 0.0))];
    let error = write(&program, &moved, &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 3: the arc begins at a place that changes"),
        "{error}"
    );
}

#[test]
fn a_full_circle_without_an_end_takes_pieces() {
    let text = "G0 X10 Y0 Z0\nN20 G2 I-10 F100\nX20\n";
    let program = program(&text.replace("X20", "G1 X20"));
    let MotionKind::Arc { angle_rad, .. } = program.motions[1].kind else {
        panic!()
    };
    assert!((angle_rad + std::f64::consts::TAU).abs() < 1e-12);
    let pieces = [
        Piece::to(1, Vector3::new(-10.0, 0.0, 0.0)),
        Piece::to(1, Vector3::new(10.0, 0.0, 0.0)),
    ];
    assert_eq!(
        written(&program, &pieces),
        "G0 X10 Y0 Z0\nN20 G1 X-10.000 F100\nG1 X10.000 Y0.000 Z0.000\nG1 X20\n"
    );
}

#[test]
fn steps_become_places() {
    let text = "G90 G0 X0 Y0 Z0\nG91 G1 X10 F100\nX10\nG90 X=IC(5) Y=AC(3)\n";
    let output = bent(text, &[(1, [0.1, 0.0, 0.0]), (3, [0.0, 0.2, 0.0])]);
    assert_eq!(
        output,
        "G90 G0 X0 Y0 Z0\nG91 G1 X=AC(10.100) F100\nX=AC(20.000)\nG90 X=IC(5) Y=AC(3.200)\n"
    );
    let places = program(&output);
    assert_eq!(place(&places, 2), [20.0, 0.0, 0.0]);
    assert_eq!(place(&places, 3), [25.0, 3.2, 0.0]);
}

#[test]
fn expressions_become_numbers_where_they_change() {
    let text = "R1=4\nG0 X0 Y0 Z0\nG1 X=R1*2 Y=R1 F100\n";
    let output = bent(text, &[(1, [0.0, 0.25, 0.0])]);
    assert_eq!(output, "R1=4\nG0 X0 Y0 Z0\nG1 X=R1*2 Y=4.250 F100\n");
}

#[test]
fn a_changed_feed_is_taken_back() {
    let text = "G94 G0 X0 Y0 Z0\nG1 X10 F600\nX20\n";
    let program = program(text);
    let mut piece = Piece::to(1, Vector3::new(10.0, 0.0, 0.0));
    piece.speed_factor = 1.25;
    assert_eq!(
        written(&program, &[piece.clone()]),
        "G94 G0 X0 Y0 Z0\nG1 X10 F750\nX20 F600\n"
    );
    piece.motion = 0;
    piece.position_mm = Vector3::zeros();
    assert_eq!(written(&program, &[piece]), text);
}

#[test]
fn inches_are_as_fine() {
    let output = bent("G70 G0 X1 Y1 Z0\nG1 X2 F10\n", &[(1, [0.00254, 0.0, 0.0])]);
    assert_eq!(output, "G70 G0 X1 Y1 Z0\nG1 X2.00010 F10\n");
}

#[test]
fn an_arc_through_a_point_stays_one() {
    let text = "G0 X10 Y0 Z0\nCIP X-10 Y0 I1=0 J1=10 F100\nG1 X0\n";
    let program = program(text);
    let mut piece = shifted(&program, 1, [0.0, 0.0, 0.1]);
    piece.via_mm = Some(Vector3::new(0.0, 10.0, 0.1));
    assert_eq!(
        written(&program, &[piece.clone()]),
        "G0 X10 Y0 Z0\nCIP X-10 Y0 Z0.100 K1=AC(0.100) I1=0 J1=10 F100\nG1 X0 Z0.000\n"
    );
    piece.via_mm = None;
    assert_eq!(
        written(&program, &[piece]),
        "G0 X10 Y0 Z0\nG1 X-10 Y0 Z0.100 F100\nG1 X0 Z0.000\n"
    );
}

#[test]
fn directions_are_turned_and_taken_back() {
    let text = "TRAORI\nG0 X0 Y0 Z0 A3=0 B3=0 C3=1\nG1 X10 F100 A3=0.6 B3=0 C3=0.8\nX20\n";
    let program = program(text);
    let mut piece = shifted(&program, 1, [0.0; 3]);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 1e-3);
    let end = program.motions[1].target.pose().unwrap();
    piece.orientation = Some(turn * end.orientation);
    let output = written(&program, &[piece]);
    let wanted = turn * Vector3::new(0.6, 0.0, 0.8);
    let expected = format!(
        "G1 X10 A3={:.7} B3=0.0000000 C3={:.7} F100\nX20 A3=0.6000000 B3=0.0000000 C3=0.8000000\n",
        wanted.x, wanted.z
    );
    assert!(output.ends_with(&expected), "{output}");
    let again = super::program(&output);
    for (motion, wanted) in [(1, wanted), (2, Vector3::new(0.6, 0.0, 0.8))] {
        let found = again.motions[motion].target.pose().unwrap().orientation * Vector3::z();
        assert!((found - wanted).norm() < 2e-7);
    }
    // Where none is stated none is written.
    let flat = super::program("G0 X0 Y0 Z0\nG1 X1 F1\n");
    let mut piece = shifted(&flat, 1, [0.0; 3]);
    piece.orientation = Some(turn);
    let error = write(&flat, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("states no direction of the tool"),
        "{error}"
    );
}

#[test]
fn blocks_are_no_longer_than_the_control_reads() {
    let text = format!("G0 X0 Y0 Z0\nG1 X1 F1 ;{}\n", "x".repeat(500));
    let program = program(&text);
    assert_eq!(written(&program, &[]), text);
    let error = write(
        &program,
        &[shifted(&program, 1, [0.0, 0.0, 1.0])],
        &WriteOptions::default(),
    );
    let error = error.unwrap_err().to_string();
    assert!(error.contains("512 are allowed"), "{error}");
}

#[test]
fn everything_takes_corrections_in_every_motion() {
    let program = program(EVERYTHING);
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        if let Some(end) = motion.target.pose() {
            pieces.push(Piece::to(
                index,
                end.position_mm + Vector3::new(0.1, -0.2, 0.3),
            ));
        }
    }
    let again = super::program(&written(&program, &pieces));
    assert_eq!(again.motions.len(), program.motions.len());
    for piece in &pieces {
        let found = Vector3::from(place(&again, piece.motion));
        assert!(
            (found - piece.position_mm).norm() < 0.866e-3 + 1e-6,
            "{}",
            piece.motion
        );
    }
}
