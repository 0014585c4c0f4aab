//! Wrong input of every kind: exit code, a message that says what, where and what to do, nothing
//! written, no panic.

mod common;

use std::path::Path;

use common::{JOB, MODEL, PROGRAM, contents, run, shell, workplace};

/// A wrong question: files to write first, the command, its exit code, words of the message.
struct Case {
    name: &'static str,
    files: Vec<(&'static str, Vec<u8>)>,
    arguments: Vec<&'static str>,
    code: i32,
    words: &'static [&'static str],
}

fn case(
    name: &'static str,
    files: Vec<(&'static str, Vec<u8>)>,
    arguments: &[&'static str],
    code: i32,
    words: &'static [&'static str],
) -> Case {
    Case {
        name,
        files,
        arguments: arguments.to_vec(),
        code,
        words,
    }
}

#[track_caller]
fn changed(text: &str, from: &str, to: &str) -> Vec<u8> {
    assert!(text.contains(from), "'{from}' is not in the good file");
    text.replace(from, to).into_bytes()
}

#[track_caller]
fn judge(case: &Case) {
    let here = workplace();
    for (name, bytes) in &case.files {
        std::fs::write(here.path().join(name), bytes).unwrap();
    }
    let before = contents(here.path());
    let said = run(here.path(), &case.arguments);
    let told = &said.err;
    let name = case.name;
    assert_eq!(said.code, case.code, "{name}: {said:?}");
    for word in case.words {
        assert!(told.contains(word), "{name}: '{word}' is not in\n{told}");
    }
    assert!(told.starts_with("error"), "{name}: {told}");
    for never in ["panicked", "RUST_BACKTRACE", "unwrap", "\u{1b}", "\u{7}"] {
        assert!(!told.contains(never), "{name}: {told}");
    }
    assert!(said.out.is_empty(), "{name}: {}", said.out);
    assert_eq!(
        contents(here.path()),
        before,
        "{name}: something was written"
    );
}

fn all(cases: Vec<Case>) -> usize {
    for case in &cases {
        judge(case);
    }
    cases.len()
}

const CHECK: [&str; 2] = ["check", "bad.toml"];

fn models() -> Vec<Case> {
    let m = |from: &str, to: &str| vec![("bad.toml", changed(MODEL, from, to))];
    vec![
        case(
            "model: no unit",
            m("length_mm = 800", "length = 800"),
            &CHECK,
            1,
            &["bad.toml:20", "no unit", "length_mm"],
        ),
        case(
            "model: wrong unit",
            m("stiffness_n_m_per_rad", "stiffness_n_m_per_deg"),
            &CHECK,
            1,
            &["bad.toml:19", "stiffness_n_m_per_rad"],
        ),
        case(
            "model: unit of another kind",
            m("stiffness_n_m_per_rad", "stiffness_n_per_mm"),
            &CHECK,
            1,
            &["bad.toml:19"],
        ),
        case(
            "model: not a number",
            m("mass_kg = 2", "mass_kg = nan"),
            &CHECK,
            1,
            &["bad.toml:10", "finite"],
        ),
        case(
            "model: infinite",
            m("length_mm = 800", "length_mm = inf"),
            &CHECK,
            1,
            &["bad.toml:20", "finite"],
        ),
        case(
            "model: negative stiffness",
            m("= 2e5", "= -2e5"),
            &CHECK,
            1,
            &["bad.toml:19", "-200000", "above zero"],
        ),
        case(
            "model: negative mass",
            m("mass_kg = 2", "mass_kg = -2"),
            &CHECK,
            1,
            &["bad.toml:10", "mass"],
        ),
        case(
            "model: slip of the pen",
            m("youngs_modulus_gpa", "youngs_modulos_gpa"),
            &CHECK,
            1,
            &["bad.toml:14", "did you mean 'youngs_modulus_gpa'?"],
        ),
        case(
            "model: text for a number",
            m("mass_kg = 2", "mass_kg = \"2\""),
            &CHECK,
            1,
            &["bad.toml:10", "number"],
        ),
        case(
            "model: unknown chain",
            m("chain = \"arm\"", "chain = \"arn\""),
            &CHECK,
            1,
            &["bad.toml", "arn", "arm"],
        ),
        case(
            "model: weight without gravity",
            m("gravity_m_per_s2 = [0, 0, -9.81]", ""),
            &CHECK,
            1,
            &["bad.toml", "gravity_m_per_s2"],
        ),
        case(
            "model: no TOML",
            m("schema = 1", "schema : 1"),
            &CHECK,
            1,
            &["bad.toml:1", "TOML"],
        ),
        case(
            "model: another version",
            m("schema = 1", "schema = 7"),
            &CHECK,
            1,
            &["bad.toml:1", "version 7", "version 1"],
        ),
        case(
            "model: unnamed rotation",
            m(
                "position_mm = [800, 0, 0]",
                "position_mm = [800, 0, 0], rpy_deg = [0, 0, 0]",
            ),
            &CHECK,
            1,
            &["bad.toml:9", "convention"],
        ),
        case(
            "model: missing",
            vec![],
            &["check", "missing.toml"],
            1,
            &["missing.toml", "no such file"],
        ),
        case(
            "model: directory",
            vec![],
            &["check", "."],
            1,
            &["directory"],
        ),
        case(
            "model: nothing in it",
            vec![("bad.toml", vec![])],
            &CHECK,
            1,
            &["bad.toml", "empty"],
        ),
        case(
            "model: binary",
            vec![("bad.toml", vec![0, 159, 146, 150, 0])],
            &CHECK,
            1,
            &["bad.toml", "binary"],
        ),
        case(
            "model: UTF-16",
            vec![("bad.toml", vec![0xff, 0xfe, b's', 0])],
            &CHECK,
            1,
            &["bad.toml", "UTF-16", "UTF-8"],
        ),
        case(
            "model: Latin-1",
            vec![("bad.toml", b"schema = 1\n# Gr\xf6\xdfe\n".to_vec())],
            &CHECK,
            1,
            &["bad.toml", "line 2", "UTF-8"],
        ),
        case(
            "model: unknown preset",
            vec![],
            &["check", "ortoglide"],
            1,
            &["ortoglide", "did you mean 'orthoglide'?"],
        ),
        case(
            "model: preset to show",
            vec![],
            &["model", "show", "stewart"],
            1,
            &["stewart", "stewart_gough_a"],
        ),
        case(
            "model: escape codes in a name",
            m("name = \"shoulder\"", "nam\u{7}e = \"\u{1b}[31mshoulder\""),
            &CHECK,
            1,
            &["bad.toml"],
        ),
    ]
}

const RUN: [&str; 2] = ["compensate", "bad.toml"];

fn jobs() -> Vec<Case> {
    let j = |from: &str, to: &str| vec![("bad.toml", changed(JOB, from, to))];
    vec![
        case(
            "job: slip of the pen",
            j("length_mm = 100", "lenght_mm = 100"),
            &RUN,
            1,
            &[
                "bad.toml:9",
                "unknown key 'lenght_mm'",
                "did you mean 'length_mm'?",
            ],
        ),
        case(
            "job: no unit",
            j("part_origin_mm", "part_origin"),
            &RUN,
            1,
            &["bad.toml:6", "part_origin_mm"],
        ),
        case(
            "job: unknown table",
            j("[load]", "[loads]"),
            &RUN,
            1,
            &["bad.toml:11", "did you mean 'load'?"],
        ),
        case(
            "job: text for a number",
            j("radial_n = 215", "radial_n = \"215 N\""),
            &RUN,
            1,
            &["bad.toml:12", "a number is needed"],
        ),
        case(
            "job: not a number",
            j("radial_n = 215", "radial_n = nan"),
            &RUN,
            1,
            &["bad.toml:12", "finite"],
        ),
        case(
            "job: two numbers for three",
            j("[0, 0, 100]", "[0, 0]"),
            &RUN,
            1,
            &["bad.toml:6"],
        ),
        case(
            "job: half a load",
            j(", axial_n = -25", ""),
            &RUN,
            1,
            &["bad.toml:12", "axial_n"],
        ),
        case(
            "job: load twice",
            j("[load]\n", "[load]\nforce_n = [0, 0, 1]\n"),
            &RUN,
            1,
            &["bad.toml:13", "twice"],
        ),
        case(
            "job: no TOML",
            j("[output]", "[output"),
            &RUN,
            1,
            &["bad.toml:14", "TOML"],
        ),
        case(
            "job: another version",
            j("schema = 1", "schema = 9"),
            &RUN,
            1,
            &["bad.toml:1", "version 9"],
        ),
        case(
            "job: no version",
            j("schema = 1\n", ""),
            &RUN,
            1,
            &["bad.toml", "'schema' is missing"],
        ),
        case(
            "job: no program",
            j("program = \"part.ngc\"\n", ""),
            &RUN,
            1,
            &["names no program", "--program"],
        ),
        case(
            "job: no model",
            j("model = \"orthoglide\"\n", ""),
            &RUN,
            1,
            &["names no model", "--model"],
        ),
        case(
            "job: missing program",
            j("part.ngc", "gone.ngc"),
            &RUN,
            1,
            &["gone.ngc", "does not exist"],
        ),
        case(
            "job: missing model",
            j("\"orthoglide\"", "\"gone.toml\""),
            &RUN,
            1,
            &["gone.toml", "no such file"],
        ),
        case(
            "job: unknown preset",
            j("\"orthoglide\"", "\"orthoglied\""),
            &RUN,
            1,
            &["did you mean 'orthoglide'?"],
        ),
        case(
            "job: out of its directory",
            j("\"out.ngc\"", "\"../out.ngc\""),
            &RUN,
            1,
            &["bad.toml:15", "outside the job's directory"],
        ),
        case(
            "job: absolute output",
            j("\"out.ngc\"", "\"/tmp/kinetostat-out.ngc\""),
            &RUN,
            1,
            &["bad.toml:15", "outside the job's directory"],
        ),
        case(
            "job: output with a drive",
            j("\"out.ngc\"", "'C:\\out.ngc'"),
            &RUN,
            1,
            &["bad.toml:15", "outside the job's directory"],
        ),
        case(
            "job: output is the program",
            j("\"out.ngc\"", "\"part.ngc\""),
            &RUN,
            1,
            &["same file as the input", "part.ngc"],
        ),
        case(
            "job: output is the job",
            j("\"out.ngc\"", "\"bad.toml\""),
            &RUN,
            1,
            &["same file as the input", "bad.toml"],
        ),
        case(
            "job: two outputs in one file",
            j("[output]\n", "[output]\nreport = \"./out.ngc\"\n"),
            &RUN,
            1,
            &["goes there too"],
        ),
        case(
            "job: output directory missing",
            j("\"out.ngc\"", "\"no/out.ngc\""),
            &RUN,
            1,
            &["no", "does not exist", "create it"],
        ),
        case(
            "job: deviation of no limb",
            j(
                "[placement]",
                "[[deviation]]\nlimb = \"leg w\"\nat = \"line\"\nmoved_by = { translation_mm = [1, 0, 0] }\n\n[placement]",
            ),
            &RUN,
            1,
            &["bad.toml:5", "leg w", "leg x"],
        ),
        case(
            "job: unnamed rotation",
            j(
                "[tool]",
                "part_orientation = { rpy_deg = [0, 0, 1] }\n[tool]",
            ),
            &RUN,
            1,
            &["bad.toml:8", "rpy_deg"],
        ),
        case(
            "job: rotation given twice",
            j(
                "[tool]",
                "part_orientation = { a_b_c_kuka_deg = [0, 0, 1], x_axis = \"y\" }\n[tool]",
            ),
            &RUN,
            1,
            &["bad.toml:8", "twice"],
        ),
        case(
            "job: no tolerance",
            j("[output]", "[tolerances]\npath_um = 0\n\n[output]"),
            &RUN,
            1,
            &["tolerance", "0.001"],
        ),
        case(
            "job: decimals",
            j("[output]", "[tolerances]\ndecimals = 1\n\n[output]"),
            &RUN,
            1,
            &["decimals", "3 to 8"],
        ),
        case(
            "job: unknown word",
            j("[output]", "[reading]\nunits = \"cm\"\n\n[output]"),
            &RUN,
            1,
            &["bad.toml:15", "cm", "mm, inch"],
        ),
        case(
            "job: unknown offset",
            j(
                "[output]",
                "[reading]\nwork_offset_mm = { G53 = [0, 0, 0] }\n\n[output]",
            ),
            &RUN,
            1,
            &["bad.toml:15", "G53", "G54"],
        ),
        case(
            "job: missing",
            vec![],
            &["compensate", "gone.toml"],
            1,
            &["gone.toml", "does not exist"],
        ),
        case(
            "job: directory",
            vec![],
            &["compensate", "."],
            1,
            &["directory"],
        ),
        case(
            "job: nothing in it",
            vec![("bad.toml", b"\n \n".to_vec())],
            &RUN,
            1,
            &["empty"],
        ),
        case(
            "job: binary",
            vec![("bad.toml", vec![1, 0, 2])],
            &RUN,
            1,
            &["binary"],
        ),
    ]
}

const CUT: [&str; 4] = ["compensate", "job.toml", "--program", "bad.ngc"];

fn programs() -> Vec<Case> {
    let p = |text: &str| vec![("bad.ngc", text.as_bytes().to_vec())];
    let changed = |from: &str, to: &str| vec![("bad.ngc", changed(PROGRAM, from, to))];
    vec![
        case(
            "program: no units",
            changed("G21 ", ""),
            &CUT,
            1,
            &["bad.ngc", "line 2", "units", "G21"],
        ),
        case(
            "program: tool radius compensation",
            changed("G1 Z-1", "G41 D1\nG1 Z-1"),
            &CUT,
            1,
            &["bad.ngc", "line 3", "G41"],
        ),
        case(
            "program: canned cycle",
            changed("G1 Z-1 F300", "G81 Z-1 R2 F300"),
            &CUT,
            1,
            &["bad.ngc", "line 3", "G81"],
        ),
        case(
            "program: an arc that is none",
            changed("I0 J-20", "I0 J-21"),
            &CUT,
            1,
            &["bad.ngc", "line 5", "radius", "arc"],
        ),
        case(
            "program: subroutine",
            changed("M2", "M98 P100\nM2"),
            &CUT,
            1,
            &["bad.ngc", "line 7", "M98"],
        ),
        case(
            "program: variable",
            changed("X20", "X#1"),
            &CUT,
            1,
            &["bad.ngc", "line 2", "#1"],
        ),
        case(
            "program: comma for a point",
            changed("X20", "X20,5"),
            &CUT,
            1,
            &["bad.ngc", "line 2"],
        ),
        case(
            "program: two points",
            changed("X20", "X2.0.5"),
            &CUT,
            1,
            &["bad.ngc", "line 2"],
        ),
        case(
            "program: open comment",
            changed("M2", "M2 (end"),
            &CUT,
            1,
            &["bad.ngc", "line 7", "comment"],
        ),
        case(
            "program: escape codes in a comment",
            changed("M2", "M98 (\u{1b}[2J\u{7})\nM2"),
            &CUT,
            1,
            &["bad.ngc", "line 7"],
        ),
        case(
            "program: nothing in it",
            p(""),
            &CUT,
            1,
            &["bad.ngc", "empty"],
        ),
        case(
            "program: binary",
            vec![("bad.ngc", vec![0, 1, 2, 3])],
            &CUT,
            1,
            &["bad.ngc", "line 1"],
        ),
        case(
            "program: UTF-16",
            vec![("bad.ngc", vec![0xff, 0xfe, b'G', 0])],
            &CUT,
            1,
            &["bad.ngc", "UTF-16"],
        ),
        case(
            "program: no motion",
            p("G21 G90\nM2\n"),
            &CUT,
            1,
            &["bad.ngc", "no motion"],
        ),
        case(
            "program: directory",
            vec![],
            &["compensate", "job.toml", "--program", "."],
            1,
            &["directory"],
        ),
        case(
            "program: compensated already",
            vec![(
                "bad.ngc",
                format!("(kinetostat: compensated program)\n{PROGRAM}").into_bytes(),
            )],
            &CUT,
            1,
            &["bad.ngc", "line 1", "compensated already"],
        ),
        case(
            "program: out of reach",
            changed("G0 Z5\n", "G0 Z5\nG1 Y900\n"),
            &CUT,
            2,
            &["bad.ngc", "line 7", "leg"],
        ),
        case(
            "program: beyond the map",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n10,0,0,0,0,0\n".to_vec(),
            )],
            &[
                "compensate",
                "--map",
                "map.csv",
                "--program",
                "part.ngc",
                "--out",
                "o.ngc",
            ],
            2,
            &["part.ngc", "line 2", "outside the map"],
        ),
        case(
            "map: a column too few",
            vec![(
                "map.csv",
                b"x_mm,y_mm,z_mm,dx_mm,dy_mm\n0,0,0,0,0\n".to_vec(),
            )],
            &[
                "compensate",
                "--map",
                "map.csv",
                "--program",
                "part.ngc",
                "--out",
                "o.ngc",
            ],
            1,
            &["map.csv", "dz_mm"],
        ),
    ]
}

