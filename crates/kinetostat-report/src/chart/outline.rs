//! Lines with thousands of points as short path data that looks the same, and dashed lines that lie on each other.

use std::fmt::Write as _;

use crate::svg::{Pixel, tenths, to_tenths};

/// Largest displacement of a line by omitted points, in pixels: less than half of its own width.
const TOLERANCE: f64 = 0.2;

/// Path data of a line through points; `None` lifts the pen.
pub(crate) fn path_data(points: &[Option<Pixel>]) -> String {
    let mut data = String::new();
    for run in points.split(Option::is_none) {
        let run: Vec<Pixel> = run.iter().flatten().copied().collect();
        write_run(&mut data, &simplified(&run));
    }
    data
}

/// Omits stretches that cover only places covered already: a pocket of a hundred thousand blocks has no more to show
/// than there are places on the drawing.
pub(crate) fn first_time(points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
    // Below this, everything is kept: short programs lose nothing.
    const MANY: usize = 4000;
    if points.len() < MANY {
        return points.to_vec();
    }
    let mut covered = Covered::default();
    let mut out: Vec<Option<Pixel>> = Vec::new();
    for run in points.split(Option::is_none) {
        let run: Vec<Pixel> = run.iter().flatten().copied().collect();
        // Otherwise the next stretch begins with a lift.
        let mut down = false;
        for stretch in stretches(&simplified(&run)) {
            let new = covered.adds(&stretch);
            if new {
                if !down {
                    out.extend([None, Some(stretch[0])]);
                }
                out.extend(stretch[1..].iter().copied().map(Some));
            }
            down = new;
        }
    }
    out
}

/// A line cut into stretches of this length, each from where the one before it ends.
fn stretches(points: &[Pixel]) -> Vec<Vec<Pixel>> {
    const LENGTH: f64 = 4.0;
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    let mut out = Vec::new();
    let (mut open, mut left) = (vec![first], LENGTH);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let segment = dx.hypot(dy);
            // Also where it is no number.
            if segment.partial_cmp(&left) != Some(std::cmp::Ordering::Greater) {
                left -= segment;
                open.push(to);
                break;
            }
            let share = left / segment;
            from = [from[0] + share * dx, from[1] + share * dy];
            open.push(from);
            out.push(std::mem::replace(&mut open, vec![from]));
            left = LENGTH;
        }
    }
    if open.len() > 1 || out.is_empty() {
        out.push(open);
    }
    out
}

/// Places on the drawing that have been drawn, with their neighbours.
#[derive(Default)]
struct Covered {
    cells: std::collections::BTreeSet<(i32, i32)>,
}

impl Covered {
    /// Size of places that are distinguished, pixels.
    const PLACE: f64 = 0.5;

