//! Real public programs, read where they lie: `docs/robot-programs.csv` lists repositories, commits, paths and licences;
//! none of them is copied here.

use std::io::Write;
use std::path::{Path, PathBuf};

use kinetostat_formats::*;
use nalgebra::Vector3;

/// The folder that holds `rapid`, `krl`, `ls` and `apt`.
const VARIABLE: &str = "KINETOSTAT_ROBOT_PROGRAMS";

/// The programs of a language by name; nothing (said plainly) where the variable is absent.
pub fn programs(folder: &str) -> Vec<(String, Vec<u8>)> {
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

/// Those with certain endings; nothing (said plainly) where the folder is absent, too.
pub fn programs_with(folder: &str, endings: &[&str]) -> Vec<(String, Vec<u8>)> {
    let root = std::env::var_os(VARIABLE);
    if root.is_some_and(|root| !Path::new(&root).join(folder).is_dir()) {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: {VARIABLE} has no folder {folder}, no real program was read"
        );
        return Vec::new();
    }
    let ends = |name: &str| {
        let ending = name.rsplit('.').next().unwrap_or_default();
        endings
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
    };
    let all = programs(folder).into_iter();
    all.filter(|(name, _)| ends(name)).collect()
}

/// Prints a number of public programs of others: eight of each language are asked for.
fn public(what: &str, count: usize) -> bool {
    let measured = f64::from(u32::try_from(count).expect("few"));
    kinetostat_testing::figure::at_least(
        &format!("public programs: {what}"),
        measured,
        8.0,
        "files",
    )
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
fn figure_rapid_programs_come_back_byte_for_byte() {
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
    assert!(public(
        "RAPID files that come back byte for byte",
        left.len()
    ));
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
fn figure_corrected_rapid_programs_are_read_again_at_the_corrected_places() {
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
    assert!(all.is_empty() || public("RAPID files corrected and read again", corrected));
}

/// What is stated for programs that are not wholly known from their text.
pub fn stated() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    options.external_axes = ExternalAxes::Carried;
    options.cutter_compensation = CutterCompensation::CentrePath;
    options
}

/// FANUC TP programs that are read with the options as they are, and their motions.
const READ_LS: [(&str, usize); 8] = [
    ("calib_sph.ls", 15),
    ("fixtures_invalid_AI_MISMATCH.LS", 0),
    ("fixtures_valid_AI_VALID.LS", 0),
    ("fanucPrograms_home.ls", 1),
    ("fanucPrograms_iverson.ls", 0),
    ("BEND.LS", 0),
    ("END_PART.LS", 0),
    ("tpe_ros.ls", 0),
];

/// TP programs that are refused whatever is stated, and why.
const REFUSED_LS: [(&str, &str); 3] = [
    ("cub_2.ls", "coordinated with another group"),
    ("layer_1.ls", "coordinated with another group"),
    ("SEARCH.LS", "the block that it belongs to is not whole"),
];

/// APT files that are read with the options as they are, and their motions.
const READ_APT: [(&str, usize); 6] = [
    ("TORETC_250_BOK.cls", 10),
    ("1_KONTUR_NAR_40_N2.cls", 46),
    ("3_PAZ_125_N2.cls", 640),
    ("4_SVERL_63_N2.cls", 90),
    ("ust_a.cls", 546),
    ("DEMO1.txt", 11),
];

/// APT files that are refused whatever is stated, and why.
const REFUSED_APT: [(&str, &str); 3] = [
    ("DEMO3.txt", "it turns the table or the head"),
    ("DEMO4.txt", "the word is not known"),
    ("PostProcessor_test.apt", "the word is not known"),
];

/// Reads the programs of a folder as they are and with all stated; what is read comes back byte for byte, and with all
/// places moved is read again there.
fn come_back(folder: &str, language: Language, plain: &[(&str, usize)], refused: &[(&str, &str)]) {
    let all = programs(folder);
    let (mut read_plain, mut left) = (Vec::new(), 0);
    for (name, bytes) in &all {
        let file = || vec![SourceFile::new(name.clone(), bytes.clone())];
        if let Ok(program) = read(language, file(), &ReadOptions::default()) {
            read_plain.push((name.as_str(), program.motions.len()));
        }
        let program = match read(language, file(), &stated()) {
            Ok(program) => program,
            Err(errors) => {
                let known = refused.iter().find(|(end, _)| name.ends_with(end));
                let (_, reason) = known.unwrap_or_else(|| panic!("{name}: {}", errors[0]));
                assert!(errors[0].reason.contains(reason), "{name}: {}", errors[0]);
                continue;
            }
        };
        let files = write(&program, &[], &WriteOptions::default()).unwrap();
        assert!(files[0].1 == *bytes, "{name}");
        moved(name, &program);
        left += 1;
    }
    if all.is_empty() {
        return;
    }
    assert_eq!(left, all.len() - refused.len());
    let what = "files that come back byte for byte, are corrected and read again";
    assert!(public(&format!("{language:?} {what}"), left));
    assert_eq!(read_plain.len(), plain.len(), "{read_plain:?}");
    for (end, motions) in plain {
        let found = |(name, count): &(&str, usize)| name.ends_with(end) && count == motions;
        assert!(read_plain.iter().any(found), "{end}: {read_plain:?}");
    }
    let _ = writeln!(
        std::io::stderr(),
        "{} of {} files in {folder} are read, {left} with what is unknown left",
        read_plain.len(),
        all.len()
    );
}

/// Writes a program with all its places moved (arcs divided) and reads it again.
fn moved(name: &str, program: &RobotProgram) {
    let wave = |place: Vector3<f64>| 0.1 * (place / 70.0).map(f64::sin);
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let Some(end) = motion.target.pose() else {
            continue;
        };
        // A helix whose way is not followed begins where it began.
        let next = program.motions.get(index + 1);
        if next.is_some_and(|next| matches!(next.target, Target::Unknown { .. })) {
            continue;
        }
        let place = end.position_mm + wave(end.position_mm);
        if matches!(motion.kind, MotionKind::Arc { .. }) {
            pieces.push(Piece::to(index, place + Vector3::new(0.0, 0.0, 1.0)));
        }
        pieces.push(Piece::to(index, place));
    }
    // An arc that begins where something changed is divided, too.
    let changed: Vec<usize> = pieces.iter().map(|piece| piece.motion).collect();
    for (index, motion) in program.motions.iter().enumerate() {
        let starts = motion.follows.is_some_and(|from| changed.contains(&from));
        if let (MotionKind::Arc { .. }, true, false) =
            (&motion.kind, starts, changed.contains(&index))
        {
            let end = motion.target.pose().unwrap().position_mm;
            pieces.push(Piece::to(index, end + Vector3::new(0.0, 0.0, 1.0)));
            pieces.push(Piece::to(index, end));
        }
    }
    pieces.sort_by_key(|piece| piece.motion);
    let files = write(program, &pieces, &WriteOptions::default())
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let files = (files.into_iter())
        .map(|(name, bytes)| SourceFile::new(name, bytes))
        .collect();
    let again = read(program.language, files, &stated())
        .unwrap_or_else(|errors| panic!("{name}: {}", errors[0]));
    let mut places = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let own: Vec<_> = pieces
            .iter()
            .filter(|piece| piece.motion == index)
            .collect();
        match own.is_empty() {
            true => places.push(motion.target.pose().map(|end| end.position_mm)),
            false => places.extend(own.iter().map(|piece| Some(piece.position_mm))),
        }
    }
    assert_eq!(again.motions.len(), places.len(), "{name}");
    for (motion, place) in again.motions.iter().zip(places) {
        if let (Some(found), Some(place)) = (motion.target.pose(), place) {
            let away = (found.position_mm - place).norm();
            assert!(away <= 1e-3, "{name}, line {}: {away} mm", motion.line);
        }
    }
}

