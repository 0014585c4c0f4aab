//! Motions that cannot stand in one path, and all faults of a program in one run, by line.

use thiserror::Error;

use crate::error::ProgramError;
use crate::model::Language;
use crate::model::motion::{FrameUse, Motion, MotionKind};
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::not_evenly;
use crate::options::ReadOptions;
use crate::path::tools::{same_frame, tools_of};
use crate::path::{PathError, fault_at};
use crate::text::source::SourceFile;

/// The motions to poses.
pub(crate) fn motions_to_poses(program: &RobotProgram) -> Vec<&Motion> {
    let motions = program.motions.iter();
    motions
        .filter(|motion| motion.target.pose().is_some())
        .collect()
}

/// True if all motions have the work object of the first one.
pub(crate) fn has_one_work_object(poses: &[&Motion]) -> bool {
    let Some(first) = poses.first() else {
        return true;
    };
    let is_other = |motion: &&Motion| !same_frame(&motion.work_object, &first.work_object);
    !poses.iter().any(is_other)
}

/// All that keeps motions out of one path, in order of files and lines. It holds for programs of which a part was refused, too.
pub(crate) fn faults_of_motions(program: &RobotProgram) -> Vec<PathError> {
    let poses = motions_to_poses(program);
    let mut faults = Vec::new();
    faults.extend(in_another_file(program));
    faults.extend(another_tool(program, &poses));
    faults.extend(unknown_work_objects(program, &poses));
    faults.extend(no_speeds(program, &poses));
    faults.extend(program.motions.iter().filter_map(|motion| {
        let (reason, remedy) = too_far(motion)?;
        Some(fault_at(program, motion, reason, remedy))
    }));
    faults.extend(closed_circles(program));
    faults.extend(turning_otherwise(program));
    in_order(program, faults)
}

fn in_order(program: &RobotProgram, mut faults: Vec<PathError>) -> Vec<PathError> {
    let place = |fault: &PathError| {
        let files = &mut program.files.iter();
        let file = files.position(|file| file.name() == fault.file);
        (file, fault.line)
    };
    faults.sort_by_key(place);
    faults
}

fn in_another_file(program: &RobotProgram) -> Option<PathError> {
    let file = program.motions.first()?.file;
    let other = program.motions.iter().find(|motion| motion.file != file)?;
    let reason = format!(
        "motions stand in this file and in {}",
        program.files[file].name()
    );
    let remedy = "run the program once and write it flat (--expand), or give the files with motions one by one";
    Some(fault_at(program, other, reason, remedy))
}

fn another_tool(program: &RobotProgram, poses: &[&Motion]) -> Option<PathError> {
    let tools = tools_of(poses);
    let other = tools.get(1)?;
    if poses.windows(2).all(|pair| pair[0].line <= pair[1].line) {
        return None;
    }
    let name = |frame: &FrameUse| frame.name == other.name;
    let motion = poses.iter().find(|motion| name(&motion.tool))?;
    let reason = format!(
        "the tool `{}` is another one, in a program whose routines do not run in the order of their lines",
        other.name
    );
    let remedy = "write one program for each tool, or the routines in their order";
    Some(fault_at(program, motion, reason, remedy))
}

fn unknown_work_objects(program: &RobotProgram, poses: &[&Motion]) -> Vec<PathError> {
    if has_one_work_object(poses) {
        return Vec::new();
    }
    let unknown = poses
        .iter()
        .filter(|motion| motion.work_object.known().is_none());
    let fault = |motion: &&Motion| {
        let reason = format!(
            "the work object `{}` is not known, and the program has another one",
            motion.work_object.name
        );
        fault_at(program, motion, reason, "state where it is (`frames`)")
    };
    unknown.map(fault).collect()
}

fn no_speeds(program: &RobotProgram, poses: &[&Motion]) -> Vec<PathError> {
    let fault = |motion: &&Motion| {
        let is_none = |speed: &f64| !(*speed > 0.0 && speed.is_finite());
        let speed = motion.speed.mm_per_s.filter(is_none)?;
        let reason = format!("its speed is {speed} mm/s");
        Some(fault_at(
            program,
            motion,
            reason,
            "write a speed above zero",
        ))
    };
    poses.iter().filter_map(fault).collect()
}

fn closed_circles(program: &RobotProgram) -> Vec<PathError> {
    let fault = |(index, pair): (usize, &[Motion])| {
        let [from, to] = [&pair[0], &pair[1]].map(|motion| motion.target.pose());
        let way = to?.position_mm - from?.position_mm;
        let is_circle = matches!(pair[1].kind, MotionKind::Circular { .. });
        let is_closed = is_circle && pair[1].follows == Some(index) && way.norm() < 1e-6;
        is_closed.then(|| {
            fault_at(
                program,
                &pair[1],
                "a circle through a place that ends where it begins is no circle".to_owned(),
                "write a full turn as two circular motions",
            )
        })
    };
    (program.motions.windows(2).enumerate())
        .filter_map(fault)
        .collect()
}

