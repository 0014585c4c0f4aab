//! `convert --to joints`: programs as tables of joint values of an arm, read again as the same poses.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use kinetostat_testing::largest;

use crate::common::run;

const PART: &str = "MODULE Part\n\
    PERS tooldata tMill:=[TRUE,[[200,0,100],[0.7071067811865476,0,0.7071067811865476,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\n\
    TASK PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1300,0,800],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
    PROC main()\n\
    MoveJ [[0,0,50],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tMill\\WObj:=wPart;\n\
    MoveL [[0,0,-1],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;\n\
    MoveL [[60,5,-1.25],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;\n\
    MoveC [[70,15,-1.25],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[60,25,-1.25],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;\n\
    ENDPROC\nENDMODULE\n";

const CELL: &str =
    "schema = 1\n[tool]\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n";

const DIGITS: &str = "position_decimals = 12\nquaternion_decimals = 15\n";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Rows of a table of poses: places (mm), quaternion.
fn poses(here: &Path, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(here.join(name)).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with(['#', 'x']));
    rows.map(|row| {
        row.split(',')
            .take(7)
            .map(|cell| cell.parse().unwrap())
            .collect()
    })
    .collect()
}

fn place() -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("part.mod"), PART).unwrap();
    let cell = CELL.replace("[tool]", &format!("{DIGITS}[tool]"));
    std::fs::write(here.path().join("cell.toml"), cell).unwrap();
    std::fs::write(
        here.path().join("digits.toml"),
        format!("schema = 1\n{DIGITS}"),
    )
    .unwrap();
    here
}

/// Poses are those of the program to 1e-9 mm and 1e-9 rad, seen from the base.
#[test]
fn joint_values_give_the_poses_of_the_program() {
    let here = place();
    let here = here.path();
    for between in ["linear", "joint"] {
        let line = format!(
            "convert part.mod --to joints --model heavy_6r --joint-rows {between} --out q.csv --force-overwrite"
        );
        let said = run(here, &words(&line)).answered();
        let said = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        for needle in [
            "in a table of joint values",
            "of joint values of heavy_6r",
            &format!("--joint-rows {between}"),
        ] {
            assert!(said.contains(needle), "{needle}: {said}");
        }
        let line = format!(
            "convert q.csv --to csv --model heavy_6r --joint-rows {between} --template cell.toml --out again.csv --force-overwrite"
        );
        run(here, &words(&line)).answered();
        run(
            here,
            &words("convert part.mod --to csv --template digits.toml --out poses.csv --force-overwrite"),
        )
        .answered();
        let (again, poses) = (poses(here, "again.csv"), poses(here, "poses.csv"));
        assert!(match between {
            "linear" => again.len() == poses.len(),
            _ => again.len() > poses.len() + 10,
        });
        let (mut place_mm, mut turn) = (Vec::new(), Vec::new());
        for pose in &poses {
            // The work object lies along the axes of the base.
            let there = [pose[0] + 1300.0, pose[1], pose[2] + 800.0];
            let apart = |row: &Vec<f64>| -> f64 {
                (0..3)
                    .map(|k| (row[k] - there[k]).powi(2))
                    .sum::<f64>()
                    .sqrt()
            };
            let nearest = again
                .iter()
                .min_by(|a, b| apart(a).total_cmp(&apart(b)))
                .unwrap();
            place_mm.push(apart(nearest));
            let dot: f64 = (3..7).map(|k| nearest[k] * pose[k]).sum();
            turn.push((1.0 - dot.abs()).abs().sqrt());
        }
        let (place_mm, turn) = (largest(place_mm), largest(turn));
        assert!(place_mm < 1e-9 && turn < 1e-7, "{place_mm} mm, {turn}");
    }
    // The table is compensated with the same model.
    let line = "compensate --model heavy_6r --weight all --program q.csv --joint-rows joint --tool-length-mm 0 --force 10 0 10 --tolerance-um 20";
    run(here, &words(line)).answered();
}

/// Where all joints move in step, rapids of G-code are divided as cuts are; those of a robot's own joint motions are not, and that is
/// said.
#[test]
fn rapids_go_straight_where_the_source_has_them_straight() {
    let here = place();
    let here = here.path();
    let text = "G21 G90\nG0 X0 Y-400 Z5\nG0 X0 Y400 Z5\nG1 Z-1 F600\nG1 X50\nG0 Z5\nM30\n";
    std::fs::write(here.join("far.ngc"), text).unwrap();
    let cell = "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\npose = { position_mm = [1600, 0, 600] }\n[tool]\npose = { position_mm = [0, 0, 180] }\n";
    std::fs::write(here.join("far.toml"), cell).unwrap();
    let line = "convert far.ngc --to joints --model heavy_6r --joint-rows joint --template far.toml --out far.csv";
    run(here, &words(line)).answered();
    // Read again as poses, each row is on the straight way of x = 1600 until the cut.
    let line = "convert far.csv --to csv --model heavy_6r --joint-rows joint --template far.toml --out far_poses.csv";
    run(here, &words(line)).answered();
    let rows = poses(here, "far_poses.csv");
    let high: Vec<_> = rows.iter().filter(|row| row[1] < 399.0).collect();
    assert!(high.len() > 20, "{}", high.len());
    let stepped = largest(high.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()));
    assert!(stepped < 60.0, "{stepped}");
    let line = "convert part.mod --to joints --model heavy_6r --joint-rows joint --out p.csv";
    let said = run(here, &words(line)).answered();
    let joint = "MoveJ [[0,0,50]";
    assert!(
        PART.contains(joint) && !said.out.contains("In rapids"),
        "{}",
        said.out
    );
    let far = PART.replacen("MoveL", "MoveJ [[0,400,50],[0,0.17364817766693033,0.984807753012208,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tMill\\WObj:=wPart;\nMoveL", 1);
    std::fs::write(here.join("far.mod"), far).unwrap();
    let line = "convert far.mod --to joints --model heavy_6r --joint-rows joint --out p2.csv";
    let said = run(here, &words(line)).answered();
    let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("In rapids all joints move in step"), "{text}");
}

