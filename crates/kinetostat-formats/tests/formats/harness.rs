//! What random programs of any language must keep.
//!
//! Whatever the bytes are, they are read or refused with a line; what is read comes back byte for byte, and with corrections
//! is read again with those corrections; divided, it goes through all places in their order.

use std::collections::BTreeMap;

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

pub use crate::chance::Chance;

/// A check that one language alone needs: it may change what is asked of the broken files.
pub type OwnCheck = fn(&mut Chance, &mut Kind, &[Vec<u8>]) -> Result<(), String>;

/// A language, what it can write, and its random programs.
pub struct Kind {
    pub language: Language,
    pub options: ReadOptions,
    /// Whether an orientation can be turned by itself.
    pub turns: bool,
    /// Whether speeds are changed, too.
    pub speeds: bool,
    /// Words that break a text.
    pub words: &'static [&'static str],
    pub place_mm: f64,
    pub turn_rad: f64,
    /// Makes the files of a program that is understood.
    pub whole: fn(&mut Chance) -> Vec<String>,
    /// Reasons for which the writer may refuse a correction by chance.
    pub said: &'static [&'static str],
    pub own: OwnCheck,
    /// Names of the files.
    pub names: [&'static str; 2],
}

impl Kind {
    /// A language whose places alone are changed.
    pub fn of(
        language: Language,
        options: ReadOptions,
        whole: fn(&mut Chance) -> Vec<String>,
    ) -> Self {
        Self {
            language,
            options,
            turns: false,
            speeds: false,
            words: &[],
            place_mm: PLACE_MM,
            // Half of the seventh decimal in each of four parts, doubled.
            turn_rad: 4e-7,
            whole,
            said: &[],
            own: |_, _, _| Ok(()),
            names: ["a.txt", "a.dat"],
        }
    }

    /// A fault, unless the writer may say it.
    pub fn unless_said(&self, found: Result<(), String>) -> Result<(), String> {
        found.or_else(
            |what| match self.said.iter().any(|said| what.contains(said)) {
                true => Ok(()),
                false => Err(what),
            },
        )
    }
}

