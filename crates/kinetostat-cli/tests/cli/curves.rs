//! `kinetostat curve` and `kinetostat equilibria`: the numbers of the report's chains through the
//! commands, drawings, tables, and the same bytes twice.

use crate::common::chains::{curve_along, figure, json, named, number, workplace};
use crate::common::run;
use kinetostat_testing::Worst;
use serde_json::Value;

/// The column of the book's chapter on buckling, computed by another program: Delta 0.110931613194, F -1.03347699957.
#[test]
fn figure_the_z_chain_buckles_at_its_pitchfork() {
    let here = workplace();
    let mut worst = <[Worst; 2]>::default();
    for model in ["z.toml", "three_link_z"] {
        let arguments = curve_along(model, ["1", "0", "0"], ["-400", "0"], &[]);
        let a = json(here.path(), &arguments);
        assert_eq!(a["schema"], 3);
        assert_eq!(a["branches"].as_array().expect("branches").len(), 2);
        let forks = named(&a, "pitchfork");
        assert_eq!(forks.len(), 1);
        let fork = forks[0];
        let delta = -1e-3 * number(&fork["displacement_mm"]);
        worst[0].add((delta - 0.110931613194).abs());
        worst[1].add((number(&fork["force_along_n"]) + 1.03347699957).abs());
        assert!((number(&fork["position_mm"][0]) - 2798.38129798).abs() < 1e-7);
        assert!(a["jumps"].as_array().expect("jumps").is_empty());
        // The start is the chain at rest.
        let start = named(&a, "start")[0];
        assert!((number(&start["slope_n_per_mm"]) - 0.01692820323).abs() < 1e-9);
        assert_eq!(start["stable_under_dead_load"], true);
    }
    let place = figure(
        "kinetostat curve: pitchfork of the Z chain, Delta",
        worst[0].value(),
        1e-8,
        "m",
    );
    let force = figure(
        "kinetostat curve: pitchfork of the Z chain, force",
        worst[1].value(),
        1e-8,
        "N",
    );
    assert!(place && force);
}

/// Delta (m), force along x (N), mu, stable: all equilibria with angles within 180 degrees.
const Z_TABLE: [(f64, f64, f64, bool); 18] = [
    (0.0, 0.0, 0.0, true),
    (0.0, -6.09325071, 6.0025896, false),
    (0.05, -0.611210298, 0.5972313, true),
    (0.05, -5.5357834, 5.4091745, false),
    (0.1, -0.971876963, 0.9420378, true),
    (0.1, -5.23066014, 5.0700654, false),
    (0.115, -1.03430334, 0.9609886, true),
    (0.115, -1.03430334, 0.9609886, true),
    (0.115, -1.05525021, 1.0204064, false),
    (0.115, -5.1643198, 4.9937967, false),
    (0.2, -1.05202636, 0.6153020, true),
    (0.2, -1.05202636, 0.6153020, true),
    (0.2, -1.41051127, 1.3458410, false),
    (0.2, -4.90904012, 4.6839664, false),
    (0.4, -1.09758209, 0.4614500, true),
    (0.4, -1.09758209, 0.4614500, true),
    (0.4, -1.90206432, 1.7617202, false),
    (0.4, -4.67980504, 4.3345048, false),
];

