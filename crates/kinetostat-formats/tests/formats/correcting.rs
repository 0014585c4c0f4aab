//! Programs written with a correction and checked by what is read again.

use kinetostat_formats::{Correctable, PathOptions, ReadOptions, RobotPath, RobotProgram};
use kinetostat_program::{
    Corrected, CorrectionField, MachineProgram, Unwatched, WriteOptions as PathWriteOptions,
};

/// What is written of a program on its path, and found as it should be when it is read again; or why it is not written.
///
/// # Panics
/// Where what is read again is not what was to be written.
pub fn written_and_checked(
    (program, path): (&RobotProgram, &RobotPath),
    (reading, making): (&ReadOptions, &PathOptions),
    field: &dyn CorrectionField,
    writing: &PathWriteOptions,
) -> Result<Corrected, String> {
    let robot = Correctable {
        program,
        path,
        reading,
        making,
        writing: &Default::default(),
    };
    let written = robot.write(field, writing, &Unwatched);
    let written = written.map_err(|error| error.to_string())?;
    if let Err(error) = robot.verify(&written, writing) {
        panic!("{}: {error}", program.files[path.file].name());
    }
    Ok(written)
}
