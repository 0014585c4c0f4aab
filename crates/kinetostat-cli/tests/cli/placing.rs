//! `place`: the best placement by the command, from the job to the files.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use kinetostat_testing::Worst;
use serde_json::Value;

use crate::common::{gcode, run, workplace};

const PLATE: &str = "G21 G90\nG0 X0 Y0 Z20\nG1 Z-2 F600\nG1 X160\nG1 Y90\nG0 Z20\nM30\n";

fn job(program: &str, place: &str) -> String {
    format!(
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"{program}\"\n[placement]\npart_origin_mm = [1400, 70, 500]\n[tool]\nlength_mm = 200\n[load]\nweight = \"all\"\nmilling = {{ radial_n = 215, tangential_n = -10, axial_n = -25 }}\n{place}"
    )
}

fn figure(found: &Value, of: &str) -> f64 {
    found[of]["figure"].as_f64().unwrap()
}

/// The figure of the best placement is that of `deflect` there, and the files say the same.
#[test]
fn the_best_placement_is_what_deflect_finds_there() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    write("plate.ngc", PLATE);
    let free = "[place]\nx_mm = [1300, 1700]\ny_mm = [-300, 300]\n";
    write("job.toml", &job("plate.ngc", free));
    let words = [
        "place",
        "job.toml",
        "--samples",
        "40",
        "--json",
        "--csv",
        "all.csv",
        "--plot",
        "map.svg",
    ];
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let origin = found["best"]["part_origin_mm"].as_array().unwrap();
    let origin: Vec<String> = origin
        .iter()
        .map(|x| x.as_f64().unwrap().to_string())
        .collect();
    let mut words = vec!["deflect", "job.toml", "--json", "--part-origin-mm"];
    words.extend(origin.iter().map(String::as_str));
    let said = run(here.path(), &words).answered();
    let there: Value = serde_json::from_str(&said.out).unwrap();
    let own = there["summary"]["max_position_error_before_mm"]
        .as_f64()
        .unwrap();
    let mut relative = Worst::new();
    relative.add(figure(&found, "best") / own - 1.0);
    assert!(relative.holds(1e-6), "{relative}");
    assert!(figure(&found, "best") < figure(&found, "centre"));
    let table = std::fs::read_to_string(here.path().join("all.csv")).unwrap();
    assert!(
        table.starts_with("kind,fixture,x_mm,y_mm,figure,refused\n"),
        "{table}"
    );
    assert!(
        table
            .lines()
            .filter(|line| line.starts_with("filling,"))
            .count()
            >= 40
    );
    assert_eq!(
        table
            .lines()
            .filter(|line| line.starts_with("map,"))
            .count(),
        41 * 41
    );
    let map = std::fs::read_to_string(here.path().join("map.svg")).unwrap();
    assert!(map.starts_with("<svg") && map.contains("best"));
}

#[test]
fn ranges_out_of_reach_have_no_answer() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    write("plate.ngc", PLATE);
    write(
        "job.toml",
        &job("plate.ngc", "[place]\nx_mm = [6000, 7000]\n"),
    );
    let said = run(here.path(), &["place", "job.toml", "--samples", "10"]);
    assert_eq!(said.code, 2, "{}", said.err);
    let err = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    for needle in [
        "no placement inside the ranges",
        "Nearest to it is x = 6000 mm",
        "moved by (-",
    ] {
        assert!(err.contains(needle), "{err}");
    }
}

#[test]
fn a_part_behind_an_obstacle_is_not_to_be_moved_by_nothing() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    write("plate.ngc", PLATE);
    let wall = "[place]\nx_mm = [1400, 1410]\n[[place.obstacles]]\nname = \"wall\"\nfrom_mm = [-5000, -5000, -5000]\nto_mm = [5000, 5000, 5000]\n";
    write("job.toml", &job("plate.ngc", wall));
    let said = run(here.path(), &["place", "job.toml", "--samples", "4"]);
    assert_eq!(said.code, 2, "{}", said.err);
    let err = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(err.contains("wall"), "{err}");
    assert!(!err.contains("move the ranges"), "{err}");
    assert!(err.contains("The machine reaches all of it there"), "{err}");
}

/// A box that has nothing to do with the program keeps clear of obstacles what is not the part.
#[test]
fn a_box_that_the_program_does_not_cut_in_is_told() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    write("plate.ngc", PLATE);
    let said = |part: &str| {
        let free = format!("[place]\nx_mm = [1400, 1410]\npart_box_mm = {part}\n");
        write("job.toml", &job("plate.ngc", &free));
        let words = ["place", "job.toml", "--samples", "4"];
        let said = run(here.path(), &words).answered();
        said.out.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let around = said("[[-10, -10, -40], [150, 80, 0]]");
    assert!(!around.contains("outside part_box_mm"), "{around}");
    let elsewhere = said("[[1400, 70, 400], [1600, 170, 500]]");
    assert!(elsewhere.contains("outside part_box_mm"), "{elsewhere}");
}

#[test]
fn questions_without_sense_are_refused() {
    let here = workplace();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    write("plate.ngc", PLATE);
    let wall = "[[place.obstacles]]\nname = \"wall\"\nfrom_mm = [0, 0, 9]\nto_mm = [9, 9, 0]\n";
    let cases = [
        ("", "nothing about the placement is free"),
        ("[place]\nx_mm = [5, 1]\n", "the range from 5 to 1 is empty"),
        ("[place]\nturn_z_deg = [0, 400]\n", "-360 to 360 degrees"),
        ("[place]\nx_mm = [0, 2e7]\n", "more than 10 km away"),
        (wall, "the obstacle 'wall' has no inside"),
    ];
    for (place, needle) in cases {
        write("job.toml", &job("plate.ngc", place));
        let said = run(here.path(), &["place", "job.toml"]);
        assert_eq!(said.code, 1, "{place}: {}", said.err);
        let err = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(err.contains(needle), "{place}: {err}");
    }
}

/// A quarter less error was wanted than in the middle of the ranges.
#[test]
fn figure_the_pocket_lies_a_quarter_better_than_in_the_middle() {
    let Some(gcode) = gcode() else { return };
    let here = workplace();
    let text = std::fs::read_to_string(gcode.join("tball-pocket.gcode")).unwrap();
    // A debug build takes a part of it.
    let lines = if cfg!(debug_assertions) {
        2000
    } else {
        usize::MAX
    };
    let part: String = text.split_inclusive('\n').take(lines).collect();
    std::fs::write(here.path().join("pocket.ngc"), part).unwrap();
    let free = "[place]\nx_mm = [1000, 1800]\ny_mm = [-400, 400]\nz_mm = [300, 900]\n";
    std::fs::write(here.path().join("job.toml"), job("pocket.ngc", free)).unwrap();
    let words = ["place", "job.toml", "--samples", "100", "--json"];
    let said = run(here.path(), &words).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let share = figure(&found, "best") / figure(&found, "centre");
    let name =
        "place: largest error of tball-pocket on heavy_6r by that in the middle of the ranges";
    assert!(kinetostat_testing::figure::at_most(name, share, 0.75, "1"));
    assert_eq!(found["next_best"].as_array().unwrap().len(), 10);
}
