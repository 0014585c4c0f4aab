//! State of the walk over a program, its results, and its error reports.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::corner::Cut;
use crate::error::{ProgramError, note};
use crate::model::motion::Motion;
use crate::model::program::{OutsideCall, StatedAxes};
use crate::options::ReadOptions;
use crate::siemens::block::How;
use crate::siemens::expression::Expression;
use crate::siemens::state::{Angles, Code, Coordinate, Feed, NO_SHIFT_MM, State, StatedModes};
use crate::siemens::tokens::Broken;
use crate::siemens::values::Variables;
use crate::text::source::{Finding, SourceFile};
use crate::turned_axis::CountShown;

/// Result of the scan of a program's files.
#[derive(Debug, Default)]
pub(crate) struct Scan {
    pub motions: Vec<Motion>,
    /// Source positions of each motion.
    pub written: Vec<Written>,
    pub findings: Vec<Finding>,
    pub faults: Vec<ProgramError>,
    /// First line of a feed whose way is the control's own.
    pub unjudged_feed_on: Option<usize>,
    /// Calls of subprograms that are in none of the files.
    pub outside_calls: Vec<OutsideCall>,
    /// Rotary axis positions stated by motions.
    pub rotary: StatedAxes,
    /// Evidence in the words for the way in which these axes count.
    pub shown: Vec<CountShown>,
    /// Words of rotary axes in cuts that a setting of the machine takes otherwise.
    pub plain_turns: Vec<PlainTurn>,
    /// Lines of steps that are the first words of their axes behind a frame.
    pub steps_behind_frames: Vec<usize>,
    /// Words RND, CHF and CHR, where corners are followed.
    pub corner_words: Vec<Range<usize>>,
}

/// An angle without AC or DC where it matters how the machine takes it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlainTurn {
    pub line: usize,
    pub letter: char,
    pub to: f64,
    /// Turn in both readings, direct and by the shortest way, deg.
    pub readings: [f64; 2],
}

/// Source positions of a motion, for the writer.
#[derive(Debug, Clone)]
pub(crate) struct Written {
    /// The line without its ending.
    pub line: Range<usize>,
    /// First byte of its words.
    pub words_at: usize,
    /// X, Y, Z of its end; of the point on a CIP.
    pub axes: [Option<Coordinate>; 3],
    pub via: [Option<Coordinate>; 3],
    /// Words of rotary axes, the axis among those that are followed with each.
    pub rotary: Vec<(usize, Coordinate, How)>,
    /// Words that an end elsewhere makes void.
    pub arc_words: Vec<Range<usize>>,
    pub direction_words: Vec<Range<usize>>,
    /// Words that act at the end of the block.
    pub at_end: Vec<Range<usize>>,
    pub code: Code,
    pub code_word: Option<Range<usize>>,
    /// The feed in force, if it is known, as written.
    pub feed: Option<Feed>,
    pub feed_word: Option<(Range<usize>, Option<Range<usize>>)>,
    /// Words that were stated in blocks between the motion before and this one.
    pub stated: StatedModes,
    /// Transformation from the axes of its numbers to those of the part.
    pub frame: Isometry3<f64>,
    pub unit_mm: f64,
    /// Start in the frame's axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    /// The motion is in machine coordinates.
    pub machine: bool,
    /// G91 is in force.
    pub steps: bool,
    /// Axis across the plane: 2 for G17.
    pub normal: usize,
    /// Corner to the next motion, if corners are followed.
    pub corner: Option<(Range<usize>, Cut)>,
}

impl Written {
    /// True for a step that counts from the last word of its axis before a frame, where the writer stated the axis since.
    pub(crate) fn counts_behind_frame(&self, axis: usize, is_stated: bool) -> bool {
        let word = self.axes[axis]
            .as_ref()
            .filter(|word| is_stated && word.step);
        let ends = self.start[axis].zip(self.end[axis]);
        word.zip(ends)
            .is_some_and(|(word, (start, end))| (end - start - word.mm).abs() > NO_SHIFT_MM)
    }
}

/// Treatment of RND, CHF and CHR.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Corners {
    /// Corners are refused: motions end at them.
    Refused,
    /// Corners are noted beside the motions.
    Followed,
}

/// The walk over one file.
pub(crate) struct Reader<'r> {
    pub out: &'r mut Scan,
    pub options: &'r ReadOptions,
    pub frames: &'r BTreeMap<String, Isometry3<f64>>,
    /// All files of the program.
    pub files: &'r [SourceFile],
    pub file: &'r SourceFile,
    pub index: usize,
    pub state: State,
    pub variables: Variables,
    pub changes_by_m6: bool,
    pub corners: Corners,
}

impl Reader<'_> {
    pub(crate) fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        note(&mut self.out.faults, || {
            ProgramError::at(self.file, span.clone(), reason, remedy)
        });
        self.state.lost = true;
    }

    pub(crate) fn broken(&mut self, broken: Broken) {
        self.fault(&broken.span, broken.reason, broken.remedy);
    }

    pub(crate) fn finding(&mut self, span: &Range<usize>, message: String) {
        self.out.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }

    /// The text of a name in capitals.
    pub(crate) fn name(&self, span: &Range<usize>) -> String {
        String::from_utf8_lossy(self.file.part(span)).to_ascii_uppercase()
    }

    /// The first stated number of an expression, or a fault.
    pub(crate) fn number(&mut self, span: &Range<usize>, value: &Expression) -> Option<f64> {
        match self.variables.number(self.file.bytes(), value) {
            Ok(value) if value.abs() < FARTHEST => Some(value),
            Ok(_) => {
                self.fault(span, "its value is larger than 10 km", "mend it");
                None
            }
            Err(why) => {
                self.fault(
                    span,
                    why,
                    "give it a value in the program, or state it (--set NAME=VALUE)",
                );
                None
            }
        }
    }

    /// The direction into which angles turn Z.
    pub(crate) fn turned(&self, angles: [f64; 3]) -> Option<Vector3<f64>> {
        use nalgebra::UnitQuaternion as Q;
        let [a, b, c] = angles.map(f64::to_radians);
        let about = |axis: &nalgebra::Unit<Vector3<f64>>, angle| Q::from_axis_angle(axis, angle);
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let turn = match self.state.angles? {
            Angles::Euler => about(&z, a) * about(&x, b) * about(&z, c),
            Angles::Rpy => about(&z, c) * about(&y, b) * about(&x, a),
        };
        Some(turn * Vector3::z())
    }
}

/// Larger than any number of a program, mm or degrees.
const FARTHEST: f64 = 1e7;
