//! The same question gives the same bytes, on any number of threads; and nearly the same on a processor
//! that cannot multiply and add in one step.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::common::{command, contents, run, workplace};
use kinetostat_testing::largest;
use serde_json::Value;

/// One of every kind of answer; files go to the working directory.
const QUERIES: [&str; 14] = [
    "check heavy_6r",
    "stiffness orthoglide --json",
    "deflect heavy_6r --force 300 0 -500 --json",
    "deflect job.toml --points points.csv --json result.json",
    "compensate job.toml --report report.html --points points.csv --json result.json",
    "assemble orthoglide --at 0 0 0 --json",
    "curve three_link_z --direction -1 0 0 --displacement-mm 0 400 --free rz --plot z.svg --csv z.csv",
    "equilibria three_link_z --displaced-mm -200 0 0 --free rz --json",
    "force --material C45 --tool ball --diameter-mm 8 --teeth 3 --helix-deg 30 --run-out-um 12 --width-mm 2 --depth-mm 5 --climb --feed-per-tooth-mm 0.05 --plot cut.svg --csv cut.csv --json",
    "reproduce table-5.2 --json",
    "model draw heavy_6r --force 300 0 -500 --out bent.svg",
    "model compare puu3 orthoglide",
    "model show stewart_gough_b",
    "import urdf crane.urdf --tip hook -o crane.toml",
];

/// Joints and links enough for names to be sorted in more than one way.
const URDF: &str = r#"<robot name="crane">
<link name="post"/><link name="jib"><inertial><mass value="40"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="trolley"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link><link name="hook"/><link name="lamp"/>
<joint name="slew" type="revolute"><parent link="post"/><child link="jib"/><origin xyz="0 0 2"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="luff" type="revolute"><parent link="jib"/><child link="trolley"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="lift" type="prismatic"><parent link="trolley"/><child link="hook"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="lamp joint" type="fixed"><parent link="jib"/><child link="lamp"/></joint>
</robot>
"#;

/// What a question says and writes, in a directory of its own.
#[derive(Debug, PartialEq)]
struct Answer {
    said: (Option<i32>, String, String),
    files: BTreeMap<PathBuf, Vec<u8>>,
}

fn answer(query: &str, environment: (&str, &str)) -> Answer {
    let here = workplace();
    std::fs::write(here.path().join("crane.urdf"), URDF).expect("a file");
    let output = command(here.path())
        .args(query.split(' '))
        .env(environment.0, environment.1)
        .output()
        .expect("the command starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let relative = |(path, bytes): (PathBuf, Vec<u8>)| {
        let path = path.strip_prefix(here.path()).expect("below").to_owned();
        (path, bytes)
    };
    Answer {
        said: (
            output.status.code(),
            text(&output.stdout),
            text(&output.stderr),
        ),
        files: contents(here.path()).into_iter().map(relative).collect(),
    }
}

#[test]
fn every_command_answers_with_the_same_bytes_on_any_number_of_threads() {
    for query in QUERIES {
        let first = answer(query, ("RAYON_NUM_THREADS", "1"));
        let code = match query.starts_with("compensate") {
            true => 4,
            false => 0,
        };
        assert_eq!(first.said.0, Some(code), "{query}: {first:?}");
        let again = answer(query, ("RAYON_NUM_THREADS", "3"));
        assert!(first == again, "{query}: {first:?} {again:?}");
    }
}

/// All numbers of a JSON value, in order.
fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(n) => found.extend(n.as_f64()),
        Value::Array(all) => all.iter().for_each(|v| numbers(v, found)),
        Value::Object(all) => all.values().for_each(|v| numbers(v, found)),
        _ => {}
    }
}

/// The C library takes other sines where a processor cannot multiply and add in one step.
#[test]
fn a_processor_without_fused_steps_writes_the_same_program() {
    if !cfg!(all(
        target_os = "linux",
        target_env = "gnu",
        target_arch = "x86_64"
    )) {
        println!("SKIPPED: only glibc on x86_64 can be told to leave such instructions alone");
        return;
    }
    let here = workplace();
    run(here.path(), &["demo", "--out", "fused"]).answered();
    let plain = command(here.path())
        .args(["demo", "--out", "plain"])
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4")
        .output()
        .expect("the command starts");
    assert!(plain.status.success());
    let read = |folder: &str, file: &str| {
        let path = here.path().join(folder).join(file);
        std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    let program = |folder| read(folder, "compensated.ngc");
    assert_eq!(program("fused"), program("plain"));
    let all = |folder| {
        let value = serde_json::from_slice(&read(folder, "result.json")).expect("JSON");
        let mut found = Vec::new();
        numbers(&value, &mut found);
        found
    };
    let (fused, plain) = (all("fused"), all("plain"));
    assert_eq!(fused.len(), plain.len());
    let apart = |(a, b): (&f64, &f64)| (a - b).abs() / a.abs().max(1.0);
    let worst = largest(fused.iter().zip(&plain).map(apart));
    println!("largest difference {worst:.1e} of {} numbers", fused.len());
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn a_folder_of_answers_is_compared_whole() {
    // A comparison that overlooked files would hold always.
    let fifth = answer(QUERIES[4], ("RAYON_NUM_THREADS", "2"));
    for file in ["out.ngc", "report.html", "points.csv", "result.json"] {
        assert!(fifth.files.contains_key(Path::new(file)), "{file}");
    }
}
