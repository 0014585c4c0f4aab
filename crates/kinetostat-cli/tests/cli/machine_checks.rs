//! `kinetostat check`: what it counts and names, and that singular postures near an answer are reported.

use crate::common::checks::{
    ARM, BAR, COLUMN, HEAVY, checked, edited, flat, of, preset, texts, warnings,
};
use crate::common::{MODEL, PROGRAM, run, workplace};
use serde_json::Value;

#[test]
fn over_constraint_is_counted_and_the_fighting_directions_named() {
    let (found, text) = preset("orthoglide", &[]);
    let home = &found["home"];
    assert_eq!(home["degrees_of_over_constraint"], 3);
    let named = texts(&home["over_constraints"]);
    assert_eq!(named.len(), 3);
    // Three legs that all keep the tool from turning fight with moments about x, y and z.
    for axis in ["x", "y", "z"] {
        let moment = format!("with a moment about {axis}, against leg");
        assert!(named.iter().any(|n| n.contains(&moment)), "{named:?}");
    }
    assert!(named.iter().all(|n| !n.contains("force")), "{named:?}");
    assert!(text.contains("over-constraint 1: leg"), "{text}");

    let (found, text) = preset("puu3", &[]);
    assert_eq!(found["home"]["degrees_of_over_constraint"], 0);
    assert!(texts(&found["home"]["over_constraints"]).is_empty());
    assert!(text.contains("no over-constraint"), "{text}");
}

#[test]
fn limbs_alike_are_reported_once() {
    let (found, text) = preset("stewart_gough_b", &[]);
    assert_eq!(found["limbs"].as_array().map(Vec::len), Some(6));
    assert!(
        text.contains("6 limbs alike, from 'base' to 'tool':"),
        "{text}"
    );
    assert_eq!(text.matches("actuator 'ram'").count(), 1, "{text}");
    assert!(
        found["home"]["stiffness_rank"] == 6 && text.contains("rank 6:"),
        "{text}"
    );
}

#[test]
fn redundant_joints_are_named_by_limb_and_joint() {
    // A second shoulder at the same place: one motion leaves the tool where it is.
    let twice = edited(
        ARM,
        &[(
            "  { body = \"upper mass\"",
            "  { actuator = \"revolute\", name = \"twin\", axis = \"z\", rigid_drive = true, limits_deg = [-90, 90] },\n  { body = \"upper mass\"",
        )],
    );
    let (found, text) = checked(&twice, &[]);
    let home = &found["home"];
    assert_eq!(home["redundant_motions"], 1);
    assert_eq!(
        texts(&home["redundant_actuators"]),
        ["arm: shoulder", "arm: twin"]
    );
    assert!(
        flat(&text).contains("(redundant): arm: shoulder, arm: twin move then"),
        "{text}"
    );
    let (found, text) = checked(ARM, &[]);
    assert_eq!(found["home"]["redundant_motions"], 0);
    assert!(text.contains("no joint is redundant"), "{text}");
    // A bar between two spherical joints turns about itself.
    let (found, _) = checked(BAR, &[]);
    let passive = texts(&found["home"]["redundant_passive_joints"]);
    assert!(passive.contains(&"strut: near.x".to_owned()), "{passive:?}");
    assert!(passive.contains(&"strut: far.x".to_owned()), "{passive:?}");
}

#[test]
fn the_reach_of_an_arm_is_that_of_its_stretched_elbow() {
    // The elbow stops at 40 degrees: the law of cosines.
    let (a, b, stop) = (500.0_f64, 300.0_f64, 40_f64.to_radians());
    let exact = (a * a + b * b + 2.0 * a * b * stop.cos()).sqrt();
    let (found, _) = checked(ARM, &[]);
    let reach = &found["reach"];
    let close = |value: &Value, exact: f64| (value.as_f64().expect("mm") - exact).abs() < 1e-3;
    assert!(close(&reach["from_first_axis_mm"], exact), "{reach}");
    assert!(close(&reach["from_base_mm"], exact.hypot(200.0)), "{reach}");
    // The passive joints of a chain may stand anywhere.
    let (found, _) = preset("two_link", &[]);
    assert!(close(&found["reach"]["from_base_mm"], 2000.0));
    // No limits, no reach.
    let slides = edited(BAR, &[(", limits_mm = [300, 500]", "")]);
    let (found, text) = checked(&slides, &[]);
    assert!(found["reach"]["from_base_mm"].is_null());
    assert!(flat(&text).contains("reach: not bounded: the actuator 'ram' slides without limits"));
}

