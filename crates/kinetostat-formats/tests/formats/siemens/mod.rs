//! SINUMERIK 840D.

mod arrays;
mod broken;
mod broken_forms;
mod corrections;
mod flat;
mod frames;
mod notes;
pub mod random;
mod real;
mod saved;
mod spindle_feeds;
mod zero_change;

use kinetostat_formats::*;

const EVERYTHING: &str = include_str!("../fixtures/everything.mpf");

fn read_with(text: &[u8], options: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    read_siemens(vec![SourceFile::new("part.mpf", text)], options)
}

fn program(text: &str) -> RobotProgram {
    read_with(text.as_bytes(), &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}

fn place(program: &RobotProgram, motion: usize) -> [f64; 3] {
    program.motions[motion]
        .target
        .pose()
        .unwrap()
        .position_mm
        .into()
}

/// What is wrong with a program.
fn fault(text: &str) -> String {
    let errors = read_with(text.as_bytes(), &ReadOptions::default()).unwrap_err();
    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
    errors.join("\n")
}
