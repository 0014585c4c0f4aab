//! Tables of a person's measurements as text: CSV as it is, and spreadsheets (XLSX) and Parquet as CSV of their own.

use std::io::Cursor;
use std::path::Path;

use calamine::{Data, DataRef, Reader, Xlsx};
use kinetostat_diagnostic::ErrorCode;

use crate::files::input_files::{InputFiles, text_in};
use crate::ui::failure::{Answer, Failing};

/// Largest table, bytes: a spreadsheet may be a hundred times as large when it is unpacked.
const MOST_BYTES: usize = 16 << 20;

/// Limit of the cells of a spreadsheet.
const MOST_CELLS: usize = 2_000_000;

impl InputFiles {
    /// A table as CSV; lines are those of the file, rows those of the first sheet. `what` names its part in the question.
    pub(crate) fn table(&self, what: &str, path: &Path) -> Answer<String> {
        let bytes = self.bytes(what, path)?;
        let refuse = |why: String| {
            ErrorCode::FileForm.failure(format!("the {what} '{}': {why}", path.display()))
        };
        if bytes.starts_with(b"PK\x03\x04") {
            return text_of_sheet(bytes).map_err(refuse);
        }
        if bytes.starts_with(b"PAR1") {
            return text_of_parquet(&bytes).map_err(refuse);
        }
        text_in(what, path, bytes)
    }
}

/// The first sheet, cells separated by semicolons: numbers with a point, texts as they are, with commas in them or not.
fn text_of_sheet(bytes: Vec<u8>) -> Result<String, String> {
    if bytes.len() > MOST_BYTES {
        return Err("a spreadsheet of at most 16 MB is read".to_owned());
    }
    let unreadable = |error: calamine::XlsxError| {
        format!("it cannot be read as a spreadsheet (XLSX): {error}; save it as CSV")
    };
    let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(unreadable)?;
    let names = book.sheet_names();
    let first = names.first().ok_or("it has no sheet")?;
    let mut cells = book.worksheet_cells_reader(first).map_err(unreadable)?;
    let mut writer = csv::WriterBuilder::new()
        .delimiter(b';')
        .flexible(true)
        .from_writer(Vec::new());
    let mut row: Vec<String> = Vec::new();
    let (mut at, mut count) = (0, 0);
    let broken = |error: csv::Error| error.to_string();
    let mut columns = 0;
    while let Some(cell) = cells.next_cell().map_err(unreadable)? {
        let (line, column) = cell.get_position();
        count += 1;
        if count > MOST_CELLS || column as usize > MOST_CELLS / (1 + line as usize) {
            return Err(format!("its first sheet has more than {MOST_CELLS} cells"));
        }
        while at < line {
            row.resize(columns.max(row.len()).max(2), String::new());
            columns = row.len();
            writer.write_record(&row).map_err(broken)?;
            row.clear();
            at += 1;
        }
        row.resize(column as usize, String::new());
        row.push(words(cell.get_value()));
    }
    row.resize(columns.max(row.len()).max(2), String::new());
    writer.write_record(&row).map_err(broken)?;
    let text = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(text).map_err(|error| error.to_string())
}

/// A cell as it would be typed.
fn words(cell: &DataRef<'_>) -> String {
    match Data::from(cell.clone()) {
        Data::Float(number) => number.to_string(),
        // The number behind a date counts days and is no length.
        Data::DateTime(_) | Data::DateTimeIso(_) | Data::DurationIso(_) => "a date".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(feature = "parquet")]
fn text_of_parquet(bytes: &[u8]) -> Result<String, String> {
    let text = kinetostat_formats::table_of_parquet(bytes)?;
    let text = String::from_utf8(text).map_err(|error| error.to_string())?;
    // The last column is the number of the row.
    let lines = text
        .lines()
        .map(|line| line.rsplit_once(',').map_or(line, |(own, _)| own));
    Ok(lines.flat_map(|line| [line, "\n"]).collect())
}

#[cfg(not(feature = "parquet"))]
fn text_of_parquet(_bytes: &[u8]) -> Result<String, String> {
    Err("this kinetostat does not read Parquet; save it as CSV".to_owned())
}
