//! One source for every figure: each number with a unit, in a report and on the terminal, is a value of
//! the JSON as the formatter writes it.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::*;
use kinetostat_machining::number::{
    Rounding, fixed, largest, largest_angle, largest_length, least, least_length, length_setting,
    mean_length, setting, share, significant, with_unit,
};
use serde_json::Value;

const UNITS: [&str; 9] = ["mm", "um", "deg", "N", "N/mm", "1/s", "%", "kg", "m"];

/// Every way in which the formatter may write a value.
fn ways(value: f64, allowed: &mut BTreeSet<String>) {
    for text in [
        largest_length(value),
        least_length(value),
        mean_length(value),
        length_setting(value),
        largest_angle(value),
        share(value),
        with_unit(&significant(value, 5, Rounding::Nearest), "mm"),
        with_unit(&fixed(100.0 * value, 0), "%"),
        with_unit(&fixed(value, 3), "mm"),
    ] {
        allowed.insert(text);
    }
    for unit in UNITS {
        allowed.insert(largest(value, unit));
        allowed.insert(least(value, unit));
        allowed.insert(with_unit(&setting(value), unit));
    }
}

/// Values and words of a part of the JSON.
fn collect(part: &Value, allowed: &mut BTreeSet<String>) {
    match part {
        Value::Number(n) => ways(n.as_f64().expect("a number"), allowed),
        Value::String(text) => allowed.extend(with_units(text)),
        Value::Array(list) => {
            list.iter().for_each(|v| collect(v, allowed));
            let vector: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
            if let [x, y, z] = vector[..] {
                ways(x.hypot(y).hypot(z), allowed);
            }
        }
        Value::Object(map) => map.values().for_each(|v| collect(v, allowed)),
        _ => {}
    }
}

/// Numbers that a unit follows, as `number unit`.
fn with_units(text: &str) -> Vec<String> {
    let trim = |word: &str| -> String {
        let ends = |c: char| "()[],;:.'".contains(c);
        word.trim_start_matches(ends)
            .trim_end_matches(ends)
            .to_owned()
    };
    let words: Vec<String> = text.split_whitespace().map(trim).collect();
    let mut found = Vec::new();
    for pair in words.windows(2) {
        let number = pair[0].parse::<f64>().is_ok_and(f64::is_finite);
        if number && UNITS.contains(&pair[1].as_str()) {
            found.push(format!("{} {}", pair[0], pair[1]));
        }
    }
    found
}

/// What a reader of a page sees, without the ticks of axes and the bar of the scale, as plain text.
fn text_of(page: &str) -> String {
    let mut rest = page.split_once("</style>").map_or(page, |(_, body)| body);
    let mut out = String::new();
    while let Some((before, after)) = rest.split_once('<') {
        out.push_str(before);
        let (tag, after) = after.split_once('>').expect("a tag ends");
        if !["b", "/b", "em", "/em"].contains(&tag) {
            out.push_str("\n ");
        }
        let skipped = tag.contains("class=\"tick\"") || after.starts_with("this long:");
        rest = match after.split_once('<') {
            Some((_, next)) if skipped => &after[after.len() - next.len() - 1..],
            _ => after,
        };
    }
    out.push_str(rest);
    // Set in type: thousands apart, true minus, micrometres.
    let chars: Vec<char> = out.chars().collect();
    let mut plain = String::new();
    for (i, c) in chars.iter().enumerate() {
        let digit = |at: Option<&char>| at.is_some_and(char::is_ascii_digit);
        match c {
            '\u{202f}' if digit(chars.get(i + 1)) && i > 0 && digit(chars.get(i - 1)) => {}
            '\u{202f}' => plain.push(' '),
            '\u{2212}' => plain.push('-'),
            'µ' => plain.push('u'),
            c => plain.push(*c),
        }
    }
    plain
        .replace("&#x2f;", "/")
        .replace("&#x27;", "'")
        .replace("&quot;", "\"")
}

/// Fails unless everything stated is in the JSON; says how many numbers were compared.
fn compare(what: &str, shown: &str, json: &Value) -> usize {
    let mut allowed = BTreeSet::new();
    for (name, part) in json.as_object().expect("an object") {
        // The points of the plots are not stated one by one.
        if name != "points" {
            collect(part, &mut allowed);
        }
    }
    // What the report sums up: the error that a written program may have.
    let number = |group: &str, name: &str| json[group][name].as_f64().unwrap_or(0.0);
    let chords = match number("summary", "feed_arcs") > 0.0 {
        true => number("question", "chord_tolerance_mm"),
        false => 0.0,
    };
    let sum =
        number("question", "tolerance_mm") + chords + number("summary", "max_rounding_error_mm");
    ways(sum, &mut allowed);
    allowed.insert("100 %".to_owned());
    allowed.insert("0 %".to_owned());
    let found = with_units(shown);
    for text in &found {
        assert!(
            allowed.contains(text),
            "{what}: {text:?} is no value of the JSON"
        );
    }
    found.len()
}

