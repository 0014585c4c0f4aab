//! `--expand` and `[expand]`: commands that go on with the flat form of a program, and the lines that they name.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::{JOB, contents, run};

/// Two slots by a subprogram file, a loop, a parameter and a cycle.
const MACRO: &str = "G21 G90 G17\n(two slots)\n#1 = 0\nG0 X20 Y0 Z5\nO1 while [#1 LT 2]\nO<slot> call [-10 * #1] [#100]\n#1 = [#1 + 1]\nO1 endwhile\nG99 G81 X5 Y5 Z-#100 R1 F200\nG80\nG0 Z5\nM2\n";

/// The second line is a feed move, the third an arc.
const SLOT: &str = "O<slot> sub\nG0 X20 Y[#1]\nG1 Z-#2 F300\nG1 X0 Y20 F600\nG3 X-20 Y0 I0 J-20\nG0 Z5\nO<slot> endsub\n";

const WITH: &str = "--subprograms macros --parameter 100=1";

const TABLE: &str = "\n[expand]\nsubprograms = [\"macros\"]\nparameters = { 100 = 1 }\n";

fn place() -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("part.ngc", MACRO);
    put("job.toml", JOB);
    std::fs::create_dir(here.path().join("macros")).unwrap();
    put("macros/slot.ngc", SLOT);
    here
}

