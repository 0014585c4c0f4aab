//! Blanks as they come from the saw: blocks and cylinders.

use crate::error::Result;
use crate::stock::grid::Stock;
use crate::stock::settings::StockSettings;

impl Stock {
    /// A block between two opposite corners, mm.
    ///
    /// # Errors
    /// A block without volume, one larger than 100 m or far away, more memory than allowed.
    pub fn block(a: [f64; 3], b: [f64; 3], settings: &StockSettings) -> Result<Self> {
        let least = |i: usize| if b[i] < a[i] { b[i] } else { a[i] };
        let most = |i: usize| if b[i] < a[i] { a[i] } else { b[i] };
        let (low, high) = ([least(0), least(1)], [most(0), most(1)]);
        let mut stock = Self::empty(low, high, [least(2), most(2)], settings)?;
        let height = stock.height;
        stock.fill(|x, y| {
            let beyond = [(low[0] - x).max(x - high[0]), (low[1] - y).max(y - high[1])];
            let nearest = beyond[0].max(beyond[1]);
            let distance = match nearest > 0.0 {
                true => beyond[0].max(0.0).hypot(beyond[1].max(0.0)),
                false => nearest,
            };
            (height, -distance)
        });
        Ok(stock)
    }

    /// A cylinder that stands upright: centre of its lower end, diameter and height, mm.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let stock = Stock::cylinder([0.0, 0.0, -5.0], 40.0, 5.0, &StockSettings::with_cell_mm(0.5)?)?;
    /// assert!((stock.volume_mm3() / 6283.2 - 1.0).abs() < 1e-3);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Stock::block`].
    pub fn cylinder(
        centre: [f64; 3],
        diameter_mm: f64,
        height_mm: f64,
        settings: &StockSettings,
    ) -> Result<Self> {
        let [x0, y0, bottom] = centre;
        let radius = 0.5 * diameter_mm;
        let ends = [bottom, bottom + height_mm];
        let (low, high) = ([x0 - radius, y0 - radius], [x0 + radius, y0 + radius]);
        let mut stock = Self::empty(low, high, ends, settings)?;
        stock.fill(|x, y| (height_mm, radius - (x - x0).hypot(y - y0)));
        Ok(stock)
    }
}
