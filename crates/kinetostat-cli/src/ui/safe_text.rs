//! Text of files made safe for a terminal.

/// Text of files and names made safe for a terminal: control characters other than line ends are
/// replaced, so that a comment cannot move the cursor or change colours.
pub(crate) fn safe(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\n' => c,
            '\t' => ' ',
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
            c if c.is_control() => '\u{fffd}',
            c => c,
        })
        .collect()
}
