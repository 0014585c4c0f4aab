//! Modes that count where chatter is judged, other speeds with their feeds, and the spread of the force: held against other
//! commands and against the changed program.

use std::path::Path;

use serde_json::Value;

use crate::common::{Said, run, workplace};

/// A slot along x; speed, feed and depth are put in.
const PROGRAM: &str =
    "G21 G90 G17\nT1 M6\nS{S} M3\nG0 X-10 Y0 Z5\nG1 Z-{Z} F{F}\nG1 X40\nG0 Z5\nM30\n";

const JOB: &str = r#"schema = 1
model = "{MODEL}"
program = "slot.ngc"
[placement]
part_origin_mm = [1450, 70, 500]
[tool]
length_mm = {LENGTH}
cutter = { shape = "flat", diameter_mm = 12, teeth = 2, helix_deg = 30 }
[material]
name = "{MATERIAL}"
[stock]
block_mm = [[0, -70, -10], [50, 40, 0]]
cell_mm = 0.3
"#;

/// The tool of the model bends at 700 Hz, on an arm of 12 Hz.
const TOOL: &str = "  { spring = \"prismatic\", name = \"tool bends y\", axis = \"y\", stiffness_n_per_m = 1.54755e7 },\n  \
    { spring = \"prismatic\", name = \"tool bends z\", axis = \"z\", stiffness_n_per_m = 1.54755e7 },\n  \
    { body = \"tool\", mass_kg = 0.8, centre_of_mass_mm = [0, 0, 0], inertia_kg_m2 = [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 1e-4]] },\n";

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

fn number(of: &Value, name: &str) -> f64 {
    of[name]
        .as_f64()
        .unwrap_or_else(|| panic!("no {name}: {of}"))
}

fn write(here: &Path, [model, length, material]: [&str; 3], [speed, feed, depth]: [f64; 3]) {
    let job = JOB
        .replace("{MODEL}", model)
        .replace("{LENGTH}", length)
        .replace("{MATERIAL}", material);
    let program = PROGRAM
        .replace("{S}", &speed.to_string())
        .replace("{F}", &feed.to_string())
        .replace("{Z}", &depth.to_string());
    std::fs::write(here.join("job.toml"), job).expect("written");
    std::fs::write(here.join("slot.ngc"), program).expect("written");
}

fn warned(of: &Value, part: &str) -> bool {
    of["warnings"].to_string().contains(part)
}

/// With modes up to 300 Hz the slot was called stable to 5 mm; the tool chatters from 0.9 mm on.
#[test]
fn a_tool_that_bends_at_700_hz_chatters_without_being_asked_for() {
    let here = workplace();
    let model = said(here.path(), "model show heavy_6r").answered().out;
    let at = model.find("  { body = \"flange mass\"").expect("a flange");
    let end = at + model[at..].find('\n').expect("a line") + 1;
    let with_tool = [&model[..end], TOOL, &model[end..]].concat();
    std::fs::write(here.path().join("tool.toml"), with_tool).expect("written");
    write(
        here.path(),
        ["tool.toml", "50", "linear aluminium"],
        [8300.0, 1660.0, 2.0],
    );
    let line = "chatter job.toml --damping 0.02 --json";
    let found = json(&said(here.path(), line).answered());
    assert_eq!(found["chatters"], true, "{found}");
    let limit = number(&found["nearest"], "limit_mm");
    let lobes = |more: &str| {
        let line = format!(
            "lobes tool.toml --damping 0.02 --teeth 2 --immersion 1 --coefficients-n-per-mm2 796 168 222 --tool-axis 0 0 1 --at 1470 70 498 \
             --tool-length-mm 50 --helix-deg 30 --diameter-mm 12 --rpm 8300 8300 1 --json{more}"
        );
        json(&said(here.path(), &line).answered())
    };
    let all = lobes(" --modes-up-to-hz 10000");
    let exact = number(&all["points"][0], "limit_mm");
    assert!((limit / exact - 1.0).abs() < 0.02, "{limit} {exact}");
    let automatic = lobes("");
    let own = number(&automatic["points"][0], "limit_mm");
    assert!((own / exact - 1.0).abs() < 5e-3, "{own} {exact}");
    for answer in [&found, &automatic] {
        let band = number(answer, "modes_up_to_hz");
        assert!(band > 710.0 && band < 1000.0, "{band}");
        assert!(!warned(answer, "counts by its flexibility at rest alone"));
    }
    // Who leaves it out is told.
    let few = lobes(" --modes-up-to-hz 300");
    assert!(few["points"][0]["limit_mm"].is_null(), "{few}");
    assert!(warned(&few, "the mode at 710"), "{few}");
    assert_eq!(few["best"]["no_limit_found"], true);
    let few = json(&said(here.path(), &format!("{line} --modes-up-to-hz 60")).answered());
    assert!(
        warned(&few, "counts by its flexibility at rest alone"),
        "{few}"
    );
}

