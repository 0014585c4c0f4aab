//! Programs that state the direction of the tool's axis alone, through the commands: against the same poses in whole.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::fmt::Write as _;
use std::path::Path;

use kinetostat_testing::least;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::common::run;

/// Steps from one corner to the next: whole poses turn about one axis between two of them, on which the tool's axis leaves its
/// great circle by the square of a step.
const STEPS: usize = 32;

/// The places of a program: straight from corner to corner, with axes on great circles.
fn poses() -> Vec<([f64; 3], Vector3<f64>)> {
    let corners = corners();
    let mut poses = vec![corners[0]];
    for ends in corners.windows(2) {
        let [(from, first), (to, last)] = [ends[0], ends[1]];
        let between = UnitQuaternion::rotation_between(&first, &last).unwrap();
        for step in 1..=STEPS {
            let share = step as f64 / STEPS as f64;
            let place = [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            poses.push((place, between.powf(share) * first));
        }
    }
    poses
}

/// Corners in the part with axes that lean to all sides, mm.
fn corners() -> Vec<([f64; 3], Vector3<f64>)> {
    let lean = |by: f64, around: f64| {
        let (by, around) = (by.to_radians(), around.to_radians());
        Vector3::new(by.sin() * around.cos(), by.sin() * around.sin(), by.cos())
    };
    vec![
        ([0.0, 0.0, 20.0], lean(0.0, 0.0)),
        ([0.0, 0.0, -1.0], lean(12.0, 35.0)),
        ([60.0, 10.0, -2.0], lean(25.0, 130.0)),
        ([80.0, 70.0, 4.0], lean(18.0, -100.0)),
        ([-20.0, 40.0, 9.0], lean(7.0, 200.0)),
    ]
}

/// x of the tool as near as possible to -x of the part, z of the tool against the axis.
fn whole(axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    let x = (-Vector3::x() + axis * axis.x).normalize();
    let z = -axis;
    let matrix = Matrix3::from_columns(&[x, z.cross(&x), z]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
}

fn apt() -> String {
    let mut text = "PARTNO/LEANING\nUNITS/MM\nMULTAX\nFEDRAT/1200,MMPM\nRAPID\n".to_owned();
    for ([x, y, z], axis) in poses() {
        writeln!(
            text,
            "GOTO/{x},{y},{z},{:.9},{:.9},{:.9}",
            axis.x, axis.y, axis.z
        )
        .unwrap();
    }
    text + "FINI\n"
}

fn rapid() -> String {
    let mut text = "MODULE Leaning\n  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\n  \
        PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1800,0,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n  PROC main()\n"
        .to_owned();
    for (index, ([x, y, z], axis)) in poses().into_iter().enumerate() {
        let q = whole(&axis);
        let word = match index {
            0 => "MoveJ",
            _ => "MoveL",
        };
        writeln!(
            text,
            "    {word} [[{x},{y},{z}],[{:.9},{:.9},{:.9},{:.9}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;",
            q.w, q.i, q.j, q.k
        )
        .unwrap();
    }
    text + "  ENDPROC\nENDMODULE\n"
}

/// Numbers with one of their last printed digit.
fn table(here: &Path, name: &str) -> Vec<Vec<(f64, f64)>> {
    let text = std::fs::read_to_string(here.join(name)).unwrap();
    let mut rows = text.lines();
    let columns: Vec<&str> = rows.next().unwrap().split(',').collect();
    // What is written between the ends has the turn of the rule in one file and that of the controller in the other; two quaternions
    // are one rotation.
    let compared = [
        "x_mm",
        "y_mm",
        "z_mm",
        "error_before",
        "correction",
        "force",
        "orientation",
    ];
    let wanted: Vec<usize> = (0..columns.len())
        .filter(|index| {
            compared
                .iter()
                .any(|name| columns[*index].starts_with(name))
        })
        .collect();
    assert!(wanted.len() >= 16, "{columns:?}");
    rows.map(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        let number = |index: &usize| -> Option<(f64, f64)> {
            let number: f64 = cells[*index].parse().ok()?;
            let decimals = cells[*index].split('.').nth(1).map_or(0, str::len);
            let number = match columns[*index].starts_with("orientation") {
                true => number.abs(),
                false => number,
            };
            Some((number, 0.1_f64.powi(decimals as i32)))
        };
        wanted.iter().filter_map(number).collect()
    })
    .collect()
}

fn alike(here: &Path, [one, other]: [&str; 2], within: f64) {
    let (a, b) = (table(here, one), table(here, other));
    assert!(
        a.len() > 20 && a.len() == b.len(),
        "{} {}",
        a.len(),
        b.len()
    );
    for (row, (a, b)) in a.iter().zip(&b).enumerate() {
        assert_eq!(a.len(), b.len(), "row {row}");
        for (column, ((a, a_digit), (b, b_digit))) in a.iter().zip(b).enumerate() {
            let off = (a - b).abs();
            // Of both digits the smaller one: a number that ends in zeros is printed without them.
            let is_rounding = off < 1.01 * least([*a_digit, *b_digit]);
            assert!(
                off < within * (1.0 + a.abs()) || is_rounding,
                "row {row}, number {column}: {a} and {b}"
            );
        }
    }
}

#[test]
fn an_arm_runs_axes_as_the_same_poses_in_whole() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("a.apt"), apt()).unwrap();
    std::fs::write(here.join("a.mod"), rapid()).unwrap();
    let job = |program: &str, robot: &str| {
        format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"{program}\"\n[load]\nweight = \"all\"\nmilling = {{ radial_n = 300, tangential_n = -100, axial_n = -50 }}\n{robot}"
        )
    };
    let frames = "[robot.frames]\nTOOL = { position_mm = [0, 0, 180] }\nPART = { position_mm = [1800, 0, 900] }\n";
    let turn = "[robot]\nturn_about_axis = { tool = \"x\", part = \"-x\" }\n";
    let put = |name: &str, text: String| std::fs::write(here.join(name), text).unwrap();
    put("apt.toml", job("a.apt", &format!("{turn}{frames}")));
    put("mod.toml", job("a.mod", ""));
    run(
        here,
        &[
            "compensate",
            "apt.toml",
            "--points",
            "apt.csv",
            "--all-points",
        ],
    )
    .answered();
    run(
        here,
        &[
            "compensate",
            "mod.toml",
            "--points",
            "mod.csv",
            "--all-points",
        ],
    )
    .answered();
    alike(here, ["apt.csv", "mod.csv"], 1e-5);
    let written = std::fs::read_to_string(here.join("a-compensated.apt")).unwrap();
    // The axes of the program are there as they were printed.
    for line in apt().lines().filter(|line| line.starts_with("GOTO")) {
        let axis = line.splitn(4, ',').nth(3).unwrap();
        assert!(written.contains(axis), "{axis}");
    }
    // The other rule is said, and is another posture.
    put("least.toml", job("a.apt", frames));
    let said = run(here, &["check", "least.toml"]).answered();
    let words: Vec<&str> = said.out.split_whitespace().collect();
    let words = words.join(" ");
    assert!(
        words
            .contains("about it the tool is taken to turn as little as possible from pose to pose"),
        "{words}"
    );
    // A direction along the axis says nothing.
    put(
        "along.toml",
        job(
            "a.apt",
            &format!("[robot]\nturn_about_axis = {{ tool = \"z\", part = \"x\" }}\n{frames}"),
        ),
    );
    let refused = run(here, &["check", "along.toml"]);
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("lies along its axis"), "{refused:?}");
}

