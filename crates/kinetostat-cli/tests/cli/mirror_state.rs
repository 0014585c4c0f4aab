//! `mirror`: the state that goes from trial to trial, and what it tells of the last correction.

use std::path::Path;

use serde_json::Value;

use crate::common::{Said, run, workplace};

const GROOVE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG0 Z10\nM30\n";

/// Evenly from -1 to 1, in no order.
fn jitter(k: i32) -> f64 {
    f64::from((k * 37 + 11) % 101 - 50) / 50.0
}

/// A point every mm that lies so far beside the groove, with a jitter of so much; `seed` says which.
fn beside(by: f64, jitter_mm: f64, seed: i32) -> String {
    let rows = (0..=60).map(|x| {
        let [y, z] = [7, 53].map(|of| jitter_mm * jitter(seed * of + 3 * x));
        format!("{x},{},{z}\n", by + y)
    });
    std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect()
}

fn mirror(here: &Path, measured: &str, more: &[&str]) -> Said {
    let mut words = vec!["mirror", "groove.ngc", "--measured", measured];
    words.extend(["--state", "state.toml", "--out", "next.ngc"]);
    words.extend(["--register", "none", "--force-overwrite"]);
    words.extend(more);
    run(here, &words)
}

fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_state_that_was_edited_is_refused_by_its_name() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("groove.ngc", GROOVE);
    put("trial1.csv", &beside(0.05, 0.001, 1));
    put("trial2.csv", &beside(0.01, 0.001, 2));
    mirror(here.path(), "trial1.csv", &[]).answered();
    let kept = std::fs::read_to_string(here.path().join("state.toml")).unwrap();
    for (from, to) in [
        ("relaxation = 1.0", "relaxation = 0.5"),
        ("number = 1", "number = 2"),
        ("mirrored = true", "mirrored = false"),
    ] {
        let edited = kept.replacen(from, to, 1);
        assert_ne!(edited, kept, "{from}");
        put("state.toml", &edited);
        let said = mirror(here.path(), "trial2.csv", &[]);
        assert_eq!(said.code, 1, "{said:?}");
        let why = in_one_line(&said.err);
        assert!(
            why.contains("'state.toml': the file was changed after it was written")
                && why.contains("begin with a new state"),
            "{why}"
        );
        let now = std::fs::read_to_string(here.path().join("state.toml")).unwrap();
        assert_eq!(now, edited, "what is refused is left as it is");
    }
    // A copy with other ends of lines is the same state, and so is one without a digest, of an earlier version.
    let without: String = kept
        .lines()
        .skip(1)
        .map(|line| format!("{line}\n"))
        .collect();
    for same in [kept.replace('\n', "\r\n"), without] {
        put("state.toml", &same);
        mirror(here.path(), "trial2.csv", &[]).answered();
    }
}

#[test]
fn a_correction_within_the_scatter_is_said_not_to_be_seen() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("groove.ngc", GROOVE);
    // Off by 2 um with a scatter of 17, corrected by half; and by 50 um with a scatter of half a micrometre.
    for (by, left, jitter_mm, is_seen) in [(0.002, 0.001, 0.03, false), (0.05, 0.0, 0.001, true)] {
        put("trial1.csv", &beside(by, jitter_mm, 1));
        put("trial2.csv", &beside(left, jitter_mm, 2));
        let first = mirror(here.path(), "trial1.csv", &["--relaxation", "0.5"]).answered();
        assert!(!first.out.contains("CANNOT BE TOLD"), "{}", first.out);
        let second = mirror(here.path(), "trial2.csv", &["--json", "answer.json"]).answered();
        assert_eq!(
            second.out.contains("IT CANNOT BE TOLD"),
            !is_seen,
            "{}",
            second.out
        );
        let json = std::fs::read_to_string(here.path().join("answer.json")).unwrap();
        let answer: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(answer["shows_correction"].as_bool(), Some(is_seen));
        std::fs::remove_file(here.path().join("state.toml")).unwrap();
    }
}

/// A scatter that is not what was stated, on a wave that bends within the smoothing length: the wave is none.
#[test]
fn a_scatter_that_is_not_what_was_stated_is_told() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("groove.ngc", GROOVE);
    for (jitter_mm, um, is_told) in [
        // Evenly up to 50 um to either side: 29 um in one direction.
        (0.05, "5", true),
        (0.05, "25", false),
        (0.0, "1", false),
    ] {
        let rows = (0..=60).map(|x| {
            let angle = std::f64::consts::TAU * f64::from(x) / 40.0;
            let [y, z] = [7, 53].map(|of| jitter_mm * jitter(of * x * x));
            format!("{x},{},{}\n", 0.3 * angle.sin() + y, 0.3 * angle.cos() + z)
        });
        let text: String = std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
            .chain(rows)
            .collect();
        put("trial1.csv", &text);
        let said = mirror(here.path(), "trial1.csv", &["--repeatability-um", um]).answered();
        assert_eq!(
            said.out.contains("THE POINTS SCATTER"),
            is_told,
            "{um}: {}",
            said.out
        );
        std::fs::remove_file(here.path().join("state.toml")).unwrap();
    }
}