/// Joint values are places in the robot's base, whatever base the template has for parts.
#[test]
fn joint_values_stay_where_they_are_beside_a_base_of_the_template() {
    let here = place();
    let here = here.path();
    let based = CELL.replace(
        "[tool]",
        "[base]\npose = { position_mm = [100, 50, -100], a_b_c_kuka_deg = [10, 0, 0] }\n[tool]",
    );
    std::fs::write(here.join("based.toml"), based).unwrap();
    let joints = |name: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(here.join(name)).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with(['#', 'j']));
        rows.map(|row| {
            row.split(',')
                .take(6)
                .map(|cell| cell.parse().unwrap())
                .collect()
        })
        .collect()
    };
    let line = "convert part.mod --to joints --model heavy_6r --joint-rows linear --out first.csv";
    run(here, &words(line)).answered();
    for (to, name) in [("krl", "part2.src"), ("rapid", "part2.mod")] {
        let line = format!(
            "convert first.csv --to {to} --model heavy_6r --joint-rows linear --template based.toml --out {name}"
        );
        let said = run(here, &words(&line)).answered();
        let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            text.contains("the base of the template is not used"),
            "{text}"
        );
        let line = format!(
            "convert {name} --to joints --model heavy_6r --joint-rows linear --out again.csv --force-overwrite"
        );
        run(here, &words(&line)).answered();
        let (first, again) = (joints("first.csv"), joints("again.csv"));
        assert!(first.len() > 3 && again.len() == first.len(), "{to}");
        let off = first.iter().flatten().zip(again.iter().flatten());
        let off = largest(off.map(|(a, b)| (a - b).abs()));
        assert!(off < 1e-5, "{to}: {off} deg");
    }
}

/// A table of joint values written as one again, with the option that says how the controller moves between the rows of both.
#[test]
fn a_table_of_joint_values_becomes_one_again() {
    let here = place();
    let here = here.path();
    std::fs::write(
        here.join("rows.csv"),
        "A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,speed_mm_per_s,rapid\n\
         0,0,0,0,60,0,200,1\n1,2,1,0,60,0,50,0\n2,2,1,0,61,5,50,0\n",
    )
    .unwrap();
    std::fs::write(
        here.join("tool.toml"),
        "schema = 1\n[tool]\npose = { position_mm = [0, 0, 180] }\n",
    )
    .unwrap();
    let line = "convert rows.csv --to joints --model heavy_6r --joint-rows linear --template tool.toml --out again.csv --force-overwrite";
    run(here, &words(line)).answered();
    let text = std::fs::read_to_string(here.join("again.csv")).unwrap();
    let rows: Vec<Vec<f64>> = (text.lines())
        .filter(|line| !line.starts_with(['#', 'j']))
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let expected = [
        [0.0, 0.0, 0.0, 0.0, 60.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 60.0, 0.0],
        [2.0, 2.0, 1.0, 0.0, 61.0, 5.0],
    ];
    assert_eq!(rows.len(), expected.len(), "{text}");
    for (row, expected) in rows.iter().zip(expected) {
        for (value, expected) in row.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-9, "{text}");
        }
    }
    let said = run(here, &words(&line.replace("--joint-rows linear ", "")));
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("--joint-rows"), "{said:?}");
}

#[test]
fn what_is_missing_is_named() {
    let here = place();
    for (line, needle) in [
        (
            "convert part.mod --to joints --out q.csv",
            "no model is named",
        ),
        (
            "convert part.mod --to joints --model orthoglide --out q.csv",
            "is no arm of six turning joints",
        ),
        (
            "convert part.mod --to csv --model heavy_6r --out q.csv",
            "--model is for tables of joint values",
        ),
        (
            "convert part.ngc --to joints --model heavy_6r --out q.csv --template cell.toml --tool-orientation a_b_c_kuka_deg=160,0,180",
            "where the part is: pose under [base]",
        ),
        (
            "convert far.mod --to joints --model heavy_6r --out q.csv",
            "line 7: ",
        ),
    ] {
        std::fs::write(here.path().join("part.ngc"), "G21 G90\nG0 X0 Y0 Z5\nM2\n").unwrap();
        let far = PART.replace("[[60,5,-1.25]", "[[6000,5,-1.25]");
        std::fs::write(here.path().join("far.mod"), far).unwrap();
        let said = run(here.path(), &words(line));
        assert_eq!(said.code, 1, "{line}: {said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(needle), "{needle}: {text}");
        assert!(!here.path().join("q.csv").exists());
    }
}
