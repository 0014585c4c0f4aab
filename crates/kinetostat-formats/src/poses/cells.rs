//! The cells of a line of a table, and numbers in them.

use std::ops::Range;

use crate::text::number::NumberText;

/// The column of a table made of one in Parquet that says which row of the file a row is.
pub(crate) const PARQUET_ROW: &str = "parquet_row";

/// The separator of a table by its line of names: of comma, semicolon and tab the one that stands there most often.
pub(crate) fn separator_of(line: &[u8]) -> u8 {
    let mut quoted = false;
    let mut counts = [(0_usize, b','), (0, b';'), (0, b'\t')];
    for byte in line {
        quoted ^= *byte == b'"';
        for (count, separator) in &mut counts {
            *count += usize::from(!quoted && byte == separator);
        }
    }
    let mut best = counts[0];
    for other in &counts[1..] {
        if other.0 > best.0 {
            best = *other;
        }
    }
    best.1
}

/// The cells of a line: bytes of the file without blanks around them, and without the quotes around those that have them.
///
/// # Errors
/// Where a quote is not closed on the line, or something stands behind it: the bytes from there.
pub(crate) fn cells_of(
    bytes: &[u8],
    line: Range<usize>,
    separator: u8,
) -> Result<Vec<Range<usize>>, Range<usize>> {
    let mut cells = Vec::new();
    let mut from = line.start;
    loop {
        let is_blank = |at: &usize| bytes[*at] == b' ' || bytes[*at] == b'\t' && separator != b'\t';
        let start = (from..line.end)
            .find(|at| !is_blank(at))
            .unwrap_or(line.end);
        let end = match bytes.get(start).filter(|_| start < line.end) {
            Some(b'"') => {
                let close = closing_quote(bytes, start + 1..line.end).ok_or(start..line.end)?;
                cells.push(start + 1..close);
                let next = (close + 1..line.end).find(|at| !is_blank(at));
                match next {
                    Some(at) if bytes[at] != separator => return Err(start..line.end),
                    Some(at) => at,
                    None => line.end,
                }
            }
            _ => {
                let end = (start..line.end).find(|at| bytes[*at] == separator);
                let end = end.unwrap_or(line.end);
                let last = (start..end).rev().find(|at| !is_blank(at));
                cells.push(start..last.map_or(start, |at| at + 1));
                end
            }
        };
        if end >= line.end {
            return Ok(cells);
        }
        from = end + 1;
    }
}

/// The quote that closes: one that is not doubled.
fn closing_quote(bytes: &[u8], part: Range<usize>) -> Option<usize> {
    let mut at = part.start;
    while at < part.end {
        match (bytes[at], bytes.get(at + 1)) {
            (b'"', Some(b'"')) if at + 1 < part.end => at += 2,
            (b'"', _) => return Some(at),
            _ => at += 1,
        }
    }
    None
}

/// The number that bytes say; none where they say none, or one that is not finite.
pub(crate) fn number_of(bytes: &[u8], span: &Range<usize>) -> Option<NumberText> {
    let text = bytes.get(span.clone())?;
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    if !text.iter().all(is_part) {
        return None;
    }
    let value: f64 = std::str::from_utf8(text).ok()?.parse().ok()?;
    value.is_finite().then(|| NumberText {
        span: span.clone(),
        value,
    })
}
