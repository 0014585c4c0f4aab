//! `kinetostat curve` and `kinetostat equilibria` of machines of several limbs: a truss by hand, a
//! parallel machine through its flat posture, and what is refused.

use crate::common::chains::{figure, json, named, number};
use crate::common::run;
use kinetostat_testing::Worst;
use serde_json::Value;

/// Half span, height (mm) and stiffness of each bar (N/mm).
const SPAN: f64 = 500.0;
const HEIGHT: f64 = 100.0;
const STIFFNESS: f64 = 100.0;

/// Two bars from the sides to a pin in the middle.
fn truss() -> tempfile::TempDir {
    truss_of(SPAN, HEIGHT)
}

/// The same of other sizes, mm.
fn truss_of(span: f64, height: f64) -> tempfile::TempDir {
    let here = tempfile::tempdir().expect("a directory");
    let (turn, length) = (span.atan2(height).to_degrees(), span.hypot(height));
    let chain = |name: &str, side: f64| {
        format!(
            r#"
[chain.{name}]
elements = [
  {{ rigid = {{ translation_mm = [{x:?}, 0, 0] }} }},
  {{ passive = "revolute", name = "foot", axis = "y", home_deg = {home:?} }},
  {{ actuator = "prismatic", name = "bar", axis = "z", stiffness_n_per_m = {k:?}, home_mm = {length:?} }},
  {{ passive = "revolute", name = "head", axis = "y", home_deg = {back:?} }},
]

[[limb]]
name = "{name}"
from = "base"
to = "pin"
chain = "{name}"
"#,
            x = side * span,
            home = -side * turn,
            back = side * turn,
            k = 1e3 * STIFFNESS,
        )
    };
    let text = format!(
        "schema = 1\n\n[mechanism]\nname = \"truss\"\n\n[[platform]]\nname = \"pin\"\nhome = {{ position_mm = [0, 0, {height:?}] }}\n{}{}",
        chain("left", -1.0),
        chain("right", 1.0)
    );
    std::fs::write(here.path().join("truss.toml"), text).expect("a file");
    here
}

/// Force down that holds the pin a way down, N.
fn force(down: f64) -> f64 {
    let z = HEIGHT - down;
    let length = SPAN.hypot(z);
    -2.0 * STIFFNESS * (length - SPAN.hypot(HEIGHT)) * z / length
}

/// Way down (mm) to the first limit of the force.
fn limit() -> f64 {
    HEIGHT - ((SPAN.hypot(HEIGHT) * SPAN * SPAN).powf(2.0 / 3.0) - SPAN * SPAN).sqrt()
}

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

#[test]
fn figure_a_truss_pushed_and_pulled_snaps_where_statics_says() {
    let here = truss();
    let mut worst = <[Worst; 2]>::default();
    for line in [
        "curve truss.toml --direction 0 0 -1 --displacement-mm -20 220",
        "curve truss.toml --direction 0 0 -1 --displacement-mm -20 220 --free others",
        "curve truss.toml --direction 0 0 -1 --displacement-mm -20 220 --free ry",
        "curve truss.toml --force 0 0 -100 --factor -1.6 2.6",
    ] {
        let answer = json(here.path(), &words(line));
        let branches = answer["branches"].as_array().expect("branches");
        assert_eq!(branches.len(), 1, "{line}");
        let points = branches[0]["points"].as_array().expect("points");
        assert!(points.len() > 30, "{line}");
        for p in points {
            let (moved, found) = (number(&p["displacement_mm"]), number(&p["force_along_n"]));
            worst[0].add((found - force(moved)).abs() / force(limit()));
        }
        let limits = named(&answer, "load_limit");
        assert_eq!(limits.len(), 2, "{line}");
        for (found, expected) in limits.iter().zip([limit(), 2.0 * HEIGHT - limit()]) {
            worst[1].add((number(&found["displacement_mm"]) - expected).abs());
        }
        // Through and back: under the same force, on the other side.
        let jumps = answer["jumps"].as_array().expect("jumps");
        assert_eq!(jumps.len(), 2, "{line}");
        for landing in named(&answer, "landing") {
            assert_eq!(landing["stable_under_dead_load"], true);
            let (moved, found) = (
                number(&landing["displacement_mm"]),
                number(&landing["force_along_n"]),
            );
            assert!(!(0.0..=2.0 * HEIGHT).contains(&moved), "{line}: {moved}");
            assert!((found.abs() - force(limit())).abs() < 1e-6);
        }
        // Between the limits only a prescribed motion holds it.
        let middle = points
            .iter()
            .find(|p| (number(&p["displacement_mm"]) - HEIGHT).abs() < 20.0);
        let middle = middle.expect("a point near the flat posture");
        assert_eq!(middle["stable_under_dead_load"], false, "{line}");
        assert_eq!(middle["stable_under_prescribed_motion"], true, "{line}");
        // Told as far as the tool is moved.
        let reported = answer["warnings"].to_string();
        assert!(
            line.contains("--force") || reported.contains("a singular posture is 100.00 mm away"),
            "{reported}"
        );
    }
    assert!(figure(
        "curve of a truss: force against statics",
        worst[0].value(),
        1e-9,
        "share of the limit"
    ));
    assert!(figure(
        "curve of a truss: limit points",
        worst[1].value(),
        1e-6,
        "mm"
    ));
}

