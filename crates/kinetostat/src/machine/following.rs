//! Targets that prescribe the position only: the orientation follows.
//!
//! A machine with fewer freedoms than a full pose turns its tool as it moves (five-bar, 3-RPS, an arm of
//! few joints). Asked for a position, it takes the pose there whose rotation from a wanted orientation
//! is least. All joints of the nominal machine are moved together by Newton's iteration in three
//! ranks, each in what the ranks before leave free: the limbs close; the tool's reference point comes
//! to the position; the rotation vector to the wanted orientation becomes as short as it can. What a
//! rank cannot do is left, so a position that cannot be taken ends at the nearest one.

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};

use crate::chain::directions::axis_description;
use crate::error::{Error, Result};
use crate::linalg::sparse::largest;
use crate::machine::inverse::limb::wrap;
use crate::machine::posture::Posture;
use crate::machine::singular::lost_motion::{LostMotionSearch, solve};
use crate::model::mechanism::Mechanism;

/// Motions of unit length that move less than this (scaled) do not move.
const NOTHING: f64 = 1e-9;
/// Smallest such motion where freedoms are counted, beside a posture that may be singular.
const COUNTED: f64 = 1e-6;
/// A position moves, for a correction, if a motion of unit length (of all joints and platforms,
/// rotations at the natural length) moves it by this at least: less would turn the machine far for
/// a small correction.
const CORRECTS: f64 = 1e-2;
/// Maximum number of Newton steps.
const STEPS: usize = 60;
/// Largest step of the position (share of the natural length) that is taken at once.
const STRIDE: f64 = 0.1;
/// Free motions at a posture, and what they do to the tool (3 x k each, rotations at the natural
/// length).
struct Freedoms {
    all: DMatrix<f64>,
    position: DMatrix<f64>,
    rotation: DMatrix<f64>,
}

/// Shortest `z` that brings `rows z` nearest to `wanted`, and what is left free; rows of motions of
/// unit length that are rounding are none.
fn nearest(rows: &DMatrix<f64>, wanted: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let n = rows.ncols();
    if n > 0 && rows.amax() < NOTHING {
        return Some((DVector::zeros(n), DMatrix::identity(n, n)));
    }
    solve(rows, wanted)
}

/// Normal of the surface that the tool's reference point moves in, of a machine that has no third direction
/// anywhere: neither where it stands nor beside home, which may be singular.
fn surface_normal(at: &Posture) -> Option<Vector3<f64>> {
    let mechanism = &at.mechanism;
    let home = mechanism.posture_at_pose(&mechanism.platforms()[mechanism.tool()].home, None);
    let home = home.ok()?;
    let mut beside = LostMotionSearch::new(&home);
    beside.beside(0.05, 0)?;
    let (_, elsewhere) = beside.freedoms()?;
    let (_, here) = LostMotionSearch::new(at).freedoms()?;
    if rank(&elsewhere.position) != 2 || rank(&here.position) != 2 {
        return None;
    }
    let gram = (&here.position * here.position.transpose()).symmetric_eigen();
    let least = gram.eigenvalues.imin();
    let normal = Vector3::from_iterator(gram.eigenvectors.column(least).iter().copied());
    // Either sign would do, but always the same.
    Some(normal * normal[normal.iamax()].signum())
}

fn rank(rows: &DMatrix<f64>) -> usize {
    let gram = rows * rows.transpose();
    let values = gram.symmetric_eigenvalues();
    values.iter().filter(|v| **v > COUNTED * COUNTED).count()
}

