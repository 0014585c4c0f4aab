//! State of the walk over a program, its error reports, and what it found: motions, their programming, corners.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::{Vector2, Vector3};

use crate::apt::file_reader::Frames;
use crate::corner::{Beside, Corner, Cut, Leg};
use crate::error::{ProgramError, note};
use crate::heidenhain::arcs::Plane;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::datum::Datum;
use crate::heidenhain::ends::Shape;
use crate::heidenhain::state::{Aside, Pole, State};
use crate::model::motion::Motion;
use crate::model::program::{AxesStated, OutsideCall};
use crate::options::ReadOptions;
use crate::text::source::{Finding, SourceFile};
use crate::turned_axis::CountShown;

/// The walk over one file.
pub(crate) struct Reader<'r> {
    pub found: &'r mut Found,
    pub options: &'r ReadOptions,
    pub frames: &'r Frames,
    /// All files of the program.
    pub files: &'r [SourceFile],
    pub file: &'r SourceFile,
    pub index: usize,
    pub unit_mm: f64,
    pub state: State,
    pub pole_from: Option<usize>,
    /// See [`PoleThere`].
    pub poles: [usize; 2],
    /// The file may hold rounded corners; the straight block just before; a corner that waits for its second line.
    pub has_corners: bool,
    pub line: Option<Line>,
    pub corner: Option<Pending>,
    /// Words that were remarked on.
    pub remarked: BTreeSet<String>,
}

/// Remedy of repeated or parametric blocks.
pub(crate) const EXPAND: &str = "write the program flat first (--expand)";

pub(crate) const TILTED: &str = "it tilts the plane in which the places are";

pub(crate) const TILTED_REMEDY: &str = "let the CAM system write the places in the axes of the part, with LN blocks (TX, TY, TZ) where the tool leans, or give each plane as a program of its own";

pub(crate) const BUILDERS: &str =
    "is the machine builder's: taken as one that does not move the tool";

pub(crate) const BY_PARAMETER: &str = "a Q parameter says its value";

impl Reader<'_> {
    pub(crate) fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        let file = self.file;
        note(&mut self.found.faults, || {
            ProgramError::at(file, span.clone(), reason, remedy)
        });
    }

    /// Remarks once on a word that is taken in some way.
    pub(crate) fn remark(&mut self, span: &Range<usize>, word: &str, taken: &str) {
        if self.remarked.insert(word.to_owned()) {
            self.finding(span, format!("{word} {taken}"));
        }
    }

    pub(crate) fn finding(&mut self, span: &Range<usize>, message: String) {
        self.found.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }
}

/// A motion as it is programmed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    pub block: Block,
    pub shape: Shape,
    /// Start in the programmed axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    pub datum: Datum,
    pub unit_mm: f64,
    /// Modal feed as programmed; `None` in rapid traverse or if unknown.
    pub feed: Option<f64>,
    /// The plane of its arc, or of its pole; and that of the tool's axis.
    pub plane: Plane,
    pub working: Plane,
    /// RL or RR in force, and the tool's radius where the program states it, mm.
    pub aside: Option<(Aside, Option<f64>)>,
    /// Sense of its arc in the programmed axes, 1 anticlockwise; 0 of what is straight.
    pub turns: f64,
    /// Surface normals at its start and its end, where blocks state them, as programmed.
    pub normals: [Option<Vector3<f64>>; 2],
    pub pole: PoleThere,
    /// A block up to here stated the direction of the tool.
    pub directed: bool,
    /// Rotary axis positions that it states, with shortest-path traverse (M126).
    pub axes: Option<AxesStated>,
    pub shorter: bool,
    /// The motion at whose end the pole was set from where the tool was.
    pub pole_from: Option<usize>,
}

/// The pole at a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PoleThere {
    /// Active pole.
    pub at: Option<Pole>,
    /// The block counts from it.
    pub used: bool,
    /// Number of executed CC blocks, in all and up to the last that does not depend on an earlier pole.
    pub count: usize,
    pub whole: usize,
}

/// Content of a program.
#[derive(Default)]
pub(crate) struct Found {
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    /// First line of a feed whose way is the control's own.
    pub unjudged_feed_on: Option<usize>,
    /// Calls of programs that are in none of the files.
    pub outside_calls: Vec<OutsideCall>,
    pub motions: Vec<Motion>,
    /// Source positions of each motion.
    pub ways: Vec<Way>,
    /// Rotary axis positions that the motions state.
    pub axes: BTreeMap<usize, AxesStated>,
    /// Evidence in the words for the way in which these axes count.
    pub shown: Vec<CountShown>,
    /// Rounded corners, in the order in which they run.
    pub corners: Vec<Result<Rounded, Unrounded>>,
    /// LP blocks after the first that continue an earlier radius or angle: their ends, mm, and the unit, mm.
    pub polar: Vec<(Block, Vector2<f64>, f64)>,
}

/// True if a program may have rounded corners or chamfers.
pub(crate) fn has_corners(bytes: &[u8]) -> bool {
    bytes
        .windows(3)
        .any(|part| part.eq_ignore_ascii_case(b"RND") || part.eq_ignore_ascii_case(b"CHF"))
}

/// A straight block, or an arc about a pole, whose start and end are known, in the programmed axes, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub block: Block,
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    pub arc: Option<Beside>,
    pub rapid: bool,
    pub unit_mm: f64,
    /// Modal feed at the end, as programmed.
    pub feed: Option<f64>,
}

impl Line {
    /// Leg of the corner in the plane.
    pub(crate) fn leg(&self) -> Leg {
        Leg {
            from: self.from.xy(),
            to: self.to.xy(),
            arc: self.arc,
        }
    }
}

/// Remedy of a corner that is not followed.
pub(crate) const AS_ARC: &str =
    "let the CAM system write the corner as an arc (CR or C) between its lines";
pub(crate) const AS_LINE: &str =
    "let the CAM system write the chamfer as an L block between its lines";

/// A block RND or CHF behind a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pending {
    pub line: Option<Line>,
    pub block: Block,
    pub span: Range<usize>,
    /// Cut of the corner, in mm, or the reason why it is unknown.
    pub cut: Result<Cut, String>,
    pub feed: Option<f64>,
    /// Remedy if the corner is not followed.
    pub remedy: &'static str,
}

/// A rounded corner, or a chamfer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rounded {
    /// The blocks of the line before, of the corner, and of the line behind.
    pub blocks: [Block; 3],
    pub corner: Corner,
    /// Cut as programmed, in mm.
    pub cut: Cut,
    /// F of the block itself, and the feed that is in force again behind it.
    pub feed: Option<f64>,
    pub feed_behind: Option<f64>,
    /// Programmed end of the second line, mm.
    pub to: Vector2<f64>,
    pub unit_mm: f64,
}

/// A corner that is not followed: where, why, what to do.
pub(crate) type Unrounded = (Range<usize>, String, &'static str);
