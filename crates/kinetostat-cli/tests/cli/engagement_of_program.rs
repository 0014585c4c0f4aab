//! `kinetostat engagement PROGRAM`: the same figures from options as from a job, options over a job, the words that are
//! missing, and how the program is read.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::chains::{json, number};
use crate::common::checks::flat;
use crate::common::{contents, run};

/// A slot of the tool's width, 2 mm deep, through a block of 40 mm, and back above it.
const SLOT: &str = "G21 G90 G94\nS10000 M3\nG0 X-10 Y0 Z5\nG1 Z-2 F2000\nG1 X50 F600\nG0 Z5\nM2\n";

const WAX: &str = r#"[[material]]
name = "wax"
group = "other"
spread_percent = 20
source = "our dynamometer"
measured_in = { process = "milling" }
[material.law.linear]
cutting_n_per_mm2 = [800, 200, 100]
edge_n_per_mm = [10, 5, 1]
"#;

const JOB: &str = r#"schema = 1
program = "slot.ngc"
[tool]
cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }
[material]
name = "wax"
file = "wax.toml"
wear_factor = 1.2
[stock]
block_mm = [[0, -20, -10], [40, 20, 0]]
[spindle]
power_w = 100
base_rpm = 10000
most_rpm = 20000
"#;

const TOOLS: &str = "[[tool]]\nnumber = 1\nshape = \"flat\"\ndiameter_mm = 6\nteeth = 2\n[[tool]]\nnumber = 2\nshape = \"flat\"\ndiameter_mm = 4\nteeth = 2\n";

const MATERIAL: &str = "--material wax --materials wax.toml --wear 1.2";
const TOOL: &str = "--tool flat --diameter-mm 6 --teeth 2 --helix-deg 30";
const BLOCK: &str = "--block-mm 0 -20 -10 40 20 0";
const SPINDLE: &str = "--spindle-power-w 100 --spindle-base-rpm 10000 --spindle-most-rpm 20000";

fn place(program: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("slot.ngc", program),
        ("wax.toml", WAX),
        ("job.toml", JOB),
        ("tools.toml", TOOLS),
    ] {
        std::fs::write(directory.path().join(name), text).unwrap();
    }
    directory
}

#[track_caller]
fn answer(here: &Path, line: &str) -> Value {
    json(here, &line.split_whitespace().collect::<Vec<_>>())
}

