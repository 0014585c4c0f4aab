//! How the tool turns: `CirPathMode` and `SingArea`.

use kinetostat_formats::*;

const START: &str = "MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;";
/// On a half circle the tool turns by 60 degrees.
const TURNED: &str = "MoveC [[5,5,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[10,0,0],[0,0.8660254,0.5,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;";
const EVEN: &str = "MoveC [[5,5,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[10,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;";
const LINE: &str =
    "MoveL [[20,0,0],[0,0.8660254,0.5,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;";

/// Lines and faults of the motions of `main` with a routine `other`.
fn faults(main: &str, other: &str) -> Vec<(usize, String)> {
    let text = format!(
        "MODULE M\nPROC main()\n{main}\nENDPROC\nPROC other()\n{other}\nENDPROC\nENDMODULE\n"
    );
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    match path_of(&program, &PathOptions::default()) {
        Ok(_) => Vec::new(),
        Err(faults) => faults
            .iter()
            .map(|fault| (fault.line, fault.to_string()))
            .collect(),
    }
}

#[track_caller]
fn refused(main: &str, other: &str, line: usize, part: &str) {
    let found = faults(main, other);
    let fits = found.len() == 1 && found[0].0 == line && found[0].1.contains(part);
    assert!(fits, "{found:#?}");
}

#[track_caller]
fn carried(main: &str, other: &str) {
    let found = faults(main, other);
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn on_circles_the_tool_turns_evenly_with_the_object_frame_alone() {
    let remedy = "the tool turns by 60.0000 deg on its way, and on a circle it does not turn evenly: it turns with the path (CirPathMode\\PathFrame";
    refused(&format!("{START}\n{TURNED}"), "", 4, remedy);
    carried(&format!("{START}\n{EVEN}"), "");
    carried(&format!("{START}\nCirPathMode\\ObjectFrame;\n{TURNED}"), "");
    for other in ["PathFrame", "CirPointOri", "Wrist45"] {
        let main = format!("CirPathMode\\ObjectFrame;\n{START}\nCirPathMode\\{other};\n{TURNED}");
        refused(&main, "", 6, "write CirPathMode\\ObjectFrame before it");
    }
}

#[test]
fn the_mode_is_that_of_the_run() {
    let set = "CirPathMode\\ObjectFrame;";
    let left = "CirPathMode\\PathFrame;";
    let circle = format!("{START}\n{TURNED}");
    // At the second pass, and at the second call, the path frame is in force.
    let passes = format!("{set}\nFOR i FROM 1 TO 2 DO\n{circle}\n{left}\nENDFOR");
    refused(&passes, "", 6, "turns with the path");
    let calls = format!("{set}\nother;\n{left}\nother;");
    refused(&calls, &circle, 10, "turns with the path");
    carried(&format!("other;\n{circle}"), set);
    carried(
        &format!("FOR i FROM 1 TO 2 DO\n{START}\n{set}\n{TURNED}\nENDFOR"),
        "",
    );
    // A jump and a return pass statements by.
    let jump = format!("GOTO on;\n{set}\non:\n{circle}");
    refused(&jump, "", 7, "turns with the path");
    let back = format!("RETURN;\n{set}");
    refused(
        &format!("other;\n{circle}"),
        &back,
        5,
        "turns with the path",
    );
    // Nothing goes wrong: handlers and interrupts do not run.
    let handled = format!("SetDO x,1;\nERROR\n{set}");
    refused(
        &format!("other;\n{circle}"),
        &handled,
        5,
        "turns with the path",
    );
}

#[test]
fn a_mode_on_an_unknown_condition_is_refused_by_line() {
    let read = |condition: &str, values: &[(&str, f64)]| {
        let text = format!(
            "MODULE M\nPROC main()\nIF {condition} THEN\nCirPathMode\\ObjectFrame;\nENDIF\n{START}\n{TURNED}\nENDPROC\nENDMODULE\n"
        );
        let mut options = ReadOptions::default();
        for (name, value) in values {
            (options.values).insert((*name).to_owned(), StatedValue::Number(*value));
        }
        read_rapid(vec![SourceFile::new("m.mod", text)], &options)
    };
    let faults = read("di1=1", &[]).unwrap_err();
    assert_eq!((faults.len(), faults[0].line), (1, 3));
    let said = faults[0].to_string();
    assert!(
        said.contains("no `di1` is declared") && said.contains("--set NAME=VALUE"),
        "{said}"
    );
    let program = read("di1=1", &[("di1", 1.0)]).unwrap();
    assert!(path_of(&program, &PathOptions::default()).is_ok());
    let program = read("di1=1", &[("DI1", 0.0)]).unwrap();
    assert!(path_of(&program, &PathOptions::default()).is_err());
}

#[test]
fn with_the_joints_of_the_wrist_no_motion_turns_evenly() {
    for mode in ["Wrist", "LockAxis4"] {
        let main = format!("{START}\nSingArea\\{mode};\n{LINE}");
        refused(
            &main,
            "",
            5,
            "the joints of the wrist turn evenly (SingArea\\Wrist",
        );
    }
    carried(&format!("{START}\nSingArea\\Wrist;\n{START}"), "");
    carried(
        &format!("SingArea\\Wrist;\n{START}\nSingArea\\Off;\n{LINE}"),
        "",
    );
}

#[test]
fn a_mode_on_a_condition_or_in_a_comment_is_not_stated() {
    refused(
        &format!("CirPathMode\\PathFrame ! not ObjectFrame\n;\n{START}\n{TURNED}"),
        "",
        6,
        "turns with the path",
    );
}

/// A correction turns the tool by little on each circle, and the frame of the path would turn it otherwise.
#[test]
fn circles_that_a_correction_turns_state_the_object_frame_and_are_read_again() {
    let text = format!("MODULE M\nPROC main()\n  {START}\n  {EVEN}\nENDPROC\nENDMODULE\n");
    let read = |text: &str| {
        read_rapid(
            vec![SourceFile::new("m.mod", text)],
            &ReadOptions::default(),
        )
        .unwrap()
    };
    let program = read(&text);
    let own = program.motions[1].target.pose().unwrap().orientation;
    let turned = own * nalgebra::UnitQuaternion::from_euler_angles(1e-3, 0.0, 0.0);
    let mut piece = Piece::to(1, nalgebra::Vector3::new(10.0, 0.0, 0.1));
    piece.via_mm = Some(nalgebra::Vector3::new(5.0, 5.0, 0.1));
    let written = |piece: &Piece| {
        let files = write(
            &program,
            std::slice::from_ref(piece),
            &WriteOptions::default(),
        );
        String::from_utf8(files.unwrap().remove(0).1).unwrap()
    };
    let placed = written(&piece);
    assert!(!placed.contains("CirPathMode"), "{placed}");
    piece.orientation = Some(turned);
    let output = written(&piece);
    let line = "  CirPathMode\\ObjectFrame;\n  MoveC [[5,5,0.1";
    assert!(output.contains(line), "{output}");
    let again = read(&output);
    assert!(path_of(&again, &PathOptions::default()).is_ok());
    let pose = again.motions[1].target.pose().unwrap();
    assert!(pose.orientation.angle_to(&turned) < 1e-6);
}