    /// Draws a line; says whether it shows something new.
    fn adds(&mut self, line: &[Pixel]) -> bool {
        let mut own = Vec::new();
        let cell = |x: f64| (x / Self::PLACE).round() as i32;
        for (k, from) in line.iter().enumerate() {
            let to = line.get(k + 1).unwrap_or(from);
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let steps = (dx.hypot(dy) / Self::PLACE).ceil().clamp(1.0, 1e4) as usize;
            for step in 0..=steps {
                let share = step as f64 / steps as f64;
                own.push((cell(from[0] + share * dx), cell(from[1] + share * dy)));
            }
        }
        let new = own.iter().any(|place| !self.cells.contains(place));
        if new {
            for (x, y) in own {
                self.cells
                    .extend([(x, y), (x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]);
            }
        }
        new
    }
}

/// The envelope of a line over columns of pixels: of a column with many points its lowest and its highest
/// one stay, joined by a stroke, from the nearer end on. The drawn line covers the same pixels, however
/// many points there were; a pen that is lifted within a column is not. Points go from left to right.
pub(crate) fn per_column(points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
    /// Number of points of a column up to which all are kept.
    const FEW: usize = 4;
    let mut out: Vec<Option<Pixel>> = Vec::new();
    let mut rest = points;
    while let Some(first) = rest.iter().position(Option::is_some) {
        if first > 0 {
            out.push(None);
        }
        rest = &rest[first..];
        let column = |p: &Option<Pixel>| p.map(|p| p[0].floor());
        let here = column(&rest[0]);
        let end = rest.iter().position(|p| p.is_some() && column(p) != here);
        let end = end.unwrap_or(rest.len());
        // Lifts at the end of the column belong to what follows.
        let last = rest[..end].iter().rposition(Option::is_some).unwrap_or(0);
        let (own, after) = rest.split_at(last + 1);
        rest = after;
        let many: Vec<Pixel> = own.iter().flatten().copied().collect();
        if many.len() <= FEW {
            out.extend(own);
            continue;
        }
        let (low, high) = (extreme(&many, -1.0), extreme(&many, 1.0));
        let x = many[0][0].floor() + 0.5;
        let mut ends = [[x, many[low][1]], [x, many[high][1]]];
        if let Some(Some(before)) = out.last()
            && (before[1] - ends[1][1]).abs() < (before[1] - ends[0][1]).abs()
        {
            ends.reverse();
        }
        out.extend(ends.map(Some));
    }
    out
}

fn extreme(column: &[Pixel], sign: f64) -> usize {
    let mut best = 0;
    for (index, point) in column.iter().enumerate() {
        if sign * point[1] > sign * column[best][1] {
            best = index;
        }
    }
    best
}

/// The Douglas-Peucker choice of points, without recursion.
fn simplified(points: &[Pixel]) -> Vec<Pixel> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let farthest = (first + 1..last)
            .map(|index| (index, distance(points[index], points[first], points[last])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, away)) = farthest
            && away > TOLERANCE
        {
            keep[index] = true;
            open.push((first, index));
            open.push((index, last));
        }
    }
    let kept = points.iter().zip(&keep).filter(|(_, keep)| **keep);
    kept.map(|(point, _)| *point).collect()
}

