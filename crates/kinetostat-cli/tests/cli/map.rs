//! `kinetostat map`: figures on a grid of places, as table, drawing and JSON.

use crate::common::{Said, command, run, workplace};
use kinetostat_testing::{largest, least};
use serde_json::Value;
use std::path::Path;

fn map(here: &Path, line: &str) -> Said {
    let mut words = vec!["map"];
    words.extend(line.split(' '));
    run(here, &words)
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

#[test]
fn a_place_of_the_map_is_what_stiffness_says_there() {
    let here = workplace();
    let line =
        "orthoglide --x -60 40 6 --y 25 --z 70 120 3 --tool-length-mm 100 --csv map.csv --json";
    let answer = json(&map(here.path(), line).answered());
    assert_eq!(answer["places"]["asked"], 18);
    let table = std::fs::read_to_string(here.path().join("map.csv")).expect("the table");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 19);
    assert!(lines[0].starts_with("x_mm,y_mm,z_mm,smallest_stiffness_n_per_mm,"));
    // x runs fastest.
    let row: Vec<&str> = lines[3].split(',').collect();
    assert_eq!(row[..3], ["-20", "25", "70"]);
    assert_eq!(row[7], "ok");
    let place = [
        "stiffness",
        "orthoglide",
        "--at",
        "-20",
        "25",
        "70",
        "--tool-length-mm",
        "100",
        "--json",
    ];
    let there = json(&run(here.path(), &place).answered());
    let compliance = |i: usize| {
        there["compliance_m_rad_per_n"][i][i]
            .as_f64()
            .expect("a number")
    };
    for k in 0..3 {
        let own: f64 = row[4 + k].parse().expect("a number");
        assert!((own * compliance(k) * 1e3 - 1.0).abs() < 5e-5, "{row:?}");
    }
    // Extremes are those of the table.
    let column = |k: usize| -> Vec<f64> {
        let cells = lines[1..]
            .iter()
            .map(|l| l.split(',').nth(k).expect("a cell"));
        cells.map(|c| c.parse().expect("a number")).collect()
    };
    let softest = &answer["figures"][0];
    assert_eq!(softest["name"], "smallest_stiffness_n_per_mm");
    let lowest = least(column(3));
    let most = largest(column(3));
    for (name, of_table) in [("least", lowest), ("most", most)] {
        let value = softest[name]["value"].as_f64().expect("a number");
        assert!((value / of_table - 1.0).abs() < 5e-5, "{value} {of_table}");
    }
}

/// Heads of further columns carry units; those of an actuator are those of its kind.
#[test]
fn heads_of_a_table_carry_units() {
    let here = workplace();
    for (machine, of_drive) in [("orthoglide", ["m", "n"]), ("heavy_6r", ["rad", "n_m"])] {
        let x = if machine == "orthoglide" { 10 } else { 1500 };
        map(
            here.path(),
            &format!("{machine} --x {x} --force 1 2 3 --variables stiffness_x,rotational_stiffness_y,principal_compliance,margin,commands,joint_efforts --csv map.csv --force-overwrite"),
        )
        .answered();
        let table = std::fs::read_to_string(here.path().join("map.csv")).expect("the table");
        let heads: Vec<&str> = table
            .lines()
            .next()
            .unwrap_or_default()
            .split(',')
            .collect();
        let [command, effort] = of_drive;
        for head in [
            "stiffness_x_n_per_m",
            "rotational_stiffness_y_n_m_per_rad",
            "principal_compliance_3_m_per_n",
            "margin",
            &format!("commands_2_{command}"),
            &format!("joint_efforts_3_{effort}"),
        ] {
            assert!(heads.contains(&head), "{head}: {heads:?}");
        }
    }
}

#[test]
fn under_a_load_it_tells_where_the_tool_goes() {
    let here = workplace();
    let line = "orthoglide --x -40 40 3 --y -40 40 3 --force 215 -10 -25 --csv map.csv --plot d.svg --show displacement";
    let said = map(here.path(), line).answered();
    assert!(
        said.out.contains("moved, mm") && said.out.contains("9  stable"),
        "{}",
        said.out
    );
    let table = std::fs::read_to_string(here.path().join("map.csv")).expect("the table");
    let row: Vec<&str> = table.lines().nth(1).expect("a place").split(',').collect();
    let place = [
        "deflect",
        "orthoglide",
        "--at",
        "-40",
        "-40",
        "0",
        "--force",
        "215",
        "-10",
        "-25",
        "--json",
    ];
    let there = json(&run(here.path(), &place).answered());
    for k in 0..3 {
        let own: f64 = row[7 + k].parse().expect("a number");
        let alone = there["displacement_mm"][k].as_f64().expect("a number");
        // To the last digit of the table, 1 nm.
        assert!((own - alone).abs() < 0.6e-6, "{own} {alone}");
    }
    let svg = std::fs::read_to_string(here.path().join("d.svg")).expect("the drawing");
    assert!(svg.starts_with("<svg") && svg.contains("displacement, mm"));
    let legend = svg.matches(">machine with its tool in the middle<");
    assert_eq!(legend.count(), 1, "three limbs have one name");
}

