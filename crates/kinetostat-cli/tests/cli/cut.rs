//! Loads that are computed from the cut: job tables, corrections that follow the engagement, what is refused.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::{Said, contents, gcode, run};

/// A pass into a block and out of it again, on the small Orthoglide: climb milling, half the tool in the material.
pub(crate) const PASS: &str =
    "G21 G90\nS12000 M3\nG0 X-30 Y0 Z5\nG1 Z-2 F300\nG1 X30 F600\nG0 Z5\nM30\n";

pub(crate) const JOB: &str = r#"schema = 1
model = "orthoglide"
program = "pass.ngc"
[placement]
part_origin_mm = [0, 0, 100]
[tool]
length_mm = 0
cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }
[material]
name = "AlMg4.5Mn"
[stock]
block_mm = [[0, -20, -12], [20, 0, 0]]
[output]
program = "out.ngc"
report = "report.html"
json = "result.json"
points = "points.csv"
"#;

pub(crate) fn place(job: &str, program: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("pass.ngc"), program).unwrap();
    std::fs::write(directory.path().join("job.toml"), job).unwrap();
    directory
}

/// Tool and correction of the written program where it passes an x, mm: from its words, read here.
pub(crate) fn written_y_at(here: &Path, x: f64) -> f64 {
    let text = std::fs::read_to_string(here.join("out.ngc")).unwrap();
    let word = |line: &str, letter: char| -> Option<f64> {
        let after = line.split_whitespace().find(|w| w.starts_with(letter))?;
        after[1..].parse().ok()
    };
    let (mut at, mut places) = ([-30.0, 0.0], Vec::new());
    for line in text
        .lines()
        .filter(|line| line.starts_with('G') || line.starts_with('X'))
    {
        at = [
            word(line, 'X').unwrap_or(at[0]),
            word(line, 'Y').unwrap_or(at[1]),
        ];
        places.push(at);
    }
    let pair = places
        .windows(2)
        .find(|p| p[0][0] <= x && x <= p[1][0] && p[1][0] > p[0][0]);
    let [a, b] = [pair.unwrap()[0], pair.unwrap()[1]];
    a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
}

#[test]
fn the_correction_follows_the_engagement() {
    let here = place(JOB, PASS);
    run(here.path(), &["compensate", "job.toml"]).answered();
    // In air before and behind the block nothing is corrected; in it the tool is held against the force across the feed.
    for x in [-25.0, -10.0, 25.0, 29.0] {
        assert!(written_y_at(here.path(), x).abs() < 2e-3, "{x}");
    }
    let inside = written_y_at(here.path(), 10.0);
    assert!(inside.abs() > 5e-3, "{inside}");
    let result: serde_json::Value =
        serde_json::from_slice(&std::fs::read(here.path().join("result.json")).unwrap()).unwrap();
    let words = result["question"]["cut"].as_array().unwrap();
    let all: Vec<&str> = words.iter().filter_map(|w| w.as_str()).collect();
    for part in [
        "AlMg4.5Mn",
        "source:",
        "assumed:",
        "K_PRO",
        "%",
        "height field",
        "mean over",
    ] {
        assert!(all.iter().any(|w| w.contains(part)), "{part}: {all:?}");
    }
    assert!(
        result["question"]["load"]
            .as_str()
            .unwrap()
            .contains("computed from the cut")
    );
    let report = std::fs::read_to_string(here.path().join("report.html")).unwrap();
    assert!(report.contains("Cutting force") && report.contains("AlMg4.5Mn"));
    assert!(
        result["summary"]["max_position_error_after_mm"]
            .as_f64()
            .unwrap()
            < 1e-3
    );
}

/// The same program above the block: nothing is cut and nothing corrected.
#[test]
fn air_needs_no_correction() {
    let here = place(
        &JOB.replace(
            "[[0, -20, -12], [20, 0, 0]]",
            "[[0, -20, -12], [20, 0, -4]]",
        ),
        PASS,
    );
    run(here.path(), &["compensate", "job.toml"]).answered();
    for x in [-25.0, 0.0, 10.0, 25.0] {
        assert!(written_y_at(here.path(), x).abs() < 1e-9, "{x}");
    }
}

