//! Holes of APT, blocks behind a slash of SINUMERIK, and work objects that lie on their sides, through the commands.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::run;

const HOLES: &str = "PARTNO/PLATE\nUNITS/MM\nSPINDL/500,RPM,CLW\nFEDRAT/600,MMPM\nRAPID\nGOTO/0,0,20\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,AUTO,MMPM,150\n\
    GOTO/10,5,0\nGOTO/40,-5,-1\nCYCLE/OFF\nGOTO/60,0,20\nFINI\n";

const JOB: &str = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"holes.apt\"\n[load]\nweight = \"all\"\nforce_n = [0, 0, 300]\n[tool]\nlength_mm = 180\n\
    [placement]\npart_origin_mm = [1800, 0, 900]\n";

const CELL: &str = "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Numbers of a KRL pose behind its letters.
fn pose(line: &str) -> Vec<f64> {
    let inner = line.split(['{', '}']).nth(1).unwrap();
    let parts = inner
        .split(',')
        .map(|part| part[2..].trim().parse().unwrap());
    parts.collect()
}

#[test]
fn holes_are_drilled_by_convert_and_compensate() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    put("holes.apt", HOLES);
    put("job.toml", JOB);
    put("cell.toml", CELL);
    let refused = run(here, &words("compensate job.toml --out none.apt"));
    assert_eq!(refused.code, 1);
    assert!(one_line(&refused.err).contains("(--expand)"), "{refused:?}");
    run(
        here,
        &words("convert holes.apt --expand --to krl --template cell.toml --out holes.src"),
    )
    .answered();
    let made = read(here, "holes.src");
    let motions: Vec<&str> = made
        .lines()
        .filter(|line| line.starts_with("PTP {") || line.starts_with("LIN {"))
        .collect();
    let heights: Vec<f64> = motions.iter().map(|line| pose(line)[2]).collect();
    // Up to the height before the cycle behind each hole, 20 mm.
    let expected = [20.0, 20.0, 3.0, -10.0, 20.0, 20.0, 2.0, -11.0, 20.0, 20.0];
    assert_eq!(heights.len(), expected.len(), "{made}");
    let near = heights.iter().zip(expected);
    assert!(
        near.into_iter().all(|(a, b)| (a - b).abs() < 1e-6),
        "{made}"
    );
    // 150 mm/min.
    assert_eq!(made.matches("$VEL.CP=0.0025\n").count(), 2, "{made}");
    run(
        here,
        &words("compensate job.toml --expand --out good.apt --points p.csv"),
    )
    .answered();
    let written = read(here, "good.apt");
    // Drilled at feed to the depths below both places, in the path along which it is compensated.
    let table = read(here, "p.csv");
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let columns = rows.next().unwrap();
    let column = |name: &str| columns.iter().position(|own| *own == name).unwrap();
    let [kind, share, x, z] = ["kind", "share", "x_mm", "z_mm"].map(column);
    let number = |text: &str| text.parse::<f64>().unwrap();
    let bottoms =
        rows.filter(|row| row[kind] == "feed" && row[share] == "1" && number(row[z]) < -9.0);
    let bottoms: Vec<[f64; 2]> = bottoms
        .map(|row| [x, z].map(|at| number(row[at])))
        .collect();
    assert!(
        bottoms.len() == 2
            && bottoms
                .iter()
                .zip([[10.0, -10.0], [40.0, -11.0]])
                .all(|(a, b)| { (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9 }),
        "{table}"
    );
    assert!(!written.contains("CYCLE"), "{written}");
    // The flat program is that of `expand`, in which nothing is left to write out.
    run(here, &words("expand holes.apt --out flat.apt")).answered();
    assert_eq!(read(here, "holes-flat.apt"), read(here, "flat.apt"));
    let said = run(here, &words("expand flat.apt --out again.apt")).answered();
    assert!(
        said.out.contains("Nothing was to be written flat"),
        "{said:?}"
    );
    assert_eq!(read(here, "again.apt"), read(here, "flat.apt"));
}