fn command_lines() -> Vec<Case> {
    let c =
        |name, arguments: &[&'static str], code, words| case(name, vec![], arguments, code, words);
    vec![
        c("line: unknown option", &["demo", "--fast"], 1, &["--fast"]),
        c(
            "line: unknown command",
            &["compensat"],
            1,
            &["compensat", "compensate"],
        ),
        c(
            "line: value missing",
            &["compensate", "job.toml", "--out"],
            1,
            &["--out"],
        ),
        c(
            "line: two numbers for three",
            &["stiffness", "orthoglide", "--at", "1", "2"],
            1,
            &["--at"],
        ),
        c(
            "line: no number",
            &["stiffness", "orthoglide", "--at", "1", "2", "z"],
            1,
            &["'z'", "number"],
        ),
        c(
            "line: commas",
            &["stiffness", "orthoglide", "--at", "1,2,3", "0", "0"],
            1,
            &["comma"],
        ),
        c(
            "line: not a number",
            &[
                "deflect", "two_link", "--at", "1", "2", "3", "--force", "nan", "0", "0",
            ],
            1,
            &["finite"],
        ),
        c(
            "line: no threads",
            &["compensate", "job.toml", "--threads", "0"],
            1,
            &["--threads 0"],
        ),
        c(
            "line: half a thread",
            &["compensate", "job.toml", "--threads", "1.5"],
            1,
            &["whole number"],
        ),
        c(
            "line: nothing named",
            &["compensate"],
            1,
            &["no program is named", "--program"],
        ),
        c(
            "line: program without model",
            &["compensate", "--program", "part.ngc"],
            1,
            &["no model is named"],
        ),
        c(
            "line: unnamed rotation",
            &[
                "deflect",
                "orthoglide",
                "--at",
                "0",
                "0",
                "0",
                "--rotation",
                "0,0,90",
            ],
            1,
            &["convention", "a_b_c_kuka_deg"],
        ),
        c(
            "line: unknown rotation",
            &[
                "deflect",
                "orthoglide",
                "--at",
                "0",
                "0",
                "0",
                "--rotation",
                "a_b_c_kuka=0,0,90",
            ],
            1,
            &["did you mean 'a_b_c_kuka_deg'?"],
        ),
        c(
            "line: four angles",
            &[
                "compensate",
                "job.toml",
                "--part-orientation",
                "a_b_c_kuka_deg=0,0,90,1",
            ],
            1,
            &["3 numbers"],
        ),
        c(
            "line: work offset",
            &["compensate", "job.toml", "--work-offset", "G54=1,2"],
            1,
            &["G54=1,2", "G54=10,0,-5"],
        ),
        c(
            "line: no scale",
            &["compensate", "job.toml", "--scale", "0"],
            1,
            &["--scale", "above zero"],
        ),
        c(
            "line: two loads",
            &[
                "compensate",
                "job.toml",
                "--milling",
                "1",
                "2",
                "3",
                "--force",
                "1",
                "2",
                "3",
            ],
            1,
            &["--milling"],
        ),
        c(
            "line: map and model",
            &["compensate", "--map", "m.csv", "--model", "two_link"],
            1,
            &["--map", "--model"],
        ),
        c(
            "line: report of a map",
            &[
                "compensate",
                "--map",
                "job.toml",
                "--program",
                "part.ngc",
                "--report",
                "r.html",
            ],
            1,
            &["--map", "--report"],
        ),
        c(
            "line: report of a place",
            &[
                "deflect",
                "orthoglide",
                "--at",
                "0",
                "0",
                "0",
                "--report",
                "r.html",
            ],
            1,
            &["--report", "--program"],
        ),
        c(
            "line: place out of reach",
            &["deflect", "orthoglide", "--at", "0", "0", "900"],
            2,
            &["reached"],
        ),
        c(
            "line: place beyond the limits",
            &["stiffness", "orthoglide", "--at", "-100", "0", "0"],
            2,
            &["leg x.slider", "-430 .. -160 mm"],
        ),
        c(
            "line: program onto itself",
            &[
                "compensate",
                "job.toml",
                "--out",
                "./part.ngc",
                "--force-overwrite",
            ],
            1,
            &["same file as the input", "never overwritten"],
        ),
        c(
            "line: report onto the model",
            &[
                "compensate",
                "job.toml",
                "--model",
                "model.toml",
                "--report",
                "model.toml",
                "--force-overwrite",
            ],
            1,
            &["same file as the input"],
        ),
        c(
            "line: output exists",
            &["compensate", "job.toml", "--out", "model.toml"],
            1,
            &["exists already", "--force-overwrite"],
        ),
        c(
            "line: output is a directory",
            &["compensate", "job.toml", "--out", "."],
            1,
            &["file"],
        ),
        c(
            "line: output is a device",
            &["compensate", "job.toml", "--out", "/dev/full"],
            1,
            &["device", "/dev/full"],
        ),
        c(
            "line: output below a file",
            &["compensate", "job.toml", "--out", "part.ngc/out.ngc"],
            1,
            &["part.ngc", "not a directory"],
        ),
        c(
            "line: output directory missing",
            &["compensate", "job.toml", "--out", "no/out.ngc"],
            1,
            &["does not exist", "create it"],
        ),
        c(
            "line: copy onto itself",
            &[
                "compensate",
                "--no-compensation",
                "--program",
                "part.ngc",
                "--out",
                "part.ngc",
            ],
            1,
            &["same file as the input"],
        ),
        c(
            "line: demo below a file",
            &["demo", "--out", "part.ngc"],
            1,
            &["part.ngc", "--out"],
        ),
        c(
            "line: demo nowhere",
            &["demo", "--out", "no/where"],
            1,
            &["does not exist"],
        ),
        c(
            "line: pages nowhere",
            &["man", "--out", "no"],
            1,
            &["does not exist"],
        ),
        c(
            "line: unknown shell",
            &["completions", "cmd"],
            1,
            &["cmd", "bash"],
        ),
    ]
}

#[test]
fn wrong_models() {
    assert!(all(models()) >= 20);
}

#[test]
fn wrong_jobs() {
    assert!(all(jobs()) >= 30);
}

#[test]
fn wrong_programs() {
    assert!(all(programs()) >= 18);
}

#[test]
fn wrong_command_lines() {
    assert!(all(command_lines()) >= 30);
}

/// The files of a directory apart from its clock: nothing new, nothing changed.
#[track_caller]
fn unchanged(directory: &Path, line: &str, words: &[&str]) {
    let before = contents(directory);
    let said = shell(directory, line);
    assert_eq!(said.code, 1, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "'{word}' is not in\n{}", said.err);
    }
    assert!(!said.err.contains("panicked"), "{}", said.err);
    assert_eq!(contents(directory), before);
}

