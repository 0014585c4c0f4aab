//! `mirror`: trials of a machine that another command simulates, and what the state refuses.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use kinetostat_testing::{Worst, figure};
use serde_json::Value;

use crate::common::{Said, run, workplace};

/// A circle of 30 mm, with straight ways in and out along its tangent.
const CIRCLE: &str =
    "G21 G90\nG0 X30 Y-40 Z5\nG0 Z0\nG1 Y0 F600\nG3 X30 Y0 I-30\nG1 Y40\nG0 Z5\nM2\n";

pub(crate) fn job(program: &str, model: &str) -> String {
    format!(
        "schema = 1\nmodel = \"{model}\"\nprogram = \"{program}\"\n[placement]\npart_origin_mm = [0, 0, 100]\n[tool]\nlength_mm = 100\n[load]\nmilling = {{ radial_n = 215, tangential_n = -10, axial_n = -25 }}\n"
    )
}

/// The orthoglide with feet and bars 30 % softer than the preset.
pub(crate) fn soft(preset: &str) -> String {
    let softer = |line: &str| {
        let mut out = String::new();
        let mut digits = String::new();
        for c in line.chars().chain(std::iter::once('\n')) {
            // Digits in a name are no number.
            let begins =
                c.is_ascii_digit() && !out.ends_with(|before: char| before.is_alphanumeric());
            let goes_on = c.is_ascii_digit() || c == '.' || c == 'e';
            if begins && digits.is_empty() || goes_on && !digits.is_empty() {
                digits.push(c);
                continue;
            }
            match digits.parse::<f64>() {
                Ok(value) => out += &format!("{}", 0.7 * value),
                Err(_) => out += &digits,
            }
            digits.clear();
            out.push(c);
        }
        out
    };
    let mut changed = 0;
    let lines = preset.lines().map(|line| {
        let of_bar = line.trim_start().starts_with('[') && line.trim_end().ends_with("],");
        let of_foot = line.strip_prefix("rigidities = ");
        changed += usize::from(of_bar || of_foot.is_some());
        match of_foot {
            Some(rest) => format!("rigidities = {}", softer(rest)),
            None if of_bar && line.starts_with("  [") => softer(line),
            None => format!("{line}\n"),
        }
    });
    let text = lines.collect();
    assert!(changed >= 7, "{changed} lines of stiffness");
    text
}

/// Points along a program on the machine that is simulated.
pub(crate) fn solved_points(here: &Path, program: &str) -> String {
    let words = [
        "deflect",
        "soft_job.toml",
        "--program",
        program,
        "--points",
        "points.csv",
        "--all-points",
        "--force-overwrite",
    ];
    run(here, &words).answered();
    std::fs::read_to_string(here.join("points.csv")).unwrap()
}

/// Where the tool comes to be along a program, by solving a machine along it: rows of a measurement, and the largest distance of
/// those on the circle from it, um.
fn simulated(here: &Path, program: &str) -> (String, Worst) {
    let text = solved_points(here, program);
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let at = ["x", "y", "z"].map(|axis| {
        [
            column(&format!("{axis}_mm")),
            column(&format!("error_before_{axis}_mm")),
        ]
    });
    let kind = column("kind");
    let mut rows = String::from("x_mm,y_mm,z_mm\n");
    let mut worst = Worst::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        if cells[kind] == "rapid" {
            continue;
        }
        let [x, y, z] = at.map(|both| {
            both.map(|k| cells[k].parse::<f64>().unwrap())
                .iter()
                .sum::<f64>()
        });
        rows += &format!("{x},{y},{z}\n");
        if x < 29.0 {
            worst.add(1e3 * (x.hypot(y) - 30.0).hypot(z));
        }
    }
    assert!(worst.samples() > 300);
    (rows, worst)
}

/// A part and the machine that is to cut it.
pub(crate) struct Part<'a> {
    /// Name of its program, and the program itself.
    pub program: (&'a str, &'a str),
    /// Name of the model's preset, and the same machine as it is: softer.
    pub preset: &'a str,
    pub softened: fn(&str) -> String,
    /// The job with a model.
    pub job: &'a dyn Fn(&str) -> String,
    /// Further options of `mirror`.
    pub more: &'a [&'a str],
}

/// A program for the orthoglide.
pub(crate) fn of_orthoglide<'a>(
    program: (&'a str, &'a str),
    job: &'a dyn Fn(&str) -> String,
) -> Part<'a> {
    Part {
        program,
        preset: "orthoglide",
        softened: soft,
        job,
        more: &[],
    }
}

