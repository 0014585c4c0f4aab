//! Lines of a file in words.

/// Lines are named up to so many.
const MOST_NAMED: usize = 20;

/// Lines in words, those that follow one another as one.
pub(crate) fn in_words(lines: &[usize]) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for line in lines {
        match ranges.last_mut() {
            Some([_, to]) if *to + 1 == *line => *to = *line,
            _ => ranges.push([*line, *line]),
        }
    }
    let named = ranges.iter().take(MOST_NAMED);
    let named: Vec<String> = named
        .map(|[from, to]| match to - from {
            0 => from.to_string(),
            1 => format!("{from}, {to}"),
            _ => format!("{from} to {to}"),
        })
        .collect();
    let rest: usize = ranges
        .iter()
        .skip(MOST_NAMED)
        .map(|[from, to]| to - from + 1)
        .sum();
    let more = match (rest, lines.last()) {
        (1.., Some(last)) => format!(" and {rest} more, the last {last}"),
        _ => String::new(),
    };
    let word = match lines.len() {
        1 => "line",
        _ => "lines",
    };
    format!("{word} {}{more}", named.join(", "))
}
