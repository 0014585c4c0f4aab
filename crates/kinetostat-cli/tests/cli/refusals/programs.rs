//! Wrong programs and maps.

use crate::common::PROGRAM;
use crate::refusals::{Case, case, changed};

const CUT: [&str; 4] = ["compensate", "job.toml", "--program", "bad.ngc"];

const MAP: [&str; 7] = [
    "compensate",
    "--map",
    "map.csv",
    "--program",
    "part.ngc",
    "--out",
    "o.ngc",
];

pub fn programs() -> Vec<Case> {
    let p = |text: &str| vec![("bad.ngc", text.as_bytes().to_vec())];
    let changed = |from: &str, to: &str| vec![("bad.ngc", changed(PROGRAM, from, to))];
    vec![
        case(
            "program: tool radius compensation",
            changed("G1 Z-1", "G41 D1\nG1 Z-1"),
            &CUT,
            1,
            &["bad.ngc", "line 3", "G41"],
        ),
        case(
            "program: the spindle on and off in one block",
            changed("G1 Z-1 F300", "M3 M5 S900\nG1 Z-1 F300"),
            &CUT,
            1,
            &["bad.ngc", "line 3", "another code of its group"],
        ),
        case(
            "program: all faults at once",
            changed(
                "G1 Z-1 F300",
                "G41 D1\nG81 Z-1 R2 F300\nX[1+2]\nG2.1 X5 F300",
            ),
            &CUT,
            1,
            &[
                "4 lines are refused",
                "line 3",
                "G41",
                "line 4",
                "G81",
                "line 5",
                "variables",
                "line 6",
                "G2.1 is not known",
            ],
        ),
        case(
            "program: an axis that turns the part",
            changed("G1 Z-1 F300", "G1 Z-1 A90 F300"),
            &CUT,
            1,
            &[
                "bad.ngc",
                "line 3",
                "axis A",
                "--axes-stand-still",
                "axes_stand_still = true",
            ],
        ),
        case(
            "program: canned cycle",
            changed("G1 Z-1 F300", "G81 Z-1 R2 F300"),
            &CUT,
            1,
            &["bad.ngc", "line 3", "G81"],
        ),
        case(
            "program: an arc that is none",
            changed("I0 J-20", "I0 J-21"),
            &CUT,
            1,
            &["bad.ngc", "line 5", "radius", "arc"],
        ),
        case(
            "program: subroutine",
            changed("M2", "M98 P100\nM2"),
            &CUT,
            1,
            &["bad.ngc", "line 7", "M98"],
        ),
        case(
            "program: variable",
            changed("X20", "X#1"),
            &CUT,
            1,
            &["bad.ngc", "line 2", "#1"],
        ),
        case(
            "program: comma for a point",
            changed("X20", "X20,5"),
            &CUT,
            1,
            &["bad.ngc", "line 2"],
        ),
        case(
            "program: two points",
            changed("X20", "X2.0.5"),
            &CUT,
            1,
            &["bad.ngc", "line 2"],
        ),
        case(
            "program: open comment",
            changed("M2", "M2 (end"),
            &CUT,
            1,
            &["bad.ngc", "line 7", "comment"],
        ),
        case(
            "program: escape codes in a comment",
            changed("M2", "M98 (\u{1b}[2J\u{7})\nM2"),
            &CUT,
            1,
            &["bad.ngc", "line 7"],
        ),
        case(
            "program: nothing in it",
            p(""),
            &CUT,
            1,
            &["bad.ngc", "empty"],
        ),
        case(
            "program: binary",
            vec![("bad.ngc", vec![0, 1, 2, 3])],
            &CUT,
            1,
            &["bad.ngc", "line 1"],
        ),
        case(
            "program: UTF-16",
            vec![("bad.ngc", vec![0xff, 0xfe, b'G', 0])],
            &CUT,
            1,
            &["bad.ngc", "UTF-16"],
        ),
        case(
            "program: no motion",
            p("G21 G90\nM2\n"),
            &CUT,
            1,
            &["bad.ngc", "no motion"],
        ),
        case(
            "program: directory",
            vec![],
            &["compensate", "job.toml", "--program", "."],
            1,
            &["directory"],
        ),
        case(
            "program: compensated already",
            vec![(
                "bad.ngc",
                format!("(kinetostat: compensated program)\n{PROGRAM}").into_bytes(),
            )],
            &CUT,
            1,
            &["bad.ngc", "line 1", "compensated already"],
        ),
        case(
            "program: out of reach",
            changed("G0 Z5\n", "G0 Z5\nG1 Y900\n"),
            &CUT,
            2,
            &["bad.ngc", "line 7", "leg"],
        ),
        case(
            "program: beyond the map",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n10,0,0,0,0,0\n".to_vec(),
            )],
            &MAP,
            2,
            &["part.ngc", "line 2", "outside the map"],
        ),
        case(
            "program: blocks after a tape mark in its middle",
            changed("G1 X0", "%\nG1 X0"),
            &CUT,
            1,
            &["3 lines are refused", "line 5", "line 6", "line 7", "% on line 4", "remove the blocks after %"],
        ),
        case(
            "map: all faults at once",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,no\n1,0,0,0,0,0\n2,0,0,0\n3,0,0,inf,0,0\n".to_vec(),
            )],
            &[
                "compensate",
                "--map",
                "map.csv",
                "--program",
                "part.ngc",
                "--out",
                "o.ngc",
            ],
            1,
            &["map.csv", "3 places", "line 2", "line 4", "line 5"],
        ),
        case(
            "map: names in capitals",
            vec![(
                "map.csv",
                b"X_MM,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n".to_vec(),
            )],
            &MAP,
            1,
            &["did you mean `x_mm`?"],
        ),
        case(
            "map: a column in micrometres",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_um,dy_mm,dz_mm\n0,0,0,0,0,0\n".to_vec(),
            )],
            &MAP,
            1,
            &["dx_mm", "convert its numbers"],
        ),
        case(
            "map: semicolons, and points in thousands",
            vec![(
                "map.csv",
                b"x_mm;y_mm;z_mm;dx_mm;dy_mm;dz_mm\n0;0;0;1.234,5;0;0\n".to_vec(),
            )],
            &MAP,
            1,
            &["line 2", "`1.234,5` in column dx_mm", "no finite number"],
        ),
        case(
            "program: 10 nm beyond the map",
            vec![
                (
                    "map.csv",
                    b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n99.9999,0,0,0,0,0\n".to_vec(),
                ),
                (
                    "part.ngc",
                    b"G21 G90\nG0 X0 Y0 Z0\nG1 X99.99991 F600\nM2\n".to_vec(),
                ),
            ],
            &MAP,
            2,
            &["x 99.99990", "mm is outside the map", "from 0 to 99.9999 mm"],
        ),
        case(
            "map: a column too few",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_mm,dy_mm\n0,0,0,0,0\n".to_vec(),
            )],
            &[
                "compensate",
                "--map",
                "map.csv",
                "--program",
                "part.ngc",
                "--out",
                "o.ngc",
            ],
            1,
            &["map.csv", "dz_mm"],
        ),
    ]
}
