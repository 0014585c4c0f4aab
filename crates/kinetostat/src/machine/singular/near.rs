//! Distance and direction of a posture from a singular one [R 5.5.3].
//!
//! Two kinds: the locked actuators and the limbs do not hold the machine any more (a motion is
//! gained, the stiffness has a free direction), or a limb cannot make a motion that it can make
//! elsewhere (a motion is lost, commands grow without bound). The measure of both is a singular
//! value of a matrix of joint axes, rotations at the natural length; springs play no part.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::motion_description;
use crate::error::Result;
use crate::linalg::singular_values::SingularValues;
use crate::linalg::sparse::largest;
use crate::machine::constraints::Constraints;
use crate::machine::posture::Posture;
use crate::machine::singular::lost_motion::{LostMotionSearch, solve};
use crate::number;
use crate::number::smaller;
use crate::spatial::{Pose, Twist, moved, pose_residual};

/// Kind of a singular posture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SingularityKind {
    /// A motion that neither actuators nor limbs hold.
    Gained,
    /// A motion that a limb cannot make.
    Lost,
}

/// A singular posture near a posture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NearSingularity {
    /// Gained or lost.
    pub kind: SingularityKind,
    /// The limb that loses the motion.
    pub limb: Option<String>,
    /// Smallest singular value that is not always zero, as a share of the largest: 0 is singular.
    pub share: f64,
    /// Motion of the tool to the singular posture, base axes, its longest part 1 m (rotations at the
    /// natural length). For a motion gained the steepest descent of the singular value, for one lost
    /// the least motion (sum of squares) that ends where it is lost. Zero at a singular posture.
    pub towards: Twist,
    /// Distance of the singular posture in that direction, m (rotations at the natural length).
    pub distance_m: f64,
    /// The singular posture was found; if not, the distance is a first-order estimate, singular value
    /// by its slope.
    pub followed: bool,
    /// The motion gained (of the tool; zero if only platforms in between move) or lost there (of
    /// the limb's tip), base axes, longest part 1 m.
    pub motion: Twist,
}

impl NearSingularity {
    /// One sentence.
    #[must_use]
    pub fn description(&self) -> String {
        let motion = if self.motion.0.norm() == 0.0 {
            "moves platforms between base and tool".to_owned()
        } else {
            motion_description(&mainly(&self.motion))
        };
        let what = match (&self.kind, &self.limb) {
            (SingularityKind::Lost, Some(limb)) => {
                format!("limb '{limb}' loses a motion: nothing {motion}")
            }
            _ => format!("a motion is gained that no actuator holds: {motion}"),
        };
        if self.distance_m == 0.0 {
            return format!("singular posture: {what}");
        }
        let motion_there = motion_description(&mainly(&self.towards));
        let how = if self.followed {
            "found by following that way"
        } else {
            "a first-order estimate"
        };
        format!(
            "a singular posture is {} away ({how}) if the tool {motion_there}; there {what}",
            number::length(self.distance_m * 1e3, 5, number::Rounding::Nearest)
        )
    }
}

/// A motion for a sentence: without parts that are a hundredth of what is left (translations against
/// rotations at one metre, which only decides what is worth a word).
fn mainly(motion: &Twist) -> Twist {
    let (v, w) = (motion.linear(), motion.angular());
    let cut = |part: nalgebra::Vector3<f64>, other: f64| match part.norm() < 0.01 * other {
        true => nalgebra::Vector3::zeros(),
        false => part,
    };
    Twist::new(cut(v, w.norm()), cut(w, v.norm()))
}

/// Postures beside one, along motions of its joints: of machines whose tool cannot move straight on.
struct Beside<'p> {
    start: LostMotionSearch<'p>,
    /// Free motions of all joints and platforms, and what they do to the tool, scaled.
    free: DMatrix<f64>,
    moves: SingularValues,
}

/// Steps until all limbs close again.
const CLOSING_STEPS: usize = 30;

impl<'p> Beside<'p> {
    fn of(posture: &'p Posture) -> Option<Self> {
        let start = LostMotionSearch::new(posture);
        let (closure, residuals) = start.closure();
        let (_, free) = solve(&closure, &DVector::zeros(residuals.len()))?;
        let moves = free.rows(start.tool(), 6).into_owned();
        let moves = (!moves.is_empty()).then(|| SingularValues::of(&moves))?;
        Some(Self { start, free, moves })
    }