#[test]
fn the_reach_of_a_parallel_machine_ends_at_the_limits_of_its_sliders() {
    // With y = z = 0 the slider of x moves as much as the tool: limits -430 .. -160, home -350.5.
    let (found, text) = preset("orthoglide", &[]);
    let reach = &found["reach"];
    for axis in 0..3 {
        for (side, exact) in [(0, 79.5), (1, 190.5)] {
            let far = reach["along_axes_mm"][axis][side].as_f64().expect("mm");
            assert!((far - exact).abs() < 0.1, "{reach}");
            let end = reach["ends"][axis][side].as_str().expect("a reason");
            assert!(end.starts_with("limit of 'leg "), "{end}");
        }
    }
    let corner = |i: usize, k: usize| reach["box_mm"][i][k].as_f64().expect("mm");
    // The workspace for which the limits were made is in reach but for its corners.
    assert!(
        (0..3).all(|k| (-79.6..-40.0).contains(&corner(0, k))),
        "{reach}"
    );
    assert!(
        (0..3).all(|k| (100.0..190.6).contains(&corner(1, k))),
        "{reach}"
    );
    assert!(
        text.contains("reach from home, mm: x -79.50 .. +190.5"),
        "{text}"
    );
}

#[test]
fn the_scale_of_stiffness_is_that_of_the_compliance() {
    let (found, _) = preset("orthoglide", &["--force", "0", "0", "-500"]);
    let a = &found["assumptions"];
    let here = workplace();
    let said = run(here.path(), &["stiffness", "orthoglide", "--json"]).answered();
    let k: Value = serde_json::from_str(&said.out).expect("JSON");
    let softest = 1e-3
        / k["compliance_m_rad_per_n"][0][0]
            .as_f64()
            .expect("compliance");
    let reported = a["against_force_n_per_mm"][0]
        .as_f64()
        .expect("a stiffness");
    assert!(
        (reported / softest - 1.0).abs() < 1e-3,
        "{reported} {softest}"
    );
    // The load that was requested, solved by another command.
    let said = run(
        here.path(),
        &[
            "deflect",
            "orthoglide",
            "--force",
            "0",
            "0",
            "-500",
            "--json",
        ],
    )
    .answered();
    let d: Value = serde_json::from_str(&said.out).expect("JSON");
    let moved = d["displacement_size_mm"].as_f64().expect("mm");
    let reported = a["reference_deflection_mm"].as_f64().expect("mm");
    assert!((reported / moved - 1.0).abs() < 1e-9, "{reported} {moved}");
    assert_eq!(
        a["reference_force_n"],
        serde_json::json!([0.0, 0.0, -500.0])
    );
    // What the matrix alone tells, as a vector.
    let off: f64 = (0..3)
        .map(|i| {
            let linear = -500e3
                * k["compliance_m_rad_per_n"][i][2]
                    .as_f64()
                    .expect("compliance");
            let solved = d["displacement_mm"][i].as_f64().expect("mm");
            (linear - solved).powi(2)
        })
        .sum::<f64>()
        .sqrt();
    let reported = a["linear_error_percent"].as_f64().expect("percent");
    assert!(
        (reported - 100.0 * off / moved).abs() < 1e-6,
        "{reported} {off}"
    );
}

#[test]
fn large_deflections_and_loads_near_buckling_are_reported() {
    let (found, text) = preset("orthoglide", &["--force", "0", "0", "-60000"]);
    assert!(
        flat(&text).contains("NOT small against the links"),
        "{text}"
    );
    assert!(found["assumptions"]["linear_error_percent"].as_f64() > Some(1.0));
    let (_, text) = preset("two_link", &[]);
    assert!(
        flat(&text).contains("far too much for this machine"),
        "{text}"
    );
    // A slender strut, held upright by a slide: 80 % of its Euler load.
    let (found, _) = checked(COLUMN, &[]);
    let euler = found["limbs"][0]["links"][0]["euler_load_n"]
        .as_f64()
        .expect("N");
    let load = format!("{}", -0.8 * euler);
    let (found, text) = checked(COLUMN, &["--force", &load, "0", "0"]);
    let share = found["assumptions"]["largest_share_of_euler_load"].as_f64();
    assert!((share.expect("a share") - 0.8).abs() < 0.01, "{share:?}");
    assert!(text.contains("NEAR BUCKLING"), "{text}");
    assert!(warnings(&found).iter().any(|w| w.contains("NEAR BUCKLING")));
}

