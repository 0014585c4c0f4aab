//! Statements and comments on the lines of motions, preselected tools, optional stops.

use kinetostat_formats::*;

use super::{cell, found, of_robot, text_of};

/// The lines of a made program from the first motion on, without what is between brackets.
fn course(made: &Made) -> Vec<String> {
    let text = text_of(made, 0);
    let lines = text.lines().map(str::trim);
    let from = lines.skip_while(|line| !line.starts_with("PTP"));
    let short = |line: &str| {
        line.split(['{', '='])
            .next()
            .unwrap_or(line)
            .trim()
            .to_owned()
    };
    from.map(short)
        .filter(|line| !line.starts_with('$'))
        .collect()
}

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

fn line(way: &str, x: u32) -> String {
    format!("{way} [[{x},0,50],[0,0,1,0],[0,0,0,0],{NONE}],v20,fine,tool0;")
}

#[test]
fn several_statements_of_a_rapid_line_run_in_their_order() {
    let text = format!(
        "MODULE b\nPROC main()\n{} ! above\n{} WaitTime 1; SetDO d,1; {} Stop; {} ! end\n{} WaitTime 2;\nWaitTime 3; Stop;\nTPWrite \"a;b\"; Stop;\nIF d=1 THEN WaitTime 4; ENDIF\nENDPROC\nENDMODULE\n",
        line("MoveJ", 0),
        line("MoveL", 10),
        line("MoveL", 20),
        line("MoveL", 30),
        line("MoveL", 40),
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert_eq!(
        course(&made),
        [
            "PTP",
            "; line 3: ! above",
            "LIN",
            "; line 4: WaitTime 1",
            "WAIT SEC 1",
            "; line 4: SetDO d,1",
            "LIN",
            "; line 4: Stop",
            "HALT",
            "LIN",
            "; line 4: ! end",
            "LIN",
            "; line 5: WaitTime 2",
            "WAIT SEC 2",
            "; line 6: WaitTime 3",
            "WAIT SEC 3",
            "; line 6: Stop",
            "HALT",
            "; line 7: TPWrite  a b",
            "; line 7: Stop",
            "HALT",
            "; line 8: IF d",
            "END",
        ],
        "{}",
        text_of(&made, 0)
    );
}

#[test]
fn comments_behind_motions_are_carried() {
    let krl = "DEF a( )\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180} ; above\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 180} C_DIS; down\nEND\n";
    let made = of_robot(Language::Krl, krl, MakeLanguage::Krl);
    assert_eq!(
        course(&made),
        ["PTP", "; line 5: above", "LIN", "; line 6: down", "END"]
    );
    let apt = "UNITS/MM\nRAPID\nGOTO/0,0,5 $$ above\nFEDRAT/200,MMPM\nGOTO/0,0,0 $$ down\nFINI\n";
    let made = of_robot(Language::Apt, apt, MakeLanguage::Krl);
    assert_eq!(
        course(&made),
        [
            "PTP",
            "; line 3: $$ above",
            "LIN",
            "; line 5: $$ down",
            "END"
        ]
    );
}

#[test]
fn a_tool_that_comes_next_is_not_taken_yet() {
    let heidenhain = "0 BEGIN PGM A MM\n1 TOOL CALL 5 Z S3000\n2 TOOL DEF 7\n3 L X+0 Y+0 Z+5 R0 FMAX M3\n4 L Z+0 F200\n5 TOOL CALL 7 Z S2000\n6 TOOL DEF 5\n7 L X+10 Y+0 Z+0 F200 M3\n8 END PGM A MM\n";
    let siemens = "G90 G71\nT5 M6\nT7\nG0 X0 Y0 Z5\nG1 Z0 F200\nM6\nT5\nG1 X10 Y0 Z0\nM30\n";
    for (language, text, taken, next) in [
        (
            Language::Heidenhain,
            heidenhain,
            [
                "(line 2: TOOL CALL 5 Z S3000)",
                "(line 6: TOOL CALL 7 Z S2000)",
            ],
            "2 lines are notes now, and do nothing there (line 3: TOOL DEF 7)",
        ),
        (
            Language::Siemens,
            siemens,
            ["(line 2: T5 M6)", "(line 6: M6)"],
            "2 lines are notes now, and do nothing there (line 3: T7)",
        ),
    ] {
        let made = of_robot(language, text, MakeLanguage::Gcode);
        let lines: Vec<String> = text_of(&made, 0).lines().map(str::to_owned).collect();
        for (note, word) in taken.into_iter().zip(["T5 M6", "T7 M6"]) {
            let at = lines.iter().position(|line| line == note);
            let at = at.unwrap_or_else(|| panic!("{note}: {lines:#?}"));
            assert_eq!(lines[at + 1], word, "{lines:#?}");
        }
        assert!(found(&made, next), "{:?}", made.findings);
    }
}

#[test]
fn an_optional_stop_that_always_stops_is_named() {
    let siemens = "G90 G71\nG0 X0 Y0 Z5\nG1 Z0 F200\nM1\nG1 X9 M1\nM0\nM30\n";
    let heidenhain = "0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+5 FMAX\n2 L Z+0 F200\n3 M1\n4 L X+15 M1\n5 STOP\n6 END PGM A MM\n";
    for (language, text) in [
        (Language::Siemens, siemens),
        (Language::Heidenhain, heidenhain),
    ] {
        for into in [
            MakeLanguage::Krl,
            MakeLanguage::Rapid,
            MakeLanguage::FanucLs,
        ] {
            let made = of_robot(language, text, into);
            assert!(
                found(&made, "always stops here (line 4, line 5)"),
                "{:?}",
                made.findings
            );
        }
        let made = of_robot(language, text, MakeLanguage::Gcode);
        assert!(!found(&made, "always stops"), "{:?}", made.findings);
    }
}

#[test]
fn faults_of_the_program_are_none_of_the_template() {
    let krl = "DEF a( )\n$BASE=BASE_DATA[70]\n$TOOL=TOOL_DATA[40]\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 180}\nEND\n";
    let program = read_krl(vec![SourceFile::new("a.src", krl)], &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let own = |template: &Template| {
        let faults = make_of_robot(&program, &robot, template, MakeLanguage::FanucLs).unwrap_err();
        let faults = faults.into_iter();
        faults
            .map(|fault| (fault.line, fault.is_of_template, fault.reason))
            .collect::<Vec<_>>()
    };
    let found = own(&cell());
    assert_eq!(found.len(), 2, "{found:?}");
    for (fault, reason) in found.iter().zip([
        "the number of the base is above 61",
        "the number of the tool is above 29",
    ]) {
        assert_eq!(
            (fault.0, fault.1, fault.2.as_str()),
            (Some(5), false, reason)
        );
    }
    let mut template = cell();
    template.base.number = Some(1);
    template.tool.frame.number = Some(77);
    let found = own(&template);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, found[0].1), (None, true));
}

