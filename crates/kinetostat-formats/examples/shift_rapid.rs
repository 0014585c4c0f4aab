//! Reads RAPID modules, says what is in them, and writes them with all straight motions 0.1 mm higher:
//! `shift_rapid FILE ...`; the written files go to FILE.shifted.

#![allow(clippy::print_stdout, reason = "a tool on the command line")]

use std::error::Error;

use kinetostat_formats::{
    MotionKind, Piece, ReadOptions, SourceFile, WriteOptions, read_rapid, write,
};
use nalgebra::Vector3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut files = Vec::new();
    for path in std::env::args().skip(1) {
        files.push(SourceFile::new(path.clone(), std::fs::read(&path)?));
    }
    let program = match read_rapid(files, &ReadOptions::default()) {
        Ok(program) => program,
        Err(errors) => {
            for error in &errors {
                println!("{error}");
            }
            return Err(format!("{} statements are refused", errors.len()).into());
        }
    };
    for finding in &program.findings {
        let file = program.files[finding.file].name();
        println!("{file}, line {}: {}", finding.line, finding.message);
    }
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        if let (MotionKind::Linear, Some(end)) = (&motion.kind, motion.target.pose()) {
            let place = end.position_mm + Vector3::new(0.0, 0.0, 0.1);
            pieces.push(Piece::to(index, place));
        }
    }
    println!(
        "{} motions, {} shifted",
        program.motions.len(),
        pieces.len()
    );
    for (name, bytes) in write(&program, &pieces, &WriteOptions::default())? {
        std::fs::write(format!("{name}.shifted"), bytes)?;
    }
    Ok(())
}
