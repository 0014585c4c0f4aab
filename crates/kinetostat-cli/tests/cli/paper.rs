//! Reports on paper: figures of the JSON, hashes of files, and nothing half written; what a reader of PDF gets out of them.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use serde_json::Value;

use crate::common::{run, workplace};

const PART: &str = "G21 G90\nG0 X-12 Y-9 Z5\nG0 Z0\nG1 X21 Y-4 F600\nG1 X25 Y13\nG0 Z5\nM2\n";

const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"größer.ngc\"\n[placement]\npart_origin_mm = [3, -2, 97]\n[tool]\nlength_mm = 100\n[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n[[features]]\nname = \"Nut\"\nlines = [4, 5]\ntolerance_um = 0.01\n";

#[test]
fn a_paper_has_the_figures_of_the_json_and_the_hashes_of_the_files() {
    let here = workplace();
    std::fs::write(here.path().join("größer.ngc"), PART).unwrap();
    std::fs::write(here.path().join("job.toml"), JOB).unwrap();
    let words = [
        "compensate",
        "job.toml",
        "--out",
        "out.ngc",
        "--json",
        "out.json",
        "--pdf",
        "ä.pdf",
        "--report",
        "ä.html",
        "--language",
        "de",
    ];
    let names = || {
        let all = std::fs::read_dir(here.path()).unwrap();
        let mut all: Vec<String> = all
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        all.sort();
        all
    };
    let before_run = names();
    // The feature is missed; files are in place.
    let output = run(here.path(), &words);
    assert_eq!(output.code, 3, "{output:?}");
    let read = |name: &str| std::fs::read(here.path().join(name)).unwrap();
    assert!(read("ä.pdf").starts_with(b"%PDF-1."));
    let page = String::from_utf8(read("ä.html")).unwrap();
    let found: Value = serde_json::from_slice(&read("out.json")).unwrap();
    // Three digits, rounded up, with a decimal comma: a bound of what the JSON has.
    let before = found["summary"]["max_position_error_before_mm"]
        .as_f64()
        .unwrap();
    let up = format!("{:.3}", (before * 1e3).ceil() / 1e3).replace('.', ",");
    assert!(page.contains(&format!("{up}\u{202f}mm")), "{up} in {page}");
    for file in found["question"]["files"].as_array().unwrap() {
        assert!(page.contains(file["sha256"].as_str().unwrap()), "{file}");
    }
    assert!(
        page.contains("geschriebenes Programm") && page.contains("VERFEHLT"),
        "{page}"
    );
    let made = names()
        .into_iter()
        .filter(|name| !before_run.contains(name));
    let made: Vec<String> = made.collect();
    let expected = ["out.json", "out.ngc", "ä.html", "ä.pdf"];
    assert_eq!(made, expected, "nothing half written stays");
    // What is there is not overwritten.
    assert_eq!(run(here.path(), &words).code, 1);
}

/// A pass into a block and back beside it: drives with ratings, forces from the cut, a feature that is missed.
const CUT: &str =
    "G21 G90\nS12000 M3\nG0 X-30 Y0 Z5\nG1 Z-2 F300\nG1 X30 F600\nG1 Y14\nG1 X-30\nG0 Z5\nM30\n";

fn cut_job(language: &str) -> String {
    format!(
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"pass.ngc\"\n[placement]\npart_origin_mm = [1400, 70, 500]\n[load]\nweight = \"all\"\n[tool]\nlength_mm = 200\ncutter = {{ shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30 }}\n[material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[0, -20, -12], [20, 30, 0]]\n[[features]]\nname = \"slot\"\nlines = [5, 5]\ntolerance_um = 25\n[[features]]\nname = \"back\"\nlines = [7, 7]\ntolerance_um = 0.01\n[output]\nprogram = \"out-{language}.ngc\"\njson = \"out-{language}.json\"\npdf = \"paper-{language}.pdf\"\nlanguage = \"{language}\"\n"
    )
}

/// Three digits that count, not below the number, without an exponent and without zeros that say nothing more.
fn up(value: f64) -> String {
    let digits = 2 - value.abs().log10().floor() as i32;
    let power = 10.0_f64.powi(digits);
    // What is exact in three digits stays what it is.
    let whole = (value * power - 1e-9).ceil();
    format!("{:.*}", digits.max(0) as usize, whole / power)
}

/// Three digits that count, the nearest.
fn nearest(value: f64) -> String {
    let digits = 2 - value.abs().log10().floor() as i32;
    format!("{value:.*}", digits.max(0) as usize)
}

/// A length in millimetres, or in micrometres where it is below a hundredth of one.
fn length(mm: f64) -> String {
    match mm < 0.01 {
        true => format!("{}µm", up(1e3 * mm)),
        false => format!("{}mm", up(mm)),
    }
}

