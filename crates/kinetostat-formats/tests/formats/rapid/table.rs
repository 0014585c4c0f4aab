//! The table says what the reader does: every row is tried.

use std::collections::BTreeSet;

use kinetostat_formats::*;

fn read_statement(statement: &str) -> Result<RobotProgram, Vec<ProgramError>> {
    let text = format!("MODULE A\nPROC main()\n{statement}\nENDPROC\nENDMODULE");
    read_rapid(
        vec![SourceFile::new("a.mod", text)],
        &ReadOptions::default(),
    )
}

#[test]
fn every_row_is_what_the_reader_does() {
    let (mut carried, mut refused, mut motions) = (0, 0, 0);
    for row in RAPID_STATEMENTS {
        let statement = format!("{} x1, x2;", row.name.to_ascii_lowercase());
        let found = read_statement(&statement);
        match row.treatment {
            Treatment::Carried => {
                let program = found.unwrap_or_else(|errors| panic!("{statement} {errors:?}"));
                let unknown =
                    |finding: &Finding| finding.message.contains("is in none of the files");
                assert!(!program.findings.iter().any(unknown), "{statement}");
                carried += 1;
            }
            Treatment::Refused { reason, remedy } => {
                let errors = found.expect_err(&statement);
                assert_eq!((errors.len(), errors[0].line), (1, 3), "{statement}");
                assert_eq!(
                    (errors[0].reason.as_str(), errors[0].remedy.as_str()),
                    (reason, remedy)
                );
                refused += 1;
            }
            Treatment::Understood => {
                let arguments = |error: &ProgramError| error.reason.contains("needs at least");
                motions += usize::from(found.is_err_and(|errors| errors.iter().any(arguments)));
            }
        }
    }
    assert_eq!((carried, refused, motions), (131, 47, 30));
}

#[test]
fn rows_stand_in_the_order_of_the_alphabet_once_with_a_source() {
    let names: Vec<String> = RAPID_STATEMENTS
        .iter()
        .map(|row| row.name.to_ascii_uppercase())
        .collect();
    assert!(names.is_sorted());
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
    assert!(
        RAPID_STATEMENTS
            .iter()
            .all(|row| row.source.starts_with("ABB, "))
    );
}

#[test]
fn a_routine_of_the_files_goes_before_the_table() {
    let text = "MODULE A\nPROC main()\nReset 5;\nENDPROC\nPROC Reset(num n)\n\
        MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\nENDPROC\nENDMODULE";
    assert_eq!(super::program(text).motions[0].runs, Runs::Once);
}
