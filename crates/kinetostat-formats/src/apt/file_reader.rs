//! State while a file is read, the arguments of its statements, and the text positions of coordinates.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::apt::lines::{Statement, all_numbers, arguments_of};
use crate::apt::state::State;
use crate::apt::table::Dialect;
use crate::error::ProgramError;
use crate::model::motion::{Frame, FrameUse, Motion};
use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::options::ReadOptions;
use crate::text::number::{NumberText, Width, in_words};
use crate::text::source::{Finding, SourceFile};

/// Results of all files so far.
pub(crate) struct Found<'o> {
    pub options: &'o ReadOptions,
    pub frames: Frames,
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    pub motions: Vec<Motion>,
}

/// Reads the statements of a file.
pub(crate) struct Reader<'r, 'o> {
    pub program: &'r mut Found<'o>,
    pub file: &'r SourceFile,
    pub index: usize,
    pub dialect: Dialect,
    pub unit_mm: f64,
    pub state: State,
}

pub(crate) const POINTS: &str = "let the CAM system write points: GOTO/x,y,z or GOTO/x,y,z,i,j,k";
pub(crate) const HOLES: &str = "let the holes be written as motions (--expand), leave them as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or let the CAM system write points";
pub(crate) const LEAVE: &str = "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or let the CAM system write points";

impl Reader<'_, '_> {
    pub fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &'static str) {
        let fault = ProgramError::at(self.file, span.clone(), reason, remedy);
        self.program.faults.push(fault);
    }

    pub fn finding(&mut self, span: &Range<usize>, message: String) {
        self.program.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }

    /// Names statements whose text goes to the controller as it stands, in one finding.
    pub fn raw_text(&mut self, statements: &[Statement]) {
        let is_raw = |statement: &&Statement| {
            self.file
                .part(&statement.word)
                .eq_ignore_ascii_case(b"INSERT")
        };
        let raw: Vec<&Statement> = statements.iter().filter(is_raw).collect();
        let Some(first) = raw.first() else {
            return;
        };
        let lines: Vec<usize> = raw
            .iter()
            .map(|statement| self.file.line_of(statement.span.start))
            .collect();
        let further = match lines.len() {
            1 => String::new(),
            _ => format!(" ({})", in_words(&lines)),
        };
        let span = first.span.clone();
        self.finding(
            &span,
            format!("INSERT gives its text to the controller as it stands, and it is not looked at: check that it moves neither the tool nor the coordinates{further}"),
        );
    }

    pub fn first_word(&self, statement: &Statement) -> Vec<u8> {
        let text = self.file.part(&statement.arguments);
        let first = text.split(|byte| *byte == b',').next().unwrap_or_default();
        first.trim_ascii().to_ascii_uppercase()
    }

    pub fn numbers(&self, statement: &Statement) -> Option<Vec<NumberText>> {
        all_numbers(&arguments_of(self.file.bytes(), &statement.arguments))
    }

    pub fn axis(&mut self, span: &Range<usize>, numbers: &[NumberText]) {
        let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        match OrientationText::Axis.rotation_of(&values) {
            Some(_) => self.state.axis = Vector3::from_row_slice(&values),
            None => self.fault(span, "the tool's axis has not the length 1", "mend it"),
        }
    }

    /// Places and, where stated, the axis: three or six numbers.
    pub fn pose(&mut self, statement: &Statement) -> Option<(Vec<NumberText>, Vector3<f64>)> {
        let span = &statement.span;
        match self.numbers(statement) {
            Some(numbers) if matches!(numbers.len(), 3 | 6) => {
                if numbers.len() == 6 {
                    self.axis(span, &numbers[3..]);
                }
                let place = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
                Some((numbers, place))
            }
            Some(numbers) => {
                let reason = format!("a place has 3 or 6 numbers, here are {}", numbers.len());
                self.fault(span, reason, POINTS);
                None
            }
            None => {
                self.fault(span, "a place is stated by other than numbers", POINTS);
                None
            }
        }
    }
}

/// The numbers of a place; `old` where they do not say the place itself.
pub(crate) fn pose_text(file: usize, numbers: Vec<NumberText>, old: Option<f64>) -> PoseText {
    let whole = numbers[0].span.start..numbers[numbers.len() - 1].span.end;
    let mut numbers = numbers.into_iter();
    let mut number = || {
        let mut number = numbers.next().unwrap_or(NumberText {
            span: 0..0,
            value: 0.0,
        });
        if let Some(old) = old {
            number.value = old;
        }
        number
    };
    let position = [number(), number(), number()];
    let orientation: Vec<NumberText> = numbers.collect();
    PoseText {
        file,
        whole,
        position,
        unit_mm: 1.0,
        convention: match orientation.is_empty() {
            true => OrientationText::Unstated,
            false => OrientationText::Axis,
        },
        orientation,
        external: Vec::new(),
        width: Width::Kept,
    }
}

/// The caller's frames by names in capitals.
pub(crate) type Frames = BTreeMap<String, Isometry3<f64>>;

/// A tool or the part by its name.
pub(crate) fn frame_use(frames: &Frames, name: &str) -> FrameUse {
    FrameUse::stated(name, frames.get(&name.to_ascii_uppercase()), "the file")
}

/// The axes of the places: MSYS in the part's, or the part's.
pub(crate) fn work_object(frames: &Frames, system: Option<&Isometry3<f64>>) -> FrameUse {
    let part = frame_use(frames, "PART");
    match (system, part.known()) {
        (None, _) => part,
        (Some(system), Some(part)) => FrameUse {
            name: "MSYS".to_owned(),
            frame: Frame::Known(part * system),
        },
        // Coordinate systems without a known part are identified by their pose in it.
        (Some(system), None) if *system == Isometry3::identity() => part,
        (Some(system), None) => {
            let (at, turn) = (system.translation.vector, system.rotation.scaled_axis());
            FrameUse {
                name: format!(
                    "MSYS at {:.4} {:.4} {:.4} turned by {:.6} {:.6} {:.6} rad",
                    at.x, at.y, at.z, turn.x, turn.y, turn.z
                ),
                ..part
            }
        }
    }
}
