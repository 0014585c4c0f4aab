//! Lines with thousands of points as short path data that looks the same.

use std::fmt::Write as _;

use crate::svg::{tenths, to_tenths};

/// A point on the drawing, in pixels.
pub(crate) type Pixel = (f64, f64);

/// How far a line may move when points are left out, in pixels: less than half of its own width.
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

/// The same line without pieces that cover only what earlier pieces cover already: a pocket of a hundred
/// thousand blocks has no more to show than there are places on the drawing.
pub(crate) fn first_time(points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
    // Below this, every piece is kept: short programs lose nothing.
    const MANY: usize = 4000;
    /// Places on the drawing that are told apart, pixels.
    const PLACE: f64 = 0.5;
    if points.len() < MANY {
        return points.to_vec();
    }
    let mut covered = std::collections::BTreeSet::new();
    let mut out: Vec<Option<Pixel>> = Vec::new();
    let mut last: Option<Pixel> = None;
    // The pen is at `last` on paper; otherwise the next piece begins with a lift.
    let mut down = false;
    for point in points {
        let Some(to) = *point else {
            (last, down) = (None, false);
            continue;
        };
        if let Some(from) = last {
            let (dx, dy) = (to.0 - from.0, to.1 - from.1);
            let steps = (dx.hypot(dy) / PLACE).ceil().clamp(1.0, 1e4) as usize;
            let mut new = false;
            for step in 0..=steps {
                let share = step as f64 / steps as f64;
                let cell = |x: f64| (x / PLACE).round() as i32;
                new |= covered.insert((cell(from.0 + share * dx), cell(from.1 + share * dy)));
            }
            if new {
                if !down {
                    out.extend([None, Some(from)]);
                }
                out.push(Some(to));
            }
            down = new;
        }
        last = Some(to);
    }
    out
}

/// At most four points per column of pixels: the first, the lowest, the highest and the last one. The
/// drawn line covers the same pixels, however many points there were. Points go from left to right.
pub(crate) fn per_column(points: &[Option<Pixel>]) -> Vec<Option<Pixel>> {
    let mut out = Vec::new();
    for run in points.split(Option::is_none) {
        let run: Vec<Pixel> = run.iter().flatten().copied().collect();
        for column in run.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
            let mut kept = [
                0,
                column.len() - 1,
                extreme(column, -1.0),
                extreme(column, 1.0),
            ];
            kept.sort_unstable();
            let mut last = None;
            for index in kept {
                if last != Some(index) {
                    out.push(Some(column[index]));
                }
                last = Some(index);
            }
        }
        out.push(None);
    }
    out
}

fn extreme(column: &[Pixel], sign: f64) -> usize {
    let mut best = 0;
    for (index, point) in column.iter().enumerate() {
        if sign * point.1 > sign * column[best].1 {
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
fn distance(point: Pixel, from: Pixel, to: Pixel) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 {
        (((point.0 - from.0) * dx + (point.1 - from.1) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point.0 - from.0 - share * dx).hypot(point.1 - from.1 - share * dy)
}

/// Steps between points rounded to tenths: short, and without drift because the ends are rounded, not the steps.
fn write_run(data: &mut String, points: &[Pixel]) {
    let mut previous = None;
    for point in points {
        let here = (to_tenths(point.0), to_tenths(point.1));
        match previous {
            None => {
                let _ = write!(data, "M{} {}", tenths(here.0), tenths(here.1));
                // A single point is drawn as a dot by round line ends.
                if points.len() == 1 {
                    data.push_str("h0");
                }
            }
            Some((x, y)) if (x, y) == here => continue,
            Some((x, y)) => {
                let _ = write!(data, "l{} {}", tenths(here.0 - x), tenths(here.1 - y));
            }
        }
        previous = Some(here);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_need_two_points() {
        let line: Vec<_> = (0..100)
            .map(|i| Some((f64::from(i), 2.0 * f64::from(i))))
            .collect();
        assert_eq!(path_data(&line), "M0 0l99 198");
        assert_eq!(
            path_data(&[Some((1.0, 1.0)), None, Some((2.0, 2.0))]),
            "M1 1h0M2 2h0"
        );
        assert_eq!(path_data(&[]), "");
    }

    #[test]
    fn what_is_covered_is_drawn_once() {
        let circle = |i: u32| {
            let angle = f64::from(i) / 1000.0 * std::f64::consts::TAU;
            Some((100.0 + 50.0 * angle.cos(), 100.0 + 50.0 * angle.sin()))
        };
        let once: Vec<_> = (0..=1000).map(circle).collect();
        assert_eq!(first_time(&once), once);
        let often: Vec<_> = (0..=100_000).map(circle).collect();
        let kept = first_time(&often);
        assert!(kept.len() < 3000, "{}", kept.len());
        // Every place of the whole line is drawn.
        for p in once.iter().flatten() {
            let near = |q: &Pixel| (p.0 - q.0).hypot(p.1 - q.1) < 1.0;
            assert!(kept.iter().flatten().any(near));
        }
    }

    #[test]
    fn columns_keep_extremes() {
        let noise: Vec<_> = (0..10_000)
            .map(|i| Some((f64::from(i) / 1000.0, f64::from(i * 7919 % 1000))))
            .collect();
        let kept = per_column(&noise);
        assert!(kept.len() <= 41);
        let highest = kept.iter().flatten().map(|p| p.1).fold(0.0, f64::max);
        assert!(highest > 998.0);
    }
}
