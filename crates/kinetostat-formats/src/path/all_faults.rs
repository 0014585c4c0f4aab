//! All faults of a program in one run: those of its text, and those that keep its motions out of one path.

use thiserror::Error;

use crate::error::ProgramError;
use crate::model::language::Language;
use crate::model::parsed::Parsed;
use crate::options::ReadOptions;
use crate::path::fault::PathError;
use crate::path::motion_faults::faults_of_motions;
use crate::text::source::SourceFile;

/// Error that keeps a program from being corrected.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, all_faults};
///
/// let files = vec![SourceFile::new("part.src", "DEF part()\nLIN NOWHERE\nEND\n")];
/// let faults = all_faults(Language::Krl, files, &ReadOptions::default());
/// assert_eq!(faults[0].place(), ("part.src", 2));
/// assert!(faults[0].reason().contains("NOWHERE"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ProgramFault {
    /// Something in its text is refused.
    #[error(transparent)]
    Text(#[from] ProgramError),
    /// A motion cannot stand in one path with the others.
    #[error(transparent)]
    Path(#[from] PathError),
}

impl ProgramFault {
    /// Name of the file, and line counted from 1.
    #[must_use]
    pub fn place(&self) -> (&str, usize) {
        match self {
            Self::Text(error) => (&error.file, error.line),
            Self::Path(error) => (&error.file, error.line),
        }
    }

    /// Reason for the refusal.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self {
            Self::Text(error) => &error.reason,
            Self::Path(error) => &error.reason,
        }
    }
}

/// All that [`crate::read`] refuses, and with it what [`crate::path_of`] would refuse of the motions that could be read, in order of
/// files and lines.
///
/// The motions beside the faults are looked at, too.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, all_faults};
///
/// let text = "DEF part()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0\n\
///     LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN XNOWHERE\nEND\n";
/// let files = vec![SourceFile::new("part.src", text)];
/// let faults = all_faults(Language::Krl, files, &ReadOptions::default());
/// assert_eq!(faults.iter().map(|fault| fault.place().1).collect::<Vec<_>>(), [5, 6]);
/// assert_eq!(faults[0].reason(), "its speed is 0 mm/s");
/// assert!(faults[1].reason().contains("XNOWHERE"));
/// ```
#[must_use]
pub fn all_faults(
    language: Language,
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Vec<ProgramFault> {
    let names: Vec<String> = files.iter().map(|file| file.name().to_owned()).collect();
    let Parsed { program, faults } = language.parse(files, options);
    let of_path = faults_of_motions(&program);
    let of_text = faults.into_iter().map(ProgramFault::from);
    let mut all: Vec<ProgramFault> = of_text
        .chain(of_path.into_iter().map(ProgramFault::from))
        .collect();
    let place = |fault: &ProgramFault| {
        let (file, line) = fault.place();
        (names.iter().position(|name| name == file), line)
    };
    all.sort_by_cached_key(place);
    all
}
