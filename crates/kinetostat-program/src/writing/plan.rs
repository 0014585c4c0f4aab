//! Output for every move: for writers of any language.
//!
//! A [`Plan`] is made from the path and a field of corrections. A writer puts its pieces into the text of its language and says
//! where each of them ends as written; [`Plan::corrected`] makes the account of it, the same for all languages.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::WriteError;
use crate::field::{Correction, CorrectionField, Monitor};
use crate::path::curve::{Arc, Curve};
use crate::path::moves::{Feed, FeedMode, Knowledge, Move, MoveKind, Path};
use crate::writing::accounting::Accounting;
use crate::writing::dividing::beginning::Fitted;
use crate::writing::dividing::divide::divide;
use crate::writing::fitting::stretch::ArcForm;
use crate::writing::node::is_divided;
use crate::writing::options::{Arcs, Circles, WriteOptions};
use crate::writing::output_state::{FittedArc, OutputMove};
use crate::writing::piece_account::{AsWritten, PieceAccount};
use crate::writing::steps::Steps;
use crate::writing::written::{Corrected, WrittenCircle};

/// A piece to be written: a straight motion to a pose, or a whole arc that is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedPiece {
    /// Share of the move's length at which it ends.
    pub share_to: f64,
    /// End of the piece, part frame, in mm.
    pub position_mm: Vector3<f64>,
    /// A place between its ends, mm, through which it passes on a circle; `None` where it is straight.
    pub via_mm: Option<Vector3<f64>>,
    /// The arc on which it goes there, for a language that states centres ([`Circles::AboutAxis`]); `None` where it is straight or
    /// goes through a place.
    pub arc: Option<PlannedArc>,
    /// Orientation of the tool there, part axes from tool axes; `None` in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Speed over that of the program, so that the speed along the part stays the same; at most
    /// [`WriteOptions::max_feed_factor`].
    pub speed_factor: f64,
    /// The speed is held to that largest factor: the part is cut more slowly here.
    pub speed_limited: bool,
}

/// Output for one move.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedMove {
    /// The pieces, in order; one at least.
    pub pieces: Vec<PlannedPiece>,
    /// The move stays as it is: its place is not known, or it is an arc on which no correction reaches the last digit.
    pub kept: bool,
}

/// End of a piece as written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrittenEnd {
    /// Rounded, part frame, in mm.
    pub position_mm: Vector3<f64>,
    /// Part axes from tool axes; `None` in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Line of the output, counted from 1.
    pub line: usize,
    /// The circle or the arc on which the piece goes there, as it was read again; `None` where it is straight.
    pub circle: Option<Arc>,
}

/// Text that a writer made of a move.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenMove {
    /// End of each piece.
    pub ends: Vec<WrittenEnd>,
    /// The text of the move is byte for byte that of the input.
    pub same: bool,
}

/// All pieces of a program that is to be written.
pub struct Plan<'a> {
    path: &'a Path,
    options: &'a WriteOptions,
    steps: Vec<Vec<OutputMove>>,
    moves: Vec<PlannedMove>,
    evaluations: usize,
    largest_jump_taken_up_mm: f64,
}

impl<'a> Plan<'a> {
    /// Divides every move where the correction varies, into straight pieces.
    ///
    /// # Errors
    /// As [`crate::write_corrected`], but for what belongs to a text.
    pub fn new(
        path: &'a Path,
        field: &dyn CorrectionField,
        options: &'a WriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Self, WriteError> {
        Self::with_circles(path, field, options, &[], monitor)
    }

