//! `chatter`: the lines of a program that chatter, held against `lobes` at their places and against the program itself, changed
//! as the answer says.

use std::path::Path;
use std::sync::LazyLock;

use serde_json::Value;

use crate::common::{Said, run, workplace};

/// A slot along x, one along y (both 1 mm deep), and one that is 4 mm deep; the tool goes in from beside the block.
const PROGRAM: &str = "G21 G90 G17\nT1 M6\nS3000 M3\nG0 X-10 Y0 Z5\nG1 Z-1 F600\nG1 X40\nG0 Z5\nG0 X20 Y-20\nG1 Z-1\nG1 Y-60\nG0 Z5\n\
    G0 X-10 Y20\nG1 Z-4 F600\nG1 X40\nG0 Z5\nM30\n";

const JOB: &str = r#"schema = 1
model = "heavy_6r"
program = "slots.ngc"
[placement]
part_origin_mm = [1450, 70, 500]
[load]
weight = "all"
[tool]
length_mm = 200
cutter = { shape = "flat", diameter_mm = 12, teeth = 2, helix_deg = 30 }
[material]
name = "linear aluminium"
[stock]
block_mm = [[0, -70, -10], [50, 40, 0]]
cell_mm = 0.3
"#;

fn here(program: &str) -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("slots.ngc"), program).expect("written");
    std::fs::write(here.path().join("job.toml"), JOB).expect("written");
    here
}

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn answer(here: &Path) -> Value {
    let said = said(here, "chatter job.toml --damping 0.03 --json").answered();
    serde_json::from_str(&said.out).expect("JSON")
}

/// What is said of [`PROGRAM`], and its files: the run takes seconds, and several tests look at it.
struct OfProgram {
    text: String,
    answer: Value,
    csv: String,
    svg: String,
}

static OF_PROGRAM: LazyLock<OfProgram> = LazyLock::new(|| {
    let here = here(PROGRAM);
    let line = "chatter job.toml --damping 0.03 --csv all.csv --plot all.svg --json all.json";
    let text = said(here.path(), line).answered().out;
    let read = |name: &str| std::fs::read_to_string(here.path().join(name)).expect("read");
    OfProgram {
        text,
        answer: serde_json::from_str(&read("all.json")).expect("JSON"),
        csv: read("all.csv"),
        svg: read("all.svg"),
    }
});

fn list<'a>(of: &'a Value, name: &str) -> &'a Vec<Value> {
    of[name].as_array().expect("a list")
}

fn number(of: &Value, name: &str) -> f64 {
    of[name].as_f64().expect("a number")
}

/// The stretch of a line.
fn stretch(answer: &Value, line: u64) -> Option<&Value> {
    list(answer, "stretches").iter().find(|s| {
        let of = |name: &str| s[name].as_u64().expect("a line");
        (of("first_line")..=of("last_line")).contains(&line)
    })
}

#[test]
fn what_the_answer_says_of_a_program_holds_for_the_changed_program() {
    let found = &OF_PROGRAM.answer;
    assert_eq!(found["chatters"], true, "{found}");
    let deep = stretch(found, 14).expect("the deep slot chatters");
    let (limit, rpm) = (number(deep, "stable_depth_mm"), number(deep, "rpm"));
    assert_eq!(rpm, 3000.0);
    assert!(limit > 0.0 && limit < 4.0, "{deep}");
    // Whatever else is deeper than its limit chatters, too.
    for place in list(found, "places") {
        let verdict = place["verdict"].as_str().expect("a word");
        let below = place["limit_mm"]
            .as_f64()
            .is_none_or(|l| number(place, "depth_mm") < l);
        assert!(
            verdict == "not judged" || (verdict == "stable") == below,
            "{place}"
        );
    }
    for (share, chatters) in [(0.97, false), (1.03, true)] {
        let depth = share * limit;
        let other = here(&PROGRAM.replace("Z-4", &format!("Z-{depth:.4}")));
        let found = answer(other.path());
        assert_eq!(stretch(&found, 14).is_some(), chatters, "{depth} {found}");
    }
    if let Some(rpm) = deep["stable_rpm"].as_f64() {
        // The feed per tooth stays, and so is it said.
        let feed = 600.0 * rpm / 3000.0;
        let told = number(deep, "stable_feed_mm_per_min");
        assert!((told / feed - 1.0).abs() < 1e-3, "{told} {feed}");
        let text = format!("(F{feed:.0}");
        assert!(OF_PROGRAM.text.contains(&text), "{text}");
        let other = PROGRAM
            .replace("S3000", &format!("S{rpm:.1}"))
            .replace("F600", &format!("F{feed:.2}"));
        let found = answer(here(&other).path());
        assert!(stretch(&found, 14).is_none(), "{found}");
    }
}

