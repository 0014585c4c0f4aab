//! Beginnings of the parts of a long program, noted during the survey: each part can then be read by itself.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

use crate::parts::PartLength;
use crate::reading::interpreting::InterpreterState;
use crate::text::program::ReaderState;

/// Modal state of reader and interpreter before a line.
pub(crate) type States = (ReaderState, InterpreterState);

/// Beginning of a part: the first line that is looked at for it.
pub(crate) struct Beginning {
    /// Number of its first own line.
    pub own: usize,
    /// Number of the first line behind those that are looked at.
    pub behind: usize,
    /// Bytes before the first line that is looked at.
    pub offset: u64,
    pub states: Arc<States>,
    /// Moves before its own.
    pub moves_before: usize,
    /// Their length, from known places.
    pub before_mm: f64,
    /// Check number of all its lines.
    pub check: u64,
}

/// Check number of lines, within one run.
#[derive(Clone, Default)]
pub(crate) struct Check(DefaultHasher);

impl Check {
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    pub fn number(&self) -> u64 {
        self.0.finish()
    }
}

/// A line from which a part may be looked at.
struct Candidate {
    line: usize,
    offset: u64,
    states: Arc<States>,
    /// Moves before it.
    moves: usize,
    /// Checksum of the lines from it on.
    check: Check,
}

/// A part of which lines still come.
struct Open {
    part: usize,
    check: Check,
    /// Moves before the first line behind its own, once that is reached.
    moves_to_end: Option<usize>,
}

/// Beginnings found so far during the survey.
pub(crate) struct Beginnings {
    length: PartLength,
    found: Vec<(Beginning, ByKnown)>,
    candidates: VecDeque<Candidate>,
    open: VecDeque<Open>,
}

/// A line that is looked at before it is read.
pub(crate) struct NextLine<'a> {
    pub line: usize,
    /// Bytes before it.
    pub offset: u64,
    /// Moves before it, and their lengths as far as a part may begin here.
    pub before: (usize, ByKnown),
    pub bytes: &'a [u8],
}

/// Minimum number of lines without a motion that are looked at on each side of a part; beyond them the motions on the other side are
/// not known.
const FAR: usize = 1000;

impl Beginnings {
    pub fn new(length: PartLength) -> Self {
        Self {
            length,
            found: Vec::new(),
            candidates: VecDeque::new(),
            open: VecDeque::new(),
        }
    }

    fn own(&self) -> usize {
        self.length.own.max(1)
    }

    fn beside(&self) -> usize {
        self.length.beside.max(1)
    }

    /// Lines beside a part that are looked at, at most: whatever a program is, its parts are read in proportion to its length.
    fn far(&self) -> usize {
        (self.own() + self.beside()).max(FAR)
    }

    /// True if a part begins with this line.
    pub fn is_first_own(&self, line: usize) -> bool {
        (line - 1).is_multiple_of(self.own())
    }

    /// Looks at a line before it is read; `states` are those behind the lines before it.
    pub fn look(&mut self, next: &NextLine<'_>, states: impl FnOnce() -> States) {
        let (line, (moves, lengths)) = (next.line, next.before);
        let (beside, far) = (self.beside(), self.far());
        let is_candidate = self.candidates.back().is_none_or(|last| {
            moves >= last.moves + beside.div_ceil(2) || line >= last.line + far.div_ceil(2)
        });
        if is_candidate {
            self.candidates.push_back(Candidate {
                line,
                offset: next.offset,
                states: Arc::new(states()),
                moves,
                check: Check::default(),
            });
        }
        let does = |second: &Candidate| moves >= second.moves + beside || line >= second.line + far;
        while self.candidates.get(1).is_some_and(does) {
            self.candidates.pop_front();
        }
        if self.is_first_own(line)
            && let Some(first) = self.candidates.front()
        {
            let beginning = Beginning {
                own: line,
                behind: 0,
                offset: first.offset,
                states: first.states.clone(),
                moves_before: moves,
                before_mm: 0.0,
                check: 0,
            };
            self.open.push_back(Open {
                part: self.found.len(),
                check: first.check.clone(),
                moves_to_end: None,
            });
            self.found.push((beginning, lengths));
        }
        self.close(line, moves);
        let candidates = self.candidates.iter_mut().map(|c| &mut c.check);
        let open = self.open.iter_mut().map(|open| &mut open.check);
        candidates
            .chain(open)
            .for_each(|check| check.add(next.bytes));
    }

    /// Ends parts of which enough is seen before a line.
    fn close(&mut self, line: usize, moves: usize) {
        let (own, beside, far) = (self.own(), self.beside(), self.far());
        let found = &mut self.found;
        self.open.retain_mut(|open| {
            let beginning = &mut found[open.part].0;
            let end = beginning.own + own;
            if line < end {
                return true;
            }
            let to_end = *open.moves_to_end.get_or_insert(moves);
            let is_seen = line > end && (moves >= to_end + beside || line >= end + far);
            if is_seen {
                (beginning.behind, beginning.check) = (line, open.check.number());
            }
            !is_seen
        });
    }

    /// The parts of a program of so many lines, which states these axes.
    pub fn finish(mut self, lines: usize, stated: [bool; 3]) -> Vec<Beginning> {
        for open in self.open {
            let beginning = &mut self.found[open.part].0;
            (beginning.behind, beginning.check) = (lines + 1, open.check.number());
        }
        let found = self.found.into_iter();
        let found = found.map(|(beginning, before)| Beginning {
            before_mm: before.whole_mm(stated),
            ..beginning
        });
        found.collect()
    }
}

/// Lengths by the axes that are known before the moves: which of them count is clear only when all axes are that are stated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ByKnown([f64; 8]);

impl ByKnown {
    pub fn add(&mut self, known: [bool; 3], length_mm: f64) {
        self.0[index_of(known)] += length_mm;
    }

    /// Length of the moves from known places, in a program that states these axes.
    pub fn whole_mm(&self, stated: [bool; 3]) -> f64 {
        let counts = (0..8).filter(|index| covers(*index, stated));
        counts.map(|index| self.0[index]).sum()
    }
}

/// Index below 8 of a set of known axes.
pub(crate) fn index_of(known: [bool; 3]) -> usize {
    (0..3).map(|axis| usize::from(known[axis]) << axis).sum()
}

/// True if all axes that are stated are known.
pub(crate) fn covers(index: usize, stated: [bool; 3]) -> bool {
    (0..3).all(|axis| index >> axis & 1 == 1 || !stated[axis])
}