/// Three trials of a part on a machine of 70 % of its model's stiffness, the model first and the rest by measurement: the worst error
/// of each, um, as `measured` finds it with the rows of a measurement. `look` sees the folder and what is said of each trial.
pub(crate) fn three_trials(
    part: &Part<'_>,
    measured: impl Fn(&Path, &str) -> (String, Worst),
    mut look: impl FnMut((&Path, &str), &Said, &Value),
) -> [Worst; 3] {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let preset = run(here.path(), &["model", "show", part.preset])
        .answered()
        .out;
    let (name, program) = part.program;
    put(name, program);
    put("soft.toml", &(part.softened)(&preset));
    put("model_job.toml", &(part.job)(part.preset));
    put("soft_job.toml", &(part.job)("soft.toml"));
    let ending = name.rsplit('.').next().unwrap();
    let trial_of = |number: u64| format!("trial{number}.{ending}");
    let fine = ["--decimals", "5", "--tolerance-um", "0.3"];
    let first = trial_of(1);
    let mut words = vec!["compensate", "model_job.toml", "--out", &first];
    words.extend(fine);
    run(here.path(), &words).answered();
    [1_u64, 2, 3].map(|trial| {
        let (rows, worst) = measured(here.path(), &trial_of(trial));
        let [file, next] = [format!("trial{trial}.csv"), trial_of(trial + 1)];
        put(&file, &rows);
        let mut words = vec![
            "mirror",
            name,
            "--measured",
            &file,
            "--job",
            "model_job.toml",
            "--state",
            "state.toml",
            "--register",
            "none",
            "--align",
            "arc-length",
            "--out",
            &next,
            "--json",
        ];
        words.extend(fine);
        words.extend(part.more);
        let said = run(here.path(), &words).answered();
        let found: Value = serde_json::from_str(&said.out).unwrap();
        assert_eq!(
            (found["trial"].as_u64(), found["model"].as_str()),
            (Some(trial), Some(part.preset))
        );
        look((here.path(), &next), &said, &found);
        worst
    })
}

#[test]
fn figure_a_model_thirty_percent_off_and_the_mirror_end_below_two_micrometres() {
    let job = |model: &str| job("circle.ngc", model);
    let part = of_orthoglide(("circle.ngc", CIRCLE), &job);
    let errors_um = three_trials(&part, simulated, |_, _, _| ()).map(|worst| worst.value());
    // The model alone leaves a third of what it should correct.
    assert!(errors_um[0] > 200.0, "{errors_um:?}");
    assert!(errors_um[1] < 10.0, "{errors_um:?}");
    let name = "mirror on a model 30 % off: error in the third trial, circle on orthoglide";
    assert!(
        figure::at_most(name, errors_um[2], 2.0, "um"),
        "{errors_um:?}"
    );
}

/// Points on the circle's ways, raised by so much, with one far off.
fn raised(by: f64) -> String {
    let mut rows = String::from("x_mm,y_mm,z_mm\n");
    for k in 0..=40 {
        let z = by + if k == 20 { 0.3 } else { 0.0 };
        rows += &format!("30,{},{z}\n", -40 + k);
    }
    for k in 1..180 {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 180.0).sin_cos();
        rows += &format!("{},{},{by}\n", 30.0 * cosine, 30.0 * sine);
    }
    rows
}

