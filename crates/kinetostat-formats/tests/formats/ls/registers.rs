//! Registers, frames and tools to which the program gives values, and offsets by them.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{read_with, with_lines, written};

/// All six numbers of a register.
fn filled(register: u32, numbers: [f64; 6]) -> Vec<String> {
    let of = |(at, number): (usize, &f64)| format!("  PR[{register},{}]={number} ;", at + 1);
    numbers.iter().enumerate().map(of).collect()
}

fn program_of(lines: &[Vec<String>]) -> Result<RobotProgram, Vec<ProgramError>> {
    let lines: Vec<&str> = lines.iter().flatten().map(String::as_str).collect();
    read_with(with_lines(&lines).as_bytes(), &ReadOptions::default())
}

fn text(lines: &[&str]) -> Vec<String> {
    lines.iter().map(|line| (*line).to_owned()).collect()
}

fn tool_z(program: &RobotProgram) -> Vec<Option<f64>> {
    let motions = program.motions.iter();
    motions
        .map(|motion| motion.tool.known().map(|tool| tool.translation.z))
        .collect()
}

#[test]
fn tools_and_frames_get_the_values_of_registers() {
    let program = program_of(&[
        filled(9, [100.0, 0.0, 500.0, 0.0, 0.0, 90.0]),
        text(&["  UFRAME[2]=PR[9] ;"]),
        filled(9, [0.0, 0.0, 250.0, 0.0, 0.0, 0.0]),
        text(&["  UTOOL[1]=PR[9] ;", "L P[1] 20mm/sec FINE ;"]),
        text(&["  CALL SPINDLE_ON ;", "L P[2] 20mm/sec FINE ;"]),
    ])
    .unwrap();
    assert_eq!(tool_z(&program), [Some(250.0), Some(250.0)]);
    let base = program.motions[1].base_pose().unwrap().translation.vector;
    // P[2] is at 200, 0, 5 of a frame that is turned by a quarter about z.
    assert!(
        (base - Vector3::new(100.0, 200.0, 505.0)).norm() < 1e-9,
        "{base}"
    );
    assert_eq!(program.motions[1].follows, Some(0));
    // The pose of a position, and that of the world.
    for (from, z) in [("P[1]", 5.0), ("UFRAME[0]", 0.0)] {
        let lines = [
            format!("  PR[3:tool]={from} ;"),
            "  PR[4]=PR[3] ;".to_owned(),
            "  UTOOL[1]=PR[4] ;".to_owned(),
            "L P[2] 20mm/sec FINE ;".to_owned(),
        ];
        assert_eq!(tool_z(&program_of(&[lines.to_vec()]).unwrap()), [Some(z)]);
    }
    // What the caller states counts.
    let mut options = ReadOptions::default();
    let stated = nalgebra::Isometry3::translation(0.0, 0.0, 7.0);
    options.frames.insert("UT:1".to_owned(), stated);
    let lines = with_lines(&["  UTOOL[1]=PR[9] ;", "L P[1] 20mm/sec FINE ;"]);
    let program = read_with(lines.as_bytes(), &options).unwrap();
    assert_eq!(tool_z(&program), [Some(7.0)]);
}

#[test]
fn values_that_are_not_known_are_refused_where_they_are_given() {
    let zeros = [0.0; 6];
    let refused = |between: &[&str]| {
        let lines = [
            filled(9, zeros),
            text(between),
            text(&["  UTOOL[1]=PR[9] ;", "L P[1] 20mm/sec FINE ;"]),
        ];
        match program_of(&lines) {
            Ok(_) => None,
            Err(errors) => Some((errors.len(), errors[0].line, errors[0].reason.clone())),
        }
    };
    assert_eq!(refused(&[]), None);
    assert_eq!(refused(&["  PR[8,3]=R[1] ;", "  R[2]=PR[9,3] ;"]), None);
    for between in [
        "  PR[9,3]=R[1] ;",
        "  PR[9]=LPOS ;",
        "  PR[R[1]]=LPOS ;",
        "  PR[R[1],3]=5 ;",
        "  IF R[1]=1,PR[9,3]=5 ;",
        "  CALL COMPUTES_IT ;",
        "  CALL SR[1] ;",
        "  RUN OTHER ;",
    ] {
        let found = refused(&[between]);
        let (count, line, reason) = found.unwrap_or_else(|| panic!("{between}"));
        assert_eq!((count, line), (1, 12), "{between}: {reason}");
        assert!(
            reason.contains("says which frame a number means"),
            "{reason}"
        );
    }
    // One value on one way, and another on the other.
    let lines = [
        filled(9, zeros),
        text(&[
            "  UTOOL[1]=PR[9] ;",
            "  PR[9,3]=5 ;",
            "  IF R[1]=1,UTOOL[1]=PR[9] ;",
        ]),
        text(&["L P[1] 20mm/sec FINE ;"]),
    ];
    let errors = program_of(&lines).unwrap_err();
    assert_eq!((errors.len(), errors[0].line), (1, 13), "{errors:?}");
    assert!(errors[0].reason.contains("which way the program goes"));
    // So is one before the first value, where the controller's counts.
    let lines = [
        text(&["L P[1] 20mm/sec FINE ;"]),
        filled(9, zeros),
        text(&["  UTOOL[1]=PR[9] ;", "L P[2] 20mm/sec FINE ;"]),
    ];
    let errors = program_of(&lines).unwrap_err();
    assert_eq!((errors.len(), errors[0].line), (1, 5), "{errors:?}");
}

