//! Tables: a line of names, then a pose or joint values a line; with decimal commas, too, as spreadsheets in German or French write them.

use std::ops::Range;

use crate::poses::cells::{PARQUET_ROW, cells_of, number_of, separator_of};
use crate::poses::columns::TABLE_HELP;
use crate::poses::layout::{Named, layout_of};
use crate::poses::row::{PART, RowContext, Rows, row_of};
use crate::text::source::{SourceFile, beginning};

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

// Tables with decimal commas, as spreadsheets in German or French write them: semicolons or tabs between cells.

/// The table with points in place of its decimal commas, byte for byte in the same places; none where it has no such commas, or points
/// too.
pub(crate) fn with_points(file: &SourceFile) -> Option<SourceFile> {
    let mut commas = Vec::new();
    for cell in cells(file) {
        let mut text = file.part(&cell).to_vec();
        let Some(mark) = text.iter().position(|byte| matches!(byte, b',' | b'.')) else {
            continue;
        };
        let is_comma = std::mem::replace(&mut text[mark], b'.') == b',';
        match (number_of(&text, &(0..text.len())), is_comma) {
            (Some(_), true) => commas.push(cell.start + mark),
            // The decimal point could precede thousandths or group thousands.
            (Some(_), false) => return None,
            (None, _) => {}
        }
    }
    (!commas.is_empty()).then(|| {
        let mut points = file.bytes().to_vec();
        for at in commas {
            points[at] = b'.';
        }
        SourceFile::new(file.name(), points)
    })
}

/// A written table with commas in place of the points of its numbers.
pub(crate) fn with_commas(name: &str, bytes: Vec<u8>) -> Vec<u8> {
    let file = SourceFile::new(name, bytes);
    let mut commas = file.bytes().to_vec();
    for cell in cells(&file).filter(|cell| number_of(file.bytes(), cell).is_some()) {
        if let Some(point) = cell.clone().find(|at| commas[*at] == b'.') {
            commas[point] = b',';
        }
    }
    commas
}

/// The cells below the line of names of a table between whose cells no commas stand.
fn cells(file: &SourceFile) -> impl Iterator<Item = Range<usize>> {
    let bytes = file.bytes();
    let mut lines = lines_of(bytes, beginning(bytes));
    let head = lines.next().filter(|_| Carrier::of(file) == Carrier::Table);
    let separator = head.map_or(b',', |head| separator_of(file.part(&head)));
    lines
        .take_while(move |_| separator != b',')
        .flat_map(move |line| cells_of(bytes, line, separator).unwrap_or_default())
}

/// Format of a list of poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carrier {
    /// Lines of cells below a line of names.
    Table,
    /// YAML.
    Yaml,
}
impl Carrier {
    /// Format by the file ending; if that is unknown, by the first line that is neither empty nor a comment.
    pub(crate) fn of(file: &SourceFile) -> Self {
        let ending = file.name().rsplit_once('.').map(|(_, ending)| ending);
        match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("csv" | "tsv" | "parquet") => return Self::Table,
            Some("yaml" | "yml") => return Self::Yaml,
            _ => {}
        }
        let text = &file.bytes()[beginning(file.bytes())..];
        let line = text
            .split(|byte| *byte == b'\n')
            .map(<[u8]>::trim_ascii)
            .find(|line| !line.is_empty() && !line.starts_with(b"#"));
        let is_yaml = |line: &[u8]| {
            line.starts_with(b"- ")
                || line == b"-"
                || line.starts_with(b"---")
                || line.starts_with(b"%YAML")
                || line.starts_with(b"{")
                || line.starts_with(b"[")
                || line.ends_with(b":")
                || line.windows(2).any(|pair| pair == b": ")
        };
        match line.is_some_and(is_yaml) {
            true => Self::Yaml,
            false => Self::Table,
        }
    }
}
