//! Programs that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

const T: &str = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

/// Line and text of every error.
fn errors(text: &str) -> Vec<(usize, String)> {
    let text = text
        .replace('T', "\u{1}")
        .replace("<\u{1}>", T)
        .replace('\u{1}', "T");
    let files = vec![SourceFile::new("a.mod", text)];
    let found = read_rapid(files, &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.line, error.to_string()))
        .collect()
}

/// Statements of `main`, from line 3 on.
fn in_main(statements: &str) -> Vec<(usize, String)> {
    errors(&format!(
        "MODULE A\nPROC main()\n{statements}\nENDPROC\nENDMODULE"
    ))
}

#[test]
fn statements_that_move_the_tool_otherwise_are_refused_by_line() {
    let cases = [
        (
            "MoveL p1,v10,z1,tool0;",
            "no `p1` is declared in these files; give the module",
        ),
        (
            "MoveL CRobT(),v10,z1,tool0;",
            "computed while the program runs; write the motion with a literal",
        ),
        ("MoveL <T>,v10,tool0;", "MoveL needs at least 4 arguments"),
        ("MoveL <T>\\Corr,v10,z1,tool0;", "corrected by a sensor"),
        (
            "MoveC <T>,v10,z1,tool0;",
            "MoveC needs at least 5 arguments",
        ),
        (
            "SearchL di1,p,<T>,v10,tool0;",
            "it ends where a signal changes",
        ),
        ("PDispOn p,tool0;", "it displaces all motions behind it"),
        ("CorrWrite id,offset;", "it corrects the path while it runs"),
        ("WaitWObj wconv;", "the work object moves with the conveyor"),
        ("MoveExtJ j1,v10,fine;", "it moves external axes alone"),
        (
            "SpotL <T>,v10,spot1,gun1,tool0;",
            "its motion is not followed",
        ),
        (
            "MoveL Offs(<T>,0,0,n),v10,z1,tool0;",
            "write the offsets as numbers",
        ),
        (
            "MoveL Offs(<T>,0,0),v10,z1,tool0;",
            "an offset has a target and three lengths",
        ),
        (
            "MoveL [[1,2],[1,0,0,0],[0,0,0,0],[9E9]],v10,z1,tool0;",
            "its place is not three numbers",
        ),
        (
            "MoveL [[1,2,3],[1,1,0,0],[0,0,0,0],[9E9]],v10,z1,tool0;",
            "its quaternion has not the length 1",
        ),
        (
            "MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9]],v10,z1,tool0;",
            "its external axes are not six numbers",
        ),
        (
            "MoveL [[1,2,3],[1,0,0,0],[0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;",
            "its configuration is not four whole numbers",
        ),
        (
            "MoveL [[1,2,3],[1,0,0,0],[0,0.5,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;",
            "its configuration is not four whole numbers",
        ),
        (
            "MoveL [[1,2,3],[1,0,0,0],conf1,[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;",
            "no `conf1` is declared in these files",
        ),
        (
            "MoveL [[1,2,3],[1,0,0,0]],v10,z1,tool0;",
            "a robtarget has four parts",
        ),
    ];
    for (statement, reason) in cases {
        let found = in_main(&format!("Set do1;\n{statement}\n! after"));
        assert_eq!(found.len(), 1, "{statement}: {found:?}");
        assert_eq!(found[0].0, 4, "{statement}");
        assert!(found[0].1.contains(reason), "{statement}: {}", found[0].1);
    }
}

