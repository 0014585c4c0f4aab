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
fn what_one_way_alone_puts_in_force_is_not_sure() {
    let set = "CirPathMode\\ObjectFrame;";
    let left = "CirPathMode\\PathFrame;";
    refused(
        &format!("IF reg1=1 THEN\n{set}\nENDIF\n{START}\n{TURNED}"),
        "",
        7,
        "turns with the path",
    );
    carried(
        &format!("IF reg1=1 THEN\n{set}\nELSE\n{set}\nENDIF\n{START}\n{TURNED}"),
        "",
    );
    // At the second pass the path frame is in force.
    refused(
        &format!("{set}\nWHILE TRUE DO\n{START}\n{TURNED}\n{left}\nENDWHILE"),
        "",
        6,
        "turns with the path",
    );
    // So it is at the second call.
    let call = format!("{set}\nother;\n{left}\nother;");
    refused(
        &call,
        &format!("{START}\n{TURNED}"),
        10,
        "turns with the path",
    );
    carried(&format!("other;\n{START}\n{TURNED}"), set);
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
fn what_is_stated_within_a_loop_or_a_routine_is_sure_there() {
    let set = "CirPathMode\\ObjectFrame;";
    carried(
        &format!("FOR i FROM 1 TO 2 DO\n{START}\n{set}\n{TURNED}\nENDFOR"),
        "",
    );
    carried("other;\nother;", &format!("{START}\n{set}\n{TURNED}"));
    let one_way =
        format!("FOR i FROM 1 TO 2 DO\nIF reg1=i THEN\n{set}\nENDIF\n{START}\n{TURNED}\nENDFOR");
    refused(&one_way, "", 8, "turns with the path");
}

#[test]
fn a_jump_and_a_return_bring_what_was_in_force_there() {
    let set = "CirPathMode\\ObjectFrame;";
    let left_out = format!("IF reg1=1 GOTO on;\n{set}\non:\n{START}\n{TURNED}");
    refused(&left_out, "", 7, "turns with the path");
    let both = format!("{set}\nIF reg1=1 GOTO on;\n{set}\non:\n{START}\n{TURNED}");
    carried(&both, "");
    let main = format!("other;\n{START}\n{TURNED}");
    refused(
        &main,
        &format!("IF reg1=1 RETURN;\n{set}"),
        5,
        "turns with the path",
    );
}

/// What a later pass, a later call or a jump out of a loop brings.
#[test]
fn later_passes_and_calls_bring_what_is_in_force_then() {
    let (set, left) = ("CirPathMode\\ObjectFrame;", "CirPathMode\\PathFrame;");
    let other = format!("{START}\n{TURNED}");
    // Walked before the loop, called again in it.
    let main = format!("{set}\nother;\nWHILE reg1=1 DO\nother;\n{left}\nENDWHILE");
    refused(&main, &other, 12, "turns with the path");
    // The second pass leaves the routine, or jumps out of the loop, with the path frame.
    let returned = format!("WHILE TRUE DO\nIF reg1=1 RETURN;\n{left}\nENDWHILE\n{set}");
    let main = format!("{set}\nother;\n{START}\n{TURNED}");
    refused(&main, &returned, 6, "turns with the path");
    let jumped = format!(
        "{set}\nWHILE TRUE DO\nIF reg1=1 GOTO on;\n{left}\nENDWHILE\n{set}\non:\n{START}\n{TURNED}"
    );
    refused(&jumped, "", 11, "turns with the path");
    // A jump backward leads to a label before what it passed.
    let back = format!("{set}\nback:\nother;\n{left}\nIF reg1=1 GOTO back;");
    refused(&back, &other, 11, "turns with the path");
    let still = format!("{set}\nback:\nother;\nIF reg1=1 GOTO back;");
    carried(&still, &other);
    // What the caller did before is not what a later call finds.
    let main = format!("{set}\n{START}\n{TURNED}\nother;\n{left}\nother;");
    carried(&main, &format!("{START}\n{EVEN}"));
}

/// Handlers and interrupts come from anywhere, and leave in force what they state.
#[test]
fn handlers_traps_and_functions_come_from_anywhere() {
    let (set, left) = ("CirPathMode\\ObjectFrame;", "CirPathMode\\PathFrame;");
    let turned = format!("other;\n{START}\n{TURNED}");
    // Nothing went wrong: the handler did not state it.
    refused(
        &turned,
        &format!("SetDO x,1;\nERROR\n{set}"),
        5,
        "turns with the path",
    );
    refused(
        &turned,
        &format!("SetDO x,1;\nUNDO\n{set}"),
        5,
        "turns with the path",
    );
    // RETRY comes back to the circle.
    let retried = format!("{set}\n{START}\n{TURNED}\nERROR\n{left}\nRETRY;");
    refused(&retried, "", 5, "turns with the path");
    carried(&format!("{set}\n{START}\n{TURNED}\nERROR\nRETRY;"), "");
    // The handler leaves the routine before it stated it.
    let main = format!("{set}\nother;\n{START}\n{TURNED}");
    let leaves = format!("{left}\nWaitDI x,1;\n{set}\nERROR\nRETURN;");
    refused(&main, &leaves, 6, "turns with the path");
    // What is called is left where something goes wrong in it, and TRYNEXT goes on behind the call, or RETRY calls it again.
    let restored = format!("{left}\nWaitDI x,1;\n{set}");
    let main = format!("{set}\nother;\n{START}\n{TURNED}");
    carried(&main, &restored);
    for back in ["TRYNEXT", "RETRY"] {
        let handled = format!("{main}\nERROR\n{back};");
        refused(&handled, &restored, 6, "turns with the path");
        carried(&handled, "WaitDI x,1;");
        // Before it stated anything, too.
        let handled = format!("other;\n{START}\n{TURNED}\nERROR\n{back};");
        refused(&handled, set, 5, "turns with the path");
    }
    let again = format!("{set}\nother;\nERROR\nRETRY;");
    let turned_first = format!("{START}\n{TURNED}\n{left}\nWaitDI x,1;\n{set}");
    refused(&again, &turned_first, 10, "turns with the path");
    carried(&format!("{set}\nother;"), &turned_first);
    refused(
        &format!("other;\n{START}\n{TURNED}"),
        &format!("WaitDI x,1;\n{set}\nERROR\nRETURN;"),
        5,
        "turns with the path",
    );
    // An interrupt between statement and circle.
    let main = format!("{set}\n{START}\n{TURNED}");
    let trap = format!("ENDPROC\nTRAP t\n{left}\nENDTRAP\nPROC last()");
    refused(&main, &trap, 5, "turns with the path");
    let function = format!("ENDPROC\nFUNC num f()\n{left}\nRETURN 1;\nENDFUNC\nPROC last()");
    refused(&main, &function, 5, "turns with the path");
    // In an interrupt what main states somewhere may be in force.
    let wrist = format!("SingArea\\Wrist;\n{START}\nSingArea\\Off;");
    let trap = format!("ENDPROC\nTRAP t\n{START}\n{LINE}\nENDTRAP\nPROC last()");
    refused(&wrist, &trap, 11, "the joints of the wrist");
    carried(START, &trap);
}

/// Which routine a computed name calls, the run decides: all of these files may be it.
#[test]
fn behind_a_computed_call_what_any_statement_puts_in_force_may_be() {
    let set = "CirPathMode\\ObjectFrame;";
    let left = "CirPathMode\\PathFrame;";
    for call in ["%\"other\"%;", "CallByVar \"other\",reg1;"] {
        let main = format!("{set}\n{call}\n{START}\n{TURNED}");
        refused(&main, left, 6, "turns with the path");
        carried(&main, set);
    }
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

/// A routine whose caller moves in a handler may be called from there, too.
#[test]
fn what_a_handler_moves_before_a_call_is_not_sure() {
    let text = format!(
        "MODULE M\nPROC main()\n{START}\nother;\nERROR\n{LINE}\nRETRY;\nENDPROC\nPROC other()\n{LINE}\nENDPROC\nENDMODULE\n"
    );
    let files = vec![SourceFile::new("m.mod", text)];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    let of_other = program.motions.iter().find(|motion| motion.line == 10);
    assert_eq!(of_other.unwrap().follows, None);
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
