//! FANUC TP programs.

mod beside;
mod broken;
mod corrections;
mod flat;
pub mod random;
mod registers;
mod runs;
mod zero_change;

use kinetostat_formats::*;

const EVERYTHING: &str = include_str!("../fixtures/everything.ls");

fn read_with(bytes: &[u8], options: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    read_ls(vec![SourceFile::new("part.ls", bytes)], options)
}

/// Options that state values (`R[1]`, `DI[1]`).
fn stating(values: &[(&str, &str)]) -> ReadOptions {
    let mut options = ReadOptions::default();
    let values = values.iter();
    options.values = values
        .map(|(name, value)| ((*name).to_owned(), StatedValue::of(value)))
        .collect();
    options
}

/// Options with which the run through [`EVERYTHING`] is known.
fn decided() -> ReadOptions {
    stating(&[("DI[1]", "ON"), ("R[1]", "3")])
}

/// A position in frame 2 with tool 1.
fn position(number: usize, place: [f64; 3]) -> String {
    format!(
        "P[{number}]{{\n   GP1:\n\tUF : 2, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {:9.3}  mm,\tY = {:9.3}  mm,\tZ = {:9.3}  mm,\n\tW =   180.000 deg,\tP =      .000 deg,\tR =    30.000 deg\n}};\n",
        place[0], place[1], place[2]
    )
}

/// A program of these lines (numbered here) with positions P[1] to P[4].
fn with_lines(lines: &[&str]) -> String {
    let mut text = format!("/PROG  PART\n/ATTR\nLINE_COUNT\t= {};\n/MN\n", lines.len());
    for (index, line) in lines.iter().enumerate() {
        text += &format!("{:4}:{line}\n", index + 1);
    }
    text += "/POS\n";
    for number in 1..=4 {
        text += &position(number, [100.0 * number as f64, 0.0, 5.0]);
    }
    text + "/END\n"
}

fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}
