//! Inputs of all commands: positional or by an option, recognised by content, from a file or from standard input.

use std::fs::File;
use std::path::Path;

use serde_json::Value;

use crate::common::{MODEL, Said, command, run, workplace};

/// A line for each command with a positional input; `@` stands for the input, and the second word is its option.
const LINES: [(&str, &str, &str); 29] = [
    (
        "compensate @ --out w.ngc --force-overwrite",
        "--job",
        "job.toml",
    ),
    (
        "compensate @ --model orthoglide --out w.ngc --force-overwrite --part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 -25",
        "--program",
        "part.ngc",
    ),
    (
        "compensate @ --program part.ngc --out w.ngc --force-overwrite --part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 -25",
        "--model",
        "orthoglide.toml",
    ),
    ("deflect @", "--job", "job.toml"),
    (
        "deflect @ --at 0 0 0 --force 1 0 0",
        "--model",
        "orthoglide.toml",
    ),
    ("verify @ --job job.toml", "--program", "part.ngc"),
    ("verify part.ngc @", "--job", "job.toml"),
    ("stiffness @ --at 0 0 0", "--model", "orthoglide.toml"),
    (
        "shares @ --at 0 0 0 --direction x",
        "--model",
        "orthoglide.toml",
    ),
    ("modes @", "--model", "heavy.toml"),
    (
        "frf @ --damping 0.03 --frequencies 5 80 20",
        "--model",
        "heavy.toml",
    ),
    (
        "lobes @ --damping 0.03 --rpm 1000 6000 8 --teeth 2 --coefficients-n-per-mm2 800 240 0",
        "--model",
        "heavy.toml",
    ),
    ("chatter @ --damping 0.03", "--job", "job.toml"),
    (
        "map @ --x -100 100 3 --y -100 100 3",
        "--model",
        "orthoglide.toml",
    ),
    (
        "mirror @ --measured part.ngc --register none --out n.ngc",
        "--program",
        "part.ngc",
    ),
    ("place @ --x-mm -20 20 --samples 4", "--job", "job.toml"),
    (
        "tolerance @ --uncertain none.toml --at 0 0 0 --force 1 0 0",
        "--model",
        "orthoglide.toml",
    ),
    (
        "assemble @ --deviation *:line:1deg_about_x --at 0 0 0",
        "--model",
        "orthoglide.toml",
    ),
    (
        "curve @ --direction -1 0 0 --displacement-mm 0 40",
        "--model",
        "chain.toml",
    ),
    ("identify @ --measured pulls.csv", "--model", "heavy.toml"),
    (
        "plan-measurement @ --mass-kg 100 --count 4 --candidates 8",
        "--model",
        "heavy.toml",
    ),
    ("equilibria @ --starts 8", "--model", "chain.toml"),
    ("engagement @", "--job", "cut.toml"),
    ("expand @", "--program", "part.ngc"),
    (
        "convert @ --to apt --out w.apt --force-overwrite --tool-orientation a_b_c_kuka_deg=0,0,0",
        "--program",
        "part.ngc",
    ),
    ("check @", "--job", "job.toml"),
    ("check @", "--model", "orthoglide.toml"),
    ("model draw @", "--model", "orthoglide.toml"),
    (
        "view @ --export page.html --force-overwrite",
        "--model",
        "orthoglide.toml",
    ),
];

/// Commands with two models, which a test of their own calls.
const OF_TWO_MODELS: [&str; 2] = ["compare", "model compare"];

