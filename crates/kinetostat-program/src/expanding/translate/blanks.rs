//! Blanks within numbers, which LinuxCNC passes over: `X 1 0` is X10.

/// A block without the blanks within its numbers; `None` if it has none. Comments stay.
pub(crate) fn without_blanks_in_numbers(text: &[u8]) -> Option<Vec<u8>> {
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let mut made = Vec::with_capacity(text.len());
    let mut at = 0;
    let mut commented = false;
    while let Some(byte) = text.get(at).copied() {
        match byte {
            b';' => {
                made.extend_from_slice(&text[at..]);
                break;
            }
            b'(' => commented = true,
            b')' => commented = false,
            _ => {}
        }
        if is_blank(&byte) && !commented {
            let blanks = text[at..].iter().take_while(|byte| is_blank(byte)).count();
            let before = made.last();
            let behind = text.get(at + blanks);
            let in_number = matches!(before, Some(b'0'..=b'9' | b'.' | b'+' | b'-'))
                && matches!(behind, Some(b'0'..=b'9' | b'.'));
            if !in_number {
                made.extend_from_slice(&text[at..at + blanks]);
            }
            at += blanks;
        } else {
            made.push(byte);
            at += 1;
        }
    }
    (made.len() < text.len()).then_some(made)
}
