//! Errors as programs read them: code, location and remedy, under --json and under `explain`.

use serde_json::Value;

use crate::common::{MODEL, command, run, workplace};

/// The faults that a command line gives as JSON, and its exit code.
#[track_caller]
fn faults(here: &std::path::Path, line: &str) -> (Vec<Value>, i32) {
    let words: Vec<&str> = line.split_whitespace().collect();
    let said = run(here, &words);
    let report: Value = serde_json::from_str(&said.out).unwrap_or_else(|e| panic!("{e}: {said:?}"));
    assert_eq!(report["exit_code"], said.code, "{line}");
    assert!(said.err.contains("error"), "{said:?}");
    let errors = report["errors"].as_array().expect("a list").clone();
    assert!(!errors.is_empty(), "{said:?}");
    (errors, said.code)
}

#[test]
fn every_kind_of_error_has_its_code_and_exit_code() {
    let here = workplace();
    let put =
        |name: &str, text: &str| std::fs::write(here.path().join(name), text).expect("a file");
    put(
        "free.toml",
        &MODEL.replace("stiffness_n_m_per_rad = 2e5,", ""),
    );
    put("part.mpf", "G1 X0 Y0 Z0 F100\nWURST=1 X1\nM30\n");
    for (line, code, exit) in [
        ("stiffness orthoglide --at 0 0 --json", "command_line", 1),
        (
            "stiffness orthoglide --at 0 0 0 --nonsense --json",
            "command_line",
            1,
        ),
        ("stiffness orthoglide --at 0 0 -inf --json", "value", 1),
        ("stiffness orthoglide --at 0 0 1e12 --json", "value", 1),
        (
            "stiffness orthoglide --at 0 0 9000 --json",
            "unreachable",
            2,
        ),
        ("stiffness nothing.toml --at 0 0 0 --json", "model_file", 1),
        ("map orthoglide --json", "missing", 1),
        (
            "compensate --model heavy_6r --program part.ngc --force 0 0 -9 --part-origin-mm 1300 0 800 --tool-length-mm 150 --json -",
            "missing",
            1,
        ),
        ("reproduce table_99 --json", "unknown_name", 1),
        ("modes orthoglide --at 0 0 0 --json", "model_unsuited", 1),
        (
            "deflect orthoglide --at 0 0 0 --program part.ngc --json -",
            "conflict",
            1,
        ),
        ("deflect job.toml --limit nonsense --json -", "value", 1),
        ("compensate job.toml --language de --json -", "unused", 1),
        ("compensate nothing.toml --json -", "file_not_read", 1),
        (
            "compensate --model orthoglide --program part.mpf --json -",
            "program_refused",
            1,
        ),
    ] {
        let (errors, found) = faults(here.path(), line);
        assert_eq!(
            (&errors[0]["code"], found),
            (&Value::from(code), exit),
            "{line}: {errors:#?}"
        );
    }
}

#[test]
fn faults_of_files_have_their_place_and_their_remedy() {
    let here = workplace();
    let put =
        |name: &str, text: &str| std::fs::write(here.path().join(name), text).expect("a file");
    let job = std::fs::read_to_string(here.path().join("job.toml")).expect("the job");
    put(
        "wrong.toml",
        &job.replace("length_mm", "lenght_mm")
            .replace("program = \"out", "programm = \"out"),
    );
    let (errors, _) = faults(here.path(), "compensate wrong.toml --json -");
    let of_keys: Vec<_> = errors.iter().filter(|e| e["code"] == "job_file").collect();
    assert_eq!(of_keys.len(), 2, "{errors:#?}");
    for fault in of_keys {
        assert_eq!(fault["file"], "wrong.toml");
        assert!(
            fault["line"].as_u64().is_some_and(|line| line > 5),
            "{fault}"
        );
        assert!(
            fault["remedy"]
                .as_str()
                .is_some_and(|help| help.contains("did you mean")),
            "{fault}"
        );
    }

    put(
        "arm.toml",
        &MODEL.replace("youngs_modulus_gpa = 70", "youngs_modulus_gpa = -70"),
    );
    let (errors, _) = faults(here.path(), "stiffness arm.toml --at 800 0 0 --json");
    assert_eq!(errors[0]["code"], "model_file");
    assert_eq!(
        errors[0]["name"], "section.tube.youngs_modulus_gpa",
        "{errors:#?}"
    );
    assert!(errors[0]["line"].is_u64() && errors[0]["column"].is_u64());

    let (errors, _) = faults(
        here.path(),
        "force --material C45 --tool flat --diameter-mm 10 --teeth 2 --width-mm 2 --depth-mm 4 --part left --feed-per-tooth-mm 0.1 --rpm 0 --json",
    );
    assert_eq!(errors[0]["name"], "--rpm", "{errors:#?}");
    assert_eq!(errors[0]["found"], "0 turns per minute");
    assert_eq!(errors[0]["allowed"], "0.001 to 1000000 turns per minute");

    put("two.ngc", "G21 G90\nG1 X1 F100\nG77 X2\nG1 X\nM2\n");
    let (errors, _) = faults(
        here.path(),
        "compensate job.toml --program two.ngc --json -",
    );
    let lines: Vec<_> = errors
        .iter()
        .map(|e| (e["code"].as_str(), e["line"].as_u64()))
        .collect();
    let refused = Some("program_refused");
    assert_eq!(
        lines,
        [(refused, Some(3)), (refused, Some(4))],
        "{errors:#?}"
    );
    assert!(
        errors
            .iter()
            .all(|e| e["found"].is_string() && e["remedy"].is_string())
    );
}

#[test]
fn a_result_and_an_error_are_never_two_documents() {
    let here = workplace();
    // The program never states Z, so that what is corrected there is left out: it is written, and misses its tolerance.
    let program = "G21 G90\nG0 X0 Y0\nG1 X20 F600\nG1 Y20\nM2\n";
    std::fs::write(here.path().join("part.ngc"), program).expect("a file");
    let said = run(here.path(), &["compensate", "job.toml", "--json", "-"]);
    assert_eq!(said.code, 3, "{said:?}");
    let result: Value = serde_json::from_str(&said.out).expect("one document");
    assert!(result["tolerance"].is_object(), "{said:?}");
    // Without --json the standard output stays empty.
    let said = run(
        here.path(),
        &["stiffness", "orthoglide", "--at", "0", "0", "9000"],
    );
    assert_eq!((said.code, said.out.as_str()), (2, ""));
}

#[test]
fn explain_names_all_codes_and_the_nearest_one() {
    let here = workplace();
    let all = run(here.path(), &["explain"]).answered();
    for code in ["unreachable", "program_refused", "near_singular"] {
        assert!(all.out.contains(&format!("\n  {code} ")), "{}", all.out);
        let one = run(here.path(), &["explain", code]).answered();
        assert!(
            one.out.contains(code) && one.out.lines().count() > 1,
            "{}",
            one.out
        );
        assert!(
            one.out.lines().all(|line| line.chars().count() <= 80),
            "{}",
            one.out
        );
    }
    let near = run(here.path(), &["explain", "unreachabel"]);
    assert!(
        near.code == 1 && near.err.contains("'unreachable'"),
        "{near:?}"
    );
    let schema = command(here.path())
        .args(["schema", "error"])
        .output()
        .expect("it starts");
    assert!(String::from_utf8_lossy(&schema.stdout).contains("\"unreachable\""));
}
