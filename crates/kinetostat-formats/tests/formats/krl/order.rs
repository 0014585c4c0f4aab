//! In which order motions run, and how often.

use kinetostat_formats::*;

fn read_all(files: &[(&str, &str)]) -> RobotProgram {
    let files = files
        .iter()
        .map(|(name, text)| SourceFile::new(*name, *text))
        .collect();
    read_krl(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

/// X of the ends, how often, and which motion each follows.
fn order(program: &RobotProgram) -> Vec<(f64, Runs, Option<usize>)> {
    let x = |motion: &Motion| motion.target.pose().unwrap().position_mm.x;
    program
        .motions
        .iter()
        .map(|motion| (x(motion), motion.runs, motion.follows))
        .collect()
}

fn to(x: usize) -> String {
    format!("LIN {{X {x},Y 0,Z 0,A 0,B 0,C 0}}\n")
}

#[test]
fn routines_are_followed_in_the_order_of_their_calls() {
    let main = format!(
        "&ACCESS RVP\nDEF main()\n{}first()\n{}other()\nFirst ( )\nEND\nDEF first()\n{}END\nDEF never()\n{}END\n",
        to(1),
        to(3),
        to(2),
        to(9)
    );
    let other = format!("DEF other()\n{}END\nGLOBAL DEF far()\nEND\n", to(4));
    let program = read_all(&[("other.src", &other), ("main.src", &main)]);
    assert_eq!(
        order(&program),
        [
            (1.0, Runs::Once, None),
            (2.0, Runs::Repeatedly, None),
            (3.0, Runs::Once, Some(1)),
            (4.0, Runs::Once, Some(2)),
            (9.0, Runs::Elsewhere, None),
        ]
    );
}

#[test]
fn branches_and_loops_are_noted() {
    let text = format!(
        "DEF main()\n{}IF $IN[1] THEN\n{}ENDIF\n{}FOR i=1 TO 3\n{}ENDFOR\nSWITCH n\nCASE 1\n{}DEFAULT\n{}ENDSWITCH\nREPEAT\n{}UNTIL FALSE\n{}END",
        to(1),
        to(2),
        to(3),
        to(4),
        to(5),
        to(6),
        to(7),
        to(8)
    );
    let program = read_all(&[("main.src", &text)]);
    use Runs::{OnCondition, Once, Repeatedly};
    assert_eq!(
        order(&program),
        [
            (1.0, Once, None),
            (2.0, OnCondition, Some(0)),
            (3.0, Once, None),
            (4.0, Repeatedly, None),
            (5.0, OnCondition, None),
            (6.0, OnCondition, None),
            (7.0, Repeatedly, None),
            (8.0, Once, Some(6)),
        ]
    );
}

#[test]
fn calls_that_are_not_in_the_files_are_carried_with_a_finding() {
    let text = format!(
        "DEF main()\n{}gripper(1)\n{}x=grip()+1\n{}END",
        to(1),
        to(2),
        to(3)
    );
    let program = read_all(&[("main.src", &text)]);
    // They are taken not to move the tool.
    assert_eq!(order(&program)[1].2, Some(0));
    let found: Vec<(usize, &str)> = program
        .findings
        .iter()
        .map(|finding| (finding.line, finding.message.as_str()))
        .collect();
    assert!(
        found.iter().any(|(line, message)| *line == 3
            && message.starts_with("`gripper` is in none of the files"))
    );
    assert!(
        found
            .iter()
            .any(|(line, message)| *line == 5 && message.starts_with("`grip`"))
    );
}

#[test]
fn what_cannot_move_the_tool_keeps_the_place() {
    let carried = "$OUT[1]=TRUE\nWAIT SEC 0.5\nWAIT FOR $IN[2]\nPULSE($OUT[1],TRUE,0.5)\nx=ABS(3)+half(2)\nMsgNotify(\"x\")\nHALT\nCONTINUE\nmark()\n";
    let text = format!(
        "DEF main()\n{}{carried}{}END\nDEF mark()\n$OUT[2]=FALSE\nEND\nDEFFCT INT half(n :IN)\nINT n\nRETURN n/2\nENDFCT",
        to(1),
        to(2)
    );
    assert_eq!(order(&read_all(&[("main.src", &text)]))[1].2, Some(0));
}

#[test]
fn deep_and_recursive_calls_end() {
    let mut text = format!("DEF main()\nr0()\nEND\nDEF back()\nback()\n{}END\n", to(1));
    for routine in 0..150 {
        text += &format!(
            "DEF r{routine}()\nr{}()\nr{}()\nback()\nEND\n",
            routine + 1,
            routine + 1
        );
    }
    text += &format!("DEF r150()\n{}END\n", to(2));
    let program = read_all(&[("main.src", &text)]);
    assert_eq!(program.motions.len(), 2);
    assert!(
        program
            .motions
            .iter()
            .all(|motion| motion.runs == Runs::Repeatedly)
    );
    let deep = format!(
        "DEF main()\n{}{}{}END\n",
        "IF x THEN\n".repeat(99),
        to(1),
        "ENDIF\n".repeat(99)
    );
    assert_eq!(read_all(&[("main.src", &deep)]).motions.len(), 1);
}