impl LostMotionSearch<'_> {
    fn freedoms(&self) -> Option<(DVector<f64>, Freedoms)> {
        let (closure, residuals) = self.closure();
        let (closing, all) = solve(&closure, &residuals)?;
        let tool = self.tool();
        let position = all.rows(tool, 3).into_owned();
        let rotation = all.rows(tool + 3, 3).into_owned();
        let freedoms = Freedoms {
            all,
            position,
            rotation,
        };
        Some((closing, freedoms))
    }

    /// Largest closure residual of the limbs, scaled.
    fn largest_residual(&self) -> f64 {
        self.closure().1.amax()
    }

    /// Newton's iteration to a position (m), turned to `wanted` as near as can be; the distance left.
    fn follow(&mut self, position: &Vector3<f64>, wanted: &UnitQuaternion<f64>) -> Option<f64> {
        let tool = self.tool();
        let length = self.length;
        let mut before = f64::INFINITY;
        for _ in 0..STEPS {
            let pose = self.at.target;
            let (closing, free) = self.freedoms()?;
            let away = position - pose.translation.vector;
            let away = DVector::from_column_slice(away.as_slice()) - closing.rows(tool, 3);
            let (moving, held) = nearest(&free.position, &away)?;
            let turn = (wanted * pose.rotation.inverse()).scaled_axis() * length;
            let turn = DVector::from_column_slice(turn.as_slice())
                - closing.rows(tool + 3, 3)
                - &free.rotation * &moving;
            let (turning, _) = nearest(&(&free.rotation * &held), &turn)?;
            let [place, turn] = [&free.all * &moving, &free.all * (held * turning)];
            if !(largest(&closing) + largest(&place) + largest(&turn)).is_finite() {
                return None;
            }
            let short = |part: &DVector<f64>| part * (0.3 * length / part.amax()).min(1.0);
            self.go(&(short(&closing) + short(&place) + short(&turn)));
            // Quadratic to the last digits; along what is least, linear.
            let size = closing.amax().max(place.amax()) + 1e-2 * turn.amax();
            if size <= 1e-13 * length || (size <= 1e-11 * length && size > 0.5 * before) {
                break;
            }
            before = size;
        }
        let closed = self.largest_residual() <= 1e-10 * length;
        let left = (position - self.at.target.translation.vector).norm();
        closed.then_some(left)
    }

    /// Moves along free motions, irregularly, the same every time, and closes again.
    fn beside(&mut self, by: f64, round: usize) -> Option<()> {
        let (_, free) = self.freedoms()?;
        let k = free.all.ncols();
        let amount = |j: usize| ((round * 7 + j + 1) as f64 * 0.618_034).fract() - 0.5;
        let step = &free.all * DVector::from_fn(k, |j, _| by * self.length * amount(j));
        self.go(&step);
        for _ in 0..STEPS {
            let (closing, _) = self.freedoms()?;
            self.go(&closing);
            if largest(&closing) <= 1e-13 * self.length {
                break;
            }
        }
        (self.largest_residual() <= 1e-10 * self.length).then_some(())
    }
}

impl Mechanism {
    /// The posture with the tool's reference point at `position` (m, base axes) whose rotation from
    /// the orientation `wanted` (base from tool) is least. From another posture, that of a neighbour on a path, joints
    /// and orientation change no more than they have to.
    pub(crate) fn posture_following(
        &self,
        position: &Vector3<f64>,
        wanted: &UnitQuaternion<f64>,
        near: Option<&Posture>,
    ) -> Result<Posture> {
        self.check_following(position, wanted)?;
        if let Some(near) = near {
            let near = self.posture_from_joints(near.target(), near.limbs().to_vec())?;
            match self.followed(&near, position, wanted) {
                Err(Error::Unreachable { .. }) => {}
                answer => return answer,
            }
        }
        let home = self.posture_at_pose(&self.platforms()[self.tool()].home, None)?;
        self.followed(&home, position, wanted)
    }

    /// Follows like [`Self::posture_following`], along the straight line from the other posture and no other.
    pub(crate) fn posture_following_straight(
        &self,
        position: &Vector3<f64>,
        wanted: &UnitQuaternion<f64>,
        near: &Posture,
    ) -> Result<Posture> {
        self.check_following(position, wanted)?;
        let start = self.posture_from_joints(near.target(), near.limbs().to_vec())?;
        match by_continuation(&start, position, wanted) {
            Some((found, left)) if left <= 1e-10 * self.scale().length => {
                self.taken(found, left, position)
            }
            Some((found, _)) => Err(self.too_far(&found, position, wanted)),
            None => Err(self.too_far(&start, position, wanted)),
        }
    }

