//! Heidenhain conversational programs.

mod arcs;
mod broken;
mod broken_forms;
mod corrections;
mod expanding;
mod paths;
mod planes;
mod properties;
pub mod random;
mod real;
mod refused_words;
mod sides;
mod tilted;
mod tool_axes;
mod zero_change;

use kinetostat_formats::*;

/// A program with most of what is followed.
const EVERYTHING: &str = include_str!("../fixtures/everything.h");

fn read_with(text: &[u8], options: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    read_heidenhain(vec![SourceFile::new("part.h", text)], options)
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
    let end = program.motions[motion].target.pose();
    end.unwrap_or_else(|| panic!("motion {motion}: {:?}", program.motions[motion].target))
        .position_mm
        .into()
}

/// The flat text of a program.
fn flat(text: &str) -> String {
    let files = vec![SourceFile::new("part.h", text)];
    let flat = expand_heidenhain(files, &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors:#?}"));
    String::from_utf8(flat.file.bytes().to_vec()).unwrap()
}
