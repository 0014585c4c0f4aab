//! Writes programs flat.
//!
//! `expand [--diameter TOOL=MM ...] PROGRAM [FOLDER ...] > flat.ngc`: subprograms are looked for in the folder of the program
//! and in the folders behind it. `expand [--diameter ...] --into FOLDER PROGRAM ...`: each program is written into the folder
//! under its name, and a line says what is refused (`scripts/compare_expanded_with_linuxcnc.py` reads it).

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

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

const USAGE: &str =
    "expand [--diameter TOOL=MM ...] [--into FOLDER] PROGRAM [PROGRAM or FOLDER ...]";

fn main() -> Result<(), Box<dyn Error>> {
    let mut options = ExpandOptions::default();
    let mut into = None;
    let mut names = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--diameter" => {
                let value = arguments.next().ok_or(USAGE)?;
                let (tool, diameter) = value.split_once('=').ok_or(USAGE)?;
                let diameters = &mut options.tool_diameters_mm;
                diameters.insert(tool.parse()?, diameter.parse()?);
            }
            "--into" => into = Some(PathBuf::from(arguments.next().ok_or(USAGE)?)),
            _ => names.push(PathBuf::from(argument)),
        }
    }
    let mut out = std::io::stdout().lock();
    let Some(into) = into else {
        let program = names.first().ok_or(USAGE)?;
        out.write_all(&flat(program, &names[1..], &options)?)?;
        return Ok(());
    };
    for program in &names {
        match flat(program, &[], &options) {
            Ok(bytes) => {
                std::fs::write(into.join(program.file_name().ok_or(USAGE)?), bytes)?;
                writeln!(out, "{}\t", program.display())?;
            }
            Err(error) => writeln!(out, "{}\t{error}", program.display())?,
        }
    }
    Ok(())
}

fn flat(
    program: &Path,
    folders: &[PathBuf],
    options: &ExpandOptions,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let own = program.parent().map(PathBuf::from);
    let folders = own.into_iter().chain(folders.iter().cloned()).collect();
    let flat = expand(std::fs::read(program)?, options, &Folders(folders))?;
    Ok(flat.program.bytes().to_vec())
}
