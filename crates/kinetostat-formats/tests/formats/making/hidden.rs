//! Statements that begin like others, or stand on the lines of others: none hides another.

use kinetostat_formats::*;

use super::{found, made, of_robot, text_of};

const POSE: &str = "[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

#[test]
fn calls_of_rapid_that_begin_like_declarations() {
    let text = format!(
        "MODULE M\nPROC main()\nMoveJ [[1,0,50],{POSE},v500,z10,tool0;\nProcessOn;\nVarReset 3;\nTaskStart;\nLocalClean;\n\
         SetDO do1,1; MoveL [[2,0,50],{POSE},v20,z1,tool0; SetDO do2,1;\nMoveL [[3,0,50],{POSE},v20,z1,tool0; SetDO do3,1;\nENDPROC\nENDMODULE\n"
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    let krl = text_of(&made, 0);
    let mut at = 0;
    for own in [
        "PTP {X 1.0",
        "ProcessOn",
        "VarReset",
        "TaskStart",
        "LocalClean",
        "SetDO do1",
        "LIN {X 2.0",
        "SetDO do2",
        "LIN {X 3.0",
        "SetDO do3",
    ] {
        at += krl[at..]
            .find(own)
            .unwrap_or_else(|| panic!("{own}: {krl}"))
            + own.len();
    }
    assert!(
        found(&made, "other statements: 7 lines"),
        "{:?}",
        made.findings
    );
}

#[test]
fn calls_of_krl_that_begin_like_declarations() {
    let text = "DEF a( )\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.02\n\
        PTP {X 0,Y 0,Z 20,A 0,B 180,C 0}\nINIT_GLUE( )\nEXTRUDE(3)\nBASKET( )\nDEFROST( )\nENDOSCOPE( )\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.02\nLIN {X 3,Y 0,Z 20,A 0,B 180,C 0}\nEND\n";
    let made = of_robot(Language::Krl, text, MakeLanguage::Rapid);
    let rapid = text_of(&made, 0);
    for own in ["INIT_GLUE", "EXTRUDE", "BASKET", "DEFROST", "ENDOSCOPE"] {
        assert!(rapid.contains(own), "{own}: {rapid}");
    }
    assert!(
        found(&made, "other statements: 5 lines"),
        "{:?}",
        made.findings
    );
}

/// Behind a routine that the run chooses a motion begins nobody knows where: it goes to its end all the same, and an arc is refused.
#[test]
fn motions_behind_unknown_routines_are_there() {
    let text = format!(
        "MODULE M\nPROC main()\nMoveJ [[1,0,50],{POSE},v500,z10,tool0;\n%\"Elsewhere\"%;\nMoveL [[2,0,50],{POSE},v20,z1,tool0;\n%\"Elsewhere\"%;\n\
         MoveL [[2,0,50],{POSE},v20,z1,tool0;\nMoveL [[3,0,50],{POSE},v20,z1,tool0;\nENDPROC\nENDMODULE\n"
    );
    for into in [MakeLanguage::Krl, MakeLanguage::Apt, MakeLanguage::Csv] {
        let made = of_robot(Language::Rapid, &text, into);
        assert_eq!(made.kept.motions, 3, "{into:?}: {}", text_of(&made, 0));
    }
    let arc = format!("MoveC [[3,4,50],{POSE},[[9,0,50],{POSE},v20,z1,tool0;");
    let text = text.replacen("%\"Elsewhere\"%;", &format!("%\"Elsewhere\"%;\n{arc}"), 1);
    let files = vec![SourceFile::new("m.mod", text)];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let refused = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl);
    let refused = refused.unwrap_err();
    assert_eq!(
        (refused.len(), refused[0].line),
        (1, Some(5)),
        "{refused:?}"
    );
    assert!(
        refused[0].to_string().contains("where this arc begins"),
        "{}",
        refused[0]
    );
}

/// What `SPINDL` says beside a turn and a speed is named.
#[test]
fn surfaces_and_angles_of_apt_spindles_are_named() {
    let text = "PARTNO A\nUNITS/MM\nSPINDL/900,RPM,CLW\nSPINDL/120,SFM,CLW\nSPINDL/ORIENT,90\nSPINDL/OFF\nFEDRAT/100\nGOTO/0,0,0\nGOTO/5,0,0\nFINI\n";
    let made = of_robot(Language::Apt, text, MakeLanguage::Gcode);
    assert!(
        found(
            &made,
            "spindle: 2 lines are notes now, and do nothing there (line 4: SPINDL/120,SFM,CLW)"
        ),
        "{:?}",
        made.findings
    );
    assert_eq!(text_of(&made, 0).matches("M5\n").count(), 2);
}

/// A block of G-code with words on both sides of its motion says both.
#[test]
fn a_block_of_g_code_has_two_sides() {
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 X10 F300 M50 M0\nG1 X20 M30 (end)\n";
    let krl = text_of(&made(text, &super::cell(), MakeLanguage::Krl), 0);
    let mut at = 0;
    for own in [
        "line 3: M50 M0",
        "LIN {X 10.0",
        "line 3: M0",
        "HALT",
        "LIN {X 20.0",
        "line 4: M30",
    ] {
        at += krl[at..]
            .find(own)
            .unwrap_or_else(|| panic!("{own}: {krl}"))
            + own.len();
    }
}
