//! Corrected places, further blocks, numbers of blocks, feeds and functions.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{EVERYTHING, place, program, written};

fn lifted(program: &RobotProgram, motion: usize, by: f64) -> Piece {
    let [x, y, z] = place(program, motion);
    Piece::to(motion, Vector3::new(x, y, z + by))
}

const HEAD: &str = "BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+0 Y+0 Z+5 R0 FMAX M3\n";

fn text(blocks: &str) -> String {
    format!("{HEAD}{blocks}END PGM A MM\n")
}

#[test]
fn only_the_numbers_change_and_what_was_taken_over_is_stated() {
    let program = program(EVERYTHING);
    // `L X+40 FAUTO` is lifted: the blocks behind go back to their own height.
    let output = written(&program, &[lifted(&program, 4, 0.125)]);
    let changed: Vec<(&str, &str)> = EVERYTHING
        .lines()
        .zip(output.lines())
        .filter(|(before, after)| before != after)
        .collect();
    assert_eq!(
        changed,
        [
            ("15 L X+40 FAUTO", "15 L X+40 Z-1.875 FAUTO"),
            ("16 L IY+5.5 F600", "16 L IY+5.5 Z-2.000 F600"),
        ]
    );
}

#[test]
fn steps_and_signs_are_written_as_places_with_the_file_s_style() {
    let body = text("L IX+10 IZ-5 F200\nL Y3\nL X 12,5\n");
    let program = program(&body);
    let pieces = [
        Piece::to(1, Vector3::new(10.0204, 0.0, 0.0)),
        Piece::to(3, Vector3::new(12.4756, 3.0, 0.0)),
    ];
    let output = written(&program, &pieces);
    let expected = text("L X+10.020 IZ-5 F200\nL X+10.000 Y3\nL X 12,476\n");
    assert_eq!(output, expected);
    assert_eq!(place(&super::program(&output), 2), [10.0, 3.0, 0.0]);
}

#[test]
fn pieces_are_blocks_before_with_functions_where_they_act() {
    let body = "L X+40 R0 F200 M8 M9 ; to the edge\nL Y+10\n";
    let program = program(&text(body));
    let pieces = [
        Piece::to(1, Vector3::new(20.0, 0.05, 5.0)),
        Piece::to(1, Vector3::new(40.0, 0.0, 5.0)),
    ];
    let output = written(&program, &pieces);
    let expected =
        "L X+20.000 Y+0.050 R0 F200 M8\nL X+40 Y+0.000 R0 F200 M9 ; to the edge\nL Y+10\n";
    assert_eq!(output, text(expected));
    // A function that stands against a coordinate leaves a blank.
    let against = super::program(&text("L M9X+40 F200\n"));
    let output = written(&against, &pieces);
    assert!(
        output.contains("\nL X+20.000 Y+0.050 F200\nL M9X+40 Y+0.000 F200\n"),
        "{output}"
    );
    let odd = super::program(&text("L X+40 R0 F200 M77\n"));
    let error = write(&odd, &pieces, &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 4: M77 stands beside a motion that is divided"),
        "{error}"
    );
}

#[test]
fn numbered_blocks_are_numbered_again_where_some_are_added() {
    let body = "0 BEGIN PGM A MM\n7  L X+0 Y+0 Z+5 FMAX\n8  L X+40 F200\n9  CC X+40 Y+10\n10 C X+50 Y+10 DR+\n12 END PGM A MM\n";
    let program = program(body);
    // One digit: nothing is numbered again.
    let output = written(&program, &[lifted(&program, 0, 0.5)]);
    assert!(
        output.contains("\n7  L X+0 Y+0 Z+5.500 FMAX\n8  L X+40 Z+5.000 F200\n"),
        "{output}"
    );
    assert!(output.contains("\n12 END PGM"));
    let side = 10.0 * 0.5_f64.sqrt();
    let pieces = [
        Piece::to(2, Vector3::new(40.0 + side, 10.0 - side, 5.0)),
        Piece::to(2, Vector3::new(50.0, 10.0, 5.0)),
    ];
    let output = written(&program, &pieces);
    assert_eq!(
        output,
        "0 BEGIN PGM A MM\n1  L X+0 Y+0 Z+5 FMAX\n2  L X+40 F200\n3  CC X+40 Y+10\n4 L X+47.071 Y+2.929\n5 L X+50.000 Y+10.000\n6 END PGM A MM\n"
    );
}

