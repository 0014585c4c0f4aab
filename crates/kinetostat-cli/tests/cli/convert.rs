//! `kinetostat convert`: programs of one language in another, from files to files.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::{gcode, run};

const PART: &str = "G21 G90 (plate)\nS8000 M3\nG0 X0 Y0 Z5\nM8\nG1 Z-1 F300\nG1 X40 F600\nG3 X50 Y10 I0 J10\nG0 Z5\nM30\n";

const CELL: &str = r#"schema = 1
tool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }
rapid_speed_mm_per_s = 150
[base]
number = 3
pose = { position_mm = [1800, 0, 900] }
[tool]
number = 2
pose = { position_mm = [0, 0, 180] }
mass_kg = 5
[zones]
feeds_mm = 0.1
"#;

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

fn place() -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("part.ngc"), PART).unwrap();
    std::fs::write(here.path().join("cell.toml"), CELL).unwrap();
    here
}

#[test]
fn g_code_becomes_a_program_for_each_robot() {
    let here = place();
    for (to, file, needles) in [
        (
            "krl",
            "plate.src",
            [
                "DEF plate( )",
                "$BASE={X 1800.000000,Y 0.000000,Z 900.000000,",
                "$APO.CDIS=0.1\n",
            ],
        ),
        (
            "rapid",
            "plate.mod",
            [
                "MODULE plate",
                "PERS wobjdata wobj3:=",
                "CONST speeddata vRapid:=[150,",
            ],
        ),
        (
            "ls",
            "plate.ls",
            ["/PROG  PLATE", "UFRAME_NUM=3 ;", "10mm/sec CNT20"],
        ),
    ] {
        let line = format!("convert part.ngc --to {to} --out {file} --template cell.toml");
        let said = run(here.path(), &words(&line)).answered();
        let text = read(here.path(), file);
        for needle in needles {
            assert!(text.contains(needle), "{needle}: {text}");
        }
        assert!(
            said.out.lines().all(|line| line.chars().count() <= 80),
            "{}",
            said.out
        );
        let said = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        for needle in [
            "part.ngc: 5 moves are 5 motions in",
            "Read again and compared with the path: places equal, orientations ",
            " mm, feeds equal.",
            "spindle: 1 line is a note now, and does nothing there (line 2: S8000 M3)",
            "coolant: 1 line is a note now",
            &format!("Written {file}"),
        ] {
            assert!(said.contains(needle), "{needle}: {said}");
        }
    }
}

#[test]
fn robots_and_tables_follow_each_other() {
    let here = place();
    let here = here.path();
    for line in [
        "convert part.ngc --to krl --out a.src --template cell.toml",
        "convert a.src --to rapid --out b.mod --rapid-from-mm-per-s 150",
        "convert b.mod --to ls --out c.ls --rapid-from-mm-per-s 200",
        "convert c.ls --to csv --out d.csv --rapid-from-mm-per-s 200",
    ] {
        run(here, &words(line)).answered();
    }
    assert!(
        read(here, "b.mod")
            .contains("PERS wobjdata wobj1:=[FALSE,TRUE,\"\",[[1800.000000,0.000000,900.000000],")
    );
    let table = read(here, "d.csv");
    let rows: Vec<Vec<f64>> = (table.lines())
        .filter(|line| !line.starts_with('#') && !line.starts_with('x'))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let wanted = [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [40.0, 0.0, -1.0]];
    for (row, wanted) in rows.iter().zip(wanted) {
        for axis in 0..3 {
            assert!((row[axis] - wanted[axis]).abs() < 3e-6, "{table}");
        }
    }
    assert!(
        (rows[2][7] - 10.0).abs() < 1e-9 && rows[2][8] == 0.0 && rows[0][8] == 1.0,
        "{table}"
    );
}

#[test]
fn a_long_program_is_a_main_one_and_parts() {
    let here = place();
    let cell = format!("most_points = 3\n{}", CELL.replace("schema = 1\n", ""));
    std::fs::write(here.path().join("cell.toml"), format!("schema = 1\n{cell}")).unwrap();
    let said = run(
        here.path(),
        &words("convert part.ngc --to krl --out long.src --template cell.toml"),
    )
    .answered();
    assert!(
        said.out.contains("a main program and 2 parts"),
        "{}",
        said.out
    );
    assert!(read(here.path(), "long.src").contains("\nlong_1( )\nlong_2( )\nEND\n"));
    assert!(read(here.path(), "long_2.src").contains("DEF long_2( )"));
    // Nothing is overwritten, parts neither.
    std::fs::remove_file(here.path().join("long.src")).unwrap();
    let said = run(
        here.path(),
        &words("convert part.ngc --to krl --out long.src --template cell.toml"),
    );
    assert_eq!(said.code, 1);
    assert!(
        said.err.contains("long_1.src") && !here.path().join("long.src").exists(),
        "{said:?}"
    );
}

