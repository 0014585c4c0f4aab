//! What `STABILITY.md` promises of files, outputs and exit codes.

mod common;

use common::{JOB, MODEL, run, workplace};
use serde_json::Value;

/// Version of every JSON output and of every file.
const SCHEMA: u64 = 1;

#[test]
fn every_json_says_its_version_and_who_wrote_it() {
    let here = workplace();
    for (line, schema) in [
        ("check model.toml --json", 2),
        ("model compare model.toml model.toml --json", 1),
        ("stiffness model.toml --json", 1),
        ("map orthoglide --x -20 20 3 --json", 2),
        ("deflect orthoglide --force 1 0 0 --json", 2),
        (
            "deflect orthoglide --program part.ngc --part-origin-mm 0 0 100 --force 1 0 0 --json",
            2,
        ),
        ("compensate job.toml --json", 2),
        (
            "curve three_link_z --direction -1 0 0 --displacement-mm 0 200 --json",
            2,
        ),
        ("equilibria three_link_z --displaced-mm -200 0 0 --json", 2),
        ("assemble orthoglide --force 1 0 0 --json", 1),
        (
            "assemble orthoglide --along 0 0 0 10 0 0 --points 2 --json",
            1,
        ),
        (
            "curve orthoglide --at -120 -120 -120 --direction 1 1 1 --displacement-mm -10 10 --json",
            2,
        ),
        ("demo --json", 2),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words).answered();
        let found: Value =
            serde_json::from_str(&said.out).unwrap_or_else(|e| panic!("{line}: {e}: {}", said.out));
        assert_eq!(found["schema"], schema, "{line}");
        assert_eq!(
            found["kinetostat_version"],
            env!("CARGO_PKG_VERSION"),
            "{line}"
        );
    }
    // A list of fixed form, without a version.
    let said = run(here.path(), &["reproduce", "table-2.3", "--json"]).answered();
    let found: Value = serde_json::from_str(&said.out).expect("JSON");
    for name in ["id", "title", "items"] {
        assert!(!found[0][name].is_null(), "{name}");
    }
}

#[test]
fn files_without_a_version_or_of_another_one_are_refused() {
    let here = workplace();
    let first = format!("schema = {SCHEMA}\n");
    for (text, command) in [(MODEL, "check"), (JOB, "compensate")] {
        for (other, needle) in [
            (text.replacen(&first, "schema = 2\n", 1), "version 1"),
            (text.replacen(&first, "", 1), "schema"),
        ] {
            assert_ne!(other, text);
            std::fs::write(here.path().join("other.toml"), other).expect("a file");
            let said = run(here.path(), &[command, "other.toml"]);
            assert_eq!(said.code, 1, "{said:?}");
            assert!(said.err.contains(needle), "{said:?}");
        }
    }
}

#[test]
fn exit_codes_are_those_of_the_table() {
    let here = workplace();
    for (line, code) in [
        ("stiffness orthoglide", 0),
        // Singular and unstable machines are answers.
        ("stiffness stewart_gough_a", 0),
        ("equilibria three_link_z --displaced-mm -200 0 0", 0),
        ("stiffness no_such_model", 1),
        ("stiffness orthoglide --no-such-option", 1),
        ("stiffness orthoglide --at 9999 0 0", 2),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        assert_eq!(said.code, code, "{line}: {said:?}");
    }
}

#[test]
fn a_compensated_program_carries_its_mark_and_is_not_compensated_twice() {
    let here = workplace();
    run(here.path(), &["compensate", "job.toml"]).answered();
    let written = std::fs::read_to_string(here.path().join("out.ngc")).expect("the program");
    assert!(written.starts_with("(kinetostat: compensated program)\n"));
    let again = [
        "compensate",
        "job.toml",
        "--program",
        "out.ngc",
        "--out",
        "twice.ngc",
    ];
    let said = run(here.path(), &again);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(!here.path().join("twice.ngc").exists());
}
