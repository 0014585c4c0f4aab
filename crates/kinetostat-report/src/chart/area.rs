//! An area between two lines as short path data that looks the same.

use std::fmt::Write as _;

use crate::svg::pixel;

/// A gap of more pixels between two places is drawn as what lies at its ends, not as the extremes of their columns.
const GAP: f64 = 2.0;

/// The places of one column of pixels.
struct Column {
    first: [f64; 3],
    last: [f64; 3],
    /// Lower and upper end, the outermost of all places.
    low: f64,
    high: f64,
}

impl Column {
    fn of(place: [f64; 3]) -> Self {
        let [_, low, high] = place;
        Self {
            first: place,
            last: place,
            low,
            high,
        }
    }

    fn add(&mut self, place: [f64; 3]) {
        let [_, low, high] = place;
        // Pixels count downwards.
        self.low = if low > self.low { low } else { self.low };
        self.high = if high < self.high { high } else { self.high };
        self.last = place;
    }
}

/// Path data of areas: of every place its abscissa, its lower and its upper end in pixels, from left to right; `None` ends a
/// piece. Of a column of pixels the outermost ends count.
pub(crate) fn area_data(places: &[Option<[f64; 3]>]) -> String {
    let mut data = String::new();
    for run in places.split(Option::is_none) {
        let mut columns: Vec<Column> = Vec::new();
        for &place in run.iter().flatten() {
            match columns.last_mut() {
                Some(last) if last.first[0].floor() == place[0].floor() => last.add(place),
                _ => columns.push(Column::of(place)),
            }
        }
        let ends = outline(&columns);
        let upper = ends.iter().map(|[x, _, high]| (x, high));
        let lower = ends.iter().rev().map(|[x, low, _]| (x, low));
        for (k, (x, y)) in upper.chain(lower).enumerate() {
            let word = if k == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{word}{} {}", pixel(*x), pixel(*y));
        }
        if !ends.is_empty() {
            data.push('z');
        }
    }
    data
}

/// The ends of an area from left to right: the extremes of each column, and beside a gap the place at its edge.
fn outline(columns: &[Column]) -> Vec<[f64; 3]> {
    let mut ends = Vec::with_capacity(columns.len());
    for (i, column) in columns.iter().enumerate() {
        let apart = |a: &Column, b: &Column| b.first[0] - a.last[0] > GAP;
        let extremes = [column.first[0], column.low, column.high];
        let before = i.checked_sub(1).and_then(|k| columns.get(k));
        if before.is_some_and(|before| apart(before, column)) && column.first != extremes {
            ends.push(column.first);
        }
        ends.push(extremes);
        let after = columns.get(i + 1);
        if after.is_some_and(|after| apart(column, after)) && column.last != extremes {
            ends.push(column.last);
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::area_data;

    #[test]
    fn an_area_goes_there_above_and_back_below() {
        let places = [[0.0, 9.0, 4.0], [0.4, 8.0, 3.0], [2.0, 9.0, 6.0]].map(Some);
        assert_eq!(area_data(&places), "M0 3L2 6L2 9L0 9z");
        assert_eq!(area_data(&[None, None]), "");
    }

    #[test]
    fn a_gap_is_bounded_by_the_places_beside_it() {
        // A cut that begins and ends within one column, between long ways in air.
        let places = [
            [0.0, 9.0, 9.0],
            [5.0, 9.0, 9.0],
            [5.1, 8.0, 4.0],
            [5.2, 9.0, 9.0],
            [9.0, 9.0, 9.0],
        ];
        assert_eq!(
            area_data(&places.map(Some)),
            "M0 9L5 9L5 4L5.2 9L9 9L9 9L5.2 9L5 9L5 9L0 9z"
        );
    }
}
