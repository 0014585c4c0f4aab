//! How many motions a second are read, and written with a correction each, in every language or in one, on one core:
//! `speed [MOTIONS] [NAME]`.
//! Prints the figures of `cargo xtask figures`.

#![allow(clippy::print_stdout, reason = "a tool for developers")]

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use kinetostat_formats::{Piece, ReadOptions, SourceFile, WriteOptions, language_of, read, write};
use nalgebra::Vector3;

/// A program of so many motions by a line each, between a beginning and an end.
fn lined(begin: &str, line: impl Fn(usize, f64, f64) -> String, end: &str, count: usize) -> String {
    let mut text = begin.to_owned();
    for index in 0..count {
        let x = 100.0 * (1e-3 * index as f64).sin();
        text += &line(index, x, 1e-3 * index as f64);
    }
    text + end
}

/// TP programs have a line and a position for each motion, and at most 32 766 positions.
fn tp(count: usize) -> String {
    let mut text = format!("/PROG  LONG\n/ATTR\nLINE_COUNT\t= {count};\n/MN\n");
    for index in 1..=count {
        let _ = writeln!(text, "{index:4}:L P[{index}] 20mm/sec CNT100    ;");
    }
    text += "/POS\n";
    for index in 1..=count {
        let _ = write!(
            text,
            "P[{index}]{{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {:9.3}  mm,\tY = {:9.3}  mm,\tZ = {:9.3}  mm,\n\tW =   180.000 deg,\tP =      .000 deg,\tR =    30.000 deg\n}};\n",
            0.01 * index as f64,
            5.0,
            -1.0
        );
    }
    text + "/END\n"
}

/// Name and text of a program in each language.
fn programs(count: usize) -> Vec<(&'static str, String)> {
    let external = "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]";
    vec![
        (
            "RAPID.mod",
            lined(
                "MODULE Long\nPROC main()\n",
                |_, x, y| {
                    format!(
                        "  MoveL [[{x:.3},{y:.3},15.000],[0,0,1,0],[0,0,0,0],{external}],v20,z1,tool0;\n"
                    )
                },
                "ENDPROC\nENDMODULE\n",
                count,
            ),
        ),
        (
            "KRL.src",
            lined(
                "DEF LONG( )\n$VEL.CP=0.02\n",
                |_, x, y| {
                    format!("LIN {{X {x:.3},Y {y:.3},Z 15.000,A 0.000,B 0.000,C 180.000}} C_DIS\n")
                },
                "END\n",
                count,
            ),
        ),
        ("FANUC.ls", tp(count.min(20_000))),
        (
            "APT.apt",
            lined(
                "UNITS/MM\n",
                |_, x, y| format!("GOTO/{x:.4},{y:.4},-1.0000\n"),
                "FINI\n",
                count,
            ),
        ),
        (
            "SINUMERIK.mpf",
            lined(
                "G90 G71 G17 G54\nT1 M6\nG0 X0 Y0 Z50\n",
                |index, x, y| format!("N{} G1 X{x:.3} Y{y:.3} Z-1 F600\n", 10 * index),
                "M30\n",
                count,
            ),
        ),
        (
            "Heidenhain.h",
            lined(
                "0 BEGIN PGM S MM\n1 TOOL CALL 5 Z S9000\n2 L X+0 Y+0 Z+2 R0 FMAX M3\n",
                |index, x, y| format!("{} L X{x:+.3} Y{y:+.3} F800\n", index + 3),
                "9999999 END PGM S MM\n",
                count,
            ),
        ),
        (
            "table.csv",
            lined(
                "x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,note\n",
                |_, x, y| format!("{x:.3},{y:.3},15.000,0,0,1,0,20,a\n"),
                "",
                count,
            ),
        ),
        (
            "list.yaml",
            lined(
                "poses:\n",
                |_, x, y| {
                    format!(
                        "  - orientation:\n      y: 1\n      w: 0\n      x: 0\n      z: 0\n    position:\n      x_mm: {x:.3}\n      z_mm: -250.0\n      y_mm: {y:.3}\n"
                    )
                },
                "",
                count,
            ),
        ),
    ]
}

/// The fastest counts: what else runs on the machine can only slow a pass down.
const PASSES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let count: usize = match std::env::args().nth(1) {
        Some(word) => word.parse()?,
        None => 100_000,
    };
    let only = std::env::args().nth(2);
    let options = ReadOptions::default();
    for (name, text) in programs(count) {
        if only
            .as_ref()
            .is_some_and(|only| !name.starts_with(only.as_str()))
        {
            continue;
        }
        let language = language_of(name, text.as_bytes()).ok_or("no language")?;
        let (mut reading, mut writing) = (0.0_f64, 0.0_f64);
        for _ in 0..PASSES {
            let files = vec![SourceFile::new(name, text.clone())];
            let start = Instant::now();
            let program = read(language, files, &options)
                .map_err(|errors| format!("{name}: {:?}", errors[0]))?;
            let done = program.motions.len() as f64;
            let rate = done / start.elapsed().as_secs_f64();
            if rate > reading {
                reading = rate;
            }
            let ends = program.motions.iter().enumerate();
            let pieces: Vec<Piece> = ends
                .filter_map(|(index, motion)| {
                    let end = motion.target.pose()?.position_mm;
                    Some(Piece::to(index, end + Vector3::new(0.01, -0.02, 0.03)))
                })
                .collect();
            let start = Instant::now();
            write(&program, &pieces, &WriteOptions::default())?;
            let rate = done / start.elapsed().as_secs_f64();
            if rate > writing {
                writing = rate;
            }
        }
        let name = name.split('.').next().unwrap_or(name);
        for (what, rate) in [("read", reading), ("written", writing)] {
            println!(
                "figure {{\"name\":\"{name}: motions {what} on one core\",\"measured\":{rate:.0},\"asked\":\"at least 100000\",\"unit\":\"1/s\",\"holds\":{}}}",
                rate >= 1e5
            );
        }
    }
    Ok(())
}
