//! Programs divided into a main file and parts: compensated as one, and written back as their files.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::run;

const CELL: &str = "schema = 1\nrapid_speed_mm_per_s = 200\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\npose = { position_mm = [1800, 0, 900] }\n[tool]\npose = { position_mm = [0, 0, 180] }\n";

const RUN: &str = "--model heavy_6r --weight all --force 60 20 100 --tool-axis -z";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

/// A wave of 40 cuts, with the template of a cell for one file and for parts of 20 places.
fn place() -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    let mut text = "G21 G90\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\n".to_owned();
    for x in 0..40_i32 {
        let y = f64::from((x * x) % 17) / 2.0;
        text.push_str(&format!("G1 X{x} Y{y} F600\n"));
    }
    text.push_str("G0 Z5\nM30\n");
    std::fs::write(here.path().join("wave.ngc"), text).unwrap();
    std::fs::write(here.path().join("one.toml"), CELL).unwrap();
    let parts = CELL.replace("schema = 1\n", "schema = 1\nmost_points = 20\n");
    std::fs::write(here.path().join("parts.toml"), parts).unwrap();
    for folder in ["one", "parts", "sent"] {
        std::fs::create_dir(here.path().join(folder)).unwrap();
    }
    here
}

/// The straight motions of files, one behind the other.
fn motions(here: &Path, names: &[&str]) -> Vec<String> {
    let texts = names.iter().map(|name| read(here, name));
    let lines = texts.flat_map(|text| text.lines().map(str::to_owned).collect::<Vec<_>>());
    let lines = lines.map(|line| line.trim().to_owned());
    lines
        .filter(|line| line.starts_with("LIN {") || line.starts_with("MoveL "))
        .collect()
}

#[test]
fn a_divided_program_is_compensated_as_a_whole() {
    for (to, ending) in [("krl", "src"), ("rapid", "mod")] {
        let here = place();
        let here = here.path();
        for form in ["one", "parts"] {
            let line = format!(
                "convert wave.ngc --to {to} --template {form}.toml --out {form}/wave.{ending}"
            );
            run(here, &words(&line)).answered();
        }
        let line = format!("compensate {RUN} --program one/wave.{ending} --out one/out.{ending}");
        run(here, &words(&line)).answered();
        let line =
            format!("compensate {RUN} --program parts/wave.{ending} --out sent/wave.{ending}");
        let said = run(here, &words(&line)).answered();
        assert!(
            said.out.contains(&format!("of wave_3.{ending}")),
            "{said:?}"
        );
        // The same motions as those of the program in one file, each in its part.
        let parts: Vec<String> = (1..=3).map(|n| format!("sent/wave_{n}.{ending}")).collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        let together = motions(here, &parts);
        assert_eq!(together, motions(here, &[&format!("one/out.{ending}")]));
        assert!(together.len() > 40, "{}", together.len());
        for part in &parts {
            let own = part.replace("sent", "parts");
            assert!(!motions(here, &[part]).is_empty());
            assert_ne!(read(here, part), read(here, &own));
            // Neither the whole nor a part is compensated twice. A part of RAPID does not say by itself what its frames are.
            std::fs::write(
                here.join("part.toml"),
                format!("schema = 1\nmodel = \"heavy_6r\"\nprogram = \"{part}\"\n[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n[robot]\ntool_axis = \"-z\"\nframes.tool1 = {{ position_mm = [0, 0, 180] }}\nframes.wobj1 = {{ position_mm = [1800, 0, 900] }}\n"),
            )
            .unwrap();
            let job = match to {
                "rapid" => "part.toml".to_owned(),
                _ => format!("{RUN} --program {part}"),
            };
            let line = format!("compensate {job} --out z.{ending}");
            let said = run(here, &words(&line));
            assert!(
                said.code == 1 && said.err.contains("marked as compensated"),
                "{said:?}"
            );
        }
        let main = read(here, &format!("sent/wave.{ending}"));
        assert!(main.contains("kinetostat: compensated program") && !main.contains("next file"));
        let rest = |text: &str| -> Vec<String> {
            let lines = text.lines().filter(|line| !line.contains("kinetostat: "));
            lines.map(str::to_owned).collect()
        };
        assert_eq!(
            rest(&main),
            rest(&read(here, &format!("parts/wave.{ending}")))
        );
    }
}

/// Nothing changes where nothing is to be corrected, and names of files in one folder differ from those of the source.
#[test]
fn a_divided_program_without_correction_comes_back_byte_for_byte() {
    let here = place();
    let here = here.path();
    run(
        here,
        &words("convert wave.ngc --to krl --template parts.toml --out parts/wave.src"),
    )
    .answered();
    for name in ["wave.src", "wave_1.src", "wave_3.src"] {
        // Line endings of the files, and one without an ending at its end.
        let text = read(here, &format!("parts/{name}")).replace('\n', "\r\n");
        let text = text.trim_end().to_owned();
        std::fs::write(here.join("parts").join(name), text).unwrap();
    }
    let none = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n";
    let rows = [-10, 50].map(|x| {
        [-10, 50]
            .map(|y| [-20, 20].map(|z| format!("{x},{y},{z},0,0,0\n")).concat())
            .concat()
    });
    std::fs::write(here.join("none.csv"), format!("{none}{}", rows.concat())).unwrap();
    let line =
        "compensate --map none.csv --program parts/wave.src --out sent/wave.src --tool-axis -z";
    run(here, &words(line)).answered();
    for name in ["wave.src", "wave_1.src", "wave_2.src", "wave_3.src"] {
        let (own, sent) = (
            read(here, &format!("parts/{name}")),
            read(here, &format!("sent/{name}")),
        );
        assert_eq!(own, sent, "{name}");
    }
    let line =
        "compensate --map none.csv --program parts/wave.src --out parts/new.src --tool-axis -z";
    run(here, &words(line)).answered();
    assert!(here.join("parts/new-wave_2.src").exists());
}

#[test]
fn to_a_robot_in_parts() {
    let here = place();
    let here = here.path();
    for (to, ending) in [("krl", "src"), ("rapid", "mod")] {
        let line = |form: &str, out: &str| {
            format!(
                "compensate --model heavy_6r --weight all --program wave.ngc --force 60 20 100 --to {to} --template {form}.toml --out {out}.{ending} --part-origin-mm 1800 0 900 --tool-length-mm 180"
            )
        };
        run(here, &words(&line("one", "single"))).answered();
        let said = run(here, &words(&line("parts", "several"))).answered();
        assert!(said.out.contains("of wave.ngc"), "{said:?}");
        let parts: Vec<String> = (1..=3).map(|n| format!("several_{n}.{ending}")).collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        assert_eq!(
            motions(here, &parts),
            motions(here, &[&format!("single.{ending}")])
        );
    }
    let line = "compensate --model heavy_6r --weight all --program wave.ngc --force 60 20 100 --to ls --template parts.toml --part-origin-mm 1800 0 900 --tool-length-mm 180";
    let said = run(here, &words(line));
    assert!(
        said.code == 1 && said.err.contains("most_points"),
        "{said:?}"
    );
}
