//! What the calls of routines say together: how often each runs, and where the tool is as it begins.

use crate::model::motion::Runs;

/// Where the tool is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Where it was as the routine was called.
    Entry,
    /// At the end of a motion.
    Motion(usize),
    /// Not known from the text.
    Unknown,
}

/// Where the tool is after one of two ways.
pub(crate) fn merge(one: Place, other: Place) -> Place {
    match one == other {
        true => one,
        false => Place::Unknown,
    }
}

/// What a routine is found to do.
#[derive(Debug, Clone, Default)]
pub(crate) struct Summary {
    /// None while it is walked or was not.
    pub leaves: Option<Place>,
    pub begun: bool,
    pub calls: Vec<Call>,
    pub recursive: bool,
}

/// A call of a routine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Call {
    pub from: usize,
    pub at: Place,
    pub runs: Runs,
}

/// How often each routine runs and where it begins, by index; `finished` has callers behind what they call.
pub(crate) fn of_calls(
    summaries: &[Summary],
    finished: &[usize],
    main: Option<usize>,
) -> (Vec<Runs>, Vec<Place>) {
    let mut runs = vec![Runs::Elsewhere; summaries.len()];
    let mut entry = vec![Place::Unknown; summaries.len()];
    for routine in finished.iter().rev().copied() {
        let summary = &summaries[routine];
        let from = |call: &Call| match call.at {
            Place::Entry => entry[call.from],
            place => place,
        };
        // What a jump leaves out calls nothing.
        let calls = (summary.calls.iter()).filter(|call| call.runs != Runs::Elsewhere);
        let reached = (calls.clone()).filter(|call| runs[call.from] != Runs::Elsewhere);
        let mut reached = reached.map(|call| runs[call.from].max(call.runs));
        runs[routine] = match (reached.next(), reached.next()) {
            _ if summary.recursive => Runs::Repeatedly,
            (None, _) if Some(routine) == main => Runs::Once,
            (None, _) => Runs::Elsewhere,
            (Some(once), None) => once,
            (Some(_), Some(_)) => Runs::Repeatedly,
        };
        let mut places = calls.map(from);
        let unknown = Some(routine) == main || summary.recursive;
        entry[routine] = match (unknown, places.next()) {
            (false, Some(first)) => places.fold(first, merge),
            _ => Place::Unknown,
        };
    }
    (runs, entry)
}
