//! `kinetostat curve` and `kinetostat equilibria` warn of loads and displacements as `deflect` does, and say when they
//! have no answer.

use serde_json::Value;

use crate::common::{run, workplace};

/// Warnings of a code in the JSON of a command on the model of the workplace; the same are in the text.
fn warned(command: &[&str], code: &str) -> bool {
    let here = workplace();
    let said = run(here.path(), &[command, &["--json"]].concat()).answered();
    let answer: Value = serde_json::from_str(&said.out).expect("JSON");
    let list = answer["warnings"].as_array().expect("a list");
    let found = list.iter().find(|w| w["code"] == code);
    if let Some(warning) = found {
        let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let message = flat(warning["message"].as_str().expect("a text"));
        assert!(flat(&said.err).contains(&message), "{said:?}");
    }
    found.is_some()
}

/// A tangential force on the arm of 0.8 m, whose joint and boom give way by 5 % of it under 3.5 kN.
#[test]
fn a_load_beyond_its_limit_is_warned_of_by_every_command() {
    for (force, large, folds) in [
        ("2000", false, false),
        ("4900", false, true),
        ("6000", true, true),
    ] {
        let load = ["--force", "0", force, "0"];
        for command in [
            [&["deflect", "model.toml"], &load[..]].concat(),
            [&["equilibria", "model.toml"], &load[..]].concat(),
            [&["curve", "model.toml"], &load[..], &["--factor", "0", "1"]].concat(),
            [
                &["curve", "model.toml", "--force", "0", "-1", "0"],
                &["--factor", "0", force][..],
            ]
            .concat(),
        ] {
            assert_eq!(warned(&command, "over_limit"), large, "{command:?}");
            assert_eq!(warned(&command, "large_displacement"), folds, "{command:?}");
        }
    }
}

/// What acts all the time counts, beside a motion that grows or a load that does.
#[test]
fn a_constant_load_is_warned_of_as_well() {
    let pushed = [
        "--direction",
        "0",
        "1",
        "0",
        "--displacement-mm",
        "0",
        "1",
        "--free",
        "x",
    ];
    for (moment, large) in [("150", false), ("250", true)] {
        let constant = ["--constant-moment", "0", "0", moment];
        let grown = ["--moment", "0", "0", "1", "--factor", "0", "10"];
        let command = [&["curve", "model.toml"], &grown[..], &constant].concat();
        assert_eq!(warned(&command, "over_limit"), large, "{command:?}");
        let command = [&["equilibria", "model.toml"], &constant[..]].concat();
        assert_eq!(warned(&command, "over_limit"), large, "{command:?}");
    }
    let command = [
        &["curve", "model.toml"],
        &pushed[..],
        &["--constant-force", "6000", "0", "0"],
    ]
    .concat();
    assert!(warned(&command, "over_limit"), "{command:?}");
}

/// Nothing found is no answer, and the reasons that are given are those of the question.
#[test]
fn a_search_without_an_equilibrium_has_no_answer_and_gives_reasons_that_fit() {
    let here = workplace();
    let loaded = ["--moment", "0", "0", "1e40"];
    let held = ["--displaced-mm", "20000", "0", "0"];
    for (command, reason, other) in [
        (
            [&["equilibria", "two_link"], &loaded[..]].concat(),
            "more than the chain can carry",
            "reach",
        ),
        (
            [&["equilibria", "three_link_z"], &held[..]].concat(),
            "out of the chain's reach",
            "carry",
        ),
        (
            [&["equilibria", "orthoglide", "--starts", "3"], &loaded[..]].concat(),
            "more than the machine can carry",
            "chain",
        ),
    ] {
        let said = run(here.path(), &command);
        assert_eq!(said.code, 2, "{command:?}: {said:?}");
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        let (_, rest) = flat
            .split_once("No equilibrium was found.")
            .expect("the result");
        let (result, _) = rest.split_once("How complete").expect("the coverage");
        assert!(
            result.contains(reason) && !result.contains(other),
            "{result}"
        );
        assert!(said.err.contains("no equilibrium of the"), "{said:?}");
    }
    let grown = ["--factor", "0", "1"];
    let said = run(
        here.path(),
        &[&["curve", "two_link"], &loaded[..], &grown].concat(),
    );
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.out.contains("1 point"), "{said:?}");
    assert!(said.err.contains("could not be followed"), "{said:?}");
}

fn answer(command: &[&str]) -> Value {
    let here = workplace();
    let said = run(here.path(), &[command, &["--json"]].concat()).answered();
    serde_json::from_str(&said.out).expect("JSON")
}

