//! `verify`: where places of a program belong, and what else than its path differs from the original.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use crate::common::{run, workplace};
use crate::verify::{changed, compensated, line_of, number, part, verified};

/// A program and a job of a machine at a place, in a folder of their own.
fn job(program: &str, machine: &str, load: &str) -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("part.ngc"), program).unwrap();
    let job = format!("schema = 1\nprogram = \"part.ngc\"\n{machine}[load]\nmilling = {load}\n");
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    here
}

const ORTHOGLIDE: &str =
    "model = \"orthoglide\"\n[placement]\npart_origin_mm = [3, -2, 97]\n[tool]\nlength_mm = 100\n";

/// What `compensate` claims and what `verify` says of the same program, mm.
fn both(here: &Path, more: &[&str]) -> [f64; 2] {
    let claimed = compensated(here, more);
    let claimed = number(&claimed["summary"], "max_position_error_after_mm");
    let (code, found, said) = verified(here, "out.ngc", more);
    assert!(matches!(code, 0 | 4), "{said}");
    [claimed, number(&found, "max_position_error_mm")]
}

#[test]
fn an_arc_over_which_the_load_comes_has_the_error_that_is_claimed() {
    // 1.9 mm of arc: the load comes over most of it, and the corrected arc is another length at every place.
    let program = "G21 G90 G17\nG0 X-3.302 Y-4.761 Z8\nG0 Z-0.5\nG2 X-2.8279 Y-6.4904 I-5.4848 J-2.4325 F1200\nG0 Z8\nM2\n";
    let load = "{ radial_n = -258.5, tangential_n = 5.2, axial_n = 39.6 }";
    let here = job(program, ORTHOGLIDE, load);
    let [claimed, found] = both(here.path(), &["--tolerance-um", "1"]);
    assert!(claimed > 1e-4, "{claimed}");
    assert!(
        (0.9 * claimed..1.05 * claimed).contains(&found),
        "{found} {claimed}"
    );
}

#[test]
fn a_jump_that_gets_no_step_is_not_looked_for_on_a_way() {
    // Corners of a few degrees, at which the correction jumps by less than the tolerance: the writer takes it up on the next block.
    let mut program = "G21 G90 G17\nG0 X-20 Y0 Z5\nG0 Z0\n".to_owned();
    let (mut x, mut y) = (-20.0, 0.0);
    for k in 0..12 {
        let angle = f64::from(k).sin() * 0.02;
        x += 1.5 * f64::cos(angle);
        y += 1.5 * f64::sin(angle);
        program += &format!("G1 X{x:.4} Y{y:.4} F600\n");
    }
    program += "G0 Z5\nM2\n";
    let load = "{ radial_n = 215, tangential_n = -10, axial_n = -25 }";
    let here = job(&program, ORTHOGLIDE, load);
    let [claimed, found] = both(here.path(), &["--tolerance-um", "20"]);
    assert!(claimed > 1e-3, "{claimed}");
    assert!(
        (0.9 * claimed..1.05 * claimed).contains(&found),
        "{found} {claimed}"
    );
}

/// A job whose forces come from the cut.
fn cut_from_stock() -> tempfile::TempDir {
    let here = workplace();
    let program = "G21 G90 G17 G94\nT1 M6\nS12000 M3\nG0 X-45 Y21 Z10\nG1 Z-3 F2000\nG1 X45 F720\nG0 Z10\nM5\nM2\n";
    std::fs::write(here.path().join("part.ngc"), program).unwrap();
    let job = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [0, 0, 100]\n[tool]\nlength_mm = 60\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30, flute_length_mm = 18 }\n[material]\nname = \"AlMg4.5Mn\"\ncoolant = \"emulsion\"\n[stock]\nblock_mm = [[-30, -20, -20], [30, 20, 0]]\n[spindle]\npower_w = 800\nbase_rpm = 10000\nmost_rpm = 24000\n";
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    here
}

