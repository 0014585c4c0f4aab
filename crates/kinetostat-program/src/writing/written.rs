//! A written program and its motions, and its header in the file's own comment style.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::path::curve::{Arc, Curve};
use crate::path::moves::{Knowledge, Move, Path, PositionOffset};
use crate::text::LineKind;
use crate::text::program::{COMPENSATED_MARK, HEADER_PREFIX, Program};
use crate::writing::accounting::Accounting;
use crate::writing::node::Turn;
use crate::writing::output_state::{OutputState, WrittenArc, slipped};

/// One motion of the written program: straight, or an arc that is kept or fitted. A doctest is with [`WrittenArc`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Piece {
    /// Index of the move it is a part of, in [`Path::moves`](crate::Path::moves).
    pub move_index: usize,
    /// Share of the move's length at which it begins.
    pub share_from: f64,
    /// Share of the move's length at which it ends.
    pub share_to: f64,
    /// Start as written (rounded), in mm, part frame.
    pub commanded_from: Vector3<f64>,
    /// End as written (rounded), in mm, part frame.
    pub commanded_to: Vector3<f64>,
    /// Line of the output, counted from 1.
    pub output_line: usize,
    /// A step at one place of the part, where the correction jumps.
    pub corner_step: bool,
    /// Part of the load's turn that such a step covers.
    pub turn: Option<Turn>,
    /// True if the field's correction is in its end; otherwise the move is carried (its place is not known) or has no
    /// length.
    pub corrected: bool,
    /// An arc that stays an arc, because no correction on it could be written.
    pub kept_arc: bool,
    /// An arc that was fitted to the corrected curve of one; `None` for straight pieces and kept arcs.
    pub arc: Option<WrittenArc>,
    /// A circle through a place, or in Heidenhain programs an arc about a stated centre, that was fitted to the corrected curve of an arc.
    pub circle: Option<WrittenCircle>,
    /// True if the feed was held to [`WriteOptions::max_feed_factor`](crate::WriteOptions::max_feed_factor) times the programmed one, so
    /// the part is cut more slowly here than programmed.
    pub feed_limited: bool,
}

impl Piece {
    /// A straight piece, between two shares of its move and two places as written (mm, part frame), without a correction.
    #[must_use]
    pub fn uncorrected(
        move_index: usize,
        [share_from, share_to]: [f64; 2],
        [commanded_from, commanded_to]: [Vector3<f64>; 2],
        output_line: usize,
    ) -> Self {
        Self {
            move_index,
            share_from,
            share_to,
            commanded_from,
            commanded_to,
            output_line,
            corner_step: false,
            turn: None,
            corrected: false,
            kept_arc: false,
            arc: None,
            circle: None,
            feed_limited: false,
        }
    }

    /// True for an arc or a circle that was fitted to the corrected curve.
    #[must_use]
    pub fn is_fitted(&self) -> bool {
        self.arc.is_some() || self.circle.is_some()
    }

    /// Commanded tool position, in mm, when a part (0 to 1) of the piece's stretch of its move is done.
    #[must_use]
    pub fn commanded(&self, motion: &Move, part: f64) -> Vector3<f64> {
        match (&self.arc, &self.circle) {
            _ if self.kept_arc => motion.point(part),
            _ if part <= 0.0 => self.commanded_from,
            _ if part >= 1.0 => self.commanded_to,
            (Some(arc), _) => {
                let curve = arc.between(&self.commanded_from, &self.commanded_to);
                curve.point(arc.turned(part))
            }
            (None, Some(circle)) => circle.commanded(part),
            (None, None) => self.commanded_from.lerp(&self.commanded_to, part),
        }
    }

    /// Length of the tool's way, in mm.
    #[must_use]
    pub fn length_mm(&self, motion: &Move) -> f64 {
        let (from, to) = (&self.commanded_from, &self.commanded_to);
        let curve = match (&self.arc, &self.circle) {
            (Some(arc), _) => Some(arc.between(from, to)),
            (None, circle) => circle.map(|circle| circle.curve),
        };
        match curve {
            _ if self.kept_arc => motion.length_mm(),
            Some(arc) => Curve::Arc(arc).length_between(from, to, 0.0, 1.0),
            None => (to - from).norm(),
        }
    }
}

/// A written program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corrected {
    /// The program, to be written to a file as it is.
    pub bytes: Vec<u8>,
    /// Motions of the program, in order.
    pub pieces: Vec<Piece>,
    /// Other files of the program, in their order, by name: declarations of targets that changed with it. Empty in G-code.
    pub beside: Vec<(String, Vec<u8>)>,
    /// Orientation of the tool at the end of every piece as written, part axes from tool axes; empty where the program does not
    /// state it.
    pub orientations: Vec<UnitQuaternion<f64>>,
    /// Angles of the rotary axes at the end of every piece as written, in deg and their order; empty if the words of the
    /// program stay, and for pieces of moves that do not state them.
    pub rotary_deg: Vec<Vec<f64>>,
    /// Summary of the changes.
    pub accounting: Accounting,
    /// State of the writer after a part of a longer program; `None` for a whole one.
    #[doc(hidden)]
    pub writer: Option<Box<WriterState>>,
}

impl Corrected {
    /// Pieces of the written program before the first of these: 0, but for a part of a longer program.
    #[must_use]
    pub fn pieces_before(&self) -> usize {
        let writer = self.writer.as_ref();
        writer.map_or(0, |writer| writer.pieces - self.pieces.len())
    }

