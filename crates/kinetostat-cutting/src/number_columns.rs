//! Columns of numbers from CSV: names in the first row, rows of numbers under them.
//!
//! Knows which names may stand in the header, not what they mean. Lines that begin with `#` and empty ones are passed over,
//! as is a mark of byte order before the first. What is wrong is named with file and line.

use crate::error::{CutError, CutErrorKind, Result};
use crate::source::{bare, nearest};

/// Separators of cells, for messages.
const SEPARATED: &str = "with commas or semicolons between them";

/// Separator of two cells: a semicolon if the header has one, else a comma.
fn separator(text: &str) -> u8 {
    let mut lines = text.lines();
    let header = lines.find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    match header.is_some_and(|line| line.contains(';')) {
        true => b';',
        false => b',',
    }
}

/// The columns that a file may have.
pub(crate) struct NumberColumns<'a> {
    pub known: &'a [&'a str],
}

impl NumberColumns<'_> {
    /// Reads a file. `accept` looks at which of the known columns there are and says what is wrong with that; `take` gets the
    /// numbers of each row in the order of the known columns, with their line; columns that are not there are `None`. Gives the
    /// line of the last row, or of the header where there is none.
    pub(crate) fn read(
        &self,
        name_of_file: &str,
        text: &str,
        accept: impl FnOnce(&[bool]) -> std::result::Result<(), String>,
        mut take: impl FnMut(&[Option<f64>], usize) -> Result<()>,
    ) -> Result<usize> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let at = |line: usize| move |error: CutError| error.at(name_of_file, Some(line));
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(separator(text))
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let headers = reader.headers().map_err(|e| at(1)(broken(&e)))?;
        let mut last = line_of(text, headers.position());
        let places = self.places(headers, accept).map_err(at(last))?;
        let mut record = csv::StringRecord::new();
        let mut row = vec![None; self.known.len()];
        loop {
            match reader.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => return Ok(last),
                Err(e) => return Err(at(line_of(text, e.position()))(broken(&e))),
            }
            last = line_of(text, record.position());
            for ((number, place), name) in row.iter_mut().zip(&places).zip(self.known) {
                *number = place
                    .map(|place| cell(name, record.get(place).unwrap_or_default()))
                    .transpose()
                    .map_err(at(last))?;
            }
            take(&row, last).map_err(at(last))?;
        }
    }

    /// Positions of the known columns.
    fn places(
        &self,
        headers: &csv::StringRecord,
        accept: impl FnOnce(&[bool]) -> std::result::Result<(), String>,
    ) -> Result<Vec<Option<usize>>> {
        let refuse = |found: String, near: Option<&str>| {
            let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            let expected = format!("the columns {}, {SEPARATED}{near}", self.known.join(","));
            Err(CutError::new(CutErrorKind::File, "header", found, expected))
        };
        let names: Vec<&str> = headers.iter().map(str::trim).collect();
        for (index, name) in names.iter().enumerate() {
            if !self.known.contains(name) {
                return refuse(format!("column `{}`", shown(name)), self.near(name));
            }
            if names[..index].contains(name) {
                return refuse(format!("column `{name}` twice"), None);
            }
        }
        let place = |known: &&str| names.iter().position(|name| name == known);
        let places: Vec<Option<usize>> = self.known.iter().map(place).collect();
        let there: Vec<bool> = places.iter().map(Option::is_some).collect();
        match accept(&there) {
            Ok(()) => Ok(places),
            Err(found) => refuse(found, None),
        }
    }

    /// The column that was most likely meant: a name without its unit, or a typing mistake.
    fn near(&self, name: &str) -> Option<&str> {
        let given = bare(name);
        let mut known = self.known.iter().copied();
        let longer = known.find(|k| !given.is_empty() && bare(k).starts_with(&given));
        longer.or_else(|| {
            nearest(name, self.known.iter().copied(), 1)
                .first()
                .copied()
        })
    }
}

fn broken(error: &csv::Error) -> CutError {
    let found = match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!("{len} cells under {expected_len} columns"),
        _ => error.to_string(),
    };
    let expected = format!("as many cells as the header has, {SEPARATED}");
    CutError::new(CutErrorKind::File, "row", found, expected)
}

fn cell(name: &str, cell: &str) -> Result<f64> {
    cell.trim().parse::<f64>().map_err(|_| {
        let found = format!("`{}`", shown(cell.trim()));
        let expected = "a number with a decimal point";
        CutError::new(CutErrorKind::File, name, found, expected)
    })
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