#[test]
fn figure_fanuc_programs_come_back_byte_for_byte() {
    come_back("ls", Language::FanucLs, &READ_LS, &REFUSED_LS);
}

#[test]
fn figure_apt_files_come_back_byte_for_byte() {
    come_back("apt", Language::Apt, &READ_APT, &REFUSED_APT);
}

/// Ends of the names of KRL modules, and motions of what is read with the options as they are.
const KRL_READ: [(&str, usize); 6] = [
    ("_My_Job", 839),
    ("_MosaicoK_Pallet2E", 36),
    ("_CalcWobj_KUE_WEG", 0),
    ("_Dat_MillingData", 0),
    ("_Dat_xPoints", 0),
    ("_EKIserver_command_handler", 0),
];

/// KRL modules that are refused even where what is unknown is left: a sensor moves the tool, it goes on from where the tool
/// is (LIN_REL), or it is no program that a controller loads.
const KRL_REFUSED: [&str; 10] = [
    "kuka_files_RSI_Ethernet",
    "kuka_rsi_driver",
    "RSI_rsi_gpio_example",
    "RSI_rsi_joint_pos_4ms",
    "KR_C2_ros_rsi",
    "KR_C4_ros_rsi",
    "krl_ros_eki",
    "krc_PoseTrack",
    "sample_welding",
    "VisionRun",
];

