//! A program with what is refused in it.

use crate::error::ProgramError;
use crate::model::program::{Language, RobotProgram};
use crate::model::stated_axes::StatedAxes;
use crate::text::source::SourceFile;

/// A program as far as it could be read, and what is refused: with a fault it must not be corrected.
pub(crate) struct Parsed {
    /// All but the motions that are refused.
    pub program: RobotProgram,
    /// In order of files and lines.
    pub faults: Vec<ProgramError>,
}

impl Parsed {
    /// Of files of which nothing can be read.
    pub(crate) fn refused(language: Language, faults: Vec<ProgramError>) -> Self {
        Self {
            program: RobotProgram {
                language,
                files: Vec::new(),
                motions: Vec::new(),
                findings: Vec::new(),
                declarations: Vec::new(),
                rotary: StatedAxes::default(),
            },
            faults,
        }
    }

    /// The program, if nothing is refused.
    pub(crate) fn without_faults(self) -> Result<RobotProgram, Vec<ProgramError>> {
        match self.faults.is_empty() {
            true => Ok(self.program),
            false => Err(self.faults),
        }
    }
}

/// Brings faults into the order of files and lines.
pub(crate) fn sort_faults(faults: &mut [ProgramError], files: &[SourceFile]) {
    let place = |fault: &ProgramError| {
        let file = files.iter().position(|file| file.name() == fault.file);
        (file, fault.span.start, fault.line)
    };
    faults.sort_by_cached_key(place);
}