#[test]
#[cfg(unix)]
fn a_disk_that_is_full() {
    let here = workplace();
    // The result on a full device.
    let said = shell(here.path(), "$K check orthoglide > /dev/full");
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("disk is full"), "{}", said.err);
    let said = shell(here.path(), "$K deflect job.toml --json > /dev/full");
    assert_eq!(said.code, 1, "{said:?}");

    // A file that may not grow behaves like a full disk and needs no rights to set up. The
    // program fits, the report and the table do not: none of them is put in place.
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; $K compensate job.toml --points p.csv --report r.html",
        &["cannot be written", "no output was changed"],
    );
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; exec $K demo",
        &["cannot be written", "no output was changed"],
    );
    // The same where old files are to be replaced.
    std::fs::write(here.path().join("out.ngc"), "old").unwrap();
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; $K compensate job.toml --points p.csv --force-overwrite",
        &["no output was changed"],
    );
}

#[test]
#[cfg(unix)]
fn a_real_full_disk_if_one_can_be_made() {
    let here = workplace();
    std::fs::create_dir(here.path().join("small")).unwrap();
    let line = "unshare -rm sh -c 'mount -t tmpfs -o size=64k none small && cp part.ngc small/ && \
                sed s/orthoglide/orthoglide/ job.toml > small/job.toml && cd small && \
                $K compensate job.toml --points p.csv --report r.html; echo code $?; ls -A'";
    let said = shell(here.path(), line);
    if !said.out.contains("code") {
        eprintln!("skipped: no file system can be mounted here: {}", said.err);
        return;
    }
    assert!(said.err.contains("disk is full"), "{said:?}");
    assert!(said.out.contains("code 1"), "{said:?}");
    let left: Vec<&str> = said.out.lines().skip(1).collect();
    assert_eq!(left, ["job.toml", "part.ngc"], "{said:?}");
}

