//! Motions that become several, and circles.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{line_with, main_with, written};

const DATA: &str = "CONST robtarget p1:=[[100,0,5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget p2:=[[50,50,5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];";

fn at(motion: usize, place: [f64; 3]) -> Piece {
    Piece::to(motion, Vector3::from(place))
}

#[test]
fn pieces_stand_before_the_end_with_all_else_as_written() {
    let program = main_with(DATA, "\tMoveL p1,v20,fine, tool0,\\WObj:=wobj0; ! groove");
    let mut pieces = [
        at(0, [33.0, 0.0, 5.01]),
        at(0, [66.0, 0.0, 5.02]),
        at(0, [100.0, 0.0, 5.03]),
    ];
    pieces[1].speed_factor = 0.5;
    let text = written(&program, &pieces);
    let expected = "\tMoveL [[33.000,0,5.010],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z0, tool0,\\WObj:=wobj0;\n\
        \tMoveL [[66.000,0,5.020],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[10,500,5000,1000],z0, tool0,\\WObj:=wobj0;\n\
        \tMoveL p1,v20,fine, tool0,\\WObj:=wobj0; ! groove";
    assert!(text.contains(expected), "{text}");
    assert!(text.contains("p1:=[[100,0,5.030]"));
    // Read again they are three motions to those places.
    let again = super::program(&text);
    let places: Vec<f64> = again
        .motions
        .iter()
        .map(|m| m.target.pose().unwrap().position_mm.z)
        .collect();
    assert_eq!(places, [5.01, 5.02, 5.03]);
}

#[test]
fn circles_stay_circles_with_a_via_and_become_chords_with_pieces() {
    let program = main_with(DATA, "  MoveC p2, p1, v20, z1, tool0;");
    let mut piece = at(0, [100.0, 0.1, 5.0]);
    let text = written(&program, &[piece.clone()]);
    assert_eq!(line_with(&text, "MoveL"), "  MoveL p1, v20, z1, tool0;");
    piece.via_mm = Some(Vector3::new(50.0, 50.2, 5.0));
    let text = written(&program, &[piece.clone()]);
    assert!(
        text.contains("p1:=[[100,0.100,5]") && text.contains("p2:=[[50,50.200,5]"),
        "{text}"
    );
    assert_eq!(line_with(&text, "MoveC"), "  MoveC p2, p1, v20, z1, tool0;");
    piece.via_mm = None;
    let text = written(&program, &[at(0, [50.0, 50.0, 5.0]), piece]);
    let expected = "  MoveL [[50.000,50.000,5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v20, z1, tool0;\n  MoveL p1, v20, z1, tool0;";
    assert!(text.contains(expected), "{text}");
    assert!(text.contains("p2:=[[50,50,5]"));
    // Without a blank behind the word: found by the fuzz.
    let program = main_with(
        DATA,
        "MoveC[[50,50,5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],p1,v20,z1,tool0;",
    );
    let text = written(
        &program,
        &[at(0, [50.0, 50.0, 5.0]), at(0, [100.0, 0.0, 5.0])],
    );
    assert!(
        text.contains("v20,z1,tool0;\nMoveL p1,v20,z1,tool0;"),
        "{text}"
    );
}

#[test]
fn arc_welds_are_divided_by_their_own_words() {
    let weld = "v10, seam1, weld1\\Weave:=w1, fine, tool0;";
    let program = main_with(
        DATA,
        &format!("ArcCEnd p2, p1, {weld}\nArcLStart p1, {weld}"),
    );
    let text = written(
        &program,
        &[at(0, [80.0, 9.0, 5.0]), at(0, [100.0, 0.0, 5.0])],
    );
    assert!(
        line_with(&text, "ArcL [[80.000,9.000,5]")
            .ends_with("v10, seam1, weld1\\Weave:=w1, z0, tool0;")
    );
    assert_eq!(line_with(&text, "ArcLEnd"), format!("ArcLEnd p1, {weld}"));
    let error = write(
        &program,
        &[at(1, [0.0; 3]), at(1, [0.0; 3])],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("this instruction cannot be divided"),
        "{error}"
    );
}

#[test]
fn what_cannot_be_divided_says_why() {
    let cases = [
        (
            "MoveJ p1,v20,fine,tool0;",
            "a joint motion cannot be divided",
        ),
        (
            "IF TRUE MoveL p1,v20,fine,tool0;",
            "it stands behind IF without THEN",
        ),
        ("MoveL p1,v20\\T:=3,fine,tool0;", "its time is stated"),
        (
            "MoveL p1\\ID:=10,v20,fine,tool0;",
            "in step with another robot",
        ),
        (
            "TriggL p1,v20,gunon,fine,tool0;",
            "this instruction cannot be divided",
        ),
    ];
    for (statement, reason) in cases {
        let program = main_with(DATA, statement);
        let pieces = [at(0, [1.0; 3]), at(0, [2.0; 3])];
        let error = write(&program, &pieces, &WriteOptions::default()).unwrap_err();
        assert!(error.to_string().contains(reason), "{statement}: {error}");
        // As one piece each of them takes its correction.
        assert!(written(&program, &pieces[1..]).contains("p1:=[[2.000,2.000,2.000]"));
    }
}

#[test]
fn pieces_of_an_offset_have_its_configuration() {
    let program = main_with(DATA, "MoveL RelTool(p1,0,0,-10),v20,z1,tool0;");
    let text = written(
        &program,
        &[at(0, [1.0, 2.0, 3.0]), at(0, [100.0, 0.0, 15.1])],
    );
    let first = line_with(&text, "MoveL [");
    assert_eq!(
        first,
        "MoveL [[1.000,2.000,3.000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;"
    );
    assert_eq!(
        line_with(&text, "MoveL R"),
        "MoveL RelTool(p1,0,0,-10.100),v20,z1,tool0;"
    );
}

#[test]
fn lines_longer_than_allowed_are_refused() {
    let program = main_with(
        DATA,
        "MoveL [[1,2,3],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;",
    );
    let mut options = WriteOptions::default();
    options.max_line_bytes = Some(74);
    // The declarations are longer, and stay.
    assert!(write(&program, &[], &options).is_ok());
    let error = write(&program, &[at(0, [1.0, 2.0, 3.5])], &options).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 5 would be written with 79 bytes, 74 are allowed"),
        "{error}"
    );
}
