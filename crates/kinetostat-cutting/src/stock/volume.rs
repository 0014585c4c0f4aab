//! Volume of a stock.

use crate::stock::grid::Stock;
use crate::stock::profile::Normal;

impl Stock {
    /// Volume of the material, mm^3: the square around each point, with the part of it beyond a wall at the height of the
    /// neighbour across that wall.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let stock = Stock::block([0.0; 3], [20.0, 10.0, 5.0], &StockSettings::with_cell_mm(0.3)?)?;
    /// assert!((stock.volume_mm3() - 1000.0).abs() < 0.1);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        let [nx, ny] = self.points;
        let mut sum = 0.0;
        for j in 0..ny {
            let mut row = 0.0;
            for i in 0..nx {
                row += self.mean_top(i, j);
            }
            sum += row;
        }
        sum * self.cell * self.cell
    }

    /// Mean height over the square around a point.
    fn mean_top(&self, i: usize, j: usize) -> f64 {
        let [nx, ny] = self.points;
        let column = self.columns[j * nx + i];
        let top = f64::from(column.top);
        let half = 0.5 * self.cell;
        // Share of the square beyond a wall at this distance: on the diagonal the square is longer.
        let near = half * std::f64::consts::SQRT_2;
        let (drop, rise) = (f64::from(column.drop), f64::from(column.rise));
        if (drop >= near && rise >= near) || i == 0 || j == 0 || i + 1 == nx || j + 1 == ny {
            return top;
        }
        // Two walls near the point, as where a slot leaves the block, lead to different levels: the normal tells which.
        let beyond = |distance: f64, normal: Normal, sign: f64| {
            let [x, y] = normal.vector();
            let [along_x, along_y] = [x.abs(), y.abs()];
            let longer = if along_x > along_y { along_x } else { along_y };
            if distance >= near || longer == 0.0 {
                return 0.0;
            }
            let step = |part: f64| (sign * part / longer).round() as isize;
            let (a, b) = (
                i.wrapping_add_signed(step(x)),
                j.wrapping_add_signed(step(y)),
            );
            let level = f64::from(self.columns[b * nx + a].top);
            beyond_line(distance / self.cell, [along_x, along_y]) * (level - top)
        };
        let below = beyond(drop, column.drop_normal, -1.0);
        let above = beyond(rise, column.rise_normal, 1.0);
        top + if below < 0.0 { below } else { 0.0 } + if above > 0.0 { above } else { 0.0 }
    }
}

/// Share of the unit square beyond a straight line at this distance from its centre, with this normal (not negative).
fn beyond_line(distance: f64, [a, b]: [f64; 2]) -> f64 {
    let (long, short) = if a > b { (a, b) } else { (b, a) };
    let (outer, inner) = (0.5 * (long + short), 0.5 * (long - short));
    match distance {
        d if d >= outer => 0.0,
        d if d >= inner => (outer - d) * (outer - d) / (2.0 * long * short),
        d => 0.5 - d / long,
    }
}
