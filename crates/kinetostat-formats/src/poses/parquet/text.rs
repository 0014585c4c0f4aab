//! A table in Parquet as text, and text in its place.

use parquet::file::metadata::KeyValue;

use crate::poses::cells::{PARQUET_ROW, cells_of};
use crate::poses::layout::{Named, layout_of};
use crate::poses::parquet::columns::Columns;
use crate::poses::parquet::data::{Data, Kind, printed, quoted};

/// Comments of the text are metadata under this key.
const KEY: &str = "kinetostat";

/// Limit of the bytes of the text.
const MOST_BYTES: usize = 1 << 28;

/// The table of a file in Parquet as CSV, for [`crate::read_poses`]: numbers and texts of all flat columns, and in a last
/// column which row of the file it is.
///
/// # Errors
/// In words, where the file is no Parquet, has lists or groups in its columns, or holds no numbers where a pose or a speed has
/// them.
pub fn table_of_parquet(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let columns = Columns::read(bytes)?;
    if columns.names.iter().any(|name| name == PARQUET_ROW) {
        return Err(format!(
            "it has a column `{PARQUET_ROW}`, which is made here: give that another name"
        ));
    }
    if columns.names.iter().any(|name| name.contains(['\n', '\r'])) {
        return Err("the name of a column goes over several lines: write it on one".to_owned());
    }
    refuse_other_types(&columns)?;
    let mut text = String::new();
    for own in columns.metadata.iter().filter(|own| own.key == KEY) {
        for line in own.value.iter().flat_map(|value| value.lines()) {
            text += &format!("# {line}\n");
        }
    }
    for name in &columns.names {
        text += &format!("{},", quoted(name));
    }
    text += PARQUET_ROW;
    text.push('\n');
    for row in 0..columns.rows {
        for (column, kind) in columns.columns.iter().zip(&columns.kinds) {
            text += &printed(column, *kind, row);
            text.push(',');
        }
        text += &format!("{row}\n");
        if text.len() > MOST_BYTES {
            return Err("its texts are longer than 256 MiB: divide it".to_owned());
        }
    }
    Ok(text.into_bytes())
}

/// Refuses columns of which a pose or a speed has its numbers, and that hold something else: all of them, in their order.
fn refuse_other_types(columns: &Columns) -> Result<(), String> {
    let named = columns.names.iter().map(|name| Named {
        name: name.clone(),
        span: 0..0,
    });
    // Faults of the names are reported where the table is read.
    let Ok(layout) = layout_of(&named.collect::<Vec<_>>(), &(0..0)) else {
        return Ok(());
    };
    let mut cells: Vec<usize> = layout.position.into_iter().flatten().collect();
    cells.extend(&layout.orientation);
    cells.extend(layout.joints.iter().map(|(cell, _)| *cell));
    cells.extend(layout.speed.map(|(cell, _)| cell));
    cells.extend(&layout.external);
    cells.sort_unstable();
    let others = cells.into_iter().filter_map(|cell| {
        let (name, kind) = (columns.names.get(cell)?, columns.kinds.get(cell)?);
        let of = columns.types.get(cell)?;
        (!kind.is_number()).then(|| format!("`{name}` of the type {of}"))
    });
    let others: Vec<String> = others.collect();
    match others.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "where numbers are needed it has the {} {}: write numbers there, of the type double",
            match others.len() {
                1 => "column",
                _ => "columns",
            },
            others.join(", ")
        )),
    }
}

/// A file in Parquet that was made of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ParquetFile {
    /// The file.
    pub bytes: Vec<u8>,
    /// Columns that could not hold what is written (whole numbers, numbers of few digits) and are of the type double now.
    pub widened: Vec<String>,
}

/// The file in Parquet with the numbers of a table that was made of it by [`table_of_parquet`] and corrected: the same
/// schema, and for each row of the table all values of the row that it is from. What did not change keeps its value; where
/// nothing changed, the file is the original, byte for byte. A column of numbers that cannot hold its new ones gets the type
/// double.
///
/// # Errors
/// In words, where the table is not of that file, or a column would get what is no number.
pub fn parquet_of_table(original: &[u8], table: &[u8]) -> Result<ParquetFile, String> {
    if table == table_of_parquet(original)? {
        return Ok(ParquetFile {
            bytes: original.to_vec(),
            widened: Vec::new(),
        });
    }
    let source = Columns::read(original)?;
    let read = rows_of(&source, table)?;
    let mut made = source.with_rows(&read.sources);
    let mut widened = Vec::new();
    for index in 0..made.columns.len() {
        let cell = match written(&mut made, index, &read.cells) {
            Ok(()) => continue,
            Err(cell) => cell,
        };
        let (name, of) = (&source.names[index], &source.types[index]);
        let refuse = || {
            format!(
                "its column `{name}` of the type {of} cannot hold {cell}: write it with the type double"
            )
        };
        if !made.kinds[index].is_number() {
            return Err(refuse());
        }
        made.widen(index)?;
        written(&mut made, index, &read.cells).map_err(|_| refuse())?;
        widened.push(name.clone());
    }
    made.metadata.retain(|own| own.key != KEY);
    if !read.header.is_empty() {
        let value = read.header.join("\n");
        made.metadata.push(KeyValue::new(KEY.to_owned(), value));
    }
    let bytes = made.file_bytes()?;
    Ok(ParquetFile { bytes, widened })
}

