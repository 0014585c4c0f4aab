//! Blocks a second of reading, writing and flattening a Heidenhain program: `speed_heidenhain [BLOCKS]`.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a tool for developers"
)]

use std::fmt::Write;
use std::time::Instant;

use kinetostat_formats::*;
use nalgebra::Vector3;

fn main() {
    let count: usize = std::env::args()
        .nth(1)
        .and_then(|word| word.parse().ok())
        .unwrap_or(200_000);
    let mut text =
        "0 BEGIN PGM S MM\n1 TOOL CALL 5 Z S9000\n2 L X+0 Y+0 Z+2 R0 FMAX M3\n".to_owned();
    for k in 0..count {
        let x = 100.0 * (k as f64 * 1e-3).sin();
        writeln!(text, "{} L X{x:+.3} Y{:+.3} F800", k + 3, 0.001 * k as f64).unwrap();
    }
    text += "9999999 END PGM S MM\n";
    let file = SourceFile::new("s.h", text);
    let options = ReadOptions::default();
    let started = Instant::now();
    let program = read_heidenhain(vec![file.clone()], &options).unwrap();
    let read = started.elapsed().as_secs_f64();
    let pieces: Vec<Piece> = (program.motions.iter().enumerate())
        .map(|(index, motion)| {
            let end = motion.target.pose().unwrap().position_mm;
            Piece::to(index, end + Vector3::new(0.01, -0.02, 0.03))
        })
        .collect();
    let started = Instant::now();
    write(&program, &pieces, &WriteOptions::default()).unwrap();
    let written = started.elapsed().as_secs_f64();
    let repeated = format!(
        "BEGIN PGM S MM\nQ1 = 0\nLBL 1\nQ1 = Q1 + 0.001\nL X+Q1 F500\nCALL LBL 1 REP {}\nEND PGM S MM\n",
        65_534.min(count)
    );
    let started = Instant::now();
    let flat = expand_heidenhain(vec![SourceFile::new("r.h", repeated)], &options).unwrap();
    let blocks = flat.file.line_count() as f64;
    let expanded = started.elapsed().as_secs_f64();
    println!(
        "{:.0} blocks/s read, {:.0} blocks/s written, {:.0} blocks/s written flat",
        count as f64 / read,
        count as f64 / written,
        blocks / expanded
    );
}
