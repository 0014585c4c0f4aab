//! The table says what the reader does: every row is tried.

use std::collections::BTreeSet;

use kinetostat_formats::*;

use super::read_text;

#[test]
fn every_row_is_what_the_reader_does() {
    let (mut carried, mut refused) = (0, 0);
    for row in URSCRIPT_STATEMENTS {
        let text = format!("def a():\n{}(1, 2)\nend\n", row.name.replace('*', "x"));
        let found = read_text(&text, &ReadOptions::default());
        match row.treatment {
            Treatment::Carried => {
                let program = found.unwrap_or_else(|errors| panic!("{text} {errors:?}"));
                let unknown = |own: &Finding| own.message.contains("in none of the files");
                assert!(!program.findings.iter().any(unknown), "{text}");
                carried += 1;
            }
            Treatment::Refused { reason, remedy } => {
                let errors = found.expect_err(&text);
                assert_eq!((errors.len(), errors[0].line), (1, 2), "{text}");
                assert_eq!(
                    (errors[0].reason.as_str(), errors[0].remedy.as_str()),
                    (reason, remedy)
                );
                refused += 1;
            }
            Treatment::Understood => {}
        }
    }
    assert!(carried > 50 && refused > 15, "{carried} {refused}");
}

#[test]
fn rows_stand_in_the_order_of_the_alphabet_once_with_a_source() {
    let names: Vec<String> = URSCRIPT_STATEMENTS
        .iter()
        .map(|row| row.name.to_ascii_uppercase())
        .collect();
    assert!(names.is_sorted());
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
    assert!(
        URSCRIPT_STATEMENTS
            .iter()
            .all(|row| row.source.starts_with("Universal Robots, "))
    );
}

#[test]
fn a_function_of_the_files_goes_before_the_table() {
    let text = "def a():\ndef sleep(n):\nmovel(p[n,0,0,0,0,0])\nend\nsleep(2)\nend\n";
    assert_eq!(super::program(text).motions.len(), 1);
}
