//! What a walk knows, and what it found so far.

use std::ops::Range;

use crate::calls::Summary;
use crate::error::{ProgramError, note};
use crate::krl::lex::TokenFile;
use crate::krl::motion::Followed;
use crate::krl::state::{Settings, State};
use crate::krl::targets::Targets;
use crate::krl::touched::Touched;
use crate::krl::values::{Reason, Values};
use crate::model::motion::Runs;
use crate::options::UnknownTargets;
use crate::text::finding::Finding;

/// Deepest nesting of calls and blocks together.
pub(super) const DEEPEST: usize = 200;

/// The routine that is walked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Now {
    pub routine: usize,
    /// Of the statement in its routine.
    pub runs: Runs,
    /// The routine runs once in a run of the program, as far as the walk came.
    pub is_certain: bool,
    /// Where a RETURN left it.
    pub left: Option<State>,
    /// What was in force before the spline block that is open.
    pub spline: Option<State>,
    /// Why the next motion keeps being one: a statement before it acts somewhere along it.
    pub along_next: Option<&'static str>,
    pub depth: usize,
}

/// Where the walk is, and what it found.
pub(crate) struct Walker<'w, 'p> {
    pub values: &'w Values<'p>,
    pub targets: &'w mut Targets,
    pub settings: Settings,
    pub unknown: UnknownTargets,
    pub faults: &'w mut Vec<ProgramError>,
    pub touched: Touched,
    pub motions: Vec<Followed>,
    pub findings: Vec<Finding>,
    pub summaries: Vec<Summary<State>>,
    /// Callers behind what they call.
    pub finished: Vec<usize>,
    pub(super) now: Now,
}

impl<'w, 'p> Walker<'w, 'p> {
    pub(crate) fn new(
        values: &'w Values<'p>,
        targets: &'w mut Targets,
        unknown: UnknownTargets,
        faults: &'w mut Vec<ProgramError>,
    ) -> Self {
        Self {
            touched: Touched::of(values),
            summaries: vec![Summary::default(); values.symbols.routines.len()],
            values,
            targets,
            settings: Settings::default(),
            unknown,
            faults,
            motions: Vec::new(),
            findings: Vec::new(),
            finished: Vec::new(),
            now: Now {
                routine: 0,
                runs: Runs::Once,
                is_certain: true,
                left: None,
                spline: None,
                along_next: None,
                depth: 0,
            },
        }
    }

    /// The file of the routine that is walked.
    pub(super) fn file(&self) -> &'p TokenFile<'p> {
        self.values.file(self.now.routine)
    }

    /// Notes what is refused.
    pub(super) fn refuse(&mut self, tokens: &Range<usize>, (reason, remedy): Reason) {
        let file = self.file();
        let span = file.span(tokens);
        note(self.faults, || {
            ProgramError::at(file.source, span, reason, remedy)
        });
    }
}