/// The lines of a PDF as a reader has them, without spaces and with a decimal point; none where there is no reader.
fn lines_of_pdf(file: &std::path::Path) -> Option<Vec<String>> {
    let reader = std::process::Command::new("pdftotext")
        .arg("-layout")
        .arg(file)
        .arg("-")
        .output();
    let Ok(reader) = reader else {
        eprintln!("SKIPPED: pdftotext (poppler-utils) is not installed, so that no PDF is read");
        return None;
    };
    assert!(reader.status.success(), "{reader:?}");
    let text = String::from_utf8(reader.stdout).unwrap();
    let dense = |line: &str| -> String {
        let line = line.chars().filter(|c| !c.is_whitespace());
        line.map(|c| if c == ',' { '.' } else { c }).collect()
    };
    Some(text.lines().map(dense).collect())
}

/// Whoever signs reads what is wrong and what is warned of, as who reads the text.
#[test]
fn the_paper_of_a_verification_says_what_is_otherwise_than_in_the_original() {
    let here = workplace();
    let with: Vec<&str> =
        "--model heavy_6r --weight all --force 200 -150 300 --tool-length-mm 150 --part-origin-mm 1300 50 900"
            .split(' ')
            .collect();
    std::fs::write(here.path().join("pass.ngc"), CUT).unwrap();
    let mut words = vec!["compensate", "--program", "pass.ngc", "--out", "out.ngc"];
    words.extend(&with);
    assert_eq!(run(here.path(), &words).code, 0);
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    for (from, to, code, says) in [
        ("S12000", "S9000", 3, "ANOTHERSPEEDOFTHESPINDLE"),
        ("M3", "M4", 3, "THESPINDLEDOESNOTTURNASINTHEORIGINAL"),
    ] {
        std::fs::write(here.path().join("other.ngc"), text.replace(from, to)).unwrap();
        let mut words = vec!["verify", "other.ngc", "--against", "pass.ngc"];
        words.extend(["--pdf", "paper.pdf", "--force-overwrite"]);
        words.extend(&with);
        let said = run(here.path(), &words);
        assert_eq!(said.code, code, "{said:?}");
        let Some(lines) = lines_of_pdf(&here.path().join("paper.pdf")) else {
            return;
        };
        assert!(lines.concat().contains(says), "{lines:?}");
    }
}

/// What a reader of PDF gets out of the paper is what the JSON holds, in all three languages; output and language are the job's.
#[test]
fn the_numbers_in_the_pdf_are_those_of_the_json() {
    let here = workplace();
    std::fs::write(here.path().join("pass.ngc"), CUT).unwrap();
    let words = [
        ("en", "largesterrorofthetool", "kept", "MISSED", "deg"),
        ("fr", "plusgrandécartdeposition", "tenue", "NONTENUE", "°"),
        (
            "de",
            "größterPositionsfehler",
            "eingehalten",
            "VERFEHLT",
            "°",
        ),
    ];
    for (language, largest, kept, missed, degrees) in words {
        let job = format!("job-{language}.toml");
        std::fs::write(here.path().join(&job), cut_job(language)).unwrap();
        let output = run(here.path(), &["compensate", &job]);
        // The second feature is missed; the files are in place.
        assert_eq!(output.code, 3, "{output:?}");
        let json = std::fs::read(here.path().join(format!("out-{language}.json"))).unwrap();
        let found: Value = serde_json::from_slice(&json).unwrap();
        let Some(lines) = lines_of_pdf(&here.path().join(format!("paper-{language}.pdf"))) else {
            return;
        };
        let number = |value: &Value| value.as_f64().unwrap();
        let row = |begins: &str, holds: &[String]| {
            let expected = holds.concat();
            let rows: Vec<&String> = lines.iter().filter(|l| l.starts_with(begins)).collect();
            assert!(
                rows.iter().any(|line| line.contains(&expected)),
                "{language}: no line '{begins}' with {expected} among {rows:?}"
            );
        };
        let summary = &found["summary"];
        let [before, after] = ["before", "after"]
            .map(|when| number(&summary[format!("max_position_error_{when}_mm")]));
        row(largest, &[length(before), length(after)]);
        for (feature, verdict) in [(0, kept), (1, missed)] {
            let own = &found["features"][feature];
            let sizes = [
                length(number(&own["error_before_mm"])),
                length(number(&own["error_after_mm"])),
            ];
            row(own["name"].as_str().unwrap(), &sizes);
            row(own["name"].as_str().unwrap(), &[verdict.to_owned()]);
        }
        // Drives beside their ratings: of the most loaded one its share and its torque.
        let drives = found["question"]["actuators"].as_array().unwrap();
        assert_eq!(drives.len(), 6);
        let most = &found["joints"]["most_loaded"];
        for (at, drive) in drives.iter().enumerate() {
            let name = drive["name"].as_str().unwrap().replace(' ', "");
            let rated = number(&drive["rating_n_or_n_m"]);
            row(&name, &[format!("{rated}Nm")]);
            if Some(at as u64) == most["actuator"].as_u64() {
                let share = number(&most["share_of_rating"]);
                let torque = format!("{}Nm", up(share * rated));
                row(&name, &[torque, format!("{rated}Nm{}%", up(100.0 * share))]);
            }
        }
        // The cut: force, torque and power at the place with the largest force, each to the nearest digit.
        let cut = &found["cutting"]["largest_force"];
        let parts = ["along_feed", "left", "up"].map(|way| number(&cut[format!("force_{way}_n")]));
        let force = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        let held = [
            format!("{}N", nearest(force)),
            format!("{}Nm", nearest(number(&cut["torque_n_m"]))),
            format!("{}W", nearest(number(&cut["power_w"]))),
        ];
        row(&cut["line"].to_string(), &held);
        let all = lines.concat();
        let tilt = up(number(&summary["max_residual_rotation_deg"]));
        assert!(all.contains(&format!("{tilt}{degrees}")), "{tilt}");
        for file in found["question"]["files"].as_array().unwrap() {
            assert!(all.contains(file["sha256"].as_str().unwrap()), "{file}");
        }
    }
}

