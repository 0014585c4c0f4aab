//! Segments of spline blocks, and steps from where the tool is.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{main_with, written};
use crate::paths::corrected;

const DATA: &str = "DECL POS XP1={X 100,Y 0,Z 5,A 0,B 0,C 180}\nDECL POS XP2={X 150,Y 50,Z 5,A 0,B 0,C 180}\nDECL POS XP3={X 100,Y 100,Z 5,A 0,B 0,C 180}";

const BLOCK: &str = "$VEL.CP=0.5\nLIN {X 0,Y 0,Z 5,A 0,B 0,C 180}\nSPLINE WITH $VEL.CP=0.2\n  SLIN XP1\n  SLIN {X 100,Y 0,Z 3,A 10,B 0,C 180} WITH $VEL.CP=0.05\n  SCIRC XP2,XP3\nENDSPLINE C_SPL\nLIN XP1";

#[test]
fn segments_are_followed_with_the_speed_of_their_block() {
    let program = main_with(DATA, BLOCK);
    let speeds: Vec<Option<f64>> = (program.motions.iter())
        .map(|motion| motion.speed.mm_per_s)
        .collect();
    let wanted = [500.0, 200.0, 50.0, 200.0, 500.0].map(Some);
    assert_eq!(speeds, wanted);
    let follows: Vec<Option<usize>> = program.motions.iter().map(|m| m.follows).collect();
    assert_eq!(follows, [None, Some(0), Some(1), Some(2), Some(3)]);
    assert!(matches!(
        program.motions[3].kind,
        MotionKind::Circular { .. }
    ));
    // Through P2, half a circle about (100, 50).
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let middle = robot.path.moves[3].point(0.5);
    let from = program.motions[2].target.pose().unwrap().position_mm;
    assert_eq!(from.z, 3.0);
    assert!(
        (middle - Vector3::new(150.0, 50.0, 4.5)).norm() < 1.0,
        "{middle}"
    );
    assert_eq!(robot.path.moves[4].line, 9);
}

#[test]
fn pieces_of_a_segment_are_segments() {
    let program = main_with(DATA, BLOCK);
    let pieces = [
        Piece::to(1, Vector3::new(50.0, 0.0, 5.1)),
        Piece::to(1, Vector3::new(100.0, 0.0, 5.2)),
    ];
    let text = written(&program, &pieces);
    assert!(
        text.contains("  SLIN {X 50.000,Y 0,Z 5.100,A 0,B 0,C 180}\n  SLIN XP1_2\n"),
        "{text}"
    );
    // No assignment stands in a block.
    let block = text.split("SPLINE").nth(1).unwrap();
    assert!(!block.contains("\n$VEL"), "{text}");
}

const STEPS: &str = "$VEL.CP=0.02\nLIN {X 10,Y 20,Z 5,A 15,B 3,C 170}\nLIN_REL {X 30,Z -2} C_DIS ; along\nLIN_REL {Y 20} #BASE\nSLIN_REL {X 0,Y 0,Z 40,A 0,B 0,C 0}";

