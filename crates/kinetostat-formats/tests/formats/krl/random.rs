//! Random programs: pieces of KRL put together by chance, and broken by chance. Whatever they are, they are read or refused
//! with a line; what is read comes back byte for byte, and with corrections is read again with those corrections.

use kinetostat_formats::*;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    Kind {
        turns: true,
        speeds: true,
        words: &[
            "\nEND\n",
            "\nIF ",
            " THEN\n",
            "\nENDIF\n",
            "DEF x()\n",
            "CASE 1\n",
            "LIN ",
            "DECL POS ",
            "=",
            "\n;FOLD ",
            "\n;ENDFOLD",
            "\nGOTO a\na:\n",
            " CA 30",
            " C_DIS ",
            "WITH $VEL.CP=0.1,",
        ],
        // Half of the fifth decimal of a degree about each of three axes, which may add up.
        turn_rad: 3.0e-7,
        said: &SAID,
        ..Kind::of(Language::Krl, ReadOptions::default(), |chance| {
            module(chance).to_vec()
        })
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

fn pose(chance: &mut Chance) -> String {
    let place: Vec<String> = (0..3).map(|_| number(chance, 2000.0)).collect();
    let angles = [180.0, 89.0, 180.0].map(|size| number(chance, size));
    let comma = chance.of(&[",", ", ", " , "]);
    let start = chance.of(&["{", "{ ", "{E6POS: ", "{POS:"]);
    let end = chance.of(&[
        "",
        ",S 2,T 35",
        ",S 'B010',T 'B00100011',E1 0.0,E2 0,E3 0,E4 0,E5 0,E6 0",
    ]);
    let members = [
        format!("X {}", place[0]),
        format!("Y {}", place[1]),
        format!("Z {}", place[2]),
        format!("A {}", angles[0]),
        format!("B {}", angles[1]),
        format!("C {}", angles[2]),
    ];
    format!("{start}{}{end}}}", members.join(comma))
}

/// Names of declared targets.
const NAMES: [&str; 7] = ["XP1", "xp2", "XP_3", "way[1]", "way[ 2 ]", "XG", "XH"];

fn end(chance: &mut Chance) -> String {
    let name = chance.of(&NAMES).to_owned();
    match chance.below(4) {
        0 | 1 => name,
        2 => {
            let (x, y, turn) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 180.0),
            );
            format!("{name}:{{X {x},Y {y},Z 0.0,A {turn},B 0,C 0}}")
        }
        _ => pose(chance),
    }
}

/// What holds for a motion or a block alone.
const LISTS: [&str; 6] = [
    "",
    "",
    " WITH $VEL.CP=0.1",
    " with $VEL = SVEL_CP(0.2, , LCPDAT1), $ACC=SACC_CP(LCPDAT1)",
    " WITH $ACC.CP=1,$VEL={CP 0.3,ORI1 200,ORI2 200}",
    " WITH $APO=SAPO(LCPDAT1),$TOOL=STOOL2(FP1),$BASE=SBASE(FP1.BASE_NO)",
];

fn block(chance: &mut Chance) -> String {
    let mut text = format!("SPLINE{}\n", chance.of(&LISTS));
    for _ in 0..chance.below(4) {
        text += &match chance.below(3) {
            0 => format!(
                "  SCIRC {},{}{}\n",
                end(chance),
                end(chance),
                chance.of(&LISTS)
            ),
            _ => format!("  SLIN {}{} ; part\n", end(chance), chance.of(&LISTS)),
        };
    }
    text + "ENDSPLINE C_SPL\n"
}

