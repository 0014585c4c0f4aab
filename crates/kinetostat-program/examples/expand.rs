//! Writes programs flat.
//!
//! `expand [--diameter TOOL=MM ...] PROGRAM [FOLDER ...] > flat.ngc`: subprograms are looked for in the folder of the program
//! and in the folders behind it. `expand [--diameter ...] [--folder ...] --into FOLDER PROGRAM ...`: each program is written
//! into the folder under its name, and a line says what is refused (`validation/scripts/compare_expanded_with_linuxcnc.py` reads it).
//! `--as-linuxcnc`: millimetres, the tool at zero, all offsets zero, other axes stand still; `--parameter NUMBER=VALUE`.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

use kinetostat_program::{Dialect, ExpandOptions, OtherAxes, Subprograms, Units, expand};
use nalgebra::Vector3;

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
    let (mut names, mut folders) = (Vec::new(), Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--diameter" => {
                let value = arguments.next().ok_or(USAGE)?;
                let (tool, diameter) = value.split_once('=').ok_or(USAGE)?;
                let diameters = &mut options.tool_diameters_mm;
                diameters.insert(tool.parse()?, diameter.parse()?);
            }
            "--parameter" => {
                let value = arguments.next().ok_or(USAGE)?;
                let (number, value) = value.split_once('=').ok_or(USAGE)?;
                let parameters = &mut options.parameters;
                parameters.insert(number.parse()?, value.parse()?);
            }
            // As LinuxCNC's module begins where the comparison says nothing else.
            "--as-linuxcnc" => {
                options.reading.units = Some(Units::Millimetres);
                options.reading.start_position_mm = Some(Vector3::zeros());
                options.reading.machine_zero_mm = Some(Vector3::zeros());
                options.reading.reference_points_mm = [Some(Vector3::zeros()); 2];
                options.reading.work_offsets_mm = [Some(Vector3::zeros()); 9];
                options.reading.other_axes = OtherAxes::StandStill;
            }
            "--dialect" => {
                options.dialect = match arguments.next().ok_or(USAGE)?.as_str() {
                    "linuxcnc" => Dialect::LinuxCnc,
                    "fanuc" => Dialect::Fanuc,
                    _ => return Err(USAGE.into()),
                }
            }
            "--folder" => folders.push(PathBuf::from(arguments.next().ok_or(USAGE)?)),
            "--into" => into = Some(PathBuf::from(arguments.next().ok_or(USAGE)?)),
            _ => names.push(PathBuf::from(argument)),
        }
    }
    let mut out = std::io::stdout().lock();
    let Some(into) = into else {
        let program = names.first().ok_or(USAGE)?;
        folders.extend_from_slice(&names[1..]);
        out.write_all(&flat(program, &folders, &options)?)?;
        return Ok(());
    };
    for program in &names {
        match flat(program, &folders, &options) {
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