/// Bytes of a text, some of them lost, doubled or changed.
pub fn broken(chance: &mut Chance, text: &str, kind: &Kind) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..chance.below(6) {
        let at = chance.below(bytes.len());
        let end = (at + chance.below(40)).min(bytes.len());
        match chance.below(5) {
            0 => drop(bytes.drain(at..end)),
            1 => {
                let copy = bytes[at..end].to_vec();
                let to = chance.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            2 => {
                let symbols = b";,:[](){}/\\&$#'\"!%=\n+-.E9\xffA ";
                bytes[at] = symbols[chance.below(symbols.len())];
            }
            3 => {
                bytes.splice(at..at, chance.of(kind.words).bytes());
            }
            _ if chance.below(4) == 0 => bytes.truncate(at.max(1)),
            _ => {}
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

/// The program of a file, or of one with its data list.
pub fn read_files(kind: &Kind, files: &[Vec<u8>]) -> Result<RobotProgram, Vec<ProgramError>> {
    let named = kind.names.iter().zip(files);
    let files = named.map(|(name, bytes)| SourceFile::new(*name, bytes.as_slice()));
    read(kind.language, files.collect(), &kind.options)
}

/// What was written, without the names.
fn bytes_of(files: Vec<(String, Vec<u8>)>) -> Vec<Vec<u8>> {
    files.into_iter().map(|(_, bytes)| bytes).collect()
}

/// What a frame is; its name and why it is not known may say a line, which is another once pieces stand before it.
fn frame_of(frame: &FrameUse) -> (Option<&str>, Option<&Isometry3<f64>>) {
    (frame.name.split(" of line ").next(), frame.known())
}

/// Corrections by chance for the motions of a program.
pub fn corrections(chance: &mut Chance, program: &RobotProgram, kind: &Kind) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut first_runs = BTreeMap::new();
    for (index, motion) in program.motions.iter().enumerate() {
        // A statement that runs several times has one correction for all of them.
        let first = *(first_runs.entry((motion.file, motion.span.start))).or_insert(index);
        if first != index {
            let same = pieces.iter().find(|piece| piece.motion == first);
            pieces.extend(same.cloned().map(|piece| Piece {
                motion: index,
                ..piece
            }));
            continue;
        }
        let Some(end) = motion.target.pose().filter(|_| chance.below(3) > 0) else {
            continue;
        };
        // An arc is about its written centre: neither its end nor its start changes.
        let is_arc = |motion: &Motion| matches!(motion.kind, MotionKind::Arc { .. });
        let next = program.motions.get(index + 1);
        if is_arc(motion) || next.is_some_and(is_arc) {
            continue;
        }
        if let MotionKind::Circular { via } = &motion.kind
            && via.pose().is_none()
        {
            continue;
        }
        let mut shift = || Vector3::new(chance.within(0.5), chance.within(0.5), chance.within(0.5));
        let mut piece = Piece::to(index, end.position_mm + shift());
        if let MotionKind::Circular { via } = &motion.kind {
            piece.via_mm = via.pose().map(|via| via.position_mm + shift());
        }
        if kind.turns && chance.below(2) == 0 {
            let angles = [0, 1, 2].map(|_| chance.within(1e-2));
            let turn = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
            piece.orientation = Some(turn * end.orientation);
        }
        if kind.speeds && chance.below(4) == 0 && motion.speed.mm_per_s.is_some() {
            piece.speed_factor = 1.0 + chance.within(0.1);
        }
        let near = |place: Vector3<f64>| place.norm() < 9e5;
        if near(piece.position_mm) && piece.via_mm.is_none_or(near) {
            pieces.push(piece);
        }
    }
    pieces
}

/// What is wrong with the writing of a program, if anything.
pub fn write_and_read(program: &RobotProgram, pieces: &[Piece], kind: &Kind) -> Result<(), String> {
    let files = match write(program, pieces, &WriteOptions::default()) {
        Ok(files) => files,
        // A target whose numbers are constants of the program cannot be corrected, and that is said.
        Err(error) if error.to_string().contains("numbers are those of constants") => return Ok(()),
        Err(error) => return Err(error.to_string()),
    };
    let again = read_files(kind, &bytes_of(files))
        .map_err(|errors| format!("read again: {}", errors[0]))?;
    if again.motions.len() != program.motions.len() {
        return Err("another number of motions".to_owned());
    }
    let (mut place, mut turn) = (Worst::new(), Worst::new());
    let mut compare = |found: &PoseTarget, to: Vector3<f64>, orientation: UnitQuaternion<f64>| {
        place.add((found.position_mm - to).norm());
        turn.add(found.orientation.angle_to(&orientation));
    };
    // In KRL a speed that is stated and restored in a loop is not that of every way any more, as far as the reader looks; and
    // one that was known by two ways with different words may be known with the words of the restored one.
    let changed = pieces.iter().any(|piece| piece.speed_factor != 1.0);
    let is_open = changed && kind.language == Language::Krl;
    for (index, (before, after)) in program.motions.iter().zip(&again.motions).enumerate() {
        let (Some(old), Some(new)) = (before.target.pose(), after.target.pose()) else {
            continue;
        };
        let piece = pieces.iter().find(|piece| piece.motion == index);
        let to = piece.map_or(old.position_mm, |piece| piece.position_mm);
        let orientation = piece.and_then(|piece| piece.orientation);
        compare(new, to, orientation.unwrap_or(old.orientation));
        if let (MotionKind::Circular { via: old }, MotionKind::Circular { via: new }) =
            (&before.kind, &after.kind)
            && let (Some(old), Some(new)) = (old.pose(), new.pose())
        {
            let to = piece.and_then(|piece| piece.via_mm);
            // How the tool stands on the way of KRL's circles is said by their ends.
            let stands = match kind.language {
                Language::Krl => new.orientation,
                _ => old.orientation,
            };
            compare(new, to.unwrap_or(old.position_mm), stands);
        }
        if kind.speeds {
            let factor = piece.map_or(1.0, |piece| piece.speed_factor);
            speed_is_kept(before, after, factor, is_open)
                .map_err(|what| format!("motion {index}: {what}"))?;
        }
        if (
            before.zone,
            frame_of(&before.tool),
            frame_of(&before.work_object),
            before.runs,
            before.follows,
        ) != (
            after.zone,
            frame_of(&after.tool),
            frame_of(&after.work_object),
            after.runs,
            after.follows,
        ) {
            return Err(format!("motion {index}: another zone, frame or order"));
        }
    }
    let largest = |worst: &Worst| worst.measured().unwrap_or(0.0);
    let (place, turn) = (largest(&place), largest(&turn));
    match place <= kind.place_mm && turn <= kind.turn_rad {
        true => Ok(()),
        false => Err(format!("{place} mm and {turn} rad away")),
    }
}

/// What is wrong with the speed of a motion that was written, if anything.
fn speed_is_kept(
    before: &Motion,
    after: &Motion,
    factor: f64,
    is_open: bool,
) -> Result<(), &'static str> {
    let (old, new) = (before.speed.mm_per_s, after.speed.mm_per_s);
    if is_open && (old.is_none() || new.is_none()) {
        return Ok(());
    }
    let away = new.unwrap_or(0.0) - factor * old.unwrap_or(0.0);
    match away.abs() <= 1e-4 {
        true => Ok(()),
        false => Err("another speed"),
    }
}

/// Straight motions, circles and arcs divided: whether what is written again goes through all places, in their order.
pub fn divide_and_read(
    chance: &mut Chance,
    program: &RobotProgram,
    kind: &Kind,
) -> Result<(), String> {
    let mut pieces = Vec::new();
    let mut places = Vec::new();
    let mut first_runs: BTreeMap<(usize, usize), Vec<Vector3<f64>>> = BTreeMap::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let statement = (motion.file, motion.span.start);
        if let Some(own) = first_runs.get(&statement) {
            pieces.extend(own.iter().map(|place| Piece::to(index, *place)));
            places.extend(match own.is_empty() {
                true => vec![motion.target.pose().map(|end| end.position_mm)],
                false => own.iter().copied().map(Some).collect(),
            });
            continue;
        }
        let Some(end) = (motion.target.pose()).filter(|end| end.position_mm.norm() < 9e5) else {
            places.push(None);
            first_runs.insert(statement, Vec::new());
            continue;
        };
        let halves = [
            Piece::to(index, end.position_mm),
            Piece::to(index, end.position_mm),
        ];
        let count = match chance.below(3) {
            // What cannot be divided says so.
            0 if write(program, &halves, &WriteOptions::default()).is_ok() => 2 + chance.below(3),
            _ => 0,
        };
        let mut own = Vec::new();
        for step in 1..count {
            own.push(end.position_mm + Vector3::new(chance.within(5.0), step as f64, 0.0));
        }
        own.push(end.position_mm);
        if count > 0 {
            pieces.extend(own.iter().map(|place| Piece::to(index, *place)));
        }
        first_runs.insert(statement, if count > 0 { own.clone() } else { Vec::new() });
        places.extend(own.into_iter().map(Some));
    }
    let files =
        write(program, &pieces, &WriteOptions::default()).map_err(|error| error.to_string())?;
    let again =
        read_files(kind, &bytes_of(files)).map_err(|errors| format!("divided: {}", errors[0]))?;
    let found: Vec<Option<Vector3<f64>>> = again
        .motions
        .iter()
        .map(|motion| motion.target.pose().map(|pose| pose.position_mm))
        .collect();
    let near = |(found, place): (&Option<Vector3<f64>>, &Option<Vector3<f64>>)| {
        found.is_none()
            || place.is_none_or(|place| {
                found.is_some_and(|found| (found - place).norm() <= kind.place_mm)
            })
    };
    match found.len() == places.len() && found.iter().zip(&places).all(near) {
        true => Ok(()),
        false => Err(format!(
            "divided: {} motions instead of {}, or elsewhere",
            found.len(),
            places.len()
        )),
    }
}

