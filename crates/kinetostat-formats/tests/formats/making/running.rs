//! Events of robots' programs: in the order in which they run, inside motions, and as what the other language has.

use kinetostat_formats::*;

use super::{found, made, of_robot, text_of};

fn in_order(text: &str, words: &[&str]) {
    let mut at = 0;
    for own in words {
        let found = text[at..].find(own);
        at += found.unwrap_or_else(|| panic!("{own} behind {at}: {text}")) + own.len();
    }
}

const POSE: &str = "[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

fn rapid(body: &str, behind: &str) -> String {
    let to = |text: String, x: u32| text.replace(&format!("P{x}"), &format!("[[{x},0,50],{POSE}"));
    let text = format!("MODULE M\n{behind}PROC main()\n{body}ENDPROC\nENDMODULE\n");
    (0..10).fold(text, to)
}

#[test]
fn events_of_routines_stand_where_they_run() {
    let sub = "! comment of the module\nPROC sub1()\nSetDO doA,1;\nMoveL P2,v20,z1,tool0;\nSetDO doB,1;\nENDPROC\n\
        PROC other()\nSetDO doC,1;\nENDPROC\n";
    let text = rapid(
        "MoveJ P1,v500,z10,tool0;\nSetDO doD,1;\nsub1;\nSetDO doE,1;\nMoveL P3,v20,z1,tool0;\nWaitTime 0.5;\nStop;\n",
        sub,
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    let krl = text_of(&made, 0);
    in_order(
        &krl,
        &[
            "comment of the module",
            "PTP {X 1.0",
            "SetDO doD",
            "SetDO doA",
            "LIN {X 2.0",
            "SetDO doB",
            "SetDO doE",
            "LIN {X 3.0",
            "WAIT SEC 0.5",
            "HALT",
        ],
    );
    assert!(!krl.contains("sub1") && !krl.contains("doC"), "{krl}");
    assert!(
        found(&made, "have no place among the motions") && found(&made, "line 9: SetDO doC,1"),
        "{:?}",
        made.findings
    );
}

#[test]
fn local_routines_of_krl_too() {
    let text = "DEF a( )\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.02\n\
        PTP {X 0,Y 0,Z 20,A 0,B 180,C 0}\nsub1( )\nLIN {X 2,Y 0,Z 20,A 0,B 180,C 0}\n$OUT[3]=TRUE\nWAIT SEC 0.5\n\
        TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[4]=TRUE\nLIN {X 3,Y 0,Z 20,A 0,B 180,C 0}\nEND\n\
        DEF sub1( )\nHALT\nLIN {X 1,Y 0,Z 20,A 0,B 180,C 0}\nEND\n";
    let made = of_robot(Language::Krl, text, MakeLanguage::Rapid);
    in_order(
        &text_of(&made, 0),
        &[
            "MoveJ [[0.0",
            "Stop;",
            "MoveL [[1.0",
            "MoveL [[2.0",
            "$OUT[3]=TRUE",
            "WaitTime 0.5;",
            "TRIGGER WHEN",
            "MoveL [[3.0",
        ],
    );
    assert!(
        found(&made, "other statements: 2 lines are notes now"),
        "{:?}",
        made.findings
    );
    let apt = text_of(&of_robot(Language::Krl, text, MakeLanguage::Apt), 0);
    in_order(
        &apt,
        &[
            "GOTO/0",
            "STOP\n",
            "GOTO/1",
            "GOTO/2",
            "DELAY/0.5\n",
            "GOTO/3",
        ],
    );
}

/// Whether a branch or a loop runs is not known: what is in it is no action.
#[test]
fn pauses_in_branches_are_notes() {
    let text = rapid(
        "MoveJ P1,v500,z10,tool0;\nIF di1=1 THEN\nStop;\nENDIF\nIF di2=1 Stop;\nFOR i FROM 1 TO 3 DO\nWaitTime 0.5;\nENDFOR\n\
         MoveL P2,v20,z1,tool0;\nWaitDI di1,1;\nWaitTime 1;\nMoveL P3,v20,z1,tool0;\n",
        "",
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::FanucLs);
    let ls = text_of(&made, 0);
    assert_eq!(ls.matches("PAUSE").count(), 0, "{ls}");
    assert_eq!(ls.matches("(sec)").count(), 1, "{ls}");
    assert!(ls.contains("WAIT   1.00(sec) ;"), "{ls}");
    assert!(
        found(&made, "stops: 1 line") && found(&made, "dwells: 1 line"),
        "{:?}",
        made.findings
    );
}

#[test]
fn what_motions_of_rapid_do_beside_is_a_note() {
    let text = rapid(
        "MoveJ P1,v500,z10,tool0;\nMoveLDO P2,v20,z1,tool0\\WObj:=wobj0,do1,1;\nMoveLSync P3,v20,z1,tool0,\"spindle_on\";\n\
         TriggL P4,v20,trig\\T2:=more,z1,tool0;\nMoveLDO P4,v20,z1,tool0,do3,1;\nMoveCDO P5,[[6,9,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0,do4,1;\n\
         MoveL P7,v20,z1,tool0; SetDO do5,1;\n",
        "",
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    in_order(
        &text_of(&made, 0),
        &[
            "PTP {X 1.0",
            "LIN {X 2.0",
            "; line 4: MoveLDO do1,1\n",
            "LIN {X 3.0",
            "; line 5: MoveLSync  spindle_on",
            "; line 6: TriggL trig\\T2:=more\n",
            "LIN {X 4.0",
            "; line 7: MoveLDO do3,1\n",
            "CIRC {",
            "; line 8: MoveCDO do4,1\n",
            "LIN {X 7.0",
            "; line 9: SetDO do5,1\n",
        ],
    );
    assert!(
        found(&made, "other statements: 6 lines are notes now"),
        "{:?}",
        made.findings
    );
}

fn ls(lines: &[&str]) -> String {
    let mut text = "/PROG  B\n/ATTR\nLINE_COUNT\t= 0;\n/MN\n".to_owned();
    for (index, line) in lines.iter().enumerate() {
        text += &format!("{:>4}:{line} ;\n", index + 1);
    }
    text += "/POS\n";
    for number in 1..=3 {
        text += &format!(
            "P[{number}]{{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {number} mm,\tY = 0 mm,\tZ = 20 mm,\n\tW = 180 deg,\tP = 0 deg,\tR = 0 deg\n}};\n"
        );
    }
    text.replace("LINE_COUNT\t= 0", &format!("LINE_COUNT\t= {}", lines.len())) + "/END\n"
}

#[test]
fn what_motions_of_fanuc_start_is_a_note() {
    let text = ls(&[
        "  UFRAME_NUM=1",
        "  UTOOL_NUM=1",
        "J P[1] 10% FINE",
        "L P[2] 20mm/sec FINE TB    .10sec,DO[1]=ON",
        "  WAIT    .50(sec)",
        "  PAUSE",
        "L P[3] 20mm/sec FINE TA .20sec,CALL GLUE",
    ]);
    let made = of_robot(Language::FanucLs, &text, MakeLanguage::Rapid);
    in_order(
        &text_of(&made, 0),
        &[
            "MoveJ [[1.0",
            "MoveL [[2.0",
            "TB .10sec,DO[1]=ON",
            "WaitTime 0.5;",
            "Stop;",
            "MoveL [[3.0",
            "TA .20sec,CALL GLUE",
        ],
    );
    assert!(
        found(&made, "other statements: 2 lines are notes now"),
        "{:?}",
        made.findings
    );
}

/// `UFRAME_NUM=R[5]` may be any frame.
#[test]
fn a_frame_that_the_run_computes_is_refused() {
    for register in ["  UFRAME_NUM=R[5]", "  UTOOL_NUM=R[5]"] {
        let text = ls(&[
            "  UFRAME_NUM=1",
            "  UTOOL_NUM=1",
            "J P[1] 10% FINE",
            register,
            "L P[3] 20mm/sec FINE",
        ]);
        let file = || vec![SourceFile::new("b.ls", text.as_str())];
        let refused = read_ls(file(), &ReadOptions::default()).unwrap_err();
        assert_eq!(refused.len(), 1, "{refused:?}");
        assert!(
            refused[0].to_string().contains("the run decides"),
            "{}",
            refused[0]
        );
        let mut options = ReadOptions::default();
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        assert_eq!(read_ls(file(), &options).unwrap().motions.len(), 2);
    }
}

#[test]
fn machines_keep_spindle_coolant_tools_pauses_and_stops() {
    let text = "G21 G90\nT3 M6\nS8000\nM3\nG0 X0 Y0 Z5 M8\nG1 Z-1 F300\nG4 X0.5\nM0\nG1 X10 M9\nT4 M6\nS4000 M4\nG1 X20 M7\nM1\nM5 M9\nM30\n";
    let apt_made = made(text, &super::cell(), MakeLanguage::Apt);
    let apt = text_of(&apt_made, 0);
    in_order(
        &apt,
        &[
            "LOADTL/3\n",
            "SPINDL/8000,RPM,CLW\n",
            "COOLNT/FLOOD\n",
            "GOTO/0",
            "DELAY/0.5\n",
            "STOP\n",
            "GOTO/10",
            "COOLNT/OFF\n",
            "LOADTL/4\n",
            "SPINDL/4000,RPM,CCLW\n",
            "COOLNT/MIST\n",
            "GOTO/20",
            "OPSTOP\n",
            "SPINDL/OFF\n",
            "COOLNT/OFF\n",
        ],
    );
    assert!(
        !found(&apt_made, "are notes now") && !found(&apt_made, "is a note now"),
        "{:?}",
        apt_made.findings
    );
    let again = of_robot(Language::Apt, &apt, MakeLanguage::Gcode);
    in_order(
        &text_of(&again, 0),
        &[
            "T3 M6\n",
            "S8000 M3\n",
            "M8\n",
            "G0 X0",
            "G4 X0.5\n",
            "M0\n",
            "G1 X10",
            "M9\n",
            "T4 M6\n",
            "S4000 M4\n",
            "M7\n",
            "G1 X20",
            "M1\n",
            "M5\n",
            "M9\n",
        ],
    );
    assert!(found(&again, "pauses are G4 X, in seconds"));
    // Poses of the tip need no tips of tools; those of a robot do.
    assert_eq!(
        made(text, &super::cell(), MakeLanguage::Csv).kept.motions,
        4
    );
    let (program, path) = super::gcode(text);
    assert!(
        make(
            &path,
            &events_of_gcode(&program, &path),
            &super::cell(),
            MakeLanguage::Krl
        )
        .is_err()
    );
}

#[test]
fn a_speed_that_is_a_time_is_refused_in_words_of_robots() {
    let text = rapid(
        "MoveJ P1,v500,z10,tool0;\nMoveL P2,v20\\T:=50,z1,tool0;\n",
        "",
    );
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let refused =
        make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Csv).unwrap_err();
    let said = refused[0].to_string();
    assert!(
        said.contains("number of mm/s") && !said.contains("G95"),
        "{said}"
    );
}

/// Feeds of machines are in mm/min, and what states none there is neither a time nor a register.
#[test]
fn a_feed_that_is_none_is_refused_in_words_of_its_language() {
    let text = "BEGIN PGM A MM\nL X+0 Y+0 Z+50 R0 FMAX\nL X+5 Y+5 Z+5 FZ0.1\nEND PGM A MM\n";
    let files = vec![SourceFile::new("a.h", text)];
    let program = read_heidenhain(files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let refused = make_of_robot(&program, &robot, &super::cell(), MakeLanguage::Csv).unwrap_err();
    let said = refused[0].to_string();
    assert!(
        said.contains("number of mm/min") && !said.contains("register"),
        "{said}"
    );
}

/// Coolant flows before the motion of its block, a stop is behind it.
#[test]
fn a_stop_beside_coolant_is_behind_the_motion() {
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 X10 F300 M8 M0\nG1 X20\n";
    let krl = text_of(&made(text, &super::cell(), MakeLanguage::Krl), 0);
    in_order(
        &krl,
        &["; line 3: M8 M0\n", "LIN {X 10.0", "HALT\n", "LIN {X 20.0"],
    );
    let apt = text_of(&made(text, &super::cell(), MakeLanguage::Apt), 0);
    in_order(
        &apt,
        &["COOLNT/FLOOD\n", "GOTO/10.0", "STOP\n", "GOTO/20.0"],
    );
}

/// A spindle that stops while the tool still cuts does harm: `M5` and `M9` are behind the motion of their block, whatever stands first.
#[test]
fn a_spindle_stops_behind_the_motion() {
    let text = "G21 G90\nS900 M3\nG0 X0 Y0 Z5 M8\nM5 G1 X10 F300 T2\nM3\nG1 X20 M9 M05 M0\nG0 Z50 M4 S700\nG0 X0 M5 (off)\nM30\n";
    let expected = [
        "SPINDL/900,RPM,CLW\n",
        "COOLNT/FLOOD\n",
        "GOTO/0.",
        "GOTO/10.",
        "SPINDL/OFF\n",
        "SPINDL/900,RPM,CLW\n",
        "GOTO/20.",
        "COOLNT/OFF\n",
        "SPINDL/OFF\n",
        "STOP\n",
        "SPINDL/700,RPM,CCLW\n",
        "GOTO/20.",
        "GOTO/0.",
        "SPINDL/OFF\n",
    ];
    let apt = text_of(&made(text, &super::cell(), MakeLanguage::Apt), 0);
    in_order(&apt, &expected);
    assert_eq!(apt.matches("SPINDL").count(), 6, "{apt}");
    let krl = text_of(&made(text, &super::cell(), MakeLanguage::Krl), 0);
    in_order(
        &krl,
        &[
            "; line 4: M5 T2\n",
            "LIN {X 10.0",
            "; line 4: M5\n",
            "LIN {X 20.0",
            "; line 6: M9 M05 M0\n",
            "HALT\n",
            "Z 50.0",
            "LIN {X 0.0",
            "; line 8: M5 [off]\n",
        ],
    );
}

/// What `main` calls is followed, also where it stands above main.
#[test]
fn a_call_that_is_followed_is_not_left_out() {
    let motion = |x: u32| {
        format!(
            "MoveL [[{x},0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,fine,tool0;\n"
        )
    };
    let text = format!(
        "MODULE M\nPROC Path_10()\n{}SetDO do1,1;\n{}ENDPROC\nPROC main()\nPath_10;\nENDPROC\nENDMODULE\n",
        motion(1),
        motion(2)
    );
    let made = super::of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert!(!super::found(&made, "left out"), "{:?}", made.findings);
    assert!(super::text_of(&made, 0).contains("; line 4: SetDO do1,1"));
}
