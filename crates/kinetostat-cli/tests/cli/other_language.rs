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
weight = "all"
force_n = [60, 20, 100]
"#;

/// The load of [`JOB`], where another one is to stand.
const LOAD: &str = "[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n";

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
        ("krl", "src", "DEF part(", "LIN {"),
        ("rapid", "mod", "MODULE part", "MoveL "),
        ("ls", "ls", "/PROG  PART", "L P["),
    ] {
        let here = place(JOB);
        let here = here.path();
        let line =
            format!("compensate job.toml --to {to} --template cell.toml --points points.csv");
        let said = run(here, &words(&line)).answered();
        let written = read(here, &format!("compensated/part.{ending}"));
        let flat = read(here, &format!("flat/part.{ending}"));
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

/// The converted program is a flat one: option and job name it without an expansion, too.
#[test]
fn the_converted_program_goes_where_it_is_named() {
    let output = "[output]\nflat_program = \"named.src\"\n";
    let robot = "[robot]\nto = \"krl\"\ntemplate = \"cell.toml\"\n";
    for (job, options) in [
        (
            JOB.to_owned(),
            "--to krl --template cell.toml --flat-program named.src",
        ),
        (format!("{JOB}{output}"), "--to krl --template cell.toml"),
        (format!("{JOB}{robot}{output}"), ""),
    ] {
        let here = place(&job);
        let here = here.path();
        run(here, &words(&format!("compensate job.toml {options}"))).answered();
        assert!(read(here, "named.src").contains("DEF "), "{options}");
        if job.contains(robot) {
            run(here, &words("check job.toml")).answered();
        }
    }
    // Where nothing is converted there is none.
    let here = place(JOB);
    let said = run(
        here.path(),
        &words("compensate job.toml --flat-program named.ngc"),
    );
    assert!(
        said.code == 1 && said.err.contains("add --expand"),
        "{said:?}"
    );
}

/// The turn is chosen along the path, written into every pose, drawn, and solved.
#[test]
fn a_chosen_turn_is_written() {
    let job = format!(
        "{JOB}[robot]\nto = \"krl\"\ntemplate = \"cell.toml\"\nfree_turn = \"choose\"\n[output]\nprogram = \"sent.src\"\nturn_plot = \"turn.svg\"\nreport = \"report.html\"\n"
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
    let report = read(here, "report.html");
    for needle in [
        "How the tool is turned about its axis",
        "way along the path, mm",
        "turn about the tool&#39;s axis, deg",
    ] {
        assert!(report.contains(needle), "{needle}");
    }
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

/// The turn is chosen for one tool: the one of `[[tools]]` that the program takes. Two are refused, and each by itself goes through.
#[test]
fn the_turn_is_chosen_for_the_one_tool_that_the_program_takes() {
    let tools = "[[tools]]\nnumber = 1\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n[[tools]]\nnumber = 2\npose = { position_mm = [180, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n";
    let (before, load) = JOB.split_once("[tool]").unwrap();
    let (_, load) = load.split_once("[load]").unwrap();
    let numbered = format!("{before}{tools}[load]{load}");
    let other = CELL.replace("[tool]\nnumber = 2\n", "");
    let parts = [
        "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X40 F600\nG0 Z5\n",
        "T2 M6\nG0 X0 Y0 Z6\nG1 Z-1 F300\nG1 X40 F600\nG0 Z5\n",
    ];
    let here = place(&numbered);
    let here = here.path();
    std::fs::write(here.join("cell.toml"), other).unwrap();
    let line = "compensate job.toml --to krl --template cell.toml --free-turn --force-overwrite";
    std::fs::write(here.join("part.ngc"), parts.concat()).unwrap();
    let said = run(here, &words(line));
    assert_eq!(said.code, 1, "{said:?}");
    let text = one_line(&said.err);
    assert!(
        text.contains(
            "part.ngc: line 8: the tool 2 moves here, and the tool 1 before: --free-turn"
        ),
        "{text}"
    );
    for part in [parts[0].to_owned(), format!("G21 G90\n{}", parts[1])] {
        std::fs::write(here.join("part.ngc"), part).unwrap();
        let said = run(here, &words(line)).answered();
        assert!(one_line(&said.out).contains("Turn of the tool about its axis"));
    }
    // Without [[tools]] the same tool gives the same turn; an analysis takes the tool of the table, too.
    let turn = |job: &str| {
        std::fs::write(here.join("job.toml"), job).unwrap();
        let said = run(here, &words("deflect job.toml --free-turn")).answered();
        let text = one_line(&said.out);
        let (_, turn) = text.split_once("Turn of the tool about its axis").unwrap();
        turn.to_owned()
    };
    let one = turn(&JOB.replace("[200, 0, 100]", "[180, 0, 100]"));
    assert_eq!(turn(&numbered), one);
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

/// Worst error before compensation and after it, mm.
fn worst(here: &Path, name: &str) -> [f64; 2] {
    let result: serde_json::Value = serde_json::from_str(&read(here, name)).unwrap();
    [
        "max_position_error_before_mm",
        "max_position_error_after_mm",
    ]
    .map(|key| {
        let value = result["summary"][key].as_f64();
        value.unwrap_or_else(|| panic!("{key}: {}", result["summary"]))
    })
}

/// The same machine under the same forces: what is off along the G-code is off along the program of the robot.
fn is_the_same(here: &Path, options: &str) {
    run(here, &words("compensate job.toml --json plain.json")).answered();
    let line = format!("compensate job.toml --json robot.json {options} --force-overwrite");
    let said = run(here, &words(&line)).answered();
    let [plain, robot] = ["plain.json", "robot.json"].map(|name| worst(here, name));
    assert!(
        (plain[0] - robot[0]).abs() < 1e-6 * plain[0],
        "{plain:?} {robot:?} {}",
        said.out
    );
    assert!(robot[1] < 0.03, "{robot:?} {}", said.out);
}

const CUTTER: &str = r#"cutter = { shape = "flat", diameter_mm = 10, teeth = 2, helix_deg = 30 }
[load]
weight = "all"
[material]
name = "AlMg4.5Mn"
[stock]
block_mm = [[10, -20, -12], [70, 30, 0]]
"#;

#[test]
fn forces_that_are_computed_from_the_cut_act_on_the_program_of_the_robot() {
    let job = JOB.replace(LOAD, CUTTER);
    assert_ne!(job, JOB);
    for to in ["krl", "rapid", "ls"] {
        let here = place(&job);
        is_the_same(here.path(), &format!("--to {to} --template cell.toml"));
        // A motion to stated joints before all others goes along nothing of the path.
        let here = place(&job);
        let started = CELL.replace(
            "[base]",
            "start_joints_deg = [0, -90, 90, 0, 45, 0]\n[base]",
        );
        std::fs::write(here.path().join("cell.toml"), started).unwrap();
        is_the_same(here.path(), &format!("--to {to} --template cell.toml"));
    }
    // A tool that leans is no tool of such forces.
    let here = place(&job.replace("[160, 0, 180]", "[160, 20, 180]"));
    let said = run(
        here.path(),
        &words("compensate job.toml --to krl --template cell.toml"),
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        one_line(&said.err).contains("the tool is tilted by 20.0 degrees"),
        "{said:?}"
    );
}

#[test]
fn measured_forces_act_on_the_program_of_the_robot() {
    for axes in ["part", "feed"] {
        let measured = format!(
            "[load]\nweight = \"all\"\n[measured]\nfile = \"log.csv\"\nacts_on = \"tool\"\naxes = \"{axes}\"\nsmooth_mm = 0\n"
        );
        assert!(JOB.contains(LOAD));
        let here = place(&JOB.replace(LOAD, &measured));
        let log = "along_mm,fx_n,fy_n,fz_n\n0,10,0,40\n20,80,30,90\n46,120,-60,60\n62,40,-10,100\n";
        std::fs::write(here.path().join("log.csv"), log).unwrap();
        is_the_same(here.path(), "--to krl --template cell.toml");
    }
}

/// The second tool of the job comes first in the program.
#[test]
fn tools_of_the_job_are_those_of_the_program_of_the_robot() {
    let program = "G21 G90\nT2 M6\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X30\nG0 Z5\nT1 M6\nG0 X0 Y10\nG1 Z-1 F300\nG1 X30\nG0 Z5\nM2\n";
    let tools = "[[tools]]\nnumber = 1\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\nload = { force_n = [0, 0, 300] }\n[[tools]]\nnumber = 2\npose = { position_mm = [240, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n";
    let job = JOB.replace(
        "[tool]\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n",
        tools,
    );
    assert!(job.contains("[[tools]]"));
    for to in ["krl", "rapid", "ls"] {
        let here = place(&job);
        std::fs::write(here.path().join("part.ngc"), program).unwrap();
        is_the_same(here.path(), &format!("--to {to}"));
    }
    // One of them in the template as well, and elsewhere.
    let here = place(&job);
    std::fs::write(here.path().join("part.ngc"), program).unwrap();
    let cell = "schema = 1\n[[tools]]\nin_program = 2\npose = { position_mm = [0, 0, 100] }\n";
    std::fs::write(here.path().join("cell.toml"), cell).unwrap();
    let said = run(
        here.path(),
        &words("compensate job.toml --to krl --template cell.toml"),
    );
    assert_eq!(said.code, 1, "{said:?}");
    let text = one_line(&said.err);
    assert!(
        text.contains("in_program = 2 under [[tools]] in the template"),
        "{text}"
    );
}

/// What is checked is what is written.
#[test]
fn the_check_of_a_job_names_the_programs_of_its_language() {
    for (robot, named) in [
        (
            "[robot]\nto = \"krl\"\n",
            "compensated/part.src flat/part.src",
        ),
        ("[expand]\n", "part-compensated.ngc part-flat.ngc"),
    ] {
        let here = place(&format!("{JOB}{robot}"));
        let said = run(here.path(), &words("check job.toml")).answered();
        for name in named.split(' ') {
            assert!(said.out.contains(name), "{name}: {}", said.out);
        }
        run(here.path(), &words("compensate job.toml")).answered();
        for name in named.split(' ') {
            assert!(here.path().join(name).is_file(), "{name}");
        }
    }
}

/// The language does not say in which of its postures the arm was solved: it is named, and what speaks against it.
#[test]
fn the_configuration_that_was_solved_is_named() {
    let here = place(JOB);
    let here = here.path();
    let run_with = |more: &str, to: &str| {
        let cell = CELL.replace("[base]", &format!("{more}\n[base]"));
        std::fs::write(here.join("cell.toml"), cell).unwrap();
        let line = format!("compensate job.toml --to {to} --template cell.toml --force-overwrite");
        one_line(&run(here, &words(&line)).answered().out)
    };
    for (to, words) in [("ls", "(`N U T`)"), ("krl", "(S 2)"), ("rapid", "(cfx 0)")] {
        let said = run_with("", to);
        let expected = format!(
            "the arm was solved in the configuration front, elbow up, wrist not flipped {words}; at its first place its joints are ("
        );
        assert!(said.contains(&expected), "{said}");
        assert!(!said.contains("states the configuration"), "{said}");
    }
    for (to, stated, part) in [
        ("ls", "F U T, 0, 0, 0", "wrist"),
        ("ls", "N D B, 0, 0, 0", "shoulder and elbow"),
        ("krl", "S 0, T 0", "elbow"),
        ("krl", "S 6, T 0", "wrist"),
        ("rapid", "[0,0,0,1]", "wrist"),
    ] {
        let said = run_with(&format!("configuration = \"{stated}\""), to);
        assert!(
            said.contains("the program states the configuration `"),
            "{said}"
        );
        assert!(
            said.contains(&format!("which is another {part}: ")),
            "{said}"
        );
    }
    // Where the arm starts counts, too: it begins with its wrist bent to the other side, or a turn away.
    let said = run_with("start_joints_deg = [0, -20, 35, 180, -75, 0]", "krl");
    assert!(
        said.contains("where the arm is front, elbow up, wrist flipped, and the run solved it front, elbow up, wrist not flipped"),
        "{said}"
    );
    let said = run_with("start_joints_deg = [0, -20, 35, 350, 75, 0]", "krl");
    assert!(said.contains("where joint 4 is at 350.0 deg"), "{said}");
    let said = run_with("start_joints_deg = [0, -20, 35, 0, 75, 0]", "krl");
    assert!(
        !said.contains("the program begins at start_joints_deg"),
        "{said}"
    );
}

/// A program of positions states how its tool stands as soon as it is one of a robot.
#[test]
fn the_orientation_of_a_converted_program_is_corrected() {
    let here = place(JOB);
    let here = here.path();
    let line = "compensate job.toml --to krl --template cell.toml --out o.src --flat-program f.src --correct pose";
    run(here, &words(line)).answered();
    let [flat, written] = ["f.src", "o.src"].map(|name| read(here, name));
    let angles = |text: &str| -> Vec<String> {
        let motions = text.lines().filter(|line| line.starts_with("LIN {"));
        let angles =
            motions.filter_map(|line| Some(line[line.find(",A ")?..line.find('}')?].to_owned()));
        angles
            .collect::<std::collections::BTreeSet<_>>()
            .into_iter()
            .collect()
    };
    assert_eq!(angles(&flat).len(), 1, "{flat}");
    assert!(angles(&written).len() > 1, "{written}");
    // In the job, too.
    let job = format!("{JOB}[robot]\nto = \"krl\"\ntemplate = \"cell.toml\"\ncorrect = \"pose\"\n");
    std::fs::write(here.join("job.toml"), job).unwrap();
    run(here, &words("check job.toml")).answered();
    run(
        here,
        &words("compensate job.toml --out o.src --flat-program f.src --force-overwrite"),
    )
    .answered();
    assert_eq!(angles(&read(here, "o.src")), angles(&written));
}
