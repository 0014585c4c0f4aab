//! Universal files and columns: those that another library has written, ours read back by it, and bad ones.
#![allow(clippy::print_stdout)] // what is skipped

use std::process::Command;

use kinetostat_chatter::{MeasuredResponse, Motion, read_columns, read_universal};
use kinetostat_testing::Worst;
use nalgebra::Complex;
use proptest::prelude::*;

use crate::universal_text::write_universal;

/// The two modes of `written_by_pyuff.py`, m/N.
fn curve(hz: f64) -> Complex<f64> {
    let w = std::f64::consts::TAU * hz;
    [(35.0, 0.02, 0.05), (80.0, 0.01, -0.02)]
        .into_iter()
        .map(|(f, zeta, constant)| {
            let w0 = std::f64::consts::TAU * f;
            Complex::from(constant) / Complex::new(w0 * w0 - w * w, 2.0 * zeta * w0 * w)
        })
        .sum()
}

const FILES: [(&str, &str, Motion, f64); 4] = [
    (
        "even double",
        include_str!("../data/even_double.unv"),
        Motion::Displacement,
        1e-9,
    ),
    (
        "even single",
        include_str!("../data/even_single.unv"),
        Motion::Displacement,
        2e-5,
    ),
    (
        "uneven double",
        include_str!("../data/uneven_double.unv"),
        Motion::Acceleration,
        5e-4,
    ),
    (
        "uneven single",
        include_str!("../data/uneven_single.unv"),
        Motion::Velocity,
        5e-4,
    ),
];

#[test]
fn files_of_another_library() {
    for (name, text, motion, share) in FILES {
        let file = read_universal(text).unwrap();
        let [response] = &file.responses[..] else {
            panic!("{name}: {}", file.responses.len());
        };
        assert_eq!(response.motion, motion, "{name}");
        assert!(response.units_stated, "{name}");
        assert_eq!(
            (response.response_node, response.response_direction),
            (7, 2),
            "{name}"
        );
        assert_eq!(
            (response.reference_node, response.reference_direction),
            (3, -1),
            "{name}"
        );
        let mut worst = Worst::new();
        let receptance = response.receptance();
        assert_eq!(
            receptance.len(),
            if name.starts_with("even") { 230 } else { 151 }
        );
        for (hz, value) in receptance {
            // Uneven abscissas have six digits: beside a peak the curve is that much off.
            worst.add_at((value - curve(hz)).norm() / curve(hz).norm(), || {
                format!("{name} {hz}")
            });
        }
        assert!(worst.value() < share, "{worst}");
    }
}

fn sample(even: bool, motion: Motion) -> MeasuredResponse {
    let frequencies_hz: Vec<f64> = (0..97)
        .map(|i| {
            if even {
                10.0 + 0.25 * f64::from(i)
            } else {
                10.0 * 1.02_f64.powi(i)
            }
        })
        .collect();
    MeasuredResponse {
        name: "tool, x by force along y".into(),
        response_node: 12,
        response_direction: 1,
        reference_node: 11,
        reference_direction: -2,
        motion,
        values: frequencies_hz.iter().map(|f| curve(*f)).collect(),
        frequencies_hz,
        units_stated: true,
    }
}

#[test]
fn what_we_write_comes_back() {
    for even in [true, false] {
        for motion in [Motion::Displacement, Motion::Velocity, Motion::Acceleration] {
            let written = [sample(even, motion), sample(!even, motion)];
            let file = read_universal(&write_universal(&written)).unwrap();
            assert_eq!(file.left_out, Vec::<String>::new());
            let mut worst = Worst::new();
            for (read, written) in file.responses.iter().zip(&written) {
                assert_eq!(read.motion, written.motion);
                assert_eq!(read.name, written.name);
                assert_eq!(read.reference_direction, -2);
                assert!(read.units_stated);
                for i in 0..97 {
                    worst.add(
                        (read.values[i] - written.values[i]).norm() / written.values[i].norm(),
                    );
                    worst.add(1e-6 * (read.frequencies_hz[i] / written.frequencies_hz[i] - 1.0));
                }
            }
            assert!(worst.of(2 * 2 * 97) < 2e-11, "{worst}");
        }
    }
}

