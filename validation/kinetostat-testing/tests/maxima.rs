//! The helper fails where `f64::max` and `amax` pass, and no test of the workspace goes around it.

use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use kinetostat_testing::{LargestEntry, Worst, largest, largest_size, least};
use nalgebra::{DMatrix, Matrix6, Vector3};

fn worst(differences: &[f64]) -> Worst {
    let mut worst = Worst::new();
    differences.iter().for_each(|d| worst.add(*d));
    worst
}

fn refuses<T>(of: impl FnOnce() -> T + std::panic::UnwindSafe) -> String {
    let Err(why) = catch_unwind(of) else {
        panic!("it was accepted")
    };
    let text = why.downcast_ref::<String>().cloned();
    text.or_else(|| why.downcast_ref::<&str>().map(|t| (*t).to_owned()))
        .expect("a message")
}

#[test]
fn the_largest_size_counts() {
    let found = worst(&[0.5, -2.0, 1.0]);
    assert_eq!((found.value(), found.of(3), found.samples()), (2.0, 2.0, 3));
    assert_eq!(found.measured(), Some(2.0));
    assert!(found.holds(2.0) && !found.holds(1.9));
    assert_eq!(worst(&[0.0]).value(), 0.0);
    assert_eq!(worst(&[1.0, f64::INFINITY]).value(), f64::INFINITY);
}

#[test]
fn a_nan_fails_wherever_it_stands() {
    for place in 0..3 {
        let mut differences = [1.0, 5.0, 2.0];
        differences[place] = f64::NAN;
        assert!(
            differences.into_iter().fold(0.0, f64::max) < 6.0,
            "the trap"
        );
        let found = worst(&differences);
        assert!(!found.holds(f64::INFINITY));
        assert!(found.measured().is_some_and(f64::is_nan));
        let why = refuses(|| found.value());
        assert!(why.contains("NaN"), "{why}");
        assert!(why.contains(&format!("sample {} of 3", place + 1)), "{why}");
        assert!(why.contains("maxima.rs"), "{why}");
        refuses(|| found.of(3));
        refuses(|| largest(differences));
        refuses(|| largest_size(differences));
        refuses(|| least(differences));
        refuses(|| Vector3::from(differences).largest_entry());
    }
    assert_eq!(Vector3::new(f64::NAN, 5.0, 2.0).amax(), 5.0, "the trap");
}

#[test]
fn samples_that_were_skipped_fail() {
    assert!(!worst(&[]).holds(1.0));
    assert_eq!(worst(&[]).of_all(0), 0.0);
    assert_eq!(worst(&[]).measured(), None);
    for why in [
        refuses(|| worst(&[]).value()),
        refuses(|| worst(&[]).of(0)),
        refuses(|| worst(&[1.0, 2.0]).of(3)),
        refuses(|| worst(&[1.0, 2.0]).of(1)),
        refuses(|| worst(&[1.0]).of_all(0)),
        refuses(|| worst(&[]).of_all(1)),
    ] {
        assert!(why.contains("compared"), "{why}");
    }
    refuses(|| largest([]));
    refuses(|| largest_size([]));
    refuses(|| least([]));
    refuses(|| worst(&[]).all_apart(&[1.0], &[]));
}

#[test]
fn the_place_of_the_worst_is_kept() {
    let mut found = Worst::new();
    for (place, d) in [("here", 1.0), ("there", -3.0), ("nowhere", 2.0)] {
        found.add_at(d, || place);
    }
    assert_eq!(found.place(), "there");
    let text = found.to_string();
    assert!(text.starts_with("3e0 at there, sample 2 of 3"), "{text}");
    found.add_at(f64::NAN, || "lost");
    found.add_at(f64::INFINITY, || "far");
    let why = refuses(|| found.value());
    assert!(why.contains("at lost, sample 4 of 5"), "{why}");
}

