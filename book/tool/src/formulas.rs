//! Formulas as MathML, which every current browser draws by itself: no script, no fonts, no network.
//!
//! `$...$` is a formula in the line, a fence named `math` one on its own, with a number and an anchor
//! (`eq-CHAPTER-3` in the file `CHAPTER.md`; `math #name` makes it `eq-CHAPTER-name`). Code stays as it
//! is. A formula that cannot be read is an error with its chapter.

use anyhow::{Context, Result, bail};
use mdbook_driver::book::{Book, Chapter};
use mdbook_preprocessor::{Preprocessor, PreprocessorContext};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};

/// The preprocessor.
pub struct Formulas;

impl Preprocessor for Formulas {
    fn name(&self) -> &str {
        "formulas"
    }

    fn run(&self, _context: &PreprocessorContext, mut book: Book) -> Result<Book> {
        let mut wrong = None;
        book.for_each_chapter_mut(
            |chapter| match rendered(&chapter.content, &anchor(chapter)) {
                Ok(text) => chapter.content = text,
                Err(error) => {
                    wrong.get_or_insert(error.context(format!("chapter '{}'", chapter.name)));
                }
            },
        );
        wrong.map_or(Ok(book), Err)
    }
}

/// Beginning of the anchors of a chapter's formulas: all chapters stand on one printed page.
fn anchor(chapter: &Chapter) -> String {
    let stem = chapter.path.as_ref().and_then(|p| p.file_stem());
    format!("eq-{}", stem.unwrap_or_default().to_string_lossy())
}

/// Markdown with every formula replaced.
fn rendered(text: &str, anchor: &str) -> Result<String> {
    let mut count = 0;
    let mut names: Vec<String> = Vec::new();
    let mut out = String::with_capacity(2 * text.len());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let fence = line.trim_start();
        let ticks = fence.chars().take_while(|&c| c == '`').count();
        if ticks < 3 {
            out.push_str(&in_line(line)?);
            out.push('\n');
            continue;
        }
        let closing = "`".repeat(ticks);
        let body: Vec<&str> = lines.by_ref().take_while(|l| l.trim() != closing).collect();
        let (word, name) = match fence[ticks..].trim().split_once(" #") {
            Some((word, name)) => (word.trim(), Some(name.trim())),
            None => (fence[ticks..].trim(), None),
        };
        if word == "math" {
            let formula = mathml(&body.join("\n"), DisplayMode::Block)?;
            count += 1;
            let id = match name {
                Some(name) => format!("{anchor}-{name}"),
                None => format!("{anchor}-{count}"),
            };
            if names.contains(&id) {
                bail!("two formulas have the anchor {id}");
            }
            out.push_str(&format!(
                "<div class=\"formula\" id=\"{id}\"><div class=\"scroll\">{formula}</div><a class=\"number\" href=\"#{id}\">({count})</a></div>\n"
            ));
            names.push(id);
        } else {
            out.push_str(line);
            out.push('\n');
            for l in body {
                out.push_str(l);
                out.push('\n');
            }
            out.push_str(&closing);
            out.push('\n');
        }
    }
    Ok(out)
}

/// One line outside of fences.
fn in_line(line: &str) -> Result<String> {
    let mut out = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(at) = rest.find(['`', '$', '\\']) {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        if rest.starts_with('\\') {
            let next = rest.chars().nth(1).map_or(0, char::len_utf8);
            out.push_str(&rest[..1 + next]);
            rest = &rest[1 + next..];
        } else if rest.starts_with('`') {
            let ticks = rest.chars().take_while(|&c| c == '`').count();
            let end = rest[ticks..]
                .find(&rest[..ticks])
                .map_or(rest.len(), |e| e + 2 * ticks);
            out.push_str(&rest[..end]);
            rest = &rest[end..];
        } else {
            let end = rest[1..]
                .find('$')
                .with_context(|| format!("a formula without its end: {line}"))?;
            out.push_str(&mathml(&rest[1..=end], DisplayMode::Inline)?);
            rest = &rest[end + 2..];
        }
    }
    out.push_str(rest);
    Ok(out)
}

/// One formula, on one line, with nothing in it that Markdown could take for its own.
fn mathml(formula: &str, display_mode: DisplayMode) -> Result<String> {
    let storage = Storage::new();
    let config = RenderConfig {
        display_mode,
        ..RenderConfig::default()
    };
    let mut out = String::new();
    push_mathml(&mut out, Parser::new(formula, &storage), config)
        .with_context(|| format!("formula {formula}"))?;
    if out.contains("<merror") {
        bail!("a formula that cannot be read: {formula}");
    }
    let mut safe = String::with_capacity(out.len());
    for c in mended(&out).chars() {
        match c {
            '\n' => safe.push(' '),
            '*' | '_' | '|' | '[' | ']' | '`' | '~' | '\\' => {
                safe.push_str(&format!("&#{};", c as u32));
            }
            c => safe.push(c),
        }
    }
    Ok(safe)
}

/// What pulldown-latex 0.8 writes amiss: a space inside of the script it precedes (`2\sin^2 x`), and a
/// named entity escaped twice.
fn mended(mathml: &str) -> String {
    const SPACE: &str = "<mspace width=\"0.1667em\" />";
    let mut out = mathml.replace("&amp;nbsp;", "\u{a0}");
    for script in ["<msup>", "<msub>", "<msubsup>"] {
        let (inside, before) = (format!("{script}{SPACE}"), format!("{SPACE}{script}"));
        out = out.replace(&inside, &before);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_replaced_and_code_is_not() {
        let text = "a $x_1$ and `$y$`\n```sh\necho $HOME\n```\n```math\nE = \\frac12 k x^2\n```\n";
        let out = rendered(text, "eq-a").expect("both formulas are right");
        assert_eq!(out.matches("<math").count(), 2, "{out}");
        assert!(out.contains("`$y$`") && out.contains("echo $HOME"));
        assert!(!out.contains('_'), "{out}");
    }

    #[test]
    fn scripts_have_two_parts_and_spaces_are_spaces() {
        let out = rendered("$2\\sin^2 x,\\ y$", "eq-a").expect("a right formula");
        assert!(
            !out.contains("nbsp") && !out.contains("<msup><mspace"),
            "{out}"
        );
        assert!(out.contains("<msup><mi>sin</mi>"), "{out}");
    }

    #[test]
    fn formulas_on_their_own_have_numbers_and_anchors() {
        let text = "```math\na\n```\n\n$b$\n\n```math #energy\nE\n```\n";
        let out = rendered(text, "eq-page").expect("right formulas");
        for (id, number) in [("eq-page-1", "(1)"), ("eq-page-energy", "(2)")] {
            let link = format!("href=\"#{id}\">{number}</a>");
            assert!(out.contains(&format!("id=\"{id}\"")), "{out}");
            assert!(out.contains(&link), "{out}");
        }
        let twice = "```math #a\nx\n```\n```math #a\ny\n```\n";
        assert!(rendered(twice, "eq-page").is_err());
    }

    #[test]
    fn a_wrong_formula_is_named() {
        for wrong in ["$\\frac{1}$", "$\\nosuchword$", "one $ only"] {
            assert!(rendered(wrong, "eq-a").is_err(), "{wrong}");
        }
    }
}
