//! One job has one reading: what each command says of placement, tool, load and of the program that another command wrote.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::{Said, run};

const PART: &str = "G21 G90 (plate)\nS8000 M3\nG0 X0 Y0 Z5\nM8\nG1 Z-1 F300\nG1 X40 F600\nG3 X50 Y10 I0 J10\nG0 Z5\nM30\n";
const BASE: &str = "pose = { position_mm = [1300, 0, 800] }\n";
const ORIGIN: &str = "part_origin_mm = [1300, 0, 800]\n";
const STANDS: &str = "tool_orientation = { a_b_c_kuka_deg = [160, 0, 180] }\n";
const TIP: &str = "pose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n";
const CUT: &str = "cutter = { shape = \"flat\", diameter_mm = 10, teeth = 2, helix_deg = 30 }\n[load]\nweight = \"all\"\n[material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[-10, -20, -12], [70, 30, 0]]\n[place]\nx_mm = [1295, 1305]\n";

/// One cell, of which the job states some and the template the rest.
struct Stated {
    origin_by_job: bool,
    orientation_by_job: bool,
    tool_by_job: bool,
}

impl Stated {
    fn place(&self, to: &str, spindle: &str) -> tempfile::TempDir {
        let of = |by_job: bool, text: &'static str| match by_job {
            true => (text, ""),
            false => ("", text),
        };
        let stands = of(self.orientation_by_job, STANDS);
        let tip = of(self.tool_by_job, TIP);
        let (origin, base) = match self.origin_by_job {
            true => (ORIGIN, ""),
            false => ("", BASE),
        };
        let job = format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n[robot]\nto = \"{to}\"\ntemplate = \"cell.toml\"\n[placement]\n{origin}{}[tool]\n{}{CUT}",
            stands.0, tip.0
        );
        let cell = format!(
            "schema = 1\nrapid_speed_mm_per_s = 150\n{}[base]\nnumber = 3\n{base}[tool]\nnumber = 2\n{}{spindle}",
            stands.1, tip.1
        );
        let here = tempfile::tempdir().unwrap();
        for (name, text) in [("part.ngc", PART), ("job.toml", &job), ("cell.toml", &cell)] {
            std::fs::write(here.path().join(name), text).unwrap();
        }
        here
    }
}

const EVERY: [Stated; 4] = [
    Stated {
        origin_by_job: true,
        orientation_by_job: true,
        tool_by_job: true,
    },
    Stated {
        origin_by_job: false,
        orientation_by_job: false,
        tool_by_job: false,
    },
    Stated {
        origin_by_job: true,
        orientation_by_job: false,
        tool_by_job: false,
    },
    Stated {
        origin_by_job: false,
        orientation_by_job: true,
        tool_by_job: true,
    },
];

