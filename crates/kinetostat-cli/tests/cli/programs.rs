//! Compensation of whole programs: generated ones, and the real ones outside the repository.

use crate::common::{JOB, PROGRAM, contents, gcode, run, shell, workplace};
use std::path::Path;

use serde_json::Value;

fn result(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).expect("JSON")
}

#[test]
fn tools_of_a_program_have_their_own_lengths_and_without_a_table_a_warning() {
    let here = workplace();
    let program = "G21 G90\nT1 M6\nG43 H1 G0 Z5\nG0 X0 Y0\nG1 Z-1 F300\nG1 X30\nG0 Z5\nT2 M6\nG43 H2 G0 Z5\nG1 Z-1 F300\nG1 X0\nG0 Z5\nM2\n";
    std::fs::write(here.path().join("tools.ngc"), program).unwrap();
    let compensate = |job: &str| {
        std::fs::write(here.path().join("tools.toml"), job).unwrap();
        let arguments = [
            "compensate",
            "tools.toml",
            "--force-overwrite",
            "--json",
            "r.json",
        ];
        let done = run(here.path(), &arguments);
        (done, here.path().join("r.json"))
    };
    let one = JOB.replace("part.ngc", "tools.ngc");
    let (done, json) = compensate(&one);
    done.answered();
    let r = result(&std::fs::read(json).unwrap());
    let lines: Vec<u64> = r["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|w| {
            w["message"]
                .as_str()
                .unwrap()
                .contains("one tool length and one load")
        })
        .map(|w| w["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [8], "{}", r["warnings"]);

    let table = "[[tools]]\nnumber = 1\nlength_mm = 100\n[[tools]]\nnumber = 2\nlength_mm = 40\nload = { force_n = [0, 0, -400] }\n\n[load]";
    let (done, json) = compensate(&one.replace("[load]", table));
    let said = done.answered();
    assert!(!said.out.contains("one tool length"), "{}", said.out);
    let r = result(&std::fs::read(json).unwrap());
    let inputs = &r["question"];
    assert!(
        inputs["tool"].as_str().unwrap().contains("tool 2: 40 mm"),
        "{inputs}"
    );
    assert!(
        inputs["load"]
            .as_str()
            .unwrap()
            .contains("tool 2: force (0, 0, -400) N"),
        "{inputs}"
    );
    let force = |line: u64| {
        let points = r["points"].as_array().unwrap();
        let point = points
            .iter()
            .find(|p| p["line"] == line)
            .expect("a point on the line");
        point["force_n"][2].as_f64().unwrap()
    };
    assert!((force(6) + 25.0).abs() < 1e-9 && (force(11) + 400.0).abs() < 1e-9);
    assert!(
        r["summary"]["max_position_error_after_mm"]
            .as_f64()
            .unwrap()
            <= 0.001
    );

    // What is assumed at sharp corners is said of each tool by itself, and --load-at-corners goes over it.
    let turning = "milling = { radial_n = 300, tangential_n = 0, axial_n = 100 }";
    let follows = table.replace(
        "force_n = [0, 0, -400]",
        &format!("{turning}, at_corners = \"follows_feed\""),
    );
    let (done, json) = compensate(&one.replace("[load]", &follows));
    // Tool 2 then cuts along its steps, and misses there what holds where the load turns.
    assert_eq!(done.code, 3, "{done:?}");
    let said = done.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        said.contains("(tool 1), or follows the feed on the steps (tool 2)"),
        "{said}"
    );

    let read = |json: &Path| {
        let r = result(&std::fs::read(json).unwrap());
        let tools = r["question"]["tools_at_corners"]
            .as_array()
            .unwrap()
            .clone();
        tools
            .iter()
            .map(|tool| {
                (
                    tool["number"].as_u64().unwrap(),
                    tool["load_at_corners"].as_str().unwrap().to_owned(),
                )
            })
            .collect::<Vec<_>>()
    };
    let (turns, follows) = ("turns".to_owned(), "follows_feed".to_owned());
    assert_eq!(read(&json), [(1, turns.clone()), (2, follows)]);
    run(
        here.path(),
        &[
            "compensate",
            "tools.toml",
            "--force-overwrite",
            "--json",
            "r.json",
            "--load-at-corners",
            "turns",
        ],
    )
    .answered();
    assert_eq!(read(&json), [(1, turns.clone()), (2, turns)]);

    // A tool that is not in the table.
    let (done, _) = compensate(&one.replace("[load]", &table.replace("number = 2", "number = 3")));
    assert_eq!(done.code, 1);
    assert!(
        done.err.contains("line 8") && done.err.contains("tool 2 is not among"),
        "{}",
        done.err
    );
}

