//! Questions that contradict a file of before, or that nothing answers: each is refused or told by name.

use std::path::Path;

use crate::common::{JOB, PROGRAM, Said, run, workplace};

const GROOVE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nG0 Z10\nM30\n";

const CUT: &str = "[material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[-30, -30, -20], [30, 30, 0]]\ncell_mm = 0.5\n";

const CELL: &str = "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\npose = { position_mm = [1800, 0, 900] }\n[tool]\npose = { position_mm = [0, 0, 180] }\n";

const MAP: &str = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-100,0,0,0.1,0,0\n100,0,0,0.1,0,0\n";

/// Points beside the groove, every `step` along it.
fn points(step: f64, beside: f64) -> String {
    let rows = (0..=15).map(|k| format!("{},{beside},0\n", step * f64::from(k)));
    std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect()
}

fn command(here: &Path, line: &str) -> Said {
    run(here, &line.split_whitespace().collect::<Vec<_>>())
}

fn all_of(said: &Said) -> String {
    let text = format!("{} {}", said.out, said.err);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_contradicts_a_file_or_says_nothing_is_refused_or_told() {
    let here = workplace();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).expect("written");
    put("groove.ngc", GROOVE);
    put("t1.csv", &points(2.5, 0.05));
    put("t2.csv", &points(2.5, 0.01));
    put("metres.csv", &points(0.0025, 0.00005));
    put("map.csv", MAP);
    put(
        "other.toml",
        &JOB.replace("radial_n = 215", "radial_n = 300"),
    );
    put("moved.toml", &JOB.replace("[0, 0, 100]", "[0, 10, 100]"));
    put("plain.toml", JOB);
    put(
        "twice.toml",
        &JOB.replace("part.ngc", "tools.ngc")
            .replace("[load]", "[[tools]]\nnumber = 1\nlength_mm = 50\n[load]"),
    );
    put("tools.ngc", &PROGRAM.replacen("\nG0", "\nT1 M6\nG0", 1));
    put("cut.toml", &format!("{}{CUT}", JOB.replace("length_mm = 100", "length_mm = 100\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30, flute_length_mm = 18 }").replace("[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n", "").replace("part.ngc", "marked.ngc")));
    put(
        "cell.toml",
        &format!("{CELL}[spindle]\nclockwise = [\"$ANOUT[1]=0.3\"]\nstop = [\"$OUT[12]=FALSE\"]\n"),
    );
    put("slow.toml", &format!("rapid_speed_mm_per_s = 0.15\n{CELL}"));
    put(
        "slow.ngc",
        &PROGRAM.replace("F300", "F6").replace("F600", "F6"),
    );
    let turning = PROGRAM.replacen("\nG0", "\nS12000 M3\nG0", 1);
    put("turning.ngc", &turning);
    put(
        "factor.toml",
        "schema = 1\n[[uncertain]]\nload = \"factor\"\nuniform_percent = 10\n",
    );
    // Two states: without a model, and with one.
    for more in [
        "--state free.toml --out a.ngc",
        "--state held.toml --job job.toml --out b.ngc",
    ] {
        command(
            here,
            &format!("mirror groove.ngc --register none --measured t1.csv {more}"),
        )
        .answered();
    }
    // One of the lines of the header, and not the first.
    command(here, "compensate job.toml").answered();
    let out = std::fs::read_to_string(here.join("out.ngc")).expect("read");
    let (first, rest) = out.split_once('\n').expect("lines");
    assert_eq!(first, "(kinetostat: compensated program)");
    put("marked.ngc", &rest.replacen("G21", "S12000 M3\nG21", 1));
    let marked = "the program is marked as compensated";
    let cases: &[(&str, i32, &[&str])] = &[
        (
            "mirror groove.ngc --measured t2.csv --state free.toml --out no.ngc --job job.toml",
            1,
            &["free.toml: its trials", "the model (none there, orthoglide"],
        ),
        (
            "mirror groove.ngc --measured t2.csv --state held.toml --out no.ngc",
            1,
            &["held.toml: its trials", "none now)"],
        ),
        (
            "mirror groove.ngc --measured t2.csv --state held.toml --out no.ngc --job other.toml",
            1,
            &["differs now is the load", "215.0 there, 300.0 now"],
        ),
        (
            "mirror groove.ngc --measured t2.csv --state held.toml --out no.ngc --job moved.toml",
            1,
            &["differs now is the place of the part"],
        ),
        (
            "mirror groove.ngc --measured t2.csv --state held.toml --out held.ngc --job plain.toml",
            0,
            &[],
        ),
        (
            "mirror groove.ngc --register none --measured metres.csv --out no.ngc",
            1,
            &["span 0.03", "metres taken for millimetres"],
        ),
        (
            "mirror part.ngc --register none --measured marked.ngc --out no.ngc",
            1,
            &["marked.ngc: line 1", marked],
        ),
        (
            "mirror part.ngc --register none --measured part.ngc --out no.ngc",
            1,
            &["part.ngc: this is the program itself"],
        ),
        (
            "compensate job.toml --map map.csv --out no.ngc",
            1,
            &["--map corrects from a table, and the job names a model"],
        ),
        (
            "compensate job.toml --program marked.ngc --out no.ngc",
            1,
            &["line 1", "marked as compensated already"],
        ),
        (
            "compensate twice.toml --force-overwrite",
            0,
            &["the tool is stated twice", "[[tools]]"],
        ),
        ("deflect job.toml --program marked.ngc", 0, &[marked]),
        (
            "place job.toml --program marked.ngc --x-mm -5 5 --samples 8",
            0,
            &[marked],
        ),
        ("engagement cut.toml", 0, &[marked]),
        (
            "place orthoglide.toml --x-mm -5 5 --samples 8",
            0,
            &["there is nothing to minimise"],
        ),
        (
            "deflect job.toml --machine-zero-mm 0 0 300 --g28-mm 0 0 0",
            0,
            &["g28_mm, g30_mm) is stated, and no block goes by it"],
        ),
        (
            "tolerance orthoglide --uncertain factor.toml --machines 16",
            0,
            &["no load acts"],
        ),
        (
            "convert turning.ngc --to krl --template cell.toml --out spindle.src",
            0,
            &["the speed of the program is left out", "{rpm}"],
        ),
        (
            "convert slow.ngc --to krl --template slow.toml --out slow.src",
            0,
            &["0.15 mm/s is slow for rapids"],
        ),
    ];
    put(
        "orthoglide.toml",
        &JOB.replace(
            "milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n",
            "",
        ),
    );
    for (line, code, needles) in cases {
        let said = command(here, line);
        let is_right = said.code == *code || *code == 0 && said.code == 4;
        assert!(is_right, "{line}: {said:?}");
        let text = all_of(&said);
        for needle in *needles {
            assert!(text.contains(needle), "{line}: {needle}: {text}");
        }
        assert!(
            !here.join("no.ngc").exists(),
            "{line}: a program was written"
        );
    }
    // Without these questions, nothing of the kind is said.
    for line in ["deflect job.toml", "place job.toml --x-mm -5 5 --samples 8"] {
        let text = all_of(&command(here, line).answered());
        assert!(
            !text.contains("is marked") && !text.contains("nothing to minimise"),
            "{text}"
        );
        assert!(!text.contains("is stated, and no block goes"), "{text}");
    }
}