#[test]
fn figure_all_equilibria_of_the_z_chain() {
    let here = workplace();
    let mut worst = <[Worst; 2]>::default();
    for delta in [0.0, 0.05, 0.1, 0.115, 0.2, 0.4] {
        let rows: Vec<_> = Z_TABLE.iter().filter(|r| r.0 == delta).collect();
        let shift = format!("{}", -1e3 * delta);
        let a = json(
            here.path(),
            &["equilibria", "z.toml", "--displaced-mm", &shift, "0", "0"],
        );
        let found = a["equilibria"].as_array().expect("equilibria");
        assert_eq!(found.len(), rows.len(), "Delta {delta}");
        assert_eq!(a["coverage"]["settled"], true);
        assert!(number(&a["coverage"]["chance_of_more_at_most"]) < 0.03);
        let energies: Vec<f64> = found.iter().map(|e| number(&e["energy_j"])).collect();
        assert!(
            energies.windows(2).all(|w| w[0] <= w[1]),
            "sorted by energy"
        );
        let mut left: Vec<&Value> = found.iter().collect();
        for &&(_, force, mu, stable) in &rows {
            let i = left
                .iter()
                .position(|e| (number(&e["force_n"][0]) - force).abs() < 1e-5)
                .unwrap_or_else(|| panic!("Delta {delta}: no equilibrium with the force {force}"));
            let e = left.swap_remove(i);
            worst[0].add((number(&e["force_n"][0]) - force).abs());
            worst[1].add((number(&e["share_to_buckling"]) - mu).abs());
            assert_eq!(e["stable"], stable, "Delta {delta}, force {force}");
        }
    }
    let force = figure(
        "kinetostat equilibria: Z chain complete, forces",
        worst[0].value(),
        2e-8,
        "N",
    );
    let mu = figure(
        "kinetostat equilibria: Z chain complete, mu",
        worst[1].value(),
        1e-7,
        "1",
    );
    assert!(force && mu);
}

#[test]
fn the_straight_chain_buckles_at_one_and_three() {
    let here = workplace();
    let a = json(
        here.path(),
        &curve_along(
            "s.toml",
            ["-1", "0", "0"],
            ["0", "600"],
            &["--force-limits", "-1", "6"],
        ),
    );
    let forks = named(&a, "pitchfork");
    assert_eq!(forks.len(), 2);
    for (fork, force) in forks.iter().zip([1.0, 3.0]) {
        assert!((number(&fork["force_along_n"]) - force).abs() < 1e-9);
        assert!(number(&fork["displacement_mm"]).abs() < 1e-9);
        assert!(fork["slope_n_per_mm"].is_null() || number(&fork["slope_n_per_mm"]).abs() > 1e6);
    }
    // Without limits of the force a warning names the locked chain, and it buckles all the same.
    let said = run(
        here.path(),
        &curve_along("s.toml", ["-1", "0", "0"], ["0", "600"], &[]),
    )
    .answered();
    for words in ["locked at the start", "buckles at 0 mm and 1.00000 N (B)"] {
        assert!(said.out.replace('\n', " ").contains(words), "{}", said.out);
    }
    // Figure 5.7 at Delta 0.2, each shape with its mirror image.
    let all = json(
        here.path(),
        &["equilibria", "s.toml", "--displaced-mm", "-200", "0", "0"],
    );
    let mut forces: Vec<f64> = all["equilibria"]
        .as_array()
        .expect("equilibria")
        .iter()
        .map(|e| -number(&e["force_n"][0]))
        .collect();
    forces.sort_by(f64::total_cmp);
    let expected = [1.03472647, 1.03472647, 3.106545759, 3.106545759];
    assert_eq!(forces.len(), expected.len());
    for (f, e) in forces.iter().zip(expected) {
        assert!((f - e).abs() < 2e-8, "{f} {e}");
    }
    // The same as a growing load: critical load factor 1, in the mode of the arch.
    let a = json(
        here.path(),
        &[
            "curve", "s.toml", "--force", "-2", "0", "0", "--factor", "0", "1", "--hold", "y",
        ],
    );
    let critical = &a["critical_loads"][1];
    assert_eq!(critical["judged"], "shape_and_tool");
    for key in ["factor", "linear_factor"] {
        assert!((number(&critical[key]) - 0.5).abs() < 1e-9, "{key}");
    }
    assert_eq!(critical["kind"], "pitchfork");
    let mode: Vec<f64> = critical["mode"]
        .as_array()
        .expect("a mode")
        .iter()
        .map(number)
        .collect();
    assert!((mode[1] - mode[2]).abs() < 1e-6 && (mode[0] + mode[1]).abs() < 1e-6);
    assert!((number(&named(&a, "pitchfork")[0]["force_along_n"]) - 1.0).abs() < 1e-9);
}

