//! Titles of figures, in at most two lines.

use crate::text;

/// Size of the title; the style sheet says the same.
pub(crate) const TITLE_SIZE: f64 = 13.5;

/// A title in at most two lines; what is longer is cut.
pub(crate) fn title_lines(title: &str, width: f64) -> Vec<String> {
    let size = |text: &str| text::bold_width(text, TITLE_SIZE);
    let mut lines = vec![String::new()];
    for word in title.split(' ').filter(|word| !word.is_empty()) {
        let last = lines.len() - 1;
        let longer = if lines[last].is_empty() {
            word.to_owned()
        } else {
            format!("{} {word}", lines[last])
        };
        if size(&longer) <= width || lines[last].is_empty() {
            lines[last] = longer;
        } else if lines.len() < 2 {
            lines.push(word.to_owned());
        } else {
            let fitting = longer.chars().count().saturating_sub(word.chars().count());
            lines[last] = format!("{}\u{2026}", text::shorten(&lines[last], fitting));
            break;
        }
    }
    for line in &mut lines {
        if size(line) > width {
            let share = width / size(line);
            *line = text::shorten(line, (share * line.chars().count() as f64) as usize);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_titles_take_two_lines_and_no_more() {
        let long = "a title of many words that goes on and on ".repeat(8);
        let lines = title_lines(&long, 700.0);
        assert_eq!(lines.len(), 2);
        assert!(lines[1].ends_with('\u{2026}'));
        assert!(
            lines
                .iter()
                .all(|l| text::bold_width(l, TITLE_SIZE) < 720.0)
        );
        assert_eq!(title_lines("short", 700.0), ["short"]);
        assert_eq!(title_lines(&"x".repeat(500), 700.0).len(), 1);
    }
}
