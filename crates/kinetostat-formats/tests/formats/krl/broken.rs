//! Programs that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

const T: &str = "{X 1,Y 2,Z 3,A 0,B 0,C 0}";

fn refused(files: &[(&str, &str)]) -> Vec<(String, usize, String)> {
    let files = files
        .iter()
        .map(|(name, text)| SourceFile::new(*name, *text))
        .collect();
    let found = read_krl(files, &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.file.clone(), error.line, error.to_string()))
        .collect()
}

/// Statements of the first routine, from line 3 on.
fn in_main(statements: &str) -> Vec<(String, usize, String)> {
    let text = format!(
        "&ACCESS RVP\nDEF a()\n{}\nEND",
        statements.replace("<T>", T)
    );
    let data = "DEFDAT a\nDECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 3}\nFRAME way[2]\nway[1]={X 1,Y 2,Z 3,A 0,B 0,C 0}\n\
        DECL FDAT FP1={TOOL_NO 1,BASE_NO 1,IPO_FRAME #TCP}\nFRAME empty\nDECL E6POS odd={X 1,Y two,Z 3,A 0,B 0,C 0}\nENDDAT";
    refused(&[("a.src", &text), ("a.dat", data)])
}

#[test]
fn statements_that_move_the_tool_otherwise_are_refused_by_line() {
    let cases = [
        (
            "LIN_REL {X 10}",
            "it goes on from where the tool is, and that is not known from the text in these axes; write the end with LIN",
        ),
        (
            "LIN_REL {X 10,A 3}",
            "it goes on from where the tool is, and turns it or moves axes",
        ),
        (
            "LIN_REL {X 10} C_DIS #TOOL",
            "it goes on from where the tool is, and that is not known",
        ),
        (
            "PTP XHOME\nLIN_REL {X 10}",
            "it goes on from where the tool is, and that is not known",
        ),
        (
            "LIN <T>\nLIN_REL {A1 10}",
            "it goes on from where the tool is, and turns it or moves axes",
        ),
        (
            "SPLINE\nLIN XP1\nENDSPLINE",
            "it is no segment of a spline block",
        ),
        (
            "SPLINE\nSPLINE\nENDSPLINE",
            "the block has no end: there is no ENDSPLINE that closes it",
        ),
        (
            "SPLINE\nTIME_BLOCK START\nENDSPLINE",
            "it shares out the time of a spline block",
        ),
        ("PTP_REL {A1 10,X 3}", "it goes on from where the tool is"),
        (
            "CIRC_REL {X 10},{X 20}",
            "it goes on from where the tool is",
        ),
        (
            "CIRC <T>, <T>, CA 45",
            "the angle CA lets the circle end elsewhere",
        ),
        (
            "SPLINE\nSPL XP1\nSLIN XP1\nENDSPLINE",
            "depends on all of them; write the block with SLIN and SCIRC",
        ),
        (
            "PTP $POS_RET",
            "`$POS_RET` is known to the controller alone; write the motion with a literal",
        ),
        (
            "PTP $AXIS_RET",
            "`$AXIS_RET` is known to the controller alone",
        ),
        (
            "LIN XP9",
            "no `XP9` is declared in these files; give the .dat file",
        ),
        ("LIN way[n]", "no `n` is declared in these files"),
        ("LIN way[2]", "`way[2]` has no value in these files"),
        ("LIN empty", "`empty` has no value in these files"),
        ("LIN odd", "`odd`: no `two` is declared in these files"),
        (
            "LIN {X 1+two,Y 0,Z 0,A 0,B 0,C 0}",
            "no `two` is declared in these files",
        ),
        ("LIN {X 1,Q 0}", "it has a member that no position has"),
        ("LIN {S 2}", "it states no place; write X, Y, Z"),
        ("PTP {A1 10}", "it states only some axes"),
        ("PTP {A1 10,X 5}", "it mixes axes with places"),
        (
            "LIN {Z 5}",
            "it states only some of X, Y, Z, A, B, C, and the pose before it is not known",
        ),
        (
            "LIN XP1:way[1]:<T>",
            "a sum of more than two positions is not followed",
        ),
        ("LIN", "the motion has no end"),
        ("CIRC <T>", "the motion has no end"),
        (
            "LIN P2 Vel=0.5 m/s CPDAT1 Tool[1] Base[1]",
            "only the text of an inline form has: no controller runs that; give the file",
        ),
        (
            "PTP HOME Vel=100% DEFAULT",
            "only the text of an inline form has",
        ),
        ("INI", "it is no statement of KRL that is known here"),
        (
            "RSI_MOVECORR()",
            "a sensor moves the tool while the program runs",
        ),
        ("ret=RSI_ON(#RELATIVE)", "a sensor moves the tool"),
        ("ASYPTP {E1 5}", "it moves axes apart from the program"),
        ("RESUME", "it leaves motions before their ends"),
        (
            "$IPO_MODE=#TCP",
            "the tool stands still and the robot holds the part",
        ),
        (
            "FDAT_ACT=FP1\nBAS(#CP_PARAMS,1)",
            "the tool stands still and the robot holds the part",
        ),
        ("ELSE", "it closes no block that is open here"),
        ("ENDLOOP", "it closes no block that is open here"),
        ("IF x THEN", "the block has no end"),
        ("=3", "it is no statement of KRL"),
    ];
    for (statement, reason) in cases {
        let found = in_main(&format!("$OUT[1]=TRUE\n{statement}\n; after"));
        assert_eq!(found.len(), 1, "{statement}: {found:?}");
        let (file, line, text) = &found[0];
        let lines = statement.lines().count();
        assert!(
            file == "a.src" && (4..4 + lines).contains(line),
            "{statement}: {found:?}"
        );
        assert!(text.contains(reason), "{statement}: {text}");
    }
}

