//! What the calls of routines say together: how often each runs, and what holds where it begins.

use crate::model::motion::Runs;

/// What a routine is found to do; `S` is what is followed from statement to statement.
#[derive(Debug, Clone)]
pub(crate) struct Summary<S> {
    /// None while it is walked or was not.
    pub leaves: Option<S>,
    pub begun: bool,
    pub calls: Vec<Call<S>>,
    pub recursive: bool,
}

impl<S> Default for Summary<S> {
    fn default() -> Self {
        Self {
            leaves: None,
            begun: false,
            calls: Vec::new(),
            recursive: false,
        }
    }
}

/// A call of a routine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Call<S> {
    pub from: usize,
    pub at: S,
    pub runs: Runs,
}

/// What holds at a place of a routine.
pub(crate) trait Holds: Copy {
    /// Where nothing is known of it.
    const UNKNOWN: Self;

    /// What is the same in both.
    fn merged(self, other: Self) -> Self;

    /// As it is where the routine is called with this.
    fn in_call(self, at: Self) -> Self;
}

/// How often each routine runs and what holds where it begins, by index; `finished` has callers behind what they call.
pub(crate) fn of_calls<S: Holds>(
    summaries: &[Summary<S>],
    finished: &[usize],
    main: Option<usize>,
) -> (Vec<Runs>, Vec<S>) {
    let mut runs = vec![Runs::Elsewhere; summaries.len()];
    let mut entry = vec![S::UNKNOWN; summaries.len()];
    // Callers first.
    for routine in finished.iter().rev().copied() {
        let summary = &summaries[routine];
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
        let mut states = calls.map(|call| call.at.in_call(entry[call.from]));
        let unknown = Some(routine) == main || summary.recursive;
        entry[routine] = match (unknown, states.next()) {
            (false, Some(first)) => states.fold(first, S::merged),
            _ => S::UNKNOWN,
        };
    }
    (runs, entry)
}
