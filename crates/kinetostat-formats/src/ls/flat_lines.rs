//! Lines of a flat program, as a run writes them.

use std::collections::BTreeMap;

use crate::flat_run::Written;

/// Lines of a flat program, as they are written.
#[derive(Default)]
pub(super) struct FlatLines {
    pub written: Written,
    /// Lines of programs that are written.
    pub count: usize,
    /// They are not those of the first program in its order.
    pub is_changed: bool,
    /// New numbers of positions of called programs, by program and own number.
    pub positions: BTreeMap<(usize, u32), u32>,
}

impl FlatLines {
    pub(super) fn is_full(&self) -> bool {
        self.written.is_full()
    }

    /// Bytes and lines so far.
    pub(super) fn extent(&self) -> [usize; 2] {
        [self.written.bytes.len(), self.written.origins.len()]
    }

    /// Takes back what was written behind an extent.
    pub(super) fn cut(&mut self, [bytes, lines]: [usize; 2]) {
        self.written.bytes.truncate(bytes);
        self.written.origins.truncate(lines);
    }

    pub(super) fn line(&mut self, text: &[u8], file: usize, line: usize) {
        // The writer numbers the lines.
        self.written
            .line(&[b"   1:", text, b";"].concat(), file, line);
    }
}
