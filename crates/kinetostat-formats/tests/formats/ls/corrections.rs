//! Corrected positions, further positions and further lines.

use kinetostat_formats::*;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::{position, read_with, with_lines, written};

fn program(lines: &[&str]) -> RobotProgram {
    read_with(with_lines(lines).as_bytes(), &ReadOptions::default()).unwrap()
}

fn lifted(program: &RobotProgram, motion: usize, by: f64) -> Piece {
    let end = program.motions[motion].target.pose().unwrap().position_mm;
    Piece::to(motion, end + Vector3::new(0.0, 0.0, by))
}

#[test]
fn columns_stay_and_only_the_numbers_change() {
    let lines = ["L P[1] 20mm/sec FINE ;", "L P[2] 20mm/sec FINE ;"];
    let program = program(&lines);
    let output = written(&program, &[lifted(&program, 1, -5.5)]);
    let expected = with_lines(&lines).replacen(
        "X =   200.000  mm,\tY =     0.000  mm,\tZ =     5.000  mm",
        "X =   200.000  mm,\tY =     0.000  mm,\tZ =    -0.500  mm",
        1,
    );
    assert_eq!(output, expected);
}

#[test]
fn one_position_of_several_motions_is_edited_once_or_gets_a_number() {
    let lines = [
        "L P[1] 20mm/sec FINE ;",
        "L P[2] 20mm/sec FINE ;",
        "L P[1:again] 50mm/sec FINE ;",
    ];
    let program = program(&lines);
    let same = [lifted(&program, 0, 0.25), lifted(&program, 2, 0.25)];
    let output = written(&program, &same);
    assert_eq!(output.matches("Z =     5.250").count(), 1);
    assert!(!output.contains("P[5]"));

    let differ = [lifted(&program, 0, 0.25), lifted(&program, 2, 0.5)];
    let output = written(&program, &differ);
    assert!(output.contains("   3:L P[5:again] 50mm/sec FINE ;"));
    let fifth = position(5, [100.0, 0.0, 5.5]);
    assert!(output.ends_with(&format!("{fifth}/END\n")), "{output}");
    // Without a piece the other use keeps the old value.
    let output = written(&program, &differ[1..]);
    assert!(output.contains(&position(1, [100.0, 0.0, 5.0])));
    assert!(output.contains("   3:L P[5:again] 50mm/sec FINE ;"));
}

/// `/END` begins a section only at the beginning of its line.
#[test]
fn a_copy_of_a_position_that_does_not_begin_its_line_leaves_the_end_where_it_was() {
    let lines = [
        "L P[1] 20mm/sec FINE ;",
        "L P[2] 20mm/sec FINE ;",
        "L P[1] 50mm/sec FINE ;",
    ];
    let text = with_lines(&lines).replace("P[1]{", "   P[1]{");
    assert_eq!(text.matches("   P[1]{").count(), 1);
    let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
    let pieces = [lifted(&program, 0, 0.25), lifted(&program, 2, 0.5)];
    let output = written(&program, &pieces);
    let fifth = position(5, [100.0, 0.0, 5.5]);
    assert!(output.ends_with(&format!("{fifth}/END\n")), "{output}");
}

#[test]
fn a_position_that_is_read_elsewhere_keeps_its_value() {
    let lines = ["L P[1] 20mm/sec FINE ;", "  PR[3]=P[1]    ;"];
    let program = program(&lines);
    let output = written(&program, &[lifted(&program, 0, 0.25)]);
    assert!(output.contains("   1:L P[5] 20mm/sec FINE ;"));
    assert!(output.contains(&position(1, [100.0, 0.0, 5.0])));
}

#[test]
fn pieces_are_lines_and_positions_and_all_lines_are_numbered_again() {
    let mut lines = vec!["L P[1] 20mm/sec FINE ;", "L P[2] 20mm/sec FINE PTH    ;"];
    lines.extend(["  ! nothing ;"; 7]);
    let program = program(&lines);
    let pieces: Vec<Piece> = [120.0, 150.0, 200.0]
        .map(|x| Piece::to(1, Vector3::new(x, 0.0, 5.0)))
        .to_vec();
    let output = written(&program, &pieces);
    assert!(output.contains("LINE_COUNT\t= 11;"));
    assert!(output.contains(
        "   2:L P[5] 20mm/sec CNT100 PTH    ;\n   3:L P[6] 20mm/sec CNT100 PTH    ;\n   4:L P[2] 20mm/sec FINE PTH    ;\n   5:  ! nothing ;\n"
    ));
    assert!(output.contains("\n  10:  ! nothing ;\n  11:  ! nothing ;\n/POS\n"));
    let end = format!(
        "{}{}/END\n",
        position(5, [120.0, 0.0, 5.0]),
        position(6, [150.0, 0.0, 5.0])
    );
    assert!(output.ends_with(&end), "{output}");
    assert!(
        read_with(output.as_bytes(), &ReadOptions::default())
            .unwrap()
            .findings
            .len()
            <= 2
    );
}

#[test]
fn a_divided_circle_becomes_straight() {
    let lines = [
        "L P[1] 20mm/sec FINE ;",
        "C P[2]    \n    :  P[3] 20mm/sec CNT50    ;",
    ];
    let program = program(&lines);
    let pieces: Vec<Piece> = [(200.0, 20.0), (300.0, 0.0)]
        .map(|(x, y)| Piece::to(1, Vector3::new(x, y, 5.0)))
        .to_vec();
    let output = written(&program, &pieces);
    assert!(
        output.contains("   2:L P[5] 20mm/sec CNT50    ;\n   3:L P[3] 20mm/sec CNT50    ;\n"),
        "{output}"
    );
    // As a circle it keeps its two positions.
    let mut one = Piece::to(1, Vector3::new(300.0, 1.0, 5.0));
    one.via_mm = Some(Vector3::new(200.0, 2.0, 5.0));
    let output = written(&program, &[one]);
    assert!(output.contains("C P[2]    \n    :  P[3]"));
    assert!(
        output.contains(&position(2, [200.0, 2.0, 5.0]))
            && output.contains(&position(3, [300.0, 1.0, 5.0]))
    );
}