/// Coordinates beyond this are no machine's, as in G-code, mm.
const FARTHEST_MM: f64 = 1e6;

/// Reason and remedy of a motion to an implausibly distant point; `None` if it is near enough.
fn too_far(motion: &Motion) -> Option<(String, &'static str)> {
    let value = farthest_mm(motion).filter(|value| value.is_nan() || value.abs() > FARTHEST_MM)?;
    Some((
        format!("it leads to a coordinate of {value:e} mm, farther than any machine reaches"),
        "check the number and the unit of lengths",
    ))
}

/// The largest coordinate of the poses of a motion, mm; one that is no number where there is one.
fn farthest_mm(motion: &Motion) -> Option<f64> {
    let via = match &motion.kind {
        MotionKind::Circular { via } => via.pose(),
        _ => None,
    };
    let places = [motion.target.pose(), via].into_iter().flatten();
    let mut values = places.flat_map(|pose| pose.position_mm.iter().copied());
    let first = values.next()?;
    Some(values.fold(first, |most, value| {
        match value.abs() > most.abs() || value.is_nan() {
            true => value,
            false => most,
        }
    }))
}

/// All motions whose tool turns, and not evenly. Where a motion begins at no known pose it has no way in a path, either.
fn turning_otherwise(program: &RobotProgram) -> Vec<PathError> {
    let fault = |motion: &Motion| {
        let otherwise = motion.site.turns_otherwise?;
        if motion.kind == MotionKind::Joint {
            return None;
        }
        let start = program.motions.get(motion.follows?)?;
        let frames = [start, motion].map(|motion| motion.work_object.known().copied());
        let [from, to] = [start, motion].map(|motion| Some(motion.target.pose()?.isometry()));
        let (from, to) = (from?, to?);
        let turn = match frames {
            [Some(before), Some(here)] => {
                (before.rotation * from.rotation).angle_to(&(here.rotation * to.rotation))
            }
            _ => from.rotation.angle_to(&to.rotation),
        };
        let reason = not_evenly("the tool turns", turn, otherwise)?;
        Some(fault_at(program, motion, reason, otherwise.remedy))
    };
    program.motions.iter().filter_map(fault).collect()
}

/// Error that keeps a program from being corrected.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, all_faults};
///
/// let files = vec![SourceFile::new("part.src", "DEF part()\nLIN NOWHERE\nEND\n")];
/// let faults = all_faults(Language::Krl, files, &ReadOptions::default());
/// assert_eq!(faults[0].place(), ("part.src", 2));
/// assert!(faults[0].reason().contains("NOWHERE"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ProgramFault {
    /// Something in its text is refused.
    #[error(transparent)]
    Text(#[from] ProgramError),
    /// A motion cannot stand in one path with the others.
    #[error(transparent)]
    Path(#[from] PathError),
}

impl ProgramFault {
    /// Name of the file, and line counted from 1.
    #[must_use]
    pub fn place(&self) -> (&str, usize) {
        match self {
            Self::Text(error) => (&error.file, error.line),
            Self::Path(error) => (&error.file, error.line),
        }
    }

    /// Reason for the refusal.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self {
            Self::Text(error) => &error.reason,
            Self::Path(error) => &error.reason,
        }
    }
}

/// All that [`crate::read`] refuses, and with it what [`crate::path_of`] would refuse of the motions that could be read, in order of
/// files and lines.
///
/// The motions beside the faults are looked at, too.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, all_faults};
///
/// let text = "DEF part()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0\n\
///     LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN XNOWHERE\nEND\n";
/// let files = vec![SourceFile::new("part.src", text)];
/// let faults = all_faults(Language::Krl, files, &ReadOptions::default());
/// assert_eq!(faults.iter().map(|fault| fault.place().1).collect::<Vec<_>>(), [5, 6]);
/// assert_eq!(faults[0].reason(), "its speed is 0 mm/s");
/// assert!(faults[1].reason().contains("XNOWHERE"));
/// ```
#[must_use]
pub fn all_faults(
    language: Language,
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Vec<ProgramFault> {
    let names: Vec<String> = files.iter().map(|file| file.name().to_owned()).collect();
    let Parsed { program, faults } = language.parse(files, options);
    let of_path = faults_of_motions(&program);
    let of_text = faults.into_iter().map(ProgramFault::from);
    let mut all: Vec<ProgramFault> = of_text
        .chain(of_path.into_iter().map(ProgramFault::from))
        .collect();
    let place = |fault: &ProgramFault| {
        let (file, line) = fault.place();
        (names.iter().position(|name| name == file), line)
    };
    all.sort_by_cached_key(place);
    all
}