#[test]
fn polar_blocks_and_circles_become_straight_where_they_change() {
    let body = text("CC X+50 Y+50\nLP PR+30 PA+0 F500\nLP IPA+90\nCP IPA+90 IZ-1 DR+\nL X+0\n");
    let program = program(&body);
    let moved = |motion: usize| {
        let [x, y, z] = place(&program, motion);
        Piece::to(motion, Vector3::new(x + 0.01, y, z))
    };
    let output = written(&program, &[moved(1), moved(2), moved(3)]);
    let expected = text(
        "CC X+50 Y+50\nL X+80.010 Y+50.000 F500\nL X+50.010 Y+80.000\nL X+20.010 Y+50.000 Z+4.000\nL X+0\n",
    );
    assert_eq!(output, expected);
    // A step in the angle behind a place that changes ends where it did.
    let output = written(&program, &[moved(1), moved(3)]);
    assert!(
        output.contains("\nL X+50.000 Y+80.000\nL X+20.010"),
        "{output}"
    );
}

#[test]
fn arcs_are_not_bent_by_their_start() {
    let program = program(&text("L X+10 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+\n"));
    let start = Piece::to(1, Vector3::new(10.1, 0.0, 5.0));
    let refused = |pieces: &[Piece]| {
        write(&program, pieces, &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&[start]).contains("line 6: the arc begins at a place that changes"));
    let mut through = Piece::to(2, Vector3::new(0.0, 10.0, 5.0));
    through.via_mm = Some(Vector3::new(7.0, 7.0, 5.0));
    assert!(refused(&[through]).contains("circles are written about centres"));
    let tangential = super::program(&text("L X+10 F100\nCT X+20 Y+10\n"));
    let pieces = [
        Piece::to(1, Vector3::new(5.0, 0.1, 5.0)),
        Piece::to(1, Vector3::new(10.0, 0.0, 5.0)),
    ];
    let error = write(&tangential, &pieces, &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 5: the arc begins in the direction of the block before it"),
        "{error}"
    );
    // A pole that was set from a place that changes.
    let relative = super::program(&text(
        "L X+10 F100\nCC IX-10 IY+0\nL X+10 Y+0\nC X+0 Y+10 DR+\n",
    ));
    let error = write(
        &relative,
        &[Piece::to(1, Vector3::new(10.0, 0.2, 5.0))],
        &WriteOptions::default(),
    );
    assert!(error.unwrap_err().to_string().contains("line 7"));
}

#[test]
fn arcs_behind_a_place_of_the_machine_are_not_bent_by_their_start_either() {
    // The tool is away along its axis alone: the arc begins where the block before the last one ends.
    for arc in ["CC X+0 Y+0\nC X+0 Y+10 DR+\n", "CR X+0 Y+10 R+10 DR+\n"] {
        let body = format!("L X+10 F100\nL Z-10 M91 FMAX\n{arc}L X+3 Y+3 Z+5\n");
        let mut options = ReadOptions::default();
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        let program = super::read_with(text(&body).as_bytes(), &options).unwrap();
        let moved = |x: f64| {
            let piece = Piece::to(1, Vector3::new(x, 0.0, 5.0));
            write(&program, &[piece], &WriteOptions::default()).map_err(|error| error.to_string())
        };
        let line = 5 + arc.lines().count();
        let error = moved(10.1).unwrap_err();
        let part = format!("line {line}: the arc begins at a place that changes");
        assert!(error.contains(&part), "{error}");
        assert!(moved(10.0).is_ok());
    }
    // So does one about a pole that was set at a place that changes, though it begins where it did.
    let body = "L X+10 F100\nCC IX-10 IY+0\nL X+10 Y+0\nL Z-10 M91 FMAX\nC X+0 Y+10 DR+\n";
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let program = super::read_with(text(body).as_bytes(), &options).unwrap();
    let piece = Piece::to(1, Vector3::new(10.0, 0.2, 5.0));
    let error = write(&program, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("line 8"), "{error}");
}