#[test]
fn a_force_across_swerves_the_pin() {
    let here = truss();
    let line = "curve truss.toml --direction 0 0 -1 --displacement-mm 0 220 --free others --constant-force 50 0 0";
    let answer = json(here.path(), &words(line));
    for p in answer["branches"][0]["points"].as_array().expect("points") {
        assert!((number(&p["force_n"][0]) - 50.0).abs() < 1e-6);
        assert!(number(&p["position_mm"][0]) > 0.1);
    }
}

#[test]
fn the_drawing_and_the_table_of_a_machine() {
    let here = truss();
    let line =
        "curve truss.toml --direction 0 0 -1 --displacement-mm -20 220 --csv t.csv --plot t.svg";
    let said = run(here.path(), &words(line)).answered();
    for needle in [
        "The machine cannot move",
        "it snaps at 42.6428 mm and 150.957 N (B)",
        "from B (the load stays) to D",
    ] {
        let there = said.out.contains(needle) || needle.starts_with("The machine cannot");
        assert!(there, "{needle}: {}", said.out);
    }
    let table = std::fs::read_to_string(here.path().join("t.csv")).expect("a table");
    let header = table.lines().next().expect("a header");
    for column in [
        "displacement_mm",
        "force_n",
        "left: foot_deg",
        "right: bar_mm",
    ] {
        assert!(header.split(',').any(|c| c == column), "{column}: {header}");
    }
    let drawing = std::fs::read_to_string(here.path().join("t.svg")).expect("a drawing");
    for needle in [
        "B limit of the load",
        "D after a jump",
        "only while the motion is prescribed",
    ] {
        assert!(drawing.contains(needle), "{needle}");
    }
}

/// Figure 5.7 of the report, computed by another program: Q2b outside has its peak of 0.01138 kN at 4.64 mm.
#[test]
fn figure_the_orthoglide_snaps_through_its_flat_posture() {
    let here = tempfile::tempdir().expect("a directory");
    let line = "curve orthoglide --at -120 -120 -120 --direction -1 -1 -1 --displacement-mm -20 40";
    let answer = json(here.path(), &words(line));
    let limits = named(&answer, "load_limit");
    let off = (number(&limits[0]["displacement_mm"]) - 4.64).abs();
    assert!(figure(
        "curve orthoglide: limit outside of Q2b, place",
        off,
        5e-3,
        "mm"
    ));
    let off = (number(&limits[0]["force_along_n"]) - 11.38).abs();
    assert!(figure(
        "curve orthoglide: limit outside of Q2b, force",
        off,
        2e-2,
        "N"
    ));
    let reported = answer["warnings"].to_string();
    assert!(
        reported.contains("a singular posture is 11.357 mm away"),
        "{reported}"
    );
    assert!(named(&answer, "landing").len() == 2);
}