#[test]
fn a_job_writes_what_it_names_and_options_go_over_it() {
    let here = workplace();
    let said = run(
        here.path(),
        &[
            "compensate",
            "job.toml",
            "--json",
            "r.json",
            "--points",
            "p.csv",
            "--report",
            "r.html",
        ],
    )
    .answered();
    assert!(
        said.out.contains("out.ngc") && said.out.contains("r.html"),
        "{}",
        said.out
    );
    let r = result(&std::fs::read(here.path().join("r.json")).unwrap());
    assert!(
        r["summary"]["max_position_error_after_mm"]
            .as_f64()
            .unwrap()
            <= 0.001
    );
    assert_eq!(r["question"]["model_source"], "preset orthoglide");
    let table = std::fs::read_to_string(here.path().join("p.csv")).unwrap();
    assert!(
        table.starts_with("line,output_line,kind,share,path_mm,x_mm,"),
        "{table}"
    );
    assert!(table.lines().skip(1).all(|l| l.ends_with(",ok")));
    assert_eq!(
        table.lines().count() as u64,
        1 + r["summary"]["points"].as_u64().unwrap()
    );

    // The same without a job file.
    run(
        here.path(),
        &[
            "compensate",
            "--model",
            "orthoglide",
            "--program",
            "part.ngc",
            "--part-origin-mm",
            "0",
            "0",
            "100",
            "--tool-length-mm",
            "100",
            "--milling",
            "215",
            "-10",
            "-25",
            "--out",
            "flags.ngc",
        ],
    )
    .answered();
    assert_eq!(
        std::fs::read(here.path().join("out.ngc")).unwrap(),
        std::fs::read(here.path().join("flags.ngc")).unwrap()
    );

    // Options win: no header, fewer pieces with a wide tolerance.
    run(
        here.path(),
        &[
            "compensate",
            "job.toml",
            "--out",
            "wide.ngc",
            "--no-header",
            "--tolerance-um",
            "20",
            "--chord-tolerance-um",
            "20",
            "--decimals",
            "6",
        ],
    )
    .answered();
    let wide = std::fs::read_to_string(here.path().join("wide.ngc")).unwrap();
    let fine = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    assert!(wide.lines().count() < fine.lines().count());
    assert!(!wide.contains("kinetostat") && fine.contains("kinetostat: compensated program"));
    assert!(
        fine.contains("model orthoglide") && fine.contains("215 N"),
        "{fine}"
    );
}

#[test]
fn a_compensated_program_is_not_compensated_twice() {
    let here = workplace();
    run(here.path(), &["compensate", "job.toml"]).answered();
    let before = contents(here.path());
    let twice = [
        "compensate",
        "job.toml",
        "--program",
        "out.ngc",
        "--out",
        "twice.ngc",
    ];
    let said = run(here.path(), &twice);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err.contains("line 1") && said.err.contains("again"),
        "{}",
        said.err
    );
    assert_eq!(contents(here.path()), before);
    let mut again = twice.to_vec();
    again.push("--again");
    run(here.path(), &again).answered();
}

#[test]
fn deflect_tells_and_writes_no_program() {
    let here = workplace();
    let said = run(
        here.path(),
        &["deflect", "job.toml", "--json", "--report", "r.html"],
    )
    .answered();
    let r = result(said.out.as_bytes());
    assert_eq!(r["question"]["compensated"], false);
    assert_eq!(
        r["summary"]["max_position_error_before_mm"],
        r["summary"]["max_position_error_after_mm"]
    );
    assert!(!here.path().join("out.ngc").exists());
    assert!(here.path().join("r.html").exists());
}

#[test]
fn a_table_of_corrections_is_written_into_a_program() {
    let here = workplace();
    std::fs::write(
        here.path().join("map.csv"),
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-100,0,0,0.1,0,0\n100,0,0,0.3,0,0\n",
    )
    .unwrap();
    let said = run(
        here.path(),
        &[
            "compensate",
            "--map",
            "map.csv",
            "--program",
            "part.ngc",
            "--out",
            "m.ngc",
            "--json",
        ],
    )
    .answered();
    let r = result(said.out.as_bytes());
    assert!((r["accounting"]["largest_correction_mm"].as_f64().unwrap() - 0.22).abs() < 1e-9);
    let text = std::fs::read_to_string(here.path().join("m.ngc")).unwrap();
    assert!(text.contains("G0 X20.2200 Y0 Z5"), "{text}");
    assert!(text.contains("table map.csv"), "{text}");
}

