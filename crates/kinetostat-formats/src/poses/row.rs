//! A pose of a list, before and with its length unit.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::model::orientation::OrientationText;
use crate::options::LengthUnit;
use crate::poses::cells::number_of;
use crate::poses::layout::Layout;
use crate::text::number::NumberText;
use crate::text::source::SourceFile;

/// Target of a row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RowTarget {
    Pose {
        /// Numbers in the unit of the text.
        position: [NumberText; 3],
        orientation: Vec<NumberText>,
        convention: OrientationText,
    },
    /// Joint values, with their unit in degrees or mm.
    Joints(Vec<(NumberText, f64)>),
}

/// A pose of a list.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// All of it, as it is written a second time for a pose before it.
    pub span: Range<usize>,
    pub target: RowTarget,
    /// The pose is reached in air, by a joint motion.
    pub rapid: bool,
    /// Position of the speed in the text, its value in mm/s, and true if it can be replaced there.
    pub speed: Option<(Range<usize>, f64, bool)>,
    pub tool: String,
    pub frame: String,
    pub external: Vec<Option<NumberText>>,
    /// Reason why no pose can be inserted before the row.
    pub indivisible: Option<&'static str>,
}

/// Content of a file: its rows and their faults.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    pub rows: Vec<Row>,
    pub faults: Vec<ProgramError>,
    /// Place and words.
    pub findings: Vec<(usize, String)>,
}

impl Rows {
    pub(crate) fn fault(
        &mut self,
        file: &SourceFile,
        span: &Range<usize>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        note(&mut self.faults, || {
            ProgramError::at(file, span.clone(), reason, remedy)
        });
    }
}

/// Names of frames where none is stated.
pub(crate) const TOOL: &str = "tool";
pub(crate) const PART: &str = "part";

/// Context for the cells of a row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RowContext<'c> {
    pub layout: &'c Layout,
    pub span: Range<usize>,
    /// The first one of its raster.
    pub first: bool,
    /// Frame of rows that state none.
    pub frame: &'c str,
    pub indivisible: Option<&'static str>,
}

/// Largest angle: of larger ones the digits behind the point are lost.
const MOST_DEG: f64 = 36_000.0;

const NUMBER: &str = "write a finite number with a decimal point";

/// Reads the cells of a row; none where one is refused.
pub(crate) fn row_of(
    file: &SourceFile,
    context: RowContext<'_>,
    cells: &[Range<usize>],
    rows: &mut Rows,
) -> Option<Row> {
    let layout = context.layout;
    let before = rows.faults.len();
    let mut number = |cell: usize| {
        let span = cells.get(cell)?;
        let found = number_of(file.bytes(), span);
        if found.is_none() {
            let shown = shown(file, span, &context.span);
            rows.fault(file, &shown, "it is no number", NUMBER);
        }
        found
    };
    let target = match layout.position {
        Some(position) => {
            let position = position.map(&mut number);
            let turned = layout.orientation.iter().map(|cell| number(*cell));
            let orientation: Vec<Option<NumberText>> = turned.collect();
            pose(file, layout, position, orientation, rows)
        }
        None => {
            let found: Vec<Option<(NumberText, f64)>> = (layout.joints.iter())
                .map(|(cell, unit)| Some((number(*cell)?, *unit)))
                .collect();
            let all: Option<Vec<(NumberText, f64)>> = found.into_iter().collect();
            all.map(RowTarget::Joints)
        }
    };
    let external = layout.external.iter().map(|cell| {
        let span = cells.get(*cell)?;
        match file.part(span) {
            b"" | b"9E9" | b"9e9" | b"9E+09" => None,
            _ => {
                let found = number_of(file.bytes(), span);
                if found.is_none() {
                    rows.fault(file, span, "it is no number", NUMBER);
                }
                found
            }
        }
    });
    let external = external.collect();
    let text = |cell: Option<usize>, or: &str| match cell.and_then(|cell| cells.get(cell)) {
        Some(span) if !span.is_empty() => name_of(file.part(span)),
        _ => or.to_owned(),
    };
    let (tool, frame) = (text(layout.tool, TOOL), text(layout.frame, context.frame));
    let rapid = rapid(file, layout, cells, rows).unwrap_or(context.first);
    let speed = speed(file, layout, cells, rows);
    let whole = rows.faults.len() == before;
    target.filter(|_| whole).map(|target| Row {
        span: context.span,
        target,
        rapid,
        speed,
        tool,
        frame,
        external,
        indivisible: context.indivisible,
    })
}

/// Span that is reported for a cell: an empty cell reports its row.
fn shown(file: &SourceFile, cell: &Range<usize>, row: &Range<usize>) -> Range<usize> {
    match file.part(cell).is_empty() {
        true => row.clone(),
        false => cell.clone(),
    }
}

/// A name without the quotes of YAML.
fn name_of(text: &[u8]) -> String {
    let bare = |quote: u8| {
        let text = text.strip_prefix(&[quote])?;
        text.strip_suffix(&[quote])
    };
    let text = bare(b'"').or_else(|| bare(b'\'')).unwrap_or(text);
    String::from_utf8_lossy(text).into_owned()
}

