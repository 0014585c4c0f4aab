//! Broken programs: each message names the line, what stands there, what is wrong with it and what to do.

use super::refused;

/// Program, line, what is found, a part of the reason, a part of the remedy.
const BROKEN: &[(&str, usize, &str, &str, &str)] = &[
    (
        "G21\nO1 sub\nG0 X1\nO1 call\n",
        2,
        "O1 sub",
        "endsub",
        "needs its end",
    ),
    (
        "G21\nO1 endsub\n",
        2,
        "O1 endsub",
        "was not called",
        "call it",
    ),
    (
        "G21\nO<x> call\n",
        2,
        "O<x> call",
        "no subprogram 'x'",
        "folder",
    ),
    (
        "G21\nO1 if [1]\nG0 X1 Y1 Z1\n#1=0\nO1 elseif [1]\n",
        5,
        "O1 elseif [1]",
        "endif",
        "needs its end",
    ),
    (
        "G21\nO1 while [0]\nG0 X1\n",
        2,
        "O1 while [0]",
        "endwhile",
        "needs its end",
    ),
    ("G21\nO1 endwhile\n", 2, "O1 endwhile", "", ""),
    ("G21\nO1 break\n", 2, "O1 break", "", ""),
    (
        "G21\nO1 repeat [2]\nG0 X1 Y1 Z1\n",
        2,
        "O1 repeat [2]",
        "does not end",
        "endrepeat",
    ),
    (
        "G21\nM98 P77\n",
        2,
        "M98 P77",
        "no subprogram O77",
        "folder",
    ),
    (
        "G21\nG0 X0 Y0 Z9 F100\nG98 G82 X1 Z-1 R1 P-1\n",
        3,
        "G98 G82 X1 Z-1 R1 P-1",
        "the dwell of the cycle G82 is below zero (P-1)",
        "zero or more",
    ),
    (
        "G21\nG0 X0 Y0 Z9 F100\nG4 P-2\n",
        3,
        "G4 P-2",
        "a dwell (G4) of P-2 is below zero",
        "zero or more",
    ),
    ("G21\nM98\n", 2, "M98", "calls no subprogram", "P1000"),
    ("G21\nM98 P1 L1.5\n", 2, "M98 P1 L1.5", "whole number", "L"),
    (
        "G21\nG0 X[1/0]\n",
        2,
        "G0 X[1/0]",
        "division by zero",
        "expression",
    ),
    (
        "G21\nG0 X[SQRT[-1]]\n",
        2,
        "G0 X[SQRT[-1]]",
        "SQRT",
        "expression",
    ),
    (
        "G21\nG0 X#<none>\n",
        2,
        "G0 X#<none>",
        "#<none> has no value",
        "expression",
    ),
    (
        "G21\nG0 X#6000\n",
        2,
        "G0 X#6000",
        "no parameter",
        "expression",
    ),
    (
        "G21\n#5420=1\n",
        2,
        "#5420=1",
        "kept by the controller",
        "G10",
    ),
    ("G21\nG0 X[1+2\n", 2, "G0 X[1+2", "", "LinuxCNC or Fanuc"),
    ("G21\nG0 X[1 2]\n", 2, "G0 X[1 2]", "", "LinuxCNC or Fanuc"),
    ("G21\nGOTO 5\n", 2, "GOTO 5", "no block N5", "number"),
    (
        "G21\nWHILE [0] DO1\nG0 X1\n",
        2,
        "WHILE [0] DO1",
        "END1",
        "",
    ),
    ("G21\nEND2\n", 2, "END2", "DO2", ""),
    (
        "G21\nG0 X0 Y0 Z5\nG98 G81 X1 R1\n",
        3,
        "G98 G81 X1 R1",
        "no depth",
        "first block",
    ),
    (
        "G21\nG0 X0 Y0 Z5\nG98 G83 X1 Z-1 R1\n",
        3,
        "G98 G83 X1 Z-1 R1",
        "(Q)",
        "write Q",
    ),
    (
        "G21\nG98 G81 X1 Z-1 R1\n",
        2,
        "G98 G81 X1 Z-1 R1",
        "not known",
        "state X, Y and Z",
    ),
    ("G21 G91\nG0 @3\n", 2, "G0 @3", "not known", "state X and Y"),
    ("G21\nM72\n", 2, "M72", "no M70 or M73", "write M70"),
    (
        "G21\nG0 X0 Y0 Z0\nG33 Z-1 K1\n",
        3,
        "G33 Z-1 K1",
        "tied to the spindle",
        "threads",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG71 P1 Q2\n",
        3,
        "G71 P1 Q2",
        "cycle",
        "CAM",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG38.2 Z-5\n",
        3,
        "G38.2 Z-5",
        "probe answers",
        "run it by hand",
    ),
];

#[test]
fn broken_programs_have_messages_that_help() {
    assert!(BROKEN.len() >= 20);
    let mut wrong = Vec::new();
    for (text, line, found, reason, remedy) in BROKEN {
        let error = refused(text);
        // All of it stands in the text that is shown.
        let shown = error.to_string();
        let start = format!("line {line}: `{found}`: ");
        let holds = shown.starts_with(&start)
            && [error.reason.as_str(), error.remedy.as_str()]
                .iter()
                .all(|part| !part.is_empty() && shown.contains(part))
            && error.reason.contains(reason)
            && error.remedy.contains(remedy);
        if !holds {
            wrong.push(format!("{text:?}: {shown}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