fn place() -> tempfile::TempDir {
    let here = workplace();
    for (preset, file) in [
        ("orthoglide", "orthoglide.toml"),
        ("heavy_6r", "heavy.toml"),
        ("three_link_z", "chain.toml"),
    ] {
        let shown = run(here.path(), &["model", "show", preset]).answered();
        std::fs::write(here.path().join(file), shown.out).expect("a model");
    }
    let job = "schema = 1\nprogram = \"part.ngc\"\n[tool]\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2 }\n[material]\nname = \"C45\"\n[stock]\nblock_mm = [[-30, -30, -5], [30, 30, 0]]\n[spindle]\nrpm = 8000\nrotation = \"clockwise\"\n";
    std::fs::write(here.path().join("cut.toml"), job).expect("a job");
    let pulls = crate::every_option::PULLS;
    std::fs::write(here.path().join("pulls.csv"), pulls).expect("a table");
    here
}

fn words<'a>(line: &'a str, input: &[&'a str]) -> Vec<&'a str> {
    let words = line.split(' ');
    words
        .flat_map(|word| match word {
            "@" => input.to_vec(),
            word => vec![word],
        })
        .collect()
}

/// Runs a command whose standard input is a file.
fn fed(here: &Path, words: &[&str], file: &str) -> Said {
    let input = File::open(here.join(file)).expect("an input");
    let output = command(here).args(words).stdin(input).output();
    Said::of(output.expect("the command starts"))
}

#[test]
fn an_input_is_positional_or_an_option_or_standard_input() {
    let here = place();
    let here = here.path();
    for (line, option, file) in LINES {
        let positional = run(here, &words(line, &[file]));
        let joined = format!("{option}={file}");
        for input in [vec![option, file], vec![joined.as_str()]] {
            let said = run(here, &words(line, &input));
            assert_eq!(said.code, positional.code, "{line} {input:?}: {said:?}");
            assert_eq!(said.out, positional.out, "{line} {input:?}");
            assert_eq!(said.err, positional.err, "{line} {input:?}");
        }
        for input in [vec!["-"], vec![option, "-"]] {
            let said = fed(here, &words(line, &input), file);
            assert_eq!(said.code, positional.code, "{line} {input:?}: {said:?}");
            assert_eq!(
                said.out.lines().count() > 1,
                positional.out.lines().count() > 1,
                "{line} {input:?}: {said:?}"
            );
        }
        let twice = run(here, &words(line, &[file, option, file]));
        assert_eq!(twice.code, 1, "{line}: {twice:?}");
        let said = twice.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains("are given, and the command takes one"),
            "{line}: {said}"
        );
    }
}

#[test]
fn every_command_with_an_input_is_tested() {
    fn collect(of: &clap::Command, path: &str, found: &mut Vec<String>) {
        let is_input = |argument: &clap::Arg| {
            let names = argument.get_value_names().unwrap_or_default();
            let mut names = names.iter().flat_map(|name| name.split('|'));
            names.any(|name| ["MODEL", "JOB", "PROGRAM", "A"].contains(&name))
        };
        if of.get_positionals().any(is_input) {
            found.push(path.trim_start().to_owned());
        }
        for inner in of.get_subcommands() {
            collect(inner, &format!("{path} {}", inner.get_name()), found);
        }
    }
    let mut found = Vec::new();
    collect(&kinetostat_cli::command(), "", &mut found);
    for command in &found {
        let mut lines = LINES.iter().map(|(line, ..)| line);
        let is_called = lines.any(|line| line.starts_with(&format!("{command} ")));
        assert!(
            is_called || OF_TWO_MODELS.contains(&command.as_str()),
            "{command}"
        );
    }
}

#[test]
fn inputs_are_taken_in_any_order_and_two_models_keep_theirs() {
    let here = place();
    let here = here.path();
    let said = |line: &str| {
        run(here, &line.split(' ').collect::<Vec<_>>())
            .answered()
            .out
    };
    let load = "--part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 -25 --out w.ngc --force-overwrite";
    let expected = said(&format!(
        "compensate --model orthoglide --program part.ngc {load}"
    ));
    for inputs in [
        "orthoglide part.ngc",
        "part.ngc orthoglide",
        "part.ngc --model orthoglide",
    ] {
        assert_eq!(
            said(&format!("compensate {inputs} {load}")),
            expected,
            "{inputs}"
        );
    }
    assert_eq!(
        said("verify job.toml w.ngc"),
        said("verify w.ngc --job job.toml")
    );
    for command in OF_TWO_MODELS {
        let expected = said(&format!("{command} orthoglide tripteron"));
        for inputs in [
            "--model orthoglide --model tripteron",
            "orthoglide --model tripteron",
            "--model orthoglide tripteron",
        ] {
            assert_eq!(
                said(&format!("{command} {inputs}")),
                expected,
                "{command} {inputs}"
            );
        }
    }
}

