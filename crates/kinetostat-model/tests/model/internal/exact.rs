//! Lists of exactly so many numbers, and words where words are needed.

use std::collections::BTreeMap;

use kinetostat_diagnostic::wrong_length;
use kinetostat_model::exact_toml;
use kinetostat_model::schema::{Axis, Deviation};
use serde::Deserialize;
use serde_spanned::Spanned;

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Word {
    One,
    Two,
}

#[derive(Debug, Deserialize)]
#[allow(dead_code)]
struct Everything {
    plain: Option<[f64; 3]>,
    rows: Option<[[f64; 2]; 2]>,
    placed: Option<Spanned<[f64; 4]>>,
    named: Option<BTreeMap<String, [f64; 3]>>,
    free: Option<Vec<f64>>,
    axis: Option<Axis>,
    word: Option<Word>,
    #[serde(default)]
    deviation: Vec<Spanned<Deviation>>,
}

#[test]
fn a_list_of_any_place_has_its_length() {
    for (length, before, after) in [
        (3, "plain = ", ""),
        (2, "rows = [[1, 2], ", "]"),
        (4, "placed = ", ""),
        (3, "[named]\nplace = ", ""),
        (3, "axis = ", ""),
        (
            3,
            "[[deviation]]\nlimb = 'a'\nat = 'b'\nmoved_by = { position_mm = ",
            " }",
        ),
        (3, "[[deviation]]\nlimb = 'a'\nat = 'b'\nabout = ", ""),
    ] {
        for given in 0..8 {
            let list: Vec<String> = (1..=given).map(|k| k.to_string()).collect();
            let text = format!("{before}[{}]{after}", list.join(", "));
            match exact_toml::<Everything>(&text) {
                Ok(_) => assert_eq!(given, length, "{text}"),
                Err(error) => {
                    assert_ne!(given, length, "{text}: {error}");
                    assert_eq!(error.message(), wrong_length(length, given), "{text}");
                    let span = error.span().expect("a place");
                    assert!(text[span].starts_with('['), "{text}");
                }
            }
        }
    }
    let free = exact_toml::<Everything>("free = [1, 2, 3, 4, 5]").expect("any length");
    assert_eq!(free.free.map(|list| list.len()), Some(5));
}

#[test]
fn where_a_word_is_needed_the_words_are_listed() {
    for value in ["3", "1.5", "true", "['one']", "{}", "{ one = 1, two = 2 }"] {
        let error = exact_toml::<Everything>(&format!("word = {value}")).unwrap_err();
        assert_eq!(
            error.message(),
            "a word in quotes is needed, one of: one, two",
            "{value}"
        );
        assert!(error.span().is_some(), "{value}");
    }
    let read = exact_toml::<Everything>("word = 'two'").expect("a word");
    assert_eq!(read.word, Some(Word::Two));
}
