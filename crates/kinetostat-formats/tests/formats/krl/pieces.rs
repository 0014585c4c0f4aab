//! Motions that become several, circles, and speeds.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{main_with, written};

const DATA: &str = "DECL POS XP1={X 100,Y 0,Z 5,A 0,B 0,C 180,S 2,T 35}\nDECL POS XP2={X 50,Y 50,Z 5,A 0,B 0,C 180,S 2,T 35}";

fn at(motion: usize, place: [f64; 3]) -> Piece {
    Piece::to(motion, Vector3::from(place))
}

#[test]
fn pieces_stand_before_the_end_with_all_else_as_written() {
    let program = main_with(DATA, "\tLIN XP1 ; groove\n\tSLIN XP2 C_DIS");
    let pieces = [
        at(0, [33.0, 0.0, 5.01]),
        at(0, [100.0, 0.0, 5.03]),
        at(1, [75.0, 25.0, 5.0]),
        at(1, [50.0, 50.0, 5.0]),
    ];
    let text = written(&program, &pieces);
    let expected = "\tLIN {X 33.000,Y 0,Z 5.010,A 0,B 0,C 180,S 2,T 35} C_DIS\n\tLIN XP1 ; groove\n\
        \tSLIN {X 75.000,Y 25.000,Z 5,A 0,B 0,C 180,S 2,T 35} C_DIS\n\tSLIN XP2 C_DIS\n";
    assert!(text.contains(expected), "{text}");
    assert!(text.contains("XP1={X 100,Y 0,Z 5.030,"));
}

#[test]
fn circles_stay_circles_with_a_via_and_become_chords_with_pieces() {
    let program = main_with(DATA, "LIN {X 0,Y 0,Z 5,A 0,B 0,C 180}\nCIRC XP2, XP1 C_DIS");
    let mut piece = at(1, [100.0, 0.1, 5.0]);
    let text = written(&program, &[piece.clone()]);
    assert!(text.contains("LIN XP1 C_DIS"), "{text}");
    piece.via_mm = Some(Vector3::new(50.0, 50.2, 5.0));
    let text = written(&program, &[piece]);
    assert!(text.contains("CIRC XP2, XP1 C_DIS") && text.contains("XP2={X 50,Y 50.200,Z 5,"));
    let text = written(
        &program,
        &[at(1, [50.0, 50.0, 5.0]), at(1, [100.0, 0.0, 5.0])],
    );
    assert!(
        text.contains("LIN {X 50.000,Y 50.000,Z 5,A 0,B 0,C 180,S 2,T 35} C_DIS\nLIN XP1 C_DIS\n"),
        "{text}"
    );
}

#[test]
fn joint_motions_are_not_divided() {
    let program = main_with(DATA, "PTP XP1");
    let error = write(
        &program,
        &[at(0, [1.0; 3]), at(0, [2.0; 3])],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("a joint motion cannot be divided")
    );
}

/// What acts at the end of the next motion, or so far along it, would act at the end of its first piece.
#[test]
fn motions_behind_a_trigger_are_not_divided() {
    let two = [at(0, [1.0; 3]), at(0, [100.0, 0.0, 5.0])];
    for (before, refused) in [
        (
            "TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[3]=TRUE",
            Some("the TRIGGER"),
        ),
        (
            "TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[3]=TRUE",
            Some("the TRIGGER"),
        ),
        ("STOP WHEN PATH=-10 IF $IN[1]==FALSE", Some("the STOP WHEN")),
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[3]=TRUE", None),
        ("TRIGGER WHEN PATH=20 ONSTART DELAY=0 DO $OUT[3]=TRUE", None),
        ("$OUT[3]=TRUE", None),
    ] {
        let program = main_with(DATA, &format!("{before}\nLIN XP1\nLIN XP2"));
        let written = write(&program, &two, &WriteOptions::default());
        match refused {
            Some(why) => {
                let said = written.unwrap_err().to_string();
                assert!(said.contains(why), "{before}: {said}");
            }
            None => assert!(written.is_ok(), "{before}: {written:?}"),
        }
        // The motion behind it is free, and an end that is moved alone keeps the motion one.
        let next = [at(1, [2.0; 3]), at(1, [3.0; 3])];
        assert!(
            write(&program, &next, &WriteOptions::default()).is_ok(),
            "{before}"
        );
        assert!(
            write(&program, &two[1..], &WriteOptions::default()).is_ok(),
            "{before}"
        );
    }
}

