//! A stock from a map of heights.

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::number::larger;
use crate::stock::grid::{FAR_MM, Stock};
use crate::stock::settings::StockSettings;

/// Maximum number of entries in a map.
const MOST: usize = 50_000_000;

impl Stock {
    /// A map of heights: rows of numbers (mm) with commas between them. The first row lies at `corner`, along x; the next rows
    /// follow along y, each `spacing_mm` farther, as do the numbers in a row. Between them the height is bilinear; material
    /// reaches down to the third number of `corner`, and none is where the map is not above that. `name` stands in errors.
    ///
    /// ```
    /// use kinetostat_cutting::{Stock, StockSettings};
    ///
    /// let map = b"5,5,5\n5,6,5\n5,5,5\n";
    /// let settings = StockSettings::with_cell_mm(0.5)?;
    /// let stock = Stock::height_map(map, "casting.csv", [0.0; 3], 10.0, &settings)?;
    /// assert!((stock.top_mm(10.0, 10.0).unwrap() - 6.0).abs() < 0.1);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// With file and line: what is no number, rows of different length. Less than two rows or columns, more than 50 million
    /// numbers, a spacing outside 0.001 to 1000 mm, and as [`Stock::block`].
    pub fn height_map(
        bytes: &[u8],
        name: &str,
        corner: [f64; 3],
        spacing_mm: f64,
        settings: &StockSettings,
    ) -> Result<Self> {
        let stock = CutErrorKind::Stock;
        within(stock, "spacing of the map", spacing_mm, 1e-3..=1e3, "mm")?;
        let map = Map::read(bytes, name)?;
        let [x0, y0, bottom] = corner;
        let length = |n: usize| (n - 1) as f64 * spacing_mm;
        let (dx, dy) = (length(map.columns), length(map.rows));
        let highest = map.heights.iter().copied().fold(bottom, larger);
        let opposite = [x0 + dx, y0 + dy];
        let mut field = Self::empty([x0, y0], opposite, [bottom, highest], settings)?;
        field.fill(|x, y| {
            let (u, v) = (x - x0, y - y0);
            let beyond = [-u, u - dx, -v, v - dy]
                .into_iter()
                .fold(f64::NEG_INFINITY, larger);
            let top = map.at(u / spacing_mm, v / spacing_mm) - bottom;
            match top > 0.0 {
                true => (top, -beyond),
                false => (0.0, f64::NEG_INFINITY),
            }
        });
        Ok(field)
    }
}

#[derive(Default)]
struct Map {
    heights: Vec<f64>,
    columns: usize,
    rows: usize,
}

impl Map {
    fn read(bytes: &[u8], name: &str) -> Result<Self> {
        let wrong = |quantity: &str, found: String, expected: String, line: Option<u64>| {
            CutError::new(CutErrorKind::File, quantity, found, expected)
                .at(name, line.map(|line| line as usize))
        };
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(bytes);
        let mut map = Self::default();
        let mut record = csv::StringRecord::new();
        loop {
            let more = reader.read_record(&mut record).map_err(|error| {
                let line = error.position().map(csv::Position::line);
                wrong(
                    "map of heights",
                    error.to_string(),
                    "rows of numbers".into(),
                    line,
                )
            })?;
            if !more {
                break;
            }
            let line = record.position().map(csv::Position::line);
            if map.rows == 0 {
                map.columns = record.len();
            }
            if record.len() != map.columns || map.heights.len() + record.len() > MOST {
                let found = format!("{} numbers in a row", record.len());
                let expected = format!("{} as in the first, at most {MOST} in all", map.columns);
                return Err(wrong("row of the map", found, expected, line));
            }
            for field in &record {
                let number = field.parse::<f64>().ok().filter(|h| h.abs() <= FAR_MM);
                let Some(height) = number else {
                    let found = field.chars().take(40).collect();
                    let expected = format!("a number of mm up to {FAR_MM}");
                    return Err(wrong("height", found, expected, line));
                };
                map.heights.push(height);
            }
            map.rows += 1;
        }
        match map.rows >= 2 && map.columns >= 2 {
            true => Ok(map),
            false => Err(wrong(
                "map of heights",
                format!("{} rows of {}", map.rows, map.columns),
                "at least two rows of two numbers".into(),
                None,
            )),
        }
    }

    /// Height at a place counted in spacings, held at the edge outside.
    fn at(&self, u: f64, v: f64) -> f64 {
        let part = |value: f64, n: usize| {
            let held = value.max(0.0).min((n - 1) as f64);
            let i = (held as usize).min(n - 2);
            (i, held - i as f64)
        };
        let ((i, a), (j, b)) = (part(u, self.columns), part(v, self.rows));
        let row = |j: usize| {
            let at = j * self.columns + i;
            self.heights[at] * (1.0 - a) + self.heights[at + 1] * a
        };
        row(j) * (1.0 - b) + row(j + 1) * b
    }
}
