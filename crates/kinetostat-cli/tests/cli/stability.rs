//! What `STABILITY.md` promises of files, outputs and exit codes.

use crate::common::checks::{flat, warnings};
use crate::common::{JOB, MODEL, PROGRAM, run, workplace};
use serde_json::Value;

/// Version of every JSON output and of every file.
const SCHEMA: u64 = 1;

#[test]
fn every_json_says_its_version_and_who_wrote_it() {
    let here = workplace();
    for (line, schema) in [
        ("check model.toml --json", 3),
        ("model compare model.toml model.toml --json", 1),
        ("stiffness model.toml --json", 2),
        ("map orthoglide --x -20 20 3 --json", 3),
        ("deflect orthoglide --force 1 0 0 --json", 3),
        (
            "deflect orthoglide --program part.ngc --part-origin-mm 0 0 100 --force 1 0 0 --json",
            2,
        ),
        ("compensate job.toml --json", 2),
        (
            "curve three_link_z --direction -1 0 0 --displacement-mm 0 200 --json",
            3,
        ),
        ("equilibria three_link_z --displaced-mm -200 0 0 --json", 3),
        ("assemble orthoglide --force 1 0 0 --json", 2),
        (
            "assemble orthoglide --along 0 0 0 10 0 0 --points 2 --json",
            2,
        ),
        (
            "curve orthoglide --at -120 -120 -120 --direction 1 1 1 --displacement-mm -10 10 --json",
            3,
        ),
        ("demo --json", 2),
        ("force --list-materials --json", 1),
        (
            "force --material C45 --tool flat --diameter-mm 10 --teeth 2 --width-mm 10 --depth-mm 1 --feed-per-tooth-mm 0.1 --json",
            1,
        ),
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
    // The mark in the words of the promise, by the comments of the program.
    let promise = include_str!("../../../../STABILITY.md");
    for mark in [
        "(kinetostat: compensated program)",
        "; kinetostat: compensated program",
    ] {
        assert!(promise.contains(mark), "{mark}");
        let comment = match mark.starts_with(';') {
            true => "; milled dry\n",
            false => "(milled dry)\n",
        };
        std::fs::write(here.path().join("own.ngc"), format!("{comment}{PROGRAM}"))
            .expect("a program");
        let line = [
            "compensate",
            "job.toml",
            "--program",
            "own.ngc",
            "--out",
            "marked.ngc",
            "--force-overwrite",
        ];
        run(here.path(), &line).answered();
        let marked = std::fs::read_to_string(here.path().join("marked.ngc")).expect("written");
        assert_eq!(marked.lines().next(), Some(mark));
        let again = [
            "compensate",
            "job.toml",
            "--program",
            "marked.ngc",
            "--out",
            "again.ngc",
        ];
        let said = run(here.path(), &again);
        assert!(
            said.code == 1 && said.err.contains("compensated already"),
            "{said:?}"
        );
    }
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

/// One form of warnings in every command, the same on the terminal as in the JSON.
#[test]
fn warnings_have_one_form_in_every_command() {
    let here = workplace();
    for name in ["gantry", "hexapod"] {
        let preset = run(here.path(), &["model", "show", name]).answered().out;
        assert!(preset.contains("[0, 0, -9.81]"), "{name}");
        // Of the moon, and a model that says so at this line.
        let text = preset.replace("[0, 0, -9.81]", "[0, 0, -1.62]");
        std::fs::write(here.path().join(format!("{name}.toml")), text).expect("a model");
    }
    // A planar arm cannot keep the tool's orientation, and a bar is pressed beyond its buckling load.
    std::fs::write(here.path().join("arm.toml"), crate::common::checks::ARM).expect("a model");
    let moon = "gravity is 1.62";
    for (line, code, said) in [
        ("check gantry.toml", "model", moon),
        ("stiffness gantry.toml", "model", moon),
        ("deflect gantry.toml --force 10 0 0", "model", moon),
        ("map gantry.toml --x -20 20 2", "model", moon),
        ("assemble gantry.toml --force 10 0 0", "model", moon),
        (
            "assemble gantry.toml --along 0 0 900 10 0 900 --points 2",
            "model",
            moon,
        ),
        ("equilibria gantry.toml --force 10 0 0", "model", moon),
        (
            "curve gantry.toml --force 10 0 0 --factor 0 1",
            "model",
            moon,
        ),
        (
            "curve hexapod.toml --force 10 0 0 --factor 0 1",
            "model",
            moon,
        ),
        (
            "deflect gantry.toml --weight all --program part.ngc --part-origin-mm 0 0 900 --force 10 0 0",
            "model",
            moon,
        ),
        (
            "stiffness two_link --at 1999 0 0",
            "near_singular",
            "singular posture is near",
        ),
        (
            "deflect two_link --at 1999 0 0 --force 0.001 0 0",
            "near_singular",
            "singular posture is near",
        ),
        (
            "equilibria two_link --at 1999 0 0 --force 0.001 0 0",
            "near_singular",
            "singular posture is near",
        ),
        (
            "map arm.toml --x 500 501 2 --y 300 300 1 --z 200 200 1",
            "orientation_follows",
            "the tool turns",
        ),
        (
            "curve three_link_z --direction -1 0 0 --displacement-mm 0 200 --points 10",
            "curve_ends",
            "allows more",
        ),
    ] {
        let mut words: Vec<&str> = line.split(' ').collect();
        words.push("--json");
        let answer = run(here.path(), &words).answered();
        let found: Value = serde_json::from_str(&answer.out).expect("JSON");
        let list = found["warnings"].as_array().expect("a list");
        let own = list.iter().find(|w| w["code"] == code);
        let own = own.unwrap_or_else(|| panic!("{line}: {list:?}"));
        let message = own["message"].as_str().expect("a text");
        assert!(message.contains(said), "{line}: {own}");
        if code == "model" {
            assert!(
                own["file"]
                    .as_str()
                    .is_some_and(|file| file.ends_with(".toml")),
                "{own}"
            );
            let at = own["line"].as_u64().expect("a line") as usize;
            let file =
                std::fs::read_to_string(here.path().join(own["file"].as_str().expect("a file")));
            let text = file.expect("the model");
            assert!(
                text.lines()
                    .nth(at - 1)
                    .is_some_and(|l| l.contains("-1.62")),
                "{own}"
            );
        }
        for warning in warnings(&found).iter().take(8) {
            let message = warning
                .split_once(": ")
                .filter(|(file, _)| file.contains(".toml:"));
            let message = message.map_or(warning.as_str(), |(_, message)| message);
            assert!(
                flat(&answer.err).contains(&flat(message)),
                "{line}: {message}: {}",
                answer.err
            );
        }
    }
}