/// Another command at the same place under the same force, with a slot by its width.
#[test]
fn limits_of_slots_are_those_of_lobes_at_their_places() {
    let found = &OF_PROGRAM.answer;
    let here = workplace();
    let mut compared = 0;
    for (line, feed) in [(6, "1 0 0"), (10, "0 -1 0"), (14, "1 0 0")] {
        let of_line = |p: &&Value| p["line"] == line && number(p, "exit_deg") > 179.9;
        let Some(place) = list(found, "places").iter().find(of_line) else {
            panic!("no slot on line {line}: {found}");
        };
        let Some(limit) = place["limit_mm"].as_f64() else {
            continue;
        };
        let at = place_in_base(place);
        let words = format!(
            "lobes heavy_6r --at {at} --tool-length-mm 200 --damping 0.03 --teeth 2 --helix-deg 30 --diameter-mm 12 \
             --coefficients-n-per-mm2 796 168 222 --immersion 1 --tool-axis 0 0 1 --feed-direction {feed} --rpm 3000 3001 2 --depth-mm 12 --json"
        );
        let other = said(here.path(), &words).answered();
        let other: Value = serde_json::from_str(&other.out).expect("JSON");
        let expected = number(&list(&other, "points")[0], "limit_mm");
        // The force of the cut (tens of newtons) hardly changes the modes.
        assert!(
            (limit / expected - 1.0).abs() < 2e-3,
            "{line}: {limit} {expected}"
        );
        compared += 1;
    }
    assert!(compared >= 2, "{compared}");
}

#[test]
fn what_has_no_answer_is_named() {
    let here = here(PROGRAM);
    let at = here.path();
    let refused = |line: &str, part: &str| {
        let said = said(at, line);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains(part), "{said:?}");
    };
    refused("chatter job.toml", "chatter needs damping");
    refused(
        "chatter job.toml --damping 0.03 --every-mm 0",
        "--every-mm is 0",
    );
    refused(
        "chatter job.toml --damping 0.03 --most-places 0",
        "--most-places is 0",
    );
    let write = |text: String| std::fs::write(at.join("other.toml"), text).expect("written");
    write(JOB.replace("\"flat\"", "\"ball\""));
    refused("chatter other.toml --damping 0.03", "a flat end mill");
    write(
        JOB.split("[material]")
            .next()
            .unwrap_or_default()
            .to_owned(),
    );
    refused(
        "chatter other.toml --damping 0.03",
        "says nothing of the cut",
    );
    write(
        JOB.replace("\"heavy_6r\"", "\"orthoglide\"")
            .replace("[1450, 70, 500]", "[0, 0, 0]"),
    );
    refused("chatter other.toml --damping 0.03", "has no mass anywhere");
}

/// A spindle that turns to the left is not judged, and that is said.
#[test]
fn a_spindle_that_turns_to_the_left_is_not_judged() {
    let here = here(&PROGRAM.replace("M3", "M4"));
    let found = answer(here.path());
    assert_eq!(
        (&found["chatters"], &found["places_judged"]),
        (&false.into(), &0.into())
    );
    let said = list(&found, "warnings").iter().any(|w| {
        w["message"]
            .as_str()
            .is_some_and(|text| text.contains("are not judged"))
    });
    assert!(said, "{found}");
}

