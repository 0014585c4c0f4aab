//! A program that was to be run once and written flat, with all that is refused: by the run, and by the reader behind refused lines.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::ProgramError;
use crate::text::edits::Edits;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;

/// Suffix to the remedy of the last executed line.
const NOT_RUN: &str = " (the lines behind this one were not run: what they do depends on it)";

/// Limit of the faults of one run: a loop of refused lines must end.
const MOST_FAULTS: usize = 100_000;

/// Error of a program that is not expanded.
pub struct RefusedRun {
    pub faults: Vec<ProgramError>,
    /// Output written nevertheless, with refused lines unchanged.
    pub flat: Option<Box<FlatText>>,
}

impl From<Vec<ProgramError>> for RefusedRun {
    fn from(faults: Vec<ProgramError>) -> Self {
        Self { faults, flat: None }
    }
}

/// Effect of a refused line on the rest of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Behind {
    /// The rest does not depend on the line.
    Same,
    /// The rest depends on it.
    Depends,
    /// The rest is not run.
    Nothing,
}

/// Faults of a run by the file and the place there, each line once.
#[derive(Default)]
pub(crate) struct FaultsOfRun {
    found: BTreeMap<(usize, usize), ProgramError>,
    count: usize,
}

impl FaultsOfRun {
    /// Adds one, of a file by its index; whether the run goes on.
    pub(crate) fn add(&mut self, file: usize, fault: ProgramError, behind: Behind) -> bool {
        let known = self.found.entry((file, fault.line)).or_insert(fault);
        if behind == Behind::Depends {
            known.remedy.push_str(NOT_RUN);
        }
        self.count += 1;
        behind == Behind::Same && self.count < MOST_FAULTS
    }

    /// Faults in the order of files and lines.
    pub(crate) fn into_faults(self) -> Vec<ProgramError> {
        self.found.into_values().collect()
    }
}

/// A flat program with changes, which add so many lines before or behind lines of it, counted from 1.
///
/// # Errors
/// Changes that overlap; what to do.
pub(crate) fn edited(
    flat: FlatText,
    edits: Edits,
    added: &BTreeMap<usize, usize>,
    files: &[SourceFile],
    remedy: &str,
) -> Result<FlatText, Vec<ProgramError>> {
    let Some(bytes) = edits.applied_to(flat.file.bytes()) else {
        let overlap = "its words overlap";
        return Err(vec![ProgramError::of_flat(
            &flat, files, 0, overlap, remedy,
        )]);
    };
    let lines = flat.origins.iter().enumerate();
    let origins = lines.flat_map(|(index, origin)| {
        let added = added.get(&(index + 1)).map_or(0, |added| *added);
        std::iter::repeat_n(*origin, 1 + added)
    });
    Ok(FlatText {
        file: SourceFile::new(flat.file.name(), bytes),
        origins: origins.collect(),
        changed: true,
        findings: flat.findings,
    })
}

/// A flat program with its corners written out by `written_out`; refused with all that was refused before.
pub(crate) fn with_corners(
    flat: FlatText,
    mut faults: Vec<ProgramError>,
    written_out: impl FnOnce(FlatText) -> Result<FlatText, Vec<ProgramError>>,
) -> Result<FlatText, RefusedRun> {
    let kept = flat.clone();
    let flat = match written_out(flat) {
        Ok(flat) if faults.is_empty() => return Ok(flat),
        Ok(flat) => flat,
        Err(of_corners) => {
            faults.extend(of_corners);
            kept
        }
    };
    Err(RefusedRun {
        faults,
        flat: Some(Box::new(flat)),
    })
}

impl RefusedRun {
    /// With what `read` refuses of the flat program, in the order of the files that are given and their lines. A line that the run
    /// refuses is told once.
    pub(crate) fn with_reading(
        self,
        files: &[SourceFile],
        read: impl FnOnce(SourceFile) -> Vec<ProgramError>,
    ) -> Vec<ProgramError> {
        let mut faults = self.faults;
        if let Some(flat) = self.flat {
            let index = |fault: &ProgramError| files.iter().position(|f| f.name() == fault.file);
            let told: BTreeSet<(Option<usize>, usize)> = faults
                .iter()
                .map(|fault| (index(fault), fault.line))
                .collect();
            let mut known = BTreeSet::new();
            for fault in read(flat.file.clone()) {
                let fault = fault.at_source(&flat.origins, files);
                let place = (index(&fault), fault.line);
                // Lines that run again are told once.
                if !told.contains(&place) && known.insert((place, fault.reason.clone())) {
                    faults.push(fault);
                }
            }
        }
        faults.sort_by_key(|fault| {
            let file = files.iter().position(|file| file.name() == fault.file);
            (file, fault.line, fault.span.start)
        });
        faults
    }
}