/// Comments within a statement, calls with further statements on their line, and comments behind them.
#[test]
fn what_stands_within_statements_and_beside_calls_comes_along_in_order() {
    let text = format!(
        "MODULE b\nPROC main()\n{}\nMoveL ! first\n[[10,0,50],[0,0,1,0],[0,0,0,0],{NONE}], ! second \"x\"\nv20,fine,tool0; ! behind\n\
         SetDO a,1; one; SetDO b,1; two; ! both\none2; {} ! last\nENDPROC\nPROC one()\n{} ! in one\nENDPROC\nPROC two()\n{}\nENDPROC\n\
         PROC one2()\nWaitTime 1;\nENDPROC\nENDMODULE\n",
        line("MoveJ", 0),
        line("MoveL", 40),
        line("MoveL", 20),
        line("MoveL", 30),
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert_eq!(
        course(&made),
        [
            "PTP",
            "; line 4: ! first",
            "; line 5: ! second  x",
            "LIN",
            "; line 6: ! behind",
            "; line 7: SetDO a,1",
            "LIN",
            "; line 11: ! in one",
            "; line 7: SetDO b,1",
            "LIN",
            "; line 7: ! both",
            "; line 17: WaitTime 1",
            "WAIT SEC 1",
            "LIN",
            "; line 8: ! last",
            "END"
        ]
    );
    let xs = |text: &str| {
        let lines = text.lines().filter(|line| line.starts_with("LIN {X"));
        let x = |line: &str| line[7..].split('.').next().unwrap().to_owned();
        lines.map(x).collect::<Vec<String>>()
    };
    assert_eq!(xs(&text_of(&made, 0)), ["10", "20", "30", "40"]);
    // What stands beside the arguments of a trigger is no argument.
    let text = format!(
        "MODULE b\nPROC main()\n{}\nTriggL [[10,0,50],[0,0,1,0],[0,0,0,0],{NONE}], ! a, b\nv20, trig1, ! c\nfine, tool0;\nENDPROC\nENDMODULE\n",
        line("MoveJ", 0)
    );
    let made = of_robot(Language::Rapid, &text, MakeLanguage::Krl);
    assert_eq!(
        course(&made),
        [
            "PTP",
            "; line 4: ! a, b",
            "; line 5: ! c",
            "; line 4: TriggL trig1",
            "LIN",
            "END"
        ]
    );
}

/// A comment behind a call of KRL, whose routine stands in the same file.
#[test]
fn comments_behind_calls_of_krl_come_along() {
    let text = "DEF part()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\nLIN {X 0,Y 0,Z 50,A 0,B 0,C 180}\nsub() ; the second\nEND\n\
        DEF sub()\nLIN {X 9,Y 0,Z 50,A 0,B 0,C 180}\nEND\n";
    let made = of_robot(Language::Krl, text, MakeLanguage::Rapid);
    let own = text_of(&made, 0);
    assert!(own.contains("! line 6: the second\n"), "{own}");
    assert!(!own.contains("sub()"), "{own}");
}
