//! Points of a run as Parquet and as lines for ParaView, read back by pyarrow, polars and vtk where they are installed.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

use kinetostat_testing::largest;

use crate::common::{run, workplace};

/// Two cuts behind rapids, off the axes of the machine.
const PART: &str = "G21 G90\nG0 X-12 Y-9 Z5\nG0 Z0\nG1 X21 Y-4 F600\nG1 X25 Y13\nG1 X-11 Y17 Z-1\nG0 Z5\nG0 X30 Y-20\nG0 Z-1\nG1 X31 Y20\nG0 Z5\nM2\n";

const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [3, -2, 97]\npart_orientation = { a_b_c_kuka_deg = [30, -4, 7] }\n[tool]\nlength_mm = 100\n[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n[output]\nprogram = \"out.ngc\"\npoints = \"p.parquet\"\nvtk = \"p.vtk\"\njson = \"out.json\"\n";

/// Reads all files and compares numbers; says which package is missing.
const READ: &str = r#"
import csv, math, sys
try:
    import pyarrow.parquet as pq, polars, vtk
except ImportError as error:
    print("MISSING", error); sys.exit(0)
rows = list(csv.DictReader(open("p.csv")))
table = pq.read_table("p.parquet")
assert polars.read_parquet("p.parquet").shape == (len(rows), len(rows[0])) == table.shape, table.shape
meta = {k.decode(): v.decode() for k, v in pq.ParquetFile("p.parquet").metadata.metadata.items()}
assert meta["unit.error_before_x_mm"] == "mm" and meta["unit.force_x_n"] == "N", meta
assert meta["model"] == "orthoglide" or "orthoglide" in meta["model"], meta
for name in table.column_names:
    assert "unit." + name in meta and meta["description." + name] != "", name
    for cell, row in zip(table.column(name).to_pylist(), rows):
        if isinstance(cell, str):
            assert cell == row[name], (name, cell)
        else:
            assert (row[name] == "" and math.isnan(cell)) or cell == float(row[name]), (name, cell)
reader = vtk.vtkPolyDataReader(); reader.SetFileName("p.vtk"); reader.ReadAllVectorsOn(); reader.ReadAllScalarsOn(); reader.ReadAllTensorsOn(); reader.Update()
data = reader.GetOutput()
assert data.GetNumberOfPoints() == len(rows), data.GetNumberOfPoints()
rapids = [i for i, row in enumerate(rows) if row["kind"] == "rapid"]
assert data.GetNumberOfLines() == len(rapids) + (0 not in rapids)
worst = 0.0
for i, row in enumerate(rows):
    for name, key, digits in [("error_before_mm", "error_before_%s_mm", 5.1e-7), ("error_after_mm", "error_after_%s_mm", 5.1e-7), ("correction_mm", "correction_%s_mm", 5.1e-7), ("force_n", "force_%s_n", 5.1e-3)]:
        vector = data.GetPointData().GetArray(name).GetTuple3(i)
        for axis, x in zip("xyz", vector):
            assert abs(x - float(row[key % axis])) <= digits, (i, name, axis)
    place = data.GetPoint(i)
    for axis, x in zip("xyz", place):
        assert abs(x - float(row[axis + "_mm"])) <= 5.1e-5
    worst = max(worst, abs(float(row["error_before_x_mm"])))
assert worst > 1e-3
# Ellipsoids of the compliance: those of a load that moves the tool as far as it does, with the softest direction of the table.
tensors, has = [data.GetPointData().GetArray(name) for name in ("compliance_um_per_n", "has_compliance")]
known = [i for i in range(len(rows)) if has.GetTuple1(i) == 1]
assert 10 < len(known) <= 200, len(known)
for i, row in enumerate(rows):
    tensor = tensors.GetTuple(i)
    assert all(math.isfinite(x) == (i in known) for x in tensor), i
    if i not in known:
        continue
    assert row["kind"] == "feed", i
    c = [tensor[0:3], tensor[3:6], tensor[6:9]]
    times = lambda v: [sum(a * b for a, b in zip(line, v)) for line in c]
    assert all(abs(c[a][b] - c[b][a]) < 1e-12 for a in range(3) for b in range(3))
    force, before = [[float(row[name % axis]) for axis in "xyz"] for name in ("force_%s_n", "error_before_%s_mm")]
    off = [1e-3 * x - y for x, y in zip(times(force), before)]
    assert math.hypot(*off) < 0.02 * math.hypot(*before), (i, off, before)
    v = [0.5, 0.6, 0.7]
    for _ in range(3000):
        v = times(v); most = math.hypot(*v); v = [x / most for x in v]
    assert abs(most * float(row["smallest_stiffness_n_per_mm"]) / 1e3 - 1) < 2e-4, (i, most)
print("READ", len(rows))
"#;

fn python() -> String {
    std::env::var("KINETOSTAT_PYTHON").unwrap_or_else(|_| "python3".into())
}

#[test]
fn points_are_read_back_as_parquet_and_vtk() {
    let here = workplace();
    let at = here.path();
    std::fs::write(at.join("part.ngc"), PART).unwrap();
    std::fs::write(at.join("job.toml"), JOB).unwrap();
    let output = run(at, &["compensate", "job.toml"]);
    assert_eq!(output.code, 4, "{output:?}");
    let again = [
        "compensate",
        "job.toml",
        "--points",
        "p.csv",
        "--vtk",
        "q.vtk",
    ];
    let output = run(at, &[&again[..], &["--force-overwrite"]].concat());
    assert_eq!(output.code, 4, "{output:?}");
    let [one, other] = ["p.vtk", "q.vtk"].map(|name| std::fs::read(at.join(name)).unwrap());
    assert!(one == other && one.starts_with(b"# vtk DataFile"));
    let parquet = std::fs::read(at.join("p.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    // At most 25 bytes a value.
    let table = std::fs::read_to_string(at.join("p.csv")).unwrap();
    let values = table.matches([',', '\n']).count();
    assert!(
        table.len() <= 25 * values,
        "{} bytes of {values}",
        table.len()
    );
    read_back(at);
    // The same of a program that was verified.
    let verify = "verify out.ngc --job job.toml --points v.parquet --vtk v.vtk";
    let output = run(at, &verify.split(' ').collect::<Vec<_>>());
    assert_eq!(output.code, 4, "{output:?}");
    assert!(
        std::fs::read(at.join("v.parquet"))
            .unwrap()
            .starts_with(b"PAR1")
    );
    assert!(
        std::fs::read(at.join("v.vtk"))
            .unwrap()
            .starts_with(b"# vtk")
    );
}

fn read_back(at: &Path) {
    let made = Command::new(python())
        .args(["-c", READ])
        .current_dir(at)
        .output();
    let Ok(made) = made else {
        eprintln!(
            "SKIPPED: reading back by pyarrow, polars and vtk: no python3 (KINETOSTAT_PYTHON names one)"
        );
        return;
    };
    let said = String::from_utf8_lossy(&made.stdout);
    if said.starts_with("MISSING") {
        eprintln!("SKIPPED: reading back by pyarrow, polars and vtk: {said}");
        return;
    }
    let fault = String::from_utf8_lossy(&made.stderr);
    assert!(
        made.status.success() && said.starts_with("READ"),
        "{said}{fault}"
    );
}

/// On very short blocks that turn, the load turns from one end to the other: in the middle the tool is off though both ends
/// are compensated, by what `deflect` says of the load there.
#[test]
fn the_middles_of_very_short_blocks_count_where_the_load_turns() {
    let here = workplace();
    let (radial, tangential, axial) = (215.0, -10.0, -25.0);
    let (turn, step) = (25_f64.to_radians(), 0.02);
    // Five straight blocks, eleven after corners of 25 degrees, five straight ones.
    let mut heading = 0.0_f64;
    let mut at = [0.0_f64, 0.0];
    let mut places = vec![at];
    let mut headings = Vec::new();
    for i in 0..21 {
        if (5..16).contains(&i) {
            heading += turn;
        }
        at = [at[0] + step * heading.cos(), at[1] + step * heading.sin()];
        headings.push(heading);
        places.push(at);
    }
    let lines = places[1..].iter();
    let lines: String = lines
        .map(|[x, y]| format!("G1 X{x:.6} Y{y:.6}\n"))
        .collect();
    let program = format!("G21 G90\nG0 X0 Y0 Z2\nG1 Z0 F600\n{lines}G0 Z5\nM2\n");
    std::fs::write(here.path().join("fine.ngc"), program).unwrap();
    let words = "compensate --model orthoglide --tool-length-mm 100 --part-origin-mm 3 -2 97 --milling 215 -10 -25 \
                 --tolerance-um 60 --decimals 6 --program fine.ngc --out out.ngc --json";
    let said = run(here.path(), &words.split_whitespace().collect::<Vec<_>>()).answered();
    let answer: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let stated = answer["summary"]["max_position_error_after_mm"]
        .as_f64()
        .unwrap();
    let written = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let mut now = [0.0_f64; 3];
    let mut commanded = Vec::new();
    for line in written.lines().filter(|line| line.starts_with("G1 ")) {
        for word in line.split(' ').skip(1) {
            if let Some(axis) = "XYZ".find(&word[..1]) {
                now[axis] = word[1..].parse().unwrap();
            }
        }
        commanded.push(now);
    }
    let moved = |position: [f64; 3], force: [f64; 3]| -> [f64; 3] {
        let numbers = |all: [f64; 3]| all.map(|n| format!("{n:.9}")).join(" ");
        let words = format!(
            "deflect orthoglide --tool-length-mm 100 --at {} --force {} --json",
            numbers(position),
            numbers(force)
        );
        let said = run(here.path(), &words.split(' ').collect::<Vec<_>>()).answered();
        let answer: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        std::array::from_fn(|k| answer["displacement_mm"][k].as_f64().unwrap())
    };
    // The blocks on the circle: the corners before and behind them are alike.
    let blocks = 6..15;
    let first = commanded.len() - places.len() + 1;
    let off = blocks.map(|i| {
        let (c, s) = (headings[i].cos(), headings[i].sin());
        let force = [
            radial * s + tangential * c,
            -radial * c + tangential * s,
            axial,
        ];
        let [before, after] = [commanded[first + i - 1], commanded[first + i]];
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (before[k] + after[k]));
        let nominal = [
            0.5 * (places[i][0] + places[i + 1][0]),
            0.5 * (places[i][1] + places[i + 1][1]),
            0.0,
        ];
        let origin = [3.0, -2.0, 97.0];
        let by = moved(std::array::from_fn(|k| middle[k] + origin[k]), force);
        let off: [f64; 3] = std::array::from_fn(|k| middle[k] + by[k] - nominal[k]);
        off.iter().map(|d| d * d).sum::<f64>().sqrt()
    });
    let most = largest(off.collect::<Vec<_>>());
    assert!((0.005..0.06).contains(&most), "{most}");
    assert!(
        stated >= 0.999 * most && stated < 1.05 * most,
        "{stated} {most}"
    );
}

/// Blocks of a finishing program are solved where they end, every one; inside only as many as there would be if they were as long
/// as blocks that have a place inside, without a pattern, and the same however the program is cut into parts.
#[test]
fn very_short_blocks_are_looked_at_where_they_end_and_some_inside() {
    let here = workplace();
    let mut program = "G21 G90\nG0 X-20 Y0 Z2\nG1 Z0 F600\n".to_owned();
    let blocks = 2000;
    for i in 1..=blocks {
        let x = -20.0 + 0.02 * f64::from(i);
        program.push_str(&format!(
            "G1 X{x:.3} Z{:.4}\n",
            (0.3 * x).sin() - (-6_f64).sin()
        ));
    }
    program.push_str("G0 Z5\nM2\n");
    std::fs::write(here.path().join("fine.ngc"), program).unwrap();
    let words = "compensate --model orthoglide --tool-length-mm 100 --part-origin-mm 3 -2 97 --milling 215 -10 -25 \
                 --tolerance-um 5 --program fine.ngc --all-points --force-overwrite";
    let table = |name: &str, more: &[&str]| -> Vec<(String, f64)> {
        let words = words.split_whitespace().chain(["--points", name]);
        let words: Vec<&str> = words.chain(more.iter().copied()).collect();
        let said = run(here.path(), &words);
        assert_eq!(said.code, 4, "{said:?}");
        let text = std::fs::read_to_string(here.path().join(name)).unwrap();
        let rows = text.lines().skip(1).map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (cells[0].to_owned(), cells[3].parse().unwrap())
        });
        rows.collect()
    };
    let all = table("whole.csv", &[]);
    // Lines 4 to 2003.
    let ends = |line: usize| {
        all.iter()
            .any(|(own, share)| *own == line.to_string() && *share == 1.0)
    };
    assert!((4..4 + blocks as usize).all(ends));
    let inside: Vec<f64> = all
        .iter()
        .map(|(_, share)| *share)
        .filter(|s| *s > 0.0 && *s < 1.0)
        .collect();
    // 40 mm and a little, at one place for every 0.05 sixteenths of the machine's length.
    assert!((20..=120).contains(&inside.len()), "{}", inside.len());
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    assert!((mean - 0.5).abs() < 0.15, "{mean}");
    assert_eq!(all, table("parts.csv", &["--part-lines", "300"]));
}
