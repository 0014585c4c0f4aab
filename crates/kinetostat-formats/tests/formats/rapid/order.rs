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

use Runs::{Elsewhere, OnCondition, Once, Repeatedly};

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
fn a_routine_called_twice_begins_where_its_calls_agree() {
    let twice = "PROC main() move; part; move; part; ENDPROC PROC part() move; move; ENDPROC";
    let found = motions(twice);
    assert_eq!(
        found,
        [
            (1.0, Once, None),
            (3.0, Repeatedly, None),
            (4.0, Repeatedly, Some(3.0)),
            (2.0, Once, Some(4.0))
        ]
    );
    // Once from main through a routine without motions.
    let through = "PROC main() move; middle; ENDPROC PROC middle() part; ENDPROC PROC part() Set do1; move; ENDPROC";
    assert_eq!(motions(through)[1], (2.0, Once, Some(1.0)));
}

#[test]
fn branches_meet_only_where_they_agree() {
    let found = motions("PROC main() move; IF di=1 THEN move; ENDIF move; ENDPROC");
    assert_eq!(
        found,
        [
            (1.0, Once, None),
            (2.0, OnCondition, Some(1.0)),
            (3.0, Once, None)
        ]
    );
    let found =
        motions("PROC main() move; IF di=1 THEN Set do1; ELSE Reset do1; ENDIF move; ENDPROC");
    assert_eq!(found[1], (2.0, Once, Some(1.0)));
    let found =
        motions("PROC main() move; TEST n CASE 1: move; DEFAULT: move; ENDTEST move; ENDPROC");
    assert_eq!(
        found[2..],
        [(3.0, OnCondition, Some(1.0)), (4.0, Once, None)]
    );
    let found = motions("PROC main() move; IF di=1 RETURN; move; ENDPROC");
    assert_eq!(found[1], (2.0, OnCondition, Some(1.0)));
}

#[test]
fn loops_begin_at_an_unknown_place() {
    let found = motions("PROC main() move; FOR i FROM 1 TO 4 DO move; move; ENDFOR move; ENDPROC");
    let expected = [
        (1.0, Once, None),
        (2.0, Repeatedly, None),
        (3.0, Repeatedly, Some(2.0)),
        (4.0, Once, None),
    ];
    assert_eq!(found, expected);
    let found = motions("PROC main() move; WHILE di=0 DO WaitTime 1; ENDWHILE move; ENDPROC");
    assert_eq!(found[1], (2.0, Once, Some(1.0)));
}

#[test]
fn what_is_not_in_the_files_leaves_the_place_unknown() {
    assert_eq!(
        motions("PROC main() move; elsewhere; move; ENDPROC")[1],
        (2.0, Once, None)
    );
    let function = "FUNC num f() move; RETURN 1; ENDFUNC PROC main() move; n:=f(); move; ENDPROC";
    assert_eq!(
        motions(function),
        [(2.0, Once, None), (3.0, Once, None), (1.0, Elsewhere, None)]
    );
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
fn recursion_and_error_handlers_are_never_sure() {
    let found = motions("PROC main() part; ENDPROC PROC part() move; IF n<3 part; move; ENDPROC");
    assert_eq!(found, [(1.0, Repeatedly, None), (2.0, Repeatedly, None)]);
    let found = motions("PROC main() move; move; ERROR move; RETRY; ENDPROC");
    assert_eq!(
        found,
        [
            (1.0, Once, None),
            (2.0, Once, None),
            (3.0, OnCondition, None)
        ]
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
        (6, "`own` is in none of these files"),
    ];
    assert_eq!(found, expected);
}