#[test]
fn a_singular_posture_near_an_answer_is_reported_with_distance_and_direction() {
    let here = workplace();
    // Two bars of 1 m: stretched at 2 m.
    for (line, key) in [
        ("stiffness two_link --at 1999 0 0 --json", true),
        (
            "deflect two_link --at 1999 0 0 --force 0.001 0 0 --json",
            true,
        ),
        (
            "equilibria two_link --at 1999 0 0 --force 0.001 0 0 --json",
            false,
        ),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words).answered();
        let found: Value = serde_json::from_str(&said.out).expect("JSON");
        let warnings = warnings(&found);
        let reported =
            |w: &&String| w.contains("singular posture is near") && w.contains("along x");
        assert!(
            warnings.iter().any(|w| reported(&w)),
            "{line}: {warnings:?}"
        );
        assert!(
            flat(&said.err).contains("mm of tool motion away"),
            "{}",
            said.err
        );
        if key {
            let near = &found["near_singularity"];
            let mm = near["distance_mm"].as_f64().expect("mm");
            assert!((mm - 1.0).abs() < 1e-6, "{near}");
            assert!(near["kind"] == "lost" && near["limb"] == "arm", "{near}");
            assert!((near["motion_mm"][0].as_f64().expect("mm") - mm).abs() < 1e-6 * mm);
        }
    }
    let near_at = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words).answered();
        let found: Value = serde_json::from_str(&said.out).expect("JSON");
        found["near_singularity"].clone()
    };
    let mm = |near: &Value| near["distance_mm"].as_f64().expect("mm");
    // At home bent by 30 degrees.
    let near = near_at("stiffness two_link --json");
    let off = mm(&near) - 2000.0 * (1.0 - 15_f64.to_radians().cos());
    assert!(off.abs() < 1e-6, "{near}");
    assert!(near_at("stiffness two_link --joints theta=60 --json").is_null());
    // Arms of 325 and 275 mm, also exactly stretched.
    for (line, bend) in [
        ("stiffness two_link --joints theta=0 --json", 0.0),
        ("stiffness scara --joints J2=0 --json", 0.0),
        ("stiffness scara --joints J2=0.1 --json", 0.1_f64),
        ("stiffness scara --joints J2=20 --json", 20.0),
    ] {
        let near = near_at(line);
        let bend = bend.to_radians();
        let reach =
            (325.0_f64.powi(2) + 275.0_f64.powi(2) + 2.0 * 325.0 * 275.0 * bend.cos()).sqrt();
        let expected = if bend == 0.0 { 0.0 } else { 600.0 - reach };
        assert!((mm(&near) - expected).abs() < 1e-7, "{line}: {near}");
        assert!(near["kind"] == "lost", "{line}: {near}");
    }
    // At home of a machine.
    let (found, text) = preset("stewart_gough_a", &[]);
    let near = &found["assumptions"]["near_singularity"];
    assert!(
        near["distance_mm"] == 0.0 && near["kind"] == "gained",
        "{near}"
    );
    assert!(flat(&text).contains("this posture is singular"), "{text}");
    assert!(flat(&text).contains("stiffness falls to zero"), "{text}");
    let (found, _) = preset("stewart_gough_b", &[]);
    assert!(found["assumptions"]["near_singularity"].is_null());
}