/// Example 4.6.1 with the load G/G* = 1.5 (G* = 4 sin 15 deg) on the middle: K_x vanishes on the upper branch where
/// dx/L = -0.693675473, at F_x L/K = -2.245611734 (alpha = 0.9032153489). Under a dead load the
/// chain snaps there.
#[test]
fn a_load_on_a_node_moves_the_limit_point() {
    let here = workplace();
    let g = 1.5 * 4.0 * 15_f64.to_radians().sin();
    let load = format!("elbow=0,{:.17},0", -g);
    let a = json(
        here.path(),
        &curve_along(
            "two_link",
            ["1", "0", "0"],
            ["-900", "50"],
            &["--load", &load, "--all"],
        ),
    );
    let near = |p: &&Value| (number(&p["displacement_mm"]) + 693.675473).abs() < 1e-5;
    let limits = named(&a, "load_limit");
    let limit = limits.into_iter().find(near).expect("the limit point");
    assert!((number(&limit["force_along_n"]) + 2.245611734).abs() < 1e-8);
    let jumps = a["jumps"].as_array().expect("jumps");
    assert!(
        jumps
            .iter()
            .any(|j| j["from"] == limit["name"] && j["under"] == "dead_load")
    );
    for jump in jumps {
        for to in jump["to"].as_array().expect("landings") {
            let p = named(&a, "landing").into_iter().find(|p| p["name"] == *to);
            let p = p.expect("a landing that has a name");
            assert_eq!(p["stable_under_dead_load"], true);
        }
    }
}