/// A plunge is a force without a side in the cut: the places are counted, with the largest force.
#[test]
fn a_plunge_is_said_not_to_be_judged() {
    let here = here("G21 G90 G17\nT1 M6\nS3000 M3\nG0 X20 Y20 Z5\nG1 Z-4 F300\nG0 Z5\nM30\n");
    let found = answer(here.path());
    assert_eq!(found["places_in_cut"], 0);
    let said = list(&found, "warnings").iter().any(|w| {
        w["message"].as_str().is_some_and(|text| {
            text.contains("the side of the tool is not in the cut") && text.contains("on line 5")
        })
    });
    assert!(said, "{found}");
}

#[test]
fn files_hold_all_places() {
    let OfProgram {
        text,
        answer,
        csv,
        svg,
    } = &*OF_PROGRAM;
    assert!(text.contains("Lines that chatter"), "{text}");
    assert_eq!(csv.lines().count(), 1 + list(answer, "places").len());
    assert!(svg.contains("depth of the program"));
}

/// Two other commands give the harmonics of the force over a revolution and the receptance of the tip; their product is summed here.
#[test]
fn teeth_shake_the_tip_as_forces_and_receptance_say() {
    let found = &OF_PROGRAM.answer;
    let here = workplace();
    let mut compared = 0;
    // Where the feed points in base axes.
    for (line, along) in [(6, [1.0, 0.0]), (10, [0.0, -1.0])] {
        let of_line = |p: &&Value| {
            p["line"] == line && number(p, "exit_deg") > 179.9 && p["verdict"] == "stable"
        };
        let Some(place) = list(found, "places").iter().find(of_line) else {
            continue;
        };
        let forces = rotated(&slot_forces(here.path(), place), along);
        let receptance = receptance(here.path(), place);
        let harmonics: Vec<[Complex; 3]> = receptance
            .iter()
            .enumerate()
            .map(|(k, g)| {
                let c = harmonic(&forces, k + 1);
                [0, 1, 2].map(|i| g[i][0] * c[0] + g[i][1] * c[1] + g[i][2] * c[2])
            })
            .collect();
        let squares = harmonics.iter().flatten().map(|c| 0.5 * c.norm_sqr());
        let said = &place["vibration"];
        let rms = 1e6 * squares.sum::<f64>().sqrt();
        let agrees = |said: f64, expected: f64, part: f64| {
            assert!(
                (said - expected).abs() < part * expected.abs(),
                "{line}: {said} {expected}"
            );
        };
        agrees(number(said, "rms_um"), rms, 5e-3);
        assert_eq!(number(said, "tooth_passing_hz"), 100.0);
        assert_eq!(number(said, "strongest_hz"), 100.0);
        // To the left of the feed, um, positive into the left wall; the tool turns by a tooth (half a turn) a period.
        let aside = |turn: f64| -> f64 {
            let of = |(k, c): (usize, &[Complex; 3])| {
                let turned = Complex::from_polar(1.0, 2.0 * (k + 1) as f64 * turn);
                (turned * (c[1] * along[0] - c[0] * along[1])).re
            };
            1e6 * harmonics.iter().enumerate().map(of).sum::<f64>()
        };
        let lag = 30_f64.to_radians().tan() / 6.0;
        let depth = number(place, "depth_mm");
        let mut errors = Vec::new();
        for (angle, into) in [(0.0, 1.0), (std::f64::consts::PI, -1.0)] {
            errors
                .extend((0..=40).map(|i| into * aside(angle + lag * depth * f64::from(i) / 40.0)));
        }
        errors.sort_by(f64::total_cmp);
        let (least, most) = (errors[0], errors[errors.len() - 1]);
        assert!(
            (number(said, "wall_least_um") - least).abs() < 0.02 * rms,
            "{said} {least}"
        );
        assert!(
            (number(said, "wall_most_um") - most).abs() < 0.02 * rms,
            "{said} {most}"
        );
        compared += 1;
    }
    assert_eq!(compared, 2, "{found}");
    // A cut that chatters has no steady vibration.
    let told = |p: &Value| p["vibration"].is_object();
    assert!(
        list(found, "places")
            .iter()
            .all(|p| told(p) == (p["verdict"] == "stable"))
    );
    assert!(
        OF_PROGRAM.text.contains("shake the tip by up to"),
        "{}",
        OF_PROGRAM.text
    );
}

