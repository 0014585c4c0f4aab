//! Tables: a line of names, then a pose or joint values a line.

use std::ops::Range;

use crate::poses::cells::{PARQUET_ROW, cells_of, number_of, separator_of};
use crate::poses::layout::{Named, layout_of};
use crate::poses::row::{PART, RowContext, Rows, row_of};
use crate::poses::table::TABLE_HELP;
use crate::text::source::SourceFile;
use crate::text::source::beginning;

const QUOTE: (&str, &str) = (
    "a quote is not closed on its line, or something stands behind it",
    "close it, or double it inside a text",
);

/// Reads a table; its unit where the names say it is that of the layout.
pub(crate) fn read_table(file: &SourceFile) -> (Rows, Option<crate::options::LengthUnit>) {
    let bytes = file.bytes();
    let mut rows = Rows::default();
    let mut lines = lines_of(bytes, beginning(bytes));
    let Some(head) = lines.next() else {
        rows.fault(file, &(0..0), "the table is empty", TABLE_HELP);
        return (rows, None);
    };
    let separator = separator_of(file.part(&head));
    let Ok(names) = cells_of(bytes, head.clone(), separator) else {
        rows.fault(file, &head, QUOTE.0, QUOTE.1);
        return (rows, None);
    };
    if names.iter().any(|name| number_of(bytes, name).is_some()) {
        let reason = "the first line holds numbers: what they are and in which unit is not stated";
        rows.fault(file, &head, reason, TABLE_HELP);
        return (rows, None);
    }
    let count = names.len();
    let names: Vec<Named> = names
        .into_iter()
        .map(|span| Named {
            name: String::from_utf8_lossy(file.part(&span)).into_owned(),
            span,
        })
        .collect();
    let layout = match layout_of(&names, &head) {
        Ok(layout) => layout,
        Err(faults) => {
            for (span, reason, remedy) in faults {
                rows.fault(file, &span, reason, remedy);
            }
            return (rows, None);
        }
    };
    let carried: Vec<&str> = (layout.carried.iter())
        .map(|cell| names[*cell].name.as_str())
        .filter(|name| !name.is_empty() && *name != PARQUET_ROW)
        .collect();
    if !carried.is_empty() {
        let message = format!(
            "columns that are carried as they are: {}",
            carried.join(", ")
        );
        rows.findings.push((head.start, message));
    }
    let mut raster: Option<&[u8]> = None;
    let mut first = true;
    for line in lines {
        let cells = match cells_of(bytes, line.clone(), separator) {
            Ok(cells) => cells,
            Err(span) => {
                rows.fault(file, &span, QUOTE.0, QUOTE.1);
                continue;
            }
        };
        if cells.len() != count {
            let reason = format!(
                "it has {} cells, the line of names has {count}",
                cells.len()
            );
            let remedy = match separator {
                b',' => "write as many; a decimal comma cannot stand beside commas between cells",
                _ => "write as many, with the separator of the line of names",
            };
            rows.fault(file, &line, reason, remedy);
            continue;
        }
        let own = layout.raster.map(|cell| file.part(&cells[cell]));
        first |= own != raster;
        raster = own;
        let context = RowContext {
            layout: &layout,
            span: line,
            first,
            frame: PART,
            indivisible: None,
        };
        first = false;
        let row = row_of(file, context, &cells, &mut rows);
        rows.rows.extend(row);
    }
    (rows, layout.unit)
}

/// The row of the file in Parquet, counted from 0, that a line of a table is of; none where the table is of no such file.
pub(crate) fn parquet_row(file: &SourceFile, line: &Range<usize>) -> Option<usize> {
    let bytes = file.bytes();
    let head = lines_of(bytes, beginning(bytes)).next()?;
    file.part(&head).strip_suffix(PARQUET_ROW.as_bytes())?;
    let rest = &bytes[line.start.min(bytes.len())..];
    let end = rest.iter().position(|byte| *byte == b'\n');
    let text = rest[..end.unwrap_or(rest.len())].trim_ascii_end();
    let last = text.rsplit(|byte| *byte == b',').next()?;
    std::str::from_utf8(last).ok()?.parse().ok()
}

/// Lines from a place on that are neither empty nor comments, without blanks around them.
pub(crate) fn lines_of(bytes: &[u8], from: usize) -> impl Iterator<Item = Range<usize>> {
    let mut at = from;
    std::iter::from_fn(move || {
        while at < bytes.len() {
            let end = bytes[at..].iter().position(|byte| *byte == b'\n');
            let line = at..end.map_or(bytes.len(), |end| at + end);
            at = line.end + 1;
            // A tab at an end may be an empty cell.
            let is_end = |byte: u8| matches!(byte, b' ' | b'\r');
            let Some(start) = line.clone().find(|at| !is_end(bytes[*at])) else {
                continue;
            };
            let last = line.rev().find(|at| !is_end(bytes[*at])).unwrap_or(start);
            let line = start..last + 1;
            let is_empty = bytes[line.clone()].iter().all(u8::is_ascii_whitespace);
            if bytes[start] != b'#' && !is_empty {
                return Some(line);
            }
        }
        None
    })
}