fn answer(here: &Path, line: &str) -> Value {
    let words: Vec<&str> = line.split(' ').collect();
    let said = run(here, &words).answered();
    serde_json::from_str(&said.out).unwrap_or_else(|error| panic!("{line}: {error}: {said:?}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

#[track_caller]
fn same(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} {b}");
}

/// The reference states everything in the job; its error is that of `deflect`.
#[test]
fn every_command_reads_one_cell_however_job_and_template_share_it() {
    let mut first: Option<(Value, Value, Value, Value)> = None;
    for (index, stated) in EVERY.iter().enumerate() {
        let here = stated.place("krl", "");
        let here = here.path();
        let check = answer(here, "check job.toml --json");
        let deflect = answer(here, "deflect job.toml --json");
        // These two take seconds: the job alone, and the template alone.
        let slow = |line: &str| match index < 2 {
            true => answer(here, line),
            false => Value::Null,
        };
        let chatter = slow("chatter job.toml --damping 0.03 --json");
        let place = slow("place job.toml --samples 4 --json");
        for key in ["placement", "tool"] {
            assert_eq!(check[key], deflect["question"][key], "{index}: {key}");
        }
        let compensate = answer(here, "compensate job.toml --json");
        let verify = answer(here, "verify compensated/part.src --job job.toml --json");
        let before = |value: &Value| number(&value["summary"]["max_position_error_before_mm"]);
        same(before(&compensate), before(&deflect), 1e-6);
        same(
            number(&verify["max_position_error_of_original_mm"]),
            before(&deflect),
            1e-9,
        );
        same(
            number(&verify["max_position_error_mm"]),
            number(&compensate["summary"]["max_position_error_after_mm"]),
            0.5,
        );
        assert_eq!(verify["held"], true, "{verify}");
        let own = (check, deflect, chatter, place);
        let Some(of_job) = &first else {
            first = Some(own);
            continue;
        };
        for key in ["placement", "tool", "load", "ends"] {
            assert_eq!(own.0[key], of_job.0[key], "{index}: {key}");
        }
        same(before(&own.1), before(&of_job.1), 1e-12);
        if index >= 2 {
            continue;
        }
        for key in ["places", "nearest", "stretches"] {
            assert_eq!(own.2[key], of_job.2[key], "{index}: {key}");
        }
        for key in ["best", "placed"] {
            assert_eq!(own.3[key], of_job.3[key], "{index}: {key}");
        }
    }
}

fn text(said: &Said) -> String {
    format!("{} {}", said.out, said.err)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// The program of the robot starts its spindle with statements of the cell, or every command says that it does not.
#[test]
fn a_spindle_that_is_not_started_is_in_every_headline() {
    let statements =
        "[spindle]\nclockwise = [\"SPEED={rpm}\", \"RUNS=TRUE\"]\nstop = [\"RUNS=FALSE\"]\n";
    let rapid = "[spindle]\nclockwise = [\"SetAO aoSpeed, {rpm};\", \"SetDO doRuns, 1;\"]\n";
    let fanuc = "[spindle]\nclockwise = [\"AO[1]={rpm}\", \"DO[5]=ON\"]\n";
    for (to, ending, with, line) in [
        ("krl", "src", statements, "\nSPEED=8000\nRUNS=TRUE\n"),
        ("rapid", "mod", rapid, "SetAO aoSpeed, 8000;\n"),
        ("ls", "ls", fanuc, "  AO[1]=8000 ;\n"),
    ] {
        for spindle in ["", with] {
            let here = EVERY[1].place(to, spindle);
            let here = here.path();
            let out = format!("compensated/part.{ending}");
            let convert =
                format!("convert part.ngc --to {to} --template cell.toml --out made.{ending}");
            let verify = format!("verify {out} --job job.toml");
            let compensate = "compensate job.toml --report run.html";
            for command in ["check job.toml", compensate, &verify, &convert] {
                let words: Vec<&str> = command.split(' ').collect();
                let said = run(here, &words).answered();
                let is_said = text(&said).contains("SPINDLE NOT STARTED");
                assert_eq!(is_said, spindle.is_empty(), "{command}: {said:?}");
            }
            let written = std::fs::read_to_string(here.join(&out)).unwrap();
            assert_eq!(written.contains(line), !spindle.is_empty(), "{written}");
            if !spindle.is_empty() {
                let slow = format!("slow.{ending}");
                std::fs::write(here.join(&slow), written.replace("8000", "4000")).unwrap();
                let said = run(here, &["verify", &slow, "--job", "job.toml"]);
                assert_eq!(said.code, 3, "{said:?}");
                assert!(text(&said).contains("ANOTHER SPEED OF THE SPINDLE"));
            }
            // The end of the source stops the spindle, and that of a robot's program does not.
            let stops = written.contains("\nRUNS=FALSE\n");
            assert_eq!(stops, spindle == statements, "{written}");
            let page = std::fs::read_to_string(here.join("run.html")).unwrap();
            let is_said = page.contains("SPINDLE NOT STARTED");
            assert_eq!(is_said, spindle.is_empty());
        }
    }
}

/// The controller counts with the mass of a template, the model with that of the job.
#[test]
fn a_mass_that_only_the_template_states_is_said() {
    let here = EVERY[1].place("krl", "mass_kg = 12\n");
    let said = |line: &str| answer(here.path(), line)["warnings"].to_string();
    for line in [
        "check job.toml --json",
        "deflect job.toml --json",
        "compensate job.toml --json",
    ] {
        assert!(said(line).contains("does not ([tool]: 12 kg)"), "{line}");
    }
    let job = here.path().join("job.toml");
    let text = std::fs::read_to_string(&job).unwrap();
    std::fs::write(&job, text.replace("[tool]\n", "[tool]\nmass_kg = 12\n")).unwrap();
    let line = "deflect job.toml --json";
    assert!(!said(line).contains("does not ([tool]"), "{line}");
}

/// A template is for one controller.
#[test]
fn statements_of_another_controller_are_refused() {
    let krl = "clockwise = [\"$OUT[12]=TRUE\"]";
    let undeclared = "clockwise = [\"SPEED {rpm}\"]";
    for (to, statements) in [
        ("rapid", krl),
        ("ls", krl),
        ("ls", undeclared),
        ("krl", "stop = [\"DO[5]=OFF\"]"),
        ("krl", "stop = [\"SetDO doRuns, 0;\"]"),
    ] {
        let here = EVERY[1].place(to, &format!("[spindle]\n{statements}\n"));
        for command in [
            "check job.toml",
            "compensate job.toml",
            "deflect job.toml",
            "place job.toml",
            "chatter job.toml --damping 0.03",
        ] {
            let words: Vec<&str> = command.split(' ').collect();
            let said = run(here.path(), &words);
            assert_eq!(said.code, 1, "{command} {to} {statements}: {said:?}");
            let said = text(&said);
            assert!(
                said.contains("cell.toml: [spindle]:") && !said.contains("report this"),
                "{said}"
            );
        }
    }
}

/// Another frame, tool or orientation than that of the job is a fault of the program that is verified.
#[test]
fn another_frame_or_tool_than_that_of_the_job_is_found() {
    let here = EVERY[1].place("krl", "");
    let here = here.path();
    run(here, &["compensate", "job.toml"]).answered();
    let good = std::fs::read_to_string(here.join("compensated/part.src")).unwrap();
    let line = |start: &str| good.lines().find(|line| line.starts_with(start)).unwrap();
    for (start, other) in [
        ("$BASE=", "$BASE={X 1301,Y 0,Z 800,A 0,B 0,C 0}"),
        ("$TOOL=", "$TOOL={X 201,Y 0,Z 100,A 0,B 90,C 0}"),
    ] {
        std::fs::write(here.join("bad.src"), good.replace(line(start), other)).unwrap();
        let said = run(here, &["verify", "bad.src", "--job", "job.toml"]);
        assert_eq!(said.code, 3, "{start} {said:?}");
    }
}

/// Part, tool and how it stands are those of the job where the template leaves them open, with `convert` as with `compensate`.
#[test]
fn convert_writes_the_cell_that_compensate_writes() {
    for stated in &EVERY {
        let here = stated.place("krl", "");
        let here = here.path();
        run(here, &["compensate", "job.toml"]).answered();
        let line = "convert --job job.toml --to krl --template cell.toml --out made.src";
        run(here, &line.split(' ').collect::<Vec<_>>()).answered();
        let [one, other] = ["compensated/part.src", "made.src"]
            .map(|file| std::fs::read_to_string(here.join(file)).unwrap());
        for start in ["$BASE=", "$TOOL=", "$LOAD="] {
            let first = |text: &str| {
                let found = text.lines().find(|line| line.starts_with(start));
                found.map(str::to_owned)
            };
            assert_eq!(first(&one), first(&other), "{start}");
        }
        for (start, states) in [("$BASE=", "X 1300."), ("$TOOL=", "X 200.")] {
            let line = other.lines().find(|line| line.starts_with(start)).unwrap();
            assert!(line.contains(states), "{line}");
        }
    }
}

/// What both state must agree, in every command.
#[test]
fn a_cell_that_contradicts_its_job_is_refused_by_every_command() {
    let here = EVERY[1].place("krl", "");
    let here = here.path();
    let job = std::fs::read_to_string(here.join("job.toml")).unwrap();
    let other = job.replace(
        "[placement]\n",
        "[placement]\npart_origin_mm = [1300, 0, 801]\n",
    );
    std::fs::write(here.join("job.toml"), other).unwrap();
    for command in [
        "check job.toml",
        "deflect job.toml",
        "compensate job.toml",
        "place job.toml",
    ] {
        let words: Vec<&str> = command.split(' ').collect();
        let said = run(here, &words);
        assert_eq!(said.code, 1, "{command}: {said:?}");
        assert!(
            text(&said).contains("stated twice, and not the same: [base]"),
            "{said:?}"
        );
    }
}

/// A job, a model or a program in the place of another one is called by its name, with the one that is meant.
#[test]
fn a_file_of_another_kind_is_called_what_it_is() {
    let here = EVERY[0].place("krl", "");
    let here = here.path();
    std::fs::write(here.join("arm.toml"), crate::common::MODEL).unwrap();
    for (command, needles) in [
        (
            "compensate part.ngc",
            ["no model is named", "--model MODEL"],
        ),
        (
            "chatter part.ngc --damping 0.03",
            ["'part.ngc' is a program", "a job file is needed"],
        ),
        ("place part.ngc", ["no model is named", "--model MODEL"]),
        (
            "compensate arm.toml",
            ["no program is named", "--program FILE"],
        ),
        (
            "stiffness job.toml",
            ["'job.toml' is a job file", "'heavy_6r'"],
        ),
        (
            "map job.toml --x 0 10 2 --y 0 10 2",
            ["'job.toml' is a job file", "'heavy_6r'"],
        ),
        (
            "deflect part.ngc --at 0 0 0",
            ["'part.ngc' is a program", "a model is needed"],
        ),
        (
            "check part.ngc",
            ["'part.ngc' is a program", "a model is needed"],
        ),
        (
            "expand job.toml",
            ["'job.toml' is a job file", "'part.ngc'"],
        ),
        (
            "expand job.toml --out o.ngc",
            ["'job.toml' is a job file", "'part.ngc'"],
        ),
        (
            "verify job.toml --job job.toml",
            ["'job.toml' is a job file", "'part.ngc'"],
        ),
        (
            "verify part.ngc --job part.ngc",
            ["'part.ngc' is a program", "a job file is needed"],
        ),
        (
            "engagement arm.toml",
            ["'arm.toml' is a model", "a program is needed"],
        ),
    ] {
        let words: Vec<&str> = command.split(' ').collect();
        let said = run(here, &words);
        assert_eq!(said.code, 1, "{command}: {said:?}");
        for needle in needles {
            assert!(
                text(&said).contains(needle),
                "{command}: {needle}: {said:?}"
            );
        }
    }
}

/// A program that its controller loads by name keeps it, in a folder of its own, with all its files.
#[test]
fn default_names_are_those_that_controllers_load() {
    for (to, main) in [
        ("krl", "DEF Pocket_OP10("),
        ("rapid", "MODULE Pocket_OP10"),
        ("ls", "/PROG  POCKET_OP10"),
    ] {
        let here = EVERY[0].place(to, "");
        let cell = std::fs::read_to_string(here.path().join("cell.toml")).unwrap();
        let named = cell.replace(
            "schema = 1\n",
            "schema = 1\nprogram_name = \"Pocket_OP10\"\n",
        );
        std::fs::write(here.path().join("cell.toml"), named).unwrap();
        run(here.path(), &["compensate", "job.toml"]).answered();
        let ending = if to == "krl" { "src" } else { to };
        let ending = if to == "rapid" { "mod" } else { ending };
        for folder in ["compensated", "flat"] {
            let file = here.path().join(format!("{folder}/Pocket_OP10.{ending}"));
            let written = std::fs::read_to_string(file).unwrap();
            assert!(written.contains(main), "{written}");
        }
    }
    for (to, name, main) in [
        ("krl", "Pocket_OP10.src", "DEF Pocket_OP10("),
        ("rapid", "Pocket_OP10.mod", "MODULE Pocket_OP10"),
        ("ls", "Pocket_OP10.ls", "/PROG  POCKET_OP10"),
    ] {
        let here = EVERY[0].place(to, "");
        let here = here.path();
        let made = format!(
            "convert part.ngc --to {to} --job job.toml --tool-orientation a_b_c_kuka_deg=160,0,180 --template cell.toml --out {name}"
        );
        run(here, &made.split(' ').collect::<Vec<_>>()).answered();
        let job = std::fs::read_to_string(here.join("job.toml")).unwrap();
        let (_, rest) = job.split_once("[placement]").unwrap();
        let rest = rest
            .replace(STANDS, "")
            .replace(CUT, "[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n");
        let own = format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"{name}\"\n[robot]\ntool_axis = \"z\"\nrapid_from_mm_per_s = 149\n[placement]{rest}"
        );
        std::fs::write(here.join("own.toml"), own).unwrap();
        let check = answer(here, "check own.toml --json");
        assert_eq!(
            check["outputs"][0]["path"],
            format!("compensated/{name}"),
            "{check}"
        );
        assert!(!here.join("compensated").exists());
        run(here, &["compensate", "own.toml"]).answered();
        let written = std::fs::read_to_string(here.join("compensated").join(name)).unwrap();
        assert!(written.contains(main), "{written}");
        let said = run(here, &["compensate", "own.toml"]);
        assert!(
            said.code == 1 && said.err.contains("it exists already"),
            "{said:?}"
        );
        // A run that fails leaves no folder.
        std::fs::remove_dir_all(here.join("compensated")).unwrap();
        let said = run(
            here,
            &["compensate", "own.toml", "--limit", "correction_mm=0.001"],
        );
        assert_ne!(said.code, 0, "{said:?}");
        assert!(!here.join("compensated").exists());
    }
}
