//! Arcs: their sense by kind of file, whole turns, and what they become.

use std::f64::consts::{PI, TAU};

use kinetostat_formats::*;
use nalgebra::{Rotation3, Unit, Vector3};

use super::{NX, SOLIDWORKS, program, written};

fn angles(program: &RobotProgram) -> Vec<f64> {
    let kinds = program.motions.iter().map(|motion| &motion.kind);
    kinds
        .filter_map(|kind| match kind {
            MotionKind::Arc { angle_rad, .. } => Some(*angle_rad),
            _ => None,
        })
        .collect()
}

#[test]
fn arcs_end_where_they_say() {
    for text in [SOLIDWORKS, NX] {
        let program = program(text);
        let mut seen = 0;
        for motion in &program.motions {
            let MotionKind::Arc {
                centre_mm,
                axis,
                angle_rad,
            } = motion.kind
            else {
                continue;
            };
            let start = program.motions[motion.follows.unwrap()]
                .target
                .pose()
                .unwrap()
                .position_mm;
            let end = motion.target.pose().unwrap().position_mm;
            let turn = Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle_rad);
            let rise = axis * (end - start).dot(&axis);
            let found = centre_mm + turn * (start - centre_mm) + rise;
            assert!((found - end).norm() < 2e-6, "{found} {end}");
            seen += 1;
        }
        assert!(seen >= 2);
    }
}

#[test]
fn solidworks_turns_right_handed_and_nx_left_handed() {
    // A quarter, nearly a whole turn (the bore is milled around), and a whole turn whose end is its start.
    let found = angles(&program(SOLIDWORKS));
    assert!(
        (found[0] - 92.39_f64.to_radians()).abs() < 1e-3,
        "{found:?}"
    );
    assert!(found[1] > 350.0_f64.to_radians() && found[1] < TAU);
    assert_eq!(found[2], TAU);
    // About -Z left-handed is to the left; then back with a fall of 1 mm: a helix.
    let found = angles(&program(NX));
    assert!((found[0] + PI / 2.0).abs() < 1e-12, "{found:?}");
    assert!((found[1] + PI / 2.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_divided_arc_loses_its_circle_and_the_words_between_stay() {
    let program = program(NX);
    let arc = program
        .motions
        .iter()
        .position(|motion| matches!(motion.kind, MotionKind::Arc { .. }))
        .unwrap();
    let side = 20.0 * (PI / 4.0).sin();
    let pieces = [
        Piece::to(arc, Vector3::new(side, side, 466.0)),
        Piece::to(arc, Vector3::new(0.0, 20.0, 466.0)),
    ];
    let output = written(&program, &pieces);
    assert!(
        output.contains("PAINT/COLOR,31\nPAINT/COLOR,36\nGOTO/14.1421,14.1421,466.0000\nGOTO/0.0000,20.0000,466.0000\nCIRCLE/"),
        "{output}"
    );
}

#[test]
fn an_arc_is_not_bent_by_its_end_or_its_start() {
    let program = program(NX);
    let arc = program
        .motions
        .iter()
        .position(|motion| matches!(motion.kind, MotionKind::Arc { .. }))
        .unwrap();
    // The arc behind it goes on from its end.
    let next = &program.motions[arc + 1];
    let kept = Piece::to(arc + 1, next.target.pose().unwrap().position_mm);
    let refused = |piece: Piece| {
        write(&program, &[piece, kept.clone()], &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    // Without a place between it is straight.
    let straight = Piece::to(arc, Vector3::new(0.0, 20.1, 466.0));
    let files = write(
        &program,
        &[straight, kept.clone()],
        &WriteOptions::default(),
    )
    .unwrap();
    let text = String::from_utf8_lossy(&files[0].1).into_owned();
    let circles = |text: &str| text.matches("CIRCLE/").count();
    // So is the arc behind it, of one piece, too.
    assert_eq!(circles(&text) + 2, circles(NX));
    let mut through = Piece::to(arc, Vector3::new(0.0, 20.1, 466.0));
    through.via_mm = Some(Vector3::new(14.2, 14.2, 466.0));
    assert!(refused(through).contains("none about its written centre"));
    let start = refused(Piece::to(arc - 1, Vector3::new(20.1, 0.0, 466.0)));
    assert!(
        start.contains("line 16: the arc begins at a place that changes"),
        "{start}"
    );
    // A start that does not change is none.
    let same = Piece::to(arc - 1, Vector3::new(20.0, 0.0, 466.0));
    assert_eq!(written(&program, &[same]), NX);
}

#[test]
fn paths_go_along_arcs_helices_and_rapids() {
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("PART".into(), nalgebra::Isometry3::identity());
    let program = super::read_with(NX.as_bytes(), &options).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let lengths: Vec<f64> = robot
        .path
        .moves
        .iter()
        .map(kinetostat_program::Move::length_mm)
        .collect();
    // A quarter of radius 20 mm, and one with a fall of 1 mm.
    let quarter = 20.0 * PI / 2.0;
    assert!((lengths[2] - quarter).abs() < 1e-9, "{lengths:?}");
    assert!(
        (lengths[3] - quarter.hypot(1.0)).abs() < 1e-9,
        "{lengths:?}"
    );
    let rapid: Vec<bool> = (robot.path.moves.iter())
        .map(|one| one.kind == kinetostat_program::MoveKind::Rapid)
        .collect();
    assert_eq!(rapid[..3], [true, false, false]);
}