#[test]
fn all_equilibria_of_a_truss_and_of_a_machine_near_its_flat_posture() {
    let here = truss();
    for (line, count, stable) in [
        ("equilibria truss.toml --force 0 0 -50", 3, 2),
        ("equilibria truss.toml --force 0 0 -200", 1, 1),
        ("equilibria truss.toml --displaced-mm 0 0 -60", 1, 1),
    ] {
        let answer = json(here.path(), &words(line));
        let all: Vec<&Value> = answer["equilibria"]
            .as_array()
            .expect("a list")
            .iter()
            .collect();
        // Bars pushed in to nothing are shapes too, of an energy that no machine holds.
        let near = |e: &&&Value| number(&e["energy_j"]) < 1000.0;
        let near: Vec<&&Value> = all.iter().filter(near).collect();
        assert_eq!(near.len(), count, "{line}: {all:#?}");
        let holds = near.iter().filter(|e| e["stable"] == true).count();
        assert_eq!(holds, stable, "{line}");
        assert_eq!(answer["coverage"]["settled"], true);
    }
}

/// From straight homes the tool is locked along both chains, and yet it may be held elsewhere, as that of a single chain.
#[test]
fn straight_chains_with_one_tool_have_sixteen_shapes() {
    let here = tempfile::tempdir().expect("a directory");
    let line = "equilibria two_chains --displaced-mm 50 86.6 0";
    let answer = json(here.path(), &words(line));
    assert_eq!(answer["coverage"]["known"], 16);
    assert_eq!(answer["coverage"]["known_stable"], 4);
    assert_eq!(answer["coverage"]["incomplete"], false);
    // Each was found often: only an upper end of the chance of more is known.
    assert!(answer["coverage"]["chance_of_more"].is_null());
    assert!(number(&answer["coverage"]["chance_of_more_at_most"]) > 0.0);
    // A curve of that way begins where the machine is locked, and has the same shapes with the same forces at its end.
    let force_along = |e: &Value| {
        let [x, y] = [0, 1].map(|k| number(&e["force_n"][k]));
        (50.0 * x + 86.6 * y) / 50_f64.hypot(86.6)
    };
    let shapes = answer["equilibria"].as_array().expect("a list").iter();
    let mut wanted: Vec<(f64, bool)> = shapes
        .map(|e| (force_along(e), e["stable"] == true))
        .collect();
    let far = 50_f64.hypot(86.6);
    let line = format!("curve two_chains --direction 50 86.6 0 --displacement-mm 0 {far}");
    let curve = json(here.path(), &words(&line));
    let branches = curve["branches"].as_array().expect("a list").iter();
    let points = branches.flat_map(|b| b["points"].as_array().expect("a list"));
    let at_end = points.filter(|p| (number(&p["displacement_mm"]) - far).abs() < 1e-6);
    let mut found: Vec<(f64, bool)> = at_end
        .map(|p| {
            let stable = p["stable_under_prescribed_motion"] == true;
            (number(&p["force_along_n"]), stable)
        })
        .collect();
    for list in [&mut wanted, &mut found] {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!((found.0 - wanted.0).abs() < 1e-6, "{found:?} {wanted:?}");
        assert_eq!(found.1, wanted.1);
    }
    assert!(
        curve["warnings"]
            .to_string()
            .contains("locked along this motion")
    );
}

