//! Where corrections go: literals, declarations, elements, offsets.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{line_with, main_with, written};

const P: &str =
    "CONST robtarget p1:=[[100,0.0,5],[0,0,-1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; ! of p1";

fn moved(program: &RobotProgram, motion: usize, by: [f64; 3]) -> Piece {
    let end = program.motions[motion].target.pose().unwrap().position_mm;
    Piece::to(motion, end + Vector3::from(by))
}

#[test]
fn numbers_keep_their_decimals_and_what_does_not_change_stays() {
    let literal = "MoveL [[48.0910000, -40.5 ,+15],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;";
    let program = main_with("", literal);
    let text = written(&program, &[moved(&program, 0, [0.00123456, 0.0, 0.0126])]);
    let expected = "MoveL [[48.0922346, -40.5 ,+15.013],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;";
    assert_eq!(line_with(&text, "MoveL"), expected);
    let mut options = WriteOptions::default();
    options.position_decimals = 5;
    let files = write(
        &program,
        &[moved(&program, 0, [0.0, 0.123456, 0.0])],
        &options,
    )
    .unwrap();
    assert!(
        String::from_utf8(files[0].1.clone())
            .unwrap()
            .contains("[48.0910000, -40.37654 ,+15]")
    );
    // From below zero to zero without a minus sign.
    let text = written(&program, &[moved(&program, 0, [0.0, 40.5 - 0.0001, 0.0])]);
    assert!(text.contains("[48.0910000, 0.000 ,+15]"), "{text}");
}

#[test]
fn quaternions_keep_the_sign_of_the_text() {
    let program = main_with(
        "",
        "MoveL [[0,0,0],[0,0,-1.0000000,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;",
    );
    let end = program.motions[0].target.pose().unwrap();
    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2e-3);
    let mut piece = Piece::to(0, end.position_mm);
    piece.orientation = Some(turn * end.orientation);
    // (cos a + i sin a)(-j) = -j cos a - k sin a with a = 0.001, by hand.
    let line = "MoveL [[0,0,0],[0,0,-0.9999995,-0.0010000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;";
    assert_eq!(line_with(&written(&program, &[piece]), "MoveL"), line);
}

#[test]
fn a_declaration_used_once_is_edited() {
    let program = main_with(P, "MoveL p1,v20,fine,tool0;");
    let text = written(&program, &[moved(&program, 0, [0.0, 0.0, -0.02])]);
    assert_eq!(line_with(&text, "CONST"), P.replace("0.0,5]", "0.0,4.980]"));
    assert_eq!(line_with(&text, "MoveL"), "MoveL p1,v20,fine,tool0;");
}

#[test]
fn a_declaration_used_alike_is_edited_once_and_otherwise_copied() {
    let data = format!("{P}\nCONST num p1_2:=1;");
    let program = main_with(
        &data,
        "MoveL p1,v20,fine,tool0;\nMoveL P1,v30,fine,tool0;\nMoveJ p1,v40,fine,tool0;",
    );
    let up = [0.0, 0.0, 0.1];
    let same: Vec<Piece> = (0..3).map(|motion| moved(&program, motion, up)).collect();
    let text = written(&program, &same);
    assert_eq!(text.matches("5.100").count(), 1);
    assert!(!text.contains("p1_3"));
    // The first keeps the name, the other two share a new one, which no other datum has.
    let two = [
        moved(&program, 0, up),
        moved(&program, 1, [0.1, 0.0, 0.0]),
        moved(&program, 2, [0.1, 0.0, 0.0]),
    ];
    let text = written(&program, &two);
    assert!(text.contains("CONST robtarget p1_3:=[[100.100,0.0,5],"));
    assert!(text.contains("CONST robtarget p1:=[[100,0.0,5.100],[0,0,-1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; ! of p1"));
    assert!(text.contains(
        "MoveL p1,v20,fine,tool0;\nMoveL p1_3,v30,fine,tool0;\nMoveJ p1_3,v40,fine,tool0;"
    ));
    // One that stays keeps the declaration as it is.
    let text = written(&program, &[moved(&program, 2, up)]);
    assert!(text.contains(P) && text.contains("MoveJ p1_3,v40"));
}

#[test]
fn what_something_else_rests_on_keeps_its_value() {
    for other in [
        "MoveJ Offs(p1,0,0,50),v100,z5,tool0;",
        "IF Distance(p1.trans,here)>5 Stop;",
        "here:=p1.trans;",
    ] {
        let program = main_with(
            &format!("{P}\nVAR pos here;"),
            &format!("{other}\nMoveL p1,v20,fine,tool0;"),
        );
        let last = program.motions.len() - 1;
        let text = written(&program, &[moved(&program, last, [0.0, 0.0, 0.1])]);
        assert!(
            text.contains(P) && text.contains("MoveL p1_2,v20"),
            "{text}"
        );
    }
}

#[test]
fn elements_of_arrays_are_edited_in_place_or_declared_anew() {
    let data = "CONST robtarget row{2}:=[[[1,1,1],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\n\
        [[2,2,2],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];";
    let program = main_with(
        data,
        "MoveL row{2},v20,fine,tool0;\nMoveL row{1},v20,fine,tool0;\nMoveL row{ 2 },v20,fine,tool0;",
    );
    let up = [0.0, 0.0, 0.1];
    let text = written(&program, &[moved(&program, 0, up), moved(&program, 2, up)]);
    assert_eq!(
        text,
        written(&program, &[]).replace("[2,2,2]", "[2,2,2.100]")
    );
    let text = written(&program, &[moved(&program, 2, up)]);
    assert!(text.contains(
        "CONST robtarget row_2:=[[2,2,2.100],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nCONST"
    ));
    assert!(text.contains("MoveL row{2},v20") && text.contains("MoveL row_2,v20"));
}