#[test]
fn differences_of_lists_matrices_and_printed_digits() {
    let mut found = Worst::new();
    found.all_apart(&[1.0, 2.0], &[1.5, 2.25]);
    assert_eq!(found.of(2), 0.5);
    let (one, size) = (Matrix6::identity(), Matrix6::identity() * 4.0);
    let mut found = Worst::new();
    found.matrix(&one, &Matrix6::zeros(), &size);
    assert_eq!(found.of(36), 0.25);
    let mut found = Worst::new();
    found.printed(-0.000_617_541_7, -0.000_617_541_4, 7);
    assert!((found.of(1) - 3.0).abs() < 1e-6);
}

#[test]
fn extremes_of_numbers_and_matrices() {
    assert_eq!(largest([-3.0, -1.0, -2.0]), -1.0);
    assert_eq!(largest_size([-3.0, -1.0, 2.0]), 3.0);
    assert_eq!(least([-1.0, -3.0, 2.0]), -3.0);
    assert_eq!(Vector3::new(1.0, -4.0, 2.0).largest_entry(), 4.0);
    assert_eq!(DMatrix::<f64>::zeros(0, 3).largest_entry(), 0.0);
}

/// Rust files below a folder, apart: those that are tests (in folders `tests`, `examples`, `benches`, or named so, and
/// the modules of tests at the end of a source), and what is no test.
#[derive(Default)]
struct Sources {
    tests: Vec<(PathBuf, String)>,
    others: Vec<(PathBuf, String)>,
}

impl Sources {
    fn read(&mut self, folder: &Path, inside: bool) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            if path.is_dir() {
                let own = inside || ["tests", "benches", "examples"].contains(&name.as_str());
                self.read(&path, own);
            } else if name.ends_with(".rs") {
                let text = fs::read_to_string(&path).expect("a source");
                let from = match text.find("#[cfg(test)]\nmod tests {") {
                    _ if inside || name.ends_with("tests.rs") => 0,
                    Some(at) => at,
                    None => text.len(),
                };
                let (other, test) = text.split_at(from);
                self.others.push((path.clone(), other.to_owned()));
                if !test.is_empty() {
                    self.tests.push((path, test.to_owned()));
                }
            }
        }
    }
}

impl Sources {
    fn read_pages(&mut self, folder: &Path) {
        for entry in fs::read_dir(folder).expect("the book") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                self.read_pages(&path);
            } else if path.extension().is_some_and(|end| end == "md") {
                let text = fs::read_to_string(&path).expect("a page");
                self.others.push((path, text));
            }
        }
    }
}

/// Whether a line takes a maximum of many numbers that forgets NaN: `f64::max` as a function, or a fold by `.max(`.
fn folds_without_nan(line: &str) -> bool {
    let folds = line.contains("fold(") && (line.contains(".max(") || line.contains(".min("));
    // A floor makes a new name.
    let folds = folds || (grows(line) && !line.trim().starts_with("let "));
    let named = ["f64::max)", "f64::min)", "f64::max(", "f64::min("];
    folds || named.iter().any(|n| line.contains(n))
}

/// `x = x.max(..)`.
fn grows(line: &str) -> bool {
    line.trim().split_once(" = ").is_some_and(|(to, rest)| {
        let to = to
            .trim_start_matches("let ")
            .trim_start_matches("mut ")
            .trim_start_matches('*');
        rest.strip_prefix(to)
            .is_some_and(|rest| rest.starts_with(".max("))
    })
}

/// The same in a test, where also nalgebra's `amax` counts. Floors like `size.max(1e-9)` are fine: what they divide is NaN
/// where their number is.
fn forgets_nan(line: &str) -> bool {
    grows(line) || folds_without_nan(line) || line.contains(".amax()")
}

fn workspace() -> Sources {
    let mut found = Sources::default();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for folder in ["crates", "validation", "xtask"] {
        found.read(&root.join(folder), false);
    }
    // What the book shows is copied.
    found.read_pages(&root.join("book/src"));
    found
}