/// A whole random program: it comes back, whole, corrected and divided.
pub fn whole(seed: u64, kind: &Kind) -> Result<(), String> {
    let mut chance = Chance::new(seed);
    let texts = (kind.whole)(&mut chance);
    let at = |what: String| format!("case {seed}: {what}\n{}", texts.concat());
    let files: Vec<Vec<u8>> = texts.iter().map(|text| text.as_bytes().to_vec()).collect();
    let program = read_files(kind, &files).map_err(|errors| at(format!("{errors:?}")))?;
    let same = write(&program, &[], &WriteOptions::default());
    if bytes_of(same.map_err(|error| at(error.to_string()))?) != files {
        return Err(at("bytes changed without pieces".to_owned()));
    }
    let pieces = corrections(&mut chance, &program, kind);
    kind.unless_said(write_and_read(&program, &pieces, kind))
        .map_err(at)?;
    kind.unless_said(divide_and_read(&mut chance, &program, kind))
        .map_err(at)
}

/// One case of the fuzz, a random program, whole or broken: whether it was read.
pub fn case(seed: u64, mut kind: Kind) -> Result<bool, String> {
    if seed.is_multiple_of(4) {
        return whole(seed, &kind).map(|()| true);
    }
    let mut chance = Chance::new(seed);
    let texts = (kind.whole)(&mut chance);
    let break_it = |text: &String| broken(&mut chance, text, &kind);
    let files: Vec<Vec<u8>> = texts.iter().map(break_it).collect();
    let at = |what: String| {
        let text = files.concat();
        format!("case {seed}: {what}\n{}", String::from_utf8_lossy(&text))
    };
    let own = kind.own;
    own(&mut chance, &mut kind, &files).map_err(at)?;
    let found = check(&mut chance, &files, &kind);
    let is_read = *found.as_ref().unwrap_or(&true);
    kind.unless_said(found.map(|_| ())).map_err(at)?;
    Ok(is_read)
}

