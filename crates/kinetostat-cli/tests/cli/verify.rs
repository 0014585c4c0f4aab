//! `verify`: programs of a part against the one that they were made from, whoever compensated them.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use kinetostat_testing::Worst;
use serde_json::Value;

use crate::common::{run, workplace};

/// Lines with corners, an arc, and a second cut behind a rapid, off the axes of the machine.
pub(crate) const PART: &str = "G21 G90\nG0 X-12 Y-9 Z5\nG0 Z0\nG1 X21 Y-4 F600\nG1 X25 Y13\nG3 X7 Y29 I-13.8 J2.6\nG1 X-11 Y17 Z-1\nG1 X-12 Y-9\nG0 Z5\nG0 X30 Y-20\nG0 Z-1\nG1 X31 Y20\nG0 Z5\nM2\n";

pub(crate) const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [3, -2, 97]\n[tool]\nlength_mm = 100\n[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n";

pub(crate) fn part() -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("part.ngc"), PART).unwrap();
    std::fs::write(here.path().join("job.toml"), JOB).unwrap();
    here
}

/// What `verify` answers of a program, with its exit code.
pub(crate) fn verified(here: &Path, program: &str, more: &[&str]) -> (i32, Value, String) {
    let words = ["verify", program, "--job", "job.toml", "--json"];
    let output = run(here, &[&words[..], more].concat());
    let value = serde_json::from_str(&output.out).unwrap_or(Value::Null);
    (output.code, value, output.err)
}

pub(crate) fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or(f64::NAN)
}

/// The job compensated to `out.ngc` with one of these exit codes, and its result; what it said.
fn compensated_with(here: &Path, codes: &[i32], more: &[&str]) -> (Value, String) {
    let words = [
        "compensate",
        "job.toml",
        "--out",
        "out.ngc",
        "--json",
        "out.json",
    ];
    let output = run(here, &[&words[..], more].concat());
    assert!(codes.contains(&output.code), "{output:?}");
    let text = std::fs::read_to_string(here.join("out.json")).unwrap();
    (serde_json::from_str(&text).unwrap(), output.err)
}

pub(crate) fn compensated(here: &Path, more: &[&str]) -> Value {
    compensated_with(here, &[0, 4], more).0
}

#[test]
fn an_own_program_has_the_error_that_its_compensation_claims() {
    for more in [&[][..], &["--arcs", "lines"], &["--tolerance-um", "3"]] {
        let here = part();
        let result = compensated(here.path(), more);
        let claimed = &result["summary"];
        let (code, found, text) = verified(here.path(), "out.ngc", &[]);
        let of = |name: &str| number(claimed, name);
        let after = number(&found, "max_position_error_mm");
        let claim = of("max_position_error_after_mm");
        // Other places are looked at, and the tolerance of the default is the machine's.
        assert!(
            after > 0.5 * claim && after < 1.3 * claim + 1e-4,
            "{more:?}: {after} {claim}"
        );
        let mut same = Worst::new();
        same.add(
            number(&found, "max_position_error_of_original_mm")
                - of("max_position_error_before_mm"),
        );
        // The largest is where the writer divided a block: 0.002 mm a millimetre, at places that the file's digits state to
        // 0.05 um.
        assert!(same.holds(1e-7), "{same}");
        // One verdict: it rests on the same assumptions, and costs as much where they fail.
        let is_missed = after > number(&found, "allowed_mm");
        assert_eq!(code, if is_missed { 3 } else { 4 }, "{text}");
        let of_run = &result["assessment"]["max_error_um"];
        let (own, of_run) = (
            &found["assessment"]["max_error_um"],
            of_run.as_f64().unwrap(),
        );
        let own = own.as_f64().unwrap();
        assert!((own - of_run).abs() < 0.05 * of_run, "{own} {of_run}");
        assert_eq!(found["matched"]["uncut"], serde_json::json!([]));
        assert!(
            number(&found["matched"], "largest_distance_mm") < 5e-3,
            "{text}"
        );
    }
}

