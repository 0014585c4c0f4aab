//! Modal state between two motions.

use std::ops::Range;

use kinetostat_program::Spindle;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::apt::arc::Circle;
use crate::apt::lines::Statement;
use crate::apt::numbers::{Argument, arguments_of};
use crate::model::motion::Speed;
use crate::text::source::SourceFile;

/// Modal state.
#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    /// Tool position, mm; `None` if unknown.
    pub place: Option<Vector3<f64>>,
    /// Tool axis.
    pub axis: Vector3<f64>,
    /// The motion that led there.
    pub last: Option<usize>,
    pub feed: Speed,
    /// The feed counts by turns of the spindle, mm in one.
    pub mm_per_turn: Option<f64>,
    pub spindle: Spindle,
    /// Text of a RAPID that waits for its GOTO.
    pub rapid: Option<Range<usize>>,
    /// A CIRCLE that waits for its GOTO.
    pub circle: Option<Circle>,
    pub in_cycle: bool,
    /// MSYS in the part's axes, mm.
    pub system: Option<Isometry3<f64>>,
    pub tool: String,
    /// FINI or END ended the program.
    pub has_ended: bool,
}

impl State {
    /// State at the start of a file.
    pub(crate) fn new() -> Self {
        Self {
            axis: Vector3::z(),
            tool: "TOOL".to_owned(),
            ..Self::default()
        }
    }
}

/// Length of the file's unit in mm where its statements say it; the statements that say another.
pub(crate) fn unit_of(
    file: &SourceFile,
    statements: &[Statement],
) -> (Option<f64>, Vec<Range<usize>>) {
    let (mut unit, mut others) = (None, Vec::new());
    for statement in statements {
        let word = file.part(&statement.word);
        if !word.eq_ignore_ascii_case(b"UNITS") && !word.eq_ignore_ascii_case(b"UNIT") {
            continue;
        }
        let named = file
            .part(&statement.arguments)
            .trim_ascii()
            .to_ascii_uppercase();
        let found = match named.as_slice() {
            b"MM" => Some(1.0),
            b"CM" => Some(10.0),
            b"INCH" | b"INCHES" | b"IN" => Some(25.4),
            _ => None,
        };
        match (unit, found) {
            (_, None) => others.push(statement.span.clone()),
            (Some(before), Some(now)) if before != now => others.push(statement.span.clone()),
            (_, Some(_)) => unit = found,
        }
    }
    (unit, others)
}

/// The speed of a FEDRAT in a unit of so many mm, and where it counts by turns of the spindle, the way in one, mm; none where its text
/// is not a feed.
pub(crate) fn feed_of(
    file: &SourceFile,
    statement: &Statement,
    unit_mm: f64,
) -> Option<(Speed, Option<f64>)> {
    let arguments = arguments_of(file.bytes(), &statement.arguments);
    let mut value = None;
    let (mut per_minute, mut per_turn) = (Some(unit_mm), None);
    for argument in &arguments {
        match argument {
            Argument::Number(number) => value = value.or(Some(number.value)),
            Argument::Word(word) => match file.part(word).to_ascii_uppercase().as_slice() {
                b"MMPM" => per_minute = Some(1.0),
                b"IPM" => per_minute = Some(25.4),
                b"MMPR" => (per_minute, per_turn) = (None, Some(1.0)),
                b"IPR" => (per_minute, per_turn) = (None, Some(25.4)),
                b"PERREV" | b"FPR" => (per_minute, per_turn) = (None, Some(unit_mm)),
                b"PERMIN" | b"FPM" | b"" => {}
                // Inverse-time feed, or set at the controller.
                _ => per_minute = None,
            },
        }
    }
    let text = String::from_utf8_lossy(file.part(&statement.span)).into_owned();
    (!arguments.is_empty()).then(|| {
        let mm_per_s = per_minute.and_then(|mm| Some(value? * mm / 60.0));
        let mm_per_turn = per_turn.and_then(|mm| Some(value? * mm));
        (Speed { mm_per_s, text }, mm_per_turn)
    })
}

/// The system of MSYS: origin, X axis, Y axis.
pub(crate) fn system_of(numbers: &[f64], unit_mm: f64) -> Option<Isometry3<f64>> {
    let &[ox, oy, oz, xx, xy, xz, yx, yy, yz] = numbers else {
        return None;
    };
    let (x, y) = (Vector3::new(xx, xy, xz), Vector3::new(yx, yy, yz));
    let square =
        (x.norm() - 1.0).abs() < 1e-4 && (y.norm() - 1.0).abs() < 1e-4 && x.dot(&y).abs() < 1e-4;
    square.then(|| {
        let x = x.normalize();
        let z = x.cross(&y).normalize();
        let matrix = Matrix3::from_columns(&[x, z.cross(&x), z]);
        let rotation = Rotation3::from_matrix_unchecked(matrix);
        Isometry3::from_parts(
            Translation3::from(Vector3::new(ox, oy, oz) * unit_mm),
            UnitQuaternion::from_rotation_matrix(&rotation),
        )
    })
}
