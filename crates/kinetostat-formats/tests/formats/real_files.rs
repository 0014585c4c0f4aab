//! Real public programs, read where they lie: `docs/robot-programs.csv` lists repositories, commits, paths and licences;
//! none of them is copied here.

use std::io::Write;
use std::path::{Path, PathBuf};

use kinetostat_formats::*;
use nalgebra::Vector3;

/// The folder that holds `rapid`, `krl`, `ls` and `apt`.
const VARIABLE: &str = "KINETOSTAT_ROBOT_PROGRAMS";

/// The programs of a language by name; nothing (said plainly) where the variable is absent.
fn programs(folder: &str) -> Vec<(String, Vec<u8>)> {
    let Some(root) = std::env::var_os(VARIABLE) else {
        // Past the capture of the test harness, so that it is seen.
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: {VARIABLE} is not set, no real program was read"
        );
        return Vec::new();
    };
    let folder: PathBuf = Path::new(&root).join(folder);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found: Vec<(String, Vec<u8>)> = entries
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, std::fs::read(path).unwrap())
        })
        .collect();
    found.sort();
    assert!(
        found.len() >= 20,
        "programs are missing in {}",
        folder.display()
    );
    found
}

/// Ends of names, and motions of what is read with the options as they are.
const READ: [(&str, usize); 7] = [
    ("voorbeeld_main.prg", 0),
    ("rdmlog0.prg", 2500),
    ("rdmlog2.prg", 209),
    ("xample_program.prg", 815),
    ("path-tracing_Module1.mod", 54),
    ("pick-and-place_MainModule.mod", 8),
    ("playweld.mod", 262),
];

/// Those that are no module a controller loads.
const MALFORMED: [&str; 2] = ["letters.mod", "Stena_obluk_MainModule.mod"];

#[test]
fn rapid_programs_come_back_byte_for_byte() {
    let mut read = Vec::new();
    let mut left = Vec::new();
    let all = programs("rapid");
    for (name, bytes) in &all {
        let file = || vec![SourceFile::new(name.clone(), bytes.clone())];
        let mut options = ReadOptions::default();
        if let Ok(program) = read_rapid(file(), &options) {
            read.push((name.as_str(), program.motions.len()));
        }
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        options.external_axes = ExternalAxes::Carried;
        for frame in ["cursorTool", "cursorWObj", "wWobj"] {
            options
                .frames
                .insert(frame.into(), nalgebra::Isometry3::identity());
        }
        match read_rapid(file(), &options) {
            Ok(program) => {
                let files = write(&program, &[], &WriteOptions::default()).unwrap();
                assert!(files[0].1 == *bytes, "{name}");
                left.push(name);
            }
            Err(errors) => {
                assert!(
                    MALFORMED.iter().any(|end| name.ends_with(end)),
                    "{name}: {}",
                    errors[0]
                );
            }
        }
    }
    if all.is_empty() {
        return;
    }
    assert_eq!(left.len(), all.len() - MALFORMED.len());
    assert_eq!(read.len(), READ.len());
    for (end, motions) in READ {
        assert!(
            read.iter()
                .any(|(name, found)| name.ends_with(end) && *found == motions),
            "{end}: {read:?}"
        );
    }
    let _ = writeln!(
        std::io::stderr(),
        "{} of {} RAPID files are read, {} with what is unknown left: {read:?}",
        read.len(),
        all.len(),
        left.len()
    );
}

#[test]
fn corrected_rapid_programs_are_read_again_at_the_corrected_places() {
    let all = programs("rapid");
    let mut corrected = 0;
    for (name, bytes) in all.clone() {
        let mut options = ReadOptions::default();
        options.external_axes = ExternalAxes::Carried;
        let Ok(program) = read_rapid(vec![SourceFile::new(name.clone(), bytes)], &options) else {
            continue;
        };
        let wave = |place: Vector3<f64>| 0.1 * (place / 70.0).map(f64::sin);
        let mut pieces = Vec::new();
        for (index, motion) in program.motions.iter().enumerate() {
            let Some(end) = motion.target.pose() else {
                continue;
            };
            let mut piece = Piece::to(index, end.position_mm + wave(end.position_mm));
            if let MotionKind::Circular { via } = &motion.kind {
                let via = via.pose().unwrap().position_mm;
                piece.via_mm = Some(via + wave(via));
            }
            pieces.push(piece);
        }
        let written = write(&program, &pieces, &WriteOptions::default()).unwrap();
        let files = written
            .into_iter()
            .map(|(name, bytes)| SourceFile::new(name, bytes))
            .collect();
        let again = read_rapid(files, &options).unwrap();
        assert_eq!(again.motions.len(), program.motions.len(), "{name}");
        for piece in &pieces {
            let found = again.motions[piece.motion]
                .target
                .pose()
                .unwrap()
                .position_mm;
            let away = (found - piece.position_mm).norm();
            assert!(away <= 1e-3, "{name}: {away} mm");
        }
        corrected += 1;
    }
    // Those of `READ` and one on a track.
    assert!(all.is_empty() || corrected == READ.len() + 1, "{corrected}");
}
