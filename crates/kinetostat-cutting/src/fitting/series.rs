//! Mean forces at several feeds in one cut, as rows or as CSV.

use crate::error::{CutError, CutErrorKind, Result};
use crate::fitting::cut::MeasuredCut;

const FEED: &str = "feed_mm_per_tooth";
const FORCES: [&str; 3] = ["fx_n", "fy_n", "fz_n"];
const MOST_ROWS: usize = 100_000;

/// Mean force on the tool at a feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanForce {
    /// Feed per tooth, mm.
    pub feed_mm_per_tooth: f64,
    /// Along the feed, to its left and towards the spindle, N; `None` where it was not measured.
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
    /// Feeds that are not above zero, fewer than two different ones, forces that are no numbers, more than 100 000 rows.
    pub fn new(cut: MeasuredCut, rows: Vec<MeanForce>) -> Result<Self> {
        most_rows(rows.len())?;
        for row in &rows {
            checked(row)?;
        }
        different_feeds(&rows)?;
        Ok(Self { cut, rows })
    }

    /// Forces from CSV with the columns `feed_mm_per_tooth`, `fx_n`, `fy_n`, `fz_n` in any order; a force that was not
    /// measured has no column. Lines that begin with `#` are passed over.
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
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let at = |line: usize| move |error: CutError| error.at(name_of_file, Some(line));
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let headers = reader.headers().map_err(|e| at(1)(broken(&e)))?.clone();
        let first = line_of(text, headers.position());
        let columns = Columns::of(&headers).map_err(at(first))?;
        let mut rows = Vec::new();
        let mut last = first;
        for record in reader.records() {
            let record = record.map_err(|e| at(line_of(text, e.position()))(broken(&e)))?;
            last = line_of(text, record.position());
            most_rows(rows.len() + 1).map_err(at(last))?;
            let row = columns.row(&record).map_err(at(last))?;
            checked(&row).map_err(at(last))?;
            rows.push(row);
        }
        different_feeds(&rows).map_err(at(last))?;
        Ok(Self { cut, rows })
    }
}

/// Which column holds what.
struct Columns {
    feed: usize,
    forces: [Option<usize>; 3],
}

impl Columns {
    fn of(headers: &csv::StringRecord) -> Result<Self> {
        let all = format!("{FEED},{}", FORCES.join(","));
        let refuse = |found: String| {
            Err(CutError::new(
                CutErrorKind::File,
                "header",
                found,
                format!("the columns {all}, with commas between them"),
            ))
        };
        for (index, name) in headers.iter().enumerate() {
            if name != FEED && !FORCES.contains(&name) {
                return refuse(format!("column `{}`", shown(name)));
            }
            if headers.iter().take(index).any(|before| before == name) {
                return refuse(format!("column `{name}` twice"));
            }
        }
        let place = |name: &str| headers.iter().position(|header| header == name);
        let forces = FORCES.map(place);
        match place(FEED) {
            Some(feed) if forces.iter().any(Option::is_some) => Ok(Self { feed, forces }),
            Some(_) => refuse("no column of a force".to_owned()),
            None => refuse(format!("no column `{FEED}`")),
        }
    }

    fn row(&self, record: &csv::StringRecord) -> Result<MeanForce> {
        let number = |name: &str, column: usize| {
            let cell = record.get(column).unwrap_or_default();
            cell.parse::<f64>().map_err(|_| {
                let found = format!("`{}`", shown(cell));
                CutError::new(
                    CutErrorKind::File,
                    name,
                    found,
                    "a number with a decimal point",
                )
            })
        };
        let mut force_n = [None; 3];
        for (force, (name, column)) in force_n.iter_mut().zip(FORCES.iter().zip(self.forces)) {
            *force = column.map(|column| number(name, column)).transpose()?;
        }
        Ok(MeanForce {
            feed_mm_per_tooth: number(FEED, self.feed)?,
            force_n,
        })
    }
}

fn checked(row: &MeanForce) -> Result<()> {
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

/// With one feed, the part of the force that grows with it cannot be told from the part that does not.
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

fn broken(error: &csv::Error) -> CutError {
    let found = match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!("{len} cells under {expected_len} columns"),
        _ => error.to_string(),
    };
    let expected = "as many cells as the header has, with commas between them";
    CutError::new(CutErrorKind::File, "row", found, expected)
}

/// Line of the record that is read from a position on: comments and empty lines before it are passed over.
fn line_of(text: &str, position: Option<&csv::Position>) -> usize {
    let Some(position) = position else { return 1 };
    let from = usize::try_from(position.byte()).unwrap_or(text.len());
    let rest = text.as_bytes().get(from..).unwrap_or_default();
    let passed = rest
        .split_inclusive(|byte| *byte == b'\n')
        .take_while(|line| matches!(*line, b"\n" | b"\r\n" | [b'#', ..]))
        .count();
    usize::try_from(position.line()).unwrap_or(1) + passed
}

fn shown(cell: &str) -> String {
    cell.chars().take(40).collect()
}
