//! The points of a run that are kept: the worst before and after compensation, those that the summary is taken from, and some of
//! every stretch of the path. They are taken one after the other; the memory does not grow with the program.

use crate::result::point::{PointKind, PointResult, size};
use crate::result::selection::{Joins, Stretches, extreme_values, farthest_off, worst};

/// A point with its number in the order of the path.
type Numbered = (usize, PointResult);

/// Points that are kept for a stretch.
const PER_STRETCH: usize = 6;

/// Room for the points from which figures of the summary are taken.
const FOR_SUMMARY: usize = 100;

/// The points with the largest values that were seen for each of some figures; the first one of equal ones, NaN is passed over.
#[derive(Clone, Debug, Default, PartialEq)]
struct Largest(Vec<Option<(f64, Numbered)>>);

impl Largest {
    fn note(&mut self, index: usize, value: f64, number: usize, point: &PointResult) {
        if index >= self.0.len() {
            self.0.resize(index + 1, None);
        }
        let slot = &mut self.0[index];
        if !value.is_nan() && slot.as_ref().is_none_or(|(most, _)| value > *most) {
            *slot = Some((value, (number, point.clone())));
        }
    }

    fn points(&self) -> impl Iterator<Item = &Numbered> {
        self.0.iter().flatten().map(|(_, numbered)| numbered)
    }
}

impl Joins for Largest {
    fn join(&mut self, next: Self) {
        for (index, later) in next.0.into_iter().enumerate() {
            if index >= self.0.len() {
                self.0.resize(index + 1, None);
            }
            let own = &mut self.0[index];
            let larger = match (&own, &later) {
                (Some((own, _)), Some((later, _))) => later > own,
                (None, _) => true,
                (_, None) => false,
            };
            if larger {
                *own = later;
            }
        }
    }
}

/// Values for a stretch, in this order: its first point, the largest error before on a cutting move, and the largest and the
/// smallest error before and after off rapids.
fn of_stretch(number: usize, point: &PointResult) -> [f64; PER_STRETCH] {
    let (before, after) = (size(&point.error_before_mm), size(&point.error_after_mm));
    let off_rapids = |value: f64| match point.kind {
        PointKind::Rapid => f64::NAN,
        _ => value,
    };
    [
        -(number as f64),
        match point.kind {
            PointKind::Feed => before,
            _ => f64::NAN,
        },
        off_rapids(before),
        off_rapids(-before),
        off_rapids(after),
        off_rapids(-after),
    ]
}

/// Gathers the points of a run that are kept.
///
/// ```
/// use kinetostat_machining::{KeptPoints, PointResult};
///
/// let mut kept = KeptPoints::new(1000);
/// for i in 0..100_000 {
///     let mut point = PointResult::default();
///     point.line = i + 1;
///     point.path_mm = i as f64;
///     point.error_before_mm = [if i == 54_321 { 2.0 } else { 1.0 }, 0.0, 0.0];
///     kept.add(&point);
/// }
/// assert_eq!(kept.worst_before()[0].line, 54_322);
/// assert!(kept.points().len() <= 1000);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct KeptPoints {
    most: usize,
    seen: usize,
    /// All points, as long as there are no more than are kept anyway.
    all: Vec<PointResult>,
    stretches: Stretches<Largest>,
    summary: Largest,
    last: Option<Numbered>,
}

impl KeptPoints {
    /// Keeps at most so many points, or about a hundred for a machine with many actuators where that is more.
    #[must_use]
    pub fn new(most: usize) -> Self {
        let stretches = most.saturating_sub(FOR_SUMMARY) / PER_STRETCH;
        Self {
            most,
            seen: 0,
            all: Vec::new(),
            stretches: Stretches::new(stretches),
            summary: Largest::default(),
            last: None,
        }
    }

    /// Takes the next point in the order of the path.
    pub fn add(&mut self, point: &PointResult) {
        if self.seen < self.most {
            self.all.push(point.clone());
        } else if self.seen == self.most {
            for (number, earlier) in std::mem::take(&mut self.all).iter().enumerate() {
                self.sort_in(number, earlier);
            }
        }
        if self.seen >= self.most {
            self.sort_in(self.seen, point);
        }
        self.seen += 1;
    }

    fn sort_in(&mut self, number: usize, point: &PointResult) {
        let stretch = self.stretches.at(point.path_mm);
        for (index, value) in of_stretch(number, point).into_iter().enumerate() {
            stretch.note(index, value, number, point);
        }
        for (index, value) in extreme_values(point).enumerate() {
            self.summary.note(index, value, number, point);
        }
        match &mut self.last {
            Some((last, kept)) => {
                *last = number;
                kept.clone_from(point);
            }
            None => self.last = Some((number, point.clone())),
        }
    }

    /// The points kept, in the order of the path: all of a short program.
    #[must_use]
    pub fn points(&self) -> Vec<PointResult> {
        if self.seen <= self.most {
            return self.all.clone();
        }
        let of_stretches = self.stretches.reached().iter().flat_map(Largest::points);
        let kept = of_stretches.chain(self.summary.points()).chain(&self.last);
        in_order(kept)
    }

    /// The places with the largest errors before compensation, worst first: at most ten, no two from one line or near each other. Of a long
    /// program one from a stretch of the path.
    #[must_use]
    pub fn worst_before(&self) -> Vec<PointResult> {
        let points = self.points();
        worst(&points)
            .into_iter()
            .map(|i| points[i].clone())
            .collect()
    }

    /// The places that are farthest off with the written program, worst first: at most ten, one of a line of it, none on rapids. Of a long program one
    /// from a stretch of the path.
    #[must_use]
    pub fn worst_after(&self) -> Vec<PointResult> {
        let points = self.points();
        let chosen = farthest_off(&points).into_iter();
        chosen.map(|i| points[i].clone()).collect()
    }
}

/// Each point once, by its number.
fn in_order<'p>(points: impl Iterator<Item = &'p Numbered>) -> Vec<PointResult> {
    let mut numbered: Vec<&Numbered> = points.collect();
    numbered.sort_by_key(|(number, _)| *number);
    numbered.dedup_by_key(|(number, _)| *number);
    numbered
        .into_iter()
        .map(|(_, point)| point.clone())
        .collect()
}

impl<'p> Extend<&'p PointResult> for KeptPoints {
    fn extend<I: IntoIterator<Item = &'p PointResult>>(&mut self, points: I) {
        points.into_iter().for_each(|point| self.add(point));
    }
}
