//! Random TP programs: lines and positions put together by chance, and broken by chance.

use kinetostat_formats::*;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    let mut options = ReadOptions::default();
    let on = StatedValue::Truth(true);
    options.values.insert("DI[1]".to_owned(), on);
    Kind {
        turns: true,
        words: &[
            "/POS\n",
            "/MN\n",
            "/END\n",
            "P[1] ",
            "LBL[1] ;",
            "JMP LBL[2] ;",
            " 7:L P[2] 20mm/sec FINE ;\n",
            "};\n",
            "GP2:\n",
            "IF (R[1]=1) THEN ;",
            "ENDIF ;",
            "FOR R[1]=1 TO 3 ;",
            "ENDFOR ;",
            "UF : 3,",
            "CONFIG : 'F U T, 0, 0, 0',",
            "J1= 1 deg",
            "Offset,PR[1] ",
            "COORD ",
            "CALL A ;",
            "R[",
        ],
        // Half of the fifth decimal of three angles.
        turn_rad: 3.0e-7,
        ..Kind::of(Language::FanucLs, options, |chance| vec![program(chance)])
    }
}

fn position(chance: &mut Chance, number: usize, frame: usize) -> String {
    let p = [0, 1, 2].map(|_| chance.within(1500.0));
    let a = [
        chance.within(180.0),
        chance.within(85.0),
        chance.within(180.0),
    ];
    match chance.below(3) {
        0 => format!(
            "P[{number}:\"point {number}\"]{{\n   GP1:\n\tUF : {frame}, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {:9.3}  mm,\tY = {:9.3}  mm,\tZ = {:9.3}  mm,\n\tW = {:9.3} deg,\tP = {:9.3} deg,\tR = {:9.3} deg\n}};\n",
            p[0], p[1], p[2], a[0], a[1], a[2]
        ),
        1 => format!(
            "P[{number}] {{\n   GP1:\n       UF : F, UT : F,     CONFIG: 'F U T, 0, 0, -1',\n      X = {:.1} mm, Y = {:.1} mm, Z = {:.2} mm,\n      W = {:.1} deg, P = {:.1} deg, R = {:.6} deg,\n      E1= 12.5 mm\n   GP2:\n       UF : 1, UT : 2,\n      J1 = 3.0 deg\n}};\n",
            p[0], p[1], p[2], a[0], a[1], a[2]
        ),
        _ => format!(
            "P[{number}]{{\n   GP1:\n\tUF : {frame}, UT : 1,\tCONFIG : 'N D B, 0, 0, 1',\n\tX={:.4} mm,Y={:+.3} mm,Z= {:8.3} mm,\n\tW={:.2} deg,P={:.3} deg,R={:.3} deg\n}};\n",
            p[0], p[1], p[2], a[0], a[1], a[2]
        ),
    }
}

fn motion(chance: &mut Chance) -> String {
    let number = 1 + chance.below(6);
    let linear = chance.of(&[
        "20mm/sec",
        "60cm/min",
        "R[3]mm/sec",
        "10.5mm/sec",
        "30inch/min",
        "2.0sec",
        "45deg/sec",
    ]);
    let zone = chance.of(&["FINE", "CNT100", "CNT50", "CD10", "CNT R[4]"]);
    let option = chance.of(&[
        "",
        "",
        " ACC80",
        " Wjnt",
        " PTH",
        " ACC R[7:a] PTH",
        " TB .10sec,DO[1]=ON",
    ]);
    match chance.below(6) {
        0 => format!("J P[{number}] 50% {zone}{option}    ;"),
        1 => format!(
            "C P[{number}:mid]    \n    :  P[{}] {linear} {zone}{option}    ;",
            1 + chance.below(6)
        ),
        2 => format!("L P[{number}:name here] {linear} {zone} ;"),
        _ => format!("L P[{number}] {linear} {zone}{option}    ;"),
    }
}

/// A program that is understood.
pub fn program(chance: &mut Chance) -> String {
    let mut lines = vec!["  UFRAME_NUM=2 ;".to_owned(), "  UTOOL_NUM=1 ;".to_owned()];
    for _ in 0..chance.below(12) {
        match chance.below(9) {
            0 => lines.push("  ! text ; with signs ;".to_owned()),
            1 => lines.push("  WAIT    .30(sec) ;".to_owned()),
            2 => {
                lines.push("  IF (DI[1:a]=ON) THEN ;".to_owned());
                lines.push(motion(chance));
                if chance.below(2) == 0 {
                    lines.push("  ELSE ;".to_owned());
                    lines.push(motion(chance));
                }
                lines.push("  ENDIF ;".to_owned());
            }
            3 => {
                lines.push("  FOR R[1]=1 TO 3 ;".to_owned());
                lines.push(motion(chance));
                lines.push("  ENDFOR ;".to_owned());
            }
            4 => lines.push("  IF R[1:x, y]=2,JMP LBL[9] ;".to_owned()),
            _ => lines.push(motion(chance)),
        }
    }
    lines.push("  LBL[9] ;".to_owned());
    let mut text = format!(
        "/PROG  PART\n/ATTR\nLINE_COUNT\t= {};\nPROTECT = READ_WRITE;\n/MN\n",
        lines.len()
    );
    for (index, line) in lines.iter().enumerate() {
        text += &format!("{:4}:{line}\n", index + 1);
    }
    text += "/POS\n";
    for number in 1..=6 {
        text += &position(chance, number, 2);
    }
    text += "/END\n";
    match chance.below(3) {
        0 => text.replace('\n', "\r\n"),
        _ => text,
    }
}
