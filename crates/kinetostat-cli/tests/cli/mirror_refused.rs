//! `mirror`: what it does not take, with the option or the file that says so, and nothing written.

use std::path::Path;

use crate::common::{Said, run, workplace};

/// A circle of 30 mm, with a straight way in.
const CIRCLE: &str = "G21 G90\nG0 X30 Y-40 Z5\nG0 Z0\nG1 Y0 F600\nG3 X30 Y0 I-30\nG0 Z5\nM2\n";

/// Points every mm of the way in and every two degrees of the circle, raised by so much; row 21 by 0.3 mm more.
fn raised(by: f64) -> Vec<String> {
    let way_in = (0..=40).map(|k| {
        let z = by + if k == 20 { 0.3 } else { 0.0 };
        format!("30,{},{z}\n", -40 + k)
    });
    let around = (1..180).map(|k| {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 180.0).sin_cos();
        format!("{},{},{by}\n", 30.0 * cosine, 30.0 * sine)
    });
    way_in.chain(around).collect()
}

fn table(rows: &[String]) -> String {
    format!("x_mm,y_mm,z_mm\n{}", rows.concat())
}

fn mirror(here: &Path, measured: &[&str], more: &[&str]) -> Said {
    let mut words = vec![
        "mirror",
        "circle.ngc",
        "--out",
        "next.ngc",
        "--state",
        "state.toml",
    ];
    for file in measured {
        words.extend(["--measured", *file]);
    }
    words.extend(more);
    if !more.contains(&"--register") {
        words.extend(["--register", "rigid"]);
    }
    run(here, &words)
}

#[test]
fn lengths_of_nothing_are_refused_by_their_option() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("circle.ngc", CIRCLE);
    put("trial1.csv", &table(&raised(0.05)));
    for (option, value, says) in [
        (
            "--smoothing-mm",
            "0",
            "--smoothing-mm: the smoothing length is 0 mm; this path of",
        ),
        ("--smoothing-mm", "1e9", " to 10 times its own"),
        ("--smoothing-mm", "1e-300", "allows lengths from 0.00"),
        ("--smoothing-mm", "1e-9", "allows lengths from 0.00"),
        ("--smoothing-mm", "1e-4", "allows lengths from 0.00"),
        (
            "--smoothing-mm",
            "-5",
            "--smoothing-mm: the smoothing length is -5 mm",
        ),
        (
            "--window-mm",
            "0",
            "--window-mm 0: a length above 0 is needed",
        ),
    ] {
        let said = mirror(
            here.path(),
            &["trial1.csv"],
            &["--register", "none", option, value],
        );
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains(says), "{}", said.err);
        assert!(!here.path().join("next.ngc").exists() && !here.path().join("state.toml").exists());
    }
}

/// The program of the trial before, measured once more: the correction would be made twice.
#[test]
fn a_program_without_the_last_correction_is_not_corrected_twice() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("circle.ngc", CIRCLE);
    put("trial1.csv", &table(&raised(0.05)));
    // The same but for a tenth of a micrometre.
    put("again.csv", &table(&raised(0.0501)));
    mirror(here.path(), &["trial1.csv"], &["--register", "none"]).answered();
    let kept = std::fs::read(here.path().join("state.toml")).unwrap();
    let more = ["--register", "none", "--force-overwrite"];
    let said = mirror(here.path(), &["again.csv"], &more);
    assert_eq!(said.code, 1, "{said:?}");
    let says = "nothing is seen of the correction that trial 1 wrote";
    assert!(said.err.contains(says), "{}", said.err);
    assert_eq!(std::fs::read(here.path().join("state.toml")).unwrap(), kept);
    // With --was-run the trial is taken, with a warning that the correction is not seen.
    let kept_by_hand = std::fs::copy(
        here.path().join("state.toml"),
        here.path().join("kept.toml"),
    );
    kept_by_hand.unwrap();
    let said = mirror(
        here.path(),
        &["again.csv"],
        &[&more[..], &["--was-run"]].concat(),
    );
    assert!(
        said.out.contains("THE LAST CORRECTION IS NOT SEEN"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("the same is mirrored twice"),
        "{}",
        said.out
    );
    said.answered();
    std::fs::rename(
        here.path().join("kept.toml"),
        here.path().join("state.toml"),
    )
    .unwrap();
    // A machine that answers by a third is slow, and converges.
    put("third.csv", &table(&raised(0.033)));
    mirror(here.path(), &["third.csv"], &more).answered();
}

#[test]
fn a_measurement_given_again_is_told_by_its_numbers() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let rows = raised(0.05);
    put("circle.ngc", CIRCLE);
    put("trial1.csv", &table(&rows));
    put(
        "trial2.csv",
        &format!("# the second trial\n{}\n", table(&rows)),
    );
    let said = mirror(
        here.path(),
        &["trial1.csv", "trial2.csv"],
        &["--register", "none"],
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err
            .contains("trial1.csv and trial2.csv are one measurement, point for point"),
        "{}",
        said.err
    );
    mirror(here.path(), &["trial1.csv"], &["--register", "none"]).answered();
    let kept = std::fs::read(here.path().join("state.toml")).unwrap();
    let more = ["--register", "none", "--force-overwrite"];
    let said = mirror(here.path(), &["trial2.csv"], &more);
    assert_eq!(said.code, 1, "{said:?}");
    let says = "trial2.csv is the measurement trial1.csv of an earlier trial, point for point";
    assert!(said.err.contains(says), "{}", said.err);
    assert_eq!(std::fs::read(here.path().join("state.toml")).unwrap(), kept);
}

#[test]
fn points_in_no_order_are_not_mirrored_in_one() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let rows = raised(0.05);
    // 220 and 81 have no common divisor: every row once, each far from the one before it.
    let shuffled: Vec<String> = (0..rows.len())
        .map(|k| rows[k * 81 % rows.len()].clone())
        .collect();
    put("circle.ngc", CIRCLE);
    put("trial1.csv", &table(&shuffled));
    let more = ["--register", "none", "--align", "arc-length"];
    let said = mirror(here.path(), &["trial1.csv"], &more);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err
            .contains("of its 220 points have no place on the path")
            && said.err.contains("in the order in which the tool went"),
        "{}",
        said.err
    );
    assert!(!here.path().join("next.ngc").exists());
    // The nearest places do not ask for an order.
    mirror(here.path(), &["trial1.csv"], &["--register", "none"]).answered();
}

#[test]
fn rows_that_the_registration_did_not_follow_are_said() {
    let here = workplace();
    let put = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    put("circle.ngc", CIRCLE);
    // A scatter of a hundredth of a micrometre, so that there is a deviation of which six are a measure.
    let rows: Vec<String> = raised(0.0)
        .iter()
        .enumerate()
        .map(|(k, row)| {
            row.replace(
                ",0\n",
                if k % 2 == 0 {
                    ",0.00001\n"
                } else {
                    ",-0.00001\n"
                },
            )
        })
        .collect();
    put("trial1.csv", &table(&rows));
    let said = mirror(here.path(), &["trial1.csv"], &[]).answered();
    let one_line = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        one_line.contains(
            "1 of the points did not count in the motion onto the path, being farther from it than six standard deviations: row 21"
        ),
        "{}",
        said.out
    );
}