/// Runs a line, and compares terminal and report with the JSON.
fn run_and_compare(here: &Path, line: &str) -> Value {
    let words: Vec<&str> = line.split(' ').collect();
    let said = run(here, &words).answered();
    let read = |name: &str| std::fs::read_to_string(here.join(name)).expect(name);
    let json: Value = serde_json::from_str(&read("r.json")).expect("JSON");
    let terminal = said.out.split("\nWritten\n").next().unwrap_or_default();
    let count = compare(&format!("{line}: terminal"), terminal, &json);
    assert!(count >= 8, "{line}: {count} numbers on the terminal");
    let report = text_of(&read("r.html"));
    let count = compare(&format!("{line}: report"), &report, &json);
    assert!(count >= 12, "{line}: {count} numbers in the report");
    json
}

#[test]
fn the_demo_and_a_run_with_a_table_state_values_of_their_json() {
    let here = workplace();
    let read = |name: &str| std::fs::read_to_string(here.path().join(name)).expect(name);
    let terminal = |said: &Said, after: &str| {
        let shown = said.out.split("\nWritten\n").next().unwrap_or_default();
        let (_, figures) = shown.split_once(after).expect("figures");
        figures.to_owned()
    };
    let said = run(here.path(), &["demo"]).answered();
    let json: Value = serde_json::from_str(&read("kinetostat-demo/result.json")).expect("JSON");
    // Above that line the demo tells its story.
    let count = compare("demo: terminal", &terminal(&said, "original.ngc on"), &json);
    assert!(count >= 20, "{count} numbers on the terminal");
    let report = text_of(&read("kinetostat-demo/report.html"));
    let count = compare("demo: report", &report, &json);
    assert!(count >= 20, "{count} numbers in the report");
    points_hold_the_extremes(&json);

    let mut table = String::from("x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n");
    for (x, y, z) in (0..8).map(|i| (i % 2, i / 2 % 2, i / 4)) {
        let place = [x, y, z].map(|k| 200 * k - 100);
        table.push_str(&format!(
            "{},{},{},{},0.002,0\n",
            place[0],
            place[1],
            place[2],
            0.013 * f64::from(x)
        ));
    }
    std::fs::write(here.path().join("map.csv"), table).expect("a table");
    let line = "compensate --map map.csv --program part.ngc --out m.ngc --json m.json";
    let words: Vec<&str> = line.split(' ').collect();
    let said = run(here.path(), &words).answered();
    let json: Value = serde_json::from_str(&read("m.json")).expect("JSON");
    let count = compare(line, &terminal(&said, "corrected by the table"), &json);
    assert!(count >= 8, "{count} numbers on the terminal");
}

/// The table of `map` has its units in the first column.
#[test]
fn every_number_of_a_map_is_in_its_json() {
    let here = workplace();
    for line in [
        "map orthoglide --x -40 40 5 --y -20 20 3 --force 100 -20 30 --json",
        "map orthoglide --x -40 40 5 --z -20 20 3 --json",
        "map heavy_6r --x 1000 1400 3 --z 800 1000 2 --force 0 0 -500 --json",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words).answered();
        let json: Value = serde_json::from_str(&said.out).expect("JSON");
        let figures = json["figures"].as_array().expect("figures");
        let mut allowed: BTreeSet<String> = BTreeSet::new();
        let mut add = |value: f64| {
            for digits in 3..=5 {
                allowed.insert(significant(value, digits, Rounding::Nearest));
            }
            allowed.extend([fixed(value, 1), setting(value)]);
        };
        for figure in figures {
            for part in [
                &figure["mean"],
                &figure["least"]["value"],
                &figure["most"]["value"],
            ] {
                add(part.as_f64().expect("a number"));
            }
            for end in ["least", "most"] {
                for x in figure[end]["position_mm"].as_array().expect("a place") {
                    add(x.as_f64().expect("mm"));
                }
            }
        }
        let table = said.err.split("\n\n").find(|part| part.contains("least"));
        let mut rows = 0;
        for row in table.expect("a table").lines().skip(1) {
            let (_, numbers) = row.split_once("  ").expect("columns");
            let (_, numbers) = numbers
                .trim()
                .split_once("  ")
                .map_or(("", numbers), |(a, b)| (a, b));
            for word in numbers
                .split([' ', ',', '(', ')'])
                .filter(|w| w.parse::<f64>().is_ok())
            {
                assert!(allowed.contains(word), "{line}: {word:?} in {row:?}");
            }
            rows += 1;
        }
        assert_eq!(rows, figures.len(), "{}", said.err);
        let places = json["places"]["asked"].as_u64().expect("a count");
        assert!(
            said.err.contains(&format!("{places} places")),
            "{}",
            said.err
        );
    }
}

fn size(vector: &Value) -> f64 {
    let parts = vector.as_array().expect("a vector").iter();
    parts
        .map(|x| x.as_f64().expect("a number").powi(2))
        .sum::<f64>()
        .sqrt()
}

