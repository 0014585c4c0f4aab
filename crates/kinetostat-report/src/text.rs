//! Text that comes from files: made harmless and short enough for its place.

/// Text without characters that could hide or reorder what is shown.
pub(crate) fn clean(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\n' | '\r' | '\t' => ' ',
            c if c.is_control() => '\u{fffd}',
            // Marks that change the direction of text.
            '\u{061c}'
            | '\u{200e}'
            | '\u{200f}'
            | '\u{202a}'..='\u{202e}'
            | '\u{2066}'..='\u{2069}' => '\u{fffd}',
            c => c,
        })
        .collect()
}

/// Clean text, or a word for its absence.
pub(crate) fn or_unknown(text: &str) -> String {
    let text = clean(text);
    if text.trim().is_empty() {
        "not stated".to_owned()
    } else {
        text
    }
}

/// Shortens to at most `most` characters; the cut is marked.
pub(crate) fn shorten(text: &str, most: usize) -> String {
    let text = clean(text);
    if text.chars().count() <= most {
        return text;
    }
    let mut out: String = text.chars().take(most.saturating_sub(1)).collect();
    out.push('…');
    out
}

/// Text as content or attribute of an element.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in clean(text).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// Width of text in units of its size, on the safe side for common sans-serif fonts.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let units: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | 't' | 'f' | 'r' | 'I' | '.' | ',' | ':' | ' ' | '\'' => 0.32,
            '\u{202f}' => 0.22,
            'm' | 'w' | 'M' | 'W' | '…' => 0.9,
            c if c.is_ascii_uppercase() => 0.7,
            c if c.is_ascii() => 0.57,
            '\u{2212}' | 'µ' | '×' => 0.62,
            _ => 1.0,
        })
        .sum();
    units * size
}

/// Width in bold type.
pub(crate) fn bold_width(text: &str, size: f64) -> f64 {
    1.22 * width(text, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_text_is_harmless() {
        assert_eq!(escape("<script>\"'&"), "&lt;script&gt;&quot;&#39;&amp;");
        assert_eq!(clean("a\u{202e}b\u{0}c\nd"), "a\u{fffd}b\u{fffd}c d");
        assert_eq!(shorten("abcdef", 4), "abc…");
        assert_eq!(or_unknown("  "), "not stated");
    }
}
