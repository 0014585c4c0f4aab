//! Corrected places, further statements, turned axes.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{CATIA, NX, OTHER, SOLIDWORKS, place, program, written};

fn lifted(program: &RobotProgram, motion: usize, by: f64) -> Piece {
    let [x, y, z] = place(program, motion);
    Piece::to(motion, Vector3::new(x, y, z + by))
}

#[test]
fn only_the_numbers_change_and_columns_stay() {
    let program = super::program(CATIA);
    let output = written(&program, &[lifted(&program, 1, 0.123)]);
    let expected = CATIA.replace(
        "GOTO  /    0.00000,    0.00000,  -20.00000 $$ deep",
        "GOTO  /    0.00000,    0.00000,  -19.87700 $$ deep",
    );
    assert_eq!(output, expected);
    let program = super::program(SOLIDWORKS);
    let last = program.motions.len() - 1;
    let output = written(&program, &[lifted(&program, last, 0.0104)]);
    assert_eq!(
        output,
        SOLIDWORKS.replace("GOTO/1.,.25,0\n", "GOTO/1.,.25,0.010\n")
    );
}

#[test]
fn pieces_are_places_before_and_rapid_holds_for_each() {
    let program = super::program(SOLIDWORKS);
    let pieces = [
        Piece::to(0, Vector3::new(77.5, 145.0, 30.0)),
        Piece::to(0, Vector3::new(77.5, 145.0, 25.0)),
    ];
    let output = written(&program, &pieces);
    assert!(
        output.contains(
            "\nRAPID/\nGOTO/77.5,145.,30.000,0,0,1.\nRAPID/\nGOTO/77.5,145.,25.,0,0,1.\nFEDRAT"
        ),
        "{output}"
    );
    let again = super::program(&output);
    assert_eq!(again.motions[0].speed.text, "RAPID/");
    assert_eq!(again.motions[1].speed.text, "RAPID/");
}

#[test]
fn a_step_becomes_a_place_where_it_or_its_start_changes() {
    let program = super::program(NX);
    let step = program.motions.len() - 2;
    let output = written(&program, &[lifted(&program, step, 0.25)]);
    assert_eq!(
        output,
        NX.replace(
            "GODLTA/0.0000,0.0000,100.5000",
            "GOTO/20.0000,0.0000,565.7500"
        )
    );
    let text = "UNITS/MM\nFROM/0,0,0\nGOTO/1,2,3\nGODLTA/1,0,0\nGODLTA/0,1,0\n";
    let program = super::program(text);
    let output = written(&program, &[lifted(&program, 0, 0.5)]);
    assert_eq!(
        output,
        "UNITS/MM\nFROM/0,0,0\nGOTO/1,2,3.500\nGOTO/2.000,2.000,3.000\nGODLTA/0,1,0\n"
    );
    assert_eq!(place(&super::program(&output), 2), [2.0, 3.0, 3.0]);
}

#[test]
fn inches_are_written_as_inches() {
    let program = super::program(OTHER);
    let output = written(&program, &[lifted(&program, 1, 0.254)]);
    assert_eq!(
        output,
        OTHER.replace("GOTO / 10, 10, 0", "GOTO / 10, 10, 0.01000")
    );
}

#[test]
fn axes_are_turned_where_they_stand_or_get_one() {
    let text = "UNITS/MM\nGOTO/1,2,3,0.0000000,0.0000000,1.0000000\nGOTO/1,2,4,0.0000000,0.0000000,1.0000000\nGOTO/1,2,5\n";
    let program = program(text);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.1);
    let turned = |motion: usize| {
        let mut piece = lifted(&program, motion, 0.0);
        piece.orientation = Some(turn);
        piece
    };
    let output = written(&program, &[turned(0)]);
    assert!(
        output.contains("GOTO/1,2,3,0.0998334,0.0000000,0.9950042\n"),
        "{output}"
    );
    // Without an axis of its own it gets one, and so does the one behind it, which would take it over.
    let output = written(&program, &[turned(1)]);
    assert!(
        output.ends_with(
            "GOTO/1,2,4,0.0998334,0.0000000,0.9950042\nGOTO/1,2,5,0.0000000,0.0000000,1.0000000\n"
        ),
        "{output}"
    );
    let output = written(&program, &[turned(2)]);
    assert!(
        output.ends_with("GOTO/1,2,5,0.0998334,0.0000000,0.9950042\n"),
        "{output}"
    );
    // A turn about the axis is free: nothing is written.
    let mut free = lifted(&program, 2, 0.0);
    free.orientation = Some(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1.0));
    assert_eq!(written(&program, &[free]), text);
}

#[test]
fn speeds_stay() {
    let program = super::program(OTHER);
    let mut piece = lifted(&program, 1, 0.0);
    piece.speed_factor = 1.5;
    let error = write(&program, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 7: its speed cannot be changed"),
        "{error}"
    );
}
