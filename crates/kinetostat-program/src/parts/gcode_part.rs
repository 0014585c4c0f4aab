//! A part of a program in G-code as a program that is written.

use crate::checking::verifier::Verification;
use crate::checking::verify::against_input;
use crate::error::WriteError;
use crate::field::request::{CorrectionField, Monitor};
use crate::machine_program::MachineProgram;
use crate::parts::in_order::PlaceInOrder;
use crate::parts::windows::Part;
use crate::path::moves::Path;
use crate::writing::options::WriteOptions;
use crate::writing::write::Divided;
use crate::writing::written::Corrected;

/// A part of a program in G-code, to be written behind the parts before it.
pub struct GcodePart<'a, 'o> {
    /// The part.
    pub part: &'a Part,
    /// Place of the part among the others.
    pub place: &'a PlaceInOrder<'a, 'o>,
}

impl MachineProgram for GcodePart<'_, '_> {
    fn bytes(&self) -> &[u8] {
        self.part.program.own_bytes()
    }

    fn statement_count(&self) -> usize {
        self.part.program.block_count()
    }

    fn path(&self) -> &Path {
        &self.part.path
    }

    fn mark_line(&self) -> Option<usize> {
        let own = self.part.program.own_numbers();
        let found = self.part.program.mark_line();
        found.filter(|line| own.contains(line))
    }

    fn write(
        &self,
        field: &dyn CorrectionField,
        options: &WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Corrected, WriteError> {
        let (program, path) = (&self.part.program, &self.part.path);
        let divided = Divided::of(program, path, field, options, monitor)?;
        let before = self.place.before().ok_or(WriteError::Cancelled)?;
        divided.emit(before.writer())
    }

    fn verify(
        &self,
        written: &Corrected,
        options: &WriteOptions,
    ) -> Result<Verification, WriteError> {
        let before = self.place.before().ok_or(WriteError::Cancelled)?;
        let again = before.read_again(written);
        let (output, output_path, behind) = again.map_err(|error| WriteError::Verification {
            line: 0,
            output_line: error.line,
            what: format!("it cannot be read again: {error}"),
        })?;
        self.place.put_behind(behind);
        let (input, input_path) = (&self.part.program, &self.part.path);
        against_input(input, input_path, &output, &output_path, written, options)
    }
}