/// Lines of files, each behind its path, that a rule finds.
fn lines_of<'a>(
    files: impl IntoIterator<Item = &'a (PathBuf, String)>,
    rule: fn(&str) -> bool,
) -> Vec<String> {
    let mut found = Vec::new();
    for (path, text) in files {
        // A fold may have its function on the next line.
        let mut head = "";
        for line in text.lines() {
            let whole = format!("{head}{line}");
            if rule(line) || (!head.is_empty() && rule(&whole)) {
                found.push(format!("{}: {}", path.display(), whole.trim()));
            }
            let goes_on = line.contains("fold(")
                && !rule(line)
                && line.trim_end().ends_with(['|', '{', '(', ',']);
            head = if goes_on { line } else { "" };
        }
    }
    found
}

#[test]
fn no_test_takes_a_maximum_that_forgets_nan() {
    for line in [
        "worst = worst.max(d);",
        "*w = w.max(x);",
        "let gap = gap.max(turn);",
        "worst[0] = worst[0].max((a - b).abs());",
        ".fold(0.0, f64::max)",
        "let m = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));",
        "assert!((a - b).amax() < 1e-9);",
    ] {
        assert!(forgets_nan(line), "{line}");
    }
    assert!(!forgets_nan("let unit = 1e-9 * energy.max(1e-12);"));
    // This file shows them.
    let mut files = workspace().tests;
    files.retain(|(path, _)| !path.ends_with("tests/maxima.rs"));
    assert!(files.len() > 150, "{} files of tests", files.len());
    let found = lines_of(&files, forgets_nan);
    assert!(
        found.is_empty(),
        "use kinetostat_testing:\n{}",
        found.join("\n")
    );
}

/// Where sources that are no tests may fold by `f64::max`, and why.
const ALLOWED: [(&str, &str); 5] = [
    (
        "kinetostat-report/src/",
        "sizes of text and panels on a page, and values that can be drawn, which are finite",
    ),
    (
        "kinetostat/src/batch/",
        "lanes: a NaN ends them by the check of all answers (`numbers`)",
    ),
    ("program/src/checking/text.rs", "bytes of a line"),
    ("machine/singular/near.rs", "ranks"),
    ("reproduce/src/orthoglide/circle.rs", "steps"),
];

/// What the program states and decides by must not have lost a NaN: `kinetostat::number::larger` and `smaller` keep it.
/// Scales of matrices (`amax`) are left out here: what is compared with them is NaN where they should have been.
#[test]
fn no_source_folds_without_nan() {
    let files = workspace().others;
    assert!(files.len() > 400, "{} sources", files.len());
    for (part, why) in ALLOWED {
        let own = files.iter().filter(|(path, _)| is_in(path, part));
        let left = lines_of(own, folds_without_nan);
        assert!(
            !left.is_empty(),
            "{part} needs no exception any more: {why}"
        );
    }
    let excepted = |path: &Path| ALLOWED.iter().any(|(part, _)| is_in(path, part));
    let others = files.iter().filter(|(path, _)| !excepted(path));
    let found = lines_of(others, folds_without_nan);
    assert!(
        found.is_empty(),
        "use kinetostat::number::larger or smaller:\n{}",
        found.join("\n")
    );
}

/// A library that is not built for tests would never run a module of tests in its sources.
#[test]
fn no_test_stands_where_it_is_not_built() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["crates", "validation"].map(|folder| fs::read_dir(root.join(folder)));
    let mut looked_at = 0;
    for entry in folders.into_iter().flat_map(|all| all.expect("a folder")) {
        let folder = entry.expect("an entry").path();
        let Ok(manifest) = fs::read_to_string(folder.join("Cargo.toml")) else {
            continue; // The folder of scripts.
        };
        let library = manifest.split("\n[").find(|part| part.starts_with("lib]"));
        if !library.is_some_and(|part| part.contains("\ntest = false")) {
            continue;
        }
        looked_at += 1;
        let mut sources = Sources::default();
        sources.read(&folder.join("src"), true);
        for (path, text) in &sources.tests {
            assert!(!text.contains("#[cfg(test)]"), "{}", path.display());
            assert!(!text.contains("#[test]"), "{}", path.display());
        }
    }
    assert!(looked_at > 7, "{looked_at} libraries");
}

fn is_in(path: &Path, part: &str) -> bool {
    path.to_string_lossy().contains(part)
}
