//! A program in whatever language, as far as a run over it needs to know: its path, and how it is written with corrections.

use crate::checking::Verification;
use crate::checking::verify::verify_written;
use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor};
use crate::path::moves::Path;
use crate::reading::options::ReadOptions;
use crate::text::program::Program;
use crate::writing::options::WriteOptions;
use crate::writing::write::write_corrected;
use crate::writing::written::Corrected;

/// A program that was read, in G-code or in the language of a robot.
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100\nM2\n")?;
/// let reading = ReadOptions::default();
/// let path = interpret(&program, &reading)?;
/// let gcode = Gcode { program: &program, path: &path, reading: &reading };
/// let program: &dyn MachineProgram = &gcode;
///
/// let raised = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.25));
/// let writing = WriteOptions::default();
/// let written = program.write(&raised, &writing, &Unwatched)?;
/// assert_eq!(program.verify(&written, &writing)?.moves, program.path().moves.len());
/// assert_eq!((program.statement_count(), program.bytes().len()), (5, 43));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait MachineProgram: Sync {
    /// Bytes of the program, as read.
    fn bytes(&self) -> &[u8];

    /// Number of blocks or statements.
    fn statement_count(&self) -> usize;

    /// Path of the tool.
    fn path(&self) -> &Path;

    /// Line of the first comment that marks it as compensated, from 1.
    fn mark_line(&self) -> Option<usize>;

    /// The program whose commanded path is its own plus the field's correction.
    ///
    /// # Errors
    /// See [`WriteError`]; nothing is returned in part.
    fn write(
        &self,
        field: &dyn CorrectionField,
        options: &WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Corrected, WriteError>;

    /// Reads what was written again and checks what every written program satisfies.
    ///
    /// # Errors
    /// [`WriteError::Verification`] with the first promise that is broken.
    fn verify(
        &self,
        written: &Corrected,
        options: &WriteOptions,
    ) -> Result<Verification, WriteError>;
}

/// A program in G-code with its path.
#[derive(Debug, Clone, Copy)]
pub struct Gcode<'a> {
    /// The program as read.
    pub program: &'a Program,
    /// Result of [`crate::interpret`].
    pub path: &'a Path,
    /// Options it was read with.
    pub reading: &'a ReadOptions,
}

impl MachineProgram for Gcode<'_> {
    fn bytes(&self) -> &[u8] {
        self.program.bytes()
    }

    fn statement_count(&self) -> usize {
        self.program.block_count()
    }

    fn path(&self) -> &Path {
        self.path
    }

    fn mark_line(&self) -> Option<usize> {
        self.program.mark_line()
    }

    fn write(
        &self,
        field: &dyn CorrectionField,
        options: &WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Corrected, WriteError> {
        write_corrected(self.program, self.path, field, options, monitor)
    }

    fn verify(
        &self,
        written: &Corrected,
        options: &WriteOptions,
    ) -> Result<Verification, WriteError> {
        verify_written(self.program, self.path, written, self.reading, options)
    }
}