#[test]
fn the_original_is_as_far_off_as_deflect_says() {
    let here = part();
    let (code, found, text) = verified(here.path(), "part.ngc", &["--tolerance-um", "2"]);
    assert_eq!(code, 3, "{text}");
    assert!(text.contains("THE TOLERANCE IS MISSED at line"), "{text}");
    let output = run(here.path(), &["deflect", "job.toml", "--json"]);
    let deflected: Value = serde_json::from_str(&output.out).unwrap();
    // The moves of both are one: so are the figures, at corners, too, but for the places at which they are looked at.
    for [of_verify, of_deflect] in [
        ["max_position_error_mm", "max_position_error_before_mm"],
        [
            "max_position_error_of_original_mm",
            "max_position_error_before_mm",
        ],
    ] {
        let off = number(&deflected["summary"], of_deflect);
        let mut same = Worst::new();
        same.add(number(&found, of_verify) - off);
        assert!(off > 0.5 && same.holds(1e-5), "{same} of {off}");
    }
}

#[test]
fn what_is_wrong_in_a_program_of_others_is_found_where_it_is() {
    let here = part();
    compensated(here.path(), &["--arcs", "lines", "--no-header"]);
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    // The end of the last block of the contour, 40 um too high.
    let index = lines
        .iter()
        .rposition(|line| line.contains(" Z-0.") && line.contains('X'))
        .unwrap();
    let z_at = lines[index].find(" Z").unwrap() + 2;
    let end = lines[index][z_at..]
        .find(' ')
        .map_or(lines[index].len(), |more| z_at + more);
    let z: f64 = lines[index][z_at..end].parse().unwrap();
    let spoiled = format!(
        "{}{:.4}{}",
        &lines[index][..z_at],
        z + 0.04,
        &lines[index][end..]
    );
    let mut all = lines.clone();
    all[index] = &spoiled;
    std::fs::write(here.path().join("other.ngc"), all.join("\n") + "\n").unwrap();
    let (code, found, said) = verified(here.path(), "other.ngc", &["--tolerance-um", "10"]);
    assert_eq!(code, 3, "{said}");
    let mut off = Worst::new();
    off.add(number(&found, "max_position_error_mm") - 0.04);
    assert!(off.holds(2e-3), "{off}");
    assert_eq!(found["missed"]["output_line"], index + 1, "{said}");
    assert_eq!(found["missed"]["line"], 8, "{said}");
    // Without its second cut.
    let kept = PART.replace("G1 X31 Y20\n", "");
    std::fs::write(here.path().join("short.ngc"), kept).unwrap();
    let (code, found, said) = verified(here.path(), "short.ngc", &["--tolerance-um", "5000"]);
    assert_eq!(code, 3, "{said}");
    assert_eq!(
        found["matched"]["uncut"][0]["lines"],
        serde_json::json!([12, 12]),
        "{said}"
    );
    assert!(
        said.contains("LINE 12 OF THE ORIGINAL IS NOT CUT"),
        "{said}"
    );
    // One block goes elsewhere altogether.
    std::fs::write(
        here.path().join("away.ngc"),
        PART.replace("X31 Y20", "X31 Y60"),
    )
    .unwrap();
    let (code, found, said) = verified(here.path(), "away.ngc", &["--tolerance-um", "5000"]);
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains("LINE 12 IS A MOVE AT FEED THAT THE ORIGINAL DOES NOT MAKE")
            && said.contains("LINE 12 OF THE ORIGINAL IS NOT CUT"),
        "{said}"
    );
    let length = number(&found["matched"]["extra_cuts"][0], "length_mm");
    assert!((80.0..80.1).contains(&length), "{said}");
    // All of it.
    let shifted = |word: &str| match word.strip_prefix('X') {
        Some(x) => format!("X{}", x.parse::<i32>().unwrap() + 100),
        None => word.to_owned(),
    };
    let lines = PART.lines().map(|line| {
        let words: Vec<String> = line.split(' ').map(shifted).collect();
        words.join(" ") + "\n"
    });
    std::fs::write(here.path().join("away.ngc"), lines.collect::<String>()).unwrap();
    let (code, _, said) = verified(here.path(), "away.ngc", &[]);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("away.ngc: line ") && said.contains("mm the program is"),
        "{said}"
    );
}