/// Digits that mean something, on places that no decimal number meets: as many as in the table of points.
#[test]
fn the_table_has_no_digits_that_mean_nothing() {
    let here = workplace();
    for line in [
        "orthoglide --x -60 40 7 --y -20 30 4 --z 70 100 4 --tool-length-mm 100 --force 215 -10 -25",
        "heavy_6r --x 900 3300 7 --y -300 700 4 --z 500 1900 4",
        "prs3 --x -10 10 4 --z -770 -740 4 --force 3 2 1",
    ] {
        map(
            here.path(),
            &format!("{line} --csv map.csv --force-overwrite"),
        )
        .answered();
        let table = std::fs::read_to_string(here.path().join("map.csv")).expect("the table");
        let mut lines = table.lines();
        let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
        let mut numbers = 0;
        for row in lines {
            for (cell, name) in row.split(',').zip(&names) {
                let (_, decimals) = cell.split_once('.').unwrap_or((cell, ""));
                let digits = cell.trim_start_matches(['-', '0', '.']);
                let digits = digits.bytes().filter(u8::is_ascii_digit).count();
                match name {
                    &"status" => continue,
                    name if name.ends_with("n_per_mm") => {
                        assert!(digits <= 5 || decimals.is_empty(), "{name}: {cell}");
                    }
                    &("x_mm" | "y_mm" | "z_mm") => assert!(decimals.len() <= 4, "{name}: {cell}"),
                    name if name.ends_with("_mm") => {
                        assert!(decimals.len() <= 6, "{name}: {cell}");
                    }
                    _ => assert!(decimals.len() <= 5, "{name}: {cell}"),
                }
                numbers += usize::from(cell.parse::<f64>().is_ok_and(f64::is_finite));
            }
        }
        assert!(numbers > 60, "{line}: {numbers}");
    }
}

#[test]
fn one_thread_and_two_write_the_same_bytes() {
    let here = workplace();
    let files = |threads: &str| {
        let line = format!(
            "heavy_6r --x 900 3300 19 --y -300 700 9 --z 500 1900 2 --section z=700 --csv {threads}.csv --plot {threads}.svg --json --threads {threads}"
        );
        let said = map(here.path(), &line).answered();
        let read = |end: &str| {
            std::fs::read(here.path().join(format!("{threads}.{end}"))).expect("a file")
        };
        (said.out, read("csv"), read("svg"))
    };
    let one = files("1");
    assert_eq!(one, files("2"));
    let answer: Value = serde_json::from_str(&one.0).expect("JSON");
    let count = |name: &str| answer["places"][name].as_u64().expect("a count");
    assert!(count("unreachable") > 0 && count("regular") > 0, "{answer}");
}

/// Whichever end of an axis is named first: the same places, files and drawing, and no drawing without places.
#[test]
fn falling_axes_are_the_same_map() {
    let here = workplace();
    let files = |name: &str, x: &str, y: &str| {
        let line = format!(
            "orthoglide --x {x} --y {y} --z 10 --csv {name}.csv --plot {name}.svg --vtk {name}.vtk"
        );
        map(here.path(), &line).answered();
        ["csv", "svg", "vtk"]
            .map(|end| std::fs::read(here.path().join(format!("{name}.{end}"))).expect("a file"))
    };
    let rising = files("rising", "-60 40 6", "-30 50 5");
    assert_eq!(files("falling", "40 -60 6", "50 -30 5"), rising);
    let table = String::from_utf8_lossy(&rising[0]);
    let xs = table.lines().skip(1).map(|l| l.split(',').next());
    let wanted = ["-60", "-40", "-20", "0", "20", "40"];
    assert!(
        xs.eq(wanted.into_iter().cycle().take(30).map(Some)),
        "{table}"
    );
    let svg = String::from_utf8_lossy(&rising[1]);
    assert!(svg.contains("best") && !svg.contains("no places"), "{svg}");
}