/// A table that was made of a file.
struct TableRows<'t> {
    /// Comments of the table.
    header: Vec<String>,
    /// Cells of the table, without the line of names.
    cells: Vec<Vec<&'t [u8]>>,
    /// Rows of the file from which the rows of the table come.
    sources: Vec<usize>,
}

fn rows_of<'t>(source: &Columns, table: &'t [u8]) -> Result<TableRows<'t>, String> {
    let foreign = || "the table is not of that file".to_owned();
    let mut header = Vec::new();
    let mut cells: Vec<Vec<&[u8]>> = Vec::new();
    let mut from = 0;
    for line in table.split_inclusive(|byte| *byte == b'\n') {
        let span = from..from + line.trim_ascii_end().len();
        from += line.len();
        if let Some(comment) = table[span.clone()].strip_prefix(b"#") {
            header.push(String::from_utf8_lossy(comment.trim_ascii()).into_owned());
            continue;
        }
        let found = cells_of(table, span, b',').map_err(|_| foreign())?;
        if found.len() != source.names.len() + 1 {
            return Err(foreign());
        }
        cells.push(found.into_iter().map(|cell| &table[cell]).collect());
    }
    if cells.is_empty() {
        return Err(foreign());
    }
    // The line of names.
    cells.remove(0);
    let mut sources = Vec::with_capacity(cells.len());
    for row in &cells {
        let last = row.last().and_then(|cell| std::str::from_utf8(cell).ok());
        let own: Option<usize> = last.and_then(|cell| cell.parse().ok());
        let own = own.filter(|own| *own < source.rows).ok_or_else(foreign)?;
        sources.push(own);
    }
    Ok(TableRows {
        header,
        cells,
        sources,
    })
}

/// Puts the cells of a column that changed in place of its values; the first one that it cannot hold.
fn written(made: &mut Columns, index: usize, cells: &[Vec<&[u8]>]) -> Result<(), String> {
    let kind = made.kinds[index];
    if !kind.is_number() && kind != Kind::Bool {
        // Texts are carried.
        return Ok(());
    }
    for (row, cells) in cells.iter().enumerate() {
        let cell = String::from_utf8_lossy(cells[index]);
        let column = &mut made.columns[index];
        let before = printed(column, kind, row);
        let number = |text: &str| text.parse::<f64>().ok();
        let is_same = cell == before || number(&cell).is_some() && number(&cell) == number(&before);
        if !is_same && put(column, kind, row, &cell).is_none() {
            return Err(cell.into_owned());
        }
    }
    Ok(())
}

/// Puts a number in place of that of a row; none where the column cannot hold it.
fn put(column: &mut Data, kind: Kind, row: usize, cell: &str) -> Option<()> {
    if matches!(kind, Kind::Decimal(_) | Kind::Half) {
        return None;
    }
    match column {
        Data::Bool(v) => v.put(row, bit(cell)?),
        Data::Int32(v) if kind == Kind::Unsigned => {
            v.put(row, u32::try_from(whole(cell)?).ok()?.cast_signed());
        }
        Data::Int64(v) if kind == Kind::Unsigned => {
            v.put(row, u64::try_from(whole(cell)?).ok()?.cast_signed());
        }
        Data::Int32(v) => v.put(row, i32::try_from(whole(cell)?).ok()?),
        Data::Int64(v) => v.put(row, whole(cell)?),
        Data::Float(v) => v.put(row, cell.parse().ok()?),
        Data::Double(v) => v.put(row, cell.parse().ok()?),
        Data::Bytes(_) | Data::Fixed(_) | Data::Int96(_) => {}
    }
    Some(())
}

/// The whole number that a cell says, up to those of which a number of 64 bits with a fraction knows all digits.
fn whole(cell: &str) -> Option<i64> {
    let value: f64 = cell.parse().ok()?;
    (value.fract() == 0.0 && value.abs() < 9e15).then_some(value as i64)
}

fn bit(cell: &str) -> Option<bool> {
    match cell {
        "0" => Some(false),
        "1" => Some(true),
        _ => None,
    }
}
