//! Real public programs, read where they lie (`KINETOSTAT_ROBOT_PROGRAMS`/heidenhain; `docs/robot-programs.csv` names
//! repositories, commits, paths and licences); none of them is copied here.

use std::collections::BTreeMap;
use std::io::Write;

use kinetostat_formats::*;
use kinetostat_testing::largest;
use nalgebra::Vector3;

use crate::real_files::{programs, stated};

/// The programs by name; nothing, said plainly, where there are none.
fn all() -> Vec<(String, Vec<u8>)> {
    let root = std::env::var_os("KINETOSTAT_ROBOT_PROGRAMS");
    if let Some(root) = root
        && !std::path::Path::new(&root).join("heidenhain").is_dir()
    {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: the folder heidenhain is not there, no real Heidenhain program was read"
        );
        return Vec::new();
    }
    let mut found = programs("heidenhain");
    found.retain(|(name, _)| name.ends_with(".h"));
    found
}

/// Moves all places of a program and reads it again: the largest distance from where they were to be, mm.
fn moved(name: &str, program: &RobotProgram) -> f64 {
    let wave = |place: Vector3<f64>| 0.1 * (place / 70.0).map(f64::sin);
    let (mut pieces, mut places) = (Vec::new(), Vec::new());
    for (index, motion) in program.motions.iter().enumerate() {
        let Some(end) = motion.target.pose() else {
            places.push(None);
            continue;
        };
        let place = end.position_mm + wave(end.position_mm);
        if matches!(motion.kind, MotionKind::Arc { .. }) {
            let between = place + Vector3::new(0.0, 0.0, 1.0);
            pieces.push(Piece::to(index, between));
            places.push(Some(between));
        }
        pieces.push(Piece::to(index, place));
        places.push(Some(place));
    }
    let files = write(program, &pieces, &WriteOptions::default())
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let files = files
        .into_iter()
        .map(|(name, bytes)| SourceFile::new(name, bytes))
        .collect();
    let again =
        read_heidenhain(files, &stated()).unwrap_or_else(|errors| panic!("{name}: {}", errors[0]));
    assert_eq!(again.motions.len(), places.len(), "{name}");
    let mut worst = 0.0;
    for (motion, place) in again.motions.iter().zip(places) {
        if let (Some(found), Some(place)) = (motion.target.pose(), place) {
            let away = (found.position_mm - place).norm();
            assert!(away <= 1e-3, "{name}, line {}: {away} mm", motion.line);
            worst = largest([worst, away]);
        }
    }
    worst
}

#[test]
fn they_come_back_byte_for_byte_and_take_corrections() {
    let all = all();
    let (mut plain, mut with_all, mut expanded) = (0, 0, 0);
    let mut motions = 0;
    let mut refused: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (name, bytes) in &all {
        let file = SourceFile::new(name.clone(), bytes.clone());
        assert_eq!(
            language_of(name, bytes),
            Some(Language::Heidenhain),
            "{name}"
        );
        plain += usize::from(read_heidenhain(vec![file.clone()], &ReadOptions::default()).is_ok());
        if let Ok(program) = read_heidenhain(vec![file.clone()], &stated()) {
            let files = write(&program, &[], &WriteOptions::default()).unwrap();
            assert!(files[0].1 == *bytes, "{name}");
            moved(name, &program);
            with_all += 1;
        }
        let flat = expand_heidenhain(vec![file], &stated());
        match flat.and_then(|flat| read_heidenhain(vec![flat.file], &stated())) {
            Ok(program) => {
                motions += program.motions.len();
                moved(name, &program);
                expanded += 1;
            }
            Err(errors) => {
                let first = &errors[0];
                refused.entry(first.reason.clone()).or_default().push(name);
            }
        }
    }
    assert!(all.is_empty() || (plain >= 8 && with_all >= 8 && expanded >= 40));
    let _ = writeln!(
        std::io::stderr(),
        "{} Heidenhain files: {plain} read as they are, {with_all} with all stated, {expanded} when written flat ({motions} motions); refused: {refused:#?}",
        all.len()
    );
}
