//! Grammar of URScript statements and expressions.

use crate::interpreter::declared::Around;
use crate::interpreter::ends::PoseForm;
use crate::interpreter::expression::Operator;
use crate::interpreter::lexing::Marks;
use crate::interpreter::reading::Grammar;
use crate::interpreter::tree::RoutineKind;
use crate::interpreter::words::Words;
use crate::model::orientation::OrientationText;

/// Members of a pose, in the order in which `p[x,y,z,rx,ry,rz]` has them.
pub(super) const MEMBERS: [&str; 6] = ["X", "Y", "Z", "RX", "RY", "RZ"];

/// Source: the script manual, Flow of control, Threads, Scoping rules.
pub(super) const WORDS: Words = Words {
    // `$ 2 "MoveL"`: by such lines the pendant knows its nodes.
    marks: Marks {
        comment: b'#',
        aside: b'$',
    },
    routines: &[
        ("def", RoutineKind::Procedure),
        ("sec", RoutineKind::Procedure),
        ("thread", RoutineKind::Trap),
    ],
    branch: ["if", "elif", "else"],
    repeat: "while",
    end: "end",
    colon: b':',
    scopes: ["global", "local"],
    leaves: ["return", "break", "continue", "halt"],
    plain: &["run", "join", "kill", "enter_critical", "exit_critical"],
    nothing: "pass",
};

/// Source: the script manual, Numbers, variables, and types.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("or", Operator::Or, 0),
        ("xor", Operator::Xor, 0),
        ("and", Operator::And, 1),
        ("==", Operator::Equal, 2),
        ("!=", Operator::Unequal, 2),
        ("<=", Operator::LessOrEqual, 2),
        (">=", Operator::GreaterOrEqual, 2),
        ("<", Operator::Less, 2),
        (">", Operator::Greater, 2),
        ("+", Operator::Plus, 3),
        ("-", Operator::Minus, 3),
        ("*", Operator::Times, 4),
        ("/", Operator::Over, 4),
        ("%", Operator::Remainder, 4),
    ],
    not: 2,
    sign: 5,
    index: [b'[', b']'],
    list: Some([b'[', b']']),
    has_members: false,
    names_arguments: true,
    counts_from_one: false,
    truths: ["False", "True"],
    aggregate: Some(("p", &MEMBERS)),
    separates_comparisons: false,
};

/// Form of poses.
pub(super) const FORM: PoseForm = PoseForm {
    unit_mm: 1e3,
    orientation: OrientationText::RotationVector,
    around: Around {
        before: |_| "global ".to_owned(),
        middle: b"=",
        after: b"",
    },
    remedy: "write the end as a pose: p[x,y,z,rx,ry,rz] in metres and radians, or state what it rests on (--set NAME=VALUE)",
};
