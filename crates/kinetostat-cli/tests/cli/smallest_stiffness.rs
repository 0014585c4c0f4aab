//! The smallest stiffness against a force is one figure with one definition: the same at the same place
//! in `stiffness`, `map`, `deflect` and along programs, and what the compliance says.

use crate::common::{run, workplace};
use nalgebra::{Matrix6, SymmetricEigen};
use serde_json::Value;
use std::path::Path;

const NAME: &str = "smallest_stiffness_n_per_mm";

fn json(here: &Path, words: &[&str]) -> Value {
    let said = run(here, words).answered();
    serde_json::from_str(&said.out).expect("JSON")
}

fn figure(value: &Value) -> f64 {
    let figure = value[NAME].as_f64().expect("a figure");
    assert!(figure.is_finite() && figure > 0.0, "{figure}");
    figure
}

fn same(what: &str, one: f64, other: f64) {
    assert!(
        (one / other - 1.0).abs() < 1e-6,
        "{what}: {one} against {other}"
    );
}

/// Force per motion in the softest direction of a force, N/mm, from a stiffness matrix in SI units.
fn of_matrix(rows: &Value) -> f64 {
    let entry = |i: usize, j: usize| rows[i][j].as_f64().expect("a number");
    let k = Matrix6::from_fn(entry);
    let k = 0.5 * (k + k.transpose());
    let c = k.try_inverse().expect("no free direction");
    let forces: nalgebra::Matrix3<f64> = c.fixed_view::<3, 3>(0, 0).into();
    1e-3 / SymmetricEigen::new(forces).eigenvalues.max()
}

#[test]
fn all_commands_give_the_same_figure_at_the_same_place() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("there.ngc"), "G21 G90\nG0 X0 Y0 Z0\nM2\n").expect("a program");
    for (model, place) in [
        ("heavy_6r", ["1000", "200", "1100"]),
        ("counterweight_arm", ["1850", "150", "1900"]),
        ("kuka_kr270_like", ["1400", "-300", "1300"]),
        ("orthoglide", ["-20", "25", "30"]),
        ("delta", ["50", "-80", "-900"]),
        ("tricept_like", ["-150", "60", "-1750"]),
        ("prs3", ["12", "-8", "-740"]),
    ] {
        let [x, y, z] = place;
        let force = ["--force", "80", "-50", "-120"];
        let answer_to = |command: &'static str, force: &[&'static str]| {
            let mut words = vec![command, model, "--at", x, y, z, "--json"];
            words.extend(force);
            json(here, &words)
        };
        let map = |force: &[&'static str]| {
            let mut words = vec!["map", model, "--x", x, "--y", y, "--z", z, "--json"];
            words.extend(force);
            let answer = json(here, &words);
            let list = answer["figures"].as_array().expect("figures");
            let own = list.iter().find(|f| f["name"] == NAME).expect("the figure");
            own["least"]["value"].as_f64().expect("a number")
        };
        // As drawn.
        let drawn = answer_to("stiffness", &[]);
        same(
            model,
            figure(&drawn),
            of_matrix(&drawn["stiffness_n_m_rad"]),
        );
        same(model, figure(&drawn), map(&[]));
        // Under a force.
        let loaded = answer_to("stiffness", &force);
        same(
            model,
            figure(&loaded),
            of_matrix(&loaded["stiffness_n_m_rad"]),
        );
        same(model, figure(&loaded), map(&force));
        same(
            model,
            figure(&loaded),
            figure(&answer_to("deflect", &force)),
        );
        // Without a load on the tool: with all that acts in the model.
        let rest = figure(&answer_to("deflect", &[]));
        if drawn["left_out"].is_array() {
            same(model, figure(&drawn["at_rest"]), rest);
            same(
                model,
                of_matrix(&drawn["at_rest"]["stiffness_n_m_rad"]),
                rest,
            );
        }
        let program = ["--program", "there.ngc", "--part-origin-mm", x, y, z];
        let mut words = vec!["deflect", model];
        words.extend(program);
        words.extend(["--weight", "all", "--json"]);
        let along = json(here, &words);
        same(model, figure(&along["summary"]), rest);
    }
}

#[test]
fn springs_between_parts_are_named_and_counted() {
    let here = workplace();
    let here = here.path();
    for (model, names) in [
        ("counterweight_arm", vec!["'counterweight' of limb 'crank'"]),
        (
            "compensated_arm",
            vec!["'gravity compensator' of limb 'arm'"],
        ),
        (
            "fanuc_m900ib_like",
            vec![
                "'left balancer' of limb 'upper arm'",
                "'right balancer' of limb 'upper arm'",
            ],
        ),
    ] {
        let answer = json(here, &["stiffness", model, "--json"]);
        assert_eq!(answer["left_out"], serde_json::json!(names), "{model}");
        let rest = figure(&answer["at_rest"]);
        // They do something, and not much in a machine that holds its joints.
        let share = rest / figure(&answer) - 1.0;
        assert!(share.abs() > 1e-6 && share.abs() < 0.1, "{model}: {share}");
        let said = run(here, &["stiffness", model]).answered();
        for name in names {
            let text: Vec<&str> = said.out.split_whitespace().collect();
            assert!(text.join(" ").contains(name), "{model}: {}", said.out);
        }
    }
    let answer = json(here, &["stiffness", "orthoglide", "--json"]);
    assert!(answer.get("left_out").is_none() && answer.get("at_rest").is_none());
}

/// One name for it: on the terminal, in the JSON and in the report of a run.
#[test]
fn the_smallest_stiffness_has_one_name_in_a_run_and_its_report() {
    let here = crate::common::workplace();
    let line = [
        "compensate",
        "job.toml",
        "--report",
        "r.html",
        "--json",
        "r.json",
    ];
    let said = crate::common::run(here.path(), &line).answered();
    let read = |name: &str| std::fs::read_to_string(here.path().join(name)).expect(name);
    let name = "smallest stiffness against a force";
    let row = said.out.lines().find(|l| l.contains(name)).expect("a row");
    let figure = row
        .trim()
        .strip_prefix(name)
        .expect("the name first")
        .trim()
        .to_owned();
    let json: serde_json::Value = serde_json::from_str(&read("r.json")).expect("JSON");
    let reported = json["summary"]["smallest_stiffness_n_per_mm"]
        .as_f64()
        .expect("a figure");
    let shown: f64 = figure.trim_end_matches(" N/mm").parse().expect("a number");
    assert!(
        shown <= reported && (reported - shown).abs() < 0.01 * reported,
        "{shown} {reported}"
    );
    let page = read("r.html");
    // A box and the title of a plot, both with that figure.
    assert!(
        page.matches("Smallest stiffness against a force").count() >= 2,
        "{name}"
    );
    assert!(!page.contains("Smallest stiffness:") && !page.contains("Smallest stiffness<"));
    assert!(
        page.contains(&format!("at least {}", figure.replace(' ', "\u{202f}")))
            || page.contains(&format!("at least {figure}")),
        "{figure}"
    );
}
