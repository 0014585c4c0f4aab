//! Faults of TOML are told by the words of the library `toml`: each kind here is that of an error that it makes itself.

use std::collections::BTreeMap;

use kinetostat_diagnostic::{TomlFault, TomlFaultKind, wrong_length};
use serde::Deserialize;
use serde::de::Error;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Tool {
    shape: Shape,
    teeth: u32,
    #[serde(default)]
    name: String,
    diameter_mm: Option<f64>,
    coated: Option<bool>,
    lengths_mm: Option<Vec<f64>>,
    tip_mm: Option<[f64; 3]>,
    span_mm: Option<(f64, f64)>,
    wear: Option<Wear>,
    notes: Option<BTreeMap<String, String>>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    Flat,
    Ball,
    Bull,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Wear {
    flank_um: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Nothing {}

fn fault(text: &str) -> TomlFault {
    TomlFault::of(&toml::from_str::<Tool>(text).expect_err(text))
}

/// The kind of the fault of a line behind those that every tool has.
fn kind_with(line: &str) -> TomlFaultKind {
    fault(&format!("shape = \"flat\"\nteeth = 2\n{line}\n")).kind
}

fn names(of: &[&str]) -> Vec<String> {
    of.iter().map(|name| (*name).to_owned()).collect()
}

#[test]
fn names_that_are_not_known() {
    let TomlFaultKind::UnknownKey { given, known } = kind_with("lenght_mm = 3") else {
        panic!("no unknown key");
    };
    assert_eq!((given.as_str(), known.len()), ("lenght_mm", 10));
    assert_eq!(known[..3], names(&["shape", "teeth", "name"]));
    let (given, known) = ("flank_mm".to_owned(), names(&["flank_um"]));
    let one = TomlFaultKind::UnknownKey { given, known };
    assert_eq!(kind_with("wear = { flank_mm = 1 }"), one);
    let error = toml::from_str::<Nothing>("any = 1").unwrap_err();
    let (given, known) = ("any".to_owned(), Vec::new());
    let none = TomlFaultKind::UnknownKey { given, known };
    assert_eq!(TomlFault::of(&error).kind, none);
    let word = fault("shape = \"bal\"\nteeth = 2");
    let (given, known) = ("bal".to_owned(), names(&["flat", "ball", "bull"]));
    assert_eq!(word.kind, TomlFaultKind::UnknownWord { given, known });
    assert_eq!(word.span, 8..13);
}

#[test]
fn keys_that_are_missing_or_there_twice() {
    let missing = TomlFaultKind::MissingKey("teeth".to_owned());
    assert_eq!(fault("shape = \"flat\"").kind, missing);
    assert_eq!(kind_with("teeth = 3"), TomlFaultKind::DuplicateKey);
}

#[test]
fn lists_of_another_length() {
    let length = |needed, given| TomlFaultKind::Length { needed, given };
    assert_eq!(kind_with("tip_mm = [1, 2]"), length(3, 2));
    assert_eq!(kind_with("span_mm = [1]"), length(2, 1));
    let own = toml::de::Error::custom(wrong_length(3, 4));
    assert_eq!(TomlFault::of(&own).kind, length(3, 4));
}

#[test]
fn values_of_another_kind_are_named_in_words() {
    let table = "a table { key = value, ... }";
    for (line, found, expected) in [
        ("diameter_mm = \"6 mm\"", "the text \"6 mm\"", "a number"),
        ("diameter_mm = [6]", "a list", "a number"),
        ("diameter_mm = { a = 6 }", "a table", "a number"),
        ("name = true", "the word `true`", "a text in quotes"),
        ("name = 2.5", "the number `2.5`", "a text in quotes"),
        ("coated = 1", "the number `1`", "true or false"),
        ("lengths_mm = 1", "the number `1`", "a list"),
        ("tip_mm = 1", "the number `1`", "a list of 3"),
        ("wear = 1", "the number `1`", table),
        ("notes = 1", "the number `1`", table),
        ("diameter_mm", "key with no value", "`=`"),
        ("name = \"open", "invalid basic string", "`\"`"),
    ] {
        let (found, expected) = (found.to_owned(), expected.to_owned());
        let kind = TomlFaultKind::Mismatch { found, expected };
        assert_eq!(kind_with(line), kind, "{line}");
    }
    for teeth in ["-1", "2.5"] {
        let (found, expected) = (format!("the number `{teeth}`"), "a whole number".to_owned());
        let kind = TomlFaultKind::Mismatch { found, expected };
        let text = format!("shape = \"flat\"\nteeth = {teeth}");
        assert_eq!(fault(&text).kind, kind);
    }
    let expected = "a text in quotes, or a table".to_owned();
    let found = "another value".to_owned();
    let no_word = TomlFaultKind::Mismatch { found, expected };
    assert_eq!(fault("shape = 3\nteeth = 2").kind, no_word);
}

#[test]
fn faults_of_the_text_itself() {
    assert_eq!(
        kind_with("name = \"a\" coated = true"),
        TomlFaultKind::LineGoesOn
    );
    let own = toml::de::Error::custom("a word in quotes is needed, one of: one, two");
    assert_eq!(TomlFault::of(&own).kind, TomlFaultKind::Other);
}