#[test]
fn other_feeds_and_speeds_are_other_forces() {
    let here = cut_from_stock();
    compensated(here.path(), &["--no-header"]);
    let (code, found, said) = verified(here.path(), "out.ngc", &["--tolerance-um", "10"]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert_eq!(found["matched"]["conditions"], serde_json::json!([]));
    for (from, to, what) in [
        (" F7", " F27", "ANOTHER FEED"),
        ("S12000", "S6000", "ANOTHER SPEED OF THE SPINDLE"),
        ("M3", "M4", "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL"),
    ] {
        let (code, _, said) = changed(here.path(), |text| text.replace(from, to));
        assert_eq!(code, 3, "{said}");
        assert!(said.contains(what), "{said}");
    }
}

#[test]
fn other_feeds_are_faults_where_the_load_is_stated() {
    let here = part();
    compensated(here.path(), &["--no-header"]);
    let (code, found, said) = changed(here.path(), |text| text.replace(" F", " F1"));
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("ANOTHER FEED: line"), "{said}");
    let conditions = &found["matched"]["conditions"];
    assert_eq!(conditions[0]["condition"], "feed", "{said}");
    assert_eq!(conditions[0]["of_original"], "600 mm/min", "{said}");
    let (_, found, said) = verified(here.path(), "out.ngc", &[]);
    assert_eq!(
        found["matched"]["conditions"],
        serde_json::json!([]),
        "{said}"
    );
}

#[test]
fn frames_that_the_original_does_not_state_are_faults() {
    let here = part();
    compensated(here.path(), &["--no-header"]);
    let (code, _, said) = changed(here.path(), |text| format!("G55\n{text}"));
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains("ANOTHER FRAME: lines")
            && said.contains("cut with G55, the original with no word for a frame"),
        "{said}"
    );
    // The first one is in force without a word.
    let (code, _, said) = changed(here.path(), |text| format!("G54\n{text}"));
    assert!(matches!(code, 0 | 4), "{said}");
    for (word, words) in [
        (
            "G43 H1",
            ["ANOTHER TOOL", "cut with G43 H1, the original with G49"],
        ),
        // By half a millimetre the control may leave the path.
        ("G64 P0.50", ["ANOTHER PATH MODE", "cut with G64 P0.5, the"]),
        (
            "T2 M6",
            ["ANOTHER TOOL: line", "with T2, the original with"],
        ),
    ] {
        let (code, _, said) = changed(here.path(), |text| format!("{word}\n{text}"));
        assert_eq!(code, 3, "{said}");
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
    // Whoever stops at corners follows the path no worse.
    let (code, found, said) = changed(here.path(), |text| format!("G61\n{text}"));
    assert!(matches!(code, 0 | 4), "{said}");
    assert!(
        found["warnings"].to_string().contains("cut with G61"),
        "{said}"
    );
}

/// A cut in a frame that lies elsewhere is no wrong input.
#[test]
fn a_cut_in_a_frame_that_is_far_away_is_a_fault() {
    let here = part();
    let frames = ["--work-offset", "G54=0,0,0", "--work-offset", "G55=400,0,0"];
    compensated(here.path(), &[&["--no-header"], &frames[..]].concat());
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    for cut in ["G0 Z-1\n", "G0 Z0\n"] {
        let from = text.find(cut).unwrap_or_else(|| panic!("{text}"));
        let other = format!("{}G55\n{}", &text[..from], &text[from..]);
        std::fs::write(here.path().join("other.ngc"), other).unwrap();
        let (code, _, said) = verified(here.path(), "other.ngc", &frames);
        assert_eq!(code, 3, "{cut}: {said}");
    }
}

/// The rounding of a program with three digits is part of what `compensate` allows itself.
#[test]
fn a_program_with_few_digits_is_verified_with_these() {
    let here = part();
    compensated(here.path(), &["--decimals", "3"]);
    let allowed = |more: &[&str]| {
        let (_, found, said) = verified(here.path(), "out.ngc", more);
        let allowed = found["allowed_mm"].as_f64();
        allowed.unwrap_or_else(|| panic!("{said}"))
    };
    let more = allowed(&["--decimals", "3"]) - allowed(&[]);
    // Half of the last digit along three axes.
    assert!((more - 0.75_f64.sqrt() * 0.9e-3).abs() < 1e-12, "{more}");
    let (code, _, said) = verified(here.path(), "out.ngc", &["--decimals", "3"]);
    assert!(matches!(code, 0 | 4), "{said}");
}