#[test]
fn features_have_verdicts_of_their_own() {
    let here = part();
    let features = "[[features]]\nname = \"contour\"\nlines = [4, 8]\ntolerance_um = 20\n[[features]]\nname = \"slot\"\nlines = [12, 12]\ntolerance_um = 0.01\n[[features]]\nname = \"nothing\"\nlines = [9, 10]\n";
    std::fs::write(here.path().join("job.toml"), format!("{JOB}{features}")).unwrap();
    let (of_compensate, said) = compensated_with(here.path(), &[3], &[]);
    assert!(
        said.contains("THE TOLERANCE OF slot IS MISSED at line"),
        "{said}"
    );
    let (code, of_verify, said) = verified(here.path(), "out.ngc", &[]);
    assert_eq!(code, 3, "{said}");
    for result in [&of_compensate, &of_verify] {
        let held: Vec<&Value> = (0..3).map(|i| &result["features"][i]["held"]).collect();
        assert_eq!(
            held,
            [&Value::Bool(true), &Value::Bool(false), &Value::Null]
        );
    }
    // Refused in words, at their line.
    for (wrong, said) in [
        ("lines = [8, 4]\n", "lines 8 to 4"),
        ("lines = [0, 4]\n", "counted from 1"),
        (
            "lines = [4, 8]\ntolerance_um = -1\n",
            "0.001 to 10000 micrometres",
        ),
    ] {
        let job = format!("{JOB}[[features]]\nname = \"contour\"\n{wrong}");
        std::fs::write(here.path().join("job.toml"), job).unwrap();
        let (code, _, text) = verified(here.path(), "out.ngc", &[]);
        assert_eq!(code, 1, "{text}");
        assert!(text.contains(said) && text.contains("job.toml:"), "{text}");
    }
}

#[test]
fn a_feature_that_is_not_cut_is_not_kept() {
    let here = part();
    let features = "[[features]]\nname = \"contour\"\nlines = [4, 8]\n[[features]]\nname = \"slot\"\nlines = [12, 12]\n[[features]]\nname = \"way\"\nlines = [9, 10]\n[[features]]\nname = \"corner\"\nlines = [8, 8]\n";
    std::fs::write(here.path().join("job.toml"), format!("{JOB}{features}")).unwrap();
    let held = |found: &Value| -> Vec<Value> {
        let all = found["features"].as_array().cloned().unwrap_or_default();
        all.iter().map(|feature| feature["held"].clone()).collect()
    };
    // Without the slot, and without the end of the contour.
    for (left_out, wanted, lines) in [
        (
            "G1 X31 Y20\n",
            "[true,false,null,true]",
            "line 12 of the original",
        ),
        (
            "G1 X-12 Y-9\nG0 Z5\n",
            "[false,true,null,false]",
            "line 8 of the original",
        ),
    ] {
        let other = PART.replace(left_out, "");
        assert_ne!(other, PART);
        std::fs::write(here.path().join("other.ngc"), other).unwrap();
        let (code, found, said) = verified(here.path(), "other.ngc", &["--tolerance-um", "5000"]);
        assert_eq!(code, 3, "{said}");
        assert_eq!(Value::from(held(&found)).to_string(), wanted, "{said}");
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains(&format!("IS NOT CUT by this program at {lines}.")),
            "{said}"
        );
    }
}

#[test]
fn a_feature_beyond_the_end_of_the_program_is_refused() {
    let here = part();
    compensated(here.path(), &[]);
    let feature = "[[features]]\nname = \"pocket\"\nlines = [12, 15]\n";
    std::fs::write(here.path().join("job.toml"), format!("{JOB}{feature}")).unwrap();
    let commands: [&[&str]; 4] = [
        &["verify", "out.ngc", "--job", "job.toml"],
        &["compensate", "job.toml", "--force-overwrite"],
        &[
            "compensate",
            "job.toml",
            "--force-overwrite",
            "--part-lines",
            "5",
        ],
        &["deflect", "job.toml"],
    ];
    for words in commands {
        let output = run(here.path(), words);
        assert_eq!(output.code, 1, "{words:?}: {output:?}");
        assert!(output.err.contains("job.toml:12:"), "{words:?}: {output:?}");
        let said = output.err.split_whitespace().collect::<Vec<_>>().join(" ");
        let what = "the feature 'pocket' has the lines 12 to 15, and the program 'part.ngc' ends with line 14";
        assert!(said.contains(what), "{words:?}: {said}");
    }
    // The last line is there, with and without its ending.
    let job = format!("{JOB}{feature}").replace("[12, 15]", "[12, 14]");
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    for program in [PART, PART.trim_end()] {
        std::fs::write(here.path().join("part.ngc"), program).unwrap();
        compensated(here.path(), &["--force-overwrite"]);
    }
}