/// Dampers at joints couple modes and hold what has no mass: limits have all of that, and nothing is left to be told of it.
#[test]
fn dampers_that_couple_modes_are_in_the_limits() {
    let here = here(PROGRAM);
    let of = |line: &[&str]| {
        let dampers = ["--viscous", "joint 1=3e4", "--viscous", "joint 2=3e4"];
        let line = [line, &dampers, &["--json"]].concat();
        let answer: Value =
            serde_json::from_str(&run(here.path(), &line).answered().out).expect("JSON");
        let all = list(&answer, "warnings").iter();
        let mut texts = all.filter_map(|w| w["message"].as_str().map(str::to_owned));
        texts.find(|text| text.contains("this damping is not all in the modes"))
    };
    assert_eq!(of(&["chatter", "job.toml"]), None);
    let place = of(&[
        "lobes",
        "heavy_6r",
        "--at",
        "1450",
        "70",
        "500",
        "--teeth",
        "2",
        "--immersion",
        "1",
        "--up",
        "--coefficients-n-per-mm2",
        "800",
        "240",
        "0",
        "--rpm",
        "3000",
        "3000",
        "1",
    ]);
    assert_eq!(place, None);
}

/// A run of a job with `[chatter]` says the same as `chatter`, in its result, its text and its reports of all languages.
#[test]
fn a_run_reports_the_chatter_of_its_program() {
    let here = here(PROGRAM);
    let job = format!("{JOB}[chatter]\ndamping_ratio = 0.03\n");
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    let checked = said(here.path(), "check job.toml").answered().out;
    let told = "Chatter: judged along the program; damping: 0.03 of critical";
    assert!(checked.contains(told), "{checked}");
    let found = &OF_PROGRAM.answer;
    let mut seen = 0;
    for (language, head) in [
        ("en", "Where it chatters"),
        ("fr", "Broutement et vibrations"),
        ("de", "Rattern und Schwingungen"),
    ] {
        let line = format!(
            "deflect job.toml --language {language} --report {language}.html --pdf {language}.pdf --json {language}.json"
        );
        let text = said(here.path(), &line).answered().out;
        assert!(
            text.contains("One stretch of the program chatters."),
            "{text}"
        );
        assert!(text.contains("line 14: the cut chatters at 3000"), "{text}");
        let read = |end: &str| {
            std::fs::read_to_string(here.path().join(format!("{language}.{end}"))).expect("read")
        };
        let result: Value = serde_json::from_str(&read("json")).expect("JSON");
        let (own, stretch) = (&result["chatter"], &list(found, "stretches")[0]);
        for name in ["rpm", "depth_mm", "stable_depth_mm", "chatter_hz"] {
            let own = number(&list(own, "stretches")[0], name);
            assert_eq!(own, number(stretch, name), "{name}");
        }
        for (own, place) in list(own, "places").iter().zip(list(found, "places")) {
            assert_eq!(own["line"], place["line"]);
            assert_eq!(own["limit_mm"], place["limit_mm"]);
            assert_eq!(own["vibration_rms_um"], place["vibration"]["rms_um"]);
            seen += 1;
        }
        let report = read("html");
        let limit = format!("{:.2}", number(stretch, "stable_depth_mm"));
        let limit = match language {
            "en" => limit,
            _ => limit.replace('.', ","),
        };
        assert!(report.contains(&format!(">{limit}<")), "{limit} {report}");
        assert!(report.contains(head), "{report}");
        assert!(here.path().join(format!("{language}.pdf")).exists());
    }
    assert_eq!(seen, 3 * list(found, "places").len());
    // What the job asks is refused like the options.
    for (line, told) in [
        ("damping_ratio = 3", "a ratio to critical damping above 0"),
        ("most_places = 0", "a number from 1 to 1000000"),
        ("every_mm = -1", "a number above zero"),
        ("every = 1", "every_mm"),
    ] {
        let job = format!("{JOB}[chatter]\n{line}\n");
        std::fs::write(here.path().join("job.toml"), job).expect("written");
        let refused = said(here.path(), "deflect job.toml");
        assert_eq!(refused.code, 1, "{refused:?}");
        assert!(refused.err.contains(told), "{line}: {}", refused.err);
        assert!(refused.err.contains("job.toml:"), "{}", refused.err);
    }
    // No damping anywhere, and no cut.
    std::fs::write(here.path().join("job.toml"), format!("{JOB}[chatter]\n")).expect("written");
    for command in ["deflect", "check"] {
        let refused = said(here.path(), &format!("{command} job.toml"));
        assert_eq!(refused.code, 1, "{refused:?}");
        assert!(refused.err.contains("chatter needs damping"), "{refused:?}");
    }
    let cut = JOB.find("[material]").expect("material");
    let job = format!(
        "{}[chatter]\ndamping_ratio = 0.03\n",
        JOB[..cut].replace("[load]\n", "[load]\nforce_n = [1, 2, 3]\n")
    );
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    let refused = said(here.path(), "deflect job.toml");
    assert_eq!(refused.code, 1, "{refused:?}");
    assert!(
        refused.err.contains("says nothing of the cut"),
        "{}",
        refused.err
    );
}