/// Weight, compensators, the tool's length and the load of a whole machine: the end of the curve of
/// a growing load is where `deflect` puts the tool.
#[test]
fn a_growing_load_ends_where_deflect_puts_the_tool() {
    let here = workplace();
    for model in ["heavy_6r", "compensated_arm"] {
        let common = [
            model,
            "--tool-length-mm",
            "250",
            "--force",
            "300",
            "-200",
            "800",
        ];
        let mut arguments = vec!["curve"];
        arguments.extend(common);
        arguments.extend(["--factor", "0", "1"]);
        let a = json(here.path(), &arguments);
        let mut arguments = vec!["deflect"];
        arguments.extend(common);
        let loaded = json(here.path(), &arguments);
        // At no load the weight has moved the tool already.
        let mut arguments = vec!["deflect"];
        arguments.extend(&common[..3]);
        arguments.extend(["--force", "0", "0", "0"]);
        let rest = json(here.path(), &arguments);
        assert!(number(&rest["displacement_size_mm"]) > 0.1, "weight counts");
        let ends = named(&a, "end");
        let end = ends
            .iter()
            .find(|p| (number(&p["factor"]) - 1.0).abs() < 1e-12)
            .expect("the whole load");
        for (point, deflected) in [(*end, &loaded), (named(&a, "start")[0], &rest)] {
            for k in 0..3 {
                let expected = number(&deflected["place"]["position_mm"][k])
                    + number(&deflected["displacement_mm"][k]);
                let found = number(&point["position_mm"][k]);
                assert!(
                    (found - expected).abs() < 1e-7,
                    "{model}, {k}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn drawings_have_solid_and_dashed_parts_and_names() {
    let here = workplace();
    let files = ["--plot", "z.svg", "--csv", "z.csv", "--json", "z.json"];
    let mut arguments = curve_along("z.toml", ["-1", "0", "0"], ["0", "400"], &files);
    let said = run(here.path(), &arguments).answered();
    assert!(
        said.out.contains("buckles at 110.932 mm and 1.03348 N (B)"),
        "{}",
        said.out
    );
    assert!(said.out.contains("z.svg"));
    assert!(
        said.out.lines().all(|l| l.chars().count() <= 80),
        "{}",
        said.out
    );
    let read = |name: &str| std::fs::read_to_string(here.path().join(name)).expect(name);
    let svg = read("z.svg");
    assert!(svg.starts_with("<svg"));
    assert!(svg.contains("class=\"line c0\"") && svg.contains("class=\"line c5 dashed\""));
    for words in [
        "B pitchfork",
        "displacement, mm",
        "force, N",
        ">stable<",
        ">unstable<",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    // Nothing is overwritten without leave.
    let again = run(here.path(), &arguments);
    assert_eq!(again.code, 1);
    assert!(again.err.contains("--force-overwrite"), "{}", again.err);
    arguments.push("--force-overwrite");
    run(here.path(), &arguments).answered();

    let answer: Value = serde_json::from_str(&read("z.json")).expect("JSON");
    let mut table = csv::Reader::from_path(here.path().join("z.csv")).expect("a table");
    let header = table.headers().expect("a header").clone();
    let at = |name: &str| header.iter().position(|h| h == name).expect(name);
    let (displacement, force) = (at("displacement_mm"), at("force_n"));
    let (held, th1) = (at("stable_under_prescribed_motion"), at("th1_deg"));
    let points: Vec<&Value> = answer["branches"]
        .as_array()
        .expect("branches")
        .iter()
        .flat_map(|b| b["points"].as_array().expect("points"))
        .chain(answer["named_points"].as_array().expect("named points"))
        .collect();
    let mut count = 0;
    for (row, point) in table.records().zip(&points) {
        let row = row.expect("a row");
        let cell = |k: usize| row[k].parse::<f64>().expect("a number");
        assert_eq!(cell(displacement), number(&point["displacement_mm"]));
        assert_eq!(cell(force), number(&point["force_along_n"]));
        assert_eq!(cell(th1), number(&point["coordinates"][1]));
        let stable = point["stable_under_prescribed_motion"].as_bool();
        assert_eq!(&row[held] == "yes", stable == Some(true));
        count += 1;
    }
    assert_eq!(count, points.len());

    run(
        here.path(),
        &[
            "equilibria",
            "z.toml",
            "--displaced-mm",
            "-200",
            "0",
            "0",
            "--plot",
            "shapes.svg",
            "--csv",
            "shapes.csv",
        ],
    )
    .answered();
    let svg = read("shapes.svg");
    for words in [
        "x, mm",
        "y, mm",
        ">base<",
        ">tool<",
        "1: stable",
        "3: unstable",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    let mut table = csv::Reader::from_path(here.path().join("shapes.csv")).expect("a table");
    assert_eq!(table.records().filter_map(Result::ok).count(), 4);
}

#[test]
fn the_same_question_gives_the_same_bytes() {
    let here = workplace();
    for arguments in [
        curve_along(
            "s.toml",
            ["-1", "0", "0"],
            ["0", "600"],
            &[
                "--force-limits",
                "-1",
                "6",
                "--all",
                "--json",
                "--plot",
                "a.svg",
                "--csv",
                "a.csv",
            ],
        ),
        vec![
            "equilibria",
            "z.toml",
            "--displaced-mm",
            "-115",
            "0",
            "0",
            "--json",
            "--plot",
            "a.svg",
            "--csv",
            "a.csv",
        ],
    ] {
        let mut seen = Vec::new();
        for _ in 0..2 {
            let said = run(here.path(), &arguments).answered();
            let read = |name: &str| std::fs::read(here.path().join(name)).expect(name);
            seen.push((said.out, said.err, read("a.svg"), read("a.csv")));
            for name in ["a.svg", "a.csv"] {
                std::fs::remove_file(here.path().join(name)).expect(name);
            }
        }
        assert!(seen[0] == seen[1], "{}", arguments[0]);
    }
}

/// A round rod, 1 m long and 20 mm thick, clamped at the base.
const ROD: &str = r#"schema = 1
[mechanism]
name = "rod"
[[platform]]
name = "tool"
home = { position_mm = [1000, 0, 0] }
[section.rod]
round = { diameter_mm = 20 }
youngs_modulus_gpa = 210
poissons_ratio = 0.3
[chain.arm]
elements = [
  { link = "rod", name = "rod", length_mm = 1000, segments = 8 },
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

#[test]
fn figure_a_rod_bends_to_a_circle_and_beyond() {
    let here = workplace();
    std::fs::write(here.path().join("rod.toml"), ROD).expect("a file");
    // 2 pi EI / L bends it to a full circle: the rotation is the moment times L / EI.
    let moment = std::f64::consts::TAU * 210e9 * std::f64::consts::PI * 0.01_f64.powi(4) / 4.0;
    let text = moment.to_string();
    let arguments = [
        "curve", "rod.toml", "--moment", "0", "0", &text, "--factor", "0", "1.25", "--csv",
        "rod.csv", "--plot", "rod.svg",
    ];
    let answer = json(here.path(), &arguments);
    let points = answer["branches"][0]["points"].as_array().expect("points");
    let mut worst = Worst::new();
    for p in points {
        let (factor, turn) = (number(&p["factor"]), number(&p["rotation_deg"]));
        worst.add((turn - 360.0 * factor).abs());
    }
    assert!(figure(
        "curve: rotation of a rod bent to 1 1/4 circles, against M L / EI",
        worst.of(points.len()) / 450.0,
        1e-6,
        "of 450 deg",
    ));
    let named_end = answer["named_points"].as_array().expect("named");
    let last = named_end.last().expect("an end");
    assert!(
        (number(&last["rotation_deg"]) - 450.0).abs() < 1e-3,
        "{last}"
    );
    // Table and drawing go on as well.
    let table = std::fs::read_to_string(here.path().join("rod.csv")).expect("a table");
    let mut lines = csv::Reader::from_reader(table.as_bytes());
    let column = lines
        .headers()
        .expect("a header")
        .iter()
        .position(|h| h == "rotation_deg")
        .expect("a column");
    let turns: Vec<f64> = lines
        .records()
        .map(|r| r.expect("a row"))
        .filter(|r| !r[1].is_empty())
        .map(|r| r[column].parse().expect("a number"))
        .collect();
    assert_eq!(turns.len(), points.len());
    assert!(turns.windows(2).all(|w| w[1] > w[0] && w[1] < w[0] + 15.0));
    let said = run(
        here.path(),
        &[
            "curve", "rod.toml", "--moment", "0", "0", &text, "--factor", "0", "1.25",
        ],
    )
    .answered();
    assert!(said.out.contains("450.000"), "{}", said.out);
}

#[test]
fn only_what_is_at_a_limit_is_called_so() {
    let here = workplace();
    let held = |model: &str, x: &str| {
        run(
            here.path(),
            &["equilibria", model, "--displaced-mm", x, "0", "0"],
        )
    };
    // Nearly straight (0.9 degrees): regular, with large forces.
    for x in ["80", "90.0", "90.6"] {
        let said = held("z.toml", x).answered().out;
        assert!(
            said.contains("2 equilibria; one of them is stable"),
            "{said}"
        );
        assert!(!said.contains("at a limit"), "{x}: {said}");
    }
    // Straight: locked, the force is not determined.
    let said = held("s.toml", "0").answered().out;
    assert!(said.contains("at a limit"), "{said}");
    // Beyond reach, or just not found: that none was found is all that is known.
    for x in ["90.687", "500"] {
        let said = held("z.toml", x);
        let words: Vec<&str> = said.out.split_whitespace().collect();
        let words = words.join(" ");
        let none = words.contains("No equilibrium was found. This does not say that there is none");
        assert!(none || words.contains("2 equilibria"), "{said:?}");
        assert_eq!(said.code, if none { 2 } else { 0 }, "{said:?}");
    }
}

/// Ziegler's column of two equal springs (1 m, 1 N m/rad each): a force that follows the last link stays, and a
/// dead one grows. In the absolute angles the tangent is `[[2 - F - p, F - 1], [-1, 1 - p]]`: its determinant
/// `p^2 - (3 - F) p + 1` has no zero from F = 1 on, where the symmetric part is indefinite long before.
#[test]
fn a_column_under_a_force_that_follows_loses_no_stability_by_its_symmetric_part() {
    let here = workplace();
    for follows in [0.5, 0.9, 1.1, 2.5] {
        let text = format!(
            "schema = 1\n[mechanism]\nname = \"Ziegler\"\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [2000, 0, 0] }}\n[chain.column]\nelements = [\n{{ actuator = \"revolute\", name = \"s1\", axis = \"z\", stiffness_n_m_per_rad = 1 }},\n{{ rigid = {{ translation_mm = [1000, 0, 0] }} }},\n{{ actuator = \"revolute\", name = \"s2\", axis = \"z\", stiffness_n_m_per_rad = 1 }},\n{{ rigid = {{ translation_mm = [1000, 0, 0] }} }},\n{{ node = \"top\" }},\n]\n[[limb]]\nname = \"column\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"column\"\n[[limb.load]]\nwrench = \"jet\"\nnode = \"top\"\naxes = \"node\"\nforce_n = [-{follows}, 0, 0]\n"
        );
        std::fs::write(here.path().join("ziegler.toml"), text).expect("a model");
        let line = "curve ziegler.toml --force -0.01 0 0 --factor 0 300";
        let words: Vec<&str> = line.split(' ').collect();
        let answer = json(here.path(), &words);
        let loads = answer["critical_loads"].as_array().expect("a list");
        let whole = loads
            .iter()
            .find(|c| c["judged"] == "shape_and_tool")
            .expect("the whole");
        let half: f64 = 0.5 * (3.0 - follows);
        match half >= 1.0 {
            true => {
                let expected = 100.0 * (half - (half * half - 1.0).sqrt());
                for name in ["factor", "linear_factor"] {
                    let found = number(&whole[name]);
                    assert!(
                        (found - expected).abs() < 1e-4,
                        "{follows} {name}: {found} {expected}"
                    );
                }
            }
            false => {
                assert!(whole["factor"].is_null(), "{follows}: {whole}");
                assert!(whole["linear_factor"].is_null(), "{follows}: {whole}");
            }
        }
        // Below the factor at which the symmetric part turns indefinite all is well; above it, masses decide.
        let symmetric = |p: f64| (2.0 - follows - p) * (1.0 - p) - (0.5 * follows - 1.0).powi(2);
        let until = 1e-2 * number(&whole["safe_below_factor"]);
        let holds = until == 0.0 && symmetric(0.0) < 0.0;
        assert!(holds || symmetric(until).abs() < 1e-5, "{follows}: {until}");
        let caution = whole["caution"].as_str().expect("words");
        assert!(
            caution.contains("flutter") && caution.contains("masses"),
            "{caution}"
        );
        let said = run(here.path(), &words).answered();
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            flat.contains("flutter") && flat.contains("depends on the masses"),
            "{flat}"
        );
        // At one place: the symmetric part is positive up to F = 2, and nothing is called unstable beyond.
        let words = "deflect ziegler.toml --force 0 0.0001 0".split(' ');
        let said = run(here.path(), &words.collect::<Vec<_>>()).answered();
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            !flat.contains("instability") && !flat.contains("NOT stay"),
            "{flat}"
        );
        assert_eq!(flat.contains("(flutter)"), follows > 2.0, "{flat}");
        assert_eq!(flat.contains("the platform stays"), follows < 2.0, "{flat}");
        // No command calls it unstable, for its determinant never vanishes, and those that look at many places
        // say what they do not assess.
        for (command, warns) in [
            ("check ziegler.toml --force 0 0 0", false),
            ("map ziegler.toml --x 2000 --y 0 --z 0 --force 0 0 0", true),
            ("assemble ziegler.toml --force 0 0 0", false),
            (
                "model draw ziegler.toml --force 0 0.0001 0 --out z.svg --force-overwrite",
                false,
            ),
        ] {
            let words: Vec<&str> = command.split(' ').collect();
            let said = run(here.path(), &words).answered();
            let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
            let unstable = ["NOT STABLE", "not stable", "does not stay", "would jump"];
            assert!(
                unstable.iter().all(|word| !flat.contains(word)),
                "{follows} {command}: {flat}"
            );
            assert!(!warns || flat.contains("flutter"), "{command}: {flat}");
        }
    }
}

/// A unit too many: the answer says that no machine goes that far.
#[test]
fn a_curve_beyond_all_sense_says_so() {
    let here = workplace();
    let pushed = |to: &str| {
        let arguments = curve_along("scara", ["1", "0", "0"], ["0", to], &[]);
        let a = json(here.path(), &arguments);
        let warnings = a["warnings"].as_array().expect("warnings").clone();
        let mut codes = warnings.iter().map(|w| w["code"].clone());
        codes.any(|code| code == "large_displacement")
    };
    assert!(pushed("1e6"));
    assert!(!pushed("5"));
    // Farther than any machine stands nothing is computed: the first step was nothing but rounding.
    let arguments = curve_along("puu3", ["0", "0", "1"], ["0", "1e9"], &[]);
    let refused = run(here.path(), &arguments);
    assert_eq!(refused.code, 1, "{refused:?}");
    assert!(refused.err.contains("farther than 10 km"), "{refused:?}");
}
