//! Reports on paper: figures of the JSON, hashes of files, and nothing half written.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use serde_json::Value;

use crate::common::{run, workplace};

const PART: &str = "G21 G90\nG0 X-12 Y-9 Z5\nG0 Z0\nG1 X21 Y-4 F600\nG1 X25 Y13\nG0 Z5\nM2\n";

const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"größer.ngc\"\n[placement]\npart_origin_mm = [3, -2, 97]\n[tool]\nlength_mm = 100\n[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n[[features]]\nname = \"Nut\"\nlines = [4, 5]\ntolerance_um = 0.01\n";

#[test]
fn a_paper_has_the_figures_of_the_json_and_the_hashes_of_the_files() {
    let here = workplace();
    std::fs::write(here.path().join("größer.ngc"), PART).unwrap();
    std::fs::write(here.path().join("job.toml"), JOB).unwrap();
    let words = [
        "compensate",
        "job.toml",
        "--out",
        "out.ngc",
        "--json",
        "out.json",
        "--pdf",
        "ä.pdf",
        "--report",
        "ä.html",
        "--language",
        "de",
    ];
    let names = || {
        let all = std::fs::read_dir(here.path()).unwrap();
        let mut all: Vec<String> = all
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        all.sort();
        all
    };
    let before_run = names();
    // The feature is missed; files are in place.
    let output = run(here.path(), &words);
    assert_eq!(output.code, 3, "{output:?}");
    let read = |name: &str| std::fs::read(here.path().join(name)).unwrap();
    assert!(read("ä.pdf").starts_with(b"%PDF-1."));
    let page = String::from_utf8(read("ä.html")).unwrap();
    let found: Value = serde_json::from_slice(&read("out.json")).unwrap();
    // Three digits, rounded up, with a decimal comma: a bound of what the JSON has.
    let before = found["summary"]["max_position_error_before_mm"]
        .as_f64()
        .unwrap();
    let up = format!("{:.3}", (before * 1e3).ceil() / 1e3).replace('.', ",");
    assert!(page.contains(&format!("{up}\u{202f}mm")), "{up} in {page}");
    for file in found["question"]["files"].as_array().unwrap() {
        assert!(page.contains(file["sha256"].as_str().unwrap()), "{file}");
    }
    assert!(
        page.contains("geschriebenes Programm") && page.contains("VERFEHLT"),
        "{page}"
    );
    let made = names()
        .into_iter()
        .filter(|name| !before_run.contains(name));
    let made: Vec<String> = made.collect();
    let expected = ["out.json", "out.ngc", "ä.html", "ä.pdf"];
    assert_eq!(made, expected, "nothing half written stays");
    // What is there is not overwritten.
    assert_eq!(run(here.path(), &words).code, 1);
}
