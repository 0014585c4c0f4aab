//! GOTO.

use kinetostat_formats::*;

use super::main_with;

fn to(x: u32) -> String {
    format!("MoveL [[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;")
}

fn runs(statements: &str) -> Vec<(Runs, Option<usize>)> {
    let program = main_with("VAR num n;", statements);
    let motions = program.motions.iter();
    motions
        .map(|motion| (motion.runs, motion.follows))
        .collect()
}

#[test]
fn jumps_forward_are_followed() {
    use Runs::{Elsewhere, OnCondition, Once, Repeatedly};
    let [a, b, c, d] = [1, 2, 3, 4].map(to);
    for (statements, wanted) in [
        // Passed by.
        (
            format!("{a}\nGOTO on;\n{b}\non:\n{c}"),
            vec![(Once, None), (Elsewhere, None), (Once, Some(0))],
        ),
        (
            format!("{a}\nGOTO on;\nSetDO x,1;\non:\n{b}\n{c}"),
            vec![(Once, None), (Once, Some(0)), (Once, Some(1))],
        ),
        // A branch to a label.
        (
            format!("{a}\nIF n=1 GOTO on;\n{b}\non:\n{c}\n{d}"),
            vec![
                (Once, None),
                (OnCondition, Some(0)),
                (Once, None),
                (Once, Some(2)),
            ],
        ),
        (
            format!("{a}\nIF n=1 GOTO on;\nSetDO x,1;\non:\n{c}"),
            vec![(Once, None), (Once, Some(0))],
        ),
        // Two labels, one within what the other jump leaves out.
        (
            format!("{a}\nIF n=1 GOTO one;\nGOTO two;\none:\n{b}\ntwo:\n{c}"),
            vec![(Once, None), (OnCondition, Some(0)), (Once, None)],
        ),
        // Out of a loop, and out of a branch with more statements.
        (
            format!(
                "{a}\nFOR i FROM 1 TO 3 DO\nIF n=i THEN\nGOTO on;\nENDIF\n{b}\nENDFOR\n{c}\non:\n{d}"
            ),
            vec![
                (Once, None),
                (Repeatedly, None),
                (OnCondition, None),
                (Once, None),
            ],
        ),
        // Backward, and to nowhere: the order is not that of the lines.
        (
            format!("{a}\nback:\n{b}\nIF n=1 GOTO back;\n{c}"),
            vec![(Repeatedly, None); 3],
        ),
        (
            format!("{a}\nGOTO nowhere;\n{b}"),
            vec![(Repeatedly, None); 2],
        ),
    ] {
        assert_eq!(runs(&statements), wanted, "{statements}");
    }
}

/// What a jump leaves out calls nothing, and returns from nothing.
#[test]
fn what_is_left_out_does_nothing() {
    let [a, b, c] = [1, 2, 3].map(to);
    let statements =
        format!("{a}\nGOTO on;\nsub;\nRETURN;\nEXIT;\non:\nsub;\n{b}\nENDPROC\nPROC sub()\n{c}");
    assert_eq!(
        runs(&statements),
        [
            (Runs::Once, None),
            (Runs::Once, Some(0)),
            (Runs::Once, Some(1))
        ]
    );
}

#[test]
fn conversions_follow_jumps_and_name_what_is_left_out() {
    let [a, b, c] = [1, 2, 3].map(to);
    let made = |statements: &str| {
        let program = main_with("VAR num n;", statements);
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl)
    };
    let krl = made(&format!("{a}\nIF n=1 GOTO on;\nSetDO x,1;\non:\n{c}")).unwrap();
    let text = String::from_utf8(krl.files[0].1.clone()).unwrap();
    assert!(text.contains("LIN {X 3.000000"), "{text}");
    let faults = made(&format!("{a}\nGOTO on;\n{b}\non:\n{c}")).unwrap_err();
    assert_eq!(faults.len(), 1);
    assert!(
        faults[0].to_string().starts_with("line 6: nothing in these files leads to this motion: it never runs (its routine is not called, a jump leaves it out"),
        "{}", faults[0]
    );
}
