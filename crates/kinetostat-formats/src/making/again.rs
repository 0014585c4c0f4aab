//! Check of a made program by the reader of its language.

use kinetostat_program::{Arc, Curve, Program, ReadOptions as GcodeReading, interpret};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::document::read;
use crate::making::fault::MakeError;
use crate::making::limits::MakeLanguage;
use crate::model::language::Language;
use crate::model::motion::{MotionKind, Runs};
use crate::model::target::Target;
use crate::options::ReadOptions;
use crate::text::source::SourceFile;

/// A motion as it was read again.
pub(crate) struct ReadMotion {
    /// Line of the made program, counted through its files.
    pub line: usize,
    pub place: Vector3<f64>,
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Direction of the tool, where that alone is stated.
    pub axis: Option<Vector3<f64>>,
    pub curve: Curve,
    pub is_joint: bool,
    pub speed_mm_per_s: Option<f64>,
}

/// The motions of a made program; those to joint values are left out.
pub(crate) fn read_again(
    files: &[(String, Vec<u8>)],
    language: MakeLanguage,
) -> Result<Vec<ReadMotion>, MakeError> {
    match (language, language.language()) {
        (MakeLanguage::Csv, _) => of_table(files),
        (_, Some(language)) => of_robot(files, language),
        (_, None) => of_gcode(files),
    }
}

/// A made program that is not what was to be made.
pub(crate) fn broken(what: impl Into<String>) -> MakeError {
    MakeError::of(
        format!(
            "the made program, read again, is not the path that it was made of: {}",
            what.into()
        ),
        "nothing was written, please report this",
    )
}

fn of_robot(files: &[(String, Vec<u8>)], language: Language) -> Result<Vec<ReadMotion>, MakeError> {
    let sources = files
        .iter()
        .map(|(name, bytes)| SourceFile::new(name.clone(), bytes.clone()));
    let program = read(language, sources.collect(), &ReadOptions::default())
        .map_err(|faults| broken(faults.first().map(ToString::to_string).unwrap_or_default()))?;
    let lines = files
        .iter()
        .map(|(_, bytes)| bytes.split_inclusive(|byte| *byte == b'\n').count());
    let ends = lines.scan(0, |end, lines| {
        *end += lines;
        Some(*end)
    });
    let starts: Vec<usize> = std::iter::once(0).chain(ends).collect();
    let mut motions = Vec::with_capacity(program.motions.len());
    let mut before: Option<Vector3<f64>> = None;
    for (index, motion) in program.motions.iter().enumerate() {
        let pose = match &motion.target {
            Target::Pose(pose) => pose,
            Target::Joints { .. } if index == 0 => continue,
            _ => {
                return Err(broken(format!(
                    "line {} of {} goes nowhere",
                    motion.line,
                    program.files[motion.file].name()
                )));
            }
        };
        if motion.runs != Runs::Once || motion.follows != index.checked_sub(1) {
            return Err(broken(format!(
                "line {} of {} runs in another order",
                motion.line,
                program.files[motion.file].name()
            )));
        }
        let curve = match (&motion.kind, before) {
            (MotionKind::Circular { via }, Some(before)) => {
                let via = via.pose().map_or(before, |via| via.position_mm);
                Arc::through(&before, &via, &pose.position_mm).map_or(Curve::Line, Curve::Arc)
            }
            _ => Curve::Line,
        };
        let by_axis = !language.states_turn();
        motions.push(ReadMotion {
            line: starts[motion.file] + motion.line,
            place: pose.position_mm,
            orientation: (!by_axis).then_some(pose.orientation),
            axis: by_axis.then(|| pose.orientation * Vector3::z()),
            curve,
            is_joint: motion.kind == MotionKind::Joint,
            speed_mm_per_s: motion.speed.mm_per_s,
        });
        before = Some(pose.position_mm);
    }
    Ok(motions)
}

fn of_gcode(files: &[(String, Vec<u8>)]) -> Result<Vec<ReadMotion>, MakeError> {
    let bytes = files
        .first()
        .map(|(_, bytes)| bytes.clone())
        .unwrap_or_default();
    let program = Program::read(bytes).map_err(|fault| broken(fault.to_string()))?;
    let path =
        interpret(&program, &GcodeReading::default()).map_err(|fault| broken(fault.to_string()))?;
    let motion = |m: &kinetostat_program::Move| ReadMotion {
        line: m.line,
        place: m.end,
        orientation: None,
        axis: Some(Vector3::z()),
        curve: m.curve,
        is_joint: false,
        speed_mm_per_s: m.feed_mm_per_minute(f64::NAN).map(|feed| feed / 60.0),
    };
    Ok(path.moves.iter().map(motion).collect())
}

fn of_table(files: &[(String, Vec<u8>)]) -> Result<Vec<ReadMotion>, MakeError> {
    let text = files
        .first()
        .map(|(_, bytes)| String::from_utf8_lossy(bytes))
        .unwrap_or_default();
    let rows = text.lines().enumerate();
    let mut rows = rows.filter(|(_, line)| !line.starts_with('#'));
    let head = rows.next().map_or("", |(_, head)| head);
    let tool = head.split(',').position(|name| name == "tool");
    rows.map(|(index, row)| {
        let cells = row.split(',').enumerate();
        let numbers = cells.filter(|(cell, _)| Some(*cell) != tool);
        let values: Option<Vec<f64>> = numbers.map(|(_, part)| part.parse().ok()).collect();
        let (place, turn, speed) = match values.as_deref() {
            Some(&[x, y, z, speed, _]) => (Vector3::new(x, y, z), None, speed),
            Some(&[x, y, z, w, i, j, k, speed, _]) => (
                Vector3::new(x, y, z),
                Some(Quaternion::new(w, i, j, k)),
                speed,
            ),
            _ => return Err(broken(format!("the row {row}"))),
        };
        Ok(ReadMotion {
            line: index + 1,
            place,
            orientation: turn.map(UnitQuaternion::new_normalize),
            axis: None,
            curve: Curve::Line,
            is_joint: false,
            speed_mm_per_s: Some(speed),
        })
    })
    .collect()
}