#[test]
fn offsets_take_the_correction_in_their_own_axes() {
    let data = format!("{P}\nCONST num high:=50;");
    // The tool of p1 is turned half about y: its x and z are against those of the work object.
    let statements =
        "MoveL Offs(p1,0,0,high),v20,z1,tool0;\nMoveL RelTool(p1,0,2,-20\\Rz:=90),v20,z1,tool0;";
    let program = main_with(&data, statements);
    let by = [0.3, 0.02, -0.1];
    let text = written(&program, &[moved(&program, 0, by), moved(&program, 1, by)]);
    assert_eq!(
        line_with(&text, "MoveL O"),
        "MoveL Offs(p1,0.300,0.020,49.900),v20,z1,tool0;"
    );
    assert_eq!(
        line_with(&text, "MoveL R"),
        "MoveL RelTool(p1,-0.300,2.020,-19.900\\Rz:=90),v20,z1,tool0;"
    );
    assert!(text.contains(&data));
}

#[test]
fn an_offset_that_turns_becomes_the_target_itself() {
    let program = main_with(P, "MoveL Offs(p1,1,0,0),v20,z1,tool0;");
    let end = program.motions[0].target.pose().unwrap();
    let mut piece = Piece::to(0, end.position_mm);
    piece.orientation =
        Some(end.orientation * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 2e-3));
    let text = written(&program, &[piece]);
    let expected = "MoveL [[101.000,0.0,5],[0,-0.0010000,-0.9999995,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;";
    assert_eq!(line_with(&text, "MoveL"), expected);
}

#[test]
fn new_names_keep_the_length_that_controllers_read() {
    let name = "a234567890123456789012345678_32x";
    assert_eq!(name.len(), 32);
    let program = main_with(
        &P.replace("p1:", &format!("{name}:")),
        &format!("MoveL {name},v20,z1,tool0;\nMoveL {name},v20,z1,tool0;"),
    );
    let text = written(&program, &[moved(&program, 1, [0.1, 0.0, 0.0])]);
    assert!(
        text.contains("MoveL a234567890123456789012345678_3_2,v20"),
        "{text}"
    );
}

#[test]
fn speeds_are_multiplied_where_they_are_known() {
    let program = main_with(
        "CONST speeddata vc:=[12.5,400,5000,1000];",
        "MoveL [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\nMoveL [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],vc,z1,tool0;\nMoveL [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,z1,tool0;",
    );
    let pieces = |count: usize| -> Vec<Piece> {
        (0..count)
            .map(|motion| {
                let mut piece = moved(&program, motion, [0.0; 3]);
                piece.speed_factor = 1.01;
                piece
            })
            .collect()
    };
    let text = written(&program, &pieces(2));
    assert!(
        text.contains(",[20.2,500,5000,1000],z1") && text.contains(",[12.625,400,5000,1000],z1"),
        "{text}"
    );
    let error = write(&program, &pieces(3), &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 6: its speed cannot be changed"),
        "{error}"
    );
}

#[test]
fn joints_unknown_motions_and_absurd_pieces_are_refused() {
    let program = main_with(
        P,
        "MoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\nMoveL p1,v20,fine,tool0;",
    );
    let refused = |piece: Piece| {
        write(&program, &[piece], &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(Piece::to(0, Vector3::zeros())).contains("line 4: the motion has no pose"));
    assert!(
        refused(Piece::to(1, Vector3::new(f64::NAN, 0.0, 0.0)))
            .contains("line 5: a piece has no finite place")
    );
    assert!(
        refused(Piece::to(9, Vector3::zeros())).contains("motion 9, the program has 2 motions")
    );
    let mut still = Piece::to(1, Vector3::zeros());
    still.speed_factor = 0.0;
    assert!(refused(still).contains("no finite place, orientation or speed"));
    let mut turned = Piece::to(1, Vector3::zeros());
    turned.rotary_deg = Some(vec![0.0, f64::NAN]);
    assert!(refused(turned).contains("no finite angle of an axis"));
}

#[test]
fn options_before_the_target_do_not_hide_it() {
    let program = main_with(P, "MoveL\\Conc, p1,v20,fine,tool0;");
    let text = written(&program, &[moved(&program, 0, [0.0, 0.0, 0.1])]);
    assert!(text.contains("p1:=[[100,0.0,5.100]") && text.contains("MoveL\\Conc, p1,v20"));
}

#[test]
fn one_declaration_for_thousands_of_motions_is_copied_at_once() {
    let program = main_with(P, &"MoveL p1,v20,fine,tool0;\n".repeat(20_000));
    let pieces: Vec<Piece> = (0..20_000)
        .map(|index| moved(&program, index, [0.01 * index as f64, 0.0, 0.0]))
        .collect();
    let text = written(&program, &pieces);
    assert!(text.contains("CONST robtarget p1_20000:=[[299.990,0.0,5]"));
    assert_eq!(super::program(&text).motions.len(), 20_000);
}