#[test]
fn an_expanded_program_names_the_lines_of_its_files() {
    let here = place();
    let text = "G21 G90\nG0 X0 Y0 Z5\nO1 repeat [2]\nM8\nG91 G1 X5 F60\nG90\nO1 endrepeat\nM2\n";
    std::fs::write(here.path().join("macro.ngc"), text).unwrap();
    run(
        here.path(),
        &words("convert macro.ngc --expand --to krl --out m.src --template cell.toml"),
    )
    .answered();
    let text = read(here.path(), "m.src");
    assert_eq!(
        text.matches("; macro.ngc, line 4: M8\n").count(),
        2,
        "{text}"
    );
}

/// SINUMERIK is run by the readers of robots' programs; its notes name the lines of its file all the same.
#[test]
fn an_expanded_program_of_sinumerik_names_the_lines_of_its_file() {
    let here = place();
    let text = "G17 G90 G54\nT1 D1\nM3 S5000\nG0 X0 Y0 Z50\nR1=0\nREPEAT_PART:\nG1 X=R1 F600\nR1=R1+10\nM8\nIF R1<30 GOTOB REPEAT_PART\nG0 Z50\nM30\n";
    std::fs::write(here.path().join("part.mpf"), text).unwrap();
    run(
        here.path(),
        &words("convert part.mpf --expand --to csv --out part.csv --template cell.toml"),
    )
    .answered();
    let table = read(here.path(), "part.csv");
    assert!(table.contains("part.mpf, line 12: M30"), "{table}");
    assert_eq!(table.matches("part.mpf, line 9: M8").count(), 3, "{table}");
}

#[test]
fn what_is_wrong_is_named_and_nothing_is_written() {
    let here = place();
    let here = here.path();
    let lines = [
        (
            "--to krl --out new.src",
            "",
            "state tool_orientation in the template",
        ),
        (
            "--to krl --out 1.src",
            CELL,
            "controllers take letters, digits and _",
        ),
        (
            "--to gcode --out new.ngc",
            CELL,
            "the program is in G-code already",
        ),
        (
            "--to gcode --out new.src",
            CELL,
            "and the made program is G-code: name it 'new.ngc'",
        ),
        (
            "--to krl --out part.ngc --force-overwrite",
            CELL,
            "'part.ngc': .ngc is the ending of another language, and the made program is KRL: name it 'part.src'",
        ),
        ("--to ls --out new.csv", CELL, "name it 'new.ls'"),
        (
            "--to krl --out new.src",
            "schema = 2\n",
            "schema 2 is not known",
        ),
        (
            "--to krl --out new.src",
            "tool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n",
            "schema = 1",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\nspeed = 3\n",
            "unknown key 'speed'",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\nrapid_speed = 3\n",
            "rapid_speed_mm_per_s",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\nrapids = \"fast\"\n",
            "'fast' is not known here",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 180] }\n",
            "cell.toml",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\ntool_orientation = { position_mm = [0, 0, 1] }\n",
            "a position is given in it",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\nrapid_speed_mm_per_s = -1\n",
            "cell.toml: rapid_speed_mm_per_s is -1",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\n[[tools]]\nin_program = 1\n[[tools]]\nin_program = 1\n",
            "stated twice",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\n[base\n",
            "this is not TOML",
        ),
        (
            "--to krl --out new.src",
            "schema = 1\nrapid_speed_mm_per_s = nan\n",
            "no finite number",
        ),
        (
            "--to krl --out new.src --tool-orientation 0,0,180",
            CELL,
            "--tool-orientation",
        ),
        (
            "--to krl --out new.src --tolerance-mm 0",
            CELL,
            "tolerance_mm is 0",
        ),
    ];
    for (options, template, needle) in lines {
        std::fs::write(here.join("cell.toml"), template).unwrap();
        let template = match template {
            "" => "",
            _ => " --template cell.toml",
        };
        let said = run(
            here,
            &words(&format!("convert part.ngc {options}{template}")),
        );
        assert_eq!(said.code, 1, "{options}: {said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(needle), "{needle}: {said:?}");
        assert!(!here.join("new.src").exists() && !here.join("new.ngc").exists());
    }
    assert_eq!(read(here, "part.ngc"), PART);
}