/// The model of the book's chapter of five axes.
fn portal() -> String {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/tutorials/five-axes.md");
    let text = std::fs::read_to_string(book).unwrap();
    let model = text.split("```toml\n").nth(1).unwrap();
    model.split("```").next().unwrap().to_owned()
}

/// Directions of the axis where the head stands at A and the table at C: the table turns by -C, the part with it.
fn direction(a: f64, c: f64) -> Vector3<f64> {
    let (a, c) = (a.to_radians(), c.to_radians());
    // The head leans z to -y by A; in the part the tool then turns by C.
    let leaned = Vector3::new(0.0, -a.sin(), a.cos());
    Vector3::new(
        leaned.x * c.cos() - leaned.y * c.sin(),
        leaned.x * c.sin() + leaned.y * c.cos(),
        leaned.z,
    )
}

#[test]
fn a_machine_of_five_axes_points_its_tool_as_the_same_angles_do() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("portal.toml"), portal()).unwrap();
    let places = [
        ([60.0, 0.0, 50.0], (20.0, 0.0)),
        ([60.0, 0.0, 0.0], (20.0, 0.0)),
        ([0.0, 60.0, 0.0], (20.0, 90.0)),
        ([-60.0, 0.0, -5.0], (35.0, 170.0)),
        ([0.0, -60.0, -5.0], (10.0, 230.0)),
    ];
    let mut code = "G21 G90 G94\nG0 A0 C0\nG0 X60 Y0 Z50\nG43.4 H1 Z50\n".to_owned();
    let mut apt = "UNITS/MM\nRAPID\nGOTO/60,0,50,0,0,1\nFEDRAT/600,MMPM\n".to_owned();
    let begin = "G0 X60 Y0 Z50 A3=0 B3=0 C3=1\n";
    let mut mpf = format!("G71 G90 G94\nTRAORI\n{begin}");
    for (index, ([x, y, z], (a, c))) in places.into_iter().enumerate() {
        let d = direction(a, c);
        let (word, rapid) = match index {
            0 => ("G0", "RAPID\n"),
            _ => ("G1 F600", ""),
        };
        writeln!(code, "{word} X{x} Y{y} Z{z} A{a} C{c}").unwrap();
        writeln!(
            apt,
            "{rapid}GOTO/{x},{y},{z},{:.10},{:.10},{:.10}",
            d.x, d.y, d.z
        )
        .unwrap();
        writeln!(
            mpf,
            "{word} X{x} Y{y} Z{z} A3={:.10} B3={:.10} C3={:.10}",
            d.x, d.y, d.z
        )
        .unwrap();
    }
    code += "G0 Z50\nG49\nM30\n";
    apt += "RAPID\nGOTO/0,-60,50\nFINI\n";
    mpf += "G0 Z50\nM30\n";
    // Between two directions the axes turn evenly, as those of angles do, or the tool goes on the great circle.
    let even = mpf.replace(begin, &format!("ORIAXES\n{begin}"));
    for (name, text) in [
        ("a.nc", &code),
        ("even.mpf", &even),
        ("a.apt", &apt),
        ("a.mpf", &mpf),
    ] {
        std::fs::write(here.join(name), text).unwrap();
        let line = format!(
            "compensate --model portal.toml --weight all --program {name} --tool-length-mm 120 --milling 400 -150 -80 --part-origin-mm 0 0 100 --points {name}.csv --all-points"
        );
        let words: Vec<&str> = line.split_whitespace().collect();
        run(here, &words).answered();
    }
    // At feed: rapids begin otherwise in G-code. Where a move is looked at may differ; at the same places all is the same.
    let feeds = |name: &str| -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(here.join(name)).unwrap();
        let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let at = |wanted: &str| columns.iter().position(|name| *name == wanted).unwrap();
        let wanted = [
            "share",
            "x_mm",
            "y_mm",
            "z_mm",
            "error_before_x_mm",
            "error_before_y_mm",
            "error_before_z_mm",
            "A_command_deg",
        ]
        .map(at);
        (text.lines().skip(1))
            .map(|row| row.split(',').collect::<Vec<_>>())
            .filter(|cells| cells.contains(&"feed"))
            .map(|cells| wanted.map(|index| cells[index].to_owned()).to_vec())
            .collect()
    };
    let [code, even, apt, mpf] = ["a.nc.csv", "even.mpf.csv", "a.apt.csv", "a.mpf.csv"].map(feeds);
    let off = |a: &[String], b: &[String]| -> f64 {
        let numbers = a.iter().zip(b);
        let offs = numbers.map(|(a, b)| {
            let [a, b]: [f64; 2] = [a, b].map(|cell| cell.parse().unwrap());
            (a - b).abs()
        });
        // A table of numbers: none is missing.
        offs.fold(0.0, |sum, off| sum + off)
    };
    for (one, other) in [(&code, &even), (&apt, &mpf)] {
        let mut met = 0;
        for row in other {
            let mut known = one.iter().filter(|known| known[..4] == row[..4]).peekable();
            if known.peek().is_some() {
                met += 1;
                let least = known.any(|known| off(&known[4..], &row[4..]) < 5e-5);
                assert!(least, "{row:?}");
            }
        }
        assert!(
            met > other.len() / 2 && met > 300,
            "{met} of {}",
            other.len()
        );
    }
}