#[test]
fn a_changed_speed_is_stated_and_the_one_before_restored() {
    let program = main_with(DATA, "$VEL.CP=0.02\n  LIN XP1 C_DIS ; groove\n  LIN XP2");
    let mut piece = at(0, [100.0, 0.0, 5.0]);
    piece.speed_factor = 0.5;
    let text = written(&program, &[piece.clone()]);
    let expected =
        "$VEL.CP=0.02\n  $VEL.CP=0.01\n  LIN XP1 C_DIS ; groove\n  $VEL.CP=0.02\n  LIN XP2\n";
    assert!(text.contains(expected), "{text}");
    // Each of several pieces states its own.
    let text = written(&program, &[at(0, [50.0, 0.0, 5.0]), piece]);
    let expected = "$VEL.CP=0.02\n  $VEL.CP=0.02\n  LIN {X 50.000,Y 0,Z 5,A 0,B 0,C 180,S 2,T 35} C_DIS\n  \
        $VEL.CP=0.01\n  LIN XP1 C_DIS ; groove\n  $VEL.CP=0.02\n  LIN XP2\n";
    assert!(text.contains(expected), "{text}");
    let again = read_krl(
        vec![
            SourceFile::new("part.src", text.split("DEFDAT").next().unwrap()),
            SourceFile::new("part.dat", format!("DEFDAT part\n{DATA}\nENDDAT")),
        ],
        &ReadOptions::default(),
    );
    let speeds: Vec<Option<f64>> = again
        .unwrap()
        .motions
        .iter()
        .map(|motion| motion.speed.mm_per_s)
        .collect();
    assert_eq!(speeds, [Some(20.0), Some(10.0), Some(20.0)]);
    // What is not known cannot be changed.
    let program = main_with(DATA, "LIN XP1");
    let mut piece = at(0, [100.0, 0.0, 5.0]);
    piece.speed_factor = 0.5;
    let error = write(&program, &[piece], &WriteOptions::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("its speed cannot be changed"));
}

/// All motions that do not take their pieces are named at once.
#[test]
fn all_lines_that_are_not_divided_are_named() {
    let program = main_with(
        DATA,
        "LIN XP1\nPTP XP2\nPTP XP1\nLIN XP2\nPTP XP1\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\nLIN XP2",
    );
    let pieces: Vec<Piece> = (0..program.motions.len())
        .flat_map(|motion| [at(motion, [60.0, 40.0, 5.0]), at(motion, [50.0, 50.0, 5.0])])
        .collect();
    let error = write(&program, &pieces, &WriteOptions::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "part.src, line 3: a joint motion cannot be divided: the tool does not go straight; so on lines 4, 6; line 8: the TRIGGER before it acts along the whole of it; give it one piece, at its end"
    );
}

/// What brakes the robot on its path is carried; what leaves a motion before its end is refused.
#[test]
fn brake_holds_on_the_path_and_resume_leaves_it() {
    let program = main_with(DATA, "LIN XP1\nBRAKE\nBRAKE F\nHALT\nLIN XP2");
    assert_eq!(program.motions[1].follows, Some(0));
    let text = "DEF part()\nRESUME\nEND\n";
    let errors = read_krl(
        vec![SourceFile::new("part.src", text)],
        &ReadOptions::default(),
    );
    let rapid = "MODULE M\nPROC main()\nStopMove;\nStartMove;\nClearPath;\nStepBwdPath 30,1;\nENDPROC\nENDMODULE\n";
    let others = read_rapid(
        vec![SourceFile::new("m.mod", rapid)],
        &ReadOptions::default(),
    );
    let (errors, others) = (errors.unwrap_err(), others.unwrap_err());
    assert_eq!((errors.len(), others.len()), (1, 2));
    assert_eq!((errors[0].line, others[0].line), (2, 5));
    assert_eq!(errors[0].reason, others[0].reason);
    assert!(others[1].reason.contains("goes back along the way"));
}