    /// Variant of [`Plan::new`] in which arcs become circles through a place, or arcs about the same axis, if `circles` (one entry
    /// for each move, straight where there is none) says so and [`WriteOptions::arcs`] asks for arcs.
    ///
    /// ```
    /// use kinetostat_program::*;
    /// use nalgebra::Vector3;
    ///
    /// let program = Program::read("G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// // The plane of the arc leans: no arc about z follows that.
    /// let leaning = |request: &Request| Ok(Vector3::z() * 0.01 * request.position_mm.x);
    /// let writing = WriteOptions::default();
    /// let circles = [Circles::Straight, Circles::ThroughPlace];
    /// let plan = Plan::with_circles(&path, &leaning, &writing, &circles, &Unwatched)?;
    /// let pieces = &plan.moves()[1].pieces;
    /// assert!(pieces.len() <= 2 && pieces.iter().all(|piece| piece.via_mm.is_some()));
    /// assert!(Plan::new(&path, &leaning, &writing, &Unwatched)?.moves()[1].pieces.len() > 20);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn with_circles(
        path: &'a Path,
        field: &dyn CorrectionField,
        options: &'a WriteOptions,
        circles: &[Circles],
        monitor: &dyn Monitor,
    ) -> Result<Self, WriteError> {
        options.check()?;
        let fitted = |index: usize| match (options.arcs, circles.get(index)) {
            (Arcs::Fit, Some(Circles::ThroughPlace)) => Fitted::Circles,
            (Arcs::Fit, Some(Circles::AboutAxis)) => Fitted::Arcs,
            _ => Fitted::Nothing,
        };
        let division = divide(path, field, options, &fitted, monitor)?;
        let evaluations = division.evaluations;
        let mut steps = Steps::new(path, options, division);
        let mut reached = path.moves.first().map_or_else(Vector3::zeros, |m| m.start);
        let (mut all, mut moves) = (Vec::new(), Vec::new());
        for (move_index, motion) in path.moves.iter().enumerate() {
            let (list, nodes) = steps.of(move_index, reached, ArcForm::Centre)?;
            let half = options.half_digit_mm(motion.words.mm_per_unit);
            let nothing = |step: &OutputMove| {
                let off = step.target - motion.point(step.share_to);
                off.amax() <= half
                    && step.tilt.amax() * options.turn_lever_mm <= half
                    && step.largest_inside_mm() <= half
            };
            let arc = motion.curve != Curve::Line;
            let kept = motion.known == Knowledge::Nothing
                || arc
                    && is_divided(motion)
                    && !nodes.is_empty()
                    && list.iter().all(nothing)
                    && (reached - motion.start).amax() <= half;
            let list = match kept {
                false => list,
                true => {
                    let corrected = motion.known != Knowledge::Nothing;
                    vec![OutputMove::whole(motion.end, Vector3::zeros(), corrected)]
                }
            };
            moves.push(PlannedMove {
                pieces: pieces(motion, &list, reached, kept, options),
                kept,
            });
            reached = list.last().map_or(reached, |step| step.target);
            all.push(list);
        }
        Ok(Self {
            path,
            options,
            steps: all,
            moves,
            evaluations,
            largest_jump_taken_up_mm: steps.largest_jump_taken_up_mm,
        })
    }

    /// Output for each move of the path.
    #[must_use]
    pub fn moves(&self) -> &[PlannedMove] {
        &self.moves
    }

    /// The written program with its account. `blocks_in` counts the statements of the input, `bytes_in` its bytes; `written` has
    /// one entry for each move.
    #[must_use]
    pub fn corrected(
        self,
        blocks_in: usize,
        bytes_in: usize,
        written: &[WrittenMove],
        bytes: Vec<u8>,
    ) -> Corrected {
        let accounting = Accounting {
            blocks_in,
            bytes_in,
            moves_in: self.path.moves.len(),
            blocks_carried: blocks_in - self.path.moves.len().min(blocks_in),
            blocks_out: blocks_in - self.path.moves.len().min(blocks_in),
            evaluations: self.evaluations,
            largest_jump_taken_up_mm: self.largest_jump_taken_up_mm,
            warnings: self.path.warnings.clone(),
            ..Accounting::default()
        };
        let mut account = PieceAccount::new(self.path, self.options, accounting);
        let mut orientations = Vec::new();
        let mut from = self
            .path
            .moves
            .first()
            .map_or_else(Vector3::zeros, |m| m.start);
        let planned = self.steps.iter().zip(&self.moves).zip(written);
        for (move_index, ((steps, plan), written)) in planned.enumerate() {
            let motion = &self.path.moves[move_index];
            let ends = steps.iter().zip(&plan.pieces).zip(&written.ends);
            for ((step, piece), end) in ends {
                let factor = piece.speed_factor;
                let as_written = AsWritten {
                    from,
                    to: end.position_mm,
                    output_line: end.line,
                    arc: None,
                    circle: end
                        .circle
                        .zip(step.slip())
                        .map(|(curve, slip)| WrittenCircle { curve, slip }),
                    kept_arc: plan.kept && motion.curve != Curve::Line,
                    feed: motion.feed.map(|feed| Feed {
                        value: feed.value * factor,
                        ..feed
                    }),
                    feed_limited: piece.speed_limited,
                };
                match motion.known {
                    Knowledge::Nothing => account.uncorrected(move_index, &as_written),
                    _ => account.piece(move_index, step, &as_written),
                }
                orientations.extend(end.orientation);
                from = end.position_mm;
            }
            account.block(motion, steps.len(), written.same);
        }
        let (pieces, accounting) = account.finish(bytes.len());
        Corrected {
            bytes,
            pieces,
            orientations,
            accounting,
            ..Corrected::default()
        }
    }
}

