//! `compensate --to`: a program compensated in the language of a robot, and the turn of its tool.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::run;

const PART: &str = "G21 G90 (plate)\nS8000 M3\nG0 X0 Y0 Z5\nM8\nG1 Z-1 F300\nG1 X40 F600\nG3 X50 Y10 I0 J10\nG0 Z5\nM30\n";

const CELL: &str =
    "schema = 1\nrapid_speed_mm_per_s = 150\n[base]\nnumber = 3\n[tool]\nnumber = 2\n";

const JOB: &str = r#"schema = 1
model = "heavy_6r"
program = "part.ngc"
[placement]
part_origin_mm = [1300, 0, 800]
tool_orientation = { a_b_c_kuka_deg = [160, 0, 180] }
[tool]
pose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }
[load]
force_n = [60, 20, 100]
"#;

fn place(job: &str) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    for (name, text) in [("part.ngc", PART), ("cell.toml", CELL), ("job.toml", job)] {
        std::fs::write(here.path().join(name), text).unwrap();
    }
    here
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn one_command_converts_and_compensates() {
    for (to, ending, main, motion) in [
        ("krl", "src", "DEF part_compensated", "LIN {"),
        ("rapid", "mod", "MODULE part_compensated", "MoveL "),
        ("ls", "ls", "/PROG  PART_COMPENSATED", "L P["),
    ] {
        let here = place(JOB);
        let here = here.path();
        let line =
            format!("compensate job.toml --to {to} --template cell.toml --points points.csv");
        let said = run(here, &words(&line)).answered();
        let written = read(here, &format!("part_compensated.{ending}"));
        let flat = read(here, &format!("part_compensated_flat.{ending}"));
        assert!(written.contains(main) && flat.contains(main), "{written}");
        let count = |text: &str| text.matches(motion).count();
        assert!(
            count(&flat) > 2 && count(&written) >= count(&flat),
            "{written}"
        );
        assert_ne!(written, flat);
        let said = one_line(&said.out);
        // Lines are those of the source.
        assert!(said.contains("of part.ngc"), "{said}");
        assert!(said.contains("spindle: 1 line is a note now"), "{said}");
        // Joints of the arm, at lines of the flat program.
        let points = read(here, "points.csv");
        assert!(
            points
                .lines()
                .next()
                .unwrap()
                .contains("joint_6_command_deg")
        );
        assert!(points.lines().count() > 20);
    }
}

/// The turn is chosen along the path, written into every pose, drawn, and solved.
#[test]
fn a_chosen_turn_is_written() {
    let job = format!(
        "{JOB}[robot]\nto = \"krl\"\ntemplate = \"cell.toml\"\nfree_turn = \"choose\"\n[output]\nprogram = \"sent.src\"\nturn_plot = \"turn.svg\"\n"
    );
    let here = place(&job);
    let here = here.path();
    let said = run(here, &words("compensate job.toml")).answered();
    let text = one_line(&said.out);
    assert!(
        text.contains("Turn of the tool about its axis - The tool"),
        "{text}"
    );
    assert!(
        text.contains("sent.src") && text.contains("turn.svg"),
        "{text}"
    );
    assert!(read(here, "turn.svg").contains("way along the path, mm"));
    // Not the orientation of the job.
    let flat = read(here, "sent_flat.src");
    assert!(!flat.contains("A 160.00000000,"), "{flat}");
    // Lines of the source are named as such.
    assert!(text.contains("line 2 of part.ngc: S8000 M3"), "{text}");
    // The same job is analysed as it is, with the turn.
    let said = run(
        here,
        &words("deflect job.toml --points p.csv --turn-plot again.svg"),
    );
    let said = said.answered();
    assert!(
        one_line(&said.out).contains("Turn of the tool about its axis"),
        "{}",
        said.out
    );
    assert!(read(here, "again.svg").contains("way along the path, mm"));
    let points = read(here, "p.csv");
    assert!(
        points.lines().next().unwrap().contains("orientation_w"),
        "{points}"
    );
}

/// The spindle would be turned into a limit: the turn that helps is asked for by name.
#[test]
fn where_the_arm_does_not_come_the_turn_is_named() {
    let here = place(&JOB.replace("[160, 0, 180]", "[0, 0, 180]"));
    let said = run(here.path(), &words("compensate job.toml --to krl"));
    assert_eq!(said.code, 2, "{said:?}");
    let text = one_line(&said.err);
    assert!(
        text.contains("line 3 of part.ngc (line 14 of the flat program)"),
        "{text}"
    );
    assert!(
        text.contains("is outside its limits") && text.contains("--free-turn"),
        "{text}"
    );
    let said = run(
        here.path(),
        &words("compensate job.toml --to krl --free-turn"),
    );
    said.answered();
}

#[test]
fn what_cannot_be_written_so_is_said() {
    let twice = CELL.replace(
        "number = 3",
        "number = 3\npose = { position_mm = [0, 0, 900] }",
    );
    let slow = CELL.replace("150", "8");
    for (job, cell, options, needle) in [
        (
            JOB,
            CELL,
            "--free-turn",
            "has no words for the turn of a tool",
        ),
        (JOB, CELL, "--turn-plot turn.svg", "give --free-turn, too"),
        (JOB, CELL, "--to gcode", "[possible values: krl, rapid, ls]"),
        (JOB, CELL, "--to csv", "[possible values: krl, rapid, ls]"),
        (JOB, CELL, "--to krl --out new.nc", "name it 'new.src'"),
        (
            JOB,
            CELL,
            "--to krl --flat-program flat.ngc --expand",
            "and the flat program is KRL: name it 'flat.src'",
        ),
        (
            JOB,
            &twice,
            "--to krl --template cell.toml",
            "stated twice, and not the same: [base]",
        ),
        (
            JOB,
            &slow,
            "--to krl --template cell.toml",
            "line 6: the feed, 10 mm/s, is not below",
        ),
        (JOB, CELL, "--to krl --scale 2", "scale"),
        (JOB, CELL, "--to krl --template none.toml", "none.toml"),
        (
            &JOB.replace(
                "part.ngc\"",
                "part.ngc\"\n[robot]\nexternal_axes = \"carried\"\nfree_turn = \"choose\"",
            ),
            CELL,
            "",
            "is for programs of robots",
        ),
    ] {
        let here = place(job);
        std::fs::write(here.path().join("cell.toml"), cell).unwrap();
        let said = run(
            here.path(),
            &words(&format!("compensate job.toml {options}")),
        );
        assert_eq!(said.code, 1, "{options}: {said:?}");
        let text = one_line(&said.err);
        assert!(text.contains(needle), "{needle}: {text}");
        let files = std::fs::read_dir(here.path()).unwrap().count();
        assert_eq!(files, 3, "{options}: nothing is written");
    }
}
