//! The real programs of the shared data, which are not part of the repository.

// Helpers of tests, which clippy does not count as tests.
use std::io::Write;
use std::path::PathBuf;

use kinetostat_program::*;
use kinetostat_testing::largest_size;
use nalgebra::Vector3;

/// The programs by name, or nothing (said plainly) where the shared data is absent.
fn programs() -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/gcode");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        // Past the capture of the test harness, so that it is seen.
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: no shared data beside the checkout, the real programs were not read"
        );
        return Vec::new();
    };
    let mut programs: Vec<(String, Vec<u8>)> = entries
        .filter_map(|entry| {
            let path = entry.unwrap().path();
            let name = path
                .file_name()?
                .to_str()?
                .strip_suffix(".gcode")?
                .to_owned();
            Some((name, std::fs::read(&path).unwrap()))
        })
        .collect();
    programs.sort();
    assert!(programs.len() >= 8, "the shared data has become smaller");
    programs
}

fn program(name: &str) -> Option<Vec<u8>> {
    programs()
        .into_iter()
        .find(|(found, _)| found == name)
        .map(|(_, bytes)| bytes)
}

fn millimetres() -> ReadOptions {
    let mut reading = ReadOptions::default();
    reading.units = Some(Units::Millimetres);
    reading
}

/// A smooth field of some tenths of a millimetre.
fn smooth(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let p = request.position_mm / 60.0;
    Ok(0.1
        * Vector3::new(
            (p.x + p.y).sin(),
            (p.y - p.z).cos(),
            (p.x * 0.7 + 1.0).sin(),
        ))
}

/// The same and a load along the feed, which turns at every corner and begins below the surface.
fn turning(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let cuts = request.position_mm.z < -0.5;
    let load = request.tangent.filter(|_| cuts).unwrap_or_default() * 0.03;
    Ok(smooth(request)? + load)
}

#[test]
fn every_program_but_the_subroutine_dialect_is_read_byte_for_byte() {
    for (name, bytes) in programs() {
        match Program::read(bytes.clone()) {
            Ok(program) => {
                assert_ne!(name, "371373P");
                assert!(program.bytes() == bytes, "{name}");
                assert!(!program.is_marked_compensated());
            }
            Err(error) => {
                assert_eq!(name, "371373P", "{error}");
                let message = error.to_string();
                assert!(
                    message.starts_with("line 5: `N5   G22 C1 B0`: the call G22"),
                    "{message}"
                );
            }
        }
    }
}

#[test]
fn without_correction_the_straight_programs_come_back_byte_for_byte() {
    for name in ["tball-pocket", "tball-engrave", "jsdc", "part"] {
        let Some(bytes) = program(name) else { return };
        for start in [None, Some(Vector3::zeros())] {
            let program = Program::read(bytes.clone()).unwrap();
            let reading = {
                let mut reading = millimetres();
                reading.start_position_mm = start;
                reading
            };
            let path = interpret(&program, &reading).unwrap();
            let writing = {
                let mut writing = WriteOptions::default();
                writing.header = None;
                writing
            };
            let written =
                write_corrected(&program, &path, &NoCorrection, &writing, &Unwatched).unwrap();
            assert!(written.bytes == bytes, "{name} changed");
            assert_eq!(
                written.accounting.blocks_carried,
                written.accounting.blocks_in
            );
            verify_written(&program, &path, &written, &reading, &writing).unwrap();
        }
    }
}

#[test]
fn with_smooth_and_with_jumping_corrections_every_promise_is_kept_for_the_real_programs() {
    for name in ["tball-pocket", "tball-engrave", "jsdc", "part", "arc-ijk"] {
        let Some(bytes) = program(name) else { return };
        let program = Program::read(bytes).unwrap();
        let reading = millimetres();
        let path = interpret(&program, &reading).unwrap();
        let writing = WriteOptions::default();
        for field in [&smooth as &dyn CorrectionField, &turning] {
            let written = write_corrected(&program, &path, field, &writing, &Unwatched).unwrap();
            let found = verify_written(&program, &path, &written, &reading, &writing).unwrap();
            assert_eq!(found.moves, written.pieces.len());
            assert!(written.accounting.largest_rounding_mm <= 0.5e-4 * 3.0_f64.sqrt() * 1.001);
            assert!(
                Program::read(written.bytes)
                    .unwrap()
                    .is_marked_compensated()
            );
        }
    }
}

#[test]
fn the_calibration_program_has_five_invalid_arcs_and_the_first_is_named_with_both_radii() {
    let Some(bytes) = program("Circle_Diamond_Square_Calibration") else {
        return;
    };
    let program = Program::read(bytes.clone()).unwrap();
    let error = interpret(&program, &ReadOptions::default()).unwrap_err();
    let message = error.to_string();
    assert_eq!(error.line, 624, "{message}");
    assert!(message.contains("`N624 "), "{message}");
    assert!(message.contains("mm at its start and"), "{message}");

    // With the tolerance relaxed all 80 are read; the mismatch is counted off their radii.
    let relaxed = {
        let mut reading = ReadOptions::default();
        reading.arc_tolerance_mm = 2.0;
        reading
    };
    let path = interpret(&program, &relaxed).unwrap();
    let mismatches: Vec<f64> = path
        .moves
        .iter()
        .filter_map(|motion| match motion.curve {
            Curve::Arc(arc) => Some((arc.start_radius - arc.end_radius).abs()),
            Curve::Line => None,
        })
        .collect();
    assert_eq!(mismatches.len(), 80);
    assert_eq!(
        mismatches
            .iter()
            .filter(|mismatch| **mismatch > 0.005)
            .count(),
        5
    );
    let largest = largest_size(mismatches.iter().copied());
    assert!((largest - 1.414).abs() < 1e-3, "{largest}");

    let writing = WriteOptions::default();
    let written = write_corrected(&program, &path, &smooth, &writing, &Unwatched).unwrap();
    verify_written(&program, &path, &written, &relaxed, &writing).unwrap();
}

#[test]
fn cutter_compensation_and_missing_units_are_refused_when_interpreted() {
    let Some(bytes) = program("helical-thread-milling") else {
        return;
    };
    let message = interpret(&Program::read(bytes).unwrap(), &ReadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("line 4: "), "{message}");
    let options = {
        let mut reading = ReadOptions::default();
        reading.start_position_mm = Some(Vector3::zeros());
        reading
    };
    let Some(bytes) = program("helical-thread-milling") else {
        return;
    };
    let message = interpret(&Program::read(bytes).unwrap(), &options)
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("line 5: `G42 D08`: G42 (cutter radius compensation on)"),
        "{message}"
    );
    let Some(bytes) = program("arc-ijk") else {
        return;
    };
    let path = interpret(&Program::read(bytes).unwrap(), &ReadOptions::default()).unwrap();
    let mut warnings = path.warnings.iter();
    assert!(warnings.any(|w| w.line == 2 && w.text.contains("taken for millimetres")));
}
