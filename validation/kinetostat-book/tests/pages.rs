//! The book is whole: what its theory map names exists, its links lead somewhere, and no example
//! escapes the tests.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All files of an ending below a folder.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn pages() -> Vec<PathBuf> {
    files(&root().join("book/src"), "md")
}

/// Lines of a page outside of fences, and the first line of every fence with its body.
fn parted(text: &str) -> (Vec<&str>, Vec<(&str, String)>) {
    let (mut prose, mut fences) = (Vec::new(), Vec::new());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        match line.strip_prefix("```") {
            Some(language) => {
                let body: Vec<&str> = lines.by_ref().take_while(|l| *l != "```").collect();
                fences.push((language, body.join("\n")));
            }
            None => prose.push(line),
        }
    }
    (prose, fences)
}

/// Whether a text defines a function, a type or a trait of that name.
fn defines(text: &str, name: &str) -> bool {
    ["fn ", "struct ", "enum ", "trait ", "type "]
        .iter()
        .any(|word| {
            let head = format!("{word}{name}");
            text.match_indices(&head).any(|(at, _)| {
                let next = text[at + head.len()..].chars().next();
                next.is_none_or(|c| !c.is_alphanumeric() && c != '_')
            })
        })
}

/// Words in backticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// All source of the workspace, tests included.
fn source() -> String {
    let mut all = String::new();
    let folders = ["crates", "validation"].map(|folder| fs::read_dir(root().join(folder)));
    for krate in folders.into_iter().flat_map(|all| all.expect("crates")) {
        let krate = krate.expect("a crate").path();
        for folder in ["tests", "src"] {
            if krate.join(folder).is_dir() {
                for file in files(&krate.join(folder), "rs") {
                    all.push_str(&read(&file));
                }
            }
        }
    }
    all
}