fn motion(chance: &mut Chance) -> String {
    let word = chance.of(&["LIN", "LIN", "lin", "PTP", "CIRC", "SLIN", "SCIRC", "SPTP"]);
    let via = match word {
        "CIRC" | "SCIRC" => end(chance) + chance.of(&[",", ", "]),
        _ => String::new(),
    };
    let list = match word.starts_with('S') {
        true => chance.of(&LISTS),
        false => "",
    };
    let rest = chance.of(&["", " C_DIS", " c_vel ; part", " ; groove"]);
    let text = format!("{word} {via}{}{list}{rest}\n", end(chance));
    match (word, chance.below(4)) {
        ("LIN", 0) => {
            let point = chance.of(&["P1", "P2"]);
            format!(
                ";FOLD LIN {point} Vel=0.5 m/s CPDAT1 Tool[1] Base[2];%{{PE}}%P 1:LIN, 2:{point}\n$BWDSTART=FALSE\nLDAT_ACT=LCPDAT1\n\
                 FDAT_ACT=F{point}\nBAS(#CP_PARAMS,0.5)\nLIN X{point} C_DIS\n;ENDFOLD\n"
            )
        }
        _ => text,
    }
}

fn statements(chance: &mut Chance, depth: usize) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(7) {
        text += &match chance.below(14) {
            0 if depth < 3 => format!(
                "IF {} THEN\n{}ELSE\n{}ENDIF\n",
                chance.of(&["TRUE", "FALSE", "(i==2) OR TRUE"]),
                statements(chance, depth + 1),
                statements(chance, depth + 1)
            ),
            1 if depth < 3 => format!(
                "FOR i{depth} = 1 TO 3\n{}ENDFOR\n",
                statements(chance, depth + 1)
            ),
            2 if depth < 3 => format!("REPEAT\n{}UNTIL TRUE\n", statements(chance, depth + 1)),
            3 => "$OUT[1]=TRUE\nWAIT SEC 0.5\n".to_owned(),
            4 if depth < 2 => "sub()\n".to_owned(),
            5 => format!("  $VEL.CP={}\n", chance.of(&["0.02", "1", "20/1000.0"])),
            6 => format!(
                "$BASE={}\n",
                chance.of(&["BASE_DATA[2]", "$NULLFRAME", "{X 1,Y 2,Z 3,A 0,B 0,C 0}"])
            ),
            7 => format!(
                "$TOOL=TOOL_DATA[{}]\n$APO.CDIS=0.5\n",
                chance.of(&["0", "1"])
            ),
            8 => block(chance),
            _ => motion(chance),
        };
    }
    text
}

/// A program and its data list that are understood.
pub fn module(chance: &mut Chance) -> [String; 2] {
    let mut source = String::from("&ACCESS RVP\n");
    for (name, depth) in [("part", 0), ("sub", 2)] {
        source += &format!(
            "DEF {name}()\nINT i,i0,i1,i2\n{}END\n",
            statements(chance, depth)
        );
    }
    let mut data = String::from("&ACCESS RVP\nDEFDAT part\n");
    for name in ["XP1", "XP2", "XP_3"] {
        let declared = chance.of(&["DECL", "DECL GLOBAL", "GLOBAL"]);
        data += &format!("  {declared} E6POS {name}={}\n", pose(chance));
    }
    data += "DECL FDAT FP1={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \"}\nDECL FDAT FP2={TOOL_NO 1,BASE_NO 2}\n";
    data += "DECL LDAT LCPDAT1={VEL 2,ACC 100,APO_DIST 3.5}\n";
    data += &format!(
        "POS XG={},XH={}\nDECL FRAME way[2]\n",
        pose(chance),
        pose(chance)
    );
    data += &format!("way[1]={}\n  way[2]={}\nENDDAT", pose(chance), pose(chance));
    match chance.below(3) {
        0 => [source.replace('\n', "\r\n"), data.replace('\n', "\r\n")],
        _ => [source, data],
    }
}

/// What a writer may say of a correction that it cannot write.
const SAID: [&str; 8] = [
    // An end that keeps what it does not state ends elsewhere in each run.
    "needs another correction each time",
    "only some of X, Y, Z",
    "what its end keeps of before",
    "has no pose that could be corrected",
    "called by code that does not run here",
    "states no orientation",
    "a piece has no finite place",
    "its speed cannot be changed",
];