    fn too_far(
        &self,
        found: &Posture,
        position: &Vector3<f64>,
        wanted: &UnitQuaternion<f64>,
    ) -> Error {
        let away = position - found.target.translation.vector;
        let left = away.norm();
        let outside = surface_normal(found).filter(|n| away.dot(n).abs() > 0.99 * left);
        let place = match outside {
            Some(normal) => format!(
                ", whose tool point stays in a surface (here square to {}) that the target lies outside of",
                axis_description(&normal)
            ),
            None => " with whatever orientation of its tool".to_owned(),
        };
        let place = self.place().with_detail(place);
        Error::Unreachable {
            place,
            distance_m: left,
            angle_rad: wanted.angle_to(&found.target.rotation),
            nearest: Box::new(found.target),
        }
    }

    fn check_following(&self, position: &Vector3<f64>, wanted: &UnitQuaternion<f64>) -> Result<()> {
        let mut numbers = position.iter().chain(wanted.coords.iter()).copied();
        match numbers.find(|x| !x.is_finite()) {
            None => Ok(()),
            Some(value) => Err(Error::NotFinite {
                place: self.place(),
                what: "the place that is requested".into(),
                value,
            }),
        }
    }

    fn followed(
        &self,
        start: &Posture,
        position: &Vector3<f64>,
        wanted: &UnitQuaternion<f64>,
    ) -> Result<Posture> {
        let (found, left) = self.followed_to_nearest(start, position, wanted)?;
        if left <= 1e-10 * self.scale().length {
            return Ok(found);
        }
        Err(self.too_far(&found, position, wanted))
    }

    /// The posture at the position, or nearest to it, and the distance left (m).
    pub(crate) fn followed_to_nearest(
        &self,
        start: &Posture,
        position: &Vector3<f64>,
        wanted: &UnitQuaternion<f64>,
    ) -> Result<(Posture, f64)> {
        let length = self.scale().length;
        let start = self.posture_from_joints(start.target(), start.limbs().to_vec())?;
        let reached = 1e-10 * length;
        let mut best: Option<(Posture, f64)> = None;
        // Straight there in small steps; and where a singular start hides the path, from beside it.
        let first = by_continuation(&start, position, wanted);
        let beside = (0..6).filter_map(|round| {
            let mut search = LostMotionSearch::new(&start);
            search.beside(0.1 * (1 + round) as f64, round)?;
            let beside = search.at;
            by_continuation(&beside, position, wanted)
        });
        for (found, left) in first.into_iter().chain(beside) {
            if best.as_ref().is_none_or(|(_, least)| left < *least) {
                best = Some((found, left));
            }
            if best.as_ref().is_some_and(|(_, left)| *left <= reached) {
                break;
            }
        }
        let Some((found, left)) = best else {
            return Err(self.too_far(&start, position, wanted));
        };
        Ok((self.taken(found, left, position)?, left))
    }

    /// Completes a posture that was found at (or `left` beside) a position.
    fn taken(&self, mut found: Posture, left: f64, position: &Vector3<f64>) -> Result<Posture> {
        if left <= 1e-10 * self.scale().length {
            found.target.translation.vector = *position;
            found.platforms[self.tool()] = found.target;
        }
        for (limb, joints) in self.limbs().iter().zip(&mut found.limbs) {
            wrap(&limb.nominal, joints);
        }
        let target = found.target;
        // Redundant joints as in every other posture.
        self.posture_at_pose(&target, Some(&found)).or_else(|_| {
            let limbs = found.limbs.clone();
            let same = self.posture_from_joints(&target, limbs);
            same.map(|mut same| {
                same.platforms.clone_from(&found.platforms);
                same
            })
        })
    }