/// The modules of a folder: files of one name are one.
fn krl_modules() -> Vec<(String, Vec<SourceFile>)> {
    let mut modules: Vec<(String, Vec<SourceFile>)> = Vec::new();
    for (name, bytes) in programs("krl") {
        let stem = name.rsplit_once('.').unwrap().0.to_owned();
        let file = SourceFile::new(name, bytes);
        match modules.last_mut().filter(|(last, _)| *last == stem) {
            Some((_, files)) => files.push(file),
            None => modules.push((stem, vec![file])),
        }
    }
    modules
}

#[test]
fn figure_krl_programs_come_back_byte_for_byte() {
    let (mut read, mut left, mut files_left, mut files_all) = (Vec::new(), Vec::new(), 0, 0);
    for (name, files) in krl_modules() {
        files_all += files.len();
        let mut options = ReadOptions::default();
        if let Ok(program) = read_krl(files.clone(), &options) {
            read.push((name.clone(), program.motions.len()));
        }
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        options.external_axes = ExternalAxes::Carried;
        match read_krl(files.clone(), &options) {
            Ok(program) => {
                let written = write(&program, &[], &WriteOptions::default()).unwrap();
                assert!(
                    written
                        .iter()
                        .zip(&files)
                        .all(|((_, bytes), file)| bytes == file.bytes()),
                    "{name}"
                );
                files_left += files.len();
                left.push(name);
            }
            Err(errors) => assert!(
                KRL_REFUSED.iter().any(|end| name.ends_with(end)),
                "{name}: {}",
                errors[0]
            ),
        }
    }
    if files_all == 0 {
        return;
    }
    let what = "KRL files that come back byte for byte";
    assert!(public(what, files_left), "{left:?}");
    assert_eq!(read.len(), KRL_READ.len(), "{read:?}");
    for (end, motions) in KRL_READ {
        assert!(
            read.iter()
                .any(|(name, found)| name.ends_with(end) && *found == motions),
            "{end}: {read:?}"
        );
    }
    let _ = writeln!(
        std::io::stderr(),
        "{} KRL modules are read, {} ({files_left} of {files_all} files) with what is unknown left: {read:?}",
        read.len(),
        left.len()
    );
}

#[test]
fn figure_corrected_krl_programs_are_read_again_at_the_corrected_places() {
    let all = krl_modules();
    let mut corrected = 0;
    for (name, files) in all.clone() {
        let count = files.len();
        let mut options = ReadOptions::default();
        options.external_axes = ExternalAxes::Carried;
        options.unknown_targets = UnknownTargets::LeftAsWritten;
        let Ok(program) = read_krl(files, &options) else {
            continue;
        };
        let wave = |place: Vector3<f64>| 0.1 * (place / 70.0).map(f64::sin);
        let mut pieces = Vec::new();
        for (index, motion) in program.motions.iter().enumerate() {
            if let Some(end) = motion.target.pose() {
                pieces.push(Piece::to(index, end.position_mm + wave(end.position_mm)));
            }
        }
        let written = write(&program, &pieces, &WriteOptions::default()).unwrap();
        let files = written
            .into_iter()
            .map(|(name, bytes)| SourceFile::new(name, bytes))
            .collect();
        let again = read_krl(files, &options).unwrap();
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
        corrected += usize::from(!pieces.is_empty()) * count;
    }
    assert!(all.is_empty() || public("KRL files corrected and read again", corrected));
}