/// A program of others, made of the compensated one by changing lines, and what `verify` says of it on one line.
pub(crate) fn changed(here: &Path, change: impl Fn(&str) -> String) -> (i32, Value, String) {
    let text = std::fs::read_to_string(here.join("out.ngc")).unwrap();
    let other = change(&text);
    assert_ne!(other, text);
    std::fs::write(here.join("other.ngc"), other).unwrap();
    let (code, found, said) = verified(here, "other.ngc", &["--tolerance-um", "10"]);
    (
        code,
        found,
        said.split_whitespace().collect::<Vec<_>>().join(" "),
    )
}

/// The text without one of its lines, which count from one.
pub(crate) fn without_line(text: &str, line: usize) -> String {
    let lines = text.lines().enumerate();
    let kept = lines.filter(|(index, _)| index + 1 != line);
    kept.map(|(_, line)| format!("{line}\n")).collect()
}

pub(crate) fn line_of(text: &str, is: impl Fn(&str) -> bool) -> usize {
    1 + text.lines().position(is).unwrap()
}

/// A freehand line of short blocks, whose directions and lengths are not known to follow any rule.
fn freehand(directions: &mut impl FnMut() -> [f64; 2]) -> String {
    let [mut x, mut y, mut heading] = [0.0_f64; 3];
    let mut text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F600\n".to_owned();
    for _ in 0..120 {
        let [turn, length] = directions();
        heading += 0.2 * turn - 0.1;
        let length = [0.05, 0.2, 0.5][(3.0 * length) as usize];
        x += length * heading.cos();
        y += length * heading.sin();
        if x.hypot(y) > 30.0 {
            heading += std::f64::consts::FRAC_PI_2;
        }
        text.push_str(&format!("G1 X{x:.4} Y{y:.4}\n"));
    }
    text + "G0 Z5\nM2\n"
}

/// On blocks shorter than the corrections turn, a compensated path is much shorter than the cut, and goes back upon itself: places of it
/// are not given to the next corner of the original because that is near along the compensated path.
#[test]
fn own_programs_of_short_irregular_blocks_are_verified() {
    let mut seed = 3_u64;
    let mut even = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..8 {
        let here = part();
        let text = freehand(&mut || [even(), even()]);
        std::fs::write(here.path().join("part.ngc"), text).unwrap();
        let claimed = number(
            &compensated(here.path(), &[])["summary"],
            "max_position_error_after_mm",
        );
        let (code, found, said) = verified(here.path(), "out.ngc", &[]);
        assert!(matches!(code, 0 | 4), "{said}");
        let off = number(&found, "max_position_error_mm");
        assert!(off <= 1.001 * claimed, "{off} {claimed}");
    }
}