fn put(here: &Path, name: &str, text: &str) {
    std::fs::write(here.join(name), text).unwrap();
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

#[test]
fn the_result_is_that_of_expand_and_then_compensate() {
    let here = place();
    let here = here.path();
    let line = format!("expand part.ngc {WITH} --out flat.ngc");
    run(here, &words(&line)).answered();
    let line = "compensate job.toml --program flat.ngc --out two.ngc --points two.csv";
    run(here, &words(line)).answered();
    let line = format!("compensate job.toml --expand {WITH} --out one.ngc --points one.csv");
    let said = run(here, &words(&line)).answered();
    assert_eq!(read(here, "one.ngc"), read(here, "two.ngc"));
    assert_eq!(read(here, "part-flat.ngc"), read(here, "flat.ngc"));
    assert!(said.out.contains("part-flat.ngc"), "{said:?}");
    // The table is the same, too, with two columns more: every line is found in its file.
    let (one, two) = (read(here, "one.csv"), read(here, "two.csv"));
    let sources = [MACRO, SLOT].map(|text| text.lines().collect::<Vec<_>>());
    let flat = read(here, "flat.ngc");
    let flat: Vec<&str> = flat.lines().collect();
    let mut in_the_subprogram = 0;
    assert_eq!(one.lines().count(), two.lines().count());
    for (one, two) in one.lines().zip(two.lines()).skip(1) {
        let rest = one.strip_prefix(two).unwrap();
        let (line, file) = rest[1..].split_once(',').unwrap();
        let (line, is_slot): (usize, bool) = (line.parse().unwrap(), file == "slot.ngc");
        assert!(is_slot || file == "part.ngc", "{one}");
        in_the_subprogram += usize::from(is_slot);
        let source = sources[usize::from(is_slot)][line - 1];
        let flat_line: usize = one.split(',').next().unwrap().parse().unwrap();
        // The block in the flat program says the same line in its comment.
        let origin = match is_slot {
            true => format!("(slot, line {line})"),
            false => format!("(line {line})"),
        };
        assert!(flat[flat_line - 1].ends_with(&origin), "{one}");
        assert!(source.starts_with('G'), "{source}");
    }
    assert!(in_the_subprogram > 10, "{in_the_subprogram}");
}

#[test]
fn the_table_of_a_job_says_the_same() {
    let here = place();
    let here = here.path();
    let line = format!("compensate job.toml --expand {WITH} --out one.ngc");
    run(here, &words(&line)).answered();
    let job = JOB.replace("\"out.ngc\"\n", "\"two.ngc\"\nflat_program = \"two-flat.ngc\"\njson = \"two.json\"\nreport = \"two.html\"\n");
    put(here, "job.toml", &format!("{job}{TABLE}"));
    let said = run(here, &["check", "job.toml"]).answered();
    let as_one = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    let expected = "part.ngc with slot.ngc was run once and written flat, 20 blocks; lines are those of the flat program, two-flat.ngc.";
    assert!(as_one.contains(expected), "{said:?}");
    assert!(as_one.contains("flat program two-flat.ngc new"), "{said:?}");
    run(here, &["compensate", "job.toml"]).answered();
    assert_eq!(read(here, "one.ngc"), read(here, "two.ngc"));
    assert_eq!(read(here, "part-flat.ngc"), read(here, "two-flat.ngc"));
    // The inputs of the result are all files, with their hashes, and the settings.
    let result: Value = serde_json::from_str(&read(here, "two.json")).unwrap();
    let inputs = &result["question"];
    let files = inputs["files"].as_array().unwrap();
    let names = files.iter().map(|file| file["name"].as_str().unwrap());
    assert_eq!(
        names.collect::<Vec<_>>(),
        ["part.ngc", "slot.ngc", "preset orthoglide", "job.toml"]
    );
    assert_eq!(inputs["flat"]["name"], "two-flat.ngc");
    assert_eq!(inputs["flat"]["settings"][1], "parameters: #100 = 1");
    // Every point says the line that its line came from.
    let points = result["worst_points"].as_array().unwrap();
    assert!(!points.is_empty());
    for point in points {
        let known = point["source_line"].as_u64().unwrap() > 0;
        assert!(known && point["source_file"].is_string(), "{point}");
    }
    let report = read(here, "two.html");
    assert!(report.contains("run once and written flat, 20 blocks"));
    assert!(report.contains(" of slot.ngc</small>"));
    // Options go over the table.
    let line = "compensate job.toml --parameter 100=2 --no-comments --force-overwrite";
    run(here, &words(line)).answered();
    let flat = read(here, "two-flat.ngc");
    assert!(
        flat.contains("G1 Z-2 F300\n") && !flat.contains("line"),
        "{flat}"
    );
    // Another subprogram is another input.
    let before = inputs["files"][1]["sha256"].clone();
    put(here, "macros/slot.ngc", &SLOT.replace("F300", "F310"));
    run(here, &words("compensate job.toml --force-overwrite")).answered();
    let result: Value = serde_json::from_str(&read(here, "two.json")).unwrap();
    assert_ne!(result["question"]["files"][1]["sha256"], before);
}

#[test]
fn deflect_and_engagement_expand_as_well() {
    let here = place();
    let here = here.path();
    let line = format!("deflect job.toml --expand {WITH} --points points.csv --json");
    let said = run(here, &words(&line)).answered();
    let result: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(result["question"]["flat"]["blocks"], 20);
    assert!(read(here, "points.csv").contains(",slot.ngc"));
    // An analysis writes what is named, and no more.
    assert!(!here.join("part-flat.ngc").exists());
    let cut = "--material AlMg4.5Mn --tool flat --diameter-mm 6 --teeth 2 --helix-deg 30 --rpm 12000 --rotation clockwise --width-mm 2 --depth-mm 1 --part right";
    let line = format!(
        "engagement part.ngc --expand {WITH} {cut} --csv cut.csv --json cut.json --flat-program flat.ngc"
    );
    let said = run(here, &words(&line)).answered();
    assert!(said.out.contains("of slot.ngc"), "{said:?}");
    assert!(
        read(here, "cut.csv")
            .lines()
            .next()
            .unwrap()
            .ends_with(",source_line,source_file")
    );
    assert!(read(here, "flat.ngc").contains("(slot, line 3)"));
    let answer: Value = serde_json::from_str(&read(here, "cut.json")).unwrap();
    assert_eq!(answer["flat"]["files"][1], "slot.ngc");
    assert!(answer["cutting"]["worst_lines"][0]["source_file"].is_string());
    // A table of corrections goes through the same door.
    let grid = |x: i32| [-50, 50].map(|y| [-50, 50].map(|z| format!("{x},{y},{z},0,0,0.01\n")));
    let rows: String = [grid(-50), grid(50)].concat().concat().concat();
    put(
        here,
        "map.csv",
        &format!("x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n{rows}"),
    );
    let line = format!("compensate --map map.csv --program part.ngc --expand {WITH} --out map.ngc");
    run(here, &words(&line)).answered();
    assert!(here.join("part-flat.ngc").exists());
    let line =
        format!("compensate --no-compensation --program part.ngc --expand {WITH} --out copy.ngc");
    run(here, &words(&line)).answered();
    assert_eq!(read(here, "copy.ngc"), read(here, "part-flat.ngc"));
}

#[test]
fn without_expand_the_remedy_is_said_first() {
    let here = place();
    let here = here.path();
    let simple = "G21 G90\n#1 = 5\nG0 X0 Y0 Z#1\nG98 G81 X5 Y5 Z-1 R1 F200\nG80\nM2\n";
    for (program, needle) in [
        (
            simple,
            "error: part.ngc: add --expand (in a job file: a table [expand]): run once and written flat, it is 9 blocks that can be followed. As it stands:",
        ),
        // A cycle alone.
        (
            "G21 G90\nG0 X0 Y0 Z5\nG98 G81 X5 Y5 Z-1 R1 F200\nG80\nM2\n",
            "error: part.ngc: add --expand",
        ),
        // Controllers disagree where the tool goes behind the hole, and what holds behind G80.
        (
            "G21 G90\nG0 X0 Y0 Z5\nG81 X5 Y5 Z-1 R1 F200\nG80 G0 X9\nM2\n",
            "add --expand and --dialect fanuc or linuxcnc, as the control",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z5\nG98 G81 X5 Y5 Z-1 R1 F200\nG80\nX9\nM2\n",
            "add --expand and --dialect fanuc, as the control",
        ),
        // What the expansion refuses is said as well.
        (
            "G21 G90\n#1 = 5\nG0 X0 Y0 Z#1\nG5 X10 Y10 F100\nM2\n",
            "add --expand",
        ),
        // The subprogram lies in a folder that nobody named.
        (MACRO, "add --expand"),
    ] {
        put(here, "part.ngc", program);
        for command in ["compensate job.toml", "check job.toml", "deflect job.toml"] {
            let said = run(here, &words(command));
            assert_eq!(said.code, 1, "{command}: {said:?}");
            let as_one = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(as_one.contains(needle), "{command}: {needle}: {}", said.err);
        }
    }
    // What no expansion follows is not sent there.
    put(
        here,
        "part.ngc",
        "G21 G90\nG0 X0 Y0 Z5\nG5 X10 Y10 F100\nM2\n",
    );
    let said = run(here, &words("compensate job.toml"));
    assert!(said.code == 1 && !said.err.contains("--expand"), "{said:?}");
    assert!(!here.join("out.ngc").exists());
}

#[test]
fn a_fault_names_the_line_that_it_is_in() {
    let here = place();
    let here = here.path();
    let expand = |slot: &str| {
        put(here, "macros/slot.ngc", slot);
        run(
            here,
            &words(&format!("compensate job.toml --expand {WITH}")),
        )
    };
    // Refused while it is run, and refused as a flat block.
    for (from, to) in [
        ("G1 Z-#2 F300", "G1 Z-[#2 / 0] F300"),
        ("G1 Z-#2 F300", "G5.2 Z-#2 F300"),
    ] {
        let said = expand(&SLOT.replace(from, to));
        assert_eq!(said.code, 1, "{said:?}");
        let start = "error: part.ngc, in the subprogram: slot.ngc: line 3: `G";
        assert!(said.err.starts_with(start), "{said:?}");
    }
    let said = expand(&SLOT.replace("J-20", "J-25"));
    assert!(said.err.contains("slot.ngc: line 5: `G3"), "{said:?}");
    // Found along the flat program: both lines.
    let said = expand(&SLOT.replace("X0 Y20 F600", "X0 Y2000 F600\nG1 X0 Y20"));
    assert_eq!(said.code, 2, "{said:?}");
    let as_one = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        as_one.contains("line 4 of slot.ngc (line 6 of the flat program): no correction at X"),
        "{as_one}"
    );
    assert!(!here.join("out.ngc").exists() && !here.join("part-flat.ngc").exists());
}

