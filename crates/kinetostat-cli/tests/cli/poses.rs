//! Lists of poses through the commands: tables, and the rasters of a robot surface process.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::{gcode, run};

const SLOT: &str = "\
x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid,note
0,0,20,0,0,1,0,,1,above
0,0,-1,0,0,1,0,20,0,in
60,0,-1,0,0,1,0,20,0,along
60,0,20,0,0,1,0,,1,up
";

/// Tool and part as options.
const PLACED: &str = "--tool-length-mm 180 --part-origin-mm 1800 0 900";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn within(summary: &Value, before_mm: f64, after_mm: f64) {
    let [before, after] = [
        "max_position_error_before_mm",
        "max_position_error_after_mm",
    ]
    .map(|key| summary[key].as_f64().unwrap());
    assert!(before > before_mm, "{summary}");
    assert!(after < after_mm, "{summary}");
}

#[test]
fn a_table_of_poses_is_compensated_and_is_one_again() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("slot.csv"), SLOT).unwrap();
    let line = format!(
        "compensate --model heavy_6r --weight all --program slot.csv --milling 300 -100 -50 --tolerance-um 10 --correct pose --json out.json {PLACED}"
    );
    run(here, &words(&line)).answered();
    let output = read(here, "slot-compensated.csv");
    assert!(
        output.starts_with("# kinetostat: compensated program"),
        "{output}"
    );
    let rows: Vec<Vec<&str>> = (output.lines())
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows[0].join(","), SLOT.lines().next().unwrap());
    assert!(rows.len() > 5, "{output}");
    // What is no number of a pose or speed is as it was, in each further row, too.
    assert_eq!(rows.last().unwrap()[7..], ["", "1", "up"]);
    assert_eq!(rows[1][7..], ["", "1", "above"]);
    let end = rows.iter().rfind(|row| row[9] == "along").unwrap();
    let place: Vec<f64> = end[..3].iter().map(|cell| cell.parse().unwrap()).collect();
    let off = (place[0] - 60.0).hypot(place[1]).hypot(place[2] + 1.0);
    assert!((0.01..20.0).contains(&off), "{end:?}");
    let out: Value = serde_json::from_str(&read(here, "out.json")).unwrap();
    within(&out["summary"], 0.1, 0.0201);
    let again = format!(
        "compensate --model heavy_6r --weight all --program slot-compensated.csv --milling 1 1 1 {PLACED}"
    );
    let refused = run(here, &words(&again));
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("compensated already"), "{refused:?}");
}

/// The same four poses, which pyarrow wrote, with types that text cannot say.
#[cfg(feature = "parquet")]
#[test]
fn a_table_in_parquet_is_compensated_and_is_parquet_again() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let slot = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../kinetostat-formats/tests/formats/fixtures/slot.parquet"
    );
    std::fs::copy(slot, here.join("slot.parquet")).unwrap();
    let line = |force: &str| {
        format!(
            "compensate --model heavy_6r --weight all --program slot.parquet --milling {force} --tolerance-um 10 --correct pose --json out.json {PLACED}"
        )
    };
    run(here, &words(&line("300 -100 -50"))).answered();
    let written = std::fs::read(here.join("slot-compensated.parquet")).unwrap();
    assert!(written.starts_with(b"PAR1") && written.ends_with(b"PAR1"));
    let out: Value = serde_json::from_str(&read(here, "out.json")).unwrap();
    within(&out["summary"], 0.1, 0.0201);
    let again = format!(
        "deflect heavy_6r --weight all --program slot-compensated.parquet --milling 300 -100 -50 --json again.json {PLACED}"
    );
    run(here, &words(&again)).answered();
}

#[test]
fn the_unit_of_lengths_is_stated_or_the_list_is_refused() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    put(
        "slot.yaml",
        "- position: {x: 0, y: 0, z: 0.02}\n- position: {x: 0, y: 0, z: -0.001}\n- position: {x: 0.06, y: 0, z: -0.001}\n",
    );
    let job = |unit: &str| {
        put(
            "job.toml",
            &format!(
                "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"slot.yaml\"\n[load]\nweight = \"all\"\nforce_n = [0, 0, 100]\n[tool]\nlength_mm = 180\n[placement]\npart_origin_mm = [1800, 0, 900]\n{unit}"
            ),
        );
    };
    job("");
    let refused = run(here, &["check", "job.toml"]);
    assert_eq!(refused.code, 1);
    let said = flat(&refused.err);
    assert!(
        said.contains("whether lengths are mm or m is not stated"),
        "{said}"
    );
    assert!(said.contains("length_unit"), "{said}");
    job("[robot]\nlength_unit = \"m\"\n");
    run(here, &["compensate", "job.toml"]).answered();
    let output = read(here, "slot-compensated.yaml");
    assert!(output.contains("- position: {x: 0.0"), "{output}");
    job("[robot]\nlength_unit = \"furlong\"\n");
    assert_eq!(run(here, &["check", "job.toml"]).code, 1);
}

