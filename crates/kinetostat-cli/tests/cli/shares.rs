//! `kinetostat shares` and `kinetostat compare`: tables, files and refusals.

use crate::common::{Said, run, workplace};
use serde_json::Value;
use std::path::Path;

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

#[test]
fn shares_add_up_on_the_screen_and_in_the_files() {
    let here = workplace();
    let line = "shares orthoglide --at 20 -30 40 --along 1 2 -1 --force 100 -50 -80 --json --csv s.csv --plot s.svg --sensitivities --reduce-percent 20";
    let answer = json(&said(here.path(), line).answered());
    let parts = answer["parts"].as_array().expect("parts");
    let sum: f64 = parts
        .iter()
        .map(|p| p["share"].as_f64().expect("a share"))
        .sum();
    assert!((sum - 1.0).abs() < 1e-12);
    let table = std::fs::read_to_string(here.path().join("s.csv")).expect("the table");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), parts.len() + 1);
    let column = |row: &&str| {
        row.split(',')
            .nth(3)
            .expect("a cell")
            .parse::<f64>()
            .expect("a share")
    };
    assert!((rows[1..].iter().map(column).sum::<f64>() - 1.0).abs() < 1e-12);
    let picture = std::fs::read_to_string(here.path().join("s.svg")).expect("the picture");
    assert!(picture.starts_with("<svg") && picture.matches("<rect class=\"share\"").count() >= 9);
    let stiffening = &answer["stiffening"];
    let reached = stiffening["compliance_ratio_reached"]
        .as_f64()
        .expect("a ratio");
    assert!((reached - 0.8).abs() < 1e-8);
    let numbers = answer["sensitivities"]["numbers"]
        .as_array()
        .expect("numbers");
    assert!(numbers.len() > 10);
    assert!(numbers.iter().all(|n| n["deflection"].as_f64().is_some()));
}

#[test]
fn directions_that_nothing_holds_or_that_are_none_are_refused() {
    let here = workplace();
    assert_eq!(said(here.path(), "shares two_link --direction z").code, 2);
    assert_eq!(said(here.path(), "shares orthoglide --along 0 0 0").code, 1);
    assert_eq!(
        said(here.path(), "shares orthoglide --reduce-percent 120").code,
        1
    );
    assert_eq!(
        said(here.path(), "compare orthoglide tripteron --csv c.csv").code,
        1
    );
}

#[test]
fn a_design_is_compared_with_its_own_stiffer_self() {
    let here = workplace();
    let text = kinetostat_model::preset_text("orthoglide").expect("a preset");
    let stiffer = text.replace("stiffness_n_per_mm = 1.0e6", "stiffness_n_per_mm = 2.0e6");
    assert_ne!(text, stiffer);
    std::fs::write(here.path().join("stiffer.toml"), stiffer).expect("written");
    let line = "compare orthoglide stiffer.toml --at 10 20 30 --x -40 40 5 --y -40 40 5 --json --csv c.csv --plot c.svg";
    let answer = json(&said(here.path(), line).answered());
    let place = &answer["places"][0];
    let [a, b] = ["a", "b"].map(|of| {
        place[of]["stiffness_n_per_mm"][0]
            .as_f64()
            .expect("a stiffness")
    });
    assert!(b > a);
    let summary = &answer["difference"];
    assert_eq!(summary["common"], 25);
    assert_eq!(summary["b_stiffer_share"], 1.0);
    let table = std::fs::read_to_string(here.path().join("c.csv")).expect("the table");
    assert_eq!(table.lines().count(), 26);
    let ratios = table.lines().skip(1).map(|row| {
        row.split(',')
            .next_back()
            .expect("a cell")
            .parse::<f64>()
            .expect("a ratio")
    });
    let least = summary["least_ratio"].as_f64().expect("a ratio");
    assert!((kinetostat_testing::least(ratios) - least).abs() < 1e-15);
    let picture = std::fs::read_to_string(here.path().join("c.svg")).expect("the picture");
    assert!(picture.starts_with("<svg"));
}