#[test]
#[cfg(unix)]
fn a_directory_without_the_right_to_write() {
    use std::os::unix::fs::PermissionsExt;
    let here = workplace();
    let locked = here.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o555)).unwrap();
    let root = std::fs::write(locked.join("try"), "x").is_ok();
    if root {
        // Root may write anywhere but not into the process table.
        std::fs::remove_file(locked.join("try")).unwrap();
        let said = shell(here.path(), "$K compensate job.toml --out /proc/out.ngc");
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("/proc/out.ngc"), "{}", said.err);
    } else {
        unchanged(
            here.path(),
            "$K compensate job.toml --out locked/out.ngc",
            &["may not write"],
        );
    }
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
#[cfg(unix)]
fn links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let here = workplace();
    let elsewhere = tempfile::tempdir().unwrap();
    let path = |name: &str| here.path().join(name);
    // An output that is a link, even with leave to overwrite.
    std::fs::write(elsewhere.path().join("victim"), "mine").unwrap();
    symlink(elsewhere.path().join("victim"), path("out.ngc")).unwrap();
    unchanged(here.path(), "$K compensate job.toml", &["symbolic link"]);
    unchanged(
        here.path(),
        "$K compensate job.toml --force-overwrite",
        &["symbolic link"],
    );
    std::fs::remove_file(path("out.ngc")).unwrap();
    // A link that points nowhere.
    symlink(elsewhere.path().join("new"), path("out.ngc")).unwrap();
    unchanged(here.path(), "$K compensate job.toml", &["symbolic link"]);
    assert!(!elsewhere.path().join("new").exists());
    std::fs::remove_file(path("out.ngc")).unwrap();
    // A job whose output directory leads out of its own.
    symlink(elsewhere.path(), path("sub")).unwrap();
    std::fs::write(path("leads.toml"), JOB.replace("out.ngc", "sub/out.ngc")).unwrap();
    unchanged(
        here.path(),
        "$K compensate leads.toml",
        &["outside the job's directory"],
    );
    // Another name of an input.
    std::fs::hard_link(path("part.ngc"), path("other.ngc")).unwrap();
    unchanged(
        here.path(),
        "$K compensate job.toml --out other.ngc --force-overwrite",
        &["same file as the input"],
    );
    assert_eq!(
        std::fs::read(elsewhere.path().join("victim")).unwrap(),
        b"mine"
    );
}

#[test]
fn colour_only_where_it_is_wanted() {
    let here = workplace();
    let plain = shell(here.path(), "$K check missing.toml");
    assert!(!plain.err.contains('\u{1b}'), "{}", plain.err);
    let forced = shell(here.path(), "CLICOLOR_FORCE=1 $K check missing.toml");
    assert!(forced.err.contains('\u{1b}'), "{}", forced.err);
    let refused = shell(here.path(), "NO_COLOR=1 $K check missing.toml");
    assert!(!refused.err.contains('\u{1b}'), "{}", refused.err);
}