#[test]
fn joint_values_are_refused_in_words_and_the_table_of_names_is_shown() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("q.csv"), "joint_1_deg,joint_2_deg\n1,2\n").unwrap();
    let said = run(
        here,
        &words("deflect heavy_6r --program q.csv --force 0 0 1"),
    );
    assert_eq!(said.code, 1);
    assert!(
        flat(&said.err).contains("the table states joint values"),
        "{said:?}"
    );
    let shown = run(here, &["dialect", "show", "poses", "--json"]).answered();
    let table: Value = serde_json::from_str(&shown.out).unwrap();
    assert!(table["words"].as_array().unwrap().len() > 20);
}

#[test]
fn rasters_of_a_robot_surface_process_are_compensated() {
    let name = "crs_scanned_part1_job_90degrees.poses.yaml";
    let Some(folder) = gcode() else {
        return;
    };
    let bytes = std::fs::read(folder.join(name)).unwrap();
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("part.yaml"), &bytes).unwrap();
    // The poses' z points out of the part, along its x: turned, it looks at the robot.
    std::fs::write(
        here.join("job.toml"),
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.yaml\"\n[load]\nweight = \"all\"\nmilling = { radial_n = 0, tangential_n = -20, axial_n = -100 }\n[robot]\ncorrect = \"pose\"\ntool_axis = \"z\"\n[robot.frames]\ntool = { position_mm = [0, 0, 180], roll_pitch_yaw_urdf_deg = [180, 0, 0] }\npart = { position_mm = [2000, 0, 1300], roll_pitch_yaw_urdf_deg = [0, 0, 180] }\n[output]\njson = \"out.json\"\n",
    )
    .unwrap();
    let said = run(here, &["compensate", "job.toml"]).answered();
    assert!(flat(&said.out).contains("taken as metres"), "{said:?}");
    let out: Value = serde_json::from_str(&read(here, "out.json")).unwrap();
    within(&out["summary"], 0.05, 0.0201);
    let output = read(here, "part-compensated.yaml");
    let input = String::from_utf8(bytes).unwrap();
    let count = |text: &str, word: &str| text.matches(word).count();
    assert_eq!(count(&output, "frame_id"), count(&input, "frame_id"));
    assert!(count(&output, "orientation:") >= count(&input, "orientation:"));
    assert!(output.ends_with("min_polygons_per_cluster: 500"));
}

#[test]
fn a_table_of_a_spreadsheet_keeps_its_byte_order_mark_and_odd_names_are_refused() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let rows = "0,0,50,0,0,1,0\n0,0,-1,0,0,1,0\n60,0,-1,0,0,1,0\n";
    let line = "compensate --model heavy_6r --weight all --program t.csv --force 0 0 100 --part-origin-mm 1800 0 900 --tool-length-mm 150 --out o.csv";
    let words: Vec<&str> = line.split_whitespace().collect();
    std::fs::write(
        here.join("t.csv"),
        format!("\u{feff}x_mm,y_mm,z_mm,qw,qx,qy,qz\n{rows}"),
    )
    .unwrap();
    run(here, &words).answered();
    let output = std::fs::read_to_string(here.join("o.csv")).unwrap();
    assert!(
        output.starts_with("\u{feff}x_mm,y_mm,z_mm,qw,qx,qy,qz\n# kinetostat"),
        "{output}"
    );
    std::fs::write(
        here.join("t.csv"),
        format!("x_mm,y_mm,z_mm,q1,q2,q3,q4\n{rows}"),
    )
    .unwrap();
    let refused = run(here, &words);
    assert_eq!(refused.code, 1);
    assert!(
        refused.err.contains("looks like a part of an orientation"),
        "{refused:?}"
    );
}