#[test]
fn every_function_and_test_of_the_theory_map_exists() {
    let text = read(&root().join("book/src/theory-map.md"));
    let tests = source();
    let (mut rows, mut missing) = (0, Vec::new());
    for line in text.lines().filter(|l| l.starts_with("| ")) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").collect();
        assert_eq!(cells.len(), 4, "{line}");
        if cells[2].trim() == "function" {
            continue;
        }
        rows += 1;
        let functions = quoted(cells[2]);
        assert!(
            !functions.is_empty() && functions.len().is_multiple_of(2),
            "{line}"
        );
        for pair in functions.chunks(2) {
            let of_core = root().join("crates/kinetostat/src").join(pair[1]);
            let file = match of_core.exists() {
                true => of_core,
                false => root().join(pair[1]),
            };
            let source = read(&file);
            for name in pair[0].split("::") {
                let own = defines(&source, name) || source.contains(&format!("impl {name}"));
                let elsewhere = name != pair[0] && source.contains(name);
                if !own && !elsewhere {
                    missing.push(format!("{name} in {}", pair[1]));
                }
            }
        }
        let named = quoted(cells[3]);
        assert!(!named.is_empty(), "no test: {line}");
        for test in named {
            if !tests.contains(&format!("fn {test}(")) {
                missing.push(format!("test {test}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(rows > 50, "only {rows} rows found");
}

/// First cells of the rows of the theory map, by the heading of their table.
fn cited() -> Vec<(String, String)> {
    let text = read(&root().join("book/src/theory-map.md"));
    let (mut heading, mut found) = (String::new(), Vec::new());
    for line in text.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            title.clone_into(&mut heading);
        } else if let Some((cell, _)) = line.strip_prefix("| ").and_then(|l| l.split_once('|')) {
            found.push((heading.clone(), cell.trim().to_owned()));
        }
    }
    found
}

/// Numbers with one or two points: of equations, tables, figures and sections.
fn numbers(cell: &str) -> Vec<&str> {
    cell.split(|c: char| !c.is_ascii_digit() && c != '.')
        .map(|word| word.trim_matches('.'))
        .filter(|word| word.contains('.'))
        .collect()
}

#[test]
fn every_section_that_the_theory_map_names_exists() {
    let equations = read(&root().join("book/src/equations.md"));
    let mut seen = 0;
    for (_, cell) in cited().iter().filter(|(h, _)| h == "The corrected theory") {
        if cell.parse::<u32>().is_ok() {
            seen += 1;
            let heading = format!("\n## {cell}. ");
            assert!(
                equations.contains(&heading),
                "equations.md has no section {cell}"
            );
        }
    }
    assert!(seen >= 20, "only {seen} rows name a section");
}

/// The report's text lies beside the repository, not in it.
#[test]
fn every_equation_of_the_report_that_the_theory_map_names_exists() {
    let path = root().join("../shared/report/corousso-l1.1.txt");
    let Ok(report) = fs::read_to_string(&path) else {
        println!("SKIPPED: there is no ../shared/report, the report's numbers were not looked up");
        return;
    };
    let (mut seen, mut missing) = (0, Vec::new());
    for (heading, cell) in cited().iter().filter(|(h, _)| h.starts_with("Chapter")) {
        let words = ["Table", "Figure", "section"];
        for number in numbers(cell) {
            seen += 1;
            let before = cell.split(number).next().unwrap_or_default().trim_end();
            let title = format!("{number} ");
            let mut lines = report.lines();
            let named = |word: &str| report.contains(&format!("{word} {number}"));
            let exists = match words.iter().find(|word| before.ends_with(*word)) {
                Some(&"section") => lines.any(|l| l.trim_start().starts_with(&title)),
                // The last of `Figures 4.3 to 4.5` as the first.
                Some(word) => named(word),
                None if cell.starts_with("Figures") => named("Figure"),
                None => {
                    report.contains(&format!("({number})"))
                        || report.contains(&format!("tag{{{number}}}"))
                }
            };
            if !exists {
                missing.push(format!("{heading}: {cell}: {number}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(seen > 60, "only {seen} numbers are named");
}

/// A sentence in snake case is the name of a test: four words and more. So are some keys of model files.
fn names_a_test(word: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    word.chars().all(plain) && word.split('_').filter(|w| !w.is_empty()).count() > 3
}

#[test]
fn every_test_that_a_page_names_exists() {
    let source = source();
    let keys = read(&root().join("crates/kinetostat-model/schema/model.schema.json"));
    let (mut named, mut missing) = (0, Vec::new());
    let design = root().join("docs/design.md");
    for page in pages().into_iter().chain([design]) {
        let text = read(&page);
        for line in parted(&text).0 {
            for word in quoted(line) {
                let key = keys.contains(&format!("\"{word}\""));
                let field = source.contains(&format!(" {word}: "))
                    || source.contains(&format!("\"{word}\","));
                if !names_a_test(word) || key || field {
                    continue;
                }
                named += 1;
                if !source.contains(&format!("fn {word}(")) {
                    missing.push(format!("{}: {word}", page.display()));
                }
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(named > 100, "only {named} tests are named");
}

#[test]
fn every_page_is_in_the_summary_and_every_link_leads_somewhere() {
    let source = root().join("book/src");
    let summary = read(&source.join("SUMMARY.md"));
    let mut wrong = Vec::new();
    for page in pages() {
        let relative = page.strip_prefix(&source).expect("a page");
        let name = relative.display().to_string();
        if name != "SUMMARY.md" && !summary.contains(&format!("({name})")) {
            wrong.push(format!("{name} is not in the summary"));
        }
        let text = read(&page);
        let (prose, fences) = parted(&text);
        let mut targets: Vec<String> = Vec::new();
        for line in &prose {
            targets.extend(line.split("](").skip(1).filter_map(|rest| {
                let target = rest.split(')').next()?.split('#').next()?;
                (!target.is_empty() && !target.contains("://")).then(|| target.to_owned())
            }));
        }
        let all = prose.iter().copied().map(str::to_owned);
        for line in all.chain(fences.into_iter().map(|f| f.1)) {
            if let Some(rest) = line.split("{{#include ").nth(1) {
                let target = rest.split(['}', ':']).next().unwrap_or_default();
                targets.push(target.to_owned());
            }
        }
        let folder = page.parent().expect("a folder");
        for target in targets {
            if !folder.join(&target).exists() {
                wrong.push(format!("{name}: {target} does not exist"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The anchor that mdBook gives a heading.
fn slug(heading: &str) -> String {
    let kept = heading.trim().chars().filter_map(|c| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
        _ => None,
    });
    kept.collect()
}

/// Names of a cell of the page of functions, with the type that they belong to: `Posture::path(..)` is
/// `(Some("Posture"), "path")`.
fn functions_of(cell: &str) -> Vec<(Option<&str>, &str)> {
    let names = quoted(cell).into_iter();
    let called = names.map(|name| name.split('(').next().unwrap_or(name));
    called
        .map(|name| match name.rsplit_once("::") {
            // A room of the core is no type.
            Some((of, function)) => (
                Some(of).filter(|of| of.starts_with(char::is_uppercase)),
                function,
            ),
            None => (None, name),
        })
        .collect()
}

/// The documentation above a definition: the lines of `///` before it, attributes passed over.
fn documentation<'t>(text: &'t str, definition: &str) -> Option<Vec<&'t str>> {
    let lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().position(|line| {
        let rest = line.trim_start().strip_prefix(definition);
        rest.is_some_and(|r| !r.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })?;
    let above = lines[..at].iter().rev().map(|line| line.trim_start());
    Some(
        above
            .take_while(|l| l.starts_with("///") || l.starts_with("#["))
            .collect(),
    )
}

#[test]
fn every_function_of_the_page_of_functions_exists_and_has_an_example() {
    let core = root().join("crates/kinetostat/src");
    let sources: Vec<String> = files(&core, "rs").iter().map(|path| read(path)).collect();
    let page = read(&root().join("book/src/functions.md"));
    let rows = page.lines().filter(|line| line.starts_with('|'));
    let mut looked_at = 0;
    for row in rows.filter(|row| !row.starts_with("| question") && !row.starts_with("|--")) {
        let cell = row.split('|').nth(2).expect("a column of functions");
        for (of, name) in functions_of(cell) {
            let with_example = |definition: &str, within: Option<&str>| {
                let own = sources.iter().filter(|text| {
                    within.is_none_or(|of| {
                        text.contains(&format!("impl {of} "))
                            || text.contains(&format!("impl<'a> {of}<'a> "))
                    })
                });
                let mut found = own.filter_map(|text| documentation(text, definition));
                found.any(|doc| doc.iter().any(|line| line.contains("```")))
            };
            let function = with_example(&format!("pub fn {name}"), of);
            let types = [Some(name), of].into_iter().flatten();
            let by_type = types
                .clone()
                .any(|of| with_example(&format!("pub struct {of}"), None));
            assert!(
                function || by_type,
                "{row}\n'{name}' does not exist, or has no example"
            );
            looked_at += 1;
        }
    }
    assert!(looked_at > 20, "{looked_at} functions were looked at");
}

#[test]
fn every_anchor_exists() {
    let (mut seen, mut wrong) = (0, Vec::new());
    for page in pages() {
        let text = read(&page);
        for line in parted(&text).0 {
            for rest in line.split("](").skip(1) {
                let target = rest.split(')').next().unwrap_or_default();
                let Some((file, anchor)) = target.split_once('#') else {
                    continue;
                };
                if file.contains("://") {
                    continue;
                }
                seen += 1;
                let there = match file {
                    "" => page.clone(),
                    file => page.parent().expect("a folder").join(file),
                };
                let text = read(&there);
                let stem = there.file_stem().expect("a name").to_string_lossy();
                let named = |name: &str| text.contains(&format!("```math #{name}\n"));
                let formula = anchor.strip_prefix(&format!("eq-{stem}-"));
                let headings = text.lines().filter_map(|l| l.strip_prefix('#'));
                if !formula.is_some_and(named)
                    && !headings
                        .map(|h| slug(h.trim_start_matches('#')))
                        .any(|s| s == anchor)
                {
                    wrong.push(format!("{}: {target}", page.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(seen > 5, "only {seen} anchors are used");
}

#[test]
fn the_picture_of_the_readme_is_that_of_the_introduction() {
    let shown = read(&root().join("book/src/pictures/groove.svg"));
    assert_eq!(shown, read(&root().join("docs/preview.svg")));
}

#[test]
fn no_example_escapes_the_tests() {
    let tested = read(&root().join("validation/kinetostat-book/src/lib.rs"));
    let source = root().join("book/src");
    let (mut wrong, mut counts) = (Vec::new(), BTreeSet::new());
    for page in pages() {
        let name = page.strip_prefix(&source).expect("a page");
        let name = name.display().to_string();
        let text = read(&page);
        let mut before = "";
        let mut inside = false;
        for line in text.lines() {
            if let Some(language) = line.strip_prefix("```") {
                inside = !inside;
                if !inside {
                    continue;
                }
                counts.insert(language.to_owned());
                // A formula that others name has an anchor.
                let holds = match language.split(" #").next().unwrap_or_default() {
                    // Documentation tests of this crate; nothing may be taken out of them.
                    "rust" => tested.contains(&format!("\"{name}\"")),
                    // Run by `kinetostat-cli/tests/cli/book.rs`; formulas are read when the book is built.
                    "console" | "math" => true,
                    // Parts of files that are compiled elsewhere.
                    "rs" => true,
                    // Run by `python/tests/test_book.py`, but for those that say why not, and those of
                    // notebooks by `python/tests/test_notebooks.py`, with what they print.
                    "python" => true,
                    "text" if name.starts_with("notebooks/") => before == "<!-- output -->",
                    // Files that shell examples use.
                    "toml" | "text" | "csv" => before.starts_with("<!-- file: "),
                    _ => false,
                };
                if !holds {
                    wrong.push(format!("{name}: a fence '{language}' that nothing tests"));
                }
            }
            before = line;
        }
        for (language, body) in parted(&text).1 {
            if language == "rs" && !body.trim_start().starts_with("{{#include ") {
                wrong.push(format!("{name}: Rust that is not compiled"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(counts.contains("rust") && counts.contains("console"));
}

/// Bold symbols of formulas, as `K` or `\\theta`.
fn symbols(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for command in ["\\mathbf", "\\boldsymbol"] {
        for rest in text.split(command).skip(1) {
            let rest = rest.trim_start_matches([' ', '{']);
            let name: String = match rest.strip_prefix('\\') {
                Some(greek) => greek
                    .chars()
                    .take_while(char::is_ascii_alphabetic)
                    .collect(),
                None => rest.chars().take(1).collect(),
            };
            found.insert(name);
        }
    }
    found
}

/// One symbol for one thing: a formula has none that its page or the conventions do not bring in by a sentence.
#[test]
fn every_symbol_of_the_theory_is_introduced_in_words() {
    let page = |name: &str| read(&root().join("book/src").join(name));
    let (conventions, equations) = (page("conventions.md"), page("equations.md"));
    let words = |text: &str| symbols(&parted(text).0.join("\n"));
    let known = words(&conventions);
    let mut seen = 0;
    for (name, text) in [
        ("conventions.md", &conventions),
        ("equations.md", &equations),
    ] {
        let mut own = words(text);
        let formulas = parted(text).1.into_iter();
        let formulas: Vec<String> = formulas
            .filter(|(language, _)| language.starts_with("math"))
            .map(|(_, formula)| formula)
            .collect();
        // What stands alone before an equals sign is what the formula says.
        for part in formulas.iter().flat_map(|f| f.split("\\qquad")) {
            let left = symbols(part.split('=').next().unwrap_or_default());
            if part.contains('=') && left.len() == 1 {
                own.extend(left);
            }
        }
        for formula in &formulas {
            for symbol in symbols(formula) {
                seen += 1;
                assert!(
                    known.contains(&symbol) || own.contains(&symbol),
                    "{name}: no sentence says what {symbol} is:\n{formula}"
                );
            }
        }
    }
    assert!(seen > 50, "{seen} symbols were seen");
}
