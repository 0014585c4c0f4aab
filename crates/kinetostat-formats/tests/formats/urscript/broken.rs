//! Programs that are refused: line, what is said, and all of it in one run; and bounds.

use kinetostat_formats::*;

use super::{errors, program, read_text};

#[test]
fn statements_that_move_the_tool_otherwise_are_refused_by_line() {
    let cases = [
        (
            "speedl([0,0,0.1,0,0,0],0.5,1)",
            "on a way that only the run decides",
        ),
        (
            "servoj([0,0,0,0,0,0],0,0,0.002,0.1,300)",
            "on a way that only the run decides",
        ),
        (
            "force_mode(p[0,0,0,0,0,0],[0,0,1,0,0,0],[0,0,9,0,0,0],2,[1,1,1,1,1,1])",
            "off the programmed path",
        ),
        ("freedrive_mode()", "off the programmed path"),
        (
            "track_conveyor_linear(p[1,0,0,0,0,0],500)",
            "moves with the conveyor",
        ),
        (
            "movel([0,0,0,0,0,0])",
            "which pose they give is not known; write the end as a pose",
        ),
        ("movel()", "movel needs POSE"),
        ("movel(P9)", "no `P9` is declared"),
        ("movel(p[0.1,0.2,0.3,0,0])", "no `p` is declared"),
        ("movel(0.5)", "`0.5` is no pose"),
        (
            "movel(get_inverse_kin(p[0.1,0,0,0,0,0],[0,0,0,0,0,0],0.001,0.001,tcp=p[0,0,0.1,0,0,0]))",
            "`get_inverse_kin` is computed",
        ),
        (
            "movej(get_inverse_kin(p[0.1,0,0,0,0,0], tcp=p[0,0,0.3,0,0,0]))",
            "`get_inverse_kin` is computed",
        ),
        (
            "movec(p[0.1,0,0,0,0,0],p[0.2,0,0,0,0,0],a=1,v=0.1,r=0,mode=1)",
            "turns with the path (mode=1)",
        ),
        (
            "movec(pose_trans(f,p[0.1,0,0,0,0,0]),p[0.2,0,0,0,0,0])",
            "are in two frames",
        ),
        (
            "thread t():\n movel(p[0.1,0,0,0,0,0])\nend",
            "the thread moves the tool",
        ),
        ("x = 1\nX = 2", "the same letters"),
        (
            "set_tcp(p[0,0,0.1,0,0,0]",
            "a bracket of the statement is not closed",
        ),
        ("textmsg(\"a)", "the text is not closed on its line"),
        ("if True\nend", "nothing ends the header; end it with :"),
        ("movel", "no statement is written so"),
        (
            "movel(p[0.1,0,0,0,0,0], p[0,0,0,0,0,0], 1.2, 0.02)",
            "`p[0,0,0,0,0,0]` is no number",
        ),
        (
            "movel(p[0.1,0,0,0,0,0], a=1.2, v=0.0while 2)",
            "`0.0while 2` is no expression",
        ),
        ("movel(p[0.1,0,0,0,0,0]) a", "no statement is written so"),
        (
            "a_name_that_is_far_too_long_for_this_reader_and_for_everybody_else = 1",
            "at most 64 characters",
        ),
        (
            "movel(p[0.1,0,0,0,0,0]) # over 7/2\nmovel(p[7/0,0,0,0,0,0])",
            "it divides by zero",
        ),
    ];
    for (statement, said) in cases {
        let found = errors(statement);
        assert!(
            found.iter().any(|(_, text)| text.contains(said)),
            "{statement}: {found:?}"
        );
        assert!(
            found.iter().all(|(line, _)| (2..=4).contains(line)),
            "{statement}: {found:?}"
        );
    }
}

#[test]
fn ends_that_are_missing_or_too_many_are_refused() {
    let whole = |text: &str| {
        let found = read_text(text, &ReadOptions::default()).unwrap_err();
        (found[0].line, found[0].reason.clone())
    };
    assert_eq!(
        whole("def a():\nmovel(p[1,0,0,0,0,0])\n"),
        (1, "no `end` ends it".to_owned())
    );
    assert_eq!(
        whole("def a():\nend\nend\nmovel(p[1,0,0,0,0,0])\n"),
        (3, "nothing is open that it ends".to_owned())
    );
    let loops = whole("def a():\nwhile True:\nmovel(p[1,0,0,0,0,0])\nend\n");
    assert_eq!(loops, (1, "no `end` ends it".to_owned()));
    let scope = whole("def a():\nglobal");
    assert_eq!(scope, (1, "no `end` ends it".to_owned()));
}

#[test]
fn loops_calls_and_nesting_end() {
    let hang = "def a():\ni=0\nwhile i<2:\ni=i+0\nend\nmovel(p[1,0,0,0,0,0])\nend";
    let found = read_text(hang, &ReadOptions::default()).unwrap_err();
    assert!(
        found[0]
            .to_string()
            .contains("more than 1 million statements"),
        "{}",
        found[0]
    );
    let many = "def a():\ni=0\nwhile i<300000:\ni=i+1\nmovel(p[1,0,0,0,0,0])\nend\nend";
    let found = read_text(many, &ReadOptions::default()).unwrap_err();
    assert!(
        found[0].to_string().contains("more than 200000 motions"),
        "{}",
        found[0]
    );
    let calls = "def a():\ndef b(n):\nb(n+1)\nend\nb(0)\nend";
    let found = read_text(calls, &ReadOptions::default()).unwrap_err();
    assert!(
        found[0].to_string().contains("nested deeper than 200"),
        "{}",
        found[0]
    );
    for open in [
        "if True:\n",
        "while True:\n",
        "def f():\n",
        "x=(",
        "x=[",
        "movel(",
        "p[",
        "\"",
        "x=-",
    ] {
        let text = format!("def a():\n{}", open.repeat(20_000));
        assert!(read_text(&text, &ReadOptions::default()).is_err(), "{open}");
    }
    // A loop without an end is read for one pass.
    let endless =
        program("def a():\nwhile True:\nmovel(p[1,0,0,0,0,0])\nmovel(p[2,0,0,0,0,0])\nend\nend");
    assert_eq!(endless.motions.len(), 2);
}

/// Forms of programs that are not read say what to export.
#[test]
fn other_forms_of_programs_are_refused_in_words() {
    for (name, words) in [("part.urp", ".script"), ("PART.TP", ".ls")] {
        let said = odd_program(name, &[0x1f, 0x8b, 8, 0]).unwrap();
        assert!(said.contains(words) && said.contains("not read"), "{said}");
        assert_eq!(language_of(name, &[0x1f, 0x8b]), None);
    }
}
