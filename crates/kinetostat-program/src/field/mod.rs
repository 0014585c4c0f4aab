//! Fields of corrections: queries at places of the path and their answers, and a field from a table.

pub(crate) mod map;

use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::path::moves::Move;

/// A point of the path for which a correction is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Index of the move in [`crate::Path::moves`].
    pub move_index: usize,
    /// Share of the move's length: 0 at its start, 1 at its end.
    pub share: f64,
    /// The point, in mm, part frame.
    pub position_mm: Vector3<f64>,
    /// Direction of motion there, a unit vector; `None` where the move has no length or its start is
    /// not known.
    pub tangent: Option<Vector3<f64>>,
    /// Orientation of the tool there, part axes from tool axes; `None` in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Turn of the load inside a corner step; `None` on the path itself.
    pub turning: Option<Turning>,
}

/// A point inside a corner step, where the tool stands on the part and the load turns from that of
/// one place of the path to that of another, as far as `part` says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// Move whose load holds before the step.
    pub from_move: usize,
    /// Share of that move.
    pub from_share: f64,
    /// Share of the request's own move whose load holds after the step.
    pub to_share: f64,
    /// 0 is before, 1 is after.
    pub part: f64,
}

/// Reason for which a field has no correction for a point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldFailure {
    /// Error and remedy, without the place: the caller names line and point.
    pub message: String,
}

impl FieldFailure {
    /// A failure that says what is wrong and what to do; the caller adds line and point.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
        }
    }
}

/// A field of corrections: what to add to the position so that the tool comes to be where the
/// program wants it, and to the orientation where the program states one.
///
/// The writer evaluates it in batches of some thousand points in the order of the path; an implementor may
/// work on them in parallel. The answer has one entry for each request, in order. Equal requests must
/// get equal answers, or the output would not be reproducible.
pub trait CorrectionField: Sync {
    /// Corrections, part axes, to be added to the poses of the query.
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>>;

    /// True if the field follows the turn of the load inside a corner step ([`Request::turning`]). Otherwise such a
    /// step is one straight piece.
    fn turns(&self) -> bool {
        false
    }

    /// True if the field corrects the orientation too ([`Correction::turn`]). Arcs of such a program are written with straight pieces.
    fn turns_tool(&self) -> bool {
        false
    }

    /// Structure of the field along a move that is to be divided.
    fn structure(&self, _move_index: usize, _motion: &Move) -> Structure {
        Structure::default()
    }
}

/// A field's own course along a move.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// Shares of the move, between 0 and 1 and in any order, at which the correction or its slope may
    /// jump. Each of them is evaluated, and what lies between two is looked at by itself.
    pub breaks: Vec<f64>,
    /// Form of the correction between two of them.
    pub course: Course,
}

/// Form of a correction on a stretch without breaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// Polynomial of at most third degree in the share, along a straight line. Five values determine it.
    Cubic,
    /// Smooth: it could be continued as a power series this far (in mm) beyond every place of the
    /// stretch, and would be at most twice as large there. The shorter this length, the more places are
    /// asked.
    Smooth {
        /// The length, in mm.
        radius_mm: f64,
    },
    /// Smooth along a straight move on which only the place changes. If the move is short compared with the length, the
    /// corrections at its two ends determine it.
    Steady {
        /// The length, in mm.
        radius_mm: f64,
    },
}

impl Default for Course {
    /// Default of a field that declares nothing: smooth over 25 mm.
    fn default() -> Self {
        Self::Smooth { radius_mm: 25.0 }
    }
}

/// A closure that answers one request is a field of positions, in mm.
impl<F> CorrectionField for F
where
    F: Fn(&Request) -> Result<Vector3<f64>, FieldFailure> + Sync,
{
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let answers = requests.iter().map(self);
        answers.map(|shift| shift.map(Correction::from)).collect()
    }
}

/// The field that corrects nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCorrection;

impl CorrectionField for NoCorrection {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        vec![Ok(Correction::default()); requests.len()]
    }
}

/// Observer of a long run, who may stop it.
pub trait Monitor: Sync {
    /// `done` of `total` points are answered; the total grows while blocks are divided.
    fn progress(&self, done: usize, total: usize);

    /// True if the run is to stop. Asked between batches.
    fn cancelled(&self) -> bool;
}

/// A monitor that neither watches nor stops.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Monitor for Unwatched {
    fn progress(&self, _done: usize, _total: usize) {}

    fn cancelled(&self) -> bool {
        false
    }
}

/// Correction that a field adds to the programmed pose so that the tool reaches the desired one, part axes.
///
/// A [`Vector3`] is a correction of the position alone:
///
/// ```
/// use kinetostat_program::Correction;
/// use nalgebra::Vector3;
///
/// let raised = Correction::from(Vector3::new(0.0, 0.0, 0.2));
/// assert_eq!(raised.shift_mm.z, 0.2);
/// assert_eq!(raised.turn, Vector3::zeros());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Correction {
    /// Added to the position, in mm.
    pub shift_mm: Vector3<f64>,
    /// Rotation vector, in rad, about the tool's tip: the tool is turned by it from the orientation of the program. Zero in a
    /// program of positions.
    pub turn: Vector3<f64>,
}

impl From<Vector3<f64>> for Correction {
    fn from(shift_mm: Vector3<f64>) -> Self {
        Self {
            shift_mm,
            turn: Vector3::zeros(),
        }
    }
}

impl Correction {
    /// The correction as one vector of lengths, in mm: rotations are multiplied by the lever.
    pub(crate) fn in_lengths(&self, lever_mm: f64) -> Vector6<f64> {
        let (shift, turn) = (self.shift_mm, self.turn * lever_mm);
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    }

    /// The inverse of [`Self::in_lengths`].
    pub(crate) fn of_lengths(lengths: &Vector6<f64>, lever_mm: f64) -> Self {
        Self {
            shift_mm: lengths.fixed_rows::<3>(0).into_owned(),
            turn: lengths.fixed_rows::<3>(3) / lever_mm,
        }
    }

    /// The orientation to command, part axes from tool axes, where the program wants this one.
    ///
    /// ```
    /// use kinetostat_program::Correction;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let turn = Vector3::new(0.001, 0.0, 0.0); // 1 mrad about x of the part
    /// let correction = Correction { turn, ..Correction::default() };
    /// let programmed = UnitQuaternion::from_euler_angles(3.0, 0.1, -2.0);
    /// let commanded = correction.turned(&programmed);
    /// assert!(((commanded * programmed.inverse()).scaled_axis() - turn).norm() < 1e-12);
    /// ```
    #[must_use]
    pub fn turned(&self, programmed: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(self.turn) * programmed
    }
}
