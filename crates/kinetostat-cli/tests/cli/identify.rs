//! `identify` and `plan-measurement`: from a plan to an identified model.

use crate::common::run;

/// A table of what a machine with other stiffnesses shows in planned measurements.
fn measured(here: &std::path::Path, plan: &str, model: &str) -> String {
    let mut out = String::new();
    let mut lines = plan.lines();
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    out += &head.join(",");
    out.push('\n');
    let column = |name: &str| head.iter().position(|h| *h == name).expect("a column");
    for line in lines {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let joints: Vec<String> = (1..7)
            .map(|i| format!("A{i}={}", cells[column(&format!("A{i}_deg"))]))
            .collect();
        let joints = joints.join(",");
        let force: Vec<&str> = ["fx_n", "fy_n", "fz_n"]
            .iter()
            .map(|f| cells[column(f)].as_str())
            .collect();
        let mut words = vec!["deflect", model, "--joints", &joints, "--json", "--force"];
        words.extend(&force);
        let answer: serde_json::Value =
            serde_json::from_str(&run(here, &words).answered().out).expect("JSON");
        let by_load = &answer["displacement_by_load_mm"];
        for (k, name) in ["dx_mm", "dy_mm", "dz_mm"].iter().enumerate() {
            cells[column(name)] = by_load[k].to_string();
        }
        out += &cells.join(",");
        out.push('\n');
    }
    out
}

#[test]
fn a_planned_measurement_finds_the_stiffnesses() {
    let here = tempfile::tempdir().expect("a directory");
    let here = here.path();
    let model = run(here, &["model", "show", "kuka_kr270_like"])
        .answered()
        .out;
    let other = model
        .replace(
            "stiffness_n_m_per_rad = 3.31e6",
            "stiffness_n_m_per_rad = 2.9e6",
        )
        .replace(
            "stiffness_n_m_per_rad = 3.33e5",
            "stiffness_n_m_per_rad = 4e5",
        );
    assert_ne!(model, other);
    std::fs::write(here.join("drawn.toml"), &model).expect("a model");
    std::fs::write(here.join("built.toml"), &other).expect("a model");
    let words = [
        "plan-measurement",
        "drawn.toml",
        "--pull-n",
        "1500",
        "--count",
        "8",
        "--candidates",
        "60",
        "--load-at",
        "0",
        "0",
        "0",
        "--csv",
        "plan.csv",
        "--sheet",
        "plan.txt",
        "--json",
    ];
    let plan: serde_json::Value =
        serde_json::from_str(&run(here, &words).answered().out).expect("JSON");
    assert_eq!(plan["measurements"].as_array().map(Vec::len), Some(8));
    let efficiency = plan["efficiency"].as_f64().expect("a number");
    assert!((0.8..=1.0).contains(&efficiency), "{efficiency}");
    assert!(
        std::fs::read_to_string(here.join("plan.txt"))
            .expect("a sheet")
            .contains("before ______")
    );
    let table = std::fs::read_to_string(here.join("plan.csv")).expect("a plan");
    // As it is planned, nothing was read.
    assert_eq!(
        run(here, &["identify", "drawn.toml", "--measured", "plan.csv"]).code,
        1
    );
    std::fs::write(here.join("read.csv"), measured(here, &table, "built.toml")).expect("a table");
    let words = [
        "identify",
        "drawn.toml",
        "--measured",
        "read.csv",
        "--out",
        "found.toml",
        "--uncertain-out",
        "spread.toml",
        "--json",
        "r.json",
        "--csv",
        "r.csv",
        "--plot",
        "r.svg",
    ];
    run(here, &words).answered();
    let found: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(here.join("r.json")).expect("JSON"))
            .expect("JSON");
    let numbers = found["numbers"].as_array().expect("a list");
    let wanted = [1.4e6, 2.9e6, 2.46e6, 4e5, 3.03e5, 4.23e5];
    assert_eq!(numbers.len(), wanted.len());
    for (number, wanted) in numbers.iter().zip(wanted) {
        let value = number["identified"].as_f64().expect("a number");
        assert!((value / wanted - 1.0).abs() < 1e-5, "{number}");
    }
    let text = std::fs::read_to_string(here.join("found.toml")).expect("a model");
    assert!(
        text.contains("# The identified stiffness of a joint contains the bending"),
        "comments stay"
    );
    assert!(text.contains("identified from read.csv"), "{text}");
    run(here, &["check", "found.toml"]).answered();
    let words = [
        "tolerance",
        "found.toml",
        "--uncertain",
        "spread.toml",
        "--force",
        "300",
        "0",
        "-500",
        "--machines",
        "16",
    ];
    run(here, &words).answered();
}

#[test]
fn faults_of_a_table_are_all_reported() {
    let here = tempfile::tempdir().expect("a directory");
    let here = here.path();
    let table = "A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,fx_n,dx_mm,dy_mm,dz_mm\n0,-90,90,0,90,0,100,one,0,0\n0,-90,900,0,90,0,100,1,0,0\n";
    std::fs::write(here.join("t.csv"), table).expect("a table");
    let said = run(
        here,
        &[
            "identify",
            "kuka_kr270_like",
            "--measured",
            "t.csv",
            "--json",
        ],
    );
    assert_eq!(said.code, 1);
    let report: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    let errors = report["errors"].as_array().expect("a list");
    let at: Vec<(u64, Option<&str>)> = errors
        .iter()
        .map(|e| (e["line"].as_u64().unwrap_or(0), e["name"].as_str()))
        .collect();
    assert_eq!(at, [(2, Some("dx_mm")), (3, None)], "{report}");
    assert_eq!(errors[0]["found"], "one");
}