type Complex = nalgebra::Complex<f64>;

/// Forces of the slot on the tool over a revolution, N: along the feed, to its left, up.
fn slot_forces(here: &Path, place: &Value) -> Vec<[f64; 3]> {
    let words = format!(
        "force --material;linear aluminium;--tool;flat;--diameter-mm;12;--teeth;2;--helix-deg;30;--width-mm;12;--depth-mm;{};--climb;\
         --feed-per-tooth-mm;{};--rpm;3000;--csv;f.csv;--force-overwrite",
        number(place, "depth_mm"),
        number(place, "feed_per_tooth_mm")
    );
    run(
        here,
        &words.replacen(' ', ";", 1).split(';').collect::<Vec<_>>(),
    )
    .answered();
    rows(here, "f.csv")
        .iter()
        .map(|row| [row[1], row[2], row[3]])
        .collect()
}

/// In base axes, of a feed that goes along `along` there.
fn rotated(forces: &[[f64; 3]], along: [f64; 2]) -> Vec<[f64; 3]> {
    let turn = |f: &[f64; 3]| {
        [
            f[0] * along[0] - f[1] * along[1],
            f[0] * along[1] + f[1] * along[0],
            f[2],
        ]
    };
    forces.iter().map(turn).collect()
}

/// The harmonic `F = Re sum c_k e^(i 2 k turn)` of two teeth that are alike.
fn harmonic(forces: &[[f64; 3]], k: usize) -> [Complex; 3] {
    let n = forces.len();
    let mut sum = [Complex::default(); 3];
    for (i, force) in forces.iter().enumerate() {
        let turned = Complex::from_polar(
            2.0 / n as f64,
            -std::f64::consts::TAU * (2 * k * i) as f64 / n as f64,
        );
        for (sum, force) in sum.iter_mut().zip(force) {
            *sum += turned * force;
        }
    }
    sum
}

/// Receptance (m/N) of the tip there, base axes, at 100, 200, ... 4000 Hz: motion by force.
fn receptance(here: &Path, place: &Value) -> Vec<[[Complex; 3]; 3]> {
    let at = place_in_base(place);
    let words = format!(
        "frf heavy_6r --at {at} --tool-length-mm 200 --damping 0.03 --from x,y,z --to x,y,z --frequencies 100 4000 40 --csv g.csv --force-overwrite"
    );
    said(here, &words).answered();
    // By columns: force along x with the three motions, then along y.
    let of = |row: &Vec<f64>, motion: usize, force: usize| {
        let at = 1 + 4 * (3 * force + motion);
        Complex::new(row[at], row[at + 1])
    };
    let all = rows(here, "g.csv");
    all.iter()
        .map(|row| [0, 1, 2].map(|m| [0, 1, 2].map(|f| of(row, m, f))))
        .collect()
}