#[test]
fn another_library_reads_ours() {
    let program = std::env::var("KINETOSTAT_PYUFF_PYTHON").unwrap_or_else(|_| "python3".into());
    let known = Command::new(&program).args(["-c", "import pyuff"]).output();
    if !known.is_ok_and(|said| said.status.success()) {
        println!(
            "skipped: {program} has no pyuff (pip install pyuff, or KINETOSTAT_PYUFF_PYTHON=path)"
        );
        return;
    }
    let written = [
        sample(true, Motion::Displacement),
        sample(false, Motion::Acceleration),
    ];
    let path = std::env::temp_dir().join(format!("kinetostat-pyuff-{}.unv", std::process::id()));
    std::fs::write(&path, write_universal(&written)).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/written_by_pyuff.py");
    let said = Command::new(&program)
        .arg(script)
        .arg("read")
        .arg(&path)
        .output()
        .unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!(
        said.status.success(),
        "{}",
        String::from_utf8_lossy(&said.stderr)
    );
    let text = String::from_utf8(said.stdout).unwrap();
    let mut worst = Worst::new();
    let expected = written
        .iter()
        .flat_map(|r| r.frequencies_hz.iter().zip(&r.values));
    for (line, (frequency, value)) in text.lines().zip(expected) {
        let fields: Vec<f64> = line.split(',').map(|f| f.parse().unwrap()).collect();
        assert_eq!(fields[..4], [12.0, 1.0, 11.0, -2.0]);
        worst.add(1e-6 * (fields[4] / frequency - 1.0));
        worst.add((Complex::new(fields[5], fields[6]) - value).norm() / value.norm());
    }
    assert!(worst.of(2 * 2 * 97) < 2e-11, "{worst}");
}

#[test]
fn bad_files_are_named_by_line() {
    let good = FILES[0].1;
    let with = |line: usize, text: &str| {
        let mut lines: Vec<&str> = good.lines().collect();
        lines[line - 1] = text;
        read_universal(&lines.join("\n")).unwrap_err()
    };
    for (line, text) in [
        (2, "   58b     1     2"),
        (8, "    4         0    0         0       NONE         x   2"),
        (
            9,
            "         7       230         1  5.00000e+00  5.00000e-01  0.00000e+00",
        ),
        (
            9,
            "         6       231         1  5.00000e+00  5.00000e-01  0.00000e+00",
        ),
        (
            9,
            "         6       230         1  5.00000e+00 -5.00000e-01  0.00000e+00",
        ),
        (9, "         6"),
        (10, "        17    0    0    0 NONE                 s"),
        (11, "         8    0    0    0 NONE                 m/s^2"),
        (11, "         2    0    0    0 NONE                 m"),
        (20, "   9.75925613723e-07  nonsense"),
        (21, "                 nan   1.0e-7    1.0e-7   1.0e-7"),
    ] {
        let error = with(line, text);
        let near = error.line.is_some_and(|found| found == line || found == 9);
        assert!(near, "{line} {text}: {error}");
    }
    for text in [
        "",
        "   -1\n",
        "hello",
        "    -1\n    58\n",
        "    -1\n    58\nx\n    -1\n",
        "    -1\n   151\nx\n    -1\n",
    ] {
        assert!(read_universal(text).is_err(), "{text:?}");
    }
    // A function that is no frequency response is left out by name, and units that are not stated are said to be so.
    let coherence = good.replacen("    4         0", "    6         0", 1);
    assert!(read_universal(&coherence).is_err());
    let both = format!(
        "{coherence}\n{}",
        good.replace(" m                   ", " NONE                ")
    );
    let file = read_universal(&both).unwrap();
    assert!(file.left_out[0].contains("type 6"), "{:?}", file.left_out);
    assert!(!file.responses[0].units_stated);
}

