//! Writes a program flat: `cargo run --example expand -- part.ngc > flat.ngc`.
//!
//! Subprograms are looked for in the folder of the program and in the folders that follow it on the command line.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use kinetostat_program::{ExpandOptions, Subprograms, expand};

/// Files of subprograms in some folders.
struct Folders(Vec<PathBuf>);

impl Subprograms for Folders {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        let wanted = [format!("{name}.ngc"), format!("{name}.nc"), name.to_owned()];
        let folders = self.0.iter();
        let mut files = folders.flat_map(|folder| wanted.iter().map(|name| folder.join(name)));
        files.find_map(|file| std::fs::read(file).ok())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let program = arguments.next().ok_or("expand PROGRAM [FOLDER ...]")?;
    let mut folders: Vec<PathBuf> = program.parent().map(PathBuf::from).into_iter().collect();
    folders.extend(arguments);
    let flat = expand(
        std::fs::read(&program)?,
        &ExpandOptions::default(),
        &Folders(folders),
    )?;
    std::io::stdout().write_all(flat.program.bytes())?;
    Ok(())
}