#[test]
fn values_that_change_while_the_program_runs_are_refused() {
    for change in ["move(XP1)", "x=read(XP1)"] {
        let found = in_main(&format!("{change}\nLIN XP1"));
        assert_eq!((found.len(), found[0].1), (1, 4), "{change}");
        assert!(
            found[0]
                .2
                .contains("`XP1` is changed while the program runs (line 3)"),
            "{}",
            found[0].2
        );
    }
    // What one run leaves there is what the next one begins with.
    for change in ["XP1.X=XP1.X+1", "LIN XP1\nXP1.Z=5"] {
        let found = in_main(&format!("{change}\nLIN XP1"));
        assert_eq!((found.len(), found[0].0.as_str()), (1, "a.dat"), "{change}");
        assert!(found[0].2.contains("the next run begins with"), "{found:?}");
    }
    let found = refused(&[
        ("a.src", "DEF a()\nLIN XG\nb()\nEND"),
        (
            "a.dat",
            "DEFDAT a\nDECL GLOBAL POS XG={X 1,Y 1,Z 1,A 0,B 0,C 0}\nENDDAT",
        ),
        ("b.src", "DEF b()\nXG.Z=3\nEND"),
    ]);
    assert!(
        found[0]
            .2
            .contains("the next run begins with another value"),
        "{}",
        found[0].2
    );
    // An argument that only goes in changes nothing.
    let text = "DEF a()\nin(XP1)\nLIN XP1\nEND\nDEF in(p :IN)\nPOS p\nEND\nDEF out(p :OUT)\nPOS p\nLIN p\nEND\nDEFDAT";
    let data = "DEFDAT a\nDECL POS XP1={X 1,Y 1,Z 1,A 0,B 0,C 0}\nENDDAT";
    let found = refused(&[("a.src", text), ("a.dat", data)]);
    assert_eq!((found.len(), found[0].1), (1, 10));
    assert!(
        found[0].2.contains("`p` is an argument of the routine"),
        "{}",
        found[0].2
    );
}

#[test]
fn all_problems_come_in_one_run_in_the_order_of_files_and_lines() {
    let a = "DEF a()\nLIN one\nIF x THEN\nLIN_REL {X 1}\nENDIF\nb()\nLIN two\nEND\nDEF late()\nLIN three\nEND";
    let b = "DEF b()\nHALT\nLIN four\nEND";
    let found = refused(&[("b.src", b), ("a.src", a)]);
    let places: Vec<(&str, usize)> = found
        .iter()
        .map(|(file, line, _)| (file.as_str(), *line))
        .collect();
    assert_eq!(
        places,
        [
            ("b.src", 3),
            ("a.src", 2),
            ("a.src", 3),
            ("a.src", 7),
            ("a.src", 10)
        ]
    );
}

#[test]
fn files_that_are_none_are_refused() {
    let cases = [
        ("", 1, "there is no DEF and no DEFDAT in the file"),
        (
            "; nothing\n&ACCESS",
            1,
            "there is no DEF and no DEFDAT in the file",
        ),
        (
            "LIN XP1\nLIN XP2",
            1,
            "it stands in no routine and no data list",
        ),
        (
            "DEF a()\nHALT",
            1,
            "the routine has no end; end it with END",
        ),
        ("DEF a()\nDEF b()\nEND", 1, "the routine has no end"),
        ("DEF a\nHALT\nEND", 1, "has no brackets behind it"),
        ("DEF ()\nEND", 1, "the routine has no name"),
        ("DEF a()\nEND\nEND", 3, "no routine is open here"),
        (
            "DEF a()\nEND\nDEF A()\nEND",
            3,
            "the name is declared twice",
        ),
        (
            "DEF a()\nINT n\nREAL N\nEND",
            3,
            "the name is declared twice",
        ),
        ("DEF a()\nDECL\nEND", 2, "nothing is declared here"),
        ("DEF a()\nDECL INT 5\nEND", 2, "a declared name is missing"),
    ];
    for (text, line, reason) in cases {
        let found = refused(&[("a.src", text)]);
        assert_eq!(found[0].1, line, "{text}: {found:?}");
        assert!(found[0].2.contains(reason), "{text}: {found:?}");
    }
    let deep = format!(
        "DEF a()\n{}{}END",
        "LOOP\n".repeat(101),
        "ENDLOOP\n".repeat(101)
    );
    assert!(
        refused(&[("a.src", &deep)])[0]
            .2
            .contains("nested deeper than 100")
    );
}