#[test]
fn columns_with_units() {
    let text = "# a hammer test\nfrequency_hz; xy_mag_g_per_n; xy_phase_deg; tip_re_mm_per_s_per_n; tip_im_mm_per_s_per_n\n10; 0.5; 90; 1; 2\n11; 0.6; -90; 3; 4\n";
    let all = read_columns(text).unwrap();
    assert_eq!(
        (all[0].motion, all[1].motion),
        (Motion::Acceleration, Motion::Velocity)
    );
    assert_eq!(
        (all[0].response_direction, all[0].reference_direction),
        (1, 2)
    );
    assert!((all[0].values[0] - Complex::new(0.0, 0.5 * 9.80665)).norm() < 1e-12);
    assert!((all[1].values[1] - Complex::new(3e-3, 4e-3)).norm() < 1e-15);
    // As `kinetostat frf --csv` writes them.
    let text = "frequency_hz,z_by_x_real_m_per_n,z_by_x_imaginary_m_per_n,z_by_x_magnitude_m_per_n,z_by_x_phase_deg\n10,3,4,5,53.13\n";
    let all = read_columns(text).unwrap();
    assert_eq!(all.len(), 1);
    assert_eq!(
        (all[0].response_direction, all[0].reference_direction),
        (3, 1)
    );
    assert_eq!(all[0].values, [Complex::new(3.0, 4.0)]);
    for (text, line) in [
        ("", 1),
        ("f,xx_re_m_per_n,xx_im_m_per_n\n1,2,3\n", 1),
        ("frequency_hz\n1\n", 1),
        ("frequency_hz,xx_re,xx_im\n1,2,3\n", 1),
        ("frequency_hz,xx_re_m_per_n\n1,2\n", 1),
        ("frequency_hz,xx_mag_m_per_n\n1,2\n", 1),
        ("frequency_hz,xx_re_m_per_n,xx_im_m_per_n\n1,2,3\n2,3\n", 3),
        (
            "frequency_hz,xx_re_m_per_n,xx_im_m_per_n\n1,2,3\n2,3,four\n",
            3,
        ),
        (
            "frequency_hz,xx_re_m_per_n,xx_im_m_per_n\n2,2,3\n1,3,4\n",
            1,
        ),
        ("frequency_hz,xx_re_m_per_n,xx_im_m_per_n\n", 1),
    ] {
        assert_eq!(read_columns(text).unwrap_err().line, Some(line), "{text:?}");
    }
}

proptest! {
    /// Whatever a file holds, it is read or refused.
    #[test]
    fn no_file_ends_in_a_panic(at in 0..10_000_usize, length in 0..40_usize, with in "[ -~\u{e9}\u{b5}\n]{0,20}") {
        let mut text: Vec<char> = FILES[at % 4].1.chars().collect();
        let from = at % text.len();
        let to = (from + length).min(text.len());
        text.splice(from..to, with.chars());
        let text: String = text.into_iter().collect();
        let _ = read_universal(&text);
        let _ = read_columns(&text);
    }
}

/// Units as files of many laboratories state them; those that nobody knows are refused by line, not passed over.
#[test]
fn units_of_the_axes() {
    let good = include_str!("../data/even_double.unv");
    let lines: Vec<&str> = good.lines().collect();
    let with = |abscissa: Option<&str>, ordinate: Option<&str>, force: Option<&str>| {
        let changed = [(9, abscissa), (10, ordinate), (11, force)];
        let mut all: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        for (at, unit) in changed {
            if let Some(unit) = unit {
                let head = format!("{:<47}", &all[at][..all[at].len().min(47)]);
                all[at] = format!("{head}{unit}");
            }
        }
        read_universal(&all.join("\n"))
    };
    let plain = with(None, Some("m"), Some("N")).unwrap().responses[0].clone();
    for (ordinate, force, size) in [
        ("mm", "N", 1e-3),
        ("in", "lbf", 0.0254 / 4.448_221_615_260_5),
        ("ft", "lbf", 0.3048 / 4.448_221_615_260_5),
        ("mm/N", "", 1e-3),
        ("mm/N", "N", 1e-3),
        ("um/kN", "NONE", 1e-9),
    ] {
        let found = with(None, Some(ordinate), Some(force)).unwrap().responses[0].clone();
        assert!(found.units_stated, "{ordinate} {force}");
        let ratio = (found.values[3] / plain.values[3]).re / size;
        assert!((ratio - 1.0).abs() < 1e-12, "{ordinate} {force}: {ratio}");
    }
    let turned = with(Some("rad/s"), None, None).unwrap().responses[0].clone();
    let ratio = plain.frequencies_hz[5] / turned.frequencies_hz[5];
    assert!((ratio - std::f64::consts::TAU).abs() < 1e-12, "{ratio}");
    for (line, found) in [
        (10, with(Some("furlongs"), None, None)),
        (11, with(None, Some("furlongs"), None)),
        (12, with(None, None, Some("stones"))),
    ] {
        let error = found.unwrap_err();
        assert_eq!(error.line, Some(line), "{error}");
    }
}