#[test]
fn feeds_of_pieces_are_restored_behind_them() {
    let program = program(&text(
        "L X+40 R0 F200\nL Y+10\nL X+0 M9\nL Y+0 FMAX\nL X+5 F300\n",
    ));
    let mut slow = Piece::to(2, Vector3::new(40.0, 10.0, 5.0));
    slow.speed_factor = 0.5;
    let output = written(&program, &[slow]);
    let expected = text("L X+40 R0 F200\nL Y+10 F100\nL X+0 F200 M9\nL Y+0 FMAX\nL X+5 F300\n");
    assert_eq!(output, expected);
}

#[test]
fn shifted_turned_and_inch_coordinates_are_written_as_programmed() {
    let program = program(EVERYTHING);
    let index = program
        .motions
        .iter()
        .position(|motion| motion.line == 34)
        .unwrap();
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    // 0.5 mm further along the turned X.
    let to = Vector3::new(100.0 + 20.5 * cos, -10.0 + 20.5 * sin, 7.0);
    let output = written(&program, &[Piece::to(index, to)]);
    assert_eq!(
        output,
        EVERYTHING.replace("33 L X+20 Y+0 F300", "33 L X+20.500 Y+0 F300")
    );
    let inch = super::program("BEGIN PGM A INCH\nL X+1 Y+2 Z+3 FMAX\nEND PGM A INCH\n");
    let output = written(&inch, &[Piece::to(0, Vector3::new(25.654, 50.8, 76.2))]);
    assert!(output.contains("L X+1.01000 Y+2 Z+3 FMAX"), "{output}");
}

#[test]
fn holes_stay_where_they_are_behind_a_place_that_changes() {
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let body = text("L X+10 Y+20 F100\nL X+30 FMAX M99\nL IX+5 FMAX M99\nL M140 MB MAX\n");
    let program = super::read_with(body.as_bytes(), &options).unwrap();
    let pieces = [Piece::to(1, Vector3::new(10.1, 20.2, 5.0))];
    let output = written(&program, &pieces);
    let expected = text(
        "L X+10.100 Y+20.200 F100\nL Y+20.0000 X+30 FMAX M99\nL IX+5 FMAX M99\nL M140 MB MAX\n",
    );
    assert_eq!(output, expected);
}

#[test]
fn what_cannot_be_written_is_said() {
    let program = program(EVERYTHING);
    let refused = |piece: Piece| {
        write(&program, &[piece], &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(Piece::to(0, Vector3::zeros())).contains("line 12: the motion has no place"));
    assert!(refused(Piece::to(999, Vector3::zeros())).contains("motion 999"));
    assert!(refused(Piece::to(2, Vector3::repeat(f64::NAN))).contains("no finite place"));
    let mut turned = lifted(&program, 2, 0.0);
    turned.rotary_deg = Some(vec![f64::INFINITY]);
    assert!(refused(turned).contains("no finite angle of an axis"));
    let mut turned = lifted(&program, 3, 0.0);
    turned.orientation = Some(nalgebra::UnitQuaternion::from_euler_angles(0.1, 0.0, 0.0));
    assert!(refused(turned).contains("states a direction of the tool"));
    let mut rapid = lifted(&program, 2, 0.0);
    rapid.speed_factor = 0.5;
    assert!(refused(rapid).contains("its speed cannot be changed"));
}

#[test]
fn along_the_tool_behind_a_rotation_the_tool_stays_over_its_place() {
    let body = text("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+90\nL Z-1 F200\nL X+3 Y+0\n");
    let program = program(&body);
    let places: Vec<[f64; 3]> = (0..3).map(|motion| place(&program, motion)).collect();
    assert_eq!(places[1], [0.0, 0.0, -1.0]);
    let away = Vector3::from(places[2]) - Vector3::new(0.0, 3.0, -1.0);
    assert!(away.norm() < 1e-12, "{places:?}");
    // Beside its place: X and Y are both stated, in the turned axes.
    let piece = Piece::to(1, Vector3::new(0.25, 0.0, -1.0));
    let output = written(&program, &[piece]);
    assert!(output.contains("L X+0.000 Y-0.250 Z-1 F200\n"), "{output}");
    assert!(output.contains("\nL X+3 Y+0\n"), "{output}");
    // X alone: whether Y turns with it, controls do not say.
    let odd = body.replace("L X+3 Y+0", "L X+3");
    let options = ReadOptions::default();
    let errors = read_heidenhain(vec![SourceFile::new("a.h", odd)], &options).unwrap_err();
    assert_eq!((errors.len(), errors[0].line), (1, 7), "{errors:?}");
}