#[test]
fn motions_are_offset_by_registers_that_are_known() {
    let by = [10.0, 20.0, -30.0, 0.0, 0.0, 0.0];
    let ends = |program: &RobotProgram| -> Vec<Vector3<f64>> {
        let motions = program.motions.iter();
        let poses = motions.map(|motion| motion.target.pose().unwrap().position_mm);
        poses.collect()
    };
    let program = program_of(&[
        filled(2, by),
        text(&[
            "L P[1] 20mm/sec FINE Offset,PR[2:up] ;",
            "  OFFSET CONDITION PR[2] ;",
        ]),
        text(&[
            "L P[2] 20mm/sec FINE Offset ;",
            "L P[2] 20mm/sec FINE Tool_Offset,PR[2] ;",
        ]),
        text(&["L P[2] 20mm/sec FINE ;"]),
    ])
    .unwrap();
    let found = ends(&program);
    let at = |number: f64| Vector3::new(100.0 * number, 0.0, 5.0);
    let shift = Vector3::new(10.0, 20.0, -30.0);
    // W = 180 turns y and z of the tool over, R = 30 turns it about z of the frame.
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let of_tool = Vector3::new(10.0 * cos + 20.0 * sin, 10.0 * sin - 20.0 * cos, 30.0);
    let expected = [at(1.0) + shift, at(2.0) + shift, at(2.0) + of_tool, at(2.0)];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).norm() < 1e-9, "{found} {expected}");
    }
    let taken = program.findings.iter();
    let taken = taken.filter(|note| note.message.starts_with("PR[2] is taken to hold X"));
    assert_eq!(taken.count(), 1);
    // What is written is shifted again where it is read.
    for motion in 0..4 {
        let lift = Vector3::new(0.0, 0.0, 0.5);
        let output = written(&program, &[Piece::to(motion, found[motion] + lift)]);
        let again = read_with(output.as_bytes(), &ReadOptions::default()).unwrap();
        for (index, (now, before)) in ends(&again).iter().zip(&found).enumerate() {
            let wanted = before
                + if index == motion {
                    lift
                } else {
                    Vector3::zeros()
                };
            assert!((now - wanted).norm() < 1e-3, "{motion} {index}: {output}");
        }
    }
}

#[test]
fn offsets_that_are_not_known_are_refused() {
    let straight = [0.0, 0.0, 10.0, 0.0, 0.0, 0.0];
    for (numbers, lines) in [
        (
            [0.0, 0.0, 10.0, 0.0, 0.0, 5.0],
            &["L P[1] 20mm/sec FINE Offset,PR[2] ;"][..],
        ),
        (straight, &["L P[1] 20mm/sec FINE Offset,PR[3] ;"]),
        (straight, &["L P[1] 20mm/sec FINE Offset,PR[R[1]] ;"]),
        (straight, &["L P[1] 20mm/sec FINE Offset ;"]),
        (straight, &["L P[1] 20mm/sec FINE VOFFSET,VR[2] ;"]),
        (straight, &["C P[1] P[3] 20mm/sec FINE Offset,PR[2] ;"]),
        (
            straight,
            &[
                "  OFFSET CONDITION PR[2],UFRAME[3] ;",
                "L P[1] 20mm/sec FINE Offset ;",
            ],
        ),
        (
            straight,
            &[
                "  OFFSET CONDITION PR[2] ;",
                "  PR[2,3]=11 ;",
                "L P[1] 20mm/sec FINE Offset ;",
            ],
        ),
    ] {
        let errors = program_of(&[filled(2, numbers), text(lines)]).expect_err(lines[0]);
        assert_eq!(errors[0].line, 10 + lines.len(), "{errors:?}");
        assert!(
            errors[0].reason.contains("offset by a register"),
            "{errors:?}"
        );
    }
}

/// Some printers end a program with `/END.`.
#[test]
fn a_program_may_end_with_a_point() {
    let lines = with_lines(&["L P[1] 20mm/sec FINE ;"]);
    let program = read_with(
        lines.replace("/END", "/END.").as_bytes(),
        &ReadOptions::default(),
    );
    assert_eq!(program.unwrap().motions.len(), 1);
}
