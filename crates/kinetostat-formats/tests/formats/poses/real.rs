//! The rasters of robot surface processes in `../shared/data/gcode`, which this project shares with its tests.

use std::io::Write as _;
use std::path::Path;

use kinetostat_formats::*;
use kinetostat_testing::largest_size;
use nalgebra::Vector3;

use super::read_with;

/// Names, poses and rasters of the files.
const FILES: [(&str, usize, usize); 2] = [
    ("crs_part5_ls10cm_ps10cm.poses.yaml", 381, 21),
    ("crs_scanned_part1_job_90degrees.poses.yaml", 258, 29),
];

/// The files by name; nothing (said plainly) where they are absent.
pub fn files() -> Vec<(String, Vec<u8>, usize, usize)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/gcode");
    let mut found = Vec::new();
    for (name, poses, rasters) in FILES {
        match std::fs::read(folder.join(name)) {
            Ok(bytes) => found.push((name.to_owned(), bytes, poses, rasters)),
            Err(_) => {
                let _ = writeln!(
                    std::io::stderr(),
                    "SKIPPED: {} is absent, its poses were not read",
                    folder.join(name).display()
                );
            }
        }
    }
    found
}

#[test]
fn both_files_come_back_byte_for_byte_and_take_corrections() {
    for (name, bytes, poses, rasters) in files() {
        let options = ReadOptions::default();
        let program =
            read_with(&name, &bytes, &options).unwrap_or_else(|errors| panic!("{errors:#?}"));
        assert_eq!(program.motions.len(), poses, "{name}");
        let air = program
            .motions
            .iter()
            .filter(|motion| motion.kind == MotionKind::Joint);
        assert_eq!(air.count(), rasters, "{name}");
        // By the words alone, without a parser: numbers of `x:` below `position:`.
        let text = String::from_utf8(bytes.clone()).unwrap();
        let mut wanted = Vec::new();
        let mut place = false;
        for line in text
            .lines()
            .take_while(|line| !line.starts_with("  tool_offset"))
        {
            let word = line.trim_start_matches([' ', '-']);
            match word.split_once(": ") {
                None => place = word == "position:",
                Some(("x", number)) if place => wanted.push(1e3 * number.parse::<f64>().unwrap()),
                _ => {}
            }
        }
        let found: Vec<f64> = (program.motions.iter())
            .map(|motion| motion.target.pose().unwrap().position_mm.x)
            .collect();
        assert_eq!(found.len(), wanted.len(), "{name}");
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-9, "{name}");
        }
        let same = write(&program, &[], &WriteOptions::default()).unwrap();
        assert!(same[0].1 == bytes, "{name}");
        let pieces: Vec<Piece> = (program.motions.iter().enumerate())
            .map(|(index, motion)| {
                let end = motion.target.pose().unwrap().position_mm;
                Piece::to(index, end + Vector3::new(0.1, -0.2, 0.3))
            })
            .collect();
        let files = write(&program, &pieces, &WriteOptions::default()).unwrap();
        let again = read_with(&name, &files[0].1, &options).unwrap();
        for (piece, motion) in pieces.iter().zip(&again.motions) {
            let off = motion.target.pose().unwrap().position_mm - piece.position_mm;
            // The numbers keep their decimals, twelve at most: of a metre.
            assert!(largest_size(off.iter().copied()) <= 1e-9, "{name}: {off}");
        }
        let lines = |bytes: &[u8]| bytes.iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(lines(&files[0].1), lines(&bytes));
    }
}
