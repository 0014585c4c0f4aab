//! Formulas that are written in plain characters (`K_x`, `l^2`, `sqrt 3`, `theta1`) as HTML: indices
//! and powers, Greek letters, signs.

/// Names of Greek letters.
pub(crate) const GREEK: [(&str, &str); 13] = [
    ("theta", "\u{3b8}"),
    ("Theta", "\u{398}"),
    ("delta", "\u{3b4}"),
    ("Delta", "\u{394}"),
    ("alpha", "\u{3b1}"),
    ("beta", "\u{3b2}"),
    ("gamma", "\u{3b3}"),
    ("lambda", "\u{3bb}"),
    ("phi", "\u{3c6}"),
    ("psi", "\u{3c8}"),
    ("omega", "\u{3c9}"),
    ("pi", "\u{3c0}"),
    ("th", "\u{3b8}"),
];

/// Words for signs.
const SIGNS: [(&str, &str); 3] = [
    ("sqrt", "\u{221a}"),
    ("thth", "\u{3b8}\u{3b8}"),
    ("thq", "\u{3b8}q"),
];

/// A text with its formulas, safe in a page.
pub(crate) fn html(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut out = String::new();
    let mut i = 0;
    while i < letters.len() {
        let c = letters[i];
        let raised = match c {
            '_' => Some("sub"),
            '^' => Some("sup"),
            _ => None,
        };
        // An index belongs to a short name: words with underscores are names of something else.
        let base = out_word(&letters[..i]);
        if let Some(tag) = raised.filter(|_| i > 0 && base <= 4 && !letters[i - 1].is_whitespace())
        {
            let end = script(&letters, i + 1);
            if end > i + 1 {
                let inner: String = letters[i + 1..end].iter().collect();
                out.push_str(&format!("<{tag}>{}</{tag}>", html(&inner)));
                i = end;
                continue;
            }
        }
        if c.is_ascii_alphabetic() && (i == 0 || !letters[i - 1].is_ascii_alphabetic()) {
            let end = i + letters[i..]
                .iter()
                .take_while(|c| c.is_ascii_alphabetic())
                .count();
            let word: String = letters[i..end].iter().collect();
            match GREEK.iter().chain(&SIGNS).find(|(name, _)| *name == word) {
                Some((_, sign)) => out.push_str(sign),
                None => out.push_str(&word),
            }
            i = end;
            continue;
        }
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
        i += 1;
    }
    out
}

/// Letters and digits right before a place.
fn out_word(before: &[char]) -> usize {
    before
        .iter()
        .rev()
        .take_while(|c| c.is_alphanumeric())
        .count()
}

/// End of an index or a power that begins at `start`.
fn script(letters: &[char], start: usize) -> usize {
    if letters.get(start) == Some(&'(') {
        let close = letters[start..].iter().position(|c| *c == ')');
        return close.map_or(start, |at| start + at + 1);
    }
    let sign = usize::from(matches!(letters.get(start), Some('-' | '\u{2212}')));
    // A point between two digits belongs to a number, as in `k_c1.1`; another one ends a sentence.
    let digit = |at: usize| letters.get(at).is_some_and(char::is_ascii_digit);
    let count = (start + sign..letters.len())
        .take_while(|&at| match letters[at] {
            '.' => at > start + sign && digit(at - 1) && digit(at + 1),
            c => c.is_ascii_alphanumeric(),
        })
        .count();
    match count {
        0 => start,
        n => start + sign + n,
    }
}
