//! `kinetostat import matrix` and `import link-displacements`: from files of other programs to a model
//! that `check` and `stiffness` answer for.

use std::path::Path;
use std::process::Command;

use crate::common::{BINARY, MODEL, run, workplace};
use kinetostat_testing::largest_size;
use serde_json::Value;

/// The cantilever of the tube in `MODEL`, 800 mm, N and mm, columns in another order.
fn tube() -> String {
    let (e, g, length) = (70e3, 26e3, 800.0_f64);
    let moment = std::f64::consts::PI / 64.0 * (60_f64.powi(4) - 50_f64.powi(4));
    let area = std::f64::consts::PI / 4.0 * (60_f64.powi(2) - 50_f64.powi(2));
    let bend = e * moment;
    let k = |i: usize, j: usize| match (i.min(j), i.max(j)) {
        (0, 0) => e * area / length,
        (1, 1) | (2, 2) => 12.0 * bend / length.powi(3),
        (3, 3) => g * 2.0 * moment / length,
        (4, 4) | (5, 5) => 4.0 * bend / length,
        (1, 5) => -6.0 * bend / length.powi(2),
        (2, 4) => 6.0 * bend / length.powi(2),
        _ => 0.0,
    };
    let names = ["x", "y", "z", "rx", "ry", "rz"];
    let order = [3, 4, 5, 0, 1, 2];
    let mut out = String::from("source,closed form\nstiffness_n_mm_rad");
    for i in order {
        out += &format!(",{}", names[i]);
    }
    for i in 0..6 {
        out += &format!("\n{}", names[i]);
        for j in order {
            out += &format!(",{:e}", k(i, j));
        }
    }
    out + "\n"
}

fn stiffness_of(folder: &Path, model: &str) -> Value {
    let said = run(folder, &["stiffness", model, "--json"]).answered();
    serde_json::from_str(&said.out).expect("JSON")
}

/// A robot with the imported table is the robot with the section.
#[test]
fn an_imported_matrix_is_the_link_of_a_robot() {
    let here = workplace();
    let path = here.path();
    std::fs::write(path.join("tube.csv"), tube()).expect("a file");
    let table = run(path, &["import", "matrix", "tube.csv", "--name", "tube"]).answered();
    assert!(
        table
            .out
            .starts_with("[stiffness.tube]\nmatrix_n_mm_rad = ["),
        "{}",
        table.out
    );
    assert!(table.out.contains("source = \"closed form\""));
    let (before, after) = MODEL.split_once("[section.tube]").expect("a section");
    let (_, after) = after.split_once("\n\n").expect("its end");
    std::fs::write(path.join("by_section.toml"), MODEL).expect("a file");
    std::fs::write(
        path.join("by_matrix.toml"),
        format!("{before}{}\n{after}", table.out),
    )
    .expect("a file");
    let (one, other) = (
        stiffness_of(path, "by_section.toml"),
        stiffness_of(path, "by_matrix.toml"),
    );
    let numbers = |v: &Value| -> Vec<f64> {
        let mut found = Vec::new();
        let mut open = vec![v.clone()];
        while let Some(v) = open.pop() {
            match v {
                Value::Number(n) => found.push(n.as_f64().expect("a number")),
                Value::Array(list) => open.extend(list),
                Value::Object(map) => open.extend(
                    map.into_iter()
                        .filter(|(k, _)| k == "matrix" || k.contains("stiffness"))
                        .map(|(_, v)| v),
                ),
                _ => {}
            }
        }
        found
    };
    let (a, b) = (numbers(&one), numbers(&other));
    let largest = largest_size(a.iter().copied());
    assert!(a.len() >= 36 && a.len() == b.len(), "{one}");
    assert!(
        a.iter()
            .zip(&b)
            .all(|(x, y)| (x - y).abs() < 1e-9 * largest)
    );
    // As JSON, into a file, and not over it.
    let words = ["import", "matrix", "tube.csv", "--json", "-o", "tube.toml"];
    let said = run(path, &words).answered();
    let found: Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(
        (found["name"].as_str(), found["rank"].as_u64()),
        (Some("tube"), Some(6))
    );
    assert!(path.join("tube.toml").exists());
    let again = run(path, &words);
    assert!(
        again.code == 1 && again.err.contains("it exists already"),
        "{}",
        again.err
    );
}

