//! Where programs end before their last line, and what they call that is in none of their files.

use kinetostat_formats::*;

use super::{cell, of_robot, text_of};

fn refused(from: Language, text: &str) -> Vec<(Option<usize>, String)> {
    let files = vec![SourceFile::new("source", text)];
    let program = read(from, files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let faults = make_of_robot(&program, &robot, &cell(), MakeLanguage::Krl).unwrap_err();
    let faults = faults.into_iter();
    faults.map(|fault| (fault.line, fault.reason)).collect()
}

fn ls(instructions: &[&str]) -> String {
    let lines = instructions.iter().enumerate();
    let lines: String = lines
        .map(|(index, text)| format!("{:>4}:{text} ;\n", index + 1))
        .collect();
    let positions: String = (1..5)
        .map(|number| format!("P[{number}]{{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {number}.000  mm,\tY = 0.000  mm,\tZ = 50.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 10.000 deg\n}};\n"))
        .collect();
    format!("/PROG  A\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n{lines}/POS\n{positions}/END\n")
}

const TWO: [&str; 4] = [
    "  UFRAME_NUM=1",
    "  UTOOL_NUM=2",
    "J P[1] 50% FINE   ",
    "L P[2] 20mm/sec FINE   ",
];
const THIRD: &str = "L P[3] 20mm/sec FINE   ";

#[test]
fn what_stands_behind_the_end_of_a_tp_program_does_not_run() {
    let made = |behind: &[&str]| {
        let text = ls(&[&TWO[..], behind].concat());
        of_robot(Language::FanucLs, &text, MakeLanguage::Krl)
            .kept
            .motions
    };
    for end in ["  ABORT", "  END"] {
        assert_eq!(made(&[end, THIRD]), 2, "{end}");
        assert_eq!(made(&[end]), 2, "{end}");
    }
    // A program that ends somewhere is taken to go on.
    assert_eq!(made(&["  IF DI[1]=OFF,ABORT", THIRD]), 3);
    let jump = ["  IF DI[1]=ON,JMP LBL[9]", "  END", "  LBL[9]", THIRD];
    assert_eq!(made(&jump), 3);
    // A motion that a jump leaves out on a condition.
    let jump = ["  IF DI[1]=ON,JMP LBL[9]", THIRD, "  LBL[9]", TWO[3]];
    let text = ls(&[&TWO[..], &jump].concat());
    let files = vec![SourceFile::new("source", text)];
    let found = read_ls(files, &ReadOptions::default()).unwrap_err();
    assert_eq!(found[0].line, 9, "{found:?}");
}

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

fn rapid(behind_first: &str, routines: &str) -> String {
    let line = |x: u32| format!("MoveL [[{x},0,50],[0,0,1,0],[0,0,0,0],{NONE}],v20,fine,tool0;\n");
    format!(
        "MODULE b\nPROC main()\n{}{behind_first}\n{}ENDPROC\n{routines}ENDMODULE\n",
        line(0),
        line(5)
    )
}

#[test]
fn exit_of_rapid_ends_the_program_from_wherever_it_stands() {
    let made = |statement: &str, routines: &str| {
        let text = rapid(statement, routines);
        of_robot(Language::Rapid, &text, MakeLanguage::Krl)
            .kept
            .motions
    };
    let sub = "PROC sub1()\nEXIT;\nENDPROC\n";
    for (statement, routines) in [
        ("EXIT;", ""),
        ("RETURN;", ""),
        ("ExitCycle;", ""),
        ("sub1;", sub),
    ] {
        assert_eq!(made(statement, routines), 1, "{statement}");
    }
    // A stop goes on, and a handler runs where something went wrong.
    for (statement, routines) in [
        ("Stop;", ""),
        ("IF di1=1 THEN EXIT; ENDIF", ""),
        (
            "sub1;",
            "PROC sub1()\nTPWrite \"x\";\nERROR\nEXIT;\nENDPROC\n",
        ),
        ("sub1;", "PROC sub1()\nRETURN;\nENDPROC\n"),
    ] {
        assert_eq!(made(statement, routines), 2, "{statement}");
    }
}

#[test]
fn motions_behind_a_return_of_krl_do_not_run() {
    let text = "DEF a( )\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nRETURN\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 180}\nEND\n";
    let made = of_robot(Language::Krl, text, MakeLanguage::Krl);
    assert_eq!(made.kept.motions, 1, "{}", text_of(&made, 0));
}

#[test]
fn machines_end_at_the_end_of_their_programs() {
    let siemens = "G90 G71\nG0 X0 Y0 Z5\nG1 Z0 F200\nM30\nX20\n";
    let heidenhain = "0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+5 FMAX\n2 L Z+0 F200\n3 L X+15 M30\n4 L X+20\n5 END PGM A MM\n";
    for (language, text, motions) in [
        (Language::Siemens, siemens, 2),
        (Language::Siemens, &siemens.replace("M30", "M17"), 2),
        (Language::Heidenhain, heidenhain, 3),
        (Language::Heidenhain, &heidenhain.replace("M30", "M2"), 3),
    ] {
        let made = of_robot(language, text, MakeLanguage::Krl);
        assert_eq!(made.kept.motions, motions, "{}", text_of(&made, 0));
        assert!(!text_of(&made, 0).contains("X 20"));
    }
}

#[test]
fn what_stands_behind_the_end_of_an_apt_file_does_not_run() {
    let text = "UNITS/MM\nRAPID\nGOTO/0,0,5\nFEDRAT/200,MMPM\nGOTO/0,0,0\nFINI\nGOTO/9,0,0\n";
    for text in [text.to_owned(), text.replace("FINI", "END")] {
        let found = refused(Language::Apt, &text);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, Some(7));
    }
    let paths = text.replace("FINI\n", "END-OF-PATH\nTOOL PATH/B,TOOL,T2\n");
    of_robot(Language::Apt, &paths, MakeLanguage::Csv);
}

