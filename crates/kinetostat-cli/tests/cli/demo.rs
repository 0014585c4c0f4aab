//! The demo from end to end.

use crate::common::{command, contents, run, workplace};
use serde_json::Value;

const FILES: [&str; 7] = [
    "compensated.ngc",
    "job.toml",
    "model.toml",
    "original.ngc",
    "points.csv",
    "report.html",
    "result.json",
];

#[test]
fn writes_everything_it_promises() {
    let here = workplace();
    let said = run(here.path(), &["demo"]).answered();
    let out = here.path().join("kinetostat-demo");
    let names: Vec<String> = contents(&out)
        .keys()
        .map(|p| p.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(names, FILES);

    let result: Value =
        serde_json::from_slice(&std::fs::read(out.join("result.json")).unwrap()).unwrap();
    let summary = &result["summary"];
    let number = |key: &str| {
        summary[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key}: {summary}"))
    };
    assert!(number("points") > 100.0);
    assert_eq!(number("blocks"), 11.0);
    assert!(number("max_position_error_before_mm") > 0.05);
    assert!(number("max_position_error_after_mm") <= 0.001);
    assert!(number("max_residual_rotation_deg") > 0.0);
    assert_eq!(summary["converged"], true);
    assert_eq!(summary["stable"], true);

    // The plunge goes down, and never up on its way.
    let written = std::fs::read_to_string(out.join("compensated.ngc")).unwrap();
    let down = written
        .lines()
        .skip_while(|line| !line.starts_with("G0 Z1"));
    let down = down.take_while(|line| !line.contains("F600"));
    let z = |line: &str| {
        line.split(' ')
            .find_map(|word| word.strip_prefix('Z')?.parse::<f64>().ok())
    };
    let heights: Vec<f64> = down.filter_map(z).collect();
    assert!(
        heights.len() >= 3 && heights.windows(2).all(|z| z[1] < z[0]),
        "{heights:?}"
    );
    assert_eq!(number("largest_backward_step_mm"), 0.0);

    // The text says the result, where the files are and what to open.
    for needle in [
        "As programmed, the tool would be up to",
        "kinetostat-demo/report.html",
        "kinetostat compensate job.toml --force-overwrite",
    ] {
        assert!(said.out.contains(needle), "{}", said.out);
    }
    assert!(
        said.out.lines().all(|l| l.chars().count() <= 80),
        "{}",
        said.out
    );
    assert!(!said.out.contains('\u{1b}'), "colour without a terminal");
    assert!(said.err.is_empty(), "{}", said.err);

    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(!page.contains("http://") || page.contains("http://www.w3.org"));
    assert!(!page.contains("<script"));
}

#[test]
fn two_runs_and_any_number_of_threads_give_the_same_bytes() {
    let here = workplace();
    for (name, threads) in [("a", "1"), ("b", "2"), ("c", "3")] {
        run(here.path(), &["demo", "--out", name, "--threads", threads]).answered();
    }
    let read = |name: &str| {
        let root = here.path().join(name);
        contents(&root)
            .into_iter()
            .map(|(path, bytes)| (path.strip_prefix(&root).unwrap().to_owned(), bytes))
            .collect::<Vec<_>>()
    };
    assert_eq!(read("a"), read("b"));
    assert_eq!(read("a"), read("c"));

    // Once more into the same directory: nothing differs, nothing is refused.
    run(here.path(), &["demo", "--out", "a"]).answered();
    assert_eq!(read("a"), read("b"));
}

#[test]
fn its_job_repeats_it() {
    let here = workplace();
    run(here.path(), &["demo"]).answered();
    let out = here.path().join("kinetostat-demo");
    let before = contents(&out);
    // Without leave nothing is overwritten.
    let refused = run(&out, &["compensate", "job.toml"]);
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("--force-overwrite"), "{}", refused.err);
    // The demo states no day, so that it may be run again on another one; no more does this run.
    let again = command(&out)
        .args(["compensate", "job.toml", "--force-overwrite"])
        .env("SOURCE_DATE_EPOCH", "")
        .output()
        .expect("the command starts");
    assert_eq!(again.status.code(), Some(0));
    for (path, bytes) in contents(&out) {
        assert!(before[&path] == bytes, "{} differs", path.display());
    }
}

#[test]
fn changed_files_of_an_earlier_demo_stay() {
    let here = workplace();
    run(here.path(), &["demo", "--out", "d"]).answered();
    let job = here.path().join("d/job.toml");
    std::fs::write(&job, "mine").unwrap();
    let before = contents(here.path());
    let said = run(here.path(), &["demo", "--out", "d"]);
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("job.toml") && said.err.contains("differs"),
        "{}",
        said.err
    );
    assert_eq!(contents(here.path()), before);
    run(here.path(), &["demo", "--out", "d", "--force-overwrite"]).answered();
    assert_ne!(std::fs::read(&job).unwrap(), b"mine");
}

#[test]
fn json_alone_is_on_the_standard_output() {
    let here = workplace();
    let said = run(here.path(), &["demo", "--json"]).answered();
    let result: Value = serde_json::from_str(&said.out).expect("JSON and nothing else");
    let file: Value = serde_json::from_slice(
        &std::fs::read(here.path().join("kinetostat-demo/result.json")).unwrap(),
    )
    .unwrap();
    assert_eq!(result, file);
    assert!(said.err.contains("As programmed"), "{}", said.err);
}