fn pieces(
    motion: &Move,
    steps: &[OutputMove],
    mut from: Vector3<f64>,
    kept: bool,
    options: &WriteOptions,
) -> Vec<PlannedPiece> {
    let mut list = Vec::with_capacity(steps.len());
    for step in steps {
        let arc = match &motion.curve {
            Curve::Arc(own) => step.arc.map(|fitted| PlannedArc::new(own, &fitted)),
            Curve::Line => None,
        };
        let part_mm = motion.length_between_mm(step.share_from, step.share_to);
        let per_minute = motion.feed.is_none_or(|f| f.mode != FeedMode::InverseTime);
        let measured = motion.kind == MoveKind::Feed
            && motion.known == Knowledge::Whole
            && !kept
            && !step.corner_step
            && per_minute
            && part_mm > 0.0;
        let raised = match measured {
            true => {
                let circle = step.circle.map(|circle| circle.length_mm);
                let length = circle.or(arc.map(|arc| arc.length_mm(&from, &step.target)));
                length.unwrap_or_else(|| (step.target - from).norm()) / part_mm
            }
            false => 1.0,
        };
        let turn = Correction {
            shift_mm: Vector3::zeros(),
            turn: step.tilt,
        };
        list.push(PlannedPiece {
            share_to: step.share_to,
            position_mm: step.target,
            via_mm: step.circle.map(|circle| circle.via_mm),
            arc,
            orientation: motion.orientation(step.share_to).map(|o| turn.turned(&o)),
            speed_factor: raised.min(options.max_feed_factor),
            speed_limited: raised > options.max_feed_factor,
        });
        from = step.target;
    }
    list
}

/// An arc about an axis of the path's own arc, whose distance from the axis stays and which rises evenly, before rounding.
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// // The part is made 0.2 % larger and lies 0.1 mm higher.
/// let field = |request: &Request| Ok(request.position_mm * 2e-3 + Vector3::z() * 0.1);
/// let writing = WriteOptions::default();
/// let circles = [Circles::Straight, Circles::AboutAxis];
/// let plan = Plan::with_circles(&path, &field, &writing, &circles, &Unwatched)?;
/// let piece = &plan.moves()[1].pieces.iter().find(|piece| piece.arc.is_some()).unwrap();
/// let arc = piece.arc.unwrap();
/// assert!((arc.angle_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
/// assert!((arc.length_mm(&piece.position_mm, &piece.position_mm) - 15.7394).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedArc {
    /// A place of its axis, part frame, mm.
    pub centre_mm: Vector3<f64>,
    /// Direction of its axis, of length 1.
    pub axis: Vector3<f64>,
    /// Radius, mm.
    pub radius_mm: f64,
    /// Angle from its start to its end about the axis, right-handed, rad.
    pub angle_rad: f64,
}

impl PlannedArc {
    pub(crate) fn new(of: &Arc, fitted: &FittedArc) -> Self {
        let [first, second] = fitted.centre_mm;
        Self {
            centre_mm: of.first * first + of.second * second,
            axis: of.axis,
            radius_mm: fitted.radius_mm,
            angle_rad: fitted.sweep_rad,
        }
    }

    /// Length between two ends, mm: only their heights along the axis matter.
    #[must_use]
    pub fn length_mm(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
        (self.radius_mm * self.angle_rad).hypot((to - from).dot(&self.axis))
    }
}