#[test]
fn rapids_are_those_of_the_original() {
    let here = part();
    compensated(here.path(), &["--no-header"]);
    // The tool is not lifted before the second cut: the rapid goes through the part.
    let (code, found, said) = changed(here.path(), |text| {
        without_line(text, line_of(text, |line| line.starts_with("G0 Z5")))
    });
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("THE RAPID AT LINE"), "{said}");
    assert!(
        said.contains("(line 9 there)") || said.contains("(line 10 there)"),
        "{said}"
    );
    let off = number(&found["matched"]["rapids"][0], "distance_mm");
    assert!((5.0..7.0).contains(&off), "{said}");
    // A cut that has become a rapid is not cut.
    let (code, _, said) = changed(here.path(), |text| {
        let (contour, slot) = text.split_at(text.rfind("G0 Z-1").unwrap());
        format!("{contour}{}", slot.replace("G1 ", "G0 "))
    });
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("NOT CUT"), "{said}");
    // Nor is a piece of it, be it a step at a corner.
    let pieces = |text: &str| {
        let lines = text.lines().collect::<Vec<_>>();
        let both = lines.windows(2).enumerate();
        let inside = both.filter(|(_, w)| w.iter().all(|line| line.starts_with("G1 X")));
        inside.map(|(index, _)| index).collect::<Vec<usize>>()
    };
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let pieces = pieces(&text);
    assert!(pieces.len() > 5, "{text}");
    for piece in pieces {
        let (code, _, said) = changed(here.path(), |text| {
            let lines = text.lines().enumerate();
            let quick = |(index, line): (usize, &str)| match index == piece {
                true => format!("{}\n", line.replace("G1 ", "G0 ")),
                false => format!("{line}\n"),
            };
            lines.map(quick).collect()
        });
        let line = piece + 1;
        assert_eq!(code, 3, "line {line}: {said}");
        let is_named = said.contains("NOT CUT") || said.contains(&format!("RAPID AT LINE {line} "));
        assert!(is_named, "line {line}: {said}");
    }
    // A lift at feed cuts nothing.
    let (code, found, said) = changed(here.path(), |text| {
        let lift = line_of(text, |line| line.starts_with("G0 Z5"));
        let lines = text.lines().enumerate();
        let slow = |(index, line): (usize, &str)| match index + 1 == lift {
            true => "G1 Z5\n".to_owned(),
            false => format!("{line}\n"),
        };
        lines.map(slow).collect()
    });
    assert!(matches!(code, 0 | 4), "{said} {found}");
}

#[test]
fn one_wrong_block_is_its_own_fault_and_that_of_no_other_feature() {
    let here = part();
    let features = "[[features]]\nname = \"contour\"\nlines = [4, 8]\n[[features]]\nname = \"slot\"\nlines = [12, 12]\n";
    std::fs::write(here.path().join("job.toml"), format!("{JOB}{features}")).unwrap();
    compensated(here.path(), &["--no-header"]);
    // A spike of 3 mm behind the first piece of the slot.
    let (code, found, said) = changed(here.path(), |text| {
        let begins = line_of(text, |line| line.contains("X30") && line.starts_with("G0"));
        let at = begins + 4;
        let lines = text.lines().enumerate();
        let spike = |(index, line): (usize, &str)| match index + 1 == at {
            true => format!("{line}\nG91\nG1 X3\nX-3\nG90\n"),
            false => format!("{line}\n"),
        };
        lines.map(spike).collect()
    });
    assert_eq!(code, 3, "{said}");
    let held = [0, 1].map(|index| found["features"][index]["held"].clone());
    assert_eq!(held, [Value::Bool(true), Value::Bool(false)], "{said}");
    let off = number(&found, "max_position_error_mm");
    assert!((2.9..3.1).contains(&off), "{said}");
}

#[test]
fn rows_that_are_left_out_are_named() {
    let here = part();
    let row = |k: i32| {
        let (from, to) = if k % 2 == 0 { (0, 40) } else { (40, 0) };
        format!("G1 X{from} Y{}\nX{to}\n", 4 * k)
    };
    let rows = |left_out: &[i32]| -> String {
        let kept = (0..6).filter(|k| !left_out.contains(k));
        let rows: String = kept.map(row).collect();
        format!("G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F600\n{rows}G0 Z5\nM2\n")
    };
    std::fs::write(here.path().join("part.ngc"), rows(&[])).unwrap();
    std::fs::write(here.path().join("other.ngc"), rows(&[2, 3])).unwrap();
    let (code, found, said) = verified(here.path(), "other.ngc", &["--tolerance-um", "2000"]);
    assert_eq!(code, 3, "{said}");
    let uncut = &found["matched"]["uncut"];
    assert_eq!(uncut.as_array().map(Vec::len), Some(1), "{said}");
    let length = number(&uncut[0], "length_mm");
    assert!((90.0..100.0).contains(&length), "{uncut}");
    let [first, last] = [0, 1].map(|k| uncut[0]["lines"][k].as_u64().unwrap());
    assert!(
        (7..=9).contains(&first) && (11..=13).contains(&last),
        "{uncut}"
    );
    // Nothing is said of forty millimetres.
    assert!(number(&found, "max_position_error_mm") < 2.0, "{said}");
}

