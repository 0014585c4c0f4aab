//! A made program, read again by the reader of its language, against the path that it was made of.

use kinetostat_program::{Arc, Curve, Path, Program, ReadOptions as GcodeReading, interpret};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::document::read;
use crate::extreme::larger;
use crate::making::MakeError;
use crate::making::limits::MakeLanguage;
use crate::making::step::{MadeMotion, Step, Way};
use crate::making::template::Template;
use crate::model::Language;
use crate::model::motion::{MotionKind, Runs};
use crate::model::target::Target;
use crate::options::ReadOptions;
use crate::text::source::SourceFile;

/// Deviation of a made program, read again, from its path.
///
/// ```
/// use kinetostat_formats::{MakeLanguage, Template, make};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1.2345678 F300\nG1 X10\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let made = make(&path, &[], &Template::default(), MakeLanguage::Csv).unwrap();
/// assert_eq!((made.kept.moves, made.kept.motions), (3, 3));
/// assert!(made.kept.position_mm < 1e-6 && made.kept.speed_relative < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Kept {
    /// Moves of the path that were written.
    pub moves: usize,
    /// Motions that they became.
    pub motions: usize,
    /// Farthest that the end of a motion is from the path, mm.
    pub position_mm: f64,
    /// Farthest that the tool is turned from the path at the end of a motion, rad; of its axis where that alone is written.
    pub orientation_rad: f64,
    /// Farthest that an arc is from that of the path, mm.
    pub arc_mm: f64,
    /// Farthest that a line is from the arc that it follows, mm.
    pub chord_mm: f64,
    /// Largest difference of a speed at feed, relative to it.
    pub speed_relative: f64,
}

/// Shares of a piece at which arcs are compared.
const SHARES: [f64; 5] = [0.1, 0.25, 0.5, 0.75, 0.9];

/// Compares, motion by motion; what is farther than the digits explain is an error.
pub(crate) fn compare(
    path: &Path,
    steps: &[Step],
    again: &[ReadMotion],
    template: &Template,
    language: MakeLanguage,
) -> Result<Kept, MakeError> {
    let made = || steps.iter().filter_map(Step::motion);
    let count = made().count();
    if count != again.len() {
        return Err(broken(format!(
            "it has {} motions, not {count}",
            again.len()
        )));
    }
    let mut kept = Kept::default();
    let mut before: Option<(usize, Vector3<f64>)> = None;
    for (motion, read) in made().zip(again) {
        let is_new = before.is_none_or(|(source, _)| source != motion.source);
        kept.moves += usize::from(is_new);
        kept.motions += 1;
        let joint = motion.way == Way::Joint
            && !matches!(
                language,
                MakeLanguage::Apt | MakeLanguage::Gcode | MakeLanguage::Csv
            );
        if joint != read.is_joint {
            return Err(broken(format!(
                "line {} of the source goes another way",
                motion.line
            )));
        }
        one(
            path,
            motion,
            read,
            before.map(|(_, place)| place),
            &mut kept,
        );
        before = Some((motion.source, read.place));
    }
    within(&kept, made(), template, language)?;
    Ok(kept)
}

fn one(
    path: &Path,
    motion: &MadeMotion,
    read: &ReadMotion,
    before: Option<Vector3<f64>>,
    kept: &mut Kept,
) {
    let source = &path.moves[motion.source];
    let [from, to] = motion.shares;
    kept.position_mm = larger(kept.position_mm, (read.place - source.point(to)).norm());
    let turned = match (read.orientation, read.axis) {
        (Some(read), _) => motion
            .orientation
            .map_or(f64::NAN, |wanted| angle(&read, &wanted)),
        (None, Some(axis)) => axis
            .cross(&motion.axis)
            .norm()
            .atan2(axis.dot(&motion.axis)),
        (None, None) => 0.0,
    };
    kept.orientation_rad = larger(kept.orientation_rad, turned);
    if !motion.rapid && !read.is_joint {
        let apart = read.speed_mm_per_s.map_or(f64::NAN, |speed| {
            (speed / motion.speed_mm_per_s - 1.0).abs()
        });
        kept.speed_relative = larger(kept.speed_relative, apart);
    }
    let (Curve::Arc(_), Some(before), false) = (&source.curve, before, motion.first) else {
        return;
    };
    for share in SHARES {
        let wanted = source.point(from + (to - from) * share);
        let found = match &read.curve {
            Curve::Arc(arc) => arc.point(share),
            Curve::Line => before + (read.place - before) * share,
        };
        let apart = (found - wanted).norm();
        match motion.way {
            Way::Line => {
                // To the chord itself: where on it the tool is at a time, is the speed's affair.
                let along = (read.place - before)
                    .try_normalize(1e-12)
                    .unwrap_or_default();
                let across = (wanted - before) - along * along.dot(&(wanted - before));
                kept.chord_mm = larger(kept.chord_mm, across.norm());
            }
            _ => kept.arc_mm = larger(kept.arc_mm, apart),
        }
    }
}

/// The angle between two orientations, exact for small ones.
fn angle(one: &nalgebra::UnitQuaternion<f64>, other: &nalgebra::UnitQuaternion<f64>) -> f64 {
    let between = one.inverse() * other;
    2.0 * between.imag().norm().atan2(between.scalar().abs())
}

/// Checks that the deviation is explained by the written digits.
fn within<'m>(
    kept: &Kept,
    made: impl Iterator<Item = &'m MadeMotion>,
    template: &Template,
    language: MakeLanguage,
) -> Result<(), MakeError> {
    let half_mm = 0.5 * 10_f64.powi(-(template.position_decimals as i32));
    let size = made.map(|motion| motion.end.amax()).fold(1.0, larger);
    let arithmetic_mm = 1e-9 + 1e-14 * size;
    let position = 1.8 * half_mm + arithmetic_mm;
    let angle = 10_f64.powi(-(template.angle_decimals as i32)).to_radians();
    let quaternion = 2.0 * 10_f64.powi(-(template.quaternion_decimals as i32));
    let orientation = larger(angle, quaternion) + 1e-14;
    let slow = match (language, template.speed_decimals) {
        // Whatever the digits of a speed make of it, is said.
        (MakeLanguage::FanucLs, _) | (_, Some(_)) => f64::INFINITY,
        _ => 1e-6,
    };
    let arc = template.tolerance_mm + 20.0 * half_mm;
    let checks = [
        ("position, mm", kept.position_mm, position),
        ("orientation, rad", kept.orientation_rad, orientation),
        ("arcs, mm", kept.arc_mm, arc),
        (
            "chords, mm",
            kept.chord_mm,
            1.01 * template.tolerance_mm + 4.0 * half_mm,
        ),
        ("speed, relative", kept.speed_relative, slow),
    ];
    for (what, found, most) in checks {
        // NaN is no agreement.
        let agrees = found <= most;
        if !agrees {
            return Err(broken(format!(
                "{what}: {found:e} apart, {most:e} are the digits'"
            )));
        }
    }
    Ok(())
}

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