#[test]
fn what_is_measured_is_said_and_kept_for_the_next_trial() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let state = || std::fs::read_to_string(here.path().join("state.toml")).unwrap();
    put("circle.ngc", CIRCLE);
    put("other.ngc", &CIRCLE.replace("F600", "F500"));
    put("trial1.csv", &raised(0.05));
    put("trial2.csv", &raised(0.001));
    let mirror = |program: &str, measured: &str, out: &str, more: &[&str]| {
        let mut words = vec![
            "mirror",
            program,
            "--measured",
            measured,
            "--state",
            "state.toml",
            "--register",
            "none",
            "--align",
            "arc-length",
            "--out",
            out,
        ];
        words.extend(more);
        run(here.path(), &words)
    };
    let said = mirror(
        "circle.ngc",
        "trial1.csv",
        "trial2.ngc",
        &["--plot", "trial1.svg"],
    )
    .answered();
    assert!(
        said.out.lines().all(|line| line.chars().count() <= 80),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("row 21 is left out: 0.35"),
        "{}",
        said.out
    );
    // Nothing was measured on the way out.
    assert!(
        said.out.contains("line 6: ") && said.out.contains("fades to nothing"),
        "{}",
        said.out
    );
    let plot = std::fs::read_to_string(here.path().join("trial1.svg")).unwrap();
    assert!(plot.contains("outlier, row 21"));
    assert!(
        plot.contains("class=\"line c0 dots\""),
        "readings are not joined"
    );
    let written = std::fs::read_to_string(here.path().join("trial2.ngc")).unwrap();
    assert!(
        written.contains("Z-0.05") || written.contains("Z-0.0499"),
        "{written}"
    );

    let kept = state();
    for (program, measured, more, says) in [
        (
            "other.ngc",
            "trial2.csv",
            &[][..],
            "the state has program_sha256 = ",
        ),
        (
            "circle.ngc",
            "trial2.csv",
            &["--smoothing-mm", "4"][..],
            "the state has smoothing_mm = 5, this run 4",
        ),
        (
            "circle.ngc",
            "trial1.csv",
            &[][..],
            "trial1.csv is the measurement trial1.csv of an earlier trial",
        ),
        (
            "circle.ngc",
            "trial2.csv",
            &["--relaxation", "2"][..],
            "the relaxation is 2",
        ),
        (
            "circle.ngc",
            "trial2.csv",
            &["--repeatability-um", "0"][..],
            "--repeatability-um 0",
        ),
    ] {
        let said = mirror(program, measured, "no.ngc", more);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains(says), "{}", said.err);
        assert!(!here.path().join("no.ngc").exists() && state() == kept);
    }

    let said = mirror(
        "circle.ngc",
        "trial2.csv",
        "trial3.ngc",
        &["--repeatability-um", "10"],
    )
    .answered();
    assert!(
        said.out
            .contains("stop: what is left is within the repeatability"),
        "{}",
        said.out
    );
    let [two, three] =
        ["trial2.ngc", "trial3.ngc"].map(|name| std::fs::read(here.path().join(name)).unwrap());
    assert!(two == three && state().contains("number = 2"));
}

#[test]
fn a_second_program_is_a_measurement_too() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("circle.ngc", CIRCLE);
    put("lower.ngc", &CIRCLE.replace("G0 Z0", "G0 Z-0.02"));
    let words = [
        "mirror",
        "circle.ngc",
        "--measured",
        "lower.ngc",
        "--register",
        "none",
        "--align",
        "arc-length",
        "--out",
        "next.ngc",
        "--json",
    ];
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let figures = &found["measurements"][0]["figures"];
    assert!(
        (figures["rms_mm"].as_f64().unwrap() - 0.02).abs() < 1e-9,
        "{figures}"
    );
    assert!((found["largest_correction_mm"].as_f64().unwrap() - 0.02).abs() < 1e-4);
    // Registered, the part lies lower, and nothing is to be corrected.
    let words = [
        "mirror",
        "circle.ngc",
        "--measured",
        "lower.ngc",
        "--out",
        "same.ngc",
        "--register",
        "rigid",
        "--align",
        "arc-length",
        "--json",
    ];
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    assert!(found["largest_correction_mm"].as_f64().unwrap() < 1e-9);
    let shift = &found["measurements"][0]["registration"]["shift_mm"];
    assert!((shift[2].as_f64().unwrap() - 0.02).abs() < 1e-9, "{shift}");
}

