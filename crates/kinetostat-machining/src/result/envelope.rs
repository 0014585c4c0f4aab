//! The envelope of a run: the lowest and the highest value of every quantity in each stretch of the path, gathered from the points one after
//! the other. Its memory does not grow with the program.

use crate::result::point::{PointKind, PointResult, size};
use crate::result::selection::{Joins, Stretches};

/// A quantity that changes along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// Distance of the tool from its place without compensation, mm.
    ErrorBefore,
    /// Distance with the written program, mm.
    ErrorAfter,
    /// The distance with the written program if the force of the cut is larger or smaller by its spread, whichever is larger, mm.
    LargestErrorByForce,
    /// The smaller of these two distances, mm.
    SmallestErrorByForce,
    /// Stiffness in the softest direction, N/mm.
    SmallestStiffness,
    /// Share of the way to buckling, mu.
    ShareToBuckling,
    /// Force (N) or torque (N m) of an actuator.
    ActuatorForce(usize),
    /// Change of an actuator by the compensation, mm or deg.
    ActuatorCorrection(usize),
    /// Joint value of an actuator as commanded, mm or deg.
    ActuatorCommand(usize),
}

/// Quantities that any machine has.
const OF_ALL: [Quantity; 6] = [
    Quantity::ErrorBefore,
    Quantity::ErrorAfter,
    Quantity::LargestErrorByForce,
    Quantity::SmallestErrorByForce,
    Quantity::SmallestStiffness,
    Quantity::ShareToBuckling,
];

impl Quantity {
    /// Value at a point; `None` if the point has none, NaN if it is no number.
    #[must_use]
    pub fn of(self, point: &PointResult) -> Option<f64> {
        let by_force = || {
            Some((
                point.error_if_force_larger_mm?,
                point.error_if_force_smaller_mm?,
            ))
        };
        match self {
            Self::ErrorBefore => Some(size(&point.error_before_mm)),
            Self::ErrorAfter => Some(size(&point.error_after_mm)),
            Self::LargestErrorByForce => by_force().map(|(a, b)| if b > a { b } else { a }),
            Self::SmallestErrorByForce => by_force().map(|(a, b)| if b < a { b } else { a }),
            Self::SmallestStiffness => Some(point.smallest_stiffness_n_per_mm),
            Self::ShareToBuckling => point.share_to_buckling,
            Self::ActuatorForce(i) => point.actuator_force.get(i).copied(),
            Self::ActuatorCorrection(i) => point.actuator_correction.get(i).copied(),
            Self::ActuatorCommand(i) => point.actuator_command.get(i).copied(),
        }
    }

    /// Index of its range among those of a stretch.
    fn index(self) -> usize {
        let of_actuator = |i: usize, kind: usize| OF_ALL.len() + 3 * i + kind;
        match self {
            Self::ActuatorForce(i) => of_actuator(i, 0),
            Self::ActuatorCorrection(i) => of_actuator(i, 1),
            Self::ActuatorCommand(i) => of_actuator(i, 2),
            _ => OF_ALL.iter().position(|q| *q == self).unwrap_or(0),
        }
    }

    fn all(actuators: usize) -> impl Iterator<Item = Self> {
        let of_actuators = (0..actuators).flat_map(|i| {
            [
                Self::ActuatorForce(i),
                Self::ActuatorCorrection(i),
                Self::ActuatorCommand(i),
            ]
        });
        OF_ALL.into_iter().chain(of_actuators)
    }
}

/// Lowest and highest value of each quantity on cutting moves, and how much of the stretch is a rapid.
#[derive(Clone, Debug, Default, PartialEq)]
struct Ranges {
    ranges: Vec<Option<[f64; 2]>>,
    rapid_mm: f64,
}

impl Ranges {
    fn note(&mut self, point: &PointResult) {
        let actuators = point.actuator_force.len();
        for quantity in Quantity::all(actuators) {
            let value = quantity.of(point).filter(|value| value.is_finite());
            let Some(value) = value else { continue };
            self.widen(quantity.index(), [value, value]);
        }
    }

    fn widen(&mut self, index: usize, [low, high]: [f64; 2]) {
        if index >= self.ranges.len() {
            self.ranges.resize(index + 1, None);
        }
        self.ranges[index] = Some(match self.ranges[index] {
            Some([lowest, highest]) => [lowest.min(low), highest.max(high)],
            None => [low, high],
        });
    }
}

impl Joins for Ranges {
    fn join(&mut self, next: Self) {
        self.rapid_mm += next.rapid_mm;
        for (index, range) in next.ranges.into_iter().enumerate() {
            if let Some(range) = range {
                self.widen(index, range);
            }
        }
    }
}

/// A quantity in a stretch of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StretchRange {
    /// Start and end of the stretch, mm of the path.
    pub path_mm: [f64; 2],
    /// Lowest and highest value on cutting moves; `None` if there is none.
    pub range: Option<[f64; 2]>,
    /// True if more than half of the stretch is a rapid.
    pub rapid: bool,
}

/// The envelope of the points of a run, taken one after the other in the order of the path.
///
/// ```
/// use kinetostat_machining::{Envelope, PointResult, Quantity};
///
/// let mut envelope = Envelope::default();
/// for i in 0..100_000 {
///     let mut point = PointResult::default();
///     point.path_mm = 0.1 * f64::from(i);
///     point.error_before_mm = [f64::from(i % 7), 0.0, 0.0];
///     envelope.add(&point);
/// }
/// let stretches: Vec<_> = envelope.along(Quantity::ErrorBefore).collect();
/// assert!(stretches.len() <= Envelope::MOST_STRETCHES);
/// assert!(stretches.iter().all(|s| s.range == Some([0.0, 6.0])));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    stretches: Stretches<Ranges>,
    points: usize,
    /// Length of path at the last point, mm.
    reached_mm: f64,
}

impl Default for Envelope {
    fn default() -> Self {
        Self {
            stretches: Stretches::new(Self::MOST_STRETCHES),
            points: 0,
            reached_mm: 0.0,
        }
    }
}

impl Envelope {
    /// Maximum number of stretches that are kept: more than half as many are left, which is more than a picture has
    /// columns.
    pub const MOST_STRETCHES: usize = 2048;

    /// Takes the next point. Values that are not finite are skipped.
    pub fn add(&mut self, point: &PointResult) {
        self.points += 1;
        if point.kind == PointKind::Rapid {
            let note = |stretch: &mut Ranges, part_mm: f64| stretch.rapid_mm += part_mm;
            self.stretches.between(self.reached_mm, point.path_mm, note);
        } else {
            self.stretches.at(point.path_mm).note(point);
        }
        if point.path_mm.is_finite() {
            self.reached_mm = point.path_mm;
        }
    }

    /// Points taken.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// Length of the path, mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.reached_mm
    }

    /// A quantity along the path, stretch after stretch; the last one ends where the path ends.
    pub fn along(&self, quantity: Quantity) -> impl Iterator<Item = StretchRange> + '_ {
        let width = self.stretches.width_mm();
        let all = self.stretches.reached().iter().enumerate();
        all.map(move |(i, stretch)| {
            let start = i as f64 * width;
            let end = (start + width).min(self.reached_mm).max(start);
            StretchRange {
                path_mm: [start, end],
                range: stretch.ranges.get(quantity.index()).copied().flatten(),
                rapid: stretch.rapid_mm > 0.5 * (end - start),
            }
        })
    }
}

impl<'p> Extend<&'p PointResult> for Envelope {
    fn extend<I: IntoIterator<Item = &'p PointResult>>(&mut self, points: I) {
        points.into_iter().for_each(|point| self.add(point));
    }
}
