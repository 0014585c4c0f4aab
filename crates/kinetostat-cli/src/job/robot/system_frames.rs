//! Tools and bases of a KUKA controller, from the `$config.dat` that lies beside a program or where an archive of the controller has it.

use std::path::{Path, PathBuf};

use kinetostat_formats::{KRL_CONFIG, RobotProgram, SourceFile, krl_frames_of_config};
use kinetostat_machining::FileRead;
use kinetostat_program::Warning;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::robot::folder::Folder;
use crate::job::robot::source::{RobotSource, SystemFrames};
use crate::ui::failure::Answer;

/// An archive of a controller has its programs in `KRC/R1/Program` and folders of that, and `$config.dat` in `KRC/R1/System`.
const PROGRAMS: &str = "Program";
const SYSTEM: &str = "System";

/// Upper limit of the folders above a program in which [`PROGRAMS`] is searched.
const MOST_ABOVE: usize = 8;

/// Adds the tools and bases of the controller to a program that names them and has none of its own files for them: their place, and how
/// it was read.
pub(crate) fn with_system_frames(
    source: &mut RobotSource,
    program: &Path,
) -> Answer<Option<(PathBuf, FileRead)>> {
    if !source.language.needs_config(&source.files) {
        return Ok(None);
    }
    let Some(path) = places(program)
        .into_iter()
        .find_map(|of| of.file(KRL_CONFIG))
    else {
        return Ok(None);
    };
    // The path is shown relative to the working directory.
    let here = std::env::current_dir().unwrap_or_default();
    let path = path
        .strip_prefix(&here)
        .map_or(path.clone(), Path::to_owned);
    let bytes = InputFiles::default().bytes("data of the controller", &path)?;
    let file = SourceFile::new(KRL_CONFIG, bytes.as_slice());
    let Some(frames) = krl_frames_of_config(&file) else {
        return Ok(None);
    };
    let names = frames.bytes().split(|byte| *byte == b'\n');
    let names = names.filter_map(|line| {
        let (name, _) = std::str::from_utf8(line).ok()?.split_once('=')?;
        let declared = name.trim().rsplit(char::is_whitespace).next();
        Some(in_capitals(match name.contains('[') {
            true => name,
            false => declared?,
        }))
    });
    source.system_frames = Some(SystemFrames {
        path: path.clone(),
        names: names.collect(),
    });
    source.files.push(frames);
    let read = origin::file("data of the controller", &path, &bytes);
    Ok(Some((path, read)))
}

/// Candidate folders of the file: beside the program, in `../System`, in `System` beside a folder `Program` above it, and in
/// `R1/System` and `KRC/R1/System` below its folder.
fn places(program: &Path) -> Vec<Folder> {
    let Ok(program) = std::path::absolute(program) else {
        return Vec::new();
    };
    let Some(own) = program.parent() else {
        return Vec::new();
    };
    let below = |folder: Folder, names: &[&str]| {
        (names.iter()).try_fold(folder, |folder, name| folder.folder(name))
    };
    let beside = |folder: &Path| below(Folder::of(folder.parent()?), &[SYSTEM]);
    let above = own.ancestors().take(MOST_ABOVE);
    let programs = above.filter(|folder| {
        let name = folder.file_name();
        name.is_some_and(|name| name.eq_ignore_ascii_case(PROGRAMS))
    });
    let mut found = vec![Folder::of(own)];
    found.extend(beside(own));
    found.extend(programs.filter_map(beside));
    found.extend(below(Folder::of(own), &["R1", SYSTEM]));
    found.extend(below(Folder::of(own), &["KRC", "R1", SYSTEM]));
    found
}

/// Warns that tools and bases of motions come from the file found; those of the job have priority.
pub(crate) fn taken(source: &RobotSource, program: &RobotProgram) -> Option<Warning> {
    let found = source.system_frames.as_ref()?;
    let stated = &source.settings.reading.frames;
    let stated: Vec<String> = stated.keys().map(|name| in_capitals(name)).collect();
    let used = program.motions.iter().flat_map(|motion| {
        let frames = [&motion.tool, &motion.work_object];
        frames.map(|frame| (motion.line, frame))
    });
    let used: Vec<(usize, String)> = used
        .filter(|(_, frame)| frame.known().is_some())
        .map(|(line, frame)| (line, in_capitals(&frame.name)))
        .filter(|(_, name)| !stated.contains(name))
        .collect();
    // A base may be a sum of frames.
    let is_of = |used: &str, name: &str| used.split(':').any(|part| part == name);
    let of = |name: &&String| used.iter().find(|(_, used)| is_of(used, name));
    let names: Vec<&String> = found
        .names
        .iter()
        .filter(|name| of(name).is_some())
        .collect();
    let line = names.iter().filter_map(of).map(|(line, _)| *line).min()?;
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    Some(Warning::new(
        line,
        format!(
            "{}, which the program names, {} taken from '{}', where the program gives {} no value itself; if the controller has others, give its own {KRL_CONFIG} (files under [robot]), or state them (frames under [robot])",
            names.join(", "),
            if names.len() == 1 { "is" } else { "are" },
            found.path.display(),
            if names.len() == 1 { "it" } else { "them" },
        ),
    ))
}

/// Returns the name without blanks, in capitals.
fn in_capitals(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}