    /// Pieces as the moves of a path: the commanded positions of the tool. Moves have the index of their piece and its line in
    /// the output; the place of uncorrected ones is unknown. `original` is the path that it was written from.
    ///
    /// ```
    /// use kinetostat_program::*;
    /// use nalgebra::Vector3;
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let raised = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.25));
    /// let written = write_corrected(&program, &path, &raised, &WriteOptions::default(), &Unwatched)?;
    /// let commanded = written.path(&path);
    /// assert_eq!(commanded.moves.len(), written.pieces.len());
    /// assert_eq!(commanded.moves[2].end, Vector3::new(100.0, 0.0, -0.75));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn path(&self, original: &Path) -> Path {
        let moves = self.pieces.iter().map(|piece| {
            let motion = &original.moves[piece.move_index];
            let (mut start, mut end) = (piece.commanded_from, piece.commanded_to);
            let curve = match (&piece.arc, &piece.circle) {
                _ if piece.kept_arc => {
                    (start, end) = (motion.start, motion.end);
                    motion.curve
                }
                (Some(arc), _) => Curve::Arc(arc.between(&start, &end)),
                (None, Some(circle)) => Curve::Arc(circle.curve),
                (None, None) => Curve::Line,
            };
            Move {
                line: piece.output_line,
                kind: motion.kind,
                curve,
                start,
                end,
                tool_turn: None,
                extra: Vec::new(),
                feed: motion.feed,
                known: match piece.corrected {
                    true => motion.known,
                    false => Knowledge::Nothing,
                },
                words: motion.words,
            }
        });
        Path {
            moves: moves.collect(),
            tool_axis: original.tool_axis,
            stated: original.stated,
            ..Path::default()
        }
    }
}

/// State of a writer between two parts of a program: the second one is written from it and its own lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WriterState {
    pub(crate) output: OutputState,
    /// Last rotation of the tool, rad.
    pub(crate) tilt: Vector3<f64>,
    /// Line of the output that is written next.
    pub(crate) output_line: usize,
    /// Pieces that were written so far.
    pub(crate) pieces: usize,
    pub(crate) input_offset: PositionOffset,
    pub(crate) input_position: Vector3<f64>,
    /// A correction was written so far.
    pub(crate) corrected: bool,
    /// The largest so far: by so much may an axis be off that a block does not name.
    pub(crate) largest_correction_mm: f64,
}

/// A circle of the written program that passes through a place between its ends, or an arc about a stated centre, as it was read
/// again.
///
/// ```
/// use kinetostat_program::{Arc, WrittenCircle};
/// use nalgebra::Vector3;
///
/// let [start, via, end] = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]].map(|[x, y]| Vector3::new(x, y, 2.0));
/// let curve = Arc::through(&start, &via, &end).unwrap();
/// let circle = WrittenCircle { curve, slip: [0.0, 0.0] };
/// assert!((circle.commanded(0.5) - via).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WrittenCircle {
    /// Curve, part frame, in mm.
    pub curve: Arc,
    /// Slip, as in [`crate::WrittenArc::slip`].
    pub slip: [f64; 2],
}

impl WrittenCircle {
    /// Commanded tool position when a part (0 to 1) of the piece's stretch of the path is done, mm.
    #[must_use]
    pub fn commanded(&self, part: f64) -> Vector3<f64> {
        self.curve.point(slipped(&self.slip, part))
    }
}

/// Bytes of the header: the mark, then the texts, wrapped to `max_line_bytes`.
pub(crate) fn header(program: &Program, texts: &[String], max_line_bytes: usize) -> Vec<u8> {
    let (open, close) = if program.uses_semicolons() {
        ("; ", "")
    } else {
        ("(", ")")
    };
    let room = max_line_bytes - open.len() - close.len();
    let mut bytes = Vec::new();
    let mut write = |text: &str| {
        bytes.extend_from_slice(open.as_bytes());
        bytes.extend_from_slice(text.as_bytes());
        bytes.extend_from_slice(close.as_bytes());
        bytes.extend_from_slice(program.usual_ending());
    };
    write(COMPENSATED_MARK);
    for text in texts.iter().flat_map(|text| text.lines()) {
        let plain = plain(text);
        let mut rest = plain.as_str();
        loop {
            let length = rest.len().min(room - HEADER_PREFIX.len());
            write(&format!("{HEADER_PREFIX}{}", &rest[..length]));
            rest = &rest[length..];
            if rest.is_empty() {
                break;
            }
        }
    }
    bytes
}

/// ASCII without anything that would end a comment.
fn plain(text: &str) -> String {
    text.chars()
        .map(|character| match character {
            '(' => '[',
            ')' => ']',
            ' '..='~' => character,
            _ => '?',
        })
        .collect()
}

/// Number of lines at the top that stay above the header: the tape mark and the program number. Zero for a program
/// that has nothing else.
pub(crate) fn lines_above(program: &Program) -> usize {
    let mut above = 0;
    for line in program.lines() {
        let words = program.words(line);
        let number = line.kind == LineKind::Words && words.len() == 1 && words[0].letter == b'O';
        if !(number || line.kind == LineKind::Tape && above == 0) {
            break;
        }
        above += 1;
    }
    if above < program.lines().len() {
        above
    } else {
        0
    }
}
