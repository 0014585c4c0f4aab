//! Part frame as the machine measured it: motion from where the program says that the tool should be to where it should be in the
//! machine.
//!
//! A machine that touched its part off hung as it hangs while it cuts. Its control stands where the unloaded tool was, less the
//! displacement by own weight there, so that the part lies off the programmed frame by this displacement. One whose control
//! corrects own weight has the same at every place.

use kinetostat::batch::AlongPath;
use kinetostat::linalg::SingularValues;
use kinetostat::{Directions, Error, Mechanism, Pose, Posture, Wrench};
use kinetostat_program::Knowledge;
use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::placement::Placement;
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::{Neighbour, Orientation};
use crate::result::point::PointResult;
use crate::task::{RunError, Task};
use crate::weight_correction::{TouchOff, WeightCorrection};

/// A place of a program as it is stated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartPlace {
    pub place: Placement,
    pub position_mm: Vector3<f64>,
    /// Part axes from tool axes; none in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
}

impl PartPlace {
    /// Place of a point of a run.
    pub fn of_point(task: &Task<'_>, point: &PointResult) -> Self {
        let turned =
            |[w, i, j, k]: [f64; 4]| UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
        Self {
            place: task.placement.turned(point.part_turn.as_ref()),
            position_mm: point.position_mm.into(),
            orientation: point.tool_orientation.map(turned),
        }
    }

    /// Pose of the tool in the base, m.
    pub fn pose(&self) -> Pose {
        let orientation = self.place.orientation_of(self.orientation);
        self.place.pose(&self.position_mm, orientation)
    }

    /// Place of the part as it was measured.
    pub fn moved(mut self, motion: &FrameMotion) -> Self {
        self.position_mm += motion.shift_mm;
        self.orientation = self.orientation.map(|o| motion.turn * o);
        self
    }

    /// Measured place in the corrected directions of the pose.
    pub fn corrected(self, motion: &FrameMotion, corrected: Directions) -> Self {
        let moved = self.moved(motion);
        match corrected == Directions::ALL {
            true => moved,
            false => Self {
                orientation: self.orientation,
                ..moved
            },
        }
    }
}

/// Motion of the measured part at a place, in its own axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameMotion {
    pub shift_mm: Vector3<f64>,
    pub turn: UnitQuaternion<f64>,
}

impl Default for FrameMotion {
    fn default() -> Self {
        Self {
            shift_mm: Vector3::zeros(),
            turn: UnitQuaternion::identity(),
        }
    }
}

/// Displacement of the unloaded tool by own weight and what else acts in the model: the difference between the machine and the same
/// machine without them, so that errors of its geometry do not count.
pub(crate) struct Sag<'t> {
    mechanism: &'t Mechanism,
    orientation: Orientation,
    /// The machine, and without its own loads; `None` if it has no such loads.
    both: Option<[AlongPath; 2]>,
}

impl<'t> Sag<'t> {
    pub fn new(mechanism: &'t Mechanism, placement: &Placement) -> Self {
        let orientation = Orientation {
            follows: placement.orientation_follows,
            load_turns: false,
        };
        let compiled = match orientation.follows {
            true => AlongPath::by_neighbours,
            false => AlongPath::new,
        };
        let both = || {
            [
                compiled(mechanism),
                compiled(&mechanism.without_own_loads()),
            ]
        };
        Self {
            mechanism,
            orientation,
            both: mechanism.has_own_loads().then(both),
        }
    }

    /// Motions at neighbouring places, each near a posture if one is given.
    pub fn at<'p>(
        &self,
        places: &[PartPlace],
        near: impl Fn(usize) -> Option<&'p Posture>,
    ) -> Vec<Result<FrameMotion, Error>> {
        let Some(both) = &self.both else {
            return vec![Ok(FrameMotion::default()); places.len()];
        };
        let poses: Vec<Pose> = places.iter().map(PartPlace::pose).collect();
        let unloaded = vec![Wrench::zero(); places.len()];
        let is_free = (0..places.len()).all(|i| near(i).is_none());
        let [own, without] = [&both[0], &both[1]].map(|machine| -> Vec<Result<Pose, Error>> {
            let found = is_free.then(|| machine.rest(&poses, &unloaded)).flatten();
            if let Some(found) = found {
                return (0..places.len()).map(|i| Ok(found.tool_pose(i))).collect();
            }
            let mut memory = Neighbour::default();
            let rest = |(i, pose): (usize, &Pose)| {
                if let Some(posture) = near(i) {
                    memory.stand_at(posture);
                }
                let at_rest =
                    memory.rest(machine.mechanism(), pose, &Wrench::zero(), self.orientation);
                Ok(at_rest?.1)
            };
            poses.iter().enumerate().map(rest).collect()
        });
        let pairs = places.iter().zip(own.into_iter().zip(without));
        pairs
            .map(|(programmed, (own, without))| {
                let (own, without) = (own?, without?);
                let shift = own.translation.vector - without.translation.vector;
                let turn = (own.rotation * without.rotation.inverse()).scaled_axis();
                let place = &programmed.place;
                Ok(FrameMotion {
                    shift_mm: place.to_program(&shift),
                    turn: UnitQuaternion::from_scaled_axis(place.to_part_axes(&turn)),
                })
            })
            .collect()
    }
}

/// Motion of the part frame by which the machine's own weight is no error of the program.
pub(crate) enum MeasuredFrame<'t> {
    /// Frame of the program, that of the machine without own weight.
    AsStated,
    /// Motion that is equal everywhere: program axes, mm.
    Moved(Isometry3<f64>),
    /// Own weight itself, for each tool.
    Sagging(Vec<Sag<'t>>),
}