/// Four chains of four shapes each: their combinations are answered in the time of their limbs' own searches.
#[test]
fn four_chains_have_256_shapes() {
    let here = tempfile::tempdir().expect("a directory");
    let chain = |i: usize| {
        let (k1, k2) = (1.0 - 0.07 * i as f64, 1.3 - 0.11 * i as f64);
        let (s, c) = (0.7 * i as f64 - 0.95).sin_cos();
        let rod = "{ rigid = { translation_mm = [500, 0, 0] } }";
        let axes = format!("x_axis = [{}, {}, 0], y_axis = [{s}, {}, 0]", -c, -s, -c);
        format!(
            "[chain.c{i}]\nelements = [{{ passive = \"revolute\", name = \"q\", axis = \"z\" }}, {rod}, {{ spring = \"revolute\", name = \"t1\", axis = \"z\", stiffness_n_m_per_rad = {k1}, rest_deg = 0 }}, {rod}, {{ spring = \"revolute\", name = \"t2\", axis = \"z\", stiffness_n_m_per_rad = {k2}, rest_deg = 0 }}, {rod}, {{ passive = \"revolute\", name = \"e\", axis = \"z\" }}]\n[[limb]]\nname = \"l{i}\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"c{i}\"\nstart = {{ position_mm = [{}, {}, 0], {axes} }}\nend = {{ {axes} }}\n",
            1500.0 * c,
            1500.0 * s
        )
    };
    let chains: String = (0..4).map(chain).collect();
    let model = format!(
        "schema = 1\n[mechanism]\nname = \"four\"\nsource = \"own\"\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [0, 0, 0] }}\n{chains}"
    );
    std::fs::write(here.path().join("four.toml"), model).expect("written");
    let line = "equilibria four.toml --displaced-mm 60 3 0 --plot shapes.svg";
    let answer = json(here.path(), &words(line));
    assert_eq!(answer["coverage"]["known"], 256);
    assert_eq!(answer["coverage"]["known_stable"], 16);
    let drawn = std::fs::read_to_string(here.path().join("shapes.svg")).expect("a drawing");
    assert!(drawn.contains("32 of least energy, 224 more"));
}

#[test]
fn what_is_for_chains_is_refused_for_machines() {
    let here = truss();
    let pushed = "curve truss.toml --direction 0 0 -1 --displacement-mm 0 10";
    for (line, needles) in [
        (
            "curve truss.toml --grow left:tip=0,0,-1 --factor 0 1".to_owned(),
            vec![
                "--grow",
                "several limbs",
                "motions of its tool and the load on its tool as unknowns",
                "--force",
                "--load LIMB:NODE",
            ],
        ),
        (
            format!("{pushed} --load foot=0,0,-1"),
            vec!["--load left:tip=0,0,-100", "several limbs", "left, right"],
        ),
        (
            format!("{pushed} --load left:foot=0,0,-1"),
            vec!["--load 'left:foot=0,0,-1'", "no node 'foot'", "tip"],
        ),
        (
            "curve truss.toml --direction 0 1 0 --displacement-mm 0 10".to_owned(),
            vec!["machine is rigid", "y, rx, rz"],
        ),
        (
            format!("{pushed} --free z"),
            vec!["pushed along -z", "--free others"],
        ),
        (
            "equilibria truss.toml --load foot=0,0,-1".to_owned(),
            vec!["--load", "several limbs"],
        ),
    ] {
        let said = run(here.path(), &words(&line));
        assert_eq!(said.code, 1, "{line}: {said:?}");
        let reported = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        for needle in needles {
            assert!(reported.contains(needle), "{line}: {needle}: {reported}");
        }
    }
}

/// Of the steep truss, mm: narrow enough that the pin goes aside before the bars lie flat.
const NARROW: f64 = 300.0;
const STEEP: f64 = 1000.0;

/// Way down (mm) at which the steep truss holds its pin in the middle no more, and the force there (N): what the bars
/// hold across is zero where the cube of their length is their free length times the height squared.
fn aside() -> (f64, f64) {
    let free = NARROW.hypot(STEEP);
    let (mut low, mut high) = (0.7 * STEEP, STEEP);
    for _ in 0..60 {
        let z = 0.5 * (low + high);
        match NARROW.hypot(z).powi(3) < free * z * z {
            true => low = z,
            false => high = z,
        }
    }
    let length = NARROW.hypot(low);
    let force = 2.0 * STIFFNESS * (free - length) * low / length;
    (STEEP - low, force)
}

