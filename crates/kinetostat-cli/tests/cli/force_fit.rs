//! `kinetostat force --fit`: means that are simulated here by the closed form, with noise; the intervals cover the truth, and
//! a cut with the fitted material gives the means again.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::f64::consts::{PI, TAU};
use std::path::Path;

use serde_json::Value;

use crate::common::chains::{json, number};
use crate::common::checks::{flat, warnings};
use crate::common::{contents, run};

/// `K_tc, K_rc, K_ac` in N/mm2 and `K_te, K_re, K_ae` in N/mm.
const TRUTH: [f64; 6] = [796.0, 168.0, 222.0, 27.7, 30.8, 1.4];

const FEEDS: [f64; 6] = [0.03, 0.05, 0.08, 0.11, 0.15, 0.2];

/// A cut with a tool of 12 mm and four teeth.
#[derive(Clone, Copy)]
struct Cut {
    depth: f64,
    entry: f64,
    exit: f64,
    options: &'static str,
}

/// `acos(1 - ae/r)` of 4 mm at a radius of 6 mm.
const ARC: f64 = 1.230_959_417_340_774_7;

const SLOT: Cut = Cut {
    depth: 2.0,
    entry: 0.0,
    exit: PI,
    options: "--width-mm 12 --depth-mm 2",
};
const CLIMB: Cut = Cut {
    depth: 5.0,
    entry: PI - ARC,
    exit: PI,
    options: "--width-mm 4 --depth-mm 5 --climb",
};
const CONVENTIONAL: Cut = Cut {
    depth: 5.0,
    entry: 0.0,
    exit: ARC,
    options: "--width-mm 4 --depth-mm 5 --part left",
};

impl Cut {
    /// Mean force on the tool by the closed form of `shared/theory/cutting.md`, four teeth.
    fn mean(self, k: [f64; 6], feed: f64) -> [f64; 3] {
        let [tc, rc, ac, te, re, ae] = k;
        let (chip, edge) = (4.0 * self.depth * feed / (8.0 * PI), 4.0 * self.depth / TAU);
        let at = |phi: f64| {
            let (double, swept) = ((2.0 * phi).cos(), 2.0 * phi - (2.0 * phi).sin());
            [
                chip * (tc * double - rc * swept) + edge * (re * phi.cos() - te * phi.sin()),
                chip * (tc * swept + rc * double) - edge * (te * phi.cos() + re * phi.sin()),
                edge * (ae * phi - ac * feed * phi.cos()),
            ]
        };
        let (end, start) = (at(self.exit), at(self.entry));
        [0, 1, 2].map(|i| end[i] - start[i])
    }

    /// A file of means with errors of so many newtons.
    fn file(self, noise: &mut Noise, error: f64) -> String {
        let row = |feed: &f64| {
            let force = self.mean(TRUTH, *feed);
            let [x, y, z] = force.map(|force| force + error * noise.normal());
            format!("{feed},{x},{y},{z}\n")
        };
        let rows: String = FEEDS.iter().map(row).collect();
        format!("# simulated\nfeed_mm_per_tooth,fx_n,fy_n,fz_n\n{rows}")
    }
}

/// Always the same numbers: a congruential generator, and the method of Box and Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (a, b) = (self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }
}

const TOOL: &str = "--tool flat --diameter-mm 12 --teeth 4 --helix-deg 30";

fn words(more: &str) -> Vec<String> {
    let line = format!("force --fit means.csv {TOOL} {more}");
    line.split_whitespace().map(str::to_owned).collect()
}

#[track_caller]
fn fit(here: &Path, text: &str, more: &str) -> Value {
    std::fs::write(here.join("means.csv"), text).unwrap();
    let words = words(more);
    json(here, &words.iter().map(String::as_str).collect::<Vec<_>>())
}