#[test]
fn steps_go_along_the_axes_of_the_base() {
    let program = main_with("", STEPS);
    let places: Vec<[f64; 3]> = (program.motions.iter())
        .map(|motion| motion.target.pose().unwrap().position_mm.into())
        .collect();
    let wanted = [
        [10.0, 20.0, 5.0],
        [40.0, 20.0, 3.0],
        [40.0, 40.0, 3.0],
        [40.0, 40.0, 43.0],
    ];
    assert_eq!(places, wanted);
    let turns: Vec<_> = (program.motions.iter())
        .map(|motion| motion.target.pose().unwrap().orientation)
        .collect();
    assert!(turns.iter().all(|turn| *turn == turns[0]));
    // Whose axes they are may stand behind the words of rounding [KSS, LIN_REL].
    let behind = main_with("", &STEPS.replace("C_DIS ; along", "C_DIS #BASE ; along"));
    let end = behind.motions[1].target.pose().unwrap().position_mm;
    assert_eq!(end, Vector3::new(40.0, 20.0, 3.0));
    let text = written(&behind, &[Piece::to(1, Vector3::new(40.0, 20.0, 3.125))]);
    let stated = "LIN {X 40,Y 20,Z 3.125,A 15,B 3,C 170} C_DIS ; along\n";
    assert!(text.contains(stated), "{text}");
    // A corrected step is stated, and what goes on from it, too; the one behind that stays.
    let piece = Piece::to(1, Vector3::new(40.0, 20.0, 3.125));
    let text = written(&program, &[piece]);
    assert!(
        text.contains(
            "LIN {X 40,Y 20,Z 3.125,A 15,B 3,C 170} C_DIS ; along\n\
             LIN {X 40,Y 40,Z 3,A 15,B 3,C 170}\nSLIN_REL {X 0,Y 0,Z 40,A 0,B 0,C 0}\n"
        ),
        "{text}"
    );
}

#[test]
fn programs_with_segments_and_steps_are_corrected_along_their_paths() {
    let of = |statements: &str| format!("DEF part()\n{statements}\nEND\n");
    let block = BLOCK
        .replace("XP1", "{X 100,Y 0,Z 5,A 0,B 0,C 180}")
        .replace("XP2", "{X 150,Y 50,Z 5,A 0,B 0,C 180}")
        .replace("XP3", "{X 100,Y 100,Z 5,A 0,B 0,C 180}");
    for (text, motions) in [(of(&block), 5), (of(STEPS), 4)] {
        let bytes = text.as_bytes();
        let found = corrected(Language::Krl, "part.src", bytes, &ReadOptions::default());
        assert_eq!(found, Ok(motions));
    }
}

/// `#TOOL`: along the axes of the tool as it stands; joints by their angles. [KSS, LIN_REL and PTP_REL]
#[test]
fn steps_go_along_the_axes_of_the_tool_and_of_joints() {
    // A turn of 90 degrees about z: x of the tool is y of the base, y of the tool is -x.
    let program = main_with(
        "",
        "LIN {X 10,Y 20,Z 5,A 90,B 0,C 0}\nLIN_REL {X 3,Y 1} #TOOL\nPTP_REL {Z 7}\nSPTP_REL {Y 2} C_SPL #TOOL\nLIN_REL {X 1}",
    );
    let places = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().unwrap().position_mm);
    let wanted = [
        [10.0, 20.0, 5.0],
        [9.0, 23.0, 5.0],
        [9.0, 23.0, 12.0],
        [7.0, 23.0, 12.0],
        [8.0, 23.0, 12.0],
    ];
    for (place, wanted) in places.zip(wanted) {
        assert!(
            (place - Vector3::from(wanted)).norm() < 1e-9,
            "{place} {wanted:?}"
        );
    }
    assert_eq!(program.motions[2].kind, MotionKind::Joint);
    // Behind a corrected end they state where they went.
    let text = written(&program, &[Piece::to(1, Vector3::new(9.0, 23.0, 5.25))]);
    assert!(
        text.contains(
            "LIN {X 9,Y 23,Z 5.250,A 90,B 0,C 0}\nPTP {X 9,Y 23,Z 12,A 90,B 0,C 0}\nSPTP_REL"
        ),
        "{text}"
    );
    let program = main_with(
        "",
        "PTP {A1 1,A2 -90,A3 90,A4 0,A5 45,A6 0}\nPTP_REL {A1 10,A6 -5}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nPTP_REL {A1 3}",
    );
    let Target::Joints { values_deg } = &program.motions[1].target else {
        panic!("{:?}", program.motions[1]);
    };
    assert_eq!(values_deg, &[11.0, -90.0, 90.0, 0.0, 45.0, -5.0]);
    // Which angles the joints have at a pose the text does not say: the end is left, and nothing goes on from it.
    assert!(matches!(program.motions[3].target, Target::Unknown { .. }));
}
