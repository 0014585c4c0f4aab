//! ABB RAPID.

mod assigned;
mod broken;
mod corrections;
mod flat;
mod frames;
mod jumps;
mod order;
mod pieces;
pub mod random;
mod table;
mod turned;
mod turning;
mod zero_change;

use kinetostat_formats::*;

/// One module's text, read.
fn program(text: &str) -> RobotProgram {
    let files = vec![SourceFile::new("part.mod", text)];
    read_rapid(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Statements in `main` of a module with some data.
fn main_with(data: &str, statements: &str) -> RobotProgram {
    program(&format!(
        "MODULE Part\n{data}\nPROC main()\n{statements}\nENDPROC\nENDMODULE\n"
    ))
}

/// The one file of a program with pieces.
fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}

/// The line that begins so, of a text.
fn line_with<'t>(text: &'t str, beginning: &str) -> &'t str {
    let found = text
        .lines()
        .find(|line| line.trim_start().starts_with(beginning));
    found.unwrap_or_else(|| panic!("no line begins with {beginning} in\n{text}"))
}