#[test]
fn a_file_of_another_kind_is_named_with_the_command_that_takes_it() {
    let here = place();
    let here = here.path();
    let put = |name: &str, bytes: &[u8]| std::fs::write(here.join(name), bytes).expect("a file");
    put(
        "r.urdf",
        b"<?xml version=\"1.0\"?>\n<robot name=\"r\"><link name=\"a\"/></robot>\n",
    );
    put("data.xml", b"<data/>\n");
    put(
        "table.csv",
        b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n",
    );
    put("binary", b"\x00\x01\x02\xff\x00");
    put("columns.bin", b"PAR1\xff\xfe\x01\x02PAR1");
    for command in [
        "compensate",
        "deflect",
        "check",
        "stiffness",
        "chatter",
        "place",
        "expand",
    ] {
        for (file, needles) in [
            (
                "r.urdf",
                [
                    "'r.urdf' is a robot in URDF",
                    "kinetostat import urdf r.urdf",
                ],
            ),
            (
                "data.xml",
                ["'data.xml' is a file in XML", "no command reads it"],
            ),
            (
                "table.csv",
                ["'table.csv' is a table (CSV)", "--map table.csv"],
            ),
            (
                "columns.bin",
                [
                    "'columns.bin' is a table (Parquet)",
                    "--program columns.bin",
                ],
            ),
            ("binary", ["binary", "text"]),
            (".", ["directory", "name"]),
        ] {
            // `expand` reads a table as a program, and refuses its columns one by one.
            if command == "expand" && ["table.csv", "columns.bin"].contains(&file) {
                continue;
            }
            let said = run(here, &[command, file]);
            assert_eq!(said.code, 1, "{command} {file}: {said:?}");
            let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
            for needle in needles {
                assert!(
                    text.contains(needle) || file == "binary" && text.contains("TOML"),
                    "{command} {file}: {text}"
                );
            }
        }
    }
    let said = run(here, &["stiffness", "r.urdf", "--json"]);
    let report: Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(report["errors"][0]["code"], "file_form");
}

#[test]
fn standard_input_is_read_once_bounded_and_named() {
    let here = place();
    let here = here.path();
    for line in [
        "compensate --model - --program -",
        "engagement - --job -",
        "verify - --job=-",
    ] {
        let mut words: Vec<&str> = line.split(' ').collect();
        words.push("--json");
        let said = fed(here, &words, "job.toml");
        assert_eq!(said.code, 1, "{line}: {said:?}");
        let report: Value = serde_json::from_str(&said.out).expect("JSON");
        assert_eq!(report["errors"][0]["code"], "conflict", "{line}: {said:?}");
    }
    std::fs::write(here.join("long"), " ".repeat((16 << 20) + 1)).expect("a file");
    std::fs::write(here.join("empty"), "").expect("a file");
    std::fs::write(here.join("wrong.toml"), MODEL.replace("= 70", "= -70")).expect("a model");
    let module = "MODULE part\nPROC main()\nENDPROC\nENDMODULE\n";
    std::fs::write(here.join("part.mod"), module).expect("a program");
    for (line, file, needle) in [
        ("check -", "long", "'standard input' is larger than 16 MB"),
        (
            "compensate --job -",
            "long",
            "'standard input' is larger than 1 MB",
        ),
        ("compensate -", "empty", "'standard input' is empty"),
        ("stiffness -", "wrong.toml", "standard input:14:22"),
        ("stiffness -", "part.ngc", "--program -"),
        ("expand -", "job.toml", "'standard input' is a job file"),
        (
            "compensate - --model orthoglide --part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 -25",
            "part.ngc",
            "name it by its option, such as --out FILE",
        ),
        (
            "compensate - --model heavy_6r --out w.mod",
            "part.mod",
            "RAPID",
        ),
    ] {
        let said = fed(here, &line.split(' ').collect::<Vec<_>>(), file);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(needle), "{line}: {text}");
    }
    // Without `-`, the name is that of a file.
    let said = run(here, &["check", "standard input"]);
    assert_eq!(said.code, 1, "{said:?}");
}

