//! Random programs, put together by chance and broken by chance.

use kinetostat_formats::*;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    Kind {
        turns: true,
        speeds: true,
        words: &[
            "end\n",
            "if True:\n",
            "while ",
            "def f():\n",
            "movel(",
            "p[",
            "x=",
            "else:\n",
            "global ",
            "thread t():\n",
        ],
        ..Kind::of(Language::UrScript, ReadOptions::default(), |chance| {
            vec![program(chance)]
        })
    }
}

fn number(chance: &mut Chance, size: f64) -> String {
    let value = chance.within(size);
    match chance.below(5) {
        0 => format!("{value:.1}"),
        1 => format!("{value:.3}"),
        2 => format!("{value:.9}"),
        3 => format!("{value:e}"),
        _ => format!("{value:.6}"),
    }
}

fn pose(chance: &mut Chance) -> String {
    let mut numbers: Vec<String> = (0..3).map(|_| number(chance, 1.5)).collect();
    numbers.extend((0..3).map(|_| number(chance, 3.0)));
    format!("p[{}]", numbers.join(chance.of(&[",", ", ", " , "])))
}

fn end(chance: &mut Chance) -> String {
    match chance.below(7) {
        0 => "P1".to_owned(),
        1 => "row[1]".to_owned(),
        2 => format!("pose_trans(frame, {})", pose(chance)),
        3 => format!("pose_add(P2, {})", pose(chance)),
        4 => "P2".to_owned(),
        _ => pose(chance),
    }
}

fn motion(chance: &mut Chance) -> String {
    let rest = chance.of(&[
        "",
        ", a=1.2, v=0.02",
        ", 1.2, 0.02",
        ", a=1.2, v=speed, r=0.001",
    ]);
    let end_of_line = chance.of(&["\n", " # part\n", "\r\n"]);
    match chance.below(5) {
        0 => format!(
            "movec({}, {}{rest}){end_of_line}",
            pose(chance),
            pose(chance)
        ),
        1 => format!("movej({}){end_of_line}", end(chance)),
        2 => format!("movep({}{rest}){end_of_line}", end(chance)),
        _ => format!("movel({}{rest}){end_of_line}", end(chance)),
    }
}

fn statements(chance: &mut Chance, depth: usize) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(6) {
        text += &match chance.below(16) {
            0 if depth < 3 => format!(
                "if n == 1:\n{}else:\n{}end\n",
                statements(chance, depth + 1),
                statements(chance, depth + 1)
            ),
            1 if depth < 3 => format!("i=0\nwhile i < 3:\n{}i=i+1\nend\n", statements(chance, 3)),
            2 => "set_digital_out(1, True); sleep(0.5)\n".to_owned(),
            3 if depth == 0 => "inner()\n".to_owned(),
            _ => motion(chance),
        };
    }
    text
}

pub fn program(chance: &mut Chance) -> String {
    let mut text = String::from("def part():\nn=1\ni=0\nspeed=0.03\nset_tcp(p[0,0,0.1,0,0,0])\n");
    text += &format!(
        "frame={}\nglobal P1={}\nP2={}\nrow=[{},{}]\n",
        pose(chance),
        pose(chance),
        pose(chance),
        pose(chance),
        pose(chance)
    );
    text += &format!(
        "def inner():\n{}end\n{}end\n",
        statements(chance, 2),
        statements(chance, 0)
    );
    text
}
