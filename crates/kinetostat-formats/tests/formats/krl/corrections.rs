//! Where a correction goes in the text.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{line_with, main_with, read_both, written};

const P1: &str = "DECL E6POS XP1={X 100.5,Y 0,Z 5.12345,A 90.0,B 0,C 180,S 2,T 35,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0} ; start";

fn at(motion: usize, place: [f64; 3]) -> Piece {
    Piece::to(motion, Vector3::from(place))
}

#[test]
fn numbers_of_a_literal_keep_their_digits_and_all_else() {
    let program = main_with(
        "",
        "LIN {X 10,Y .5,Z -3.12345,A 0,B 0,C 180,S 'B010',T 35} C_DIS ; groove",
    );
    let text = written(&program, &[at(0, [10.0123, 0.25, -3.1])]);
    assert!(
        text.contains(
            "LIN {X 10.012,Y .250,Z -3.10000,A 0,B 0,C 180,S 'B010',T 35} C_DIS ; groove"
        ),
        "{text}"
    );
}

#[test]
fn angles_stay_on_the_turn_that_was_written() {
    let program = main_with("", "LIN {X 0,Y 0,Z 0,A 180,B 0,C -180}");
    let end = program.motions[0].target.pose().unwrap().orientation;
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.01_f64.to_radians());
    let mut piece = at(0, [0.0; 3]);
    piece.orientation = Some(turn * end);
    // Past half a turn it goes on to 180.01 rather than to -179.99.
    assert!(written(&program, &[piece]).contains("{X 0,Y 0,Z 0,A 180.01000,B 0,C -180}"));
}

#[test]
fn a_declaration_of_one_use_is_edited_in_its_data_list() {
    let program = main_with(P1, "LIN Xp1");
    let text = written(&program, &[at(0, [100.6, 0.0, 5.0])]);
    assert!(text.contains("LIN Xp1\n"));
    let expected = P1.replace("X 100.5,Y 0,Z 5.12345", "X 100.600,Y 0,Z 5.00000");
    assert!(text.contains(&expected), "{text}");
}

#[test]
fn uses_that_agree_share_the_declaration_and_others_get_copies() {
    let program = main_with(
        P1,
        "LIN XP1 ; one\nLIN {X 0,Y 0,Z 0}\nLIN XP1 ; two\nLIN XP1 ; three",
    );
    let same = [
        at(0, [1.0, 2.0, 3.0]),
        at(2, [1.0, 2.0, 3.0]),
        at(3, [1.0, 2.0, 3.0]),
    ];
    let text = written(&program, &same);
    assert!(text.contains("XP1={X 1.000,Y 2.000,Z 3.00000,") && !text.contains("XP1_2"));

    let text = written(&program, &[at(0, [1.0, 2.0, 3.0]), at(2, [4.0, 5.0, 6.0])]);
    assert!(
        text.contains("LIN XP1_2 ; one")
            && text.contains("LIN XP1_3 ; two")
            && text.contains("LIN XP1 ; three"),
        "{text}"
    );
    let copy = line_with(&text, "DECL E6POS XP1_2");
    assert_eq!(
        copy,
        "DECL E6POS XP1_2={X 1.000,Y 2.000,Z 3.00000,A 90.0,B 0,C 180,S 2,T 35,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}"
    );
    assert!(text.contains(P1));
}

#[test]
fn what_something_else_rests_on_stays() {
    let program = main_with(P1, "$H_POS=XP1\nLIN XP1");
    let text = written(&program, &[at(0, [1.0, 2.0, 3.0])]);
    assert!(text.contains("$H_POS=XP1\nLIN XP1_2\n") && text.contains(P1));
    // A sum rests on it as well, and takes its own correction into what is added.
    let program = main_with(P1, "LIN XP1:{X 0.0,Y 4.0,Z 0,A 0.0,B 0.0,C 0.0}\nLIN XP1");
    let end = program.motions[0].target.pose().unwrap().position_mm;
    // A quarter about Z, a half about X: Y of the pose is X of the base.
    assert!((end - Vector3::new(104.5, 0.0, 5.12345)).norm() < 1e-9);
    let text = written(
        &program,
        &[at(0, [104.6, 0.1, 5.12345]), at(1, [100.5, 0.0, 5.2])],
    );
    assert!(
        text.contains("LIN XP1:{X 0.100,Y 4.100,Z 0,A 0.0,B 0.0,C 0.0}\nLIN XP1_2\n"),
        "{text}"
    );
    assert!(text.contains(P1));
}

#[test]
fn a_turned_end_of_a_sum_is_written_in_its_place() {
    let program = main_with(P1, "LIN XP1:{X 0,Y 4,Z 0,A 0,B 0,C 0} C_DIS");
    let end = program.motions[0].target.pose().unwrap().clone();
    let mut piece = Piece::to(0, end.position_mm);
    piece.orientation =
        Some(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1e-3) * end.orientation);
    let text = written(&program, &[piece]);
    assert_eq!(
        line_with(&text, "LIN"),
        "LIN {X 104.500,Y 0,Z 5.12345,A 90.05730,B 0,C 180,S 2,T 35,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0} C_DIS"
    );
}