/// A circle of 30 mm in RAPID, with straight ways in and out along its tangent; tool and work object are in the program.
const RAPID: &str = r#"MODULE Ring
  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,"",[[1800,0,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PROC main()
    MoveL [[30,-40,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tMill\WObj:=wPart;
    MoveL [[30,-40,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tMill\WObj:=wPart;
    MoveL [[30,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tMill\WObj:=wPart;
    MoveC [[0,30,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[-30,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tMill\WObj:=wPart;
    MoveC [[0,-30,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[30,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tMill\WObj:=wPart;
    MoveL [[30,40,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tMill\WObj:=wPart;
    MoveL [[30,40,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tMill\WObj:=wPart;
  ENDPROC
ENDMODULE
"#;

/// The heavy arm with drives and tubes of 70 % of the preset's stiffness.
fn soft_arm(preset: &str) -> String {
    let mut changed = 0;
    let keys = ["stiffness_n_m_per_rad = ", "youngs_modulus_gpa = "];
    let mut text = preset.to_owned();
    for key in keys {
        let mut parts = text.split(key);
        let mut out = parts.next().unwrap().to_owned();
        for part in parts {
            let end = part.find([',', '\n']).unwrap();
            let value: f64 = part[..end].parse().unwrap();
            out += &format!("{key}{}{}", 0.7 * value, &part[end..]);
            changed += 1;
        }
        text = out;
    }
    assert_eq!(changed, 12, "six drives and six tubes");
    text
}

/// A robot's own program and an arm of 70 % of its model's stiffness: model and mirror end below 2 um in three trials.
#[test]
fn figure_a_robots_program_with_a_model_thirty_percent_off_ends_below_two_micrometres() {
    let job = |model: &str| {
        format!(
            "schema = 1\nmodel = \"{model}\"\nprogram = \"circle.mod\"\n[load]\nweight = \"all\"\nmilling = {{ radial_n = 215, tangential_n = -10, axial_n = -25 }}\n[robot]\nrapid_from_mm_per_s = 100\n[[features]]\nname = \"ring\"\nlines = [8, 9]\ntolerance_um = 5\n[[features]]\nname = \"way back\"\nlines = [11, 11]\n"
        )
    };
    let part = Part {
        program: ("circle.mod", RAPID),
        preset: "heavy_6r",
        softened: soft_arm,
        job: &job,
        more: &["--window-mm", "3"],
    };
    let mut held = Vec::new();
    let look = |(here, next): (&Path, &str), said: &Said, found: &Value| {
        let features = &found["measurements"][0]["features"];
        held.push(features[0]["held"].as_bool().unwrap());
        // A rapid cuts nothing.
        assert_eq!(features[1]["length_mm"].as_f64(), Some(0.0));
        assert!(
            said.err
                .contains("way back (lines 11 to 11): no feed move lies there")
        );
        let written = std::fs::read_to_string(here.join(next)).unwrap();
        assert!(written.contains("MODULE Ring") && written.contains("PERS tooldata tMill"));
    };
    let errors_um = three_trials(&part, simulated, look).map(|worst| worst.value());
    eprintln!("um off the circle, trial by trial: {errors_um:?}");
    assert!(errors_um[0] > 50.0, "{errors_um:?}");
    let name = "mirror on a model 30 % off: error in the third trial, RAPID ring on an arm";
    assert!(
        figure::at_most(name, errors_um[2], 2.0, "um"),
        "{errors_um:?}"
    );
    assert_eq!((held[0], held[2]), (false, true));
}

/// Features of a job without a model, in KRL: where nothing was measured is said by name.
#[test]
fn a_feature_without_a_point_is_named() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put(
        "slot.src",
        "DEF slot()\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 50,A 0,B 0,C 180}\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\nLIN {X 100,Y 0,Z 0,A 0,B 0,C 180}\nLIN {X 100,Y 80,Z 0,A 0,B 0,C 180}\nEND\n",
    );
    put(
        "job.toml",
        "schema = 1\nprogram = \"slot.src\"\n[robot]\ntool_axis = \"z\"\n[[features]]\nname = \"long side\"\nlines = [5, 5]\ntolerance_um = 30\n[[features]]\nname = \"short side\"\nlines = [6, 6]\n",
    );
    let rows = (0..100).map(|x| format!("{x},0.04,0\n"));
    let rows: String = std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect();
    put("trial1.csv", &rows);
    let words = [
        "mirror",
        "slot.src",
        "--measured",
        "trial1.csv",
        "--job",
        "job.toml",
        "--register",
        "none",
        "--out",
        "next.src",
    ];
    let said = run(here.path(), &words).answered();
    let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    for needle in [
        "long side (lines 5 to 5): 100 points",
        "MORE THAN THE 0.0300 mm ALLOWED",
        "short side (lines 6 to 6): NO POINT WAS MEASURED on its 80 mm",
    ] {
        assert!(text.contains(needle), "{needle} in {text}");
    }
    let mut of_pose = words.to_vec();
    of_pose.extend(["--correct", "pose"]);
    let refused = run(here.path(), &of_pose);
    assert!(
        refused.code == 1 && refused.err.contains("not how it stands"),
        "{refused:?}"
    );
    let written = std::fs::read_to_string(here.path().join("next.src")).unwrap();
    assert!(
        written.contains("Y -0.0") && written.starts_with("DEF slot()"),
        "{written}"
    );
}