/// A speed without room on both sides is offered as narrow, and it holds; it was "none near".
#[test]
fn a_stable_speed_without_room_is_offered_as_narrow() {
    let here = workplace();
    let of = ["heavy_6r", "200", "C45"];
    write(here.path(), of, [3600.0, 720.0, 0.25]);
    let text = said(here.path(), "chatter job.toml --damping 0.03 --json a.json")
        .answered()
        .out;
    let read = std::fs::read_to_string(here.path().join("a.json")).expect("read");
    let found: Value = serde_json::from_str(&read).expect("JSON");
    let stretch = &found["stretches"][0];
    let (rpm, feed) = (
        number(stretch, "stable_rpm"),
        number(stretch, "stable_feed_mm_per_min"),
    );
    assert_eq!(stretch["stable_speed_is_narrow"], true, "{stretch}");
    assert!(text.contains(", narrow"), "{text}");
    assert!((feed / rpm - 0.2).abs() < 1e-3, "{feed} {rpm}");
    write(here.path(), of, [rpm, feed, 0.25]);
    let found = json(&said(here.path(), "chatter job.toml --damping 0.03 --json").answered());
    assert_eq!(found["chatters"], false, "{found}");
}

/// One place of the stretch, between those at which all speeds are tried, chatters at 3300 rpm: it was offered, with the largest limit at
/// the others.
#[test]
fn an_offered_speed_holds_at_every_place() {
    let here = workplace();
    let job = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [1500, 0, 900]\n[tool]\nlength_mm = 150\n\
               cutter = { shape = \"flat\", diameter_mm = 12, teeth = 2, helix_deg = 45, flute_length_mm = 60 }\n\
               [material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[0, -40, -50], [60, 0, 0]]\n";
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    let of = |rpm: f64, feed: f64| {
        let program = format!(
            "G21 G90\nT1 M6\nS{rpm} M3\nG0 X-30 Y-3 Z5\nG0 Z-1\nG1 X90 F{feed}\nG0 Z5\nM2\n"
        );
        std::fs::write(here.path().join("part.ngc"), program).expect("written");
        json(&said(here.path(), "chatter job.toml --damping 0.03 --json").answered())
    };
    let stretch = of(3000.0, 300.0)["stretches"][0].clone();
    assert_eq!(stretch["speeds_tried"], true, "{stretch}");
    if let Some(rpm) = stretch["stable_rpm"].as_f64() {
        let feed = number(&stretch, "stable_feed_mm_per_min");
        assert_eq!(of(rpm, feed)["chatters"], false, "{rpm}: {stretch}");
    }
    assert_eq!(of(3300.0, 330.0)["chatters"], true);
}

/// The force of steel may be a fifth more than its law says: a cut that is nearer to its limit is stable by the law alone.
#[test]
fn a_limit_within_the_spread_of_the_force_is_told() {
    let here = workplace();
    let of = |depth: f64| {
        write(
            here.path(),
            ["heavy_6r", "200", "C45"],
            [3000.0, 600.0, depth],
        );
        let line = "chatter job.toml --damping 0.03 --json a.json --force-overwrite";
        let text = said(here.path(), line).answered().out;
        let read = std::fs::read_to_string(here.path().join("a.json")).expect("read");
        let answer: Value = serde_json::from_str(&read).expect("JSON");
        (text.replace('\n', " "), answer)
    };
    let (text, near) = of(0.23);
    let nearest = &near["nearest"];
    let spread = number(nearest, "force_spread_percent");
    assert!(spread > 5.0, "{nearest}");
    assert_eq!(
        (&near["chatters"], &nearest["within_spread"]),
        (&false.into(), &true.into())
    );
    assert!(text.contains("lies within the spread"), "{text}");
    assert!(text.contains("% more than its law says"), "{text}");
    let (text, far) = of(0.1);
    assert_eq!(far["nearest"]["within_spread"], false, "{far}");
    assert!(!text.contains("spread"), "{text}");
}

/// What no machine and no material has is told, and a model without mass is not the fault of a line.
#[test]
fn damping_and_coefficients_that_nothing_has_are_told() {
    let here = workplace();
    let lobes = |more: &str| {
        let line = format!("lobes heavy_6r --teeth 2 --rpm 3000 3000 1 {more}");
        said(here.path(), &line)
    };
    let cut = "--coefficients-n-per-mm2 800 240 0";
    let answer = lobes(&format!("{cut} --loss-factor 1.5 --json")).answered();
    assert!(warned(&json(&answer), "a loss factor of 1.5"), "{answer:?}");
    let answer = lobes(&format!("{cut} --damping 0.7 --json")).answered();
    assert!(warned(&json(&answer), "70.0 % of critical"), "{answer:?}");
    let answer = lobes(&format!("{cut} --damping 0.03 --json")).answered();
    assert!(!warned(&json(&answer), "damping:"), "{answer:?}");
    // KA counts with its sign, positive towards the spindle, as in the laws of `force`.
    for (axial, limit_mm) in [(222, 0.7775), (-222, 0.7767)] {
        let line = format!(
            "--tool-length-mm 150 --damping 0.03 --immersion 0.5 --coefficients-n-per-mm2 796 168 {axial} --json"
        );
        let answer = json(&lobes(&line).answered());
        let found = answer["points"][0]["limit_mm"].as_f64().expect("a limit");
        assert!((found - limit_mm).abs() < 5e-5, "{axial}: {found}");
    }
    // Oblique cutting: a helix that lifts the chip draws the tool to the part, where KA is below zero.
    let right = "--helix-deg 30 --diameter-mm 12";
    let left = "--helix-deg -30 --diameter-mm 12";
    for (axial, helix, gives) in [
        (-222, right, None),
        (222, right, Some("give -222")),
        (222, left, None),
        (-222, left, Some("give 222")),
        (222, "", Some("give -222")),
    ] {
        let line =
            format!("--damping 0.03 --coefficients-n-per-mm2 796 168 {axial} --json {helix}");
        let answer = json(&lobes(line.trim_end()).answered());
        let is_asked = warned(&answer, "is its sign meant?");
        assert_eq!(is_asked, gives.is_some(), "{answer}");
        assert!(gives.is_none_or(|part| warned(&answer, part)), "{answer}");
    }
    for (given, part) in [
        (
            "796e6 168e6 0",
            "It looks like a value in Pa: in N/mm^2 it is 796",
        ),
        ("0.8 0.2 0", "5 to 20000"),
        ("800 240 -222e6", "more than any material"),
    ] {
        let refused = lobes(&format!("--damping 0.03 --coefficients-n-per-mm2 {given}"));
        assert_eq!(refused.code, 1, "{refused:?}");
        let text = refused.err.replace('\n', " ");
        assert!(text.contains(part), "{text}");
    }
    write(
        here.path(),
        ["orthoglide", "200", "C45"],
        [3000.0, 600.0, 0.2],
    );
    let job = std::fs::read_to_string(here.path().join("job.toml")).expect("read");
    let job = job.replace("[1450, 70, 500]", "[0, 0, 0]");
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    let refused = said(here.path(), "chatter job.toml --damping 0.03");
    assert!(refused.err.contains("has no mass anywhere"), "{refused:?}");
    assert!(!refused.err.contains("line "), "{refused:?}");
}
