//! GOTO.

use kinetostat_formats::*;

use super::main_with;

fn to(x: u32) -> String {
    format!("MoveL [[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;")
}

/// Where the motions go, in the order of the run.
fn places(statements: &str) -> Vec<f64> {
    let program = main_with("VAR num n;", statements);
    let motions = program.motions.iter();
    motions
        .map(|motion| motion.target.pose().unwrap().position_mm.x)
        .collect()
}

#[test]
fn jumps_are_followed() {
    let [a, b, c, d] = [1, 2, 3, 4].map(to);
    for (statements, wanted) in [
        (format!("{a}\nGOTO on;\n{b}\non:\n{c}"), vec![1.0, 3.0]),
        (
            format!("{a}\nIF n=1 GOTO on;\n{b}\non:\n{c}\n{d}"),
            vec![1.0, 2.0, 3.0, 4.0],
        ),
        // Out of a loop, and out of a branch with more statements.
        (
            format!(
                "{a}\nFOR i FROM 1 TO 3 DO\nIF i=2 THEN\nGOTO on;\nENDIF\n{b}\nENDFOR\n{c}\non:\n{d}"
            ),
            vec![1.0, 2.0, 4.0],
        ),
        // Backward.
        (
            format!("{a}\nback:\n{b}\nIncr n;\nIF n<3 GOTO back;\n{c}"),
            vec![1.0, 2.0, 2.0, 2.0, 3.0],
        ),
        // What a jump passes by calls nothing and ends nothing.
        (
            format!(
                "{a}\nGOTO on;\nsub;\nRETURN;\nEXIT;\non:\nsub;\n{b}\nENDPROC\nPROC sub()\n{c}"
            ),
            vec![1.0, 3.0, 2.0],
        ),
    ] {
        assert_eq!(places(&statements), wanted, "{statements}");
    }
    let nowhere = format!("MODULE A\nPROC main()\nGOTO nowhere;\n{a}\nENDPROC\nENDMODULE");
    let files = vec![SourceFile::new("a.mod", nowhere)];
    let faults = read_rapid(files, &ReadOptions::default()).unwrap_err();
    assert!(
        faults[0].line == 3 && faults[0].reason.contains("no label"),
        "{faults:?}"
    );
}

#[test]
fn conversions_follow_jumps() {
    let [a, b, c] = [1, 2, 3].map(to);
    let program = main_with("VAR num n;", &format!("{a}\nGOTO on;\n{b}\non:\n{c}"));
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let made = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl).unwrap();
    let text = String::from_utf8(made.files[0].1.clone()).unwrap();
    assert!(
        text.contains("LIN {X 3.000000") && !text.contains("LIN {X 2.000000"),
        "{text}"
    );
    let said = program
        .findings
        .iter()
        .any(|finding| finding.message.contains("motions on line 6"));
    assert!(said, "{:?}", program.findings);
}
