//! Treatment of the statements of a language by its reader, as data.
//!
//! One rule for what stops a robot: what may make it leave the programmed path, or skip a motion or a part of one, is refused by line
//! (`RESUME` of KRL and `ClearPath` of RAPID leave motions before their ends); what holds it on the path, after which it goes on there,
//! is carried (`BRAKE` and `HALT`, `StopMove` with `StartMove`, `Stop`, `PAUSE` of TP programs): the tool cuts where it would have cut.

use crate::text::Name;

/// Treatment of a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Treatment {
    /// Followed: motions, frames, declarations, control flow.
    Understood,
    /// Carried unchanged: it cannot move the tool.
    Carried,
    /// Refused: it can move the tool in an unknown way.
    Refused {
        /// Reason for the refusal.
        reason: &'static str,
        /// Remedy for the user.
        remedy: &'static str,
    },
}

/// A row of a language's table.
///
/// ```
/// use kinetostat_formats::{RAPID_STATEMENTS, Treatment};
///
/// let row = RAPID_STATEMENTS.iter().find(|row| row.name == "SearchL").unwrap();
/// assert!(matches!(row.treatment, Treatment::Refused { .. }));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatementRow {
    /// Word as in the language's manual.
    pub name: &'static str,
    /// Treatment of the statement.
    pub treatment: Treatment,
    /// Source of the meaning.
    pub source: &'static str,
}

/// A row of a table.
pub(crate) const fn line(
    name: &'static str,
    treatment: Treatment,
    source: &'static str,
) -> StatementRow {
    StatementRow {
        name,
        treatment,
        source,
    }
}

/// Statements that are treated alike.
#[derive(Clone, Copy)]
pub(crate) struct Alike {
    names: &'static [&'static str],
    treatment: Treatment,
    source: &'static str,
}

/// Statements that are treated alike, and where their meaning is from.
pub(crate) const fn alike(
    treatment: Treatment,
    source: &'static str,
    names: &'static [&'static str],
) -> Alike {
    Alike {
        names,
        treatment,
        source,
    }
}

/// Number of statements in all groups.
pub(crate) const fn count(groups: &[Alike]) -> usize {
    let (mut all, mut group) = (0, 0);
    while group < groups.len() {
        all += groups[group].names.len();
        group += 1;
    }
    all
}

/// A row for each statement of groups, in their order; rows behind them are left for others.
pub(crate) const fn rows<const N: usize>(groups: &[Alike]) -> [StatementRow; N] {
    let mut all = [line("", Treatment::Carried, ""); N];
    let (mut filled, mut group) = (0, 0);
    while group < groups.len() {
        let Alike {
            names,
            treatment,
            source,
        } = groups[group];
        let mut at = 0;
        while at < names.len() {
            all[filled] = line(names[at], treatment, source);
            filled += 1;
            at += 1;
        }
        group += 1;
    }
    all
}

/// Rows in the order of their names in capitals, sorted when they are compiled.
pub(crate) const fn sorted<const N: usize>(mut all: [StatementRow; N]) -> [StatementRow; N] {
    let mut filled = 0;
    while filled < N {
        let next = all[filled];
        let mut at = filled;
        while at > 0 && comes_before(next.name.as_bytes(), all[at - 1].name.as_bytes()) {
            all[at] = all[at - 1];
            at -= 1;
        }
        all[at] = next;
        filled += 1;
    }
    all
}

/// The row of a statement in a table that is sorted by names in capitals.
pub(crate) fn row_of(
    sorted: &'static [StatementRow],
    name: &Name,
) -> Option<&'static StatementRow> {
    let letters = name.letters();
    let key = |row: &StatementRow| row.name.bytes().map(|byte| byte.to_ascii_uppercase());
    let found = sorted.binary_search_by(|row| key(row).cmp(letters.iter().copied()));
    found.ok().map(|index| &sorted[index])
}

/// True if a name precedes another one alphabetically, ignoring case.
const fn comes_before(one: &[u8], other: &[u8]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() {
        let (a, b) = (one[at].to_ascii_uppercase(), other[at].to_ascii_uppercase());
        if a != b {
            return a < b;
        }
        at += 1;
    }
    one.len() < other.len()
}
