//! Where corrections go: literals, poses with names, computed poses, further statements, circles.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{in_def, moved, program, written};

fn line_of(text: &str, line: usize) -> &str {
    text.lines().nth(line - 1).unwrap()
}

#[test]
fn numbers_are_written_in_metres_with_their_decimals() {
    let literal = "movel(p[0.4809100, -.0405 ,2.5E-1,0,3.14159,0.0],a=1.2,v=0.02)";
    let program = in_def(literal);
    let text = written(
        &program,
        &[moved(&program, 0, [0.001_234_56, 0.0126, 1e-5])],
    );
    let expected = "movel(p[0.4809112, -.040487 ,2.5E-1,0,3.14159,0.0],a=1.2,v=0.02)";
    assert_eq!(line_of(&text, 2), expected);
    let mut piece = moved(&program, 0, [0.0; 3]);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1e-3);
    let own = program.motions[0].target.pose().unwrap().orientation;
    piece.orientation = Some(turn * own);
    piece.speed_factor = 1.5;
    let text = written(&program, &[piece]);
    let vector = (turn * own).scaled_axis();
    let expected = format!(
        "movel(p[0.4809100, -.0405 ,2.5E-1,{:.7},{:.7},0.0],a=1.2,v=0.03)",
        vector.x, vector.y
    );
    assert_eq!(line_of(&text, 2), expected);
}

#[test]
fn a_pose_with_a_name_is_edited_where_all_uses_agree_and_copied_otherwise() {
    let text = "global P1=p[0.1,0.2,0.3,0,3.1,0] # here\nmovel(P1)\nmovel(pose_trans(P2,p[0,0,0.05,0,0,0]))\nmovel(P1, v=0.1)";
    let text = format!("P2=p[0.5,0,0,0,0,0]\n{text}");
    let program = in_def(&text);
    let same = [
        moved(&program, 0, [0.0, 0.0, 0.1]),
        moved(&program, 2, [0.0, 0.0, 0.1]),
    ];
    let output = written(&program, &same);
    assert_eq!(
        line_of(&output, 3),
        "global P1=p[0.1,0.2,0.300100,0,3.1,0] # here"
    );
    assert!(
        output.contains("movel(P1)\n") && output.contains("movel(P1, v=0.1)"),
        "{output}"
    );
    let other = [
        moved(&program, 0, [0.0, 0.0, 0.1]),
        moved(&program, 2, [0.1, 0.0, 0.0]),
    ];
    let output = written(&program, &other);
    let lines = "global P1_2=p[0.100100,0.2,0.3,0,3.1,0]\nglobal P1=p[0.1,0.2,0.300100,0,3.1,0] # here\nmovel(P1)";
    assert!(
        output.contains(lines) && output.contains("movel(P1_2, v=0.1)"),
        "{output}"
    );
    // The offset of a place in its own axes is edited where it stands.
    let output = written(&program, &[moved(&program, 1, [0.0, 0.0, -0.02])]);
    assert!(
        output.contains("movel(pose_trans(P2,p[0,0,0.049980,0,0,0]))"),
        "{output}"
    );
}

#[test]
fn a_pose_that_something_else_rests_on_stays() {
    let program =
        in_def("a=p[0.1,0.2,0.3,0,0,0]\nmovel(a)\nb=pose_trans(a,p[0,0,0.1,0,0,0])\nmovel(b)");
    let output = written(&program, &[moved(&program, 0, [0.1, 0.0, 0.0])]);
    let lines =
        "a_2=p[0.100100,0.2,0.3,0,0,0]\na=p[0.1,0.2,0.3,0,0,0]\nmovel(a_2)\nb=pose_trans(a,p";
    assert!(output.contains(lines), "{output}");
    // A computed pose is written as numbers.
    let output = written(&program, &[moved(&program, 1, [0.0, 0.0, 0.1])]);
    assert!(
        output.ends_with("movel(p[0.1,0.2,0.4001,0,0,0])\nend\n"),
        "{output}"
    );
}