#[test]
fn a_program_near_a_singular_posture_is_reported_on_screen_in_json_and_in_the_report() {
    let here = workplace();
    std::fs::write(here.path().join("part.ngc"), PROGRAM).expect("a file");
    let run_at = |x: &str| {
        let line = format!(
            "deflect heavy_6r --weight all --program part.ngc --part-origin-mm {x} 0 1400 --force 100 0 0 --report r.html --json r.json --force-overwrite"
        );
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words).answered();
        let read = |name| std::fs::read_to_string(here.path().join(name)).expect("a file");
        let found: Value = serde_json::from_str(&read("r.json")).expect("JSON");
        (found, flat(&said.out), flat(&read("r.html")))
    };
    let (found, text, page) = run_at("2500");
    let near = &found["near_singularity"];
    assert!(near["line"].as_u64() > Some(0), "{near}");
    // Farthest out on the circle is nearest to the stretched arm.
    assert!(
        (near["position_mm"][0].as_f64().expect("mm") - 20.0).abs() < 8.0,
        "{near}"
    );
    assert!(near["distance_mm"].as_f64() < Some(180.0), "{near}");
    for said in [text.as_str(), page.as_str()] {
        assert!(said.contains("of tool motion away"), "{said}");
    }
    let (found, text, page) = run_at("1500");
    assert!(found["near_singularity"].is_null(), "{found}");
    assert!(!text.contains("singular") && !page.contains("of tool motion away"));
}

#[test]
fn no_springs_are_named_where_there_are_none() {
    let text = edited(
        COLUMN,
        &[(
            r#"{ link = "rod", name = "rod", length_mm = 1000, segments = 4 }"#,
            "{ rigid = { translation_mm = [1000, 0, 0] } }",
        )],
    );
    let (_, words) = checked(&text, &[]);
    assert!(!flat(&words).contains("springs hold the tool"), "{words}");
}

