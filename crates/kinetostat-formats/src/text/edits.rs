//! Replaced and inserted ranges of a file; what lies between comes back byte for byte.

use std::ops::Range;

/// Replacements in one text. An empty range inserts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Edits(Vec<(Range<usize>, Vec<u8>)>);

impl Edits {
    /// Puts `bytes` in place of a range. Ranges must not overlap; insertions at one place keep their order.
    pub(crate) fn replace(&mut self, span: Range<usize>, bytes: impl Into<Vec<u8>>) {
        self.0.push((span, bytes.into()));
    }

    /// True if nothing is to be replaced.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True where a byte of a range is replaced.
    pub(crate) fn touches(&self, span: &Range<usize>) -> bool {
        let mut all = self.0.iter();
        all.any(|(own, _)| own.start < span.end && span.start < own.end)
    }

    /// Adds those of another.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.0.append(&mut other.0);
    }

    /// The text with all replacements; `None` where two overlap or one lies outside.
    pub(crate) fn applied_to(mut self, text: &[u8]) -> Option<Vec<u8>> {
        self.0.sort_by_key(|(span, _)| (span.start, span.end));
        let added: usize = self.0.iter().map(|(_, bytes)| bytes.len()).sum();
        let mut output = Vec::with_capacity(text.len() + added);
        let mut at = 0;
        for (span, bytes) in &self.0 {
            output.extend_from_slice(text.get(at..span.start)?);
            output.extend_from_slice(bytes);
            at = span.end;
        }
        output.extend_from_slice(text.get(at..)?);
        Some(output)
    }

    /// Edits of a part of the text, relative to that part: for a copy of a statement.
    pub(crate) fn applied_to_part(self, text: &[u8], part: &Range<usize>) -> Option<Vec<u8>> {
        let moved = |(span, bytes): (Range<usize>, Vec<u8>)| {
            let start = span.start.checked_sub(part.start)?;
            Some((start..span.end.checked_sub(part.start)?, bytes))
        };
        let moved: Option<Vec<_>> = self.0.into_iter().map(moved).collect();
        Self(moved?).applied_to(text.get(part.clone())?)
    }
}