    /// The tool cannot be moved everywhere that it goes with its orientation held: fewer motions
    /// without rotation than directions that its reference point can move in. Counted beside home,
    /// which may be singular; false where home cannot be reached, for nothing is known there. A place of such a machine is requested by
    /// [`PostureRequest::position`](crate::machine::PostureRequest::position).
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let drive = |stiffness, limits| ActuatorSpec {
    /// #     limits: Some(limits), // rad
    /// #     home: 0.5,
    /// #     ..ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness) // N m/rad
    /// # };
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", drive(2e5, (-2.0, 2.0)))
    /// #     .translation(vector![0.6, 0.0, 0.0])
    /// #     .actuator("elbow", drive(1e5, (0.2, 2.5)))
    /// #     .translation(vector![0.5, 0.0, 0.0])
    /// #     .build()?;
    /// # let turn = Pose::rotation(vector![0.0, 0.0, 0.5]); // rad: both joints at home
    /// # let home = turn * Pose::translation(0.6, 0.0, 0.0) * turn * Pose::translation(0.5, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// assert!(arm.turns_as_it_moves(), "two hinges take the tool's orientation along");
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry").actuator("x", slide(Vector3::x())).actuator("y", slide(Vector3::y()));
    /// # let gantry = Mechanism::serial(chain.build()?, Pose::identity(), Vector3::zeros())?;
    /// assert!(!gantry.turns_as_it_moves(), "two slides do not");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn turns_as_it_moves(&self) -> bool {
        let Ok(home) = self.posture_at_pose(&self.platforms()[self.tool()].home, None) else {
            return false;
        };
        let turns = |round: usize| {
            let mut search = LostMotionSearch::new(&home);
            search.beside(0.05, round)?;
            let (_, free) = search.freedoms()?;
            let (_, pure) = nearest(&free.rotation, &DVector::zeros(3))?;
            Some(rank(&(&free.position * pure)) < rank(&free.position))
        };
        (0..3).filter_map(turns).next().unwrap_or(false)
    }
}

/// Steps of the position along the straight path; where it ends, and the distance left.
fn by_continuation(
    start: &Posture,
    position: &Vector3<f64>,
    wanted: &UnitQuaternion<f64>,
) -> Option<(Posture, f64)> {
    let length = start.mechanism.scale().length;
    let from = start.target.translation.vector;
    let path = position - from;
    let steps = (path.norm() / (STRIDE * length)).ceil().clamp(1.0, 1e4);
    let (mut at, mut share, mut step) = (start.clone(), 0.0_f64, 1.0 / steps);
    let mut answer = None;
    while share < 1.0 {
        let next = (share + step).min(1.0);
        let place = if next == 1.0 {
            *position
        } else {
            from + path * next
        };
        let mut search = LostMotionSearch::new(&at);
        let left = search.follow(&place, wanted);
        let found = search.at;
        if left.is_some_and(|left| left <= 1e-10 * length) {
            (at, share) = (found, next);
            answer = left;
            step = (1.5 * step).min(1.0 / steps);
            continue;
        }
        step *= 0.5;
        if step * steps < 0.1 {
            // Nearest point to the position from here on.
            let mut search = LostMotionSearch::new(&at);
            let left = search.follow(position, wanted)?;
            return Some((search.at, left));
        }
    }
    if answer.is_none() {
        // No path at all.
        let mut search = LostMotionSearch::new(&at);
        let left = search.follow(position, wanted)?;
        return Some((search.at, left));
    }
    answer.map(|left| (at, left))
}

impl Posture {
    /// Directions in which the machine can move the tool's reference point (columns, base axes).
    pub(crate) fn position_freedoms(&self) -> DMatrix<f64> {
        let search = LostMotionSearch::new(self);
        let Some((_, free)) = search.freedoms() else {
            return DMatrix::zeros(3, 0);
        };
        let eigen = (&free.position * free.position.transpose()).symmetric_eigen();
        let kept: Vec<usize> = (0..3)
            .filter(|&k| eigen.eigenvalues[k] > CORRECTS * CORRECTS)
            .collect();
        eigen.eigenvectors.select_columns(&kept)
    }
}
