//! The headline of a run follows the worst of what is stated, in every output and in the exit code.

use serde_json::Value;

use crate::common::{run, workplace};

const POCKET: &str = "G21 G90 G17\nG0 X0 Y0 Z20\nM3 S6000\nG0 Z5\nF600\nG1 Z-2 F200\nG1 X60 F600\nG1 Y13\nG1 X0\nG0 Z30\nM30\n";

const JOB: &str = r#"schema = 1
model = "heavy_6r"
program = "pocket.ngc"
[placement]
part_origin_mm = [1400, 70, 500]
[tool]
length_mm = 120
cutter = { shape = "flat", diameter_mm = 10, teeth = 2, helix_deg = 30 }
[load]
weight = "all"
[material]
name = "AlMg4.5Mn"
[stock]
block_mm = [[-20, -20, -20], [80, 80, 0]]
[tolerances]
TOLERANCE
[output]
program = "out.ngc"
json = "out.json"
report = "out.html"
"#;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Force of the cut, load at corners and steps backwards cost more than the tolerance: level, tile, text, JSON and exit code say the
/// worst of them; with a wide tolerance all is well.
#[test]
fn the_headline_follows_the_worst_of_what_is_stated() {
    let here = workplace();
    std::fs::write(here.path().join("pocket.ngc"), POCKET).expect("a program");
    for (tolerance, code, level) in [
        ("path_um = 20", 4, "attention"),
        ("path_um = 500", 0, "good"),
    ] {
        let job = JOB.replace("TOLERANCE", tolerance);
        std::fs::write(here.path().join("job.toml"), job).expect("a job");
        let said = run(
            here.path(),
            &["compensate", "job.toml", "--force-overwrite"],
        );
        assert_eq!(said.code, code, "{said:?}");
        let read = |name: &str| std::fs::read_to_string(here.path().join(name)).expect(name);
        let found: Value = serde_json::from_str(&read("out.json")).expect("JSON");
        let (summary, assessment) = (&found["summary"], &found["assessment"]);
        assert_eq!(assessment["level"], level, "{assessment}");
        // By figures that stand elsewhere.
        let stated = [
            &summary["max_position_error_after_mm"],
            &summary["max_corner_error_if_load_turns_mm"],
            &summary["max_corner_error_if_load_follows_feed_mm"],
            &found["force_band"]["max_error_if_larger_mm"],
            &found["force_band"]["max_error_if_smaller_mm"],
        ];
        let backward = match summary["backward_steps"].as_u64() {
            Some(0) => 0.0,
            _ => number(&summary["largest_backward_step_mm"]),
        };
        let stated = stated.into_iter().filter_map(Value::as_f64);
        let worst_um = kinetostat_testing::largest(stated.chain([backward])) * 1e3;
        let said_um = number(&assessment["max_error_um"]);
        assert!(
            (said_um - worst_um).abs() < 1e-9 * worst_um,
            "{said_um} {worst_um}"
        );
        let costs = assessment["assumptions"].as_array().expect("a list");
        let costs: Vec<f64> = costs
            .iter()
            .filter_map(|a| a["up_to_um"].as_f64())
            .collect();
        assert!(
            !costs.is_empty() && costs.is_sorted_by(|a, b| a >= b),
            "{costs:?}"
        );
        let page = read("out.html");
        assert!(
            page.contains(&format!("class=\"assessment {level}\"")),
            "{level}"
        );
        let doubts = "The tolerance is kept only if the assumptions";
        let text: Vec<&str> = said.out.split_whitespace().collect();
        assert_eq!(text.join(" ").contains(doubts), code == 4, "{}", said.out);
        assert_eq!(said.err.contains(doubts), code == 4, "{}", said.err);
        assert_eq!(page.contains(doubts), code == 4);
        assert_eq!(page.contains("if all assumptions hold"), code == 4);
    }
}

/// A load at corners that is stated is no assumption.
#[test]
fn what_is_stated_of_corners_is_not_assumed() {
    let here = workplace();
    std::fs::write(here.path().join("pocket.ngc"), POCKET).expect("a program");
    for (stated, is_assumed) in [("", true), ("at_corners = \"turns\"\n[material]", false)] {
        let job = JOB.replace("TOLERANCE", "path_um = 20");
        let job = match stated {
            "" => job,
            stated => job.replace("[material]", stated),
        };
        std::fs::write(here.path().join("job.toml"), job).expect("a job");
        let words = ["compensate", "job.toml", "--force-overwrite"];
        run(here.path(), &words).answered();
        let found = std::fs::read_to_string(here.path().join("out.json")).expect("a result");
        let found: Value = serde_json::from_str(&found).expect("JSON");
        assert!(
            found["summary"]["corner_steps"].as_u64() > Some(0),
            "{found}"
        );
        let assumptions = found["assessment"]["assumptions"]
            .as_array()
            .expect("a list");
        let corners = assumptions.iter().any(|a| a["kind"] == "corners");
        assert_eq!(corners, is_assumed, "{assumptions:?}");
    }
}