/// A robot's program tells cuts from rapids by their speed: a cut as fast would be read back as one in air.
#[test]
fn a_cut_as_fast_as_rapids_is_refused() {
    let here = place();
    let here = here.path();
    std::fs::write(here.join("part.ngc"), PART.replace("F600", "F9000")).unwrap();
    for to in ["krl", "rapid", "ls"] {
        let line = format!("convert part.ngc --to {to} --out new.{to} --template cell.toml");
        let said = run(here, &words(&line));
        assert_eq!(said.code, 1, "{said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            text.contains("line 6: the feed, 150 mm/s, is not below"),
            "{text}"
        );
        assert!(!here.join(format!("new.{to}")).exists());
    }
}

/// A program that nobody here wrote, for an arm with a model, and compensated there.
#[test]
fn an_engraving_becomes_a_program_for_each_robot() {
    let Some(folder) = gcode() else {
        return;
    };
    let text = std::fs::read(folder.join("tball-engrave.gcode")).unwrap();
    let here = place();
    let here = here.path();
    std::fs::write(here.join("engrave.gcode"), text).unwrap();
    for (to, file, count) in [
        ("krl", "engrave.src", "LIN {"),
        ("rapid", "engrave.mod", "MoveL "),
        ("ls", "engrave.ls", "mm/sec "),
    ] {
        let line = format!("convert engrave.gcode --to {to} --out {file} --template cell.toml");
        let said = run(here, &words(&line)).answered();
        let motions: usize = said
            .out
            .split_whitespace()
            .skip_while(|word| *word != "are")
            .nth(1)
            .unwrap()
            .parse()
            .unwrap();
        assert!(motions > 3000, "{}", said.out);
        let written = read(here, file).matches(count).count();
        assert_eq!(
            written + 1,
            motions,
            "the first is a joint motion: {}",
            said.out
        );
    }
    let line = "compensate --model heavy_6r --weight all --program engrave.mod --force 30 0 -20 --correct position --rapid-from-mm-per-s 100000 --tolerance-um 20 --out sent.mod";
    let said = run(here, &words(line));
    assert!(said.code == 0 || said.code == 3, "{said:?}");
    assert!(here.join("sent.mod").exists(), "{said:?}");
}

#[test]
fn help_is_narrow() {
    let here = place();
    let said = run(here.path(), &["help", "convert"]).answered();
    let wide: Vec<&str> = said
        .out
        .lines()
        .filter(|line| line.chars().count() > 80)
        .collect();
    assert!(wide.is_empty(), "{wide:#?}");
}

/// Half way around the base of an arm, at a reach of 1.6 m.
const RING: &str =
    "G21 G90 G17\nG0 X1600 Y0 Z30\nG1 Z0 F1000\nG3 X-1385.641 Y800 I-1600 J0 F2000\nG0 Z30\nM30\n";