/// What is refused, in one line; nothing is written.
#[track_caller]
fn refused(text: &str, more: &str) -> String {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("means.csv"), text).unwrap();
    let words = words(&format!("{more} --plot fit.svg --out-material own.toml"));
    let said = run(
        here.path(),
        &words.iter().map(String::as_str).collect::<Vec<_>>(),
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert_eq!(contents(here.path()).len(), 1, "{said:?}");
    flat(&said.err)
}

fn values(answer: &Value) -> [f64; 6] {
    [0, 1, 2, 3, 4, 5].map(|i| number(&answer["coefficients"][i]["value"]))
}

#[test]
fn without_noise_the_coefficients_come_back() {
    let here = tempfile::tempdir().unwrap();
    for cut in [SLOT, CLIMB, CONVENTIONAL] {
        let a = fit(here.path(), &cut.file(&mut Noise(1), 0.0), cut.options);
        for (k, (found, truth)) in values(&a).into_iter().zip(TRUTH).enumerate() {
            assert!((found - truth).abs() <= 1e-9 * 796.0, "{k}: {found}");
        }
        for component in a["components"].as_array().unwrap() {
            assert!(number(&component["r_squared"]) > 1.0 - 1e-9);
            assert!(number(&component["residual_rms_n"]) < 1e-9);
        }
        // The reference coefficients push the tool up, which their helix does not.
        let mut told = a["warnings"].as_array().unwrap().iter();
        assert!(
            told.all(|warning| warning["code"] == "implausible_coefficient"),
            "{:?}",
            a["warnings"]
        );
    }
}

/// Of many simulated fits, about 95 in 100 intervals hold the truth.
#[test]
fn the_intervals_hold_the_truth() {
    let here = tempfile::tempdir().unwrap();
    let mut noise = Noise(7);
    let (mut held, mut all) = (0, 0);
    for cut in [SLOT, CLIMB, CONVENTIONAL] {
        for _ in 0..12 {
            let a = fit(here.path(), &cut.file(&mut noise, 2.0), cut.options);
            for (c, truth) in a["coefficients"].as_array().unwrap().iter().zip(TRUTH) {
                let (low, high) = (number(&c["low_95"]), number(&c["high_95"]));
                assert!(low < high);
                all += 1;
                if (low..=high).contains(&truth) {
                    held += 1;
                }
            }
        }
    }
    assert_eq!(all, 216);
    // 205 are expected; coefficients of one fit are not independent.
    assert!((190..=216).contains(&held), "{held} of {all}");
}