#[test]
fn interrupts_that_move_are_refused_and_external_axes_that_move() {
    let text =
        format!("DEF a()\nINTERRUPT DECL 4 WHEN $IN[1] DO away()\nEND\nDEF away()\nLIN {T}\nEND");
    let found = refused(&[("a.src", &text)]);
    assert_eq!((found.len(), found[0].1), (1, 2));
    assert!(
        found[0]
            .2
            .contains("`away` moves the tool at any time, or sets")
    );
    let text =
        "DEF a()\nLIN {X 1,Y 0,Z 0,A 0,B 0,C 0,E1 5}\nLIN {X 2,Y 0,Z 0,A 0,B 0,C 0,E1 6}\nEND";
    let found = refused(&[("a.src", text)]);
    assert_eq!((found.len(), found[0].1), (1, 3));
    assert!(found[0].2.contains("external axis E1 moves from 5 to 6"));
    let mut options = ReadOptions::default();
    options.external_axes = ExternalAxes::Carried;
    let program = read_krl(vec![SourceFile::new("a.src", text)], &options).unwrap();
    assert_eq!(
        program.motions[1].target.pose().unwrap().external[0],
        Some(6.0)
    );
}

#[test]
fn unknown_ends_stay_as_written_where_that_is_asked() {
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let text = format!("DEF a()\nPTP $POS_RET\nLIN {T}\nLIN XP9 C_DIS\nLIN {{Z 5}}\nEND");
    let program = read_krl(vec![SourceFile::new("a.src", text.as_str())], &options).unwrap();
    let unknown = |index: usize| matches!(program.motions[index].target, Target::Unknown { .. });
    assert_eq!([0, 1, 2, 3].map(unknown), [true, false, true, true]);
    assert_eq!(
        program
            .findings
            .iter()
            .filter(|finding| finding.message.starts_with("it stays as it is written"))
            .count(),
        3
    );
    assert_eq!(super::written(&program, &[]), text);
}

/// An element that the program assigns has a value, another one has none.
#[test]
fn an_element_that_is_assigned_is_said_to_be() {
    let text = "DEF b( )\nDECL POS pp[3]\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=0.02\n\
        PTP {X 0,Y 0,Z 20,A 0,B 180,C 0}\npp[1]={X 100,Y 0,Z 20,A 0,B 180,C 0}\nLIN pp[1]\nLIN pp[2]\nEND\n";
    let found = read_krl(
        vec![SourceFile::new("b.src", text)],
        &ReadOptions::default(),
    )
    .unwrap_err();
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("line 9") && found[0].contains("`pp[2]` has no value in these files"),
        "{found:?}"
    );
}

/// Two values for one coordinate, and a tool of which one number changes: nobody knows where the tip is.
#[test]
fn a_component_stated_twice_and_a_tool_changed_in_part_are_refused() {
    let text = |lines: &str| {
        let text = format!(
            "DEF part()\n$BASE={{X 1800,Y 0,Z 900,A 0,B 0,C 0}}\n$TOOL={{X 0,Y 0,Z 180,A 0,B 0,C 0}}\n$VEL.CP=0.02\nPTP {{X 0,Y 0,Z 50,A 0,B 0,C 180}}\n{lines}\nEND\n"
        );
        read_krl(
            vec![SourceFile::new("part.src", text)],
            &ReadOptions::default(),
        )
    };
    let twice = text("LIN {X 7,X 8,Y 0,Z 7,A 0,B 0,C 180}").unwrap_err();
    assert!(
        twice[0].line == 6 && twice[0].reason.contains("twice"),
        "{}",
        twice[0]
    );
    let changed = "LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n$TOOL.Z=250\nLIN {X 100,Y 0,Z 0,A 0,B 0,C 180}";
    let program = text(changed).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    for into in [
        MakeLanguage::Krl,
        MakeLanguage::Rapid,
        MakeLanguage::FanucLs,
    ] {
        let refused = make_of_robot(&program, &robot, &Template::default(), into).unwrap_err();
        let told = |fault: &MakeError| fault.reason.contains("where the tool's tip is");
        assert!(refused.iter().any(told), "{refused:?}");
    }
}