fn refused(job: &str, program: &str, words: &[&str]) {
    let here = place(job, program);
    let before = contents(here.path());
    let said: Said = run(here.path(), &["compensate", "job.toml"]);
    assert_eq!(said.code, 1, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "{word}: {}", said.err);
    }
    assert_eq!(contents(here.path()), before, "something was written");
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let job = |from: &str, to: &str| JOB.replace(from, to);
    refused(
        &job("\"AlMg4.5Mn\"", "\"AlMg4.5Mm\""),
        PASS,
        &["job.toml:10:8", "AlMg4.5Mn"],
    );
    refused(
        &job("diameter_mm = 6", "diameter_mm = -6"),
        PASS,
        &["job.toml:8", "diameter"],
    );
    refused(
        &job("shape = \"flat\"", "shape = \"round\""),
        PASS,
        &["job.toml", "flat"],
    );
    refused(
        &job("teeth = 2", "teeth = 0"),
        PASS,
        &["job.toml:8", "teeth"],
    );
    refused(
        &job("[[0, -20, -12], [20, 0, 0]]", "[[0, -20, 0], [20, 0, 0]]"),
        PASS,
        &["job.toml:11"],
    );
    refused(&job("block_mm", "blok_mm"), PASS, &["job.toml", "block_mm"]);
    refused(&job("cutter = {", "#"), PASS, &["job.toml", "cutter"]);
    refused(
        &job("[stock]\nblock_mm = [[0, -20, -12], [20, 0, 0]]", ""),
        PASS,
        &["[stock]", "[engagement]"],
    );
    refused(
        &job("[material]\nname = \"AlMg4.5Mn\"", ""),
        PASS,
        &["material"],
    );
    refused(
        &job(
            "[output]",
            "[load]\nmilling = { radial_n = 1, tangential_n = 2, axial_n = 3 }\n[output]",
        ),
        PASS,
        &["twice"],
    );
    refused(
        &job(
            "[output]",
            "[engagement]\nwidth_mm = 2\ndepth_mm = 1\n[output]",
        ),
        PASS,
        &["twice"],
    );
    let constant = job(
        "[stock]\nblock_mm = [[0, -20, -12], [20, 0, 0]]",
        "[engagement]\nwidth_mm = 7\ndepth_mm = 1\npart = \"left\"",
    );
    refused(&constant, PASS, &["width of cut", "7 mm", "6 mm"]);
    refused(
        &job("[output]", "[spindle]\nmost_rpm = 8000\n[output]"),
        PASS,
        &["power_w"],
    );
    refused(
        &job("part_origin_mm", "scale = 0.5\npart_origin_mm"),
        PASS,
        &["scaled"],
    );
    let tilted = "part_orientation = { a_b_c_kuka_deg = [0, 0, 20] }\npart_origin_mm";
    refused(
        &job("part_origin_mm", tilted),
        PASS,
        &["tilted by 20.0 degrees"],
    );
    refused(
        &job("[stock]", "[stock]\ncell_mm = 1.0"),
        PASS,
        &["cells of 1", "tenth"],
    );
    // What the program does not say.
    refused(
        JOB,
        &PASS.replace(" M3", ""),
        &["pass.ngc", "line 5", "M3 or M4"],
    );
    refused(
        JOB,
        &PASS.replace("S12000 ", ""),
        &["pass.ngc", "line 5", "(S with G97)"],
    );
    refused(
        JOB,
        &PASS.replace(" F300", "").replace(" F600", ""),
        &["pass.ngc", "line 5", "(F)"],
    );
}

#[test]
fn the_spindle_may_be_too_weak() {
    let job = JOB.replace(
        "[output]",
        "[spindle]\npower_w = 20\nbase_rpm = 10000\nmost_rpm = 24000\n[output]",
    );
    let here = place(&job, PASS);
    run(here.path(), &["compensate", "job.toml"]).answered();
    let result: serde_json::Value =
        serde_json::from_slice(&std::fs::read(here.path().join("result.json")).unwrap()).unwrap();
    let list = result["warnings"].as_array().unwrap();
    let found = list
        .iter()
        .find(|w| w["code"] == "spindle_exceeded")
        .unwrap_or_else(|| panic!("{list:?}"));
    assert_eq!(found["line"], 5, "{found}");
}

