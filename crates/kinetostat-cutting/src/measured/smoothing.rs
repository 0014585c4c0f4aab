//! The moving mean.

use crate::measured::integral::Integral;

/// The mean over a window around each row, of the signal as straight lines between its rows. Near the ends the window shrinks
/// on both sides until it fits, down to nothing at the first row and the last: what is constant or a straight line stays as it
/// is everywhere.
pub(crate) fn moving_mean(at: &[f64], values: &[f64], window: f64) -> Vec<f64> {
    let (Some(first), Some(last)) = (at.first().copied(), at.last().copied()) else {
        return Vec::new();
    };
    let integral = Integral::of(at, values);
    let mut ends = [0, 0];
    let mut mean = Vec::with_capacity(at.len());
    for (place, value) in at.iter().zip(values) {
        let half = [0.5 * window, place - first, last - place]
            .into_iter()
            .fold(f64::INFINITY, |a, b| if b < a { b } else { a });
        // Both ends of the window only go on, from row to row.
        let mut to = |end: usize, at_end: f64| {
            while ends[end] + 2 < at.len() && at[ends[end] + 1] <= at_end {
                ends[end] += 1;
            }
            integral.to_after(ends[end], at_end)
        };
        let width = 2.0 * half;
        mean.push(match width > 0.0 {
            true => (to(1, place + half) - to(0, place - half)) / width,
            false => *value,
        });
    }
    mean
}
