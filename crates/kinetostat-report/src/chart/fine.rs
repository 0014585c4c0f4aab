//! The cells of a continuous quantity, divided so that its colours change along smooth lines.

use crate::chart::cell::Cell;
use crate::number;

/// Cells of an interpolated section along an axis, about.
const FINE: usize = 240;

/// The cells of a section, divided so finely that the borders of colours are smooth.
pub(crate) struct Fine {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) cells: Vec<Cell>,
}

impl Fine {
    /// Bilinear between four places with values; beside a place without one, and beyond the outermost, the nearest cell.
    pub(crate) fn of([nx, ny]: [usize; 2], own: &[Cell]) -> Self {
        let parts = |count: usize| (FINE / count.max(1)).max(1);
        let (px, py) = (parts(nx), parts(ny));
        let cell = |i: usize, j: usize| own.get(j * nx + i).copied();
        let value = |i: usize, j: usize| match cell(i, j) {
            Some(Cell::Value(x)) => number::drawable(x),
            _ => None,
        };
        let mut cells = Vec::with_capacity(nx * px * ny * py);
        for row in 0..ny * py {
            let (low, high, up) = between(row, py, ny);
            for column in 0..nx * px {
                let (left, right, along) = between(column, px, nx);
                let corners = [(left, low), (right, low), (left, high), (right, high)];
                cells.push(match corners.map(|(i, j)| value(i, j)) {
                    [Some(a), Some(b), Some(c), Some(d)] => {
                        let (below, above) = (a + along * (b - a), c + along * (d - c));
                        Cell::Value(below + up * (above - below))
                    }
                    _ => cell(column / px, row / py).unwrap_or(Cell::Value(f64::NAN)),
                });
            }
        }
        Self {
            columns: nx * px,
            rows: ny * py,
            cells,
        }
    }
}

/// The places on both sides of a part of a cell, and the share of the way from the first to the second.
fn between(part: usize, parts: usize, count: usize) -> (usize, usize, f64) {
    let at = (part as f64 + 0.5) / parts as f64 - 0.5;
    let at = at.clamp(0.0, count as f64 - 1.0);
    let low = at as usize;
    let share = at - low as f64;
    (low, low + usize::from(share > 0.0), share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fine(cells: &[Cell]) -> Fine {
        Fine::of([2, 2], cells)
    }

    #[test]
    fn values_are_bilinear_between_places_and_constant_beyond() {
        let fine = fine(&[0.0, 1.0, 2.0, 3.0].map(Cell::Value));
        assert_eq!((fine.columns, fine.rows), (FINE, FINE));
        let at = |i: usize, j: usize| match fine.cells[j * FINE + i] {
            Cell::Value(x) => x,
            _ => f64::NAN,
        };
        assert_eq!((at(0, 0), at(FINE - 1, FINE - 1)), (0.0, 3.0));
        // The middle of the square lies between the four middle cells.
        let middle = FINE / 2;
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(middle - i, middle - j));
        assert!((four.iter().sum::<f64>() - 6.0).abs() < 1e-9, "{four:?}");
        assert!((at(middle, 0) - at(middle - 1, 0) - 1.0 / 120.0).abs() < 1e-9);
    }

    #[test]
    fn beside_a_place_without_a_value_cells_are_whole() {
        let cells = [
            Cell::Value(0.0),
            Cell::Other(1),
            Cell::Value(2.0),
            Cell::Value(3.0),
        ];
        let fine = fine(&cells);
        let none = fine.cells.iter().filter(|c| **c == Cell::Other(1));
        assert_eq!(4 * none.count(), FINE * FINE);
        // In the middle of the square, at the corner of the first cell.
        let corner = FINE / 2 - 1;
        assert_eq!(fine.cells[corner * FINE + corner], Cell::Value(0.0));
    }
}