#[test]
fn elements_of_arrays_are_edited_or_get_a_name_of_their_own() {
    let data =
        "DECL FRAME way[2]\nway[1]={X 1,Y 2,Z 3,A 0,B 0,C 0}\n  way[2]={X 4,Y 5,Z 6,A 0,B 0,C 0}";
    let program = main_with(data, "LIN way[1]\nLIN way[2]\nLIN WAY[ 2 ] C_DIS");
    let text = written(&program, &[at(0, [1.5, 2.0, 3.0]), at(1, [4.5, 5.0, 6.0])]);
    assert!(text.contains("way[1]={X 1.500,Y 2,Z 3,"));
    assert!(
        text.contains("  DECL FRAME way_2={X 4.500,Y 5,Z 6,A 0,B 0,C 0}\n  way[2]={X 4,"),
        "{text}"
    );
    assert!(text.contains("LIN way_2\nLIN WAY[ 2 ] C_DIS"));
}

#[test]
fn names_stay_within_24_characters_and_free() {
    let name = "XVERY_LONG_NAME_OF_A_POI";
    let data =
        format!("DECL FRAME {name}={{X 1,Y 2,Z 3,A 0,B 0,C 0}}\nINT XVERY_LONG_NAME_OF_A_P_2");
    let program = main_with(&data, &format!("LIN {name}\nLIN {name}"));
    let text = written(&program, &[at(0, [1.5, 2.0, 3.0])]);
    assert!(
        text.contains("LIN XVERY_LONG_NAME_OF_A__2\n")
            || text.contains("LIN XVERY_LONG_NAME_OF_A_P_3\n"),
        "{text}"
    );
    for word in text.split(|letter: char| !letter.is_alphanumeric() && letter != '_') {
        assert!(word.len() <= 25, "{word}");
    }
}

#[test]
fn the_fold_shows_the_point_that_runs() {
    let fold = |point: &str| {
        format!(
            ";FOLD LIN {point} Vel=0.05 m/s CPDAT1 Tool[1] Base[0];%{{PE}}%VLIN,%P 1:LIN, 2:{point}, 3:, 5:0.05, 7:CPDAT1\n\
             ;FOLD Parameters ;%{{h}}\n;Params Kuka.PointName={point}; Kuka.MovementDataPdatName=PDAT1\n;ENDFOLD\n\
             FDAT_ACT=F{point}\nBAS(#CP_PARAMS,0.05)\nLIN X{point}\n;ENDFOLD"
        )
    };
    let data =
        format!("{P1}\n  DECL FDAT FP1={{TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \"}}");
    let source =
        |first: &str, second: &str| format!("DEF part()\n{}\n{}\nEND\n", fold(first), fold(second));
    let program = read_both(
        &source("P1", "P1"),
        &format!("DEFDAT part\n{data}\nENDDAT\n"),
    );
    let text = written(&program, &[at(1, [1.0, 2.0, 3.0])]);
    assert!(text.starts_with(&source("P1", "P1_2")), "{text}");
    assert!(text.contains("  DECL FDAT FP1_2={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \"}\n  DECL FDAT FP1={"), "{text}");
    assert!(text.contains("XP1_2={X 1.000,Y 2.000,Z 3.00000"));
}

#[test]
fn ends_that_cannot_take_a_correction_say_so() {
    let program = main_with(
        "",
        "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN {Z 5}\nLIN {X 1,Y 2,Z 9}\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}",
    );
    let refused = |piece: Piece| {
        write(&program, &[piece], &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(at(3, [1.0, 2.0, 5.1])).contains("no pose that could be corrected"));
    let mut piece = at(2, [1.0, 2.0, 9.0]);
    piece.orientation = Some(UnitQuaternion::from_euler_angles(0.0, 0.0, 0.1));
    // The angles of before are stated where they no longer hold: a turn of 0.1 rad about Z.
    let text = written(&program, &[piece]);
    assert!(text.contains("LIN {X 1,Y 2,Z 9,A 5.72958,B"), "{text}");
    // Its place alone can be.
    assert!(written(&program, &[at(2, [1.0, 2.0, 9.1])]).contains("LIN {X 1,Y 2,Z 9.100}"));
}

#[test]
fn angles_left_out_are_those_of_before() {
    let program = main_with(
        "",
        "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.02\nPTP {X 0,Y 0,Z 20,A -180,B 20,C 180}\nLIN {X 0,Y 0,Z -1}\nCIRC {X 10,Y 10,Z -1},{X 20,Y 0,Z -1}\nSLIN {X 40,Y 0,Z -1}\nLIN {Z 20}",
    );
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    assert_eq!(robot.path.moves.len(), 5);
    // Rx(180) takes z to -z, Ry(20) leans it to (-sin 20, 0, -cos 20), Rz(-180) turns x round.
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    for motion in &robot.path.moves {
        let z = motion.orientation(1.0).unwrap() * Vector3::z();
        assert!((z - Vector3::new(sin, 0.0, -cos)).norm() < 1e-9, "{z}");
    }
    assert!((robot.path.moves[4].end - Vector3::new(40.0, 0.0, 20.0)).norm() < 1e-9);
}