#[test]
fn thread_count_does_not_change_a_byte() {
    let here = workplace();
    for threads in ["1", "2"] {
        let out = format!("t{threads}.ngc");
        let json = format!("t{threads}.json");
        run(
            here.path(),
            &[
                "compensate",
                "job.toml",
                "--threads",
                threads,
                "--out",
                &out,
                "--json",
                &json,
            ],
        )
        .answered();
    }
    let read = |name: &str| std::fs::read(here.path().join(name)).unwrap();
    assert_eq!(read("t1.ngc"), read("t2.ngc"));
    assert_eq!(read("t1.json"), read("t2.json"));
}

#[test]
fn odd_but_valid_files_are_read() {
    let here = workplace();
    let put = |name: &str, bytes: &[u8]| std::fs::write(here.path().join(name), bytes).unwrap();
    let crlf = |text: &str| text.replace('\n', "\r\n");
    put(
        "crlf.toml",
        crlf(&JOB.replace("part.ngc", "crlf.ngc")).as_bytes(),
    );
    put("crlf.ngc", crlf(PROGRAM).as_bytes());
    put(
        "bom.toml",
        format!("\u{feff}{}", JOB.replace("out.ngc", "bom-out.ngc")).as_bytes(),
    );
    put("mein Gerät.ngc", PROGRAM.as_bytes());
    run(here.path(), &["compensate", "crlf.toml"]).answered();
    let written = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    assert_eq!(
        written.matches('\n').count(),
        written.matches("\r\n").count()
    );
    run(here.path(), &["compensate", "bom.toml"]).answered();
    run(
        here.path(),
        &[
            "compensate",
            "job.toml",
            "--program",
            "mein Gerät.ngc",
            "--out",
            "größer.ngc",
        ],
    )
    .answered();
    // Without a name for the output: beside the job, never over the program.
    put(
        "short.toml",
        JOB.split("[output]").next().unwrap().as_bytes(),
    );
    let said = run(here.path(), &["compensate", "short.toml"]).answered();
    assert!(said.out.contains("part-compensated.ngc"), "{}", said.out);
}

#[test]
fn outputs_are_as_any_other_file() {
    let here = workplace();
    let said = shell(
        here.path(),
        "umask 022; $K compensate job.toml >/dev/null; test $? = 4 && ls -la",
    );
    assert_eq!(said.code, 0, "{said:?}");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(here.path().join("out.ngc"))
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o644);
    }
    assert!(!said.out.contains(".part"), "{}", said.out);
}

#[test]
fn real_programs_pass_byte_for_byte_without_compensation() {
    let Some(gcode) = gcode() else { return };
    let here = workplace();
    let mut passed = 0;
    for entry in std::fs::read_dir(&gcode).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "gcode") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let said = run(
            here.path(),
            &[
                "compensate",
                "--no-compensation",
                "--program",
                path.to_str().unwrap(),
                "--out",
                &name,
            ],
        );
        if name == "371373P.gcode" {
            assert_eq!(said.code, 1);
            for needle in ["371373P.gcode", "line 5", "G22", "subroutine"] {
                assert!(said.err.contains(needle), "{}", said.err);
            }
            assert!(!here.path().join(&name).exists());
            continue;
        }
        said.answered();
        assert_eq!(
            std::fs::read(&path).unwrap(),
            std::fs::read(here.path().join(&name)).unwrap(),
            "{name}"
        );
        passed += 1;
    }
    assert!(passed >= 7, "{passed}");
}

#[test]
fn an_arc_that_is_none_is_refused_with_both_radii() {
    let Some(gcode) = gcode() else { return };
    let here = workplace();
    let path = gcode.join("Circle_Diamond_Square_Calibration.gcode");
    let before = contents(here.path());
    let said = run(
        here.path(),
        &[
            "compensate",
            "--model",
            "orthoglide",
            "--program",
            path.to_str().unwrap(),
            "--out",
            "c.ngc",
        ],
    );
    assert_eq!(said.code, 1);
    for needle in ["N624", "29.0000", "27.5862", "1.4138", "arc"] {
        assert!(said.err.contains(needle), "{}", said.err);
    }
    assert_eq!(contents(here.path()), before);
}

