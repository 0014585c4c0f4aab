//! `identify` and `plan-measurement`: from a plan to an identified model.

use crate::common::{PROGRAM, run};
use crate::every_option::PULLS;

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

#[test]
fn spreadsheets_and_parquet_say_what_csv_says() {
    let here = tempfile::tempdir().expect("a directory");
    let here = here.path();
    // Both were written by pandas.
    let sheet = include_bytes!("common/pulls.xlsx");
    let parquet = include_bytes!("common/pulls.parquet");
    for (name, bytes) in [
        ("pulls.csv", PULLS.as_bytes()),
        ("pulls.xlsx", sheet),
        ("pulls.parquet", parquet),
        ("broken.xlsx", &sheet[..2000]),
    ] {
        std::fs::write(here.join(name), bytes).expect("a table");
    }
    let said = |name: &str| {
        let said = run(here, &["identify", "heavy_6r", "--measured", name]).answered();
        said.out.replace(name, "the table")
    };
    let csv = said("pulls.csv");
    assert_eq!(said("pulls.xlsx"), csv);
    assert_eq!(said("pulls.parquet"), csv);
    let broken = run(here, &["identify", "heavy_6r", "--measured", "broken.xlsx"]);
    assert_eq!(broken.code, 1, "{}", broken.err);
    assert!(broken.err.contains("save it as CSV"), "{}", broken.err);
}

#[test]
fn the_work_of_a_job_decides_postures_and_is_judged() {
    let here = tempfile::tempdir().expect("a directory");
    let here = here.path();
    let job = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [1300, 0, 800]\n[load]\nforce_n = [300, 200, -400]\nweight = \"all\"\n";
    for (name, text) in [
        ("job.toml", job),
        ("part.ngc", PROGRAM),
        ("pulls.csv", PULLS),
    ] {
        std::fs::write(here.join(name), text).expect("a file");
    }
    let json = |words: &str| -> serde_json::Value {
        let words: Vec<&str> = words.split(' ').collect();
        serde_json::from_str(&run(here, &words).answered().out).expect("JSON")
    };
    let plan = "plan-measurement heavy_6r --pull-n 800 --count 6 --candidates 40 --json";
    let (for_job, for_all) = (json(&format!("{plan} --work job.toml")), json(plan));
    let left = for_job["left_error_mm"].as_f64().expect("a number");
    assert!((1e-4..0.1).contains(&left), "{left}");
    assert!(for_all["left_error_mm"].is_null());
    assert_ne!(for_job["measurements"], for_all["measurements"]);

    // Postures that were taught, whatever else their table has.
    let taught =
        json("plan-measurement heavy_6r --pull-n 800 --count 3 --postures pulls.csv --json");
    assert_eq!(taught["candidates"], 5);

    // A cable at the forearm: joints beyond it are not loaded.
    let words = "plan-measurement heavy_6r --pull-n 800 --count 3 --candidates 20 --csv n.csv --sheet n.txt --json --load-on";
    let words: Vec<&str> = words.split(' ').chain(["forearm mass"]).collect();
    let forearm: serde_json::Value =
        serde_json::from_str(&run(here, &words).answered().out).expect("JSON");
    let numbers = forearm["numbers"].as_array().expect("a list").iter();
    let seen: Vec<bool> = numbers.map(|n| !n["deviation_percent"].is_null()).collect();
    assert_eq!(seen, [true, true, true, false, false, false]);
    let table = std::fs::read_to_string(here.join("n.csv")).expect("a table");
    let filled = table.replacen(",,,,,forearm mass", ",0.1,0.2,-0.9,,forearm mass", 1);
    assert_ne!(filled, table);
    std::fs::write(here.join("n.csv"), filled).expect("a table");
    let found = json("identify heavy_6r --measured n.csv --prior-percent 10 --json");
    assert_eq!(found["readings"], 3);
    let sheet = std::fs::read_to_string(here.join("n.txt")).expect("a sheet");
    assert!(sheet.contains("(base axes) on forearm mass"), "{sheet}");

    let found = json(
        "identify heavy_6r --measured pulls.csv --prior-percent 10 --work job.toml --report r.html --pdf r.pdf --json",
    );
    let work = found["work"].as_array().expect("a list");
    assert!(work.len() > 10, "{}", work.len());
    for place in work {
        let [displaced, before, after] = ["displacement_mm", "before_mm", "after_mm"]
            .map(|key| place[key].as_f64().expect("a number"));
        assert!(before < 0.5 * displaced && after < displaced, "{place}");
    }
    let report = std::fs::read_to_string(here.join("r.html")).expect("a report");
    assert_eq!(report.matches("<img ").count(), 5);
    assert!(!report.contains("<svg"), "pictures are images of their own");
    let pdf = std::fs::read(here.join("r.pdf")).expect("a report");
    assert!(pdf.starts_with(b"%PDF-"));
}