#[test]
fn elements_of_a_list_are_edited_and_runs_that_differ_are_refused() {
    let text =
        "path=[p[0.1,0,0,0,0,0],p[0.2,0,0,0,0,0]]\ni=0\nwhile i<2:\nmovel(path[i])\ni=i+1\nend";
    let program = in_def(text);
    assert_eq!(
        program.motions[1].target.pose().unwrap().position_mm.x,
        200.0
    );
    let pieces = [
        moved(&program, 0, [0.0, 0.1, 0.0]),
        moved(&program, 1, [0.0, 0.2, 0.0]),
    ];
    let refused = write(&program, &pieces, &WriteOptions::default()).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("needs another correction each time"),
        "{refused}"
    );
    let program =
        in_def("path=[p[0.1,0,0,0,0,0],p[0.2,0,0,0,0,0]]\nmovel(path[0])\nmovel(path[1])");
    let output = written(&program, &[moved(&program, 1, [0.0, 0.2, 0.0])]);
    assert!(
        output.contains("path=[p[0.1,0,0,0,0,0],p[0.2,0.000200,0,0,0,0]]"),
        "{output}"
    );
}

#[test]
fn a_divided_motion_passes_the_ends_of_its_pieces() {
    let program =
        in_def("  movel(p[0.1,0,0,0,0,0])\n  movel(p[0.2,0,0,0,0,0], 1.2, 0.02, 0, 0.005) # to");
    let half = moved(&program, 1, [-50.0, 0.0, 0.1]);
    let output = written(&program, &[half, moved(&program, 1, [0.0, 0.0, 0.1])]);
    let lines = "  movel(p[0.150000,0,0.000100,0,0,0], 1.2, 0.02, 0, 0.0001)\n  movel(p[0.2,0,0.000100,0,0,0], 1.2, 0.02, 0, 0.005) # to\n";
    assert!(output.contains(lines), "{output}");
    let half = moved(&program, 0, [-50.0, 0.0, 0.1]);
    let output = written(&program, &[half, moved(&program, 0, [0.0; 3])]);
    assert!(
        output.contains(
            "  movel(p[0.050000,0,0.000100,0,0,0], r=0.0001)\n  movel(p[0.1,0,0,0,0,0])\n"
        ),
        "{output}"
    );
    let timed = in_def("movel(p[0.1,0,0,0,0,0])\nmovel(p[0.2,0,0,0,0,0], t=3)");
    let half = moved(&timed, 1, [-50.0, 0.0, 0.1]);
    let refused = write(
        &timed,
        &[half, moved(&timed, 1, [0.0; 3])],
        &WriteOptions::default(),
    );
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("its time is stated")
    );
}

#[test]
fn a_speed_that_is_not_stated_is_that_of_the_manual() {
    let program = in_def("movel(p[0.1,0,0,0,0,0])");
    let mut piece = moved(&program, 0, [0.0; 3]);
    piece.speed_factor = 0.5;
    let output = written(&program, &[piece]);
    assert_eq!(line_of(&output, 2), "movel(p[0.1,0,0,0,0,0], v=0.125)");
}

#[test]
fn circles_stay_circles_or_become_straight() {
    let text = "def a():\nmovel(p[0.1,0,0,0,0,0])\nmovec(p[0.2,0.1,0,0,0,0], p[0.1,0.2,0,0,0,0], 1.2, 0.02, 0.001, 0)\nend\n";
    let program = program(text);
    let MotionKind::Circular { via } = &program.motions[1].kind else {
        panic!("no circle")
    };
    let via = via.pose().unwrap().position_mm;
    let mut piece = moved(&program, 1, [0.0, 0.0, 0.1]);
    piece.via_mm = Some(via + Vector3::new(0.1, 0.0, 0.0));
    let output = written(&program, &[piece]);
    let line = "movec(p[0.200100,0.1,0,0,0,0], p[0.1,0.2,0.000100,0,0,0], 1.2, 0.02, 0.001, 0)";
    assert_eq!(line_of(&output, 3), line);
    let half = Piece::to(1, via);
    let output = written(&program, &[half, moved(&program, 1, [0.0; 3])]);
    let lines = "movep(p[0.200000,0.100000,0,0,0,0], 1.2, 0.02, 0.0001)\nmovep(p[0.1,0.2,0,0,0,0], 1.2, 0.02, 0.001)\n";
    assert!(output.contains(lines), "{output}");
}
