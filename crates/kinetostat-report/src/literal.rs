//! Style sheets for documents of their own: with colours in place of variables.

use std::collections::{BTreeMap, BTreeSet};

/// Media query of dark pages, which begins the second half of a sheet.
const DARK: &str = "@media screen and (prefers-color-scheme:dark)";

/// A style sheet without variables: first with the values of light pages, then, for dark ones, once more what the variables
/// colour. Word processors, drawing programs and converters know neither variables nor dark pages; they draw the first half,
/// where they would draw all in black.
pub(crate) fn without_variables(style: &str) -> String {
    let (mut light, mut dark) = (BTreeMap::new(), BTreeMap::new());
    // True for a rule of dark pages alone, its head and its body.
    let mut rules = Vec::new();
    for (head, body) in blocks(style) {
        if head == DARK {
            let inner = blocks(body);
            dark.extend(inner.iter().flat_map(|(_, body)| variables(body)));
            rules.extend(inner.into_iter().map(|(head, body)| (true, head, body)));
        } else {
            // The first value counts.
            for (name, value) in variables(body) {
                light.entry(name).or_insert(value);
            }
            rules.push((false, head, body));
        }
    }
    let coloured: BTreeSet<&str> = (rules.iter())
        .flat_map(|(_, _, body)| declarations(body))
        .filter(|(_, value)| value.contains("var("))
        .map(|(name, _)| name)
        .collect();
    // Variables without a dark value have their light one.
    let has_dark = !dark.is_empty();
    let mut dark_or_light = light.clone();
    dark_or_light.append(&mut dark);
    let (mut out, mut night) = (String::new(), String::new());
    for (at_night, head, body) in rules {
        let own = || declarations(body).filter(|(name, _)| !name.starts_with("--"));
        if !at_night {
            rule(&mut out, head, own(), &light);
        }
        // Keeps the order of the sheet, so that later rules override earlier ones there, too.
        let kept = own().filter(|(name, _)| at_night || coloured.contains(name));
        rule(&mut night, head, kept, &dark_or_light);
    }
    if has_dark {
        out.push_str(DARK);
        out.push('{');
        out.push_str(&night);
        out.push('}');
    }
    out
}

type Values<'s> = BTreeMap<&'s str, &'s str>;

/// Heads and bodies of the outermost blocks.
fn blocks(style: &str) -> Vec<(&str, &str)> {
    let (mut all, mut depth, mut from, mut opened) = (Vec::new(), 0_usize, 0, 0);
    for (at, sign) in style.char_indices() {
        match sign {
            '{' => {
                if depth == 0 {
                    opened = at;
                }
                depth += 1;
            }
            '}' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    all.push((style[from..opened].trim(), &style[opened + 1..at]));
                    from = at + 1;
                }
            }
            _ => {}
        }
    }
    all
}

fn declarations(body: &str) -> impl Iterator<Item = (&str, &str)> {
    let all = body.split(';').filter_map(|own| own.split_once(':'));
    all.map(|(name, value)| (name.trim(), value.trim()))
}

fn variables(body: &str) -> impl Iterator<Item = (&str, &str)> {
    declarations(body).filter(|(name, _)| name.starts_with("--"))
}

/// A rule with values in place of variables; nothing without a declaration.
fn rule<'s>(
    out: &mut String,
    head: &str,
    kept: impl Iterator<Item = (&'s str, &'s str)>,
    values: &Values<'_>,
) {
    let all: Vec<String> = kept
        .map(|(name, value)| format!("{name}:{}", valued(value, values)))
        .collect();
    if !all.is_empty() {
        out.push_str(head);
        out.push('{');
        out.push_str(&all.join(";"));
        out.push('}');
        out.push('\n');
    }
}

/// A value with those of its variables; one that has none stays.
fn valued(value: &str, values: &Values<'_>) -> String {
    let (mut rest, mut out) = (value, String::new());
    while let Some((before, after)) = rest.split_once("var(") {
        let (name, behind) = after.split_once(')').unwrap_or((after, ""));
        out.push_str(before);
        match values.get(name.trim()) {
            Some(value) => out.push_str(value),
            None => out.push_str(&format!("var({name})")),
        }
        rest = behind;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_for_variables_on_light_and_on_dark_pages() {
        let style = ":root{--a:#123;--b:#fff}\n@media screen and (prefers-color-scheme:dark){:root{--a:#eee}.v{r:5}}\n\
                     svg{--c:red}.x{fill:none;stroke:var(--a)}.y,.z{fill:var(--c);r:2}.w{stroke:var(--b);r:3;border:1px solid var(--a)}";
        assert_eq!(
            without_variables(style),
            ".x{fill:none;stroke:#123}\n.y,.z{fill:red;r:2}\n.w{stroke:#fff;r:3;border:1px solid #123}\n\
             @media screen and (prefers-color-scheme:dark){\
             .v{r:5}\n.x{fill:none;stroke:#eee}\n.y,.z{fill:red}\n.w{stroke:#fff;border:1px solid #eee}\n}"
        );
        assert_eq!(without_variables(""), "");
        assert_eq!(without_variables("a{b:c}"), "a{b:c}\n");
    }

    #[test]
    fn no_variable_is_left_in_documents_of_this_crate() {
        let plot = crate::chart::plot::Plot::default().svg();
        let chatter = crate::chatter_svg("x", &kinetostat_machining::ChatterResult::default());
        for document in [plot, chatter] {
            assert!(
                !document.contains("var(") && !document.contains("--"),
                "{document}"
            );
        }
    }
}