/// A rod along x that stands on a drive turning about y.
fn standing_rod(diameter_mm: f64, drive: &str) -> String {
    format!(
        r#"schema = 1
[mechanism]
name = "standing rod"
[section.rod]
round = {{ diameter_mm = {diameter_mm} }}
youngs_modulus_gpa = 210
poissons_ratio = 0.3
[[platform]]
name = "tool"
home = {{ position_mm = [1000, 0, 0] }}
[chain.arm]
elements = [
  {{ actuator = "revolute", name = "foot", axis = "y", {drive} }},
  {{ link = "rod", name = "rod", length_mm = 1000, segments = 8 }},
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#
    )
}

/// `x tan x = k L / (E I)` between 0 and a right angle.
fn root_of_hinge(ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..100 {
        let x = 0.5 * (low + high);
        if x * x.tan() < ratio {
            low = x;
        } else {
            high = x;
        }
    }
    0.5 * (low + high)
}

#[test]
fn a_free_machine_near_buckling_is_reported_against_closed_forms() {
    let rigidity = |d: f64| 210e9 * std::f64::consts::PI * d.powi(4) / 64.0;
    // Held fast at its foot, by pi^2 E I / (4 L^2); on a drive that gives way.
    let fast = rigidity(0.02) * std::f64::consts::FRAC_PI_2.powi(2);
    let hinged = rigidity(0.12) * root_of_hinge(1e5 / rigidity(0.12)).powi(2);
    for (text, critical) in [
        (standing_rod(20.0, "rigid_drive = true"), fast),
        (standing_rod(120.0, "stiffness_n_m_per_rad = 1e5"), hinged),
    ] {
        for share in [0.2, 0.9, 0.99] {
            let load = format!("{}", -share * critical);
            let (found, words) = checked(&text, &["--force", &load, "0", "0"]);
            let a = &found["assumptions"];
            let reported = a["largest_share_to_instability_of_free_machine"]
                .as_f64()
                .expect("a share");
            // Links of eight pieces, and a share that is nearly straight in the load.
            assert!((reported - share).abs() < 0.01, "{reported}, exact {share}");
            let near = warnings(&found)
                .iter()
                .any(|w| w.contains("nearest to instability") && w.contains("NEAR BUCKLING"));
            assert_eq!(near, share > 0.5, "{words}");
            assert!(!words.contains("far from buckling"), "{words}");
        }
        let (found, _) = checked(&text, &["--force", &format!("{critical}"), "0", "0"]);
        let a = &found["assumptions"];
        let reported = a["largest_share_to_instability_of_free_machine"].as_f64();
        assert!(reported < Some(0.01), "a pull is no danger: {reported:?}");
    }
}

#[test]
fn a_machine_that_moves_only_while_it_turns_has_a_reach() {
    let (found, text) = preset("prs3", &[]);
    let reach = &found["reach"];
    let far = reach["from_base_mm"].as_f64().expect("mm");
    let [low, high] = [0, 1]
        .map(|side| [0, 1, 2].map(|k| reach["positions_span_mm"][side][k].as_f64().expect("mm")));
    // Straight down and up it slides with its legs; aside it gets only while it tilts.
    let straight = [0, 1].map(|k| reach["box_mm"][k][2].as_f64().expect("mm"));
    assert!(low[2] <= straight[0] + 0.1 && high[2] >= straight[1] - 0.1);
    assert!(low[0] < -10.0 && high[0] > 10.0, "{reach}");
    assert!(far >= -low[2] - 1e-6, "{reach}");
    let words = "reach from home, the tool turning as the machine turns it";
    assert!(flat(&text).contains(words), "{text}");
    assert_eq!(reach["orientation_follows"], true);
    // Followed aside from home: within what the search over all drives found, and not nothing.
    for axis in 0..2 {
        for (side, end) in [low, high].iter().enumerate() {
            let along = reach["along_axes_mm"][axis][side].as_f64().expect("mm");
            assert!(along > 10.0 && along < end[axis].abs() + 40.0, "{reach}");
        }
    }
}

#[test]
fn a_link_before_the_first_axis_keeps_the_reach_from_that_axis() {
    let text = standing_rod(20.0, "rigid_drive = true")
        .replace(
            "elements = [",
            "elements = [\n  { link = \"rod\", name = \"foot link\", length_mm = 400 },",
        )
        .replace("[1000, 0, 0]", "[1400, 0, 0]");
    let (found, _) = checked(&text, &[]);
    let from_axis = found["reach"]["from_first_axis_mm"].as_f64().expect("mm");
    assert!((from_axis - 1000.0).abs() < 1e-3, "{from_axis}");
}

#[test]
fn sound_models_raise_no_alarm() {
    for (name, text) in [
        ("arm", ARM),
        ("heavy", HEAVY),
        ("bar", BAR),
        ("column", COLUMN),
        ("model", MODEL),
    ] {
        let (found, _) = checked(text, &[]);
        let warnings: Vec<String> = warnings(&found)
            .into_iter()
            .filter(|w| w.starts_with("own.toml"))
            .collect();
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
    for preset_ in kinetostat_model::preset_names() {
        let (found, _) = preset(preset_.name, &[]);
        let warnings = warnings(&found);
        let singular = found["assumptions"]["near_singularity"].is_object();
        // The report's platform of equal hexagons is singular at home, its two links are 68 mm
        // from stretched; nothing else may be.
        assert_eq!(
            singular,
            ["stewart_gough_a", "two_link"].contains(&preset_.name),
            "{}",
            preset_.name
        );
        // Chapter 5 of the report has two chains because they buckle.
        let buckles = preset_.name.starts_with("two_chains");
        assert!(
            warnings.is_empty() || singular || buckles,
            "{}: {warnings:?}",
            preset_.name
        );
    }
}

#[test]
fn imported_arms_raise_no_alarm_but_of_placeholders_and_that_their_zero_posture_is_singular() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/urdf");
    let Ok(list) = std::fs::read_dir(&folder) else {
        eprintln!("SKIPPED: there are no URDF files at {}", folder.display());
        return;
    };
    let here = workplace();
    for entry in list {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|e| e != "urdf") {
            continue;
        }
        let file = path.display().to_string();
        let words = [
            "import",
            "urdf",
            &file,
            "--base",
            "base_link",
            "--tip",
            "tool0",
            "--joint-stiffness",
            "2e6",
            "-o",
            "own.toml",
            "--force-overwrite",
        ];
        run(here.path(), &words).answered();
        let (found, _) = of(run(here.path(), &["check", "own.toml", "--json"]));
        let warnings = warnings(&found);
        let placeholders: &[&str] = match path.file_stem().and_then(|stem| stem.to_str()) {
            Some("kuka_kr210l150") => &["the bodies weigh 3306 kg in all, much"],
            Some("kuka_kr120r2500pro") => &["have the same mass, 2 kg", "little for an arm"],
            _ => &[],
        };
        for words in placeholders {
            let said = warnings.iter().any(|w| w.contains(words));
            assert!(said, "{file}: {words}: {warnings:?}");
        }
        let other = |w: &&String| {
            let of_zero = w.starts_with("at home: ") || w.contains("singular at home");
            !of_zero && !placeholders.iter().any(|words| w.contains(words))
        };
        assert!(!warnings.iter().any(|w| other(&w)), "{file}: {warnings:?}");
        let reach = found["reach"]["from_first_axis_mm"].as_f64().expect("mm");
        assert!((800.0..4000.0).contains(&reach), "{file}: {reach}");
    }
}