#[test]
fn each_call_of_what_is_not_there_is_named_with_its_lines() {
    let krl = "DEF a( )\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nSUB1()\nGRIP(1)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$VEL.CP=0.01\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 180}\nGRIP(2)\nEND\n";
    let tp = ls(&[&TWO[..], &["  CALL SUB1", "  CALL SR[1]", "  CALL SUB1"]].concat());
    for (language, text, expected) in [
        (
            Language::Krl,
            krl.to_owned(),
            [
                (6, "`SUB1` is in none", ""),
                (7, "`GRIP` is in none", " (lines 7, 12)"),
            ],
        ),
        (
            Language::FanucLs,
            tp,
            [
                (9, "`SUB1` is in none", " (lines 9, 11)"),
                (10, "what is called is computed", ""),
            ],
        ),
        (
            Language::Rapid,
            rapid("sub1;\n%\"p\"%;\nsub1;", ""),
            [
                (4, "`sub1` is in none", " (lines 4, 6)"),
                (5, "what is called is computed", ""),
            ],
        ),
    ] {
        let made = of_robot(language, &text, MakeLanguage::Krl);
        for (line, begins, ends) in expected {
            let says = match begins.starts_with('`') {
                true => {
                    "it is a note here, and taken not to move the tool and not to change speed, tool or frame"
                }
                false => "it is a note here, and if it moves the tool",
            };
            assert!(
                made.findings.iter().any(|finding| {
                    finding.line == Some(line)
                        && finding.message.starts_with(begins)
                        && finding.message.contains(says)
                        && finding.message.ends_with(ends)
                }),
                "{language:?} {line}: {:?}",
                made.findings
            );
        }
    }
}

#[test]
fn what_moves_frames_of_a_tp_program_is_refused() {
    for statement in [
        "  $MNUFRAME[1,1]=PR[5]",
        "  $MNUFRAMENUM[1]=5",
        "  $MNUTOOLNUM[1]=5",
        "  $GROUP[1].$UFRAME=PR[1]",
        "  $group[1].$utool=PR[1]",
        "  UFRAME[1]=PR[1]",
        "  UTOOL[1]=PR[1]",
    ] {
        let text = ls(&[&TWO[..], &[statement, THIRD]].concat());
        let files = vec![SourceFile::new("a.ls", text)];
        let faults = read_ls(files, &ReadOptions::default()).unwrap_err();
        assert_eq!(faults.len(), 1, "{statement}: {faults:?}");
        assert_eq!(faults[0].line, 9, "{statement}");
    }
    // Others, and what only reads them, are carried.
    for statement in [
        "  $MCR.$GENOVERRIDE=50",
        "  $WAITTMOUT=$UFRAMENUM",
        "  R[1]=$MNUFRAMENUM[1]",
    ] {
        let text = ls(&[&TWO[..], &[statement, THIRD]].concat());
        of_robot(Language::FanucLs, &text, MakeLanguage::Krl);
    }
}

#[test]
fn a_tool_whose_number_the_run_computes_is_not_guessed() {
    let text = "DEF a( )\n$BASE=BASE_DATA[2]\n$TOOL=TOOL_DATA[N]\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 180}\nEND\n";
    for (text, what) in [
        (
            text.to_owned(),
            "which tool `TOOL_DATA[N]` is, is not known",
        ),
        (
            text.replace("$TOOL=TOOL_DATA[N]", "$TOOL=TC"),
            "which tool `TC` is, is not known",
        ),
        (
            text.replace("$TOOL=TOOL_DATA[N]", "BAS(#TOOL,N)"),
            "which tool `TOOL_DATA[N]` is, is not known",
        ),
        (
            text.replace("[N]", "[1]")
                .replace("BASE_DATA[2]", "BASE_DATA[M]"),
            "which work object `BASE_DATA[M]` is, is not known",
        ),
    ] {
        let found = refused(Language::Krl, &text);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, Some(5));
        assert!(found[0].1.starts_with(what), "{found:?}");
    }
}