fn place_in_base(place: &Value) -> String {
    let at: Vec<f64> = list(place, "position_mm")
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    [at[0] + 1450.0, at[1] + 70.0, at[2] + 500.0]
        .map(|x| x.to_string())
        .join(" ")
}

/// The numbers of a table.
fn rows(here: &Path, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(here.join(name)).expect("read");
    let row = |line: &str| {
        line.split(',')
            .map(|word| word.parse().expect("a number"))
            .collect()
    };
    text.lines().skip(1).map(row).collect()
}

/// With few places to judge, unlike ones stand in one group: its worst speaks for it, not its first.
#[test]
fn few_places_are_judged_by_their_worst() {
    let program = PROGRAM
        .replace("Z-1\n", "Z-1.8\n")
        .replace("Z-1 ", "Z-1.8 ");
    let program = program.replace("G0 X-10 Y20\nG1 Z-4 F600\nG1 X40\nG0 Z5\n", "");
    assert!(
        program.contains("Z-1.8 F600") && !program.contains("Z-4"),
        "{program}"
    );
    let here = here(&program);
    let all = answer(here.path());
    let text = |of: &Value| {
        list(of, "warnings")
            .iter()
            .map(|w| w["message"].to_string())
            .collect::<String>()
    };
    assert!(!text(&all).contains("--most-places"), "{}", text(&all));
    let worst = number(&all["nearest"], "limit_mm");
    assert!(all["chatters"] == true && worst < 1.8, "{all}");
    let line = "chatter job.toml --damping 0.03 --most-places 1 --json";
    let few: Value = serde_json::from_str(&said(here.path(), line).answered().out).expect("JSON");
    assert_eq!(list(&few, "places").len(), 1);
    assert_eq!(few["chatters"], true, "{few}");
    // The end of the path stands for what lies before it.
    let found = number(&few["nearest"], "limit_mm");
    assert!((found / worst - 1.0).abs() < 0.01, "{found} {worst}");
    assert!(
        text(&few).contains("a place between them may be worse"),
        "{}",
        text(&few)
    );
}

/// One pass speaks for those that are alike; but near its limit each is judged by itself, as if there were no others.
#[test]
fn passes_near_their_limit_are_judged_by_themselves() {
    let program = "G21 G90 G17\nT1 M6\nS3000 M3\nG0 X-10 Y-40 Z5\nG1 Z-0.9 F600\nG1 X60\nG1 Y-36\nG1 X-10\nG1 Y-32\nG1 X60\n\
                   G1 Y-28\nG1 X-10\nG0 Z5\nM30\n";
    let here = here(program);
    let alike = answer(here.path());
    let line = "chatter job.toml --damping 0.03 --every-mm 0.001 --most-places 100000 --json";
    let alone = said(here.path(), line).answered();
    let alone: Value = serde_json::from_str(&alone.out).expect("JSON");
    let mut compared = 0;
    for place in list(&alike, "places") {
        let at = |p: &&Value| (number(p, "path_mm") - number(place, "path_mm")).abs() < 1e-9;
        let own = list(&alone, "places").iter().find(at).expect("the place");
        assert_eq!(place["verdict"], own["verdict"], "{place} {own}");
        let Some(limit) = place["limit_mm"].as_f64().filter(|mm| *mm < 0.9 * 1.3) else {
            continue;
        };
        let expected = number(own, "limit_mm");
        assert!((limit / expected - 1.0).abs() < 1e-9, "{place} {own}");
        compared += 1;
    }
    assert!(compared >= 6, "{compared}");
}
