//! Random programs: pieces of RAPID put together by chance, and broken by chance. Whatever they are, they are read or refused
//! with a line; what is read comes back byte for byte, and with corrections is read again with those corrections.

use kinetostat_formats::*;
use nalgebra::UnitQuaternion;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    let mut options = ReadOptions::default();
    options
        .values
        .insert("di1".into(), StatedValue::Number(1.0));
    Kind {
        turns: true,
        speeds: true,
        words: &[
            "ENDPROC",
            "IF ",
            " THEN ",
            "ENDIF",
            "MODULE",
            "PROC ",
            "TEST n CASE 1:",
            "MoveL ",
            "VAR num ",
            ":=",
            "ERROR ",
        ],
        said: &["called by code that does not run here"],
        ..Kind::of(Language::Rapid, options, |chance| vec![program(chance)])
    }
}

fn number(chance: &mut Chance, size: f64) -> String {
    let value = chance.within(size);
    match chance.below(5) {
        0 => format!("{value:.0}"),
        1 => format!("{value:.1}"),
        2 => format!("{value:.6}"),
        3 => format!("{value:+.3}"),
        _ => format!("{value:.2}"),
    }
}

fn target(chance: &mut Chance) -> String {
    let place: Vec<String> = (0..3).map(|_| number(chance, 2000.0)).collect();
    let angles = [0, 1, 2].map(|_| chance.within(3.0));
    let q = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
    let comma = chance.of(&[",", ", ", " ,\n  "]);
    let external = chance.of(&["9E9,9E9,9E9,9E9,9E9,9E9", "9E+09,9e9,9E9,9E9,9E9,9E9"]);
    format!(
        "[[{}],[{:.7},{:.7},{:.7},{:.7}],[0,-1,0,1],[{external}]]",
        place.join(comma),
        q.w,
        q.i,
        q.j,
        q.k
    )
}

/// Names of declared targets.
const NAMES: [&str; 6] = ["p1", "p2", "P_3", "row{1}", "row{ 2 }", "inner"];

fn end(chance: &mut Chance) -> String {
    let name = chance.of(&NAMES).to_owned();
    match chance.below(5) {
        0 => name,
        1 => {
            let (x, y, z) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 50.0),
            );
            format!("Offs({name},{x}, {y},{z})")
        }
        2 => {
            let (x, z, turn) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 180.0),
            );
            match chance.below(2) {
                0 => format!("RelTool({name},{x},0,{z})"),
                _ => format!("RelTool({name},{x},0,{z}\\Ry:={turn})"),
            }
        }
        _ => target(chance),
    }
}

fn motion(chance: &mut Chance) -> String {
    let word = chance.of(&["MoveL", "MoveL", "MOVEL", "MoveJ", "MoveC", "ArcL"]);
    let via = match word {
        "MoveC" => end(chance) + ", ",
        _ => String::new(),
    };
    let speed = chance.of(&["v20", "vCut", "[33.3,500,5000,1000]", "v1000"]);
    let between = match word {
        "ArcL" => "seam1, weld1\\Weave:=w1, ",
        _ => "",
    };
    let rest = chance.of(&[
        "z1, tool0;",
        "fine,tMill\\WObj:=wTable;",
        "z10 , tMill,\\WObj:=wTable ; ! part",
    ]);
    format!("{word} {via}{}, {speed}, {between}{rest}\n", end(chance))
}

fn statements(chance: &mut Chance, depth: usize, calls: bool) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(6) {
        text += &match chance.below(10) {
            0 if depth < 3 => format!(
                "IF di1=1 THEN\n{}ELSE\n{}ENDIF\n",
                statements(chance, depth + 1, calls),
                statements(chance, depth + 1, calls)
            ),
            1 if depth < 3 => format!(
                "FOR i FROM 1 TO 3 DO\n{}ENDFOR\n",
                statements(chance, depth + 1, calls)
            ),
            2 => "Set do1; WaitTime 0.5;\n".to_owned(),
            3 if calls => "part;\n".to_owned(),
            _ => motion(chance),
        };
    }
    text
}

/// A module that is understood.
pub fn program(chance: &mut Chance) -> String {
    let mut text = String::from("MODULE Part\n");
    for name in ["p1", "p2", "P_3"] {
        let change = chance.of(&["CONST", "LOCAL CONST", "PERS"]);
        text += &format!("  {change} robtarget {name}:={};\n", target(chance));
    }
    text += &format!(
        "CONST robtarget row{{2}}:=[{},{}];\n",
        target(chance),
        target(chance)
    );
    text += "CONST speeddata vCut:=[12,500,5000,1000];\n";
    text += "PERS tooldata tMill:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n";
    text += "PERS wobjdata wTable:=[FALSE,TRUE,\"\",[[1,2,3],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n";
    for (name, depth) in [("main", 0), ("part", 2)] {
        let inner = target(chance);
        text += &format!(
            "PROC {name}()\nCONST robtarget inner:={inner};\n{}ENDPROC\n",
            statements(chance, depth, name == "main")
        );
    }
    text += "ENDMODULE\n";
    match chance.below(3) {
        0 => text.replace('\n', "\r\n"),
        _ => text,
    }
}
