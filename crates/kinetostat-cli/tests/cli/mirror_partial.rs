//! `mirror` with points of a part of the path: corrected there, or refused with what to do.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use serde_json::Value;

use crate::common::{Said, run, workplace};

/// A pocket of lines and arcs without a symmetry.
const POCKET: &str = "G21 G90\nG0 X0 Y0 Z5\nG0 Z0\nG1 X60 F600\nG3 X80 Y20 I0 J20\nG1 Y50\nG3 X70 Y60 I-10 J0\nG1 X10 Z-3\nG3 X0 Y50 I0 J-10\nG1 Y0 Z0\nG0 Z5\nM2\n";

/// The first points of the pocket, one a millimetre, off by a smooth deviation of 0.06 mm at most.
fn off(count: usize, size: f64) -> Vec<[f64; 3]> {
    let place = |way: f64| {
        let angle = ((way - 60.0) / 20.0).clamp(0.0, std::f64::consts::FRAC_PI_2);
        let beyond = (way - 60.0 - 20.0 * angle).max(0.0);
        let x = way.min(60.0) + 20.0 * angle.sin();
        [x, 20.0 * (1.0 - angle.cos()) + beyond, 0.0]
    };
    let points = (0..count).map(|k| {
        let way = k as f64 + 0.5;
        let [x, y, z] = place(way);
        [
            x + size * (0.05 * (way / 40.0).sin() + 0.02),
            y + size * 0.04 * (way / 55.0).cos(),
            z + size * (-0.03 + 0.03 * (way / 70.0).sin()),
        ]
    });
    points.collect()
}

fn table(points: impl IntoIterator<Item = [f64; 3]>) -> String {
    let rows = points.into_iter().map(|[x, y, z]| format!("{x},{y},{z}\n"));
    std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect()
}

fn mirror(here: &Path, measured: &str, more: &[&str]) -> Said {
    std::fs::write(here.join("pocket.ngc"), POCKET).unwrap();
    std::fs::write(here.join("trial1.csv"), measured).unwrap();
    let mut words = vec![
        "mirror",
        "pocket.ngc",
        "--measured",
        "trial1.csv",
        "--out",
        "next.ngc",
    ];
    words.extend(more);
    if !more.contains(&"--register") {
        words.extend(["--register", "rigid"]);
    }
    run(here, &words)
}

/// Points in the frame of the program are corrected where they are: no turn by half a circle, nothing beyond what was planted.
#[test]
fn a_part_of_the_path_is_corrected_where_it_is() {
    for count in [60, 80, 100, 120] {
        let here = workplace();
        let said = mirror(here.path(), &table(off(count, 1.0)), &["--json"]).answered();
        let found: Value = serde_json::from_str(&said.out).unwrap();
        let measured = &found["measurements"][0];
        let registration = &measured["registration"];
        let norm = |of: &Value| {
            let all = of.as_array().unwrap().iter();
            all.map(|x| x.as_f64().unwrap().powi(2)).sum::<f64>().sqrt()
        };
        let what = format!("{count}: {measured}");
        assert!(norm(&registration["rotation_vector_deg"]) < 1.0, "{what}");
        assert!(norm(&registration["shift_mm"]) < 0.3, "{what}");
        assert_eq!(registration["told_by"], "frame");
        assert!(
            registration["rejected_rows"].as_array().unwrap().is_empty(),
            "{what}"
        );
        assert!(
            measured["figures"]["rms_mm"].as_f64().unwrap() < 0.04,
            "{what}"
        );
        assert!(
            found["largest_correction_mm"].as_f64().unwrap() < 0.06,
            "{what}"
        );
    }
}

/// One side of it in another frame fits other sides as well; half of it fits in one place, which is said.
#[test]
fn a_part_of_the_path_in_another_frame_is_told_or_refused() {
    let here = workplace();
    let away = |count: usize| {
        table(
            off(count, 1.0)
                .into_iter()
                .map(|[x, y, z]| [300.0 - y, 40.0 + z, -x]),
        )
    };
    let said = mirror(here.path(), &away(55), &[]);
    assert_eq!(said.code, 1, "{said:?}");
    let says = "the measured points fit the path in several places";
    assert!(
        said.err.contains(says) && said.err.contains("measure more of the path"),
        "{}",
        said.err
    );
    assert!(!here.path().join("next.ngc").exists());
    let said = mirror(here.path(), &away(120), &[]).answered();
    assert!(
        said.out.contains("THE POINTS WERE IN ANOTHER FRAME"),
        "{}",
        said.out
    );
}

/// Points on the path: nothing is to be corrected, nothing is an outlier, and the program says what it said.
#[test]
fn no_deviation_is_nothing_to_correct() {
    for more in [&["--register", "none"][..], &[]] {
        let here = workplace();
        let said = mirror(here.path(), &table(off(120, 0.0)), more).answered();
        assert!(
            said.out.contains("pocket.ngc, trial 1: nothing to correct"),
            "{}",
            said.out
        );
        assert!(
            !said.out.contains("is mirrored") && !said.out.contains("left out"),
            "{}",
            said.out
        );
        let written = std::fs::read_to_string(here.path().join("next.ngc")).unwrap();
        assert!(written.contains("\nG1 X60 F600\n"), "{written}");
    }
}