#[test]
fn a_circle_on_which_the_pose_is_corrected_is_verified() {
    let here = workplace();
    let target = |x: f64, y: f64, z: f64| {
        format!("[[{x},{y},{z}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]")
    };
    let with = "tMill\\WObj:=wPart;";
    let program = format!(
        "MODULE Slot\n  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\n  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1800,0,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n  PROC main()\n    MoveJ {},v500,z10,{with}\n    MoveL {},v20,fine,{with}\n    MoveL {},v20,z1,{with}\n    MoveC {},{},v20,fine,{with}\n    MoveL {},v200,fine,{with}\n  ENDPROC\nENDMODULE\n",
        target(0.0, 0.0, 20.0),
        target(0.0, 0.0, -1.0),
        target(60.0, 0.0, -1.0),
        target(80.0, 20.0, -1.0),
        target(60.0, 40.0, -1.0),
        target(60.0, 40.0, 20.0),
    );
    std::fs::write(here.path().join("arc.mod"), program).unwrap();
    let machine = [
        "--model",
        "heavy_6r",
        "--weight",
        "all",
        "--milling",
        "300",
        "-100",
        "-50",
        "--rapid-from-mm-per-s",
        "100",
        "--correct",
        "pose",
    ];
    let compensate = ["compensate", "--program", "arc.mod", "-o", "out.mod"];
    let output = run(here.path(), &[&compensate[..], &machine].concat());
    assert_eq!(output.code, 4, "{output:?}");
    let verify = ["verify", "out.mod", "--against", "arc.mod"];
    let output = run(here.path(), &[&verify[..], &machine].concat());
    assert_eq!(output.code, 4, "{output:?}");
    assert!(output.out.contains("VERIFIED"), "{output:?}");
}

#[test]
fn a_peck_at_feed_inside_what_is_drilled_cuts_nothing() {
    let holes = |lift: &str| {
        format!("G21 G90\nG0 X0 Y0 Z8\nG1 Z-3 F200\n{lift} Z1\n{lift} Z-2.5\nG1 Z-6\nG0 Z8\nM2\n")
    };
    let load = "{ radial_n = 0, tangential_n = 0, axial_n = -120 }";
    let here = job(&holes("G0"), ORTHOGLIDE, load);
    std::fs::write(here.path().join("other.ngc"), holes("G1")).unwrap();
    let (code, found, said) = verified(here.path(), "other.ngc", &["--tolerance-um", "2000"]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert_eq!(
        found["matched"]["extra_cuts"],
        serde_json::json!([]),
        "{said}"
    );
    // Into ground that is not drilled yet it is a cut.
    let deeper = holes("G1")
        .replace("G1 Z-2.5\n", "G1 Z-4.5\n")
        .replace("G1 Z-6\n", "");
    std::fs::write(here.path().join("other.ngc"), deeper).unwrap();
    let (code, _, said) = verified(here.path(), "other.ngc", &["--tolerance-um", "100"]);
    assert_eq!(code, 3, "{said}");
}

/// The first block of the circle is 15 um long, where the load comes over it, and as near to the lift out of the hole as corrections
/// are large: it was taken for that lift, and the program said to be off by what was left out.
#[test]
fn a_short_block_beside_a_lift_is_none() {
    const HEAVY: &str = "model = \"heavy_6r\"\n[placement]\npart_origin_mm = [1500, 0, 900]\n[tool]\nlength_mm = 180\n";
    let hole = "G0 X20 Y10 Z5\nG0 Z1\nG1 Z-2 F200\nG0 Z1\nG0 Z-1.8\nG1 Z-3 F200\nG0 Z5\nG0 Z-1\n";
    let circle = "G1 X20.5 F300\nG3 I-0.5 J0\nG1 X20\nG0 Z5\n";
    let slot = "G1 X22.1 Y10.3 F300\nG0 Z1\n";
    for cut in [circle, slot] {
        let load = "{ radial_n = 215, tangential_n = -10, axial_n = -25 }\nweight = \"all\"";
        let here = job(&format!("G21 G90\n{hole}{cut}M2\n"), HEAVY, load);
        let [claimed, found] = both(here.path(), &["--tolerance-um", "3"]);
        assert!(found <= claimed + 2e-4, "{found} {claimed}");
    }
}

#[test]
fn a_gouge_is_named_at_its_own_line() {
    let here = part();
    compensated(here.path(), &["--no-header"]);
    // Across the part, and back to where the cut was.
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let behind = 1 + line_of(&text, |line| line.starts_with("G3"));
    let (code, found, said) = changed(here.path(), |text| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let spike = ["G91", "G1 X-20 Y-22", "G1 X20 Y22", "G90"].map(str::to_owned);
        lines.splice(behind..behind, spike);
        lines.join("\n") + "\n"
    });
    assert_eq!(code, 3, "{said}");
    let wanted = format!("LINE {} IS A MOVE AT FEED", behind + 2);
    assert!(said.contains(&wanted), "{wanted}: {said}");
    assert_eq!(found["matched"]["uncut"], serde_json::json!([]), "{said}");
    // A slot that the original does not have.
    let (code, _, said) = changed(here.path(), |text| {
        text.replace("M2", "G0 X0 Y10\nG1 Z-1\nG1 X4\nG0 Z5\nM2")
    });
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("IS A MOVE AT FEED"), "{said}");
}
