//! Bytes as the characters that the YAML parser reads: one for each byte, so that its places are bytes.

use saphyr_parser::Input;

/// A text that is read.
pub(crate) struct Characters<'b> {
    rest: &'b [u8],
    /// Number of characters that the parser has requested.
    asked: usize,
}

impl<'b> Characters<'b> {
    /// All of a text.
    pub(crate) fn of(rest: &'b [u8]) -> Self {
        Self { rest, asked: 0 }
    }

    fn advance(&mut self, count: usize) {
        self.rest = &self.rest[count.min(self.rest.len())..];
    }

    fn taken_while(&mut self, is_taken: impl Fn(&u8) -> bool) -> usize {
        let count = self.rest.iter().take_while(|byte| is_taken(byte)).count();
        self.advance(count);
        count
    }
}

/// Replaces a non-ASCII byte; such bytes never belong to a number or a known name.
fn character(byte: u8) -> char {
    match byte {
        0..=0x7f => char::from(byte),
        _ => 'x',
    }
}

/// True if a byte does not end a line.
fn is_in_line(byte: &u8) -> bool {
    !matches!(byte, b'\0' | b'\n' | b'\r')
}

impl Input for Characters<'_> {
    #[inline]
    fn lookahead(&mut self, count: usize) {
        self.asked = usize::max(self.asked, count);
    }

    #[inline]
    fn buflen(&self) -> usize {
        self.asked
    }

    /// The parser takes memory for so many characters at every scalar: a number of all its digits fits.
    #[inline]
    fn bufmaxlen(&self) -> usize {
        32
    }

    #[inline]
    fn raw_read_ch(&mut self) -> char {
        let next = self.peek();
        self.advance(1);
        next
    }

    #[inline]
    fn raw_read_non_breakz_ch(&mut self) -> Option<char> {
        let next = self.rest.first().filter(|byte| is_in_line(byte))?;
        let next = character(*next);
        self.advance(1);
        Some(next)
    }

    #[inline]
    fn skip(&mut self) {
        self.advance(1);
    }

    #[inline]
    fn skip_n(&mut self, count: usize) {
        self.advance(count);
    }

    #[inline]
    fn peek(&self) -> char {
        self.peek_nth(0)
    }

    #[inline]
    fn peek_nth(&self, n: usize) -> char {
        self.rest.get(n).map_or('\0', |byte| character(*byte))
    }

    #[inline]
    fn peek_opt(&self) -> Option<char> {
        self.rest.first().map(|byte| character(*byte))
    }

    fn skip_while_non_breakz(&mut self) -> usize {
        self.taken_while(is_in_line)
    }

    fn skip_while_blank(&mut self) -> usize {
        self.taken_while(|byte| matches!(byte, b' ' | b'\t'))
    }
}
