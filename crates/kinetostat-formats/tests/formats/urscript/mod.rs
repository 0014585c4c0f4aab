//! Universal Robots URScript.

mod broken;
mod corrections;
mod flat;
mod names;
pub mod random;
mod reading;
mod table;

use kinetostat_formats::*;

fn read_text(text: &str, options: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    let files = vec![SourceFile::new("part.script", text)];
    read(Language::UrScript, files, options)
}

fn program(text: &str) -> RobotProgram {
    read_text(text, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

/// Statements of a program.
fn in_def(statements: &str) -> RobotProgram {
    program(&format!("def part():\n{statements}\nend\n"))
}

/// Line and text of every error of statements of a program, from line 2 on.
fn errors(statements: &str) -> Vec<(usize, String)> {
    let text = format!("def part():\n{statements}\nend\n");
    let found = read_text(&text, &ReadOptions::default()).expect_err(statements);
    let all = found.iter().map(|error| (error.line, error.to_string()));
    all.collect()
}

fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}

fn moved(program: &RobotProgram, motion: usize, by: [f64; 3]) -> Piece {
    let end = program.motions[motion].target.pose().unwrap().position_mm;
    Piece::to(motion, end + nalgebra::Vector3::from(by))
}