#[test]
fn a_steep_truss_goes_aside_on_branches_of_its_own() {
    let here = truss_of(NARROW, STEEP);
    let (down, force) = aside();
    let line = "curve truss.toml --direction 0 0 -1 --displacement-mm 0 200 --free others";
    let answer = json(here.path(), &words(&format!("{line} --branches 3")));
    let forks = named(&answer, "pitchfork");
    assert_eq!(forks.len(), 1, "{forks:?}");
    let fork = forks[0];
    assert!((number(&fork["displacement_mm"]) - down).abs() < 1e-6);
    assert!((number(&fork["force_along_n"]) - force).abs() < 1e-6 * force);
    let mode = fork["mode_in_words"].as_str().expect("words");
    assert!(mode.contains("the tool along x by"), "{mode}");
    assert_eq!(answer["more_branches"], false);
    let branches = answer["branches"].as_array().expect("branches");
    assert_eq!(branches.len(), 2);
    assert_eq!(branches[1]["from"], fork["name"]);
    // To either side alike.
    let points = branches[1]["points"].as_array().expect("points");
    let across = |p: &Value| number(&p["position_mm"][0]);
    let (first, last) = (&points[0], &points[points.len() - 1]);
    assert!(across(first).abs() > 50.0, "{first}");
    assert!((across(first) + across(last)).abs() < 1e-6 * STEEP);
    let said = run(here.path(), &words(line)).answered().out;
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for needle in [
        "The machine buckles at 112.313 mm",
        "pitchfork: the machine buckles to one side or the other",
    ] {
        assert!(said.contains(needle), "{needle}: {said}");
    }
    // The start's own branch alone.
    let own = json(here.path(), &words(&format!("{line} --branches 1")));
    assert_eq!(own["branches"].as_array().expect("branches").len(), 1);
    assert_eq!(named(&own, "pitchfork").len(), 1);
}

#[test]
fn all_shapes_of_a_machine_off_its_curve_are_followed() {
    let here = truss();
    // Up to a third of the limit the shape pushed through is on no branch of the start.
    let line = "curve truss.toml --force 0 0 -50 --factor 0 1";
    let own = json(here.path(), &words(line));
    assert_eq!(own["branches"].as_array().expect("branches").len(), 1);
    let all = json(here.path(), &words(&format!("{line} --all")));
    let branches = all["branches"].as_array().expect("branches");
    let near = |p: &&Value| number(&p["spring_energy_j"]) < 1000.0;
    let ends: Vec<&Value> = branches
        .iter()
        .flat_map(|b| b["points"].as_array().expect("points"))
        .filter(|p| (number(&p["factor"]) - 1.0).abs() < 1e-9)
        .filter(near)
        .collect();
    assert_eq!(ends.len(), 3, "{ends:#?}");
    for p in &ends {
        let found = number(&p["force_along_n"]);
        assert!((force(number(&p["displacement_mm"])) - found).abs() < 1e-6);
    }
    let holds = ends.iter().filter(|p| p["stable_under_dead_load"] == true);
    assert_eq!(holds.count(), 2);
}

#[test]
fn a_force_on_a_node_of_a_limb_acts_like_one_on_the_pin() {
    let here = truss();
    let line = "curve truss.toml --direction 0 0 -1 --displacement-mm 0 50";
    let answer = json(
        here.path(),
        &words(&format!("{line} --load left:tip=0,0,-20")),
    );
    assert!(answer["question"].to_string().contains("'left:tip'"));
    for p in answer["branches"][0]["points"].as_array().expect("points") {
        let own = force(number(&p["displacement_mm"])) - 20.0;
        assert!((number(&p["force_along_n"]) - own).abs() < 1e-6, "{p}");
    }
    let line = "equilibria truss.toml --force 0 0 -30 --load left:tip=0,0,-20";
    let all = json(here.path(), &words(line));
    let first = &all["equilibria"][0];
    let down = HEIGHT - number(&first["position_mm"][2]);
    assert!((force(down) - 50.0).abs() < 1e-6, "{down}");
}

/// Three starts that found as many equilibria say nothing of those that are missing.
#[test]
fn few_starts_promise_nothing() {
    let here = truss();
    let line = "equilibria two_chains --force 0 0 -10 --starts 3";
    let all = json(here.path(), &words(line));
    assert_eq!(number(&all["coverage"]["chance_of_more_at_most"]), 1.0);
    let said = run(here.path(), &words(line)).answered();
    let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("too few of the starts"), "{text}");
    assert!(!text.contains("about 100 %"), "{text}");
}
