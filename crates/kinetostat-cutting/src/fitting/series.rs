//! Mean forces at several feeds in one cut, as rows or as CSV.

use crate::error::{CutError, CutErrorKind, Result};
use crate::fitting::cut::MeasuredCut;
use crate::number_columns::NumberColumns;

const FEED: &str = "feed_mm_per_tooth";
const FORCES: [&str; 3] = ["fx_n", "fy_n", "fz_n"];
const COLUMNS: [&str; 4] = [FEED, FORCES[0], FORCES[1], FORCES[2]];
const MOST_ROWS: usize = 100_000;

/// Mean force on the tool at a feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanForce {
    /// Feed per tooth, mm.
    pub feed_mm_per_tooth: f64,
    /// Force along the feed, to its left and towards the spindle, N; `None` where it was not measured.
    pub force_n: [Option<f64>; 3],
}

/// Mean forces at several feeds in one cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(crate) cut: MeasuredCut,
    pub(crate) rows: Vec<MeanForce>,
}

impl Series {
    /// Forces that were measured in a cut.
    ///
    /// # Errors
    /// Feeds that are not above zero or above half the tool's diameter, fewer than two different ones, forces that are no numbers, more than 100 000 rows.
    pub fn new(cut: MeasuredCut, rows: Vec<MeanForce>) -> Result<Self> {
        most_rows(rows.len())?;
        for row in &rows {
            checked(row, &cut)?;
        }
        different_feeds(&rows)?;
        Ok(Self { cut, rows })
    }

    /// Forces from CSV with the columns `feed_mm_per_tooth`, `fx_n`, `fy_n`, `fz_n` in any order; a force that was not
    /// measured has no column. Lines that begin with `#` are passed over; semicolons may stand in place of the commas.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, MeasuredCut, Series, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 20.0, 4)?;
    /// let slot = Engagement::straight(10.0, 20.0, 2.0, Side::Left)?;
    /// let cut = MeasuredCut::new(&tool, &slot)?;
    /// let text = "feed_mm_per_tooth,fx_n,fy_n,fz_n\n0.05,-90,150,20\n0.1,-110,230,-0.1.2\n";
    /// let error = Series::read("slot.csv", text, cut).unwrap_err();
    /// assert_eq!(error.line, Some(3));
    /// assert!(error.to_string().starts_with("slot.csv:3: fz_n: `-0.1.2`"));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Series::new`]; no header, columns that are unknown, missing or there twice, cells that are no numbers; with file
    /// and line.
    pub fn read(name_of_file: &str, text: &str, cut: MeasuredCut) -> Result<Self> {
        let columns = NumberColumns { known: &COLUMNS };
        let mut rows = Vec::new();
        let last = columns.read(name_of_file, text, accepted, |cells, _| {
            most_rows(rows.len() + 1)?;
            let row = MeanForce {
                feed_mm_per_tooth: cells[0].unwrap_or(f64::NAN),
                force_n: [cells[1], cells[2], cells[3]],
            };
            checked(&row, &cut)?;
            rows.push(row);
            Ok(())
        })?;
        different_feeds(&rows).map_err(|error| error.at(name_of_file, Some(last)))?;
        Ok(Self { cut, rows })
    }
}

impl Series {
    /// The cut in which the forces were measured.
    #[must_use]
    pub fn cut(&self) -> &MeasuredCut {
        &self.cut
    }

    /// The forces by rows.
    #[must_use]
    pub fn rows(&self) -> &[MeanForce] {
        &self.rows
    }
}

/// A feed and some force must be there.
fn accepted(there: &[bool]) -> std::result::Result<(), String> {
    match (there[0], there[1..].contains(&true)) {
        (true, true) => Ok(()),
        (true, false) => Err("no column of a force".to_owned()),
        (false, _) => Err(format!("no column `{FEED}`")),
    }
}

fn checked(row: &MeanForce, cut: &MeasuredCut) -> Result<()> {
    let refuse = |quantity: &str, found: String, expected: &str| {
        Err(CutError::new(
            CutErrorKind::Measurement,
            quantity,
            found,
            expected,
        ))
    };
    let feed = row.feed_mm_per_tooth;
    if !(1e-6..=10.0).contains(&feed) {
        return refuse(FEED, format!("{feed} mm"), "0.000001 to 10 mm");
    }
    if feed > cut.most_feed_mm() {
        let expected = "at most half the diameter of the tool: a feed per tooth, not per minute";
        return refuse(FEED, format!("{feed} mm"), expected);
    }
    for (name, force) in FORCES.iter().zip(row.force_n) {
        if let Some(force) = force.filter(|force| !(-1e6..=1e6).contains(force)) {
            return refuse(name, format!("{force} N"), "-1000000 to 1000000 N");
        }
    }
    Ok(())
}

fn most_rows(count: usize) -> Result<()> {
    match count <= MOST_ROWS {
        true => Ok(()),
        false => Err(CutError::new(
            CutErrorKind::Measurement,
            "rows",
            format!("{count} or more"),
            format!("at most {MOST_ROWS}: give means, not the signal"),
        )),
    }
}

/// Checks for different feeds: with one feed, the part of the force that grows with it cannot be told from the rest.
fn different_feeds(rows: &[MeanForce]) -> Result<()> {
    let first = rows.first().map(|row| row.feed_mm_per_tooth);
    let differs = |row: &MeanForce| {
        let feed = row.feed_mm_per_tooth;
        first.is_some_and(|first| (feed - first).abs() > 1e-6 * first)
    };
    match rows.iter().any(differs) {
        true => Ok(()),
        false => Err(CutError::new(
            CutErrorKind::Measurement,
            FEED,
            match first {
                Some(feed) => format!("{feed} mm in all {} rows", rows.len()),
                None => "no row".to_owned(),
            },
            "two different feeds at least, better five: one alone cannot tell the edge force from that of the chip",
        )),
    }
}