#[test]
fn angles_are_w_p_r_about_fixed_axes_and_stay_within_half_a_turn() {
    let program = program(&["L P[1] 20mm/sec FINE ;"]);
    let pose = program.motions[0].target.pose().unwrap().clone();
    let rx = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let rz = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 30.0_f64.to_radians());
    assert!(pose.orientation.angle_to(&(rz * rx)) < 1e-12);
    // One degree more about the fixed Z is one more of R; W goes over 180 degrees to the other side.
    let more = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1.0_f64.to_radians());
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5_f64.to_radians());
    let mut piece = Piece::to(0, pose.position_mm);
    piece.orientation = Some(more * rz * tilt * rx);
    let output = written(&program, &[piece]);
    assert!(output.contains("W = -179.50000 deg"), "{output}");
    assert!(output.contains("R =  31.00000 deg"), "{output}");
}

#[test]
fn speeds_are_written_in_mm_per_second() {
    let program = program(&["L P[1] 60cm/min FINE ;", "L P[2] R[1]mm/sec FINE ;"]);
    let mut piece = lifted(&program, 0, 0.0);
    piece.speed_factor = 1.5;
    assert!(written(&program, &[piece]).contains("L P[1] 15mm/sec FINE ;"));
    let mut piece = lifted(&program, 1, 0.0);
    piece.speed_factor = 1.5;
    let error = write(&program, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 6: its speed cannot be changed"),
        "{error}"
    );
}

#[test]
fn what_has_an_event_or_a_time_is_not_divided() {
    let program = program(&[
        "L P[1] 20mm/sec FINE TA .10sec,CALL GUN ;",
        "L P[2] 2.0sec FINE ;",
        "J P[3] 50% FINE ;",
    ]);
    for (motion, reason) in [
        (0, "would start at each piece"),
        (1, "its speed is a time"),
        (2, "a joint motion"),
    ] {
        let pieces = [lifted(&program, motion, 0.1), lifted(&program, motion, 0.0)];
        let error = write(&program, &pieces, &WriteOptions::default()).unwrap_err();
        assert!(error.to_string().contains(reason), "{error}");
    }
}

#[test]
fn frames_are_those_of_the_options_by_number() {
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("uf:2".into(), Isometry3::translation(1000.0, 0.0, 500.0));
    options
        .frames
        .insert("UT:1".into(), Isometry3::translation(0.0, 0.0, 180.0));
    let text = with_lines(&["L P[1] 20mm/sec FINE ;"]);
    let program = read_with(text.as_bytes(), &options).unwrap();
    assert!(program.findings.is_empty());
    let base = program.motions[0].base_pose().unwrap().translation.vector;
    assert_eq!(base.as_slice(), [1100.0, 0.0, 505.0]);
    assert_eq!(
        program.motions[0].tool.known().unwrap().translation.z,
        180.0
    );
}

#[test]
fn what_is_left_as_written_keeps_its_positions() {
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let text = with_lines(&[
        "L P[1] 20mm/sec FINE Offset,PR[2:up] ;",
        "L P[1] 20mm/sec FINE ;",
        "J PR[1:HOME] 100% CNT50 ;",
        "L P[2] 20mm/sec FINE Skip,LBL[1] ;",
        "L P[3] 20mm/sec FINE INC ;",
        "  LBL[1] ;",
    ]);
    let program = read_with(text.as_bytes(), &options).unwrap();
    let known: Vec<bool> = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().is_some())
        .collect();
    assert_eq!(known, [false, true, false, false, false]);
    let output = written(&program, &[lifted(&program, 1, 0.5)]);
    assert!(
        output.contains("   1:L P[1] 20mm/sec FINE Offset,PR[2:up] ;\n   2:L P[5] 20mm/sec FINE ;")
    );
    let error = write(
        &program,
        &[Piece::to(0, Vector3::zeros())],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("no pose that could be corrected")
    );
}

#[test]
fn called_programs_run_where_they_are_called() {
    let main = with_lines(&[
        "L P[1] 20mm/sec FINE ;",
        "  CALL SUB ;",
        "L P[2] 20mm/sec FINE ;",
        "  CALL SUB ;",
    ]);
    let sub = with_lines(&["L P[1] 20mm/sec FINE ;", "L P[2] 20mm/sec FINE ;"])
        .replace("PROG  PART", "PROG  sub");
    let alone = with_lines(&["L P[3] 20mm/sec FINE ;"]).replace("PROG  PART", "PROG  ALONE");
    let files = vec![
        SourceFile::new("main.ls", main),
        SourceFile::new("sub.ls", sub),
        SourceFile::new("alone.ls", alone),
    ];
    let program = read_ls(files, &ReadOptions::default()).unwrap();
    let order: Vec<(usize, Runs, Option<usize>)> = program
        .motions
        .iter()
        .map(|motion| (motion.file, motion.runs, motion.follows))
        .collect();
    assert_eq!(
        order,
        [
            (0, Runs::Once, None),
            (1, Runs::Repeatedly, Some(0)),
            (1, Runs::Repeatedly, Some(1)),
            (0, Runs::Once, Some(2)),
            (1, Runs::Repeatedly, Some(3)),
            (1, Runs::Repeatedly, Some(4)),
            (2, Runs::Elsewhere, None),
        ]
    );
}
