//! In which order motions run, how often, and where each begins.

use kinetostat_formats::*;

/// A module of routines whose motions go to X 1, 2, 3 in the order of the text.
fn motions(routines: &str) -> Vec<(f64, Runs, Option<f64>)> {
    let mut text = String::from("MODULE A\n");
    for (count, part) in routines.split("move;").enumerate() {
        if count > 0 {
            let target = format!("[[{count},0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
            text += &format!("MoveL {target},v10,z1,tool0;");
        }
        text += part;
    }
    let program = super::program(&(text + "\nENDMODULE"));
    let x = |motion: &Motion| motion.target.pose().unwrap().position_mm.x;
    let all = program.motions.iter();
    all.map(|motion| {
        (
            x(motion),
            motion.runs,
            motion.follows.map(|before| x(&program.motions[before])),
        )
    })
    .collect()
}

use Runs::{Elsewhere, Once, Repeatedly};

/// Where the motions go, in the order of the run.
fn places(routines: &str) -> Vec<f64> {
    motions(routines).iter().map(|(x, ..)| *x).collect()
}

#[test]
fn calls_are_followed_in_their_order() {
    let found = motions("PROC part() move; move; ENDPROC PROC main() move; part; move; ENDPROC");
    assert_eq!(
        found,
        [
            (3.0, Once, None),
            (1.0, Once, Some(3.0)),
            (2.0, Once, Some(1.0)),
            (4.0, Once, Some(2.0))
        ]
    );
}

#[test]
fn a_routine_runs_at_each_call() {
    let twice = "PROC main() move; part; move; part; ENDPROC PROC part() move; move; ENDPROC";
    assert_eq!(places(twice), [1.0, 3.0, 4.0, 2.0, 3.0, 4.0]);
    let runs: Vec<Runs> = motions(twice).iter().map(|(_, runs, _)| *runs).collect();
    assert_eq!(runs[..2], [Once, Repeatedly]);
    let through = "PROC main() move; middle; ENDPROC PROC middle() part; ENDPROC PROC part() Set do1; move; ENDPROC";
    assert_eq!(motions(through)[1], (2.0, Once, Some(1.0)));
    let recursive =
        "PROC main() part 1; ENDPROC PROC part(num n) move; IF n<3 part n+1; move; ENDPROC";
    assert_eq!(places(recursive), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
}

#[test]
fn branches_are_taken_by_their_values() {
    let found = |condition: &str| {
        places(&format!(
            "VAR num n:=2; VAR bool ok; PROC main() move; IF {condition} THEN move; ELSE move; ENDIF move; ENDPROC"
        ))
    };
    for (condition, taken) in [
        ("n=2", 2.0),
        ("n<>2", 3.0),
        ("NOT ok", 2.0),
        ("n>1 AND n<=2", 2.0),
        ("n DIV 2 = 1 AND 7 MOD 4 = 3", 2.0),
        ("ok OR (n-2)*3 >= 1", 3.0),
        ("ok XOR n*n=4", 2.0),
        ("Abs(-n)=2", 2.0),
        ("2+n*3=8", 2.0),
        ("-n+2=0", 2.0),
    ] {
        assert_eq!(found(condition), [1.0, taken, 4.0], "{condition}");
    }
    let cases = "VAR num n:=5; PROC main() TEST n CASE 1,2: move; CASE 4 TO 6: move; DEFAULT: move; ENDTEST ENDPROC";
    assert_eq!(places(cases), [2.0]);
    let default = cases.replace("n:=5", "n:=9");
    assert_eq!(places(&default), [3.0]);
    // A value that only the controller knows is passed over where its arms do nothing to the way.
    let open = "PROC main() move; IF di=1 THEN Set do1; ELSE Reset do1; ENDIF move; ENDPROC";
    assert_eq!(motions(open)[1], (2.0, Once, Some(1.0)));
    for open in [
        "IF di=1 THEN move; ENDIF",
        "IF di=1 RETURN;",
        "IF di=1 GOTO on;",
        "WHILE di=1 DO move; ENDWHILE",
        "FOR i FROM 1 TO di DO move; ENDFOR",
        "TEST di CASE 1: part; ENDTEST",
        "IF di=1 SingArea\\Wrist;",
    ] {
        let text = format!(
            "MODULE A\nPROC main()\n{open}\non:\nENDPROC\nPROC part()\nmove;\nENDPROC\nENDMODULE"
        )
        .replace(
            "move;",
            "MoveL [[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;",
        );
        let faults = read_rapid(
            vec![SourceFile::new("a.mod", text)],
            &ReadOptions::default(),
        )
        .unwrap_err();
        assert_eq!((faults.len(), faults[0].line), (1, 3), "{open}: {faults:?}");
        assert!(
            faults[0].reason.contains("no `di` is declared"),
            "{open}: {}",
            faults[0]
        );
    }
}

/// What an arm that may run assigns is not known behind it.
#[test]
fn values_behind_an_open_branch_are_not_known() {
    let text = "MODULE A\nVAR num n:=1;\nPROC main()\nIF di=1 n:=2;\nIF n=1 THEN\nMoveL [[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\nENDIF\nENDPROC\nENDMODULE";
    let faults = read_rapid(
        vec![SourceFile::new("a.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap_err();
    assert_eq!((faults.len(), faults[0].line), (1, 5), "{faults:?}");
    assert!(
        faults[0]
            .reason
            .contains("`n` is changed while the program runs (line 4)")
    );
}

#[test]
fn loops_run_as_often_as_they_say() {
    let found = places("PROC main() move; FOR i FROM 1 TO 3 DO move; move; ENDFOR move; ENDPROC");
    assert_eq!(found, [1.0, 2.0, 3.0, 2.0, 3.0, 2.0, 3.0, 4.0]);
    let down = "PROC main() FOR i FROM 3 TO 1 STEP -2 DO move; ENDFOR FOR i FROM 2 TO 1 STEP 1 DO move; ENDFOR ENDPROC";
    assert_eq!(places(down), [1.0, 1.0]);
    let counted = "VAR num n; PROC main() WHILE n<2 DO Incr n; move; ENDWHILE ENDPROC";
    assert_eq!(places(counted), [1.0, 1.0]);
    let found = motions("PROC main() move; WHILE di=0 DO WaitTime 1; ENDWHILE move; ENDPROC");
    assert_eq!(found[1], (2.0, Once, Some(1.0)));
    // A program that never ends is read for one pass, and one that ends too late is refused.
    let endless = "PROC main() WHILE TRUE DO move; ENDWHILE ENDPROC";
    assert_eq!(places(endless), [1.0]);
    let text =
        "MODULE A\nVAR num n;\nPROC main()\nWHILE n<1 DO\nn:=0;\nENDWHILE\nENDPROC\nENDMODULE";
    let faults = read_rapid(
        vec![SourceFile::new("a.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap_err();
    assert!(
        faults[0].reason.contains("more than 1 million statements"),
        "{}",
        faults[0]
    );
}

#[test]
fn what_is_not_in_the_files_is_taken_not_to_move() {
    let outside = "PROC main() move; elsewhere; move; ENDPROC";
    assert_eq!(motions(outside)[1], (2.0, Once, Some(1.0)));
    let computed = "PROC main() move; %name%; move; ENDPROC";
    assert_eq!(motions(computed)[1], (2.0, Once, None));
    let function = "FUNC num f() move; RETURN 1; ENDFUNC PROC main() move; n:=f(); move; ENDPROC";
    assert_eq!(places(function), [2.0, 1.0, 3.0]);
}

#[test]
fn what_nothing_calls_comes_last() {
    let found = motions("PROC other() move; move; ENDPROC PROC main() move; ENDPROC");
    assert_eq!(
        found,
        [
            (3.0, Once, None),
            (1.0, Elsewhere, None),
            (2.0, Elsewhere, Some(1.0))
        ]
    );
}

#[test]
fn error_handlers_do_not_run() {
    let program = super::main_with(
        "",
        &format!(
            "{0}\nERROR\n{0}\nRETRY;",
            "MoveL [[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;"
        ),
    );
    assert_eq!(program.motions.len(), 1);
    assert_eq!(program.findings.len(), 1);
    let said = &program.findings[0];
    assert!(
        said.line == 6
            && said
                .message
                .contains("does not come to the motions on line 6"),
        "{said:?}"
    );
}

#[test]
fn deep_nesting_of_calls_is_refused_with_its_line() {
    let mut text = String::from("MODULE A\nPROC main()\n p0;\nENDPROC\n");
    for index in 0..300 {
        text += &format!("PROC p{index}()\n p{};\nENDPROC\n", index + 1);
    }
    let files = vec![SourceFile::new(
        "a.mod",
        text + "PROC p300()\nENDPROC\nENDMODULE",
    )];
    let errors = read_rapid(files, &ReadOptions::default()).unwrap_err();
    assert!(
        errors[0].reason.contains("nested deeper"),
        "{:?}",
        errors[0]
    );
}

#[test]
fn what_changes_speeds_and_loads_is_said() {
    let text = "MODULE A\nPROC main()\nvelset 50,800;\nGripLoad piece;\nTPErase;\nown 3;\nENDPROC\nENDMODULE";
    let program = super::program(text);
    let found: Vec<(usize, &str)> = (program.findings.iter())
        .map(|finding| (finding.line, finding.message.split(':').next().unwrap()))
        .collect();
    let expected = [
        (3, "VelSet changes the speeds behind it"),
        (
            4,
            "GripLoad changes the load that the controller reckons with",
        ),
        (6, "`own` is in none of the files"),
    ];
    assert_eq!(found, expected);
}

/// What is in none of the files is taken not to move the tool; what the run computes may be any routine.
#[test]
fn calls_of_what_is_nowhere_keep_the_place() {
    let text = "PROC main() move; SpindleOn 12000; move; x:=half(2); move; %\"part\"%; move; ENDPROC FUNC num half(num n) CoolOn; RETURN n/2; ENDFUNC";
    assert_eq!(
        motions(text),
        [
            (1.0, Once, None),
            (2.0, Once, Some(1.0)),
            (3.0, Once, Some(2.0)),
            (4.0, Once, None)
        ]
    );
    let files = || {
        let text = "MODULE A\nPROC main()\nSpindleOn 12000;\nENDPROC\nENDMODULE";
        vec![SourceFile::new("a.mod", text)]
    };
    let mut options = ReadOptions::default();
    assert!(read_rapid(files(), &options).is_ok());
    options.moving_calls = ["spindleon".to_owned()].into();
    let errors = read_rapid(files(), &options).unwrap_err();
    assert_eq!((errors.len(), errors[0].line), (1, 3), "{errors:?}");
    assert!(errors[0].reason.contains("moves the tool"), "{errors:?}");
}

/// What a refuter found that was read otherwise than a controller runs it.
#[test]
fn switches_waits_and_results_are_those_of_the_controller() {
    let switch = "PROC main() p\\s; p; ENDPROC PROC p(\\switch s) IF Present(s) THEN move; ELSE move; ENDIF ENDPROC";
    assert_eq!(places(switch), [1.0, 2.0]);
    // Behind a loop that never ends nothing runs.
    assert!(places("PROC main() WHILE TRUE DO ENDWHILE move; ENDPROC").is_empty());
    // Numbers have single precision: 0.1 ten times is more than 1.
    let tenths = "PROC main() FOR k FROM 0 TO 1 STEP 0.1 DO move; ENDFOR ENDPROC";
    assert_eq!(places(tenths).len(), 10);
    assert_eq!(places("PROC main() IF 0.1+0.2=0.3 move; ENDPROC").len(), 1);
    // The variable of a loop hides data of its name, and they are there again behind it.
    let hidden = "VAR num i:=7; PROC main() FOR i FROM 1 TO 2 DO move; ENDFOR IF i=7 move; ENDPROC";
    assert_eq!(places(hidden), [1.0, 1.0, 2.0]);
}

/// The module with statements of `main`, read with a value of `di1`.
fn read_main(
    main: &str,
    routines: &str,
    di1: Option<f64>,
) -> Result<RobotProgram, Vec<ProgramError>> {
    let target = "[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let text = format!(
        "MODULE A\nCONST robtarget p:={target};\nVAR num x:=5;\nVAR bool b;\nPROC main()\n{main}\nENDPROC\n{routines}\nENDMODULE"
    );
    let mut options = ReadOptions::default();
    let values = di1.map(|value| ("di1".to_owned(), StatedValue::Number(value)));
    options.values.extend(values);
    read_rapid(vec![SourceFile::new("a.mod", text)], &options)
}

#[test]
fn what_routines_and_waits_change_is_not_decided_here() {
    let to_x = "MoveL Offs(p,x,0,0),v10,z1,tool0;";
    let sub = "PROC sub()\ninner;\nENDPROC\nPROC inner()\nx:=x+3;\nENDPROC";
    for (main, routines) in [
        (format!("IF di1=1 sub;\n{to_x}"), sub),
        (format!("WHILE di1=1 DO\nsub;\nENDWHILE\n{to_x}"), sub),
        (
            format!("WaitDI di1,1\\MaxTime:=1\\TimeFlag:=b;\nIF b THEN\n{to_x}\nENDIF"),
            "",
        ),
        (format!("WaitUntil b;\nIF b THEN\n{to_x}\nENDIF"), ""),
        (format!("IF DInput(di1)=1 THEN\n{to_x}\nENDIF"), ""),
    ] {
        let faults = read_main(&main, routines, None).unwrap_err();
        assert_eq!(faults.len(), 1, "{main}: {faults:?}");
    }
    let program = read_main(
        &format!("IF DInput(di1)=1 THEN\n{to_x}\nENDIF"),
        "",
        Some(1.0),
    );
    assert_eq!(program.unwrap().motions.len(), 1);
}

#[test]
fn a_function_in_a_motion_runs_once() {
    let to = "MoveL Offs(p,f(),0,0),v10,z1,tool0;";
    let function = "FUNC num f()\nx:=x+1;\nRETURN x;\nENDFUNC";
    let program = read_main(&format!("{to}\n{to}\nIF x=7 {to}"), function, None).unwrap();
    let x = |motion: &Motion| motion.target.pose().unwrap().position_mm.x;
    let all: Vec<f64> = program.motions.iter().map(x).collect();
    assert_eq!(all, [6.0, 7.0, 8.0]);
}

/// A target that a routine is given is not written as that of one call where other code calls it too.
#[test]
fn a_routine_that_an_interrupt_calls_too_keeps_its_targets() {
    let routine = "PROC go(robtarget t)\nMoveL t,v10,z1,tool0;\nENDPROC";
    let trap = "TRAP alarm\ngo Offs(p,9,0,0);\nENDTRAP";
    for (others, is_fixed) in [("", false), (trap, true)] {
        let program =
            read_main("go Offs(p,1,0,0);", &format!("{routine}\n{others}"), None).unwrap();
        let piece = Piece::to(0, nalgebra::Vector3::new(1.0, 0.0, 0.1));
        let written = write(&program, &[piece], &WriteOptions::default());
        let said = written.map_or_else(|error| error.to_string(), |_| String::new());
        let expected = said.contains("called by code that does not run here");
        assert_eq!(expected, is_fixed, "{others}: {said}");
    }
}
