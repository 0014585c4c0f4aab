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
            (2.0, Runs::Repeatedly, Some(0)),
            (3.0, Runs::Once, Some(1)),
            (4.0, Runs::Once, Some(2)),
            (2.0, Runs::Repeatedly, Some(3)),
            (9.0, Runs::Elsewhere, None),
        ]
    );
}

#[test]
fn branches_and_loops_run() {
    let text = format!(
        "DEF main()\nINT i,n\n{}IF $IN[1] THEN\n{}ENDIF\n{}FOR i=1 TO 2\n{}ENDFOR\nn=4-2\nSWITCH n\nCASE 1,3\n{}CASE 2\n{}ENDSWITCH\nREPEAT\nn=n+1\n{}UNTIL n>=4\n{}LOOP\nn=n+1\nIF n==9 THEN\nEXIT\nENDIF\nENDLOOP\nEND",
        to(1),
        to(2),
        to(3),
        to(4),
        to(5),
        to(6),
        to(7),
        to(8)
    );
    let mut options = ReadOptions::default();
    options
        .values
        .insert("$IN[1]".to_owned(), StatedValue::Truth(true));
    let program = read_krl(vec![SourceFile::new("main.src", text)], &options).unwrap();
    use Runs::{Once, Repeatedly};
    assert_eq!(
        order(&program),
        [
            (1.0, Once, None),
            (2.0, Once, Some(0)),
            (3.0, Once, Some(1)),
            (4.0, Repeatedly, Some(2)),
            (4.0, Repeatedly, Some(3)),
            (6.0, Once, Some(4)),
            (7.0, Repeatedly, Some(5)),
            (7.0, Repeatedly, Some(6)),
            (8.0, Once, Some(7)),
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
    let files = vec![SourceFile::new("main.src", text)];
    let refused = read_krl(files, &ReadOptions::default()).unwrap_err();
    assert!(
        refused[0].reason.contains("nested deeper than 200"),
        "{refused:?}"
    );
    let deep = format!(
        "DEF main()\n{}{}{}END\n",
        "IF TRUE THEN\n".repeat(99),
        to(1),
        "ENDIF\n".repeat(99)
    );
    assert_eq!(read_all(&[("main.src", &deep)]).motions.len(), 1);
}
