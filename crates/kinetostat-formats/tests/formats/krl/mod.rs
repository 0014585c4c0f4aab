//! KUKA KRL.

mod assigned_frames;
mod broken;
mod broken_forms;
mod corrections;
mod flat;
mod folds;
mod frames;
mod order;
mod ordinary;
mod outside_calls;
mod own_speeds;
mod partial;
mod pieces;
pub mod random;
mod runs;
mod segments;
mod turns;
mod zero_change;

use kinetostat_formats::*;

/// A program with its data list.
fn read_both(source: &str, data: &str) -> RobotProgram {
    let files = vec![
        SourceFile::new("part.src", source),
        SourceFile::new("part.dat", data),
    ];
    read_krl(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

/// Statements in the first routine of a program with some data.
fn main_with(data: &str, statements: &str) -> RobotProgram {
    read_both(
        &format!("DEF part()\n{statements}\nEND\n"),
        &format!("DEFDAT part\n{data}\nENDDAT\n"),
    )
}

/// The files of a program with pieces, one behind the other.
fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    let texts = files
        .into_iter()
        .map(|(_, bytes)| String::from_utf8(bytes).unwrap());
    texts.collect()
}

/// The line that begins so, of a text.
fn line_with<'t>(text: &'t str, beginning: &str) -> &'t str {
    let found = text
        .lines()
        .find(|line| line.trim_start().starts_with(beginning));
    found.unwrap_or_else(|| panic!("no line begins with {beginning} in\n{text}"))
}
