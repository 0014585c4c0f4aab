//! Selection of the points that are kept for plots: the envelope of every quantity that a result states.

use crate::result::point::{PointKind, PointResult, size};

/// Points that are kept for every stretch of the path: its first one, and those with the largest and the
/// smallest error before and after.
const PER_STRETCH: usize = 5;

/// Indices of at most `most` points (more only if `always` asks for more), in order: `always`, both ends,
/// the worst of the whole path in everything that the summary states, and the envelope of the errors
/// before and after in equal stretches.
#[must_use]
pub fn thinned(points: &[PointResult], always: &[usize], most: usize) -> Vec<usize> {
    if points.len() <= most {
        return (0..points.len()).collect();
    }
    let mut first: Vec<usize> = always.to_vec();
    first.extend([0, points.len() - 1]);
    first.extend(extremes(points));
    first.sort_unstable();
    first.dedup();
    let stretches = (most.saturating_sub(first.len()) / PER_STRETCH).max(1);
    let length = points.len().div_ceil(stretches);
    let mut keep = vec![false; points.len()];
    let mut add = |index: usize| keep[index] = true;
    first.into_iter().for_each(&mut add);
    for (number, stretch) in points.chunks(length).enumerate() {
        let at = number * length;
        add(at);
        let before = |p: &PointResult| size(&p.error_before_mm);
        let after = |p: &PointResult| size(&p.error_after_mm);
        for found in [
            farthest(stretch, before),
            farthest(stretch, |p| -before(p)),
            farthest(stretch, after),
            farthest(stretch, |p| -after(p)),
        ] {
            found.into_iter().for_each(|index| add(at + index));
        }
    }
    (0..points.len()).filter(|index| keep[*index]).collect()
}

/// Indices of the points from which the figures of a summary are taken.
fn extremes(points: &[PointResult]) -> Vec<usize> {
    let mut found: Vec<Option<(usize, f64)>> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        for (figure, value) in extreme_values(point).enumerate() {
            if figure >= found.len() {
                found.resize(figure + 1, None);
            }
            let larger = found[figure].is_none_or(|(_, most)| value > most);
            if larger && !value.is_nan() {
                found[figure] = Some((index, value));
            }
        }
    }
    found
        .into_iter()
        .flatten()
        .map(|(index, _)| index)
        .collect()
}

/// Values whose maximum a summary states, off rapids, and the stability of the machine; NaN if a point has no such value.
pub(crate) fn extreme_values(p: &PointResult) -> impl Iterator<Item = f64> + '_ {
    let off_rapids = move |value: f64| match p.kind {
        PointKind::Rapid => f64::NAN,
        _ => value,
    };
    let of_all = [
        size(&p.error_before_mm),
        match p.kind.is_step() {
            true => f64::NAN,
            false => size(&p.error_before_mm),
        },
        size(&p.error_after_mm),
        size(&p.correction_mm),
        p.residual_rotation_deg,
        -p.smallest_stiffness_n_per_mm,
        p.share_to_buckling.unwrap_or(f64::NAN),
        p.nearest_limit.map_or(f64::NAN, |l| -l.distance),
        p.most_loaded.map_or(f64::NAN, |d| d.share_of_rating),
    ];
    let unstable = if p.stable { f64::NAN } else { 1.0 };
    let of_actuators = p.actuator_force.iter().chain(&p.actuator_correction);
    of_all
        .into_iter()
        .chain(of_actuators.map(|x| x.abs()))
        .map(off_rapids)
        .chain([unstable])
}

/// The cutting point with the largest value; NaN is passed over.
fn farthest(points: &[PointResult], value: impl Fn(&PointResult) -> f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, point) in points.iter().enumerate() {
        let value = value(point);
        let larger = best.is_none_or(|(_, most)| value > most);
        if point.kind != PointKind::Rapid && larger && !value.is_nan() {
            best = Some((index, value));
        }
    }
    best.map(|(index, _)| index)
}

/// Places that are listed as the worst.
const MOST_WORST: usize = 10;