#[test]
fn wrong_tables_and_options_are_refused_in_their_line() {
    let here = place();
    let here = here.path();
    put(here, "file", "");
    for (table, needle) in [
        ("subprograms = [\"nowhere\"]", "'nowhere' is no folder"),
        ("subprograms = [\"file\"]", "'file' is no folder"),
        ("subprograms = [\"\"]", "is no folder"),
        ("parameters = { x = 1 }", "'x' is no whole number"),
        ("parameters = { 1 = 1, 01 = 2 }", "the number 1 comes twice"),
        (
            "tool_diameters_mm = { 1 = 6500 }",
            "the value 6500 is not allowed here",
        ),
        (
            "tool_diameters_mm = { 1 = nan }",
            "this is no finite number",
        ),
        ("tool_diameters_mm = { -1 = 6 }", "'-1' is no whole number"),
        (
            "tool_diameter_mm = { 1 = 6 }",
            "unknown key 'tool_diameter_mm'",
        ),
    ] {
        put(here, "job.toml", &format!("{JOB}\n[expand]\n{table}\n"));
        let said = run(here, &words("compensate job.toml"));
        assert_eq!(said.code, 1, "{table}: {said:?}");
        assert!(said.err.contains(needle), "{table}: {needle}: {said:?}");
        assert!(said.err.contains("job.toml:18:"), "{table}: {said:?}");
    }
    let outside = |name: &str| {
        JOB.replace(
            "\"out.ngc\"\n",
            &format!("\"out.ngc\"\nflat_program = \"{name}\"\n"),
        )
    };
    put(
        here,
        "job.toml",
        &format!("{}{TABLE}", outside("../flat.ngc")),
    );
    let said = run(here, &words("compensate job.toml"));
    assert!(
        said.code == 1 && said.err.contains("outside the job's directory"),
        "{said:?}"
    );
    put(here, "job.toml", &outside("flat.ngc"));
    let said = run(here, &words("compensate job.toml"));
    assert!(
        said.err
            .contains("a flat program only where the program is expanded"),
        "{said:?}"
    );
    put(here, "job.toml", JOB);
    for (options, needle) in [
        (
            "--parameter 1=2",
            "--parameter says something about an expanded program",
        ),
        ("--flat-program a.ngc", "--flat-program says something"),
        (
            "--expand --subprograms nowhere",
            "--subprograms: 'nowhere' is no folder",
        ),
        (
            "--expand --tool-diameter-mm 1=1e9",
            "--tool-diameter-mm '1=1e9': a tool is at most",
        ),
        (
            "--expand --subprograms macros --parameter 100=1 --flat-program part.ngc --force-overwrite",
            "the same file as the input",
        ),
        (
            "--expand --subprograms macros --parameter 100=1 --out macros/slot.ngc --force-overwrite",
            "the same file as the input",
        ),
        (
            "--expand --subprograms macros --parameter 100=1 --flat-program out.ngc",
            "goes there too",
        ),
    ] {
        let said = run(here, &words(&format!("compensate job.toml {options}")));
        assert_eq!(said.code, 1, "{options}: {said:?}");
        assert!(said.err.contains(needle), "{options}: {needle}: {said:?}");
    }
    assert_eq!(contents(here).len(), 5);
    assert_eq!(read(here, "macros/slot.ngc"), SLOT);
}