/// A motion that is prescribed may take more force than any machine bears.
#[test]
fn a_motion_that_takes_an_absurd_force_is_warned_of() {
    let by = |mm: &str| {
        let push = ["--direction", "1", "0", "0", "--displacement-mm", "0", mm];
        warned(&[&["curve", "heavy_6r"], &push[..]].concat(), "over_limit")
    };
    assert!(!by("5"));
    assert!(by("500"));
    let held = |mm: &str| {
        let place = ["--displaced-mm", mm, "0", "0"];
        // The warning is of any of them: a few starts find some.
        let words = [&["equilibria", "heavy_6r", "--starts", "8"], &place[..]].concat();
        warned(&words, "over_limit")
    };
    assert!(!held("5"));
    assert!(held("500"));
}

/// The displacement under a growing load counts from the commanded place, for a chain as for a machine, and wherever the
/// curve starts.
#[test]
fn displacements_count_from_the_commanded_place() {
    for machine in ["heavy_6r", "delta"] {
        let ends = |low: &str, high: &str| {
            let load = ["--force", "0", "0", "-1", "--factor", low, high];
            let answer = answer(&[&["curve", machine], &load[..]].concat());
            let commanded = answer["place"]["position_mm"][2]
                .as_f64()
                .expect("a height");
            let points = answer["branches"][0]["points"]
                .as_array()
                .expect("points")
                .clone();
            let of = |point: &Value| {
                let shown = point["displacement_mm"].as_f64().expect("a displacement");
                let height = point["position_mm"][2].as_f64().expect("a height");
                assert!(
                    (shown - (commanded - height)).abs() < 1e-9,
                    "{machine}: {point}"
                );
                shown
            };
            (of(&points[0]), of(&points[points.len() - 1]))
        };
        let (whole, half) = (ends("0", "10"), ends("5", "10"));
        assert!(whole.0 > 0.01, "its own weight: {whole:?}");
        assert!(
            (whole.1 - half.1).abs() < 1e-9,
            "{machine}: {whole:?} {half:?}"
        );
    }
}

/// Slides commanded to zero, within rounding, are not turned inside out by a deflection.
#[test]
fn a_slide_at_zero_keeps_its_equilibrium() {
    for (machine, load) in [
        ("prs3", &["--force", "100", "0", "0"][..]),
        ("hexaglide", &["--displaced-mm", "0", "0", "0"]),
    ] {
        let answer = answer(&[&["equilibria", machine], load].concat());
        let list = answer["equilibria"].as_array().expect("a list");
        let commanded = answer["place"]["position_mm"].as_array().expect("a place");
        let near = list.iter().any(|shape| {
            let at = shape["position_mm"].as_array().expect("a place");
            let away = |k: usize| at[k].as_f64().unwrap() - commanded[k].as_f64().unwrap();
            shape["stable"] == true && (0..3).all(|k| away(k).abs() < 1.0)
        });
        assert!(near, "{machine}: {list:?}");
    }
}

/// A curve that starts outside its limits and does not lead away from them goes on.
#[test]
fn a_curve_from_outside_its_limits_says_where_it_goes_on() {
    let push = ["--direction", "1", "0", "0", "--displacement-mm", "0", "10"];
    let limits = ["--force-limits", "5", "6"];
    let answer = answer(&[&["curve", "three_link_z"], &push[..], &limits[..]].concat());
    let points = answer["branches"][0]["points"].as_array().expect("points");
    assert!(points.len() > 5);
    let list = answer["warnings"].as_array().expect("a list");
    let said = list.iter().map(|w| w["message"].as_str().expect("a text"));
    let said: Vec<_> = said
        .filter(|text| text.contains("--force-limits"))
        .collect();
    assert!(!said.is_empty());
    assert!(
        said.iter()
            .all(|text| !text.contains("ends where it starts")),
        "{said:?}"
    );
}

/// A chain that is stretched out and locked is one shape, whatever force acts along it.
#[test]
fn a_locked_chain_is_one_shape() {
    let held = [
        "equilibria",
        "three_link_s",
        "--displaced-mm",
        "0",
        "0",
        "0",
    ];
    let answer = answer(&held);
    let list = answer["equilibria"].as_array().expect("a list");
    assert_eq!(list.len(), 1, "{list:?}");
    assert_eq!(list[0]["singular"], true);
    let force = list[0]["force_n"].as_array().expect("a force");
    assert!(
        force
            .iter()
            .all(|f| f.as_f64().is_some_and(|f| f.abs() < 1e-6)),
        "{force:?}"
    );
}