/// The material that is written is read again by `force`, and by a job whose band it carries.
#[test]
fn a_cut_with_the_fitted_material_gives_the_means_again() {
    let here = tempfile::tempdir().unwrap();
    for cut in [SLOT, CLIMB, CONVENTIONAL] {
        let a = fit(
            here.path(),
            &cut.file(&mut Noise(3), 1.0),
            &format!(
                "{} --material wax_7 --group aluminium --rpm 8000 --out-material own.toml --plot fit.svg --csv fit.csv --force-overwrite",
                cut.options
            ),
        );
        let text = std::fs::read_to_string(here.path().join("own.toml")).unwrap();
        assert_eq!(a["material_toml"], text.as_str());
        for row in a["rows"].as_array().unwrap() {
            let feed = number(&row["feed_mm_per_tooth"]);
            let line = format!(
                "force --material wax-7 --materials own.toml {TOOL} {} --feed-per-tooth-mm {feed}",
                cut.options
            );
            let one = json(here.path(), &line.split_whitespace().collect::<Vec<_>>());
            for k in 0..3 {
                let (again, fitted) = (
                    number(&one["mean"]["force_n"][k]),
                    number(&row["fitted_n"][k]),
                );
                assert!((again - fitted).abs() <= 1e-3, "{again} {fitted}");
                let truth = cut.mean(TRUTH, feed)[k];
                assert!((again - truth).abs() <= 4.0, "{again} {truth}");
            }
            let spread = number(&one["material"]["spread_percent"]);
            assert!((spread - number(&a["spread_percent"])).abs() < 1e-9);
            // The band of the material holds those of the fit at every feed.
            let norm = |v: &Value| (0..3).map(|k| number(&v[k]).powi(2)).sum::<f64>().sqrt();
            let share = 100.0 * norm(&row["half_width_95_n"]) / norm(&row["fitted_n"]);
            assert!(share <= spread + 1e-9 && share > 0.0, "{share} {spread}");
        }
        let table = std::fs::read_to_string(here.path().join("fit.csv")).unwrap();
        assert_eq!(table.lines().count(), 1 + FEEDS.len());
        let svg = std::fs::read_to_string(here.path().join("fit.svg")).unwrap();
        assert_eq!(svg.matches("class=\"mark").count(), 3 * FEEDS.len());
        // Residuals are dots, an entry of the legend and a series each.
        assert_eq!(svg.matches(" dots\"").count(), 6);
    }
    let job = "schema = 1\nprogram = \"slot.ngc\"\n[tool]\ncutter = { shape = \"flat\", diameter_mm = 12, teeth = 4 }\n[material]\nname = \"wax_7\"\nfile = \"own.toml\"\n[stock]\nblock_mm = [[0, -20, -10], [40, 20, 0]]\n";
    std::fs::write(here.path().join("job.toml"), job).unwrap();
    let program = "G21 G90 G94\nS8000 M3\nG0 X-10 Y0 Z5\nG1 Z-2 F2000\nG1 X50 F3200\nG0 Z5\nM2\n";
    std::fs::write(here.path().join("slot.ngc"), program).unwrap();
    let cut = json(here.path(), &["engagement", "job.toml"]);
    let toml = std::fs::read_to_string(here.path().join("own.toml")).unwrap();
    let spread = toml
        .lines()
        .find_map(|l| l.strip_prefix("spread_percent = "));
    let spread: f64 = spread.unwrap().parse().unwrap();
    assert!((number(&cut["cutting"]["spread_percent"]) - spread).abs() < 1e-9);
}

/// A dynamometer under the part shows the opposite force; M4 with the part on the other side is the mirror image.
#[test]
fn signs_and_senses() {
    let here = tempfile::tempdir().unwrap();
    let text = SLOT.file(&mut Noise(5), 1.0);
    let turned_of = |text: &str, signs: [f64; 3]| -> String {
        let mut lines = text.lines();
        let head: Vec<&str> = lines.by_ref().take(2).collect();
        let row = |line: &str| {
            let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
            let forces: Vec<String> = (0..3)
                .map(|k| (signs[k] * cells[k + 1]).to_string())
                .collect();
            format!("{},{}\n", cells[0], forces.join(","))
        };
        let rows: String = lines.map(row).collect();
        format!("{}\n{rows}", head.join("\n"))
    };
    let turned = |signs: [f64; 3]| turned_of(&text, signs);
    let plain = values(&fit(here.path(), &text, SLOT.options));
    let part = format!("{} --acts-on part", SLOT.options);
    let on_part = fit(here.path(), &turned([-1.0; 3]), &part);
    assert_eq!(values(&on_part), plain);
    let other = format!("{} --counter-clockwise", SLOT.options);
    let mirrored = fit(here.path(), &turned([1.0, -1.0, 1.0]), &other);
    assert_eq!(values(&mirrored), plain);
    for cut in [CLIMB, CONVENTIONAL] {
        let text = cut.file(&mut Noise(6), 1.0);
        let plain = values(&fit(here.path(), &text, cut.options));
        let options = cut.options.replace("--part left", "--part right");
        let options = format!("{options} --counter-clockwise");
        let other = fit(here.path(), &turned_of(&text, [1.0, -1.0, 1.0]), &options);
        assert_eq!(values(&other), plain);
    }
    // Axes of the dynamometer that are exchanged are told with what to turn.
    let exchanged: String = text
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            match cells[..] {
                [feed, x, y, z] if feed.parse::<f64>().is_ok() => {
                    let [x, y] = [x, y].map(|force| -force.parse::<f64>().unwrap());
                    format!("{feed},{y},{x},{z}\n")
                }
                _ => format!("{line}\n"),
            }
        })
        .collect();
    let part = "x (along the feed) and y (to its left) of the forces look exchanged";
    let wrong = fit(here.path(), &exchanged, SLOT.options);
    let said = warnings(&wrong).join(" ");
    assert!(said.contains(part), "{said}");
    assert!(wrong["material_toml"].is_null());
    assert!(refused(&exchanged, SLOT.options).contains(part));
    // Oblique cutting: the tool of a helix that lifts the chip is drawn to the part. The other sign is asked about.
    for (z, is_asked) in [(1.0, true), (-1.0, false)] {
        let found = fit(here.path(), &turned([1.0, 1.0, z]), SLOT.options);
        let said = warnings(&found).join(" ");
        assert_eq!(said.contains("Turn the sign of fz_n"), is_asked, "{said}");
    }
    // The wrong sign is seen.
    let wrong = fit(here.path(), &turned([-1.0; 3]), SLOT.options);
    assert!(wrong["material_toml"].is_null());
    let said = warnings(&wrong).join(" ");
    assert!(said.contains("--acts-on part"), "{said}");
    let said = refused(&turned([-1.0; 3]), SLOT.options);
    assert!(
        said.contains("no material has these coefficients"),
        "{said}"
    );
}