    /// Posture after a motion of the tool along a twist, but for additional rotations; `None` where it went elsewhere.
    fn at(&self, twist: &Vector6<f64>) -> Option<Posture> {
        let mut search = self.start.again();
        let length = search.length;
        let scaled =
            |t: &Vector6<f64>| DVector::from_fn(6, |i, _| t[i] * if i < 3 { 1.0 } else { length });
        let wanted = scaled(twist);
        let small = 1e-6 * self.moves.largest();
        search.go(&(&self.free * self.moves.shortest(&wanted, small)));
        for _ in 0..CLOSING_STEPS {
            let (closure, residuals) = search.closure();
            if largest(&residuals) <= 1e-12 * length {
                let gone = pose_residual(&search.at.target, &self.start.at.target);
                let off = (scaled(&gone.0) - &wanted).norm();
                return (off <= 0.5 * wanted.norm()).then_some(search.at);
            }
            let (closing, _) = solve(&closure, &residuals)?;
            if closing.iter().any(|x| !x.is_finite()) || closing.amax() > length {
                return None;
            }
            search.go(&closing);
        }
        None
    }
}

/// Singular values of one matrix of a posture, falling, and the motion of the last ones.
#[derive(Default)]
struct Measure {
    values: Vec<f64>,
    motions: Vec<Vector6<f64>>,
}

impl Posture {
    /// Singular postures at most `within_m` (m; rotations at the natural length) away, the nearest
    /// first; per limb the nearest that is found from its smallest singular values. Only ways that
    /// the nominal machine can go are looked at.
    ///
    /// # Errors
    /// None but those of the inverse kinematics where the posture itself does not close.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
    /// #     .build()?;
    /// # let home = Pose::translation(0.4, 0.0, 0.0);
    /// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let near = gantry.posture(&home)?.near_singularities(0.1)?;
    /// assert!(near.is_empty(), "slides at right angles never lose a motion");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn near_singularities(&self, within_m: f64) -> Result<Vec<NearSingularity>> {
        let length = self.mechanism.scale().length;
        let mut list: Vec<NearSingularity> = self.motion_gained(within_m).into_iter().collect();
        list.extend(self.lost_motions(within_m).into_iter().map(|lost| {
            let far = longest_part(&lost.towards, length);
            // Joints at a border of the workspace are known to the root of rounding.
            let here = far <= 1e-10 * length;
            NearSingularity {
                kind: SingularityKind::Lost,
                limb: Some(self.mechanism.limbs()[lost.limb].name.clone()),
                share: if here { 0.0 } else { lost.share },
                towards: Twist(if here {
                    Vector6::zeros()
                } else {
                    normal(&(lost.towards / far), length)
                }),
                distance_m: if here { 0.0 } else { far },
                followed: lost.followed,
                motion: Twist(normal(&lost.motion, length)),
            }
        }));
        list.sort_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        Ok(list)
    }

    /// The nearest posture at most `within_m` (to first order) away where the locked machine gains a
    /// motion, on the way of steepest descent.
    pub(crate) fn motion_gained(&self, within_m: f64) -> Option<NearSingularity> {
        let length = self.mechanism.scale().length;
        // Includes motions that actuators do not drive: at a singular posture they drive less.
        let basis = self.mobility();
        let directions: Vec<Vector6<f64>> = basis
            .column_iter()
            .map(|c| Vector6::from_fn(|i, _| if i < 3 { c[i] } else { c[i] / length }))
            .collect();
        let step = 1e-4 * length;
        let straight = |twist: &Vector6<f64>| -> Option<Measure> {
            let target: Pose = moved(&self.target, &Twist(*twist));
            let there = self.mechanism.posture_at_pose(&target, Some(self)).ok()?;
            Some(there.locked())
        };
        // A tool that turns as it moves leaves the straight way on both sides.
        let leaves = |direction: &Vector6<f64>| {
            straight(&(direction * step)).is_none() && straight(&(direction * -step)).is_none()
        };
        let beside = directions
            .iter()
            .any(leaves)
            .then(|| Beside::of(self))
            .flatten();
        let at = |twist: &Vector6<f64>| match &beside {
            Some(beside) => Some(beside.at(twist)?.locked()),
            None => straight(twist),
        };
        let here = self.locked();
        // The rank is that of postures around this one: their nonzero values count here.
        let mut rank = here.rank();
        for k in 0..3_usize {
            let mut twist = Vector6::zeros();
            for (j, direction) in directions.iter().enumerate() {
                let share = ((k * 5 + j + 1) as f64 * 0.618_034).fract() - 0.5;
                twist += direction * (0.06 * length * share);
            }
            rank = rank.max(at(&twist).map_or(0, |other| other.rank()));
        }
        let last = rank.checked_sub(1)?;
        let around: Vec<[Option<Measure>; 2]> = directions
            .iter()
            .map(|direction| [at(&(direction * step)), at(&(direction * -step))])
            .collect();
        // If the machine has fewer motions here, those that it has elsewhere are lost.
        let valued = |m: &Measure| m.values.get(last).copied().unwrap_or(0.0);
        let most = here.values.first().copied().unwrap_or(0.0);
        let value = valued(&here);
        let mut slope = DVector::zeros(directions.len());
        for (k, pair) in around.iter().enumerate() {
            let one = |m: &Option<Measure>| m.as_ref().map(valued);
            slope[k] = match (one(&pair[0]), one(&pair[1])) {
                (Some(a), Some(b)) => (a - b) / (2.0 * step),
                (Some(a), None) => (a - value) / step,
                (None, Some(b)) => (value - b) / step,
                (None, None) => 0.0,
            };
        }
        let singular = value <= 1e-8 * most;
        let first = if singular { 0.0 } else { value / slope.norm() };
        if first > within_m || first.is_nan() {
            return None;
        }
        let mut descent = Vector6::zeros();
        if !singular {
            for (k, w) in directions.iter().enumerate() {
                descent -= w * (slope[k] / slope.norm());
            }
        }
        let found = (!singular)
            .then(|| {
                let along = |s: f64| Some(at(&(descent * s))?.values[last].powi(2));
                follow(value * value, first, &along)
            })
            .flatten();
        // Gained and always free motions cannot be told apart at a singular posture, but nearby.
        let near = around.iter().flatten().flatten();
        let near = near.max_by(|a, b| a.values[last].total_cmp(&b.values[last]));
        let motion = match near {
            Some(near) if singular => &near.motions[last],
            _ => &here.motions[last],
        };
        Some(NearSingularity {
            kind: SingularityKind::Gained,
            limb: None,
            share: if singular { 0.0 } else { value / most },
            distance_m: found.unwrap_or(first) * longest_part(&descent, length),
            followed: singular || found.is_some(),
            towards: Twist(normal(&descent, length)),
            motion: Twist(normal(motion, length)),
        })
    }

    /// The machine with its actuators locked.
    fn locked(&self) -> Measure {
        let m = &self.mechanism;
        let length = m.scale().length;
        let tool = 6 * (m.tool() - 1);
        let rows = Constraints::new(self, false).rows;
        Measure::of(rows.transpose(), |v| {
            Vector6::from_fn(|i, _| v[tool + i] / if i < 3 { 1.0 } else { length })
        })
    }
}