/// The points of a result hold what its summary states.
fn points_hold_the_extremes(json: &Value) {
    let points = json["points"].as_array().expect("points");
    let cutting = || points.iter().filter(|p| p["kind"] != "rapid");
    assert!(cutting().count() > 0);
    for (of, name) in [
        ("error_before_mm", "max_position_error_before_mm"),
        ("error_after_mm", "max_position_error_after_mm"),
    ] {
        let most = kinetostat_testing::largest(cutting().map(|p| size(&p[of])));
        let stated = json["summary"][name].as_f64().expect("a number");
        assert!(
            (most - stated).abs() <= 1e-12 * stated,
            "{name}: {most} {stated}"
        );
    }
}

const SQUARE: &str =
    "G21 G90 G17\nG0 X20 Y0 Z5\nG1 Z-1 F300\nG1 X60 F600\nG1 Y40\nG1 X20\nG1 Y0\nG0 Z5\nM2\n";

#[test]
fn every_number_of_a_report_and_of_the_terminal_is_in_the_json() {
    let here = workplace();
    std::fs::write(here.path().join("square.ngc"), SQUARE).unwrap();
    let outputs = "--report r.html --json r.json --force-overwrite";
    let place = "--part-origin-mm 0 0 100 --tool-length-mm 100";
    let arm = "--model heavy_6r --weight all --part-origin-mm 1050 0 1000 --tool-length-mm 150";
    let milling = "--milling 215 -10 -25";
    for line in [
        format!("compensate job.toml {outputs}"),
        format!(
            "compensate --model orthoglide --program square.ngc {place} {milling} -o s.ngc {outputs}"
        ),
        format!("deflect orthoglide --program square.ngc {place} {milling} {outputs}"),
        format!("deflect orthoglide --program part.ngc {place} {outputs}"),
        format!("compensate {arm} --program square.ngc {milling} -o a.ngc {outputs}"),
    ] {
        let json = run_and_compare(here.path(), &line);
        points_hold_the_extremes(&json);
    }
}

#[test]
fn deflect_and_compensate_state_one_error_before() {
    let here = workplace();
    std::fs::write(here.path().join("square.ngc"), SQUARE).unwrap();
    for program in ["part.ngc", "square.ngc"] {
        let common = format!(
            "--program {program} --part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 -25 --force-overwrite"
        );
        let summary = |line: String| -> Value {
            let words: Vec<&str> = line.split(' ').collect();
            run(here.path(), &words).answered();
            let text = std::fs::read_to_string(here.path().join("r.json")).unwrap();
            let json: Value = serde_json::from_str(&text).unwrap();
            json["summary"].clone()
        };
        let one = summary(format!("deflect orthoglide {common} --json r.json"));
        let other = summary(format!(
            "compensate --model orthoglide {common} -o c.ngc --json r.json"
        ));
        for name in [
            "rms_position_error_before_mm",
            "max_position_error_before_mm",
        ] {
            let (a, b) = (one[name].as_f64().unwrap(), other[name].as_f64().unwrap());
            assert!((a - b).abs() < 5e-3 * a, "{program} {name}: {a} and {b}");
        }
    }
}

#[test]
fn a_report_states_the_day_and_the_files() {
    let here = workplace();
    let line = [
        "compensate",
        "job.toml",
        "--report",
        "r.html",
        "--json",
        "r.json",
        "--points",
        "p.csv",
    ];
    run(here.path(), &line).answered();
    let page = text_of(&std::fs::read_to_string(here.path().join("r.html")).unwrap());
    let text = std::fs::read_to_string(here.path().join("r.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["question"]["date"], "2023-11-14");
    assert!(page.contains("2023-11-14"));
    let files = json["question"]["files"].as_array().unwrap();
    assert_eq!(files.len(), 3);
    for file in files {
        let (name, hash) = (
            file["name"].as_str().unwrap(),
            file["sha256"].as_str().unwrap(),
        );
        assert_eq!(hash.len(), 64);
        assert!(page.contains(name) && page.contains(hash), "{name}");
    }
    for text in json["question"]["stiffnesses"].as_array().unwrap() {
        assert!(page.contains(text.as_str().unwrap()), "{text}");
    }
    // The same run on the same day gives the same bytes; without a day none is stated.
    let mut without = command(here.path());
    let none = without
        .args(line)
        .arg("--force-overwrite")
        .env("SOURCE_DATE_EPOCH", "");
    assert_eq!(none.output().unwrap().status.code(), Some(4));
    let text = std::fs::read_to_string(here.path().join("r.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    assert!(json["question"]["date"].is_null());
    // The table: one word for a name, one unit in it, joint values.
    let table = std::fs::read_to_string(here.path().join("p.csv")).unwrap();
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    assert!(header.iter().all(|name| !name.contains(' ')), "{header:?}");
    assert!(header.contains(&"leg_x.slider_command_mm"), "{header:?}");
    assert!(header.contains(&"leg_x.slider_force_n"), "{header:?}");
    let distinct: BTreeSet<&&str> = header.iter().collect();
    assert_eq!(distinct.len(), header.len());
    for row in table.lines().skip(1) {
        assert_eq!(row.split(',').count(), header.len(), "{row}");
        let numbers = row.split(',').filter(|cell| cell.parse::<f64>().is_ok());
        assert!(numbers.map(str::len).all(|digits| digits <= 13), "{row}");
    }
}