/// What else is read is never written over, and named in the result.
#[test]
fn files_of_the_cut_are_inputs() {
    let job = JOB
        .replace("[[0, -20, -12], [20, 0, 0]]", "")
        .replace(
            "block_mm = ",
            "height_map = { file = \"h.csv\", corner_mm = [0, -20, -12], spacing_mm = 20 }",
        )
        .replace("points = \"points.csv\"", "");
    let here = place(&job, PASS);
    std::fs::write(here.path().join("h.csv"), "12,12\n12,12\n").unwrap();
    run(here.path(), &["compensate", "job.toml"]).answered();
    let text = std::fs::read_to_string(here.path().join("result.json")).unwrap();
    assert!(text.contains("h.csv"), "its hash is in the result");
    let job = job.replace("result.json", "h.csv");
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    let said = run(
        here.path(),
        &["compensate", "job.toml", "--force-overwrite"],
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert_eq!(
        std::fs::read_to_string(here.path().join("h.csv")).unwrap(),
        "12,12\n12,12\n"
    );
}

/// Cutters from a table of tools are those that the job would state, with what `tool.tbl` adds; a tool of which nothing is known
/// is named where it cuts, and tools that the program does not call do not matter.
#[test]
fn cutters_from_a_table() {
    let program = PASS.replace("S12000", "T3 M6\nS12000");
    let with = |job: &str, table: &str| {
        let here = place(job, &program);
        std::fs::write(here.path().join("tools.toml"), table).unwrap();
        std::fs::write(
            here.path().join("tool.tbl"),
            "T3 P1 D6 Z50 ;end mill\nT4 P2 D1\n",
        )
        .unwrap();
        let said = run(here.path(), &["compensate", "job.toml"]);
        (here, said)
    };
    let stated = "cutter = { shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30 }\n";
    let (own, said) = with(JOB, "");
    said.answered();
    let cutters = "[cutters]\nfile = \"tools.toml\"\ntool_tbl = \"tool.tbl\"\n[material]";
    let job = JOB.replace(stated, "").replace("[material]", cutters);
    let fine = "[[tool]]\nnumber = 9\nshape = \"ball\"\ndiameter_mm = 0.2\nteeth = 2\n";
    let table =
        format!("{fine}[[tool]]\nnumber = 3\nshape = \"flat\"\nteeth = 2\nhelix_deg = 30\n");
    let (tabled, said) = with(&job, &table);
    said.answered();
    let read = |here: &Path| std::fs::read(here.join("out.ngc")).unwrap();
    assert_eq!(read(own.path()), read(tabled.path()));
    let result = std::fs::read_to_string(tabled.path().join("result.json")).unwrap();
    assert!(
        result.contains("tools.toml") && result.contains("tool.tbl"),
        "their hashes are in the result"
    );
    // A rake angle of the table has its factor.
    let (raked, said) = with(
        &job,
        &table.replace("helix_deg = 30", "helix_deg = 30\nrake_deg = 12"),
    );
    let said = said.answered();
    assert!(said.out.contains("tool 3: factor K_gamma"), "{}", said.out);
    assert_ne!(read(own.path()), read(raked.path()));
    // Nothing is known of tool 3.
    let other = table.replace("number = 3", "number = 5\ndiameter_mm = 6");
    let (_, said) = with(&job.replace("tool_tbl = \"tool.tbl\"\n", ""), &other);
    assert_eq!(said.code, 1, "{said:?}");
    let (_, said) = with(
        &format!(
            "{}\n",
            job.replace("[tool]\n", &format!("[tool]\n{stated}"))
        ),
        &other,
    );
    said.answered();
}

/// A cylinder as long across as its diameter.
#[test]
fn a_cylinder_has_its_radius() {
    let job = JOB.replace(
        "block_mm = [[0, -20, -12], [20, 0, 0]]",
        "cylinder = { foot_mm = [0, 0, -12], radius_mm = 20, height_mm = 12 }",
    );
    let here = place(&job, PASS);
    run(here.path(), &["compensate", "job.toml"]).answered();
    // The tool of 6 mm meets it 23 mm before its middle.
    assert!(written_y_at(here.path(), -24.5).abs() < 2e-3);
    assert!(
        written_y_at(here.path(), -15.0).abs() > 2e-3
            || written_y_at(here.path(), 0.0).abs() > 2e-3
    );
}

/// A real program: every block cut out of a block of aluminium.
#[test]
fn a_real_pocket() {
    let Some(data) = gcode() else {
        println!("skipped: shared/data/gcode is not here");
        return;
    };
    let program = std::fs::read_to_string(data.join("tball-pocket.gcode")).unwrap();
    let first: String = program
        .lines()
        .take(600)
        .map(|line| format!("{line}\n"))
        .collect();
    let job = JOB
        .replace(
            "[[0, -20, -12], [20, 0, 0]]",
            "[[0, -140, -12], [140, 5, 0]]",
        )
        .replace(
            "part_origin_mm = [0, 0, 100]",
            "part_origin_mm = [-70, 70, 100]",
        )
        .replace(
            "[output]",
            "[spindle]\nrpm = 12000\nrotation = \"clockwise\"\n[output]",
        );
    let here = place(&job, &first);
    run(here.path(), &["compensate", "job.toml"]).answered();
    let result: serde_json::Value =
        serde_json::from_slice(&std::fs::read(here.path().join("result.json")).unwrap()).unwrap();
    let summary = &result["summary"];
    assert!(
        summary["max_position_error_before_mm"].as_f64().unwrap() > 0.01,
        "{summary}"
    );
    assert!(
        summary["max_position_error_after_mm"].as_f64().unwrap() < 2e-3,
        "{summary}"
    );
}

/// What is taken for a tool that the table lacks, and another length than the job's, is said.
#[test]
fn what_a_table_of_tools_lacks_or_contradicts_is_said() {
    let job = JOB.replace("[material]", "[cutters]\nfile = \"tools.toml\"\n[material]");
    let program = PASS.replace("S12000 M3", "S12000\nT7 M6\nM3");
    let here = place(&job, &program);
    let words = |number: u32| {
        let table = format!(
            "[[tool]]\nnumber = {number}\nshape = \"flat\"\ndiameter_mm = 6\nteeth = 2\nlength_mm = 40\n"
        );
        std::fs::write(here.path().join("tools.toml"), table).unwrap();
        let said = run(here.path(), &["engagement", "job.toml"]);
        assert_eq!(said.code, 0, "{said:?}");
        said.out.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let lacks = words(3);
    assert!(
        lacks.contains(
            "tool 7 of the program is not in the table of tools: the cutter under [tool] is taken"
        ),
        "{lacks}"
    );
    let other = words(7);
    assert!(
        other.contains("tool 7 is 40 mm long in the table of tools and 0 mm in the job"),
        "{other}"
    );
    assert!(!other.contains("is not in the table"), "{other}");
}

/// A machine that bends under its own weight begins where nobody corrected it: the step is said to be that.
#[test]
fn the_first_block_takes_the_correction_up() {
    let job = JOB
        .replace("\"orthoglide\"", "\"heavy_6r\"")
        .replace(
            "part_origin_mm = [0, 0, 100]",
            "part_origin_mm = [1050, 0, 1000]\ntool_orientation = { a_b_c_kuka_deg = [0, 180, 0] }",
        )
        .replace("length_mm = 0", "length_mm = 150")
        .replace(
            "[material]",
            "[reading]\nstart_position_mm = [0, 0, 50]\n[load]\nweight = \"all\"\n[material]",
        );
    let program = PASS.replace("G0 X-30 Y0 Z5", "G1 X-30 Y0 Z5 F900");
    let here = place(&job, &program);
    let said = run(here.path(), &["compensate", "job.toml"]);
    assert_eq!(said.code, 3, "{said:?}");
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("the program begins where the tool stands without a correction"),
        "{flat}"
    );
    let here = place(&job, PASS);
    run(here.path(), &["compensate", "job.toml"]).answered();
}