#[test]
fn displacements_of_a_known_compliance() {
    let here = workplace();
    // Springs of 2000 N/mm and 5e6 N mm/rad at the end (10, 0, 0): each load moves along itself.
    let mut csv = String::from("case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm\n");
    for (c, case) in ["fx", "fy", "fz", "mx", "my", "mz"].iter().enumerate() {
        for (n, p) in [
            [10.0, 5.0, 0.0],
            [10.0, -5.0, 3.0],
            [10.0, 0.0, -6.0],
            [12.0, 1.0, 1.0],
        ]
        .iter()
        .enumerate()
        {
            let arm = [p[0] - 10.0, p[1], p[2]];
            let mut u = [0.0; 3];
            if c < 3 {
                u[c] = 100.0 / 2000.0;
            } else {
                let (i, j) = ((c - 2) % 3, (c - 1) % 3);
                // phi x arm with phi along axis c - 3.
                u[i] = -1000.0 / 5e6 * arm[j];
                u[j] = 1000.0 / 5e6 * arm[i];
            }
            csv += &format!(
                "{case},{n},{},{},{},{},{},{}\n",
                p[0], p[1], p[2], u[0], u[1], u[2]
            );
        }
    }
    std::fs::write(here.path().join("u.csv"), csv).expect("a file");
    let line =
        "import link-displacements u.csv --end-mm 10 0 0 --force-n 100 --moment-n-mm 1000 --json";
    let said = run(here.path(), &line.split(' ').collect::<Vec<_>>()).answered();
    let found: Value = serde_json::from_str(&said.out).expect("JSON");
    for i in 0..6 {
        for j in 0..6 {
            let wanted = if i != j {
                0.0
            } else if i < 3 {
                2000.0
            } else {
                5e6
            };
            let k = found["stiffness_n_mm_rad"][i][j]
                .as_f64()
                .expect("a number");
            assert!(
                (k - wanted).abs() < 1e-6 * if i + j < 5 { 2000.0 } else { 5e6 },
                "{i} {j} {k}"
            );
        }
    }
    assert!(said.err.contains("rank 6 of 6"), "{}", said.err);
}

#[test]
fn what_is_no_stiffness_is_refused_with_the_way_out() {
    let here = workplace();
    let path = here.path();
    let write = |name: &str, body: &str| std::fs::write(path.join(name), body).expect("a file");
    let good = tube();
    write(
        "skew.csv",
        &good
            .replacen("\nrz,", "\nrz,1e6,", 1)
            .replacen(",0e0\n", "\n", 1),
    );
    let pairs: String = (1..=6).map(|d| format!("1,{d},1,{d},5.0\n")).collect();
    write("k.mtx", &pairs);
    let lines = [
        ("import matrix absent.csv", "does not exist"),
        ("import matrix k.mtx", "--interface"),
        ("import matrix k.mtx --interface 1", "--units"),
        (
            "import matrix k.mtx --interface 1 --units furlong",
            "furlong",
        ),
        (
            "import matrix k.mtx --interface 7 --units n-mm",
            "node 7 of the interface",
        ),
        (
            "import matrix k.mtx --interface TIP --units n-mm",
            "no set of nodes",
        ),
        ("import matrix skew.csv --x-axis 1 0 0", "--interface"),
        (
            "import link-displacements k.mtx --end-mm 0 0 0",
            "not known",
        ),
    ];
    for (line, needle) in lines {
        let said = run(path, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(said.code, 1, "{line}: {}", said.out);
        assert!(
            said.err.contains(needle),
            "{line}: '{needle}' is not in {}",
            said.err
        );
    }
    let said = run(
        path,
        &[
            "import",
            "matrix",
            "k.mtx",
            "--interface",
            "1",
            "--units",
            "n-mm",
        ],
    )
    .answered();
    assert!(
        said.err.contains("Notices") && said.err.contains("check the units"),
        "{}",
        said.err
    );
}

/// The example of the repository with gmsh and CalculiX themselves.
#[test]
fn the_example_from_calculix_runs() {
    let here = workplace();
    let script =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/link-from-calculix/run.sh");
    let done = Command::new("sh")
        .arg(&script)
        .arg("out")
        .current_dir(here.path())
        .env("KINETOSTAT", BINARY)
        .env("OMP_NUM_THREADS", "1")
        .output();
    let Ok(done) = done else {
        eprintln!("SKIPPED: there is no shell");
        return;
    };
    let (out, err) = (
        String::from_utf8_lossy(&done.stdout),
        String::from_utf8_lossy(&done.stderr),
    );
    assert!(done.status.success(), "{out}{err}");
    if out.starts_with("SKIPPED") {
        eprintln!("{out}");
        return;
    }
    // Across: 12 EI / L^3 of the boom in series with the drive is what the tool feels; both ways agree.
    let rows = |name: &str| -> Vec<f64> {
        std::fs::read_to_string(here.path().join("out").join(name))
            .expect("a table")
            .lines()
            .filter_map(|l| l.trim().strip_prefix('[')?.strip_suffix("],"))
            .flat_map(|l| {
                l.split(", ")
                    .map(|x| x.parse::<f64>().expect("a number"))
                    .collect::<Vec<_>>()
            })
            .collect()
    };
    let (one, other) = (rows("boom.toml"), rows("boom-by-loads.toml"));
    assert_eq!((one.len(), other.len()), (36, 36));
    for i in 0..6 {
        for j in 0..6 {
            let unit = (one[7 * i] * one[7 * j]).sqrt();
            assert!((one[6 * i + j] - other[6 * i + j]).abs() < 5e-6 * unit);
        }
    }
    // Stretch of 40 x 60 mm steel over 600 mm: 840 000 N/mm, the mesh 0.6 % more.
    assert!((one[0] / 840_000.0 - 1.0058).abs() < 1e-3, "{}", one[0]);
    assert!(out.contains("anti-symmetric share"), "{out}");
}
