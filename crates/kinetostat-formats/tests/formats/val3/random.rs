//! Random VAL3 programs with the data of their application.

use kinetostat_formats::*;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    Kind {
        turns: true,
        words: &[
            "\nendIf\n",
            "if ",
            "]]>",
            "<Value key=\"1\"/>",
            "movel(",
            "[0]",
            "&lt;",
            "<!--",
            "call start()\n",
        ],
        // Half of the fifth decimal of three angles.
        turn_rad: 3.0e-7,
        names: ["start.pgx", "cell.dtx"],
        ..Kind::of(Language::Val3, ReadOptions::default(), application)
    }
}

fn number(chance: &mut Chance, size: f64) -> String {
    let value = chance.within(size);
    match chance.below(4) {
        0 => format!("{value:.0}"),
        1 => format!("{value:.1}"),
        2 => format!("{value:.6}"),
        _ => format!("{value:.3}"),
    }
}

/// Numbers of a place and an orientation, with what stands before each.
fn numbers(chance: &mut Chance, before: [&str; 6], behind: &str) -> String {
    let sizes = [900.0, 900.0, 900.0, 180.0, 85.0, 180.0];
    let all = before.iter().zip(sizes);
    let all: Vec<String> = all
        .map(|(before, size)| format!("{before}{}{behind}", number(chance, size)))
        .collect();
    all.join(if behind.is_empty() { "," } else { " " })
}

/// Values of a point or a frame.
fn value(chance: &mut Chance, key: usize, father: &str) -> String {
    let names = ["x=\"", "y=\"", "z=\"", "rx=\"", "ry=\"", "rz=\""];
    let numbers = numbers(chance, names, "\"");
    format!("      <Value key=\"{key}\" {numbers} fatherId=\"{father}\" />\n")
}

fn end(chance: &mut Chance) -> String {
    let point = chance.of(&["pA", "pB[0]", "pRow[0]", "pRow[ 1 ]"]);
    match chance.below(3) {
        0 => format!("appro({point},{{{}}})", numbers(chance, [""; 6], "")),
        _ => point.to_owned(),
    }
}

fn statements(chance: &mut Chance, depth: usize) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(6) {
        let (one, other) = (end(chance), end(chance));
        let how = chance.of(&["tMill,mCut", "tMill, mFast", "flange,mCut"]);
        text += &match chance.below(8) {
            0 if depth < 2 => format!("if true\n{}endIf\n", statements(chance, depth + 1)),
            1 if depth < 2 => format!(
                "for n{depth}=0 to 2\n{}endFor\n",
                statements(chance, depth + 1)
            ),
            2 => "waitEndMove() // all of it\n".to_owned(),
            3 => format!("movec({one},{other},{how})\n"),
            4 => format!("movej({one},{how})\n"),
            _ => format!("movel({one},{how})\n"),
        };
    }
    text
}

/// A program and its data that are understood.
fn application(chance: &mut Chance) -> Vec<String> {
    let program = format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Programs>\n  <Program name=\"start\">\n    <Code><![CDATA[begin\n{}end]]></Code>\n  </Program>\n</Programs>\n",
        statements(chance, 0)
    );
    let mut data = String::new();
    let mut declare = |name: &str, kind: &str, values: &[String]| {
        data += &format!(
            "    <Data name=\"{name}\" xsi:type=\"array\" type=\"{kind}\" size=\"{}\">\n{}    </Data>\n",
            values.len(),
            values.concat()
        );
    };
    declare("fPart", "frame", &[value(chance, 0, "world[0]")]);
    declare("tMill", "tool", &[value(chance, 0, "flange[0]")]);
    for name in ["pA", "pB"] {
        declare(name, "pointRx", &[value(chance, 0, "fPart[0]")]);
    }
    let row = [0, 1].map(|key| value(chance, key, "fPart[0]"));
    declare("pRow", "pointRx", &row);
    let description = |speed: &str| format!("      <Value key=\"0\" tmax=\"{speed}\" />\n");
    declare("mCut", "mdesc", &[description("20")]);
    declare("mFast", "mdesc", &[description("9999")]);
    let counters = ["n0", "n1"];
    for counter in counters {
        declare(counter, "num", &["      <Value key=\"0\" />\n".to_owned()]);
    }
    let head = "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n  <Datas>\n";
    vec![program, format!("{head}{data}  </Datas>\n</Database>\n")]
}