#[test]
fn text_that_no_controller_loads_is_refused_by_line() {
    let cases = [
        ("PROC main()\nENDPROC", 1, "it stands outside a module"),
        (
            "MODULE A\nPROC main()\nENDPROC\n",
            1,
            "no ENDMODULE ends the module",
        ),
        (
            "MODULE A\nPROC main()\nENDMODULE",
            2,
            "no ENDPROC ends the routine",
        ),
        (
            "MODULE A\nPROC main()\nSet do1\nENDPROC\nENDMODULE",
            3,
            "no semicolon ends the statement",
        ),
        (
            "MODULE A\nPROC main()\nIF x=1 THEN\nSet do1;\nENDPROC\nENDMODULE",
            3,
            "no ENDIF ends it",
        ),
        (
            "MODULE A\nPROC main()\nFOR i FROM 1 TO 2\nSet do1;\nENDFOR\nENDPROC\nENDMODULE",
            3,
            "DO is missing",
        ),
        (
            "MODULE A\nPROC main()\nENDWHILE\nENDPROC\nENDMODULE",
            3,
            "nothing is open that it ends",
        ),
        (
            "MODULE A\nPROC main()\nTPWrite \"open;\nENDPROC\nENDMODULE",
            3,
            "the text is not closed on its line",
        ),
        (
            "MODULE A\nPROC main()\n<SMT>;\nENDPROC\nENDMODULE",
            3,
            "no statement begins so",
        ),
        (
            "MODULE A\nCONST num a:=1;\nVAR bool A;\nPROC main()\nENDPROC\nENDMODULE",
            3,
            "the name is declared twice",
        ),
        (
            "MODULE A\nCONST num a2345678901234567890123456789_123:=1;\nENDMODULE",
            2,
            "more than 32 characters",
        ),
        (
            "MODULE A\nSet do1;\nENDMODULE",
            2,
            "neither a declaration nor a routine begins here",
        ),
        (
            "MODULE A\nPROC main()\nSet do1;\nVAR num n;\nENDPROC\nENDMODULE",
            4,
            "a declaration stands behind statements",
        ),
        ("", 1, "there is no MODULE in the file"),
        (
            "MODULE A\nCONST num 5:=1;\nENDMODULE",
            2,
            "a name is missing here",
        ),
        (
            "MODULE A\nPROC main()\nTEST n\nCASE 1;\nENDTEST\nENDPROC\nENDMODULE",
            4,
            "a colon is missing",
        ),
    ];
    for (text, line, reason) in cases {
        let found = errors(text);
        assert_eq!(found[0].0, line, "{text}: {found:?}");
        assert!(found[0].1.contains(reason), "{text}: {}", found[0].1);
        assert!(found.len() <= 3, "{text}: {found:?}");
    }
}

#[test]
fn targets_that_differ_from_run_to_run_are_refused() {
    let data = "VAR robtarget p:=<T>;\nPERS robtarget q:=<T>;\nCONST robtarget row{2}:=[<T>,<T>];\nCONST num n:=1;";
    let cases = [
        (
            "Own q;\nMoveL q,v10,z1,tool0;",
            9,
            "`q` is changed while the program runs (line 8)",
        ),
        (
            ";\nMoveL row{3},v10,z1,tool0;",
            9,
            "`row` has no such element",
        ),
        (";\nMoveL n,v10,z1,tool0;", 9, "`n` is no robtarget"),
    ];
    for (statements, line, reason) in cases {
        let text = format!(
            "MODULE A\n{data}\n! a line\nPROC main()\n{statements}\nENDPROC\nPROC change(INOUT robtarget given)\nENDPROC\nENDMODULE"
        );
        let found = errors(&text);
        assert_eq!(
            (found.len(), found[0].0),
            (1, line),
            "{statements}: {found:?}"
        );
        assert!(found[0].1.contains(reason), "{statements}: {}", found[0].1);
    }
    // What is only read stays known, and a constant is an index.
    let reads = "MODULE A\nVAR robtarget p:=<T>;\nCONST robtarget row{2}:=[<T>,<T>];\nCONST num n:=1;\nPROC main()\nlook p;\n\
        MoveL p,v10,z1,tool0;\nMoveL row{n},v10,z1,tool0;\nENDPROC\nPROC look(robtarget given)\nENDPROC\nENDMODULE";
    assert_eq!(super::program(&reads.replace("<T>", T)).motions.len(), 2);
    let argument = "MODULE A\nPROC main(robtarget p)\nMoveL p,v10,z1,tool0;\nENDPROC\nENDMODULE";
    assert!(
        errors(argument)[0]
            .1
            .contains("is an argument of the routine: no call of these files gives it")
    );
}