#[test]
fn an_end_beside_the_end_of_a_cut_belongs_to_that_cut() {
    let here = workplace();
    // Pecks of a hole, and a slot elsewhere: where one cut ends another begins at the same length along all cuts.
    let text = "G21 G90\nG0 X0 Y0 Z10\nG0 Z2\nG1 Z-1 F100\nG0 Z2\nG0 Z-0.7\nG1 Z-2\nG0 Z2\nG0 Z-1.7\nG1 Z-3\nG0 Z10\nG0 X20 Y15\nG0 Z1\nG1 Z-2 F300\nG1 X28\nG0 Z10\nM2\n";
    std::fs::write(here.path().join("part.ngc"), text).unwrap();
    std::fs::write(
        here.path().join("job.toml"),
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [1400, 70, 500]\n[tool]\nlength_mm = 200\n[load]\nweight = \"all\"\nmilling = { radial_n = 415, tangential_n = -100, axial_n = -125 }\n",
    )
    .unwrap();
    let (code, found, said) = verified(here.path(), "part.ngc", &["--tolerance-um", "6000"]);
    assert!(matches!(code, 0 | 4), "{said}");
    let off = number(&found, "max_position_error_mm");
    assert!((0.5..3.0).contains(&off), "{said}");
}

#[test]
fn a_program_of_remarks_is_its_own_fault() {
    let here = part();
    std::fs::write(here.path().join("remarks.ngc"), "(nothing)\nG21 G90\nM2\n").unwrap();
    let (code, _, said) = verified(here.path(), "remarks.ngc", &[]);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("remarks.ngc: the program has no move at feed"),
        "{said}"
    );
}

#[test]
fn the_tilt_is_said_and_what_is_refused_is_not_offered() {
    let here = part();
    let said = run(here.path(), &["verify", "part.ngc", "--job", "job.toml"]);
    assert!(said.out.contains("tool tilt that stays"), "{said:?}");
    for (command, refused) in [
        ("verify", "--report"),
        ("place", "--points"),
        ("place", "--free-turn"),
    ] {
        let help = run(here.path(), &[command, "--help"]).answered();
        assert!(!help.out.contains(refused), "{command}: {refused}");
    }
}

#[test]
fn a_robots_program_is_verified_with_its_orientation() {
    let here = workplace();
    let head = "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,speed_mm_per_s\n";
    let row = |k: u32| {
        let s = f64::from(k) / 12.0;
        format!(
            "{:.3},{:.3},{:.3},{:.3},{:.3},{:.3},20\n",
            300.0 * s - 150.0,
            40.0 * s * s,
            10.0 * s,
            5.0 * s,
            3.0 * s,
            -4.0 * s
        )
    };
    let rows: String = (0..=12).map(row).collect();
    std::fs::write(here.path().join("part.csv"), format!("{head}{rows}")).unwrap();
    std::fs::write(
        here.path().join("job.toml"),
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.csv\"\n[load]\nweight = \"all\"\nmilling = { radial_n = 0, tangential_n = -20, axial_n = -100 }\n[robot]\ncorrect = \"pose\"\ntool_axis = \"z\"\n[robot.frames]\ntool = { position_mm = [0, 0, 180], roll_pitch_yaw_urdf_deg = [180, 0, 0] }\npart = { position_mm = [2000, 0, 1300], roll_pitch_yaw_urdf_deg = [0, 0, 180] }\n",
    )
    .unwrap();
    let compensate = [
        "compensate",
        "job.toml",
        "--out",
        "out.csv",
        "--tolerance-um",
        "20",
    ];
    let output = run(here.path(), &compensate);
    assert!(matches!(output.code, 0 | 4), "{output:?}");
    let (code, found, said) = verified(here.path(), "out.csv", &["--tolerance-um", "40"]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert!(
        number(&found, "max_position_error_of_original_mm") > 0.1,
        "{said}"
    );
    assert!(number(&found, "max_residual_rotation_deg") < 1e-3, "{said}");
}