#[test]
fn the_switch_for_blocks_behind_a_slash_is_said() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    put(
        "a.mpf",
        "G90 G71 G17 G54\nT1 D1\nG0 X7 Y0 Z10\n/N50 G1 X8 F100\nG1 X10 F50\nM30\n",
    );
    put("cell.toml", CELL);
    for (word, count) in [("run", 3), ("skip", 2)] {
        let line = format!(
            "convert a.mpf --block-delete {word} --to krl --template cell.toml --out {word}.src"
        );
        let said = run(here, &words(&line)).answered();
        assert!(one_line(&said.out).contains("behind a slash"), "{said:?}");
        let made = read(here, &format!("{word}.src"));
        let motions = made
            .lines()
            .filter(|line| line.starts_with("PTP {") || line.starts_with("LIN {"));
        assert_eq!(motions.count(), count, "{made}");
    }
    let said = run(
        here,
        &words("convert a.mpf --to krl --template cell.toml --out none.src"),
    );
    assert!(
        said.code == 1 && one_line(&said.err).contains("--block-delete run or skip"),
        "{said:?}"
    );
}

#[test]
fn an_operation_on_its_side_is_solved_there() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    // The same places in the part, and the same axes: in two systems, and as axes in the part.
    let systems = "TOOL PATH/A,TOOL,MILL\nMSYS/0,0,50,1,0,0,0,0,1\nRAPID\nGOTO/10,20,50,0.0,0.0,1.0\nFEDRAT/MMPM,250\nGOTO/10,20,-1,0.0,0.0,1.0\nEND-OF-PATH\n\
        TOOL PATH/B,TOOL,MILL\nMSYS/0,0,0,1,0,0,0,1,0\nRAPID\nGOTO/10,20,50,0.0,0.0,1.0\nFEDRAT/MMPM,250\nGOTO/10,20,-1,0.0,0.0,1.0\nEND-OF-PATH\n";
    let axes = "TOOL PATH/A,TOOL,MILL\nRAPID\nGOTO/10,-50,70,0.0,-1.0,0.0\nFEDRAT/MMPM,250\nGOTO/10,1,70,0.0,-1.0,0.0\nEND-OF-PATH\n\
        TOOL PATH/B,TOOL,MILL\nRAPID\nGOTO/10,20,50,0.0,0.0,1.0\nFEDRAT/MMPM,250\nGOTO/10,20,-1,0.0,0.0,1.0\nEND-OF-PATH\n";
    let error = |name: &str, program: &str| -> Vec<f64> {
        put(&format!("{name}.cls"), program);
        let job = format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"{name}.cls\"\n[load]\nweight = \"all\"\nforce_n = [0, 0, 100]\n[tool]\nlength_mm = 180\n\
             [robot.frames]\nPART = {{ position_mm = [1800, 0, 900] }}\n"
        );
        put(&format!("{name}.toml"), &job);
        let line = format!("compensate {name}.toml --out {name}-good.cls --points {name}.csv");
        run(here, &words(&line)).answered();
        let text = read(here, &format!("{name}.csv"));
        let mut rows = text.lines();
        let columns: Vec<&str> = rows.next().unwrap().split(',').collect();
        let wanted: Vec<usize> = (0..columns.len())
            .filter(|index| {
                columns[*index].starts_with("joint_") && columns[*index].ends_with("_command_deg")
            })
            .collect();
        assert!(!wanted.is_empty(), "{columns:?}");
        let share = columns.iter().position(|own| *own == "share").unwrap();
        // Between the ends the stations are others.
        let rows = rows.map(|row| row.split(',').collect::<Vec<_>>());
        let rows: Vec<Vec<&str>> = rows
            .filter(|row| ["0", "1"].contains(&row[share]))
            .collect();
        let numbers = rows.iter().flat_map(|cells| {
            let own = wanted
                .iter()
                .map(|index| cells[*index].parse::<f64>().unwrap());
            own.collect::<Vec<_>>()
        });
        numbers.collect()
    };
    let (one, other) = (error("systems", systems), error("axes", axes));
    assert_eq!(one.len(), other.len());
    let off = one.iter().zip(&other).map(|(a, b)| (a - b).abs());
    let worst = off.fold(
        0.0,
        |worst: f64, off| if off <= worst { worst } else { off },
    );
    assert!(worst < 1e-3, "{worst}: {one:?} {other:?}");
}
