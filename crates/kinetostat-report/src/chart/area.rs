//! An area between two lines as short path data that looks the same.

use std::fmt::Write as _;

use crate::svg::pixel;

/// Path data of areas: of every place its abscissa, its lower and its upper end in pixels, from left to right; `None` ends a
/// piece. Of a column of pixels the outermost ends count.
pub(crate) fn area_data(places: &[Option<[f64; 3]>]) -> String {
    let mut data = String::new();
    for run in places.split(Option::is_none) {
        let mut columns: Vec<[f64; 3]> = Vec::new();
        for &[x, low, high] in run.iter().flatten() {
            match columns.last_mut() {
                Some(last) if last[0].floor() == x.floor() => {
                    // Pixels count downwards.
                    last[1] = if low > last[1] { low } else { last[1] };
                    last[2] = if high < last[2] { high } else { last[2] };
                }
                _ => columns.push([x, low, high]),
            }
        }
        let upper = columns.iter().map(|[x, _, high]| (x, high));
        let lower = columns.iter().rev().map(|[x, low, _]| (x, low));
        for (k, (x, y)) in upper.chain(lower).enumerate() {
            let word = if k == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{word}{} {}", pixel(*x), pixel(*y));
        }
        if !columns.is_empty() {
            data.push('z');
        }
    }
    data
}

#[cfg(test)]
mod tests {
    use super::area_data;

    #[test]
    fn an_area_goes_there_above_and_back_below() {
        let places = [[0.0, 9.0, 4.0], [0.4, 8.0, 3.0], [5.0, 9.0, 6.0]].map(Some);
        assert_eq!(area_data(&places), "M0 3L5 6L5 9L0 9z");
        assert_eq!(area_data(&[None, None]), "");
    }
}