/// A program of a control is written as it was read, or flat; why it could not be compensated is said.
#[test]
fn programs_of_controls_are_written_as_they_were_read() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    for (name, text, flat) in [
        (
            "a.h",
            "BEGIN PGM A MM\r\nFN 0: Q1 = +5\r\nL X+0 Y+0 Z+9 F200\r\nL X+Q1\r\nEND PGM A MM\r\n",
            "L X+5\r\n",
        ),
        (
            "a.mpf",
            "G90 G71\nG0 X0 Y0 Z9\nR1=2\nAA:\nG1 X=R1 F200\nR1=R1-1\nIF R1>0 GOTOB AA\nM30\n",
            "G1 X=2 F200\nG1 X=1 F200\nM30\n",
        ),
    ] {
        put(here, name, text);
        let line = format!(
            "compensate --no-compensation --program {name} --force-overwrite --out b{name}"
        );
        let said = run(here, &words(&line)).answered();
        assert!(
            said.out.contains("written as read, byte for byte"),
            "{said:?}"
        );
        assert!(
            said.out.contains("could not be compensated as it is"),
            "{said:?}"
        );
        assert_eq!(read(here, &format!("b{name}")), text);
        let said = run(here, &words(&format!("{line} --expand"))).answered();
        assert!(
            said.out.contains("written flat, without a correction"),
            "{said:?}"
        );
        let written = read(here, &format!("b{name}"));
        assert!(
            written.contains(flat) && !written.contains("R1"),
            "{written}"
        );
    }
}
