//! From a program, its path and a field of corrections to the corrected program.

use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor};
use crate::path::moves::Path;
use crate::text::program::Program;
use crate::writing::dividing::beginning::Fitted;
use crate::writing::dividing::divide::{Division, divide};
use crate::writing::emit::Emitter;
use crate::writing::options::{Arcs, WriteOptions};
use crate::writing::written::{Corrected, WriterState};

/// Writes the program whose commanded path is the path plus the field's correction.
///
/// Feed moves are divided so that straight pieces follow the corrected curve; rapids keep one piece
/// and have their ends corrected. A feed move without length keeps the place of the move before. An
/// arc on which no correction reaches the last digit stays as it is; others become as few arcs as follow the corrected curve
/// (by R where the block has R, else by I J K), with straight pieces where no arc does, or straight pieces only
/// ([`WriteOptions::arcs`]). Everything else is carried byte for
/// byte, and a program of which nothing changes comes back as it is, without a header.
///
/// The speed along the part stays the programmed one: F of a piece is the programmed F times the
/// length written over the length on the part, written where the F in force is off by more than
/// 0.05 %, and never more than [`WriteOptions::max_feed_factor`] times the programmed F.
///
/// Call [`crate::verify_written`] before putting the result in place of a file.
///
/// # Errors
///
/// See [`WriteError`]; nothing is returned in part.
pub fn write_corrected(
    program: &Program,
    path: &Path,
    field: &dyn CorrectionField,
    options: &WriteOptions,
    monitor: &dyn Monitor,
) -> Result<Corrected, WriteError> {
    Divided::of(program, path, field, options, monitor)?.emit(None)
}

/// A program, or a part of one, whose blocks are divided: all that takes long, and does not depend on what is written before.
pub(crate) struct Divided<'a> {
    program: &'a Program,
    path: &'a Path,
    options: &'a WriteOptions,
    division: Division,
}

impl<'a> Divided<'a> {
    /// # Errors
    /// As [`write_corrected`].
    pub fn of(
        program: &'a Program,
        path: &'a Path,
        field: &dyn CorrectionField,
        options: &'a WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Self, WriteError> {
        options.check()?;
        if let Some(line) = program.mark_line()
            && !options.again
        {
            return Err(WriteError::AlreadyCompensated { line });
        }
        let mut last = 0;
        for motion in &path.moves {
            let has_words = motion.line > last
                && program
                    .line(motion.line)
                    .is_some_and(|line| !program.words(line).is_empty());
            if !has_words {
                return Err(WriteError::ForeignPath { line: motion.line });
            }
            last = motion.line;
        }
        let fitted = |_| match options.arcs {
            Arcs::Fit if !field.turns_tool() => Fitted::Arcs,
            Arcs::Fit | Arcs::Lines => Fitted::Nothing,
        };
        let division = divide(path, field, options, &fitted, monitor)?;
        Ok(Self {
            program,
            path,
            options,
            division,
        })
    }

    /// The program as it is written; of a part of a longer program from where the writer stands before it.
    ///
    /// # Errors
    /// As [`write_corrected`].
    pub fn emit(self, before: Option<&WriterState>) -> Result<Corrected, WriteError> {
        let Self {
            program,
            path,
            options,
            division,
        } = self;
        Emitter::new(program, path, options, division, before).emit()
    }
}
