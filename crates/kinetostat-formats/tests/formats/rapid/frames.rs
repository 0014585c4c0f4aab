//! Tools and work objects: from the text, from the caller, or not known.

use kinetostat_formats::*;
use nalgebra::{Isometry3, Vector3};

const TARGET: &str = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

fn read_with(
    data: &str,
    statements: &str,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    let text = format!("MODULE A\n{data}\nPROC main()\n{statements}\nENDPROC\nENDMODULE");
    read_rapid(vec![SourceFile::new("a.mod", text)], options)
}

#[test]
fn undeclared_frames_are_unknown_and_said_once() {
    let two =
        format!("MoveL {TARGET},v10,z1,tOwn\\WObj:=wOwn;\nMoveL {TARGET},v10,z1,tOwn\\WObj:=wOwn;");
    let program = read_with("", &two, &ReadOptions::default()).unwrap();
    assert_eq!(program.motions[0].base_pose(), None);
    assert_eq!(program.findings.len(), 2, "{:?}", program.findings);
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("WOWN".into(), Isometry3::translation(0.0, 0.0, 7.0));
    options
        .frames
        .insert("town".into(), Isometry3::translation(0.0, 0.0, 100.0));
    let program = read_with("", &two, &options).unwrap();
    assert_eq!(
        program.motions[1].base_pose().unwrap().translation.vector,
        Vector3::new(1.0, 2.0, 10.0)
    );
    assert_eq!(
        program.motions[1].tool.known().unwrap().translation.z,
        100.0
    );
    assert!(program.findings.is_empty());
}

#[test]
fn frames_of_another_module_and_local_ones_are_seen() {
    let data = "MODULE D\nPERS tooldata tA:=[TRUE,[[0,0,1],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nENDMODULE";
    let main = format!(
        "MODULE M\nLOCAL PERS tooldata tB:=[TRUE,[[0,0,2],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nPROC main()\n\
         MoveL {TARGET},v1,z1,tA;\nMoveL {TARGET},v10,z1,TB;\ninner;\nENDPROC\nPROC inner()\n\
         VAR tooldata tA:=[TRUE,[[0,0,3],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nMoveL {TARGET},v10,z1,tA;\nENDPROC\nENDMODULE"
    );
    let files = vec![
        SourceFile::new("d.sys", data),
        SourceFile::new("m.mod", main),
    ];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    let lengths: Vec<f64> = program
        .motions
        .iter()
        .map(|m| m.tool.known().unwrap().translation.z)
        .collect();
    assert_eq!(lengths, [1.0, 2.0, 3.0]);
}

#[test]
fn frames_that_change_or_move_are_refused_unless_stated() {
    let motion = format!("MoveL {TARGET},v10,z1,tool0\\WObj:=w;");
    let fixed = "PERS wobjdata w:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];";
    let cases = [
        (
            fixed.to_owned(),
            format!("OwnCalibration w;\n{motion}"),
            "`w` is changed while the program runs (line 4)",
        ),
        (
            fixed.replace("TRUE,\"\"", "FALSE,\"track\""),
            motion.clone(),
            "moves with a mechanical unit",
        ),
        (
            fixed.replace("[FALSE,", "[TRUE,"),
            motion.clone(),
            "the robot holds the work object",
        ),
    ];
    for (data, statements, reason) in cases {
        let errors = read_with(&data, &statements, &ReadOptions::default()).unwrap_err();
        assert_eq!(errors.len(), 1);
        assert!(errors[0].to_string().contains(reason), "{}", errors[0]);
        let mut options = ReadOptions::default();
        options.frames.insert("w".into(), Isometry3::identity());
        assert!(read_with(&data, &statements, &options).is_ok());
    }
}

#[test]
fn external_axes_that_move_are_refused_or_carried() {
    let text = "MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[100,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\n\
        MoveL [[1,2,4],[1,0,0,0],[0,0,0,0],[100.0,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\n\
        MoveL [[1,2,5],[1,0,0,0],[0,0,0,0],[200,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;";
    let errors = read_with("", text, &ReadOptions::default()).unwrap_err();
    assert_eq!((errors.len(), errors[0].line), (1, 6));
    assert!(errors[0].reason.contains("eax_a moves from 100 to 200"));
    let mut options = ReadOptions::default();
    options.external_axes = ExternalAxes::Carried;
    let program = read_with("", text, &options).unwrap();
    assert_eq!(
        program.motions[2].target.pose().unwrap().external[0],
        Some(200.0)
    );
}

#[test]
fn unknown_targets_are_left_when_asked() {
    let text = format!("p:=CRobT();\nMoveL p,v10,z1,tool0;\nMoveL {TARGET},v10,z1,tool0;");
    let mut options = ReadOptions::default();
    assert_eq!(
        read_with("VAR robtarget p;", &text, &options)
            .unwrap_err()
            .len(),
        1
    );
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let program = read_with("VAR robtarget p;", &text, &options).unwrap();
    assert!(
        matches!(&program.motions[0].target, Target::Unknown { reason } if reason.contains("is computed"))
    );
    assert_eq!(program.motions[1].follows, Some(0));
    assert_eq!(program.findings.len(), 1);
    let error = write(
        &program,
        &[Piece::to(0, Vector3::zeros())],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert!(error.to_string().contains("no pose"));
}

/// A program displacement moves the frame of the motions behind it; their numbers stay.
#[test]
fn displacements_of_the_program_are_followed() {
    let statements = format!(
        "MoveL {TARGET},v10,z1,tool0;\nPDispSet [[0,0,5],[0.7071068,0,0,0.7071068]];\nMoveL {TARGET},v10,z1,tool0;\nPDispOff;\nMoveL {TARGET},v10,z1,tool0;"
    );
    let program = read_with("", &statements, &ReadOptions::default()).unwrap();
    let place = |index: usize| {
        program.motions[index]
            .base_pose()
            .unwrap()
            .translation
            .vector
    };
    let own = program.motions[0].target.pose().unwrap().position_mm;
    assert_eq!(place(0), own);
    // A quarter turn about z, then 5 mm up.
    assert!(
        (place(1) - Vector3::new(-own.y, own.x, own.z + 5.0)).norm() < 1e-4,
        "{}",
        place(1)
    );
    assert_eq!(place(2), own);
    // A correction is written in the frame of the statement.
    let piece = Piece::to(1, own + Vector3::new(0.0, 0.0, 0.25));
    let files = write(&program, &[piece], &WriteOptions::default()).unwrap();
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert_eq!(
        text.matches(&format!("{:.3}", own.z + 0.25)).count(),
        1,
        "{text}"
    );
    let unknown = format!("PDispSet shift;\nMoveL {TARGET},v10,z1,tool0;");
    let errors = read_with("", &unknown, &ReadOptions::default()).unwrap_err();
    assert!(
        errors[0].to_string().contains("no `shift` is declared"),
        "{}",
        errors[0]
    );
}
