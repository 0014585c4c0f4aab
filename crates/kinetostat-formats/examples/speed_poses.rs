//! How many poses a second are read and written, as a table and as YAML: `speed_poses [POSES]`, one core.

#![allow(clippy::print_stdout, reason = "a tool for developers")]

use std::error::Error;
use std::time::Instant;

use kinetostat_formats::{Piece, ReadOptions, SourceFile, WriteOptions, read_poses, write};
use nalgebra::Vector3;

fn table(count: usize) -> String {
    let mut text = String::from("x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,note\n");
    for index in 0..count {
        text += &format!("{index}.25,-40.594,15.000,0,0,1,0,20,a\n");
    }
    text
}

fn yaml(count: usize) -> String {
    let mut text = String::from("poses:\n");
    for index in 0..count {
        text += &format!(
            "  - orientation:\n      y: 1\n      w: 6.123233995736766e-17\n      x: 0\n      z: 0\n    position:\n      x_m: 0.{index}\n      z_m: -0.25\n      y_m: 0.5\n"
        );
    }
    text
}

fn main() -> Result<(), Box<dyn Error>> {
    let count: usize = match std::env::args().nth(1) {
        Some(word) => word.parse()?,
        None => 200_000,
    };
    for (name, text) in [("long.csv", table(count)), ("long.yaml", yaml(count))] {
        println!("{name}: {count} poses, {:.1} MB", text.len() as f64 / 1e6);
        let files = vec![SourceFile::new(name, text)];
        let start = Instant::now();
        let program =
            read_poses(files, &ReadOptions::default()).map_err(|errors| format!("{errors:?}"))?;
        let rate = |start: Instant| count as f64 / start.elapsed().as_secs_f64();
        println!("  read: {:.0} poses/s", rate(start));
        let mut pieces = Vec::new();
        for (index, motion) in program.motions.iter().enumerate() {
            if let Some(end) = motion.target.pose() {
                let by = Vector3::new(0.01, 0.02, 0.03);
                pieces.push(Piece::to(index, end.position_mm + by));
            }
        }
        let start = Instant::now();
        let written = write(&program, &pieces, &WriteOptions::default())?;
        println!(
            "  written: {:.0} poses/s, {:.1} MB",
            rate(start),
            written[0].1.len() as f64 / 1e6
        );
    }
    Ok(())
}