/// Indices of the worst points before compensation, at most ten, not two from one line or from
/// neighbouring ones.
pub(crate) fn worst(points: &[PointResult]) -> Vec<usize> {
    let programmed = |i: &usize| !points[*i].kind.is_step();
    let cutting = |i: &usize| points[*i].kind == PointKind::Feed;
    let mut order: Vec<usize> = (0..points.len()).filter(cutting).collect();
    if order.is_empty() {
        order = (0..points.len()).filter(programmed).collect();
    }
    order.sort_by(|&i, &j| {
        size(&points[j].error_before_mm)
            .total_cmp(&size(&points[i].error_before_mm))
            .then(i.cmp(&j))
    });
    let mut chosen: Vec<usize> = Vec::new();
    let reach = points.last().map_or(0.0, |p| p.path_mm) / 50.0;
    for i in order {
        let apart = chosen.iter().all(|&j| {
            points[i].line != points[j].line
                && (points[i].path_mm - points[j].path_mm).abs() > reach
        });
        if apart {
            chosen.push(i);
        }
        if chosen.len() == MOST_WORST {
            break;
        }
    }
    chosen
}

/// Indices of the points that are farthest off along a written program, worst first: at most ten, one of a line of it, none on rapids.
#[must_use]
pub fn farthest_off(points: &[PointResult]) -> Vec<usize> {
    let cut = |i: &usize| points[*i].kind != PointKind::Rapid;
    let mut order: Vec<usize> = (0..points.len()).filter(cut).collect();
    order.sort_by(|&i, &j| points[j].off_mm().total_cmp(&points[i].off_mm()));
    let mut chosen: Vec<usize> = Vec::new();
    for i in order {
        if chosen.len() == MOST_WORST {
            break;
        }
        let line = points[i].output_line;
        if chosen.iter().all(|&j| points[j].output_line != line) {
            chosen.push(i);
        }
    }
    chosen
}

/// Content of a stretch of the path.
///
/// When the path leaves the last stretch, two neighbours become one and all are twice as long. The content of a stretch
/// depends on the points in it alone, not on when they came: a path that is gathered in parts gives the same stretches.
pub(crate) trait Joins: Default {
    /// Takes up what the next stretch has.
    fn join(&mut self, next: Self);
}

/// The stretches that the path has reached.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stretches<T> {
    most: usize,
    width_mm: f64,
    reached: Vec<T>,
}

/// Length of a stretch at first, mm: less than between two points of any program, and a power of two, so that twice as long is exact.
const FINEST_MM: f64 = 1.0 / 1024.0;

impl<T: Joins> Stretches<T> {
    /// Creates an empty path of at most `most` stretches, two at least; at the end there are more than half as many, or the path is shorter
    /// than `most` times 1/1024 mm.
    pub(crate) fn new(most: usize) -> Self {
        Self {
            most: most.max(2),
            width_mm: FINEST_MM,
            reached: Vec::new(),
        }
    }

    /// The stretch at a length of path, mm; a length that is no number belongs to the last one reached.
    pub(crate) fn at(&mut self, path_mm: f64) -> &mut T {
        let index = self.index_of(path_mm);
        if index >= self.reached.len() {
            self.reached.resize_with(index + 1, T::default);
        }
        &mut self.reached[index]
    }

    /// The stretches from one length of path to another, each with the length of its part of that way, mm.
    pub(crate) fn between(&mut self, from_mm: f64, to_mm: f64, mut each: impl FnMut(&mut T, f64)) {
        if !(to_mm > from_mm && from_mm.is_finite() && to_mm.is_finite()) {
            return;
        }
        // The end first: it may make the stretches longer.
        let last = self.index_of(to_mm);
        let first = self.index_of(from_mm);
        if last >= self.reached.len() {
            self.reached.resize_with(last + 1, T::default);
        }
        let width = self.width_mm;
        for (i, stretch) in (first..=last).zip(&mut self.reached[first..=last]) {
            let (start, end) = (i as f64 * width, (i as f64 + 1.0) * width);
            each(stretch, to_mm.min(end) - from_mm.max(start));
        }
    }

    fn index_of(&mut self, path_mm: f64) -> usize {
        if !path_mm.is_finite() {
            return self.reached.len().saturating_sub(1);
        }
        while path_mm / self.width_mm >= self.most as f64 {
            self.join_neighbours();
        }
        // Below zero is zero.
        (path_mm / self.width_mm) as usize
    }

    fn join_neighbours(&mut self) {
        self.width_mm *= 2.0;
        let mut fine = std::mem::take(&mut self.reached).into_iter();
        while let Some(mut first) = fine.next() {
            if let Some(second) = fine.next() {
                first.join(second);
            }
            self.reached.push(first);
        }
    }

    /// Length of every stretch, mm.
    pub(crate) fn width_mm(&self) -> f64 {
        self.width_mm
    }

    /// All stretches that were reached, in the order of the path, the first from zero on.
    pub(crate) fn reached(&self) -> &[T] {
        &self.reached
    }
}
