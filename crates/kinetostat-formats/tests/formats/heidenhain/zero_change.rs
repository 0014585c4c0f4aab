//! Programs are read, and without pieces every byte comes back.

use std::f64::consts::{PI, TAU};

use kinetostat_formats::*;
use nalgebra::{Isometry3, Rotation3, Vector3};

use super::{EVERYTHING, place, program, read_with};

#[test]
fn every_byte_comes_back_with_any_line_ending() {
    for bytes in [
        EVERYTHING.as_bytes().to_vec(),
        EVERYTHING.replace('\n', "\r\n").into_bytes(),
        EVERYTHING.trim_end().as_bytes().to_vec(),
        [b"\xef\xbb\xbf", EVERYTHING.as_bytes()].concat(),
        [b"; \xff before\n", EVERYTHING.as_bytes(), b"\n; \xfe\n\n"].concat(),
    ] {
        let program = read_with(&bytes, &ReadOptions::default()).unwrap();
        let files = write(&program, &[], &WriteOptions::default()).unwrap();
        assert_eq!(files, [("part.h".to_owned(), bytes.clone())]);
        // Nothing is repeated or computed: it is flat.
        let file = SourceFile::new("part.h", bytes.clone());
        let flat = expand_heidenhain(vec![file], &ReadOptions::default()).unwrap();
        assert!(!flat.changed && flat.file.bytes() == bytes);
    }
}

#[test]
fn places_are_those_of_the_blocks() {
    let program = program(EVERYTHING);
    let known: Vec<(usize, [f64; 3])> = (0..program.motions.len())
        .filter(|index| program.motions[*index].target.pose().is_some())
        .map(|index| (program.motions[index].line, place(&program, index)))
        .collect();
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    let half = 12.5 * 0.5_f64.sqrt();
    let expected = [
        (14, [10.0, 20.0, 2.0]),
        (15, [10.0, 20.0, -2.0]),
        (16, [40.0, 20.0, -2.0]),
        (17, [40.0, 25.5, -2.0]),
        (19, [50.0, 35.5, -2.0]),
        (20, [60.0, 45.5, -2.0]),
        (21, [70.0, 40.0, -2.0]),
        (23, [70.0, 37.5, -2.0]),
        (24, [70.0 + half, 50.0 - half, -2.0]),
        (25, [70.0 + half, 50.0 - half, -3.5]),
        (30, [105.0, -4.0, 7.0]),
        (31, [110.5, -9.5, 7.0]),
        (34, [100.0 + 20.0 * cos, -10.0 + 20.0 * sin, 7.0]),
        (41, [101.0, -8.0, 7.0]),
        (44, [103.0, -6.0, -1.0]),
        (39, [103.0, -6.0, 50.0]),
    ];
    assert_eq!(known.len(), expected.len(), "{known:?}");
    for ((line, found), (expected_line, expected)) in known.iter().zip(expected) {
        assert_eq!(*line, expected_line);
        let away = (Vector3::from(*found) - Vector3::from(expected)).norm();
        assert!(away < 1e-9, "line {line}: {found:?}");
    }
}

#[test]
fn arcs_end_where_their_blocks_say_and_go_the_way_their_sense_says() {
    let program = program(EVERYTHING);
    let mut angles = Vec::new();
    for motion in &program.motions {
        let MotionKind::Arc {
            centre_mm,
            axis,
            angle_rad,
        } = motion.kind
        else {
            continue;
        };
        let before = &program.motions[motion.follows.unwrap()];
        let start = before.target.pose().unwrap().position_mm;
        let end = motion.target.pose().unwrap().position_mm;
        let turn = Rotation3::new(axis * angle_rad);
        let rise = axis * (end - start).dot(&axis);
        let found = centre_mm + turn * (start - centre_mm) + rise;
        assert!((found - end).norm() < 1e-9, "line {}: {found}", motion.line);
        angles.push((motion.line, angle_rad));
    }
    let lines: Vec<usize> = angles.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [19, 20, 21, 25]);
    // A quarter to the left of the centre below; more than half a turn clockwise; a whole turn.
    assert!((angles[0].1 - PI / 2.0).abs() < 1e-9, "{angles:?}");
    assert!((angles[1].1 + 1.5 * PI).abs() < 1e-9, "{angles:?}");
    assert!((angles[3].1 - TAU).abs() < 1e-9, "{angles:?}");
}

#[test]
fn a_tangential_arc_leaves_in_the_direction_of_the_block_before() {
    let text = "BEGIN PGM A MM\nL X+0 Y+0 Z+0 FMAX\nL X+10 F100\nCT X+20 Y+10\nEND PGM A MM\n";
    let program = program(text);
    let MotionKind::Arc {
        centre_mm,
        angle_rad,
        ..
    } = program.motions[2].kind
    else {
        panic!("an arc");
    };
    assert!((centre_mm - Vector3::new(10.0, 10.0, 0.0)).norm() < 1e-9);
    assert!((angle_rad - PI / 2.0).abs() < 1e-9);
}