#[test]
fn the_pocket_is_compensated_within_a_micrometre() {
    let Some(gcode) = gcode() else { return };
    let here = workplace();
    let text = std::fs::read_to_string(gcode.join("tball-pocket.gcode")).unwrap();
    // A debug build takes a part of it; the whole is timed by a release build.
    let lines = if cfg!(debug_assertions) {
        3000
    } else {
        usize::MAX
    };
    let part: String = text.split_inclusive('\n').take(lines).collect();
    std::fs::write(here.path().join("tball-pocket.gcode"), part).unwrap();
    let job = JOB
        .replace("part.ngc", "tball-pocket.gcode")
        .replace("[0, 0, 100]", "[-50, 90, 120]");
    std::fs::write(here.path().join("pocket.toml"), job).unwrap();
    let start = std::time::Instant::now();
    let said = run(here.path(), &["compensate", "pocket.toml", "--json"]).answered();
    let seconds = start.elapsed().as_secs_f64();
    let r = result(said.out.as_bytes());
    let s = &r["summary"];
    eprintln!("{} blocks in {seconds:.1} s: {s}", s["blocks"]);
    assert!(s["max_position_error_before_mm"].as_f64().unwrap() > 0.05);
    assert!(
        s["max_position_error_after_mm"].as_f64().unwrap() <= 0.001,
        "{s}"
    );
    assert_eq!(s["stable"], true);
}

/// G43 before the first move, G28 between the tools and at the end: carried, and with the machine's places a cut
/// may follow at once.
#[test]
fn places_of_the_machine_are_carried_and_may_be_stated() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let program = "G21 G90\nT1 M6\nG43 H1\nG0 X0 Y0\nZ5\nG1 Z-1 F300\nX30\nG0 Z5\nG91 G28 Z0\nG90\nX10 Y10\nG0 Z5\nG1 Z-1\nG0 Z5\nG53 G0 Z0\nG49\nG28\nM30\n";
    write("places.ngc", program);
    write("places.toml", &JOB.replace("part.ngc", "places.ngc"));
    let run_job = |more: &[&str]| {
        let start = ["compensate", "places.toml", "--force-overwrite"];
        run(here.path(), &[&start[..], more].concat())
    };
    run_job(&[]).answered();
    let output = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    for line in ["G91 G28 Z0", "X10 Y10", "G53 G0 Z0", "G28", "G43 H1", "G49"] {
        assert!(output.lines().any(|l| l == line), "{line}: {output}");
    }
    // Above the path in every cut, and with no correction at the reference points.
    assert!(
        output.contains("\nG0 Z5 X30.0000 Y0.0000\nG91 G28 Z0\n"),
        "{output}"
    );

    // A cut from there needs to know where that is.
    write(
        "places.ngc",
        "G21 G90\nG0 X0 Y0 Z5\nG28 Z5\nG1 X30 Z0 F300\nG0 Z5\nM30\n",
    );
    let said = run_job(&[]);
    assert_eq!(said.code, 4, "{said:?}");
    let unjudged = "Feeds whose start or way is not known, the first on line 4";
    let out = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        out.contains(unjudged) && out.contains("--machine-zero-mm"),
        "{out}"
    );
    let said = run_job(&["--g28-mm", "0", "0", "-90"]);
    assert!(
        said.code == 1 && said.err.contains("machine_zero_mm"),
        "{}",
        said.err
    );
    let zero = ["--machine-zero-mm", "0", "0", "100"];
    let said = run_job(&[&zero[..], &["--g28-mm", "0", "0", "-90"]].concat()).answered();
    assert!(!said.out.contains("Feeds whose start"), "{}", said.out);
    let table = "[reading]\nmachine_zero_mm = [0, 0, 100]\ng28_mm = [0, 0, -90]\n";
    let job = JOB.replace("part.ngc", "places.ngc");
    let by_options = std::fs::read(here.path().join("out.ngc")).unwrap();
    write("places.toml", &format!("{job}\n{table}"));
    run_job(&[]).answered();
    assert_eq!(
        std::fs::read(here.path().join("out.ngc")).unwrap(),
        by_options
    );
}
