//! The file itself, group by group of rows.

use std::io::{Read, Write};
use std::sync::{Arc, Mutex, PoisonError};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::fields::{Cell, RowColumn, RowsWriter};
use kinetostat_machining::{PointResult, RunInputs};

use crate::program::points_columns::column;
use crate::program::points_table::{Listing, header, rows};
use crate::ui::failure::{Answer, Failing, Failure};

/// A file that is being written; its bytes go out group by group.
struct PointsFile<P> {
    columns: Vec<RowColumn>,
    writer: RowsWriter<Shared>,
    sink: Shared,
    put: P,
}

impl<P: FnMut(&[u8]) -> Answer<()>> PointsFile<P> {
    fn new<'n>(
        run_inputs: &RunInputs,
        names: impl IntoIterator<Item = &'n str>,
        put: P,
    ) -> Answer<Self> {
        let facts = [
            ("title", format!("points of {}", run_inputs.program)),
            ("model", run_inputs.model.clone()),
            ("load", run_inputs.load.clone()),
            ("kinetostat_version", env!("CARGO_PKG_VERSION").to_owned()),
        ];
        let facts = facts.map(|(name, text)| (name.to_owned(), text));
        let columns: Vec<RowColumn> = names.into_iter().map(column).collect();
        let sink = Shared::default();
        let writer = RowsWriter::new(sink.clone(), &columns, &facts)
            .map_err(|error| ErrorCode::Output.failure(error))?;
        Ok(Self {
            columns,
            writer,
            sink,
            put,
        })
    }

    /// A row, as the CSV has its cells.
    fn push<'r>(&mut self, row: impl IntoIterator<Item = &'r str>) -> Answer<()> {
        let cells = row.into_iter().zip(&self.columns);
        let cells = cells.map(|(cell, column)| match column.is_text {
            true => Cell::Text(cell),
            // An empty cell is a number that does not exist.
            false => Cell::Number(cell.parse().unwrap_or(f64::NAN)),
        });
        self.writer
            .push(cells)
            .map_err(|error| ErrorCode::Output.failure(error))?;
        let bytes = self.sink.take();
        match bytes.is_empty() {
            true => Ok(()),
            false => (self.put)(&bytes),
        }
    }

    fn finish(mut self) -> Answer<()> {
        self.writer
            .finish()
            .map_err(|error| ErrorCode::Output.failure(error))?;
        (self.put)(&self.sink.take())
    }
}

/// The file piece by piece.
pub(crate) fn table(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
    put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    let header = header(run_inputs, points, listing);
    let mut file = PointsFile::new(run_inputs, header.iter().map(String::as_str), put)?;
    rows(run_inputs, listing, &mut points.iter(), |row| {
        file.push(row.iter().map(String::as_str))
    })?;
    file.finish()
}

/// Writes the rows of a table of all points as CSV, of which a group is in memory at a time.
pub(crate) fn from_csv(
    run_inputs: &RunInputs,
    csv: impl Read,
    put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    let mut reader = csv::Reader::from_reader(csv);
    let header = reader.headers().map_err(unread)?;
    let mut file = PointsFile::new(run_inputs, header, put)?;
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(unread)? {
        file.push(&row)?;
    }
    file.finish()
}

fn unread(error: csv::Error) -> Failure {
    ErrorCode::Checkpoint.failure(format!(
        "the rows of points that were kept cannot be read ({error}): give --restart to begin anew"
    ))
}

/// Bytes that were written since they were taken last.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Shared {
    fn take(&self) -> Vec<u8> {
        let mut bytes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut bytes)
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell as Counter;

    /// Rows of a table that are made as they are read.
    struct Rows<'c> {
        read: &'c Counter<usize>,
        text: Vec<u8>,
    }

    const COUNT: usize = 200_000;

    impl Read for Rows<'_> {
        fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
            if self.text.is_empty() && self.read.get() < COUNT {
                let row = format!("{},feed,{}\n", self.read.get(), self.read.get() % 7);
                self.text = row.into_bytes();
                self.read.set(self.read.get() + 1);
            }
            let count = self.text.len().min(to.len());
            to[..count].copy_from_slice(&self.text[..count]);
            self.text.drain(..count);
            Ok(count)
        }
    }

    #[test]
    fn rows_go_out_long_before_the_last_is_read() {
        let read = Counter::new(0);
        let header = b"line,kind,share\n".to_vec();
        let rows = Rows {
            read: &read,
            text: header,
        };
        let mut written = Vec::new();
        let put = |bytes: &[u8]| {
            written.push((read.get(), bytes.len()));
            Ok(())
        };
        from_csv(&RunInputs::default(), rows, put).unwrap();
        let after_first_group = written.iter().find(|(_, bytes)| *bytes > 1000).unwrap();
        assert!(after_first_group.0 < COUNT / 2, "{written:?}");
        assert!(written.len() >= 4, "{written:?}");
    }

    #[test]
    fn rows_that_are_none_are_said() {
        let put = |_: &[u8]| Ok(());
        let failure =
            from_csv(&RunInputs::default(), &b"line,share\n1,0\n2\n"[..], put).unwrap_err();
        assert!(failure.plain.contains("--restart"), "{}", failure.plain);
    }
}
