//! Differences of a setting between two runs, from its values in words.

/// A longer value is not said.
const LONGEST: usize = 80;

/// A field's name, with the part of it that differs and both values: the run that was kept has `kept`, this one `now`.
pub(crate) fn difference(name: &str, kept: &str, now: &str) -> String {
    let [of_kept, of_now] = [kept, now].map(|text| text.lines().collect::<Vec<_>>());
    let first = of_kept.iter().zip(&of_now).position(|(a, b)| a != b);
    let Some(first) = first else {
        return name.to_owned();
    };
    let [was, is] = [&of_kept, &of_now].map(|lines| word_at(lines, first));
    let place = place(&of_kept, first);
    let values = [was, is].map(|(_, value)| value);
    let is_short = |value: &&str| {
        !value.is_empty() && value.len() <= LONGEST && !value.ends_with(['(', '{', '['])
    };
    let own = was.0.filter(|_| was.0 == is.0);
    let place: Vec<&str> = place.into_iter().chain(own).collect();
    let said = match values.iter().all(is_short) {
        true => format!("{} there, {} now", values[0], values[1]),
        false => String::new(),
    };
    match (place.is_empty(), said.is_empty()) {
        (true, true) => name.to_owned(),
        (true, false) => format!("{name} ({said})"),
        (false, true) => format!("{name} ({})", place.join(".")),
        (false, false) => format!("{name} ({}: {said})", place.join(".")),
    }
}

/// A line of a value as its name and what it says.
fn word(line: &str) -> (Option<&str>, &str) {
    let line = line.trim().trim_end_matches(',');
    match line.split_once(": ") {
        Some((name, value)) => (Some(name), value),
        None => (None, line),
    }
}

/// The word that begins at a line: of what may be missing, what it is where it takes a line, or "none".
fn word_at<'t>(lines: &[&'t str], at: usize) -> (Option<&'t str>, &'t str) {
    let (name, value) = word(lines[at]);
    let value = match (value, lines.get(at + 1..at + 3)) {
        ("None" | "[]", _) => "none",
        ("true", _) => "yes",
        ("false", _) => "no",
        ("Some(", Some([inside, end])) if word(end).1 == ")" => word(inside).1,
        _ => value,
    };
    (name, value)
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// The names of what a line stands in, from outside.
fn place<'t>(lines: &[&'t str], line: usize) -> Vec<&'t str> {
    let mut names = Vec::new();
    let mut inside = indent(lines[line]);
    for other in lines[..line].iter().rev() {
        if indent(other) < inside {
            inside = indent(other);
            names.extend(word(other).0);
        }
    }
    names.reverse();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Inner {
        #[expect(dead_code, reason = "shown")]
        largest_mm: Option<f64>,
    }

    #[derive(Debug)]
    struct Outer {
        #[expect(dead_code, reason = "shown")]
        tolerance_mm: f64,
        #[expect(dead_code, reason = "shown")]
        steps: Vec<Inner>,
    }

    fn said(tolerance_mm: f64, largest_mm: Option<f64>) -> String {
        let steps = vec![Inner { largest_mm: None }, Inner { largest_mm }];
        format!(
            "{:#?}",
            Outer {
                tolerance_mm,
                steps
            }
        )
    }

    #[test]
    fn the_innermost_name_and_both_values_are_said() {
        let between = |a: String, b: String| difference("how it is written", &a, &b);
        let whole = between(said(0.001, None), said(0.002, None));
        assert_eq!(
            whole,
            "how it is written (tolerance_mm: 0.001 there, 0.002 now)"
        );
        let inside = between(said(1.0, Some(2.0)), said(1.0, Some(2.5)));
        assert_eq!(
            inside,
            "how it is written (steps.largest_mm: 2.0 there, 2.5 now)"
        );
        let other = between(said(1.0, None), said(1.0, Some(2.5)));
        assert_eq!(
            other,
            "how it is written (steps.largest_mm: none there, 2.5 now)"
        );
        let list = |value: &str| format!("Outer {{\n    header: {value},\n    whole: false,\n}}");
        let found = between(list("None"), list("true"));
        assert_eq!(found, "how it is written (header: none there, yes now)");
        let plain = between("0.1.0".to_owned(), "0.2.0".to_owned());
        assert_eq!(plain, "how it is written (0.1.0 there, 0.2.0 now)");
    }
}