#[test]
fn what_makes_no_map_is_refused_and_leaves_nothing() {
    let here = workplace();
    for (line, code, needle) in [
        ("orthoglide", 1, "--x"),
        ("orthoglide --x 0 10 2.5", 1, "whole number"),
        ("orthoglide --x 0 10 1", 1, "two places"),
        ("orthoglide --x 0 0 5", 1, "one place"),
        ("orthoglide --x 0 1e9 5", 1, "10 km"),
        (
            "orthoglide --x 0 9 9999 --y 0 9 9999 --z 0 9 9999",
            1,
            "the most",
        ),
        (
            "orthoglide --x 0 9 --plot a.svg --show rotation",
            1,
            "--force",
        ),
        ("orthoglide --x 0 9 --plot a.svg --section w=3", 1, "z=150"),
        ("orthoglide --x 0 9 --show x", 1, "--plot"),
        ("orthoglide --x 0 9 --csv no/such.csv", 1, "does not exist"),
        (
            "orthoglide --x 900 990 4 --csv a.csv --plot a.svg",
            2,
            "none of the 4 places",
        ),
    ] {
        let before = std::fs::read_dir(here.path()).expect("a directory").count();
        let said = map(here.path(), line);
        assert_eq!(said.code, code, "{line}: {said:?}");
        assert!(said.err.contains(needle), "{line}: {said:?}");
        let after = std::fs::read_dir(here.path()).expect("a directory").count();
        assert_eq!(before, after, "{line}");
    }
}

/// A place that was found with a growing load is counted by the map, and named by `deflect` and `assemble`; a machine that
/// no kernel knows says why.
#[test]
fn the_answer_says_what_was_found_otherwise_or_one_by_one() {
    let here = workplace();
    run(here.path(), &["demo", "--out", "d"]).answered();
    let common = "--tool-length-mm 100 --json --force 5000 0 0";
    let said = map(
        here.path(),
        &format!("d/model.toml --x 20 --y 20 --z 118 {common}"),
    )
    .answered();
    let answer = json(&said);
    let found = serde_json::json!([{ "found_by": "growing_load", "places": 1 }]);
    assert_eq!(answer["found_otherwise"], found);
    assert!(answer.get("one_by_one_because").is_none(), "{answer}");
    assert!(
        said.err.contains("At 1 place the equilibrium was found"),
        "{}",
        said.err
    );
    for command in ["deflect", "assemble"] {
        let line = format!("{command} d/model.toml --at 20 20 118 {common}");
        let words: Vec<&str> = line.split(' ').collect();
        let answer = json(&run(here.path(), &words).answered());
        assert_eq!(answer["found_by"], "growing_load", "{command}");
    }
    let line = format!("assemble d/model.toml --along 20 20 118 21 20 118 --points 2 {common}");
    let said = run(here.path(), &line.split(' ').collect::<Vec<_>>()).answered();
    assert_eq!(json(&said)["points"][0]["found_by"], "growing_load");
    let said = map(here.path(), "delta --x 0 --force 0 0 -100 --json").answered();
    let answer = json(&said);
    assert!(answer.get("found_otherwise").is_none(), "{answer}");
    let why = "it has platforms between base and tool";
    assert_eq!(answer["one_by_one_because"], why);
    assert!(said.err.contains(why), "{}", said.err);
    let line = "deflect delta --weight all --program part.ngc --part-origin-mm 0 0 -850 --json";
    let said = run(here.path(), &line.split(' ').collect::<Vec<_>>()).answered();
    assert_eq!(json(&said)["summary"]["one_by_one_because"], why);
}

/// Codes of the warnings of a command with `--json`.
fn codes(here: &Path, line: &str) -> Vec<String> {
    let words: Vec<&str> = line.split(' ').collect();
    let answer = json(&run(here, &words).answered());
    let list = answer["warnings"].as_array().expect("a list").clone();
    let code = |w: &Value| w["code"].as_str().expect("a code").to_owned();
    list.iter().map(code).collect()
}

#[test]
fn a_map_warns_of_what_deflect_warns_of() {
    let here = workplace();
    for force in ["1e6 0 0", "3000 0 0", "2700 0 0", "100 0 0"] {
        let map = codes(
            here.path(),
            &format!("map orthoglide --x 50 --y 0 --z 0 --force {force} --json"),
        );
        let place = codes(
            here.path(),
            &format!("deflect orthoglide --at 50 0 0 --force {force} --json"),
        );
        for code in [
            "over_limit",
            "large_load",
            "not_stable",
            "large_displacement",
        ] {
            let in_map = map.iter().any(|c| c == code);
            assert_eq!(
                in_map,
                place.iter().any(|c| c == code),
                "{force}: {code}: {map:?} {place:?}"
            );
        }
    }
}