/// What is refused, in one line; nothing is written.
#[track_caller]
fn refused(here: &Path, line: &str) -> String {
    let before = contents(here);
    let line = format!("{line} --csv cut.csv --plot cut.svg");
    let said = run(here, &line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(said.code, 1, "{said:?}");
    assert_eq!(contents(here), before, "something was written");
    flat(&said.err)
}

#[track_caller]
fn close(found: f64, expected: f64, share: f64) {
    let apart = (found - expected).abs();
    assert!(apart <= share * expected.abs(), "{found}, not {expected}");
}

#[test]
fn options_say_what_a_job_says() {
    let here = place(SLOT);
    let of_job = answer(here.path(), "engagement job.toml");
    let options = format!("engagement slot.ngc {MATERIAL} {TOOL} {BLOCK} {SPINDLE}");
    let own = answer(here.path(), &options);
    assert_eq!(own["cutting"], of_job["cutting"]);
    assert_eq!(own["stock"], of_job["stock"]);
    assert_eq!(own["tools"], of_job["tools"]);
    assert_eq!(own["material"], "wax");
    close(number(&own["stock"]["removed_mm3"]), 6.0 * 2.0 * 40.0, 5e-3);
    let names = |a: &Value| -> Vec<String> {
        let files = a["files"].as_array().unwrap().iter();
        files
            .map(|file| file["name"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(names(&own), ["slot.ngc", "wax.toml"]);
    // A program beside its job, either way round.
    for line in [
        "engagement slot.ngc --job job.toml",
        "engagement --job job.toml",
        "engagement job.toml --program slot.ngc",
    ] {
        let a = answer(here.path(), line);
        assert_eq!(a["cutting"], of_job["cutting"], "{line}");
    }
    let assumed = own["assumed"].to_string();
    assert!(
        assumed.contains("a block from (0, -20, -10) to (40, 20, 0) mm"),
        "{assumed}"
    );
}

#[test]
fn options_go_over_the_job() {
    let here = place(SLOT);
    let narrow = "engagement slot.ngc --job job.toml --tool flat --diameter-mm 4 --teeth 2";
    let a = answer(here.path(), narrow);
    close(number(&a["stock"]["removed_mm3"]), 4.0 * 2.0 * 40.0, 5e-3);
    assert!(!a["cutting"]["nearest_to_spindle"].is_null());
    let short = answer(
        here.path(),
        "engagement job.toml --block-mm 0 -20 -10 20 20 0 --cell-mm 0.2",
    );
    close(
        number(&short["stock"]["removed_mm3"]),
        6.0 * 2.0 * 20.0,
        1e-2,
    );
    close(number(&short["stock"]["cell_mm"]), 0.2, 1e-9);
    // The torque of a slot: (K_tc c/4 ... ) at twice the speed the chip is half.
    let fast = answer(here.path(), "engagement job.toml --rpm 20000");
    close(
        number(&fast["cutting"]["largest_chip"]["chip_mm"]),
        0.015,
        1e-6,
    );
    let stated = answer(
        here.path(),
        &format!("engagement slot.ngc {MATERIAL} {TOOL} --width-mm 2 --depth-mm 3 --part right"),
    );
    assert!(stated["stock"].is_null());
    let line = format!(
        "force {MATERIAL} {TOOL} --width-mm 2 --depth-mm 3 --part right --feed-per-tooth-mm 0.03"
    );
    let one = answer(here.path(), &line);
    let force = &stated["cutting"]["largest_force"];
    close(
        number(&force["force_left_n"]),
        number(&one["mean"]["force_n"][1]),
        1e-6,
    );
}

#[test]
fn a_table_has_the_tools_that_the_program_calls() {
    let program = SLOT.replace("G0 X-10", "T2 M6\nS10000 M3\nG0 X-10");
    let here = place(&program);
    let line = format!("engagement slot.ngc {MATERIAL} --tool-table tools.toml {BLOCK}");
    let a = answer(here.path(), &line);
    assert_eq!(a["tools"].as_array().unwrap().len(), 1);
    assert_eq!(a["tools"][0]["number"], 2);
    close(number(&a["stock"]["removed_mm3"]), 4.0 * 2.0 * 40.0, 5e-3);
    // A number is that of the whole program.
    let a = answer(here.path(), &format!("{line} --tool-number 1"));
    close(number(&a["stock"]["removed_mm3"]), 6.0 * 2.0 * 40.0, 5e-3);
    std::fs::write(here.path().join("slot.ngc"), program.replace("T2", "T9")).unwrap();
    let said = refused(here.path(), &line);
    assert!(said.contains("--tool-number"), "{said}");
}

#[test]
fn the_program_is_read_as_options_say() {
    let options = format!("{MATERIAL} {TOOL} {BLOCK}");
    let here = place(&SLOT.replace("G21 ", ""));
    let line = format!("engagement slot.ngc {options}");
    let assumed = "taken for millimetres";
    for (line, is_said) in [(line.clone(), true), (format!("{line} --units mm"), false)] {
        let a = answer(here.path(), &line);
        close(number(&a["stock"]["removed_mm3"]), 480.0, 5e-3);
        assert_eq!(a["warnings"].to_string().contains(assumed), is_said, "{a}");
    }
    // Half an inch of the program are 12.7 mm.
    std::fs::write(
        here.path().join("slot.ngc"),
        "G90 G94\nS10000 M3\nG0 X-0.4 Y0 Z0.2\nG1 Z-0.1 F80\nG1 X2 F24\nG0 Z0.2\nM2\n",
    )
    .unwrap();
    let a = answer(here.path(), &format!("{line} --units inch"));
    close(number(&a["stock"]["removed_mm3"]), 6.0 * 2.54 * 40.0, 5e-3);
    // Where the tool stands, where G54 is, and blocks that are skipped.
    let here = place("G21 G90 G94\nS10000 M3\nG1 X50 F600\n/G1 Y10\nM2\n");
    let start = format!("{line} --start-position-mm -10 0 -2");
    let whole = answer(here.path(), &start);
    let skipped = answer(here.path(), &format!("{start} --block-delete skip"));
    close(number(&skipped["stock"]["removed_mm3"]), 480.0, 5e-3);
    close(
        number(&whole["feed_length_mm"]) - number(&skipped["feed_length_mm"]),
        10.0,
        1e-9,
    );
    let here = place(SLOT);
    let moved = answer(here.path(), &format!("{line} --work-offset G54=0,0,-1"));
    close(
        number(&moved["stock"]["removed_mm3"]),
        6.0 * 3.0 * 40.0,
        5e-3,
    );
    // Without M3 the sense is asked for, and its S holds.
    let here = place(&SLOT.replace(" M3", ""));
    let said = refused(here.path(), &line);
    assert!(
        said.contains("line 5") && said.contains("--rotation"),
        "{said}"
    );
    let a = answer(here.path(), &format!("{line} --rotation clockwise"));
    close(number(&a["cutting"]["largest_chip"]["chip_mm"]), 0.03, 1e-6);
    let here = place(&SLOT.replace("S10000 ", ""));
    let said = refused(here.path(), &line);
    assert!(said.contains("--rpm"), "{said}");
    let a = answer(here.path(), &format!("{line} --rpm 10000"));
    close(number(&a["cutting"]["largest_chip"]["chip_mm"]), 0.03, 1e-6);
}

#[test]
fn what_is_missing_or_wrong_is_named() {
    let here = place(SLOT);
    let said = refused(here.path(), "engagement slot.ngc");
    for word in [
        "no material: give --material",
        "no tool: give --tool",
        "no stock: give --block-mm",
        "--job JOB",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let said = refused(
        here.path(),
        &format!("engagement slot.ngc {MATERIAL} {TOOL}"),
    );
    assert!(
        said.contains("no stock") && !said.contains("no tool"),
        "{said}"
    );
    for (line, word) in [
        (format!("{TOOL} {BLOCK}"), "no material"),
        (format!("{MATERIAL} {BLOCK}"), "no tool"),
        (
            format!("{MATERIAL} {TOOL} --block-mm 0 0 0 40 20 0"),
            "--block-mm: height of the stock: 0 mm",
        ),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --cell-mm 2"),
            "smaller --cell-mm",
        ),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --cell-mm 0.0001"),
            "--cell-mm: cells of 0.0001 mm are finer",
        ),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --memory-mb 0"),
            "--memory-mb: 1 to 100000 MB",
        ),
        (format!("{MATERIAL} {TOOL} --cell-mm 1"), "--block-mm"),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --width-mm 2 --depth-mm 3"),
            "cannot be used with",
        ),
        (
            format!("{MATERIAL} {TOOL} --width-mm 2 --depth-mm 3"),
            "--part left or --part right",
        ),
        (
            format!("{MATERIAL} {TOOL} --width-mm 7 --depth-mm 3 --part left"),
            "--width-mm: width of cut of 7 mm",
        ),
        (
            format!("--material vax {TOOL} {BLOCK}"),
            "--material: `vax` is not known",
        ),
        (
            format!("{MATERIAL} --tool ball --teeth 2 {BLOCK}"),
            "--diameter-mm",
        ),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --rpm -3"),
            "--rpm: speed of the spindle of -3",
        ),
        (
            format!("{MATERIAL} {TOOL} {BLOCK} --correct-speed"),
            "--correct-speed needs --rpm",
        ),
        (
            "--job job.toml --wear 1.3".to_owned(),
            "--wear needs --material",
        ),
        (
            "--job job.toml --program other.ngc".to_owned(),
            "'slot.ngc' and 'other.ngc' are given, and the command takes one program",
        ),
        ("--job none.toml".to_owned(), "'none.toml' does not exist"),
    ] {
        let said = refused(here.path(), &format!("engagement slot.ngc {line}"));
        assert!(said.contains(word), "{word}: {said}");
    }
    let said = refused(here.path(), "engagement job.toml --job job.toml");
    assert!(said.contains("the command takes one job"), "{said}");
    // No input is overwritten, the files of options among them.
    for target in ["slot.ngc", "wax.toml"] {
        let line = format!(
            "engagement slot.ngc {MATERIAL} {TOOL} {BLOCK} --json {target} --force-overwrite"
        );
        let said = run(here.path(), &line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(said.code, 1);
        assert!(
            flat(&said.err).contains("never overwritten"),
            "{}",
            said.err
        );
    }
}

/// What a person is told of a wrong number knows no types of a programming language.
#[test]
fn numbers_are_asked_for_in_words() {
    let here = place(SLOT);
    let lines = JOB.split("[stock]").next().unwrap().to_owned()
        + "[engagement]\nlines = [{ from = -1, to = 3, width_mm = 2, depth_mm = 2 }]\n";
    std::fs::write(here.path().join("job.toml"), lines).unwrap();
    let said = refused(here.path(), "engagement job.toml");
    assert!(said.contains("a whole number is needed"), "{said}");
    assert!(said.contains("job.toml:10"), "{said}");
    let line = format!("engagement slot.ngc {MATERIAL} --tool-table tools.toml {BLOCK}");
    for (from, to, words) in [
        (
            "teeth = 2",
            "teeth = 2.5",
            "the number `2.5`; expected a whole number",
        ),
        (
            "number = 1",
            "number = -1",
            "the number `-1`; expected a whole number",
        ),
        (
            "diameter_mm = 6",
            "diameter_mm = \"x\"",
            "the text \"x\"; expected a number",
        ),
        (
            "diameter_mm = 6",
            "diameter_mm = [6]",
            "a list; expected a number",
        ),
    ] {
        std::fs::write(here.path().join("tools.toml"), TOOLS.replacen(from, to, 1)).unwrap();
        let said = refused(here.path(), &line);
        assert!(said.contains(words), "{words}: {said}");
    }
    let line = format!("engagement slot.ngc {MATERIAL} {TOOL} {BLOCK}");
    for (from, to, words) in [
        (
            "[800, 200, 100]",
            "[800, \"a\", 100]",
            "the text \"a\"; expected a number",
        ),
        (
            "spread_percent = 20",
            "spread_percent = true",
            "expected a number",
        ),
        ("[800, 200, 100]", "[800, 200]", "expected a list of 3"),
    ] {
        std::fs::write(here.path().join("wax.toml"), WAX.replacen(from, to, 1)).unwrap();
        let said = refused(here.path(), &line);
        assert!(
            said.contains("wax.toml:") && said.contains(words),
            "{words}: {said}"
        );
    }
}
