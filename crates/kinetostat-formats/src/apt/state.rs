//! Modal state between two motions: spindle rotation, and the arc to the next place.

use std::ops::Range;

use kinetostat_program::{
    NearlyClosed, SpeedMode, Spindle, SpindleChange, SpindleRotation, angle_about,
};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::apt::lines::{Argument, Statement, arguments_of, statements_of};
use crate::apt::table::Dialect;
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

// Spindle rotation from `SPINDL`: `SPINDL/3500,RPM,CLW`, `SPINDL/RPM,3500,CCLW`, `SPINDL/ON`, `SPINDL/OFF`.

/// Spindle state after a statement `SPINDL`. A number without a unit is in rpm, and the sense is clockwise if none is stated; a surface speed (`SFM`,
/// `SMM`) gives no rpm without the tool's diameter.
pub(crate) fn spindle_of(file: &SourceFile, statement: &Statement, before: Spindle) -> Spindle {
    let mut spindle = before;
    let mut sense = None;
    let mut turns = None;
    let mut is_speed = true;
    for argument in arguments_of(file.bytes(), &statement.arguments) {
        match argument {
            Argument::Number(number) if is_speed => {
                turns = turns.or(Some(number.value));
            }
            Argument::Number(_) => is_speed = true,
            Argument::Word(word) => match file.part(&word).to_ascii_uppercase().as_slice() {
                b"CLW" | b"CLWX" => sense = Some(SpindleRotation::Clockwise),
                b"CCLW" => sense = Some(SpindleRotation::CounterClockwise),
                b"OFF" | b"LOCK" | b"ORIENT" | b"NEUTRL" => sense = Some(SpindleRotation::Stopped),
                b"SFM" | b"SMM" | b"CSS" => turns = Some(f64::NAN),
                // The number behind them is another one.
                b"RANGE" | b"MAXRPM" | b"RADIUS" | b"ZRANGE" => is_speed = false,
                _ => {}
            },
        }
    }
    spindle.mode = SpeedMode::Constant;
    if let Some(rpm) = turns {
        spindle.speed = Some(rpm).filter(|rpm| rpm.is_finite() && *rpm > 0.0);
    }
    spindle.rotation = match (sense, before.rotation) {
        (Some(sense), _) => sense,
        (None, SpindleRotation::Stopped) => SpindleRotation::Clockwise,
        (None, turning) => turning,
    };
    spindle
}

/// Changes of the spindle rotation, in the order of the lines.
pub(crate) fn spindle_changes(file: &SourceFile) -> Vec<SpindleChange> {
    let mut changes: Vec<SpindleChange> = Vec::new();
    let mut spindle = Spindle::default();
    for statement in statements_of(file.bytes()) {
        let is_spindle = file.part(&statement.word).eq_ignore_ascii_case(b"SPINDL");
        if is_spindle && !statement.assigns {
            spindle = spindle_of(file, &statement, spindle);
            changes.push(SpindleChange {
                line: file.line_of(statement.span.start),
                spindle,
            });
        }
    }
    changes
}

/// `CIRCLE` as it was read, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Circle {
    /// Lines of the circle.
    pub lines: Range<usize>,
    pub span: Range<usize>,
    pub centre_mm: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub radius_mm: Option<f64>,
    /// The circle has several turns (TIMES).
    pub times: bool,
    /// Sense about the axis.
    pub sense: f64,
}

/// Farthest that written radii differ, mm; 0.0001 in the files seen.
const RADIUS_TOLERANCE_MM: f64 = 0.01;
/// Radii smaller than this are none.
const SAME_MM: f64 = 1e-4;

impl Circle {
    /// Circle of a statement, in a unit of so many mm.
    ///
    /// # Errors
    /// Reason why its arc is unknown.
    pub(crate) fn of(
        file: &SourceFile,
        statement: &Statement,
        dialect: Dialect,
        unit_mm: f64,
    ) -> Result<Self, &'static str> {
        let arguments = arguments_of(file.bytes(), &statement.arguments);
        let numbers = arguments.iter().map_while(Argument::number);
        let values: Vec<f64> = numbers.map(|number| number.value).collect();
        let sense = dialect.sense().ok_or(
            "in which sense the arc goes about its axis, is not known of this kind of file",
        )?;
        let axis = values.get(3..6).map(Vector3::from_row_slice);
        let axis = axis.filter(|axis| (axis.norm() - 1.0).abs() < 1e-3);
        let axis = axis.ok_or("the circle is not a centre and an axis of length 1")?;
        Ok(Self {
            lines: statement.lines.clone(),
            span: statement.span.clone(),
            centre_mm: Vector3::from_row_slice(&values[..3]) * unit_mm,
            axis: axis.normalize(),
            radius_mm: values.get(6).map(|radius| radius.abs() * unit_mm),
            times: arguments.len() > values.len(),
            sense,
        })
    }

    /// The angle by which the tool goes around the axis from a place to another, right-handed, rad. The words of the places have such
    /// a last digit.
    ///
    /// # Errors
    /// Where the places lie on no circle about the centre, or it is not sure whether that is a full one; what to do.
    pub(crate) fn angle(
        &self,
        from: &Vector3<f64>,
        to: &Vector3<f64>,
        digit_mm: f64,
    ) -> Result<f64, (String, &'static str)> {
        let across = |place: &Vector3<f64>| {
            let arm = place - self.centre_mm;
            arm - self.axis * arm.dot(&self.axis)
        };
        let (start, end) = (across(from), across(to));
        let (first, last) = (start.norm(), end.norm());
        let stated = self.radius_mm.unwrap_or(first);
        let differ = |one: f64, other: f64| {
            (one - other).abs() > RADIUS_TOLERANCE_MM || !one.is_finite() || !other.is_finite()
        };
        if differ(first, last) || differ(first, stated) || first < SAME_MM {
            let stated = match self.radius_mm {
                Some(radius) => format!(", and {radius:.4} is stated"),
                None => String::new(),
            };
            return Err((
                format!(
                    "the circle has radius {first:.4} at its start and {last:.4} at its end{stated}"
                ),
                "let the CAM system write it again",
            ));
        }
        let outwards = start / first;
        let aside = self.axis.cross(&outwards);
        let arms = [start, end].map(|arm| [arm.dot(&outwards), arm.dot(&aside)]);
        let angle = angle_about(arms[0], arms[1], self.sense, digit_mm)
            .map_err(|nearly| (nearly.to_string(), NearlyClosed::REMEDY))?;
        Ok(self.sense * angle)
    }
}