#[test]
fn bad_files_are_refused_with_their_line() {
    let head = "feed_mm_per_tooth,fx_n,fy_n,fz_n\n";
    for (text, expected) in [
        (
            "feed,fx_n,fy_n,fz_n\n0.1,1,2,3\n".to_owned(),
            "means.csv:1: header: column `feed`",
        ),
        (
            "feed,fx_n,fy_n,fz_n\n0.1,1,2,3\n".to_owned(),
            "did you mean `feed_mm_per_tooth`?",
        ),
        (
            format!("{head}0.1,-9,80,9\n0.1,-9,81,9\n"),
            "means.csv:3: feed_mm_per_tooth: 0.1 mm in all 2 rows",
        ),
        (
            format!("{head}0.1,-9,80,9\n0.2,NaN,81,9\n"),
            "means.csv:3: fx_n: NaN N",
        ),
        (
            format!("{head}0.1,-9,80,9\n-0.2,-9,81,9\n"),
            "means.csv:3: feed_mm_per_tooth: -0.2 mm",
        ),
        (
            format!("{head}# fast\n0.1,-9,80,9\n\n7,-9,81,9\n"),
            "means.csv:5: feed_mm_per_tooth: 7 mm; expected at most half the diameter",
        ),
        (
            format!("{head}0.1,-9,80,9\n300,-9,81,9\n"),
            "means.csv:3: feed_mm_per_tooth: 300 mm",
        ),
        (
            "feed_mm_per_tooth,fx_n,fy_n\n0.1,-9,80\n0.2,-18,120\n".to_owned(),
            "means.csv: K_ac, K_ae: not determined by these forces",
        ),
        (
            format!("{head}0.1,-9,80,9\n0.2,-18,120,16\n"),
            "two feeds leave no interval",
        ),
    ] {
        let said = refused(&text, SLOT.options);
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let good = SLOT.file(&mut Noise(9), 1.0);
    for (options, expected) in [
        ("--depth-mm 2", "--width-mm"),
        ("--width-mm 4 --depth-mm 5", "--climb or --conventional"),
        ("--width-mm 13 --depth-mm 5", "at most the 12 mm"),
        (
            "--width-mm 12 --depth-mm 2 --spread-percent 300",
            "--spread-percent: spread of 300 %; expected 0 to 200 %",
        ),
        ("--width-mm 12 --depth-mm 2 --drill", "cannot be used with"),
        (
            "--width-mm 12 --depth-mm 2 --feed-per-tooth-mm 0.1",
            "cannot be used with",
        ),
    ] {
        let said = refused(&good, options);
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("means.csv"), &good).unwrap();
    let said = run(
        here.path(),
        &["force", "--acts-on", "part", "--material", "C45"],
    );
    assert_eq!(said.code, 1);
    assert!(said.err.contains("--fit"), "{}", said.err);
    // An input is never overwritten.
    let line = words("--width-mm 12 --depth-mm 2 --out-material means.csv --force-overwrite");
    let said = run(
        here.path(),
        &line.iter().map(String::as_str).collect::<Vec<_>>(),
    );
    assert_eq!(said.code, 1);
    assert!(flat(&said.err).contains("inputs are never overwritten"));
    assert_eq!(
        std::fs::read_to_string(here.path().join("means.csv")).unwrap(),
        good
    );
}

#[test]
fn doubtful_means_are_warned_of() {
    let here = tempfile::tempdir().unwrap();
    let head = "feed_mm_per_tooth;fx_n;fy_n;fz_n\n";
    let file = |feeds: &[f64], more: &dyn Fn(usize) -> f64| {
        let row = |(i, feed): (usize, &f64)| {
            let [x, y, z] = SLOT.mean(TRUTH, *feed);
            let wave = if i.is_multiple_of(2) { 0.3 } else { -0.3 };
            format!("{feed};{};{};{}\n", x + wave, y + more(i), z - wave)
        };
        format!(
            "{head}{}",
            feeds.iter().enumerate().map(row).collect::<String>()
        )
    };
    let feeds = [0.03, 0.05, 0.07, 0.09, 0.11, 0.13, 0.15, 0.17, 0.19, 0.21];
    for (text, code, words) in [
        (file(&[0.1, 0.2], &|_| 0.0), "feeds_of_fit", "2 feeds"),
        (file(&[0.1, 0.15, 0.2], &|_| 0.0), "feeds_of_fit", "3 feeds"),
        (
            file(&[0.1, 0.11, 0.12, 0.13, 0.14], &|_| 0.0),
            "feeds_of_fit",
            "from 0.1 to 0.14 mm only",
        ),
        (
            file(&[0.02, 0.03, 0.04, 0.05, 0.3], &|_| 0.0),
            "feeds_of_fit",
            "6.0 times the next one",
        ),
        (
            file(&[0.2, 0.4, 0.6, 0.8, 1.0], &|_| 0.0),
            "feeds_of_fit",
            "is it the feed per turn?",
        ),
        (
            file(&feeds, &|i| if i == 4 { 20.0 } else { 0.0 }),
            "outliers_in_means",
            "along y at 0.11 mm per tooth",
        ),
        (
            file(&feeds, &|i| if i < 5 { 60.0 } else { -60.0 }),
            "poor_fit",
            "linear law",
        ),
        (file(&feeds, &|_| -120.0), "implausible_coefficient", "K_te"),
    ] {
        let a = fit(here.path(), &text, SLOT.options);
        let all = a["warnings"].as_array().unwrap();
        let with_code = all.iter().filter(|w| w["code"] == code);
        let found = with_code.map(|w| w["message"].as_str().unwrap().to_owned());
        let found: Vec<String> = found.collect();
        assert!(found.iter().any(|m| m.contains(words)), "{words}: {all:?}");
    }
    // Stated by hand, the band needs no interval.
    let two = file(&[0.1, 0.2], &|_| 0.0);
    let a = fit(
        here.path(),
        &two,
        &format!("{} --spread-percent 15", SLOT.options),
    );
    assert_eq!(a["spread_from"], "given");
    assert!(
        a["material_toml"]
            .as_str()
            .unwrap()
            .contains("spread_percent = 15")
    );
    assert!(a["coefficients"][0]["low_95"].is_null());
}