#[test]
fn all_problems_come_in_one_run_in_the_order_of_lines() {
    let text = "MODULE A\nPROC late()\nMoveL p9,v10,z1,tool0;\nENDPROC\nPROC main()\nSearchL a,b,c,d,e;\nlate;\nSet do1\nMoveL x,v1,z1,tool0;\nENDPROC\nENDMODULE";
    let lines: Vec<usize> = errors(text).iter().map(|(line, _)| *line).collect();
    // `Set do1` swallows the motion behind it, which has an end.
    assert_eq!(lines, [3, 6]);
    let text = text.replace("do1\nMoveL", "do1;\nMoveL");
    let lines: Vec<usize> = errors(&text).iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [3, 6, 9]);
}

#[test]
fn blocks_nested_without_end_are_refused_once() {
    let text = format!("MODULE A\nPROC main()\n{}", "IF a=1 THEN\n".repeat(100_000));
    let found = errors(&text);
    assert!(
        found[0].1.contains("no ENDIF") || found[0].1.contains("nested deeper"),
        "{}",
        found[0].1
    );
    assert!(
        found
            .iter()
            .any(|(_, text)| text.contains("blocks are nested deeper than 100"))
    );
    assert!(found.len() < 5, "{}", found.len());
    let text = format!(
        "MODULE A\nCONST robtarget p:={};\nPROC main()\nMoveL p,v10,z1,tool0;\nENDPROC\nENDMODULE",
        "[".repeat(100_000)
    );
    assert_eq!(errors(&text).len(), 1);
}

#[test]
fn files_of_nothing_but_faults_are_bounded() {
    let files = |text: String| vec![SourceFile::new("a.mod", text)];
    let endless = "MODULE A\nPROC main()\n".to_owned() + &"TEST\n".repeat(300_000);
    assert_eq!(
        read_rapid(files(endless), &ReadOptions::default())
            .unwrap_err()
            .len(),
        100_000
    );
    let calls =
        "MODULE A\nPROC main()\n".to_owned() + &"x;".repeat(300_000) + "\nENDPROC\nENDMODULE";
    assert_eq!(
        read_rapid(files(calls), &ReadOptions::default())
            .unwrap()
            .findings
            .len(),
        1
    );
}

#[test]
fn a_refused_instruction_makes_no_other_line_wrong() {
    let found = errors(
        "MODULE A\nPERS tooldata t:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nPROC main()\nMoveL <T>,v10,z1,t;\nCapL <T>,v10,c,z1,t;\nSearchL di1,q,<T>,v10,t;\nMoveL <T>,v10,z1,t;\nENDPROC\nENDMODULE",
    );
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [5, 6], "{found:?}");
}

#[test]
fn external_axes_that_are_carried_may_move_alone() {
    let text = format!(
        "MODULE A\nPROC main()\nMoveL {T},v10,z1,tool0;\nMoveExtJ [[0,0,0,0,0,0],[5,9E9,9E9,9E9,9E9,9E9]],vrot10,fine;\nMoveL {T},v20,z1,tool0;\nENDPROC\nENDMODULE"
    );
    let files = || vec![SourceFile::new("a.mod", text.as_str())];
    let mut options = ReadOptions::default();
    let refused = read_rapid(files(), &options).unwrap_err();
    assert!(
        refused[0].remedy.contains("external axes carried"),
        "{refused:?}"
    );
    options.external_axes = ExternalAxes::Carried;
    let program = read_rapid(files(), &options).unwrap();
    assert_eq!(program.motions.len(), 2);
    let written = write(&program, &[], &WriteOptions::default()).unwrap();
    assert_eq!(written[0].1, text.as_bytes());
}