impl<'t> MeasuredFrame<'t> {
    /// Frame that the task states, along the way of an arm that is not the one from home.
    ///
    /// # Errors
    /// The machine has no answer where it touched the part off.
    pub fn of(task: &Task<'t>, course: Option<&ArmCourse>) -> Result<Self, RunError> {
        Ok(match &task.weight {
            WeightCorrection::NotStated | WeightCorrection::All => Self::AsStated,
            WeightCorrection::None => {
                let machines = std::iter::once(task.mechanism);
                let machines = machines.chain(task.tools.iter().map(|tool| tool.mechanism));
                Self::Sagging(machines.map(|m| Sag::new(m, &task.placement)).collect())
            }
            WeightCorrection::TouchOff(touched) => Self::Moved(measured(task, course, touched)?),
        })
    }

    /// Motions at neighbouring places of one tool, each near a posture if one is given.
    pub fn motions<'p>(
        &self,
        mechanism: &Mechanism,
        places: &[PartPlace],
        near: impl Fn(usize) -> Option<&'p Posture>,
    ) -> Vec<Result<FrameMotion, Error>> {
        match self {
            Self::AsStated => vec![Ok(FrameMotion::default()); places.len()],
            Self::Moved(motion) => {
                let moved = |p: &PartPlace| {
                    let there = (motion * Point3::from(p.position_mm)).coords;
                    Ok(FrameMotion {
                        shift_mm: there - p.position_mm,
                        turn: motion.rotation,
                    })
                };
                places.iter().map(moved).collect()
            }
            Self::Sagging(tools) => {
                let own = tools.iter().find(|s| std::ptr::eq(s.mechanism, mechanism));
                match own {
                    Some(sag) => sag.at(places, near),
                    None => vec![Ok(FrameMotion::default()); places.len()],
                }
            }
        }
    }
}

/// The rigid motion of the part frame that touching off measures: with the first of the tools, and as the program turns it nearest to
/// each place.
fn measured(
    task: &Task<'_>,
    course: Option<&ArmCourse>,
    touched: &TouchOff,
) -> Result<Isometry3<f64>, RunError> {
    let first = task.tools.first();
    let sag = Sag::new(
        first.map_or(task.mechanism, |tool| tool.mechanism),
        &task.placement,
    );
    let moves = &task.path().moves;
    let from: Vec<Vector3<f64>> = touched.places_mm().iter().map(|p| (*p).into()).collect();
    let mut to = from.clone();
    for (from, to) in from.iter().zip(&mut to) {
        let known = (0..moves.len()).filter(|i| moves[*i].known != Knowledge::Nothing);
        let away = |i: &usize| (moves[*i].end - from).norm();
        let nearest = known.min_by(|a, b| away(a).total_cmp(&away(b)));
        let turned = nearest.map(|i| task.placement.orientation_on(&moves[i], 1.0));
        let place = Placement {
            tool_orientation: turned.unwrap_or(task.placement.tool_orientation),
            ..task.placement
        };
        let programmed = PartPlace {
            place,
            position_mm: *from,
            orientation: None,
        };
        let posture = nearest.and_then(|i| course?.standing_at(i, 1.0));
        for found in sag.at(&[programmed], |_| posture) {
            let found = found.map_err(|cause| RunError::TouchOff {
                position_mm: (*from).into(),
                cause: Box::new(cause),
            })?;
            *to += found.shift_mm;
        }
    }
    Ok(match rigid_motion(&from, &to) {
        Some(motion) => motion,
        // One place measures no orientation.
        None => Isometry3::from_parts((to[0] - from[0]).into(), UnitQuaternion::identity()),
    })
}

/// The rotation nearest to a matrix in the sense of least squares; `None` if a turn about an axis is left open.
#[must_use]
pub fn nearest_rotation(m: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let own = SingularValues::of(m);
    // Points on a line leave a turn about it open.
    if own.rank(1e-9) < 2 {
        return None;
    }
    let u = Matrix3::from_iterator(own.left.iter().copied());
    let v_t = Matrix3::from_iterator(own.right.iter().copied()).transpose();
    let mut sign = Matrix3::identity();
    sign[(2, 2)] = (u * v_t).determinant().signum();
    let rotation = Rotation3::from_matrix_unchecked(u * sign * v_t);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

/// The rigid motion that brings points nearest to others (Kabsch); `None` if they lie on a line.
///
/// ```
/// use kinetostat::nalgebra::{Isometry3, Point3, Vector3};
/// use kinetostat_machining::rigid_motion;
///
/// let motion = Isometry3::new(Vector3::new(0.1, -0.2, 0.3), Vector3::new(0.0, 0.02, -0.01));
/// let points = [Vector3::zeros(), Vector3::x() * 300.0, Vector3::y() * 200.0];
/// let moved = points.map(|p| (motion * Point3::from(p)).coords);
/// let found = rigid_motion(&points, &moved).expect("three points");
/// assert!((found.to_homogeneous() - motion.to_homogeneous()).norm() < 1e-12);
/// assert!(rigid_motion(&points[..2], &moved[..2]).is_none());
/// ```
#[must_use]
pub fn rigid_motion(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Option<Isometry3<f64>> {
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let (here, there) = (mean(from), mean(to));
    let pairs = from.iter().zip(to);
    let h = pairs.fold(Matrix3::zeros(), |h, (from, to)| {
        h + (to - there) * (from - here).transpose()
    });
    let rotation = nearest_rotation(&h)?;
    let shift = there - rotation * here;
    Some(Isometry3::from_parts(shift.into(), rotation))
}