#[test]
fn one_warning_counts_the_places_that_are_not_stable() {
    let here = workplace();
    let line = "orthoglide --x -50 50 4 --y -50 50 4 --z 0 --force 1e6 0 0 --json";
    let answer = json(&map(here.path(), line).answered());
    let unstable = answer["places"]["unstable"].as_u64().expect("a number");
    assert!(unstable > 0, "{}", answer["places"]);
    let list = answer["warnings"].as_array().expect("a list");
    let of = |code: &str| {
        let all = list.iter().filter(|w| w["code"] == code);
        let all: Vec<&str> = all.filter_map(|w| w["message"].as_str()).collect();
        assert_eq!(all.len(), 1, "{list:?}");
        all[0].to_owned()
    };
    assert!(of("not_stable").contains(&format!("at {unstable} of the 16 places")));
    assert!(of("large_displacement").contains("of the 16 places"));
}

/// A map that takes some seconds, kept in `rows`.
const LONG: &str = "orthoglide --x -50 45 40 --y -40 55 40 --z 60 130 25 --force 100 -40 30 --tool-length-mm 30 --csv map.csv --resume rows --force-overwrite --threads 1";

#[test]
fn a_killed_map_goes_on_and_ends_with_the_same_bytes() {
    let here = workplace();
    map(here.path(), LONG).answered();
    let read = |name: &str| std::fs::read(here.path().join(name)).expect(name);
    let wanted = read("map.csv");
    let rows = here.path().join("rows/rows.bin");
    let complete = read("rows/rows.bin");
    std::fs::remove_dir_all(here.path().join("rows")).expect("removed");
    let mut kept = Vec::new();
    for _ in 0..3 {
        let before = std::fs::metadata(&rows).map_or(0, |file| file.len());
        let mut child = command(here.path())
            .arg("map")
            .args(LONG.split(' '))
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .expect("the command starts");
        // Until it has kept something more, or is over.
        let more = || std::fs::metadata(&rows).is_ok_and(|file| file.len() > before);
        while !more() && child.try_wait().expect("asked").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        // Two runs do not write into one another's rows.
        let alive = child.try_wait().expect("asked").is_none();
        let other = map(here.path(), LONG);
        if alive && other.code != 0 {
            let said = other.err.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(said.contains("another run keeps its rows there"), "{said}");
        }
        child.kill().expect("killed");
        child.wait().expect("ends");
        kept.push(read("rows/rows.bin").len());
    }
    assert!(kept.is_sorted() && kept[0] > 0, "{kept:?}");
    map(here.path(), LONG).answered();
    assert!(read("map.csv") == wanted && read("rows/rows.bin") == complete);
}

#[test]
fn damaged_rows_of_a_map_are_solved_again() {
    let here = workplace();
    let line = "orthoglide --x -50 45 21 --y -40 55 19 --z 95 --tool-length-mm 30 --csv map.csv --resume rows --force-overwrite";
    map(here.path(), line).answered();
    let path = here.path().join("rows/rows.bin");
    let table = || std::fs::read(here.path().join("map.csv")).expect("a table");
    let (complete, wanted) = (std::fs::read(&path).expect("rows"), table());
    let with = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = complete.clone();
        change(&mut bytes);
        bytes
    };
    let cases = [
        // Cut off, zeros of a disk that lost its power, one bit, more than there was.
        with(&|bytes| bytes.truncate(complete.len() * 2 / 3)),
        with(&|bytes| bytes[complete.len() / 3..].fill(0)),
        with(&|bytes| bytes[9000] ^= 4),
        with(&|bytes| bytes.extend([1; 100])),
    ];
    for bytes in cases {
        std::fs::write(&path, bytes).expect("written");
        std::fs::remove_file(here.path().join("map.csv")).expect("removed");
        map(here.path(), line).answered();
        assert!(table() == wanted && std::fs::read(&path).expect("rows") == complete);
    }
    // A manifest that is cut off says nothing of the rows; another file of that name is not replaced.
    let manifest = here.path().join("rows/manifest.json");
    let whole = std::fs::read_to_string(&manifest).expect("a manifest");
    for length in [0, whole.len() / 2] {
        std::fs::write(&manifest, &whole[..length]).expect("written");
        map(here.path(), line).answered();
        assert!(table() == wanted && std::fs::read(&path).expect("rows") == complete);
        assert!(std::fs::read_to_string(&manifest).expect("a manifest") == whole);
    }
    std::fs::write(&manifest, "{ \"of\": [1, 2").expect("written");
    let said = map(here.path(), line);
    assert!(
        said.code == 1 && said.err.contains("this is no manifest of a map"),
        "{said:?}"
    );
    std::fs::write(&manifest, &whole).expect("written");
    let other = line.replace("--tool-length-mm 30", "--tool-length-mm 31");
    let said = map(here.path(), &other);
    assert!(
        said.code == 1 && said.err.contains("tool_length_mm is 30.0 there"),
        "{said:?}"
    );
}
