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
        // The ends of the window only move forward, from row to row.
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

/// The rows, and between rows that are farther apart than half a window the places where the mean bends: half a window from each.
pub(crate) fn places_of_mean(at: &[f64], window: f64) -> Vec<f64> {
    let half = 0.5 * window;
    let mut places = Vec::with_capacity(at.len());
    places.extend(at.first().copied());
    for pair in at.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let mut between = [a + half, b - half];
        between.sort_by(f64::total_cmp);
        for place in between {
            let last = places.last().copied().unwrap_or(a);
            if b - a > half && place > last && place < b {
                places.push(place);
            }
        }
        places.push(b);
    }
    places
}

/// Values at places, in order, on the straight lines between rows.
pub(crate) fn at_places(at: &[f64], values: &[f64], places: &[f64]) -> Vec<f64> {
    let mut row = 0;
    let value = |place: &f64| {
        while row + 2 < at.len() && at[row + 1] < *place {
            row += 1;
        }
        match (at.get(row + 1), values.get(row + 1)) {
            (Some(to), Some(end)) if to > &at[row] => {
                values[row] + (end - values[row]) * (place - at[row]) / (to - at[row])
            }
            _ => values[row],
        }
    };
    places.iter().map(value).collect()
}