fn pose(
    file: &SourceFile,
    layout: &Layout,
    position: [Option<NumberText>; 3],
    orientation: Vec<Option<NumberText>>,
    rows: &mut Rows,
) -> Option<RowTarget> {
    let [Some(x), Some(y), Some(z)] = position else {
        return None;
    };
    let orientation: Vec<NumberText> = orientation.into_iter().collect::<Option<_>>()?;
    let convention = layout.convention.unwrap_or(OrientationText::Unstated);
    let values: Vec<f64> = orientation.iter().map(|number| number.value).collect();
    let angles = matches!(convention, OrientationText::Wpr | OrientationText::Abc);
    let far = |number: &&NumberText| number.value.abs() > MOST_DEG;
    if let Some(angle) = orientation.iter().find(far).filter(|_| angles) {
        let reason = "the angle is more than a hundred turns";
        rows.fault(file, &angle.span, reason, "write it within half a turn");
        return None;
    }
    if convention.rotation_of(&values).is_none() {
        let length = values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let (first, last) = (orientation.first()?, orientation.last()?);
        let start = first.span.start.min(last.span.start);
        let what = match convention {
            OrientationText::Quaternion => "the quaternion",
            _ => "the tool's axis",
        };
        let reason = format!("{what} has the length {length:.6} instead of 1 (within 0.001)");
        rows.fault(
            file,
            &(start..first.span.end.max(last.span.end)),
            reason,
            "write it with length 1, and with more digits",
        );
        return None;
    }
    Some(RowTarget::Pose {
        position: [x, y, z],
        orientation,
        convention,
    })
}

fn rapid(
    file: &SourceFile,
    layout: &Layout,
    cells: &[Range<usize>],
    rows: &mut Rows,
) -> Option<bool> {
    let span = cells.get(layout.rapid?)?;
    match file.part(span).to_ascii_lowercase().as_slice() {
        b"1" | b"true" => Some(true),
        b"0" | b"false" => Some(false),
        _ => {
            let reason = "whether the pose is reached in air is neither 0 nor 1";
            rows.fault(
                file,
                span,
                reason,
                "write 1 for a motion in air, 0 for one at feed",
            );
            None
        }
    }
}

fn speed(
    file: &SourceFile,
    layout: &Layout,
    cells: &[Range<usize>],
    rows: &mut Rows,
) -> Option<(Range<usize>, f64, bool)> {
    let (cell, factor) = layout.speed?;
    let span = cells.get(cell)?;
    if span.is_empty() {
        return None;
    }
    let Some(number) = number_of(file.bytes(), span) else {
        rows.fault(file, span, "it is no number", NUMBER);
        return None;
    };
    Some((span.clone(), number.value * factor, factor == 1.0))
}

/// Length of the unit in mm.
pub(crate) fn mm_of(unit: LengthUnit) -> f64 {
    match unit {
        LengthUnit::Millimetre => 1.0,
        LengthUnit::Metre => 1000.0,
    }
}

/// Farthest coordinate of a program in metres that is not warned of, m: arms on tracks reach no further.
const FAR_M: f64 = 20.0;

/// Largest coordinate of a program in millimetres that looks like metres, mm.
const NEAR_MM: f64 = 2.0;

/// Extents of a path of ROS messages that are taken for metres where no unit is stated, m.
const EXTENTS_M: std::ops::RangeInclusive<f64> = 0.02..=5.0;

/// Extent of the positions of a list.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reach {
    /// Largest absolute coordinate.
    pub farthest: f64,
    /// Largest difference of two coordinates of one axis.
    pub extent: f64,
    /// Places.
    pub count: usize,
}

impl Reach {
    pub(crate) fn of(rows: &[Row]) -> Self {
        let mut reach = Self::default();
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        for row in rows {
            let RowTarget::Pose { position, .. } = &row.target else {
                continue;
            };
            reach.count += 1;
            for (axis, number) in position.iter().enumerate() {
                // Numbers that are read are finite.
                let value = number.value;
                if value.abs() > reach.farthest {
                    reach.farthest = value.abs();
                }
                if value < least[axis] {
                    least[axis] = value;
                }
                if value > most[axis] {
                    most[axis] = value;
                }
            }
        }
        for (least, most) in least.iter().zip(most) {
            // Without positions the difference is not above zero.
            if most - least > reach.extent {
                reach.extent = most - least;
            }
        }
        reach
    }

    /// Reason why a stated unit is implausible.
    pub(crate) fn doubt(&self, unit: LengthUnit) -> Option<String> {
        match unit {
            LengthUnit::Metre if self.farthest > FAR_M => Some(format!(
                "the places are stated in m and reach {:.1} m from the origin: are they mm?",
                self.farthest
            )),
            LengthUnit::Millimetre if self.count > 1 && self.farthest < NEAR_MM => Some(format!(
                "the places are stated in mm and reach {:.3} mm from the origin: are they metres?",
                self.farthest
            )),
            _ => None,
        }
    }

    /// True if positions of ROS messages, which are in metres by definition, have the size of metres.
    pub(crate) fn looks_like_metres(&self) -> bool {
        EXTENTS_M.contains(&self.extent) && self.farthest <= FAR_M
    }
}
