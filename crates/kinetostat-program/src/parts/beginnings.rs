//! Where the parts of a long program begin, noted while it is surveyed: each can then be read by itself.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hasher};

use crate::parts::survey::ByKnown;
use crate::parts::windows::PartLength;
use crate::reading::interpreting::interpreter::InterpreterState;
use crate::text::program::ReaderState;

/// Where a part begins: the first line that is looked at for it.
pub(crate) struct Beginning {
    /// Number of its first own line.
    pub own: usize,
    /// Bytes before the first line that is looked at.
    pub offset: u64,
    pub reader: ReaderState,
    pub interpreter: InterpreterState,
    /// Moves before its own.
    pub moves_before: usize,
    /// Their length, from known places.
    pub before_mm: f64,
    /// Check number of all its lines.
    pub check: u64,
}

/// Check number of lines, within one run.
#[derive(Default)]
pub(crate) struct Check(DefaultHasher);

impl Check {
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    pub fn number(&self) -> u64 {
        self.0.finish()
    }
}

/// The same while the survey goes on.
pub(crate) struct Beginnings {
    length: PartLength,
    found: Vec<(Beginning, ByKnown)>,
    /// Parts of which lines still come, with the first line behind them.
    open: VecDeque<(usize, usize, Check)>,
}

impl Beginnings {
    pub fn new(length: PartLength) -> Self {
        Self {
            length,
            found: Vec::new(),
            open: VecDeque::new(),
        }
    }

    fn own(&self) -> usize {
        self.length.own.max(1)
    }

    /// Whether a part begins with this line.
    pub fn is_first_own(&self, line: usize) -> bool {
        (line - 1).is_multiple_of(self.own())
    }

    /// Looks at a line before it is read; `states` are those behind the lines before it.
    pub fn look(
        &mut self,
        line: usize,
        offset: u64,
        states: impl Fn() -> (ReaderState, InterpreterState),
        bytes: &[u8],
    ) {
        // Several begin with the first line, where parts are shorter than what is looked at beside them.
        loop {
            let own = 1 + self.found.len() * self.own();
            if line < own.saturating_sub(self.length.looked_beside()).max(1) {
                break;
            }
            let (reader, interpreter) = states();
            let beginning = Beginning {
                own,
                offset,
                reader,
                interpreter,
                moves_before: 0,
                before_mm: 0.0,
                check: 0,
            };
            let behind = own + self.own() + self.length.looked_beside();
            self.open
                .push_back((self.found.len(), behind, Check::default()));
            self.found.push((beginning, ByKnown::default()));
        }
        let is_over = |(_, behind, _): &(usize, usize, Check)| *behind <= line;
        while self.open.front().is_some_and(is_over) {
            let over = self.open.pop_front();
            if let Some((part, _, check)) = over {
                self.found[part].0.check = check.number();
            }
        }
        for (_, _, check) in &mut self.open {
            check.add(bytes);
        }
    }

    /// Notes what comes before a line, if a part begins there.
    pub fn note(&mut self, line: usize, (moves, lengths): (usize, ByKnown)) {
        let part = (line - 1) / self.own();
        if self.is_first_own(line)
            && let Some((beginning, before)) = self.found.get_mut(part)
        {
            (beginning.moves_before, *before) = (moves, lengths);
        }
    }

    /// The parts of a program of so many lines, which states these axes.
    pub fn finish(mut self, lines: usize, stated: [bool; 3]) -> Vec<Beginning> {
        for (part, _, check) in self.open {
            self.found[part].0.check = check.number();
        }
        let count = lines.div_ceil(self.length.own.max(1));
        let found = self.found.into_iter().take(count);
        let found = found.map(|(beginning, before)| Beginning {
            before_mm: before.whole_mm(stated),
            ..beginning
        });
        found.collect()
    }
}
