//! What a walk knows, and what it found so far.

use crate::calls::Summary;
use crate::error::ProgramError;
use crate::model::motion::{Motion, Runs};
use crate::model::outside_call::OutsideCall;
use crate::options::{ExternalAxes, UnknownTargets};
use crate::rapid::frames::Values;
use crate::rapid::labels::Jump;
use crate::rapid::place::Place;
use crate::rapid::table::row;
use crate::rapid::targets::Targets;
use crate::rapid::tree::{Statement, TokenFile};
use crate::rapid::turning::{MODES, Modes, Moment};
use crate::table::Treatment;
use crate::text::finding::Finding;
use crate::text::name::Name;

/// The routine that is walked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Now {
    pub routine: usize,
    /// Of the statement in its routine.
    pub runs: Runs,
    /// Where a RETURN left it, and what was in force there.
    pub left: Option<(Place, Modes)>,
    pub depth: usize,
    /// How the tool turns.
    pub modes: Modes,
}

/// Where the walk is, and what it found.
pub(super) struct Walker<'w, 'p> {
    pub values: &'w mut Values<'p>,
    pub targets: &'w mut Targets,
    pub unknown: UnknownTargets,
    pub external: ExternalAxes,
    pub faults: &'w mut Vec<ProgramError>,
    pub motions: Vec<Motion>,
    /// Routine and place at the beginning of each motion.
    pub places: Vec<(usize, Place)>,
    /// External axes move alone at the beginning of a routine: behind which motions, its calls say.
    pub moves_external_at_entry: bool,
    /// EXIT or ExitCycle ended the program, on one way at least.
    pub has_ended: bool,
    pub findings: Vec<Finding>,
    /// What is called and none of the files declares.
    pub outside_calls: Vec<OutsideCall>,
    /// By routine: a function that may move the tool.
    pub moving_functions: Vec<bool>,
    pub summaries: Vec<Summary<Place>>,
    /// Callers behind what they call.
    pub finished: Vec<usize>,
    /// Of the routine that is walked: jumps that have not come to their labels.
    pub jumps: Vec<Jump>,
    /// By routine, what is in force as it begins, at the calls seen before it was walked, and when it was walked.
    pub modes_at_entry: Vec<(Modes, Moment)>,
    /// By routine, what is in force behind it.
    pub modes_behind: Vec<Modes>,
    /// Of each motion that runs once, or at every pass of a loop: what is in force.
    pub modes: Vec<Modes>,
    /// What is sure of them wherever the program comes from.
    pub anywhere: Modes,
    /// How many statements of modes were walked.
    pub modes_stated: usize,
    /// By routine, whether it, or what it calls, states modes; what is not walked to its end may.
    pub states_modes: Vec<bool>,
    /// The last one.
    pub moment: Moment,
    /// The routines that are walked, each called by the one before it.
    pub active: Vec<usize>,
    /// How often a routine was called that had been walked before.
    pub called_again: usize,
    pub now: Now,
}

/// Whether nothing in a block can move the tool.
pub(super) fn stays(values: &Values<'_>, routine: usize, block: &[Statement]) -> bool {
    block.iter().all(|statement| match statement {
        Statement::Call { tokens } => {
            let symbols = &values.symbols;
            let file = &values.files[symbols.routines[routine].file];
            let carried = |name: &Name| {
                symbols.routine(routine, name).is_none()
                    && row(name).is_some_and(|row| {
                        row.treatment == Treatment::Carried || MODES.contains(&row.name)
                    })
            };
            Name::of(file.word(tokens.start)).is_some_and(|name| carried(&name))
        }
        Statement::Branches { blocks, .. } => {
            blocks.iter().all(|block| stays(values, routine, block))
        }
        Statement::Loop { block, .. } => stays(values, routine, block),
        Statement::Label { .. } => false,
        Statement::Assignment { .. } | Statement::Leaves { .. } => true,
    })
}

impl<'p> Walker<'_, 'p> {
    /// A moment after all that were.
    pub(super) fn next_moment(&mut self) -> Moment {
        self.moment += 1;
        self.moment
    }

    /// The file of the routine that is walked.
    pub(super) fn file(&self) -> &'p TokenFile<'p> {
        let files: &'p [TokenFile<'p>] = self.values.files;
        &files[self.values.symbols.routines[self.now.routine].file]
    }
}
