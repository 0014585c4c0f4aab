//! Calls of routines: how often each runs, and what is in force where it begins.

use crate::krl::state::State;
use crate::model::motion::Runs;

/// What a routine is found to do.
#[derive(Debug, Clone, Default)]
pub(crate) struct Summary {
    /// None while it is walked or was not.
    pub leaves: Option<State>,
    pub begun: bool,
    pub calls: Vec<Call>,
    pub recursive: bool,
}

/// A call of a routine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Call {
    pub from: usize,
    pub at: State,
    pub runs: Runs,
}

/// How often each routine runs, and what is in force at its beginning; `finished` has callers behind what they call.
pub(crate) fn of_calls(
    summaries: &[Summary],
    finished: &[usize],
    main: Option<usize>,
) -> (Vec<Runs>, Vec<State>) {
    let count = summaries.len();
    let mut runs = vec![Runs::Elsewhere; count];
    let mut entry = vec![State::UNKNOWN; count];
    // Callers first.
    for routine in finished.iter().rev().copied() {
        let summary = &summaries[routine];
        let reached = summary
            .calls
            .iter()
            .filter(|call| runs[call.from] != Runs::Elsewhere);
        let mut reached = reached.map(|call| runs[call.from].max(call.runs));
        runs[routine] = match (reached.next(), reached.next()) {
            _ if summary.recursive => Runs::Repeatedly,
            (None, _) if Some(routine) == main => Runs::Once,
            (None, _) => Runs::Elsewhere,
            (Some(once), None) => once,
            (Some(_), Some(_)) => Runs::Repeatedly,
        };
        let mut states = summary
            .calls
            .iter()
            .map(|call| call.at.in_call(entry[call.from]));
        entry[routine] = match (Some(routine) == main || summary.recursive, states.next()) {
            (false, Some(first)) => states.fold(first, State::merged),
            _ => State::UNKNOWN,
        };
    }
    (runs, entry)
}