/// A machine cannot do what its home asks for, by a little or by more, only where it cannot move.
#[test]
fn a_home_off_by_rounding_is_used_and_a_wrong_one_is_never_called_fine() {
    for (home, off) in [
        ("[500, 300, 200.001]", "0.001 mm"),
        ("[500, 300.000002, 198]", "2 mm"),
    ] {
        let (found, said) = checked(&edited(ARM, &[("[500, 300, 200]", home)]), &[]);
        assert!(found["home_problem"].is_null(), "{found}");
        let warnings = warnings(&found).join(" ");
        assert!(warnings.contains(off), "{warnings}");
        let exact = "home = { position_mm = [500, 300, 200], rotation_vector_deg = [0, 0, 90] }";
        assert!(
            flat(&warnings).contains(exact) || off.starts_with('2'),
            "{warnings}"
        );
        assert!(!said.contains("Nothing looks wrong"), "{said}");
    }
    let wrong = edited(ARM, &[("[500, 300, 200]", "[500, 300, 260]")]);
    let (found, said) = checked(&wrong, &[]);
    let problem = found["home_problem"].as_str().expect("a problem");
    assert!(problem.contains("position (500, 300, 200) mm"), "{problem}");
    assert!(!warnings(&found).is_empty(), "{found}");
    assert!(!said.contains("Nothing looks wrong"), "{said}");
}

#[test]
fn a_place_off_by_rounding_is_taken_to_the_nearest_and_others_are_refused_with_it() {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), ARM).expect("a file");
    let ask = |z: &str| {
        run(
            here.path(),
            &["deflect", "arm.toml", "--at", "500", "300", z],
        )
    };
    let said = flat(&ask("200.0001").answered().out);
    assert!(said.contains("the nearest is used"), "{said}");
    let refused = flat(&ask("200.01").err);
    assert!(refused.contains("position (500, 300, 200) mm"), "{refused}");
    assert!(!refused.contains("0.000 mm"), "{refused}");
}

/// A platform in between: an eight-digit place of the tool.
#[test]
fn a_home_of_eight_digits_serves_a_machine_with_a_platform_in_between() {
    let text = r#"schema = 1
[mechanism]
name = "bars"
[stiffness.bar]
matrix_n_mm_rad = [
  [3.25e4, 0, 0, 0, 0, 0],
  [0, 18.03, 0, 0, 0, -2878.5],
  [0, 0, 18.03, 0, 2878.5, 0],
  [0, 0, 0, 3.476e4, 0, 0],
  [0, 0, 2878.5, 0, 5.988e5, 0],
  [0, -2878.5, 0, 0, 0, 5.988e5],
]
[chain.drive]
elements = [{ actuator = "prismatic", name = "s", axis = "y", stiffness_n_per_mm = 500, home_mm = 0 }]
[chain.leg]
elements = [{ parallelogram = "bar", name = "q2", length_mm = 310, width_mm = 80, home_deg = 20 }]
[[platform]]
name = "slide"
home = { position_mm = [0, 0, 0] }
[[platform]]
name = "tool"
home = { position_mm = [291.30471, 0, -106.02624] }
[[limb]]
name = "drive"
from = "base"
to = "slide"
chain = "drive"
[[limb]]
name = "leg"
from = "slide"
to = "tool"
chain = "leg"
"#;
    let (found, _) = checked(text, &[]);
    assert!(found["home_problem"].is_null(), "{}", found["home_problem"]);
    let warnings = warnings(&found).join(" ");
    assert!(warnings.contains("the nearest pose"), "{warnings}");
}