#[test]
fn a_round_tool_is_turned_about_its_axis_along_the_whole_way() {
    let here = place();
    let here = here.path();
    let cell = CELL.replace("[1800, 0, 900]", "[0, 0, 900]");
    std::fs::write(here.join("ring.toml"), &cell).unwrap();
    std::fs::write(here.join("ring.ngc"), RING).unwrap();
    let line = "convert ring.ngc --to krl --out ring.src --template ring.toml --free-turn heavy_6r --turn-plot turn.svg";
    let said = run(here, &words(line)).answered();
    assert!(said.out.contains("about its own axis"), "{said:?}");
    assert!(read(here, "turn.svg").starts_with("<svg"));
    // The tool's axis stays down (C 180, B 0): only A changes, in steps that the rate allows.
    let made = read(here, "ring.src");
    let number = |line: &str, letter: &str| -> f64 {
        let rest = line.rsplit_once(letter).unwrap().1;
        rest.split([',', '}']).next().unwrap().parse().unwrap()
    };
    let motions = made
        .lines()
        .filter(|line| line.contains("{X ") && !line.starts_with('$'));
    let turns: Vec<f64> = motions
        .map(|line| {
            let [b, c] = [number(line, ",B "), number(line, ",C ")];
            // Upright either way: (A, 0, 180), or (A + 180, 180, 0).
            let is_down = b == 0.0 && c.abs() == 180.0 || b.abs() == 180.0 && c == 0.0;
            assert!(is_down, "{line}");
            number(line, ",A ")
        })
        .collect();
    assert!(turns.len() > 3, "{made}");
    // The whole circle cannot be followed by joint 1, whichever way the tool is turned.
    let whole = RING.replace("X-1385.641 Y800", "X1385.641 Y-800");
    std::fs::write(here.join("ring.ngc"), whole).unwrap();
    let said = run(here, &words(&format!("{line} --force-overwrite")));
    assert_eq!(said.code, 2, "{said:?}");
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in ["line 4", "'joint 1' meets its limit", "Divided before line"] {
        assert!(flat.contains(expected), "{expected}: {flat}");
    }
    // What must be known is asked for.
    let line = "convert part.ngc --to krl --out x.src --tool-orientation a_b_c_kuka_deg=0,0,180 --free-turn heavy_6r";
    let said = run(here, &words(line));
    assert_eq!(said.code, 1);
    assert!(said.err.contains("pose under [base]"), "{said:?}");
}

#[test]
fn another_tool_at_the_same_place_is_a_motion_and_exact_stops_are_named() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let pose = |x: u32| format!("[[{x},0,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    let tool = |name: &str, z: u32| {
        format!("PERS tooldata {name}:=[TRUE,[[0,0,{z}],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n")
    };
    let text = format!(
        "MODULE M\n{}{}PROC main()\nMoveJ {},v200,fine,t1;\nMoveL {},v200,fine,t2;\nMoveL {},v20,z5,t2;\nENDPROC\nENDMODULE\n",
        tool("t1", 180),
        tool("t2", 250),
        pose(0),
        pose(0),
        pose(60)
    );
    std::fs::write(here.join("two.mod"), text).unwrap();
    let said = run(here, &words("convert two.mod --to krl --out two.src")).answered();
    let made = read(here, "two.src");
    let behind = made.split("Z 250").nth(1).unwrap();
    let first = behind.lines().find(|line| line.starts_with("LIN")).unwrap();
    assert!(
        first.contains("{X 0.000000,Y 0.000000,Z 20.000000,"),
        "{made}"
    );
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("2 motions stop at their end there"), "{flat}");
    // Two work coordinate systems without their origins are said to lie in one place.
    let systems =
        "G21 G90\nG54 G0 X0 Y0 Z5\nG1 Z-5 F100\nG0 Z5\nG55 G0 X0 Y0 Z5\nG1 Z0\nG0 Z9\nM30\n";
    std::fs::write(here.join("systems.ngc"), systems).unwrap();
    let line = "convert systems.ngc --to csv --out systems.csv";
    let said = run(here, &words(line)).answered();
    assert!(said.out.contains("a second work"), "{said:?}");
}

/// Lines of one reason are named together where there are many.
#[test]
fn every_line_that_is_refused_is_named() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 X1\nG1 X2\nG1 X3\nG1 X4\nG1 X5\n";
    std::fs::write(here.join("part.ngc"), text).unwrap();
    let said = run(here, &words("convert part.ngc --to csv --out part.csv"));
    assert_eq!(said.code, 1, "{said:?}");
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("5 lines are refused"), "{flat}");
    assert!(
        flat.contains("line 6, line 7: the speed of this motion at feed is not known"),
        "{flat}"
    );
}

#[test]
fn tools_of_machines_keep_their_numbers_and_need_no_tips_in_tables() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = "G21 G90\nT3 M6\nG0 X0 Y0 Z5\nG1 X1 F60\nG0 Z9\nT4 M6\nG1 X2\n";
    std::fs::write(here.join("part.ngc"), text).unwrap();
    run(here, &words("convert part.ngc --to apt --out part.apt")).answered();
    let made = read(here, "part.apt");
    assert!(
        made.contains("LOADTL/3\n") && made.contains("LOADTL/4\n"),
        "{made}"
    );
    run(here, &words("convert part.apt --to gcode --out again.ngc")).answered();
    let made = read(here, "again.ngc");
    assert!(
        made.contains("T3 M6\n") && made.contains("T4 M6\n"),
        "{made}"
    );
    run(here, &words("convert part.ngc --to csv --out part.csv")).answered();
}