/// Distance of a point from a straight piece.
pub(crate) fn distance(point: Pixel, from: Pixel, to: Pixel) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 {
        (((point[0] - from[0]) * dx + (point[1] - from[1]) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point[0] - from[0] - share * dx).hypot(point[1] - from[1] - share * dy)
}

/// Steps between points rounded to tenths: short, and without drift because the ends are rounded, not the steps.
fn write_run(data: &mut String, points: &[Pixel]) {
    let mut previous: Option<[i64; 2]> = None;
    for point in points {
        let here = point.map(to_tenths);
        match previous {
            None => {
                let _ = write!(data, "M{} {}", tenths(here[0]), tenths(here[1]));
                // A single point is drawn as a dot by round line ends.
                if points.len() == 1 {
                    data.push_str("h0");
                }
            }
            Some(before) if before == here => continue,
            Some([x, y]) if x == here[0] => {
                let _ = write!(data, "v{}", tenths(here[1] - y));
            }
            Some([x, y]) if y == here[1] => {
                let _ = write!(data, "h{}", tenths(here[0] - x));
            }
            Some([x, y]) => {
                let _ = write!(data, "l{} {}", tenths(here[0] - x), tenths(here[1] - y));
            }
        }
        previous = Some(here);
    }
}

/// Nearer than this two lines are drawn as one, pixels.
const NEAR: f64 = 0.6;

/// Lines drawn so far in one style.
///
/// Mirrored shapes have the same curve, and two rows of dashes out of step look like a solid line.
#[derive(Default)]
pub(crate) struct Drawn {
    pieces: Vec<(Pixel, Pixel)>,
}

impl Drawn {
    /// The parts of a line that are not drawn yet; they count as drawn from now on.
    pub(crate) fn fresh(&mut self, points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
        let mut out: Vec<Option<Pixel>> = Vec::new();
        let mut lifted = true;
        for pair in points.windows(2) {
            let [Some(a), Some(b)] = *pair else {
                lifted = true;
                continue;
            };
            if a == b {
                continue;
            }
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            // The piece before ends where this one begins and hides none of it.
            let known = &self.pieces[..self.pieces.len().saturating_sub(usize::from(!lifted))];
            let hidden = [a, middle, b]
                .iter()
                .all(|p| known.iter().any(|(c, d)| distance(*p, *c, *d) < NEAR));
            if hidden {
                lifted = true;
                continue;
            }
            if lifted {
                out.extend([None, Some(a)]);
            }
            out.push(Some(b));
            lifted = false;
            self.pieces.push((a, b));
        }
        if points.len() == 1 {
            out.extend(points);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_need_two_points() {
        let line: Vec<_> = (0..100)
            .map(|i| Some([f64::from(i), 2.0 * f64::from(i)]))
            .collect();
        assert_eq!(path_data(&line), "M0 0l99 198");
        assert_eq!(
            path_data(&[Some([1.0, 1.0]), None, Some([2.0, 2.0])]),
            "M1 1h0M2 2h0"
        );
        assert_eq!(path_data(&[]), "");
    }

    #[test]
    fn what_is_covered_is_drawn_once() {
        let circle = |i: u32| {
            let angle = f64::from(i) / 1000.0 * std::f64::consts::TAU;
            Some([100.0 + 50.0 * angle.cos(), 100.0 + 50.0 * angle.sin()])
        };
        let once: Vec<_> = (0..=1000).map(circle).collect();
        assert_eq!(first_time(&once), once);
        let often: Vec<_> = (0..=100_000).map(circle).collect();
        let kept = first_time(&often);
        assert!(kept.len() < 3000, "{}", kept.len());
        // Every place of the whole line is drawn.
        for p in once.iter().flatten() {
            let near = |pair: &[Option<Pixel>]| matches!(pair, [Some(a), Some(b)] if distance(*p, *a, *b) < 1.0);
            assert!(kept.windows(2).any(near));
        }
    }

    #[test]
    fn columns_keep_extremes() {
        let noise: Vec<_> = (0..10_000)
            .map(|i| Some([f64::from(i) / 1000.0, f64::from(i * 7919 % 1000)]))
            .collect();
        let kept = per_column(&noise);
        assert!(kept.len() <= 21);
        for column in 0..10 {
            let own = kept
                .iter()
                .flatten()
                .filter(|p| p[0].floor() == f64::from(column));
            let mut own: Vec<f64> = own.map(|p| p[1]).collect();
            own.sort_by(f64::total_cmp);
            assert_eq!((own.first(), own.last()), (Some(&0.0), Some(&999.0)));
        }
    }

    /// A run of cuts with a rapid between any two is as short as one cut.
    #[test]
    fn lifts_within_a_column_are_not_kept() {
        let mut points = Vec::new();
        for i in 0..3000 {
            let x = f64::from(i) / 100.0;
            points.extend([Some([x, 1.0]), Some([x, 5.0]), None]);
        }
        let kept = per_column(&points);
        assert!(kept.len() <= 90, "{}", kept.len());
        let few = [
            None,
            Some([0.1, 1.0]),
            None,
            Some([0.2, 2.0]),
            Some([3.0, 1.0]),
            None,
        ];
        assert_eq!(per_column(&few), few[..5]);
    }

    #[test]
    fn a_line_that_comes_back_is_drawn_once() {
        let there: Vec<_> = (0..=100)
            .map(|i| Some([f64::from(i), 0.5 * f64::from(i)]))
            .collect();
        let mut both = there.clone();
        both.extend(there.iter().rev());
        let mut drawn = Drawn::default();
        let fresh = drawn.fresh(&both);
        let count = fresh.iter().flatten().count();
        assert!((100..=104).contains(&count), "{count}");
        assert!(drawn.fresh(&there).iter().flatten().next().is_none());
        // Another line stays whole.
        let other: Vec<_> = (0..=10).map(|i| Some([f64::from(i), 30.0])).collect();
        assert_eq!(drawn.fresh(&other).iter().flatten().count(), 11);
    }
}