#[test]
fn feeds_hold_on_and_rapid_traverse_does_not() {
    let program = program(EVERYTHING);
    let speed = |line: usize| {
        let motion = program
            .motions
            .iter()
            .find(|motion| motion.line == line)
            .unwrap();
        (
            motion.speed.mm_per_s.map(|speed| (speed * 60.0).round()),
            motion.speed.text.clone(),
        )
    };
    assert_eq!(speed(14), (None, "FMAX".to_owned()));
    assert_eq!(speed(15), (Some(250.0), "F250".to_owned()));
    assert_eq!(speed(16), (Some(400.0), "FAUTO".to_owned()));
    assert_eq!(speed(20), (Some(600.0), "F600".to_owned()));
    assert_eq!(speed(31), (Some(500.0), "F500".to_owned()));
}

#[test]
fn axes_that_a_mirror_image_leaves_stay_where_they_are() {
    let mirrored = "BEGIN PGM A MM\nL X+1 Y+2 Z+3 F100\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nL X+10 Y+1\nL Y+5\n\
        CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1\nL X+7\nEND PGM A MM\n";
    let found = program(mirrored);
    let places: Vec<[f64; 3]> = (0..4).map(|at| place(&found, at)).collect();
    assert_eq!(
        places,
        [
            [1.0, 2.0, 3.0],
            [-10.0, 1.0, 3.0],
            [-10.0, 5.0, 3.0],
            [7.0, 5.0, 3.0]
        ]
    );
    for (cycle, block) in [
        ("8.1 X", "L Y+1"),
        ("8.1 Z", "L X+1 Y+1"),
        ("11.1 SCL 2", "L X+1 Y+1"),
    ] {
        let text = format!(
            "BEGIN PGM A MM\nL X+1 Y+2 Z+3 F100\nCYCL DEF {cycle}\n{block}\nL X+1 Y+1 Z+1\nEND PGM A MM\n"
        );
        let faults = super::read_with(text.as_bytes(), &ReadOptions::default()).unwrap_err();
        assert_eq!(faults.len(), 1, "{faults:?}");
        let fault = faults[0].to_string();
        let expected = format!(
            "part.h, line 4: `{block}`: an axis was not stated since the coordinates were mirrored or scaled, and where it stands in them is not known; state X, Y and Z once behind the mirror image or the scaling"
        );
        assert_eq!(fault, expected);
    }
    let added = "BEGIN PGM A MM\nCYCL DEF 10.1 IROT-45\nEND PGM A MM\n";
    let faults = super::read_with(added.as_bytes(), &ReadOptions::default()).unwrap_err();
    assert!(faults[0].reason.contains("IROT") && !faults[0].remedy.contains("--expand"));
}

#[test]
fn mirrored_and_scaled_coordinates_are_followed() {
    let text = "BEGIN PGM A MM\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nL X+10 Y+0 Z+0 FMAX\nCC X+0 Y+0\n\
        C X+0 Y+10 DR+ F100\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1\nCYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5\n\
        L X+10 Y+4 Z+2 FMAX\nEND PGM A MM\n";
    let program = program(text);
    assert_eq!(place(&program, 0), [-10.0, 0.0, 0.0]);
    assert_eq!(place(&program, 1), [0.0, 10.0, 0.0]);
    let MotionKind::Arc { angle_rad, .. } = program.motions[1].kind else {
        panic!("an arc");
    };
    assert!((angle_rad + PI / 2.0).abs() < 1e-9);
    assert_eq!(place(&program, 2), [5.0, 2.0, 1.0]);
}

#[test]
fn inches_are_mm_and_tools_and_presets_have_names() {
    let text = "BEGIN PGM A INCH\nCYCL DEF 247 DATUM SETTING~\n Q339=+3 ; NUMBER\nTOOL CALL 12 Z S100\nL X+1 Y+2 Z+,5 F100\nEND PGM A INCH\n";
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("preset:3".into(), Isometry3::translation(0.0, 0.0, 100.0));
    let program = read_with(text.as_bytes(), &options).unwrap();
    let motion = &program.motions[0];
    assert_eq!(motion.tool.name, "TOOL:12");
    assert_eq!(motion.work_object.name, "PRESET:3");
    let base = motion.base_pose().unwrap().translation.vector;
    assert!(
        (base - Vector3::new(25.4, 50.8, 112.7)).norm() < 1e-9,
        "{base}"
    );
    // 100 tenths of an inch in a minute.
    assert!((motion.speed.mm_per_s.unwrap() * 60.0 - 254.0).abs() < 1e-9);
}

#[test]
fn texts_and_comments_are_never_words_and_what_does_not_run_is_carried() {
    let text = "L X+9 Y+9 Z+9\nBEGIN PGM L MM\n; L X+1 Y+1 Z+1~\n L X+2 Y+2 Z+2\n* - L X+3\nL X+1 Y+2 ;Y+5\nL Z+3 FMAX\n\
        L M2\nLBL 5\nDANCE\nLBL 0\nEND PGM L MM\n";
    let program = {
        let mut options = ReadOptions::default();
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        read_with(text.as_bytes(), &options).unwrap()
    };
    assert_eq!(program.motions.len(), 2);
    assert_eq!(place(&program, 1), [1.0, 2.0, 3.0]);
    assert!(program.findings.iter().any(|finding| finding.line == 9));
}

#[test]
fn files_are_known_by_their_ending_and_their_beginning() {
    assert_eq!(
        language_of("P.H", EVERYTHING.as_bytes()),
        Some(Language::Heidenhain)
    );
    assert_eq!(language_of("p.h", b"#pragma once\n"), None);
}