/// A robot's operator compares with the pendant: the tool stands there in the angles of the controller.
#[test]
fn the_tool_stands_in_the_angles_of_its_controller() {
    let here = workplace();
    let krl = "DEF slot()\n$TOOL={X 0,Y 0,Z 180,A 30,B 0,C 0}\n$BASE={X 1800,Y 0,Z 900,A 0,B 0,C 0}\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 50,A 10,B 0,C 180}\nLIN {X 0,Y 0,Z 0,A 10,B 0,C 180}\nLIN {X 100,Y 0,Z 0,A 20,B 5,C 180}\nEND\n";
    std::fs::write(here.path().join("slot.src"), krl).unwrap();
    let words = [
        "compensate",
        "--model",
        "heavy_6r",
        "--weight",
        "all",
        "--program",
        "slot.src",
        "--tool-axis",
        "-z",
        "--milling",
        "215",
        "-10",
        "-25",
        "--out",
        "out.src",
        "--json",
    ];
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let of = |name: &str| found["question"][name].as_str().unwrap().to_owned();
    let stands = of("tool_orientation");
    assert!(
        stands.starts_with("A 10.0000, B 0.0000, C 180.0000 deg in the axes of the program"),
        "{stands}"
    );
    let tool = of("tool");
    assert!(
        tool.contains("(A 30.0000, B 0.0000, C 0.0000 deg)"),
        "{tool}"
    );
}

#[test]
fn number_and_revision_of_the_part_stand_in_reports_and_result() {
    let here = workplace();
    let here = here.path();
    let job = std::fs::read_to_string(here.join("job.toml")).expect("a job");
    std::fs::write(
        here.join("job.toml"),
        format!("{job}part_number = \"4711-02 <A>\"\nrevision = \"C\"\n"),
    )
    .expect("written");
    for (language, name) in [
        ("en", "Part number"),
        ("de", "Teilenummer"),
        ("fr", "Numéro de la pièce"),
    ] {
        let line = format!(
            "compensate job.toml --language {language} --report r.html --pdf r.pdf --json r.json --force-overwrite --revision D"
        );
        let words: Vec<&str> = line.split(' ').collect();
        run(here, &words).answered();
        let page = std::fs::read_to_string(here.join("r.html")).expect("a page");
        assert!(
            page.contains(name) && page.contains("4711-02 &lt;A&gt;"),
            "{language}"
        );
        let result = std::fs::read_to_string(here.join("r.json")).expect("a result");
        let result: serde_json::Value = serde_json::from_str(&result).expect("JSON");
        let inputs = &result["question"];
        // An option goes before the job.
        assert_eq!(
            (&inputs["part_number"], &inputs["revision"]),
            (&"4711-02 <A>".into(), &"D".into())
        );
        if let Some(lines) = lines_of_pdf(&here.join("r.pdf")) {
            assert!(
                lines.iter().any(|line| line.contains("4711-02<A>")),
                "{language}"
            );
        }
    }
    // The machine is drawn without a report on a page, too.
    let words = "compensate job.toml --pdf alone.pdf --force-overwrite";
    run(here, &words.split(' ').collect::<Vec<_>>()).answered();
    if let Some(lines) = lines_of_pdf(&here.join("alone.pdf")) {
        assert!(lines.iter().any(|line| line.contains("Themachineatline")));
    }
    let said = run(here, &["check", "job.toml", "--part-number", "two\nlines"]);
    assert_eq!(said.code, 1);
    assert!(said.err.contains("--part-number"), "{}", said.err);
}