impl Measure {
    /// Measures by the left singular vectors.
    fn of(matrix: DMatrix<f64>, motion: impl Fn(&DVector<f64>) -> Vector6<f64>) -> Self {
        let mut own = Self::default();
        if matrix.is_empty() || matrix.iter().any(|x| !x.is_finite()) {
            return own;
        }
        let found = SingularValues::of(&matrix);
        for column in found.left.column_iter() {
            own.motions.push(motion(&column.into_owned()));
        }
        own.values = found.values;
        own
    }

    fn rank(&self) -> usize {
        let most = self.values.first().copied().unwrap_or(0.0);
        self.values.iter().filter(|v| **v > 1e-8 * most).count()
    }
}

fn longest_part(twist: &Vector6<f64>, length: f64) -> f64 {
    let (v, w) = (twist.fixed_rows::<3>(0), twist.fixed_rows::<3>(3));
    v.norm().max(w.norm() * length)
}

/// Longest part 1 m, rounding left out.
fn normal(twist: &Vector6<f64>, length: f64) -> Vector6<f64> {
    let size = longest_part(twist, length);
    if size < 1e-9 {
        return Vector6::zeros();
    }
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    Vector6::from_fn(|i, _| {
        let x = twist[i] / size;
        if x.abs() * unit(i) < 1e-6 { 0.0 } else { x }
    })
}

/// Zero of the squared singular value near `first`: parabolas through three points. `None` if it has none there.
fn follow(start: f64, first: f64, square: &dyn Fn(f64) -> Option<f64>) -> Option<f64> {
    let mut points = vec![(0.0, start)];
    for s in [0.5 * first, first] {
        points.push((s, square(s)?));
    }
    let mut estimate = first;
    for _ in 0..12 {
        let [(a, fa), (b, fb), (c, fc)] = points[..] else {
            break;
        };
        let (d1, d2) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
        let curvature = (d2 - d1) / (c - a);
        if curvature <= 0.0 {
            break;
        }
        let next = 0.5 * (a + b) - 0.5 * d1 / curvature;
        if !(0.0..=4.0 * first).contains(&next) {
            break;
        }
        estimate = next;
        // Joints may not be found where the posture is all but singular: then a little off it.
        let near = [0.0, 1e-4, -1e-4, 1e-3, -1e-3, 1e-2, -1e-2].into_iter();
        let mut near = near.map(|share| next + share * first);
        let Some((next, value)) = near.find_map(|s| Some((s, square(s)?))) else {
            break;
        };
        if value <= 1e-14 * start {
            return Some(next);
        }
        if points.iter().any(|(s, _)| (s - next).abs() <= 1e-9 * first) {
            return (value <= 1e-4 * start).then_some(estimate);
        }
        // The worst of the three goes.
        let worst = (0..3).max_by(|&i, &j| points[i].1.total_cmp(&points[j].1))?;
        points[worst] = (next, value);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let least = points.iter().map(|p| p.1).fold(f64::INFINITY, smaller);
    (least <= 1e-4 * start).then_some(estimate)
}
