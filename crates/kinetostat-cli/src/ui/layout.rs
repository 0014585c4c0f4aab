//! Text in lines, lists and columns of at most 80 characters.

use crate::ui::safe_text::safe;

/// Width of all text for people.
pub(crate) const WIDTH: usize = 80;

/// Text in lines of at most [`WIDTH`] characters, each indented.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    let (first, rest) = (" ".repeat(indent), " ".repeat(indent));
    wrap_into(&mut out, text, &first, &rest);
    out
}

/// A list entry: `- text`, with the following lines indented.
pub(crate) fn item(text: &str) -> String {
    let mut out = String::new();
    wrap_into(&mut out, text, "  - ", "    ");
    out
}

/// A line of a list of names and texts: the name in so many characters, the lines of the text below each other.
pub(crate) fn named(name: &str, width: usize, text: &str) -> String {
    let mut out = String::new();
    let name = safe(name);
    wrap_into(
        &mut out,
        text,
        &format!("  {name:<width$}  "),
        &" ".repeat(width + 4),
    );
    out
}

fn wrap_into(out: &mut String, text: &str, first: &str, rest: &str) {
    let text = safe(text);
    let mut line = first.to_owned();
    let mut empty = true;
    for word in text.split_whitespace() {
        let long = line.chars().count() + 1 + word.chars().count() > WIDTH;
        if !empty && long {
            out.push_str(&line);
            out.push('\n');
            line = rest.to_owned();
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    out.push_str(&line);
    out.push('\n');
}

/// Rows in columns: the first aligned left, the others right, two spaces between them.
pub(crate) fn columns(rows: &[Vec<String>], indent: usize) -> String {
    aligned(rows, indent, |column| column > 0)
}

/// Rows of text in columns, all aligned left; the last column may be long.
pub(crate) fn listed(rows: &[Vec<String>], indent: usize) -> String {
    aligned(rows, indent, |_| false)
}

fn aligned(rows: &[Vec<String>], indent: usize, right: impl Fn(usize) -> bool) -> String {
    let rows: Vec<Vec<String>> = rows
        .iter()
        .map(|row| row.iter().map(|cell| safe(cell)).collect())
        .collect();
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width: Vec<usize> = (0..count)
        .map(|column| {
            rows.iter()
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut out = String::new();
    for row in &rows {
        let mut line = " ".repeat(indent);
        for (column, cell) in row.iter().enumerate() {
            let padding = " ".repeat(width[column] - cell.chars().count());
            if column > 0 {
                line.push_str("  ");
            }
            if right(column) {
                line.push_str(&padding);
                line.push_str(cell);
            } else {
                line.push_str(cell);
                line.push_str(&padding);
            }
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}