#[test]
fn an_input_behind_an_open_option_is_no_value_of_it() {
    let here = place();
    let here = here.path();
    let said = |line: &str| {
        run(here, &line.split(' ').collect::<Vec<_>>())
            .answered()
            .out
    };
    assert_eq!(
        said("stiffness --at 0 0 0 --json orthoglide.toml"),
        said("stiffness orthoglide.toml --at 0 0 0 --json"),
    );
    let model = std::fs::read(here.join("orthoglide.toml")).expect("the model");
    assert_eq!(
        said("deflect --at 0 0 0 --force 1 0 0 --force-overwrite --json orthoglide.toml"),
        said("deflect orthoglide.toml --at 0 0 0 --force 1 0 0 --json -"),
    );
    let left = std::fs::read(here.join("orthoglide.toml")).expect("the model");
    assert!(model == left, "an input was overwritten");
    assert_eq!(
        said("frf --frequencies 5 80 20 --damping 0.03 heavy.toml"),
        said("frf heavy.toml --frequencies 5 80 20 --damping 0.03"),
    );
}

#[test]
fn what_is_too_many_or_missing_is_named() {
    let here = place();
    let here = here.path();
    let job = std::fs::read_to_string(here.join("job.toml")).expect("the job");
    let wrong = job.replace("schema = 1", "schema = 1,5");
    std::fs::write(here.join("wrong.toml"), wrong).expect("a job");
    for (line, code, needle) in [
        (
            "stiffness chain.toml orthoglide.toml",
            "conflict",
            "takes one model",
        ),
        ("verify part.ngc part.ngc", "conflict", "takes one program"),
        (
            "deflect nosuch.ngc orthoglide.toml",
            "file_not_read",
            "'nosuch.ngc' does not exist",
        ),
        (
            "deflect orthoglide.toml nosuch.ngc",
            "file_not_read",
            "'nosuch.ngc' does not exist",
        ),
        ("engagement wrong.toml", "job_file", "wrong.toml:"),
        ("verify part.ngc wrong.toml", "job_file", "wrong.toml:"),
    ] {
        let mut words: Vec<&str> = line.split(' ').collect();
        words.push("--json");
        let said = run(here, &words);
        let report: Value = serde_json::from_str(&said.out).expect(line);
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(report["errors"][0]["code"], code, "{line}: {text}");
        assert!(text.contains(needle), "{line}: {text}");
    }
    // Points in a table come from standard input as well.
    let points = "line,axis,error_mm\n3,x,0.1\n";
    std::fs::write(here.join("points.csv"), points).expect("points");
    let line = [
        "mirror",
        "part.ngc",
        "--measured",
        "-",
        "--register",
        "none",
        "--out",
        "n.ngc",
    ];
    let piped = fed(here, &line, "points.csv");
    let named = run(
        here,
        &line.map(|word| if word == "-" { "points.csv" } else { word }),
    );
    assert_eq!(piped.code, named.code, "{piped:?}");
    let kind = "and a program is needed";
    assert_eq!(
        piped.err.contains(kind),
        named.err.contains(kind),
        "{piped:?}"
    );
}