/// The files of a program, whatever their bytes are: whether they were read.
pub fn check(chance: &mut Chance, files: &[Vec<u8>], kind: &Kind) -> Result<bool, String> {
    let at = |what: &str| what.to_owned();
    let program = match read_files(kind, files) {
        Ok(program) => program,
        Err(errors) => {
            let place =
                |error: &ProgramError| kind.names.iter().position(|name| *name == error.file);
            let fits = |error: &ProgramError| {
                let Some(bytes) = place(error).and_then(|file| files.get(file)) else {
                    return false;
                };
                let lines = bytes.iter().filter(|byte| **byte == b'\n').count() + 1;
                (1..=lines).contains(&error.line) && error.span.end <= bytes.len()
            };
            let ordered = errors.is_sorted_by_key(|error| (place(error), error.line));
            return match !errors.is_empty() && ordered && errors.iter().all(fits) {
                true => Ok(false),
                false => Err(at("an error has no place, or not its place")),
            };
        }
    };
    let same = write(&program, &[], &WriteOptions::default());
    if bytes_of(same.map_err(|error| error.to_string())?) != files {
        return Err(at("bytes changed without pieces"));
    }
    let is_far = |motion: &Motion| {
        motion
            .target
            .pose()
            .is_some_and(|end| end.position_mm.norm() > 9e5)
    };
    if program.motions.iter().any(is_far) {
        // Farther than what is written.
        return Ok(true);
    }
    let pieces = corrections(chance, &program, kind);
    write_and_read(&program, &pieces, kind)?;
    divide_and_read(chance, &program, kind)?;
    Ok(true)
}

/// Half of the third decimal along each axis: times the root of three.
pub const PLACE_MM: f64 = 0.866e-3 + 1e-6;
