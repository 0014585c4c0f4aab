//! A table in Parquet as text, and text in its place.

use parquet::file::metadata::KeyValue;

use crate::poses::cells::{PARQUET_ROW, cells_of};
use crate::poses::parquet::columns::{Columns, Data};

/// Comments of the text are metadata under this key.
const KEY: &str = "kinetostat";

/// Most bytes of the text.
const MOST_BYTES: usize = 1 << 28;

/// The table of a file in Parquet as CSV, for [`crate::read_poses`]: numbers and texts of all flat columns, and in a last
/// column which row of the file it is.
///
/// # Errors
/// In words, where the file is no Parquet, or has lists or groups in its columns.
pub fn table_of_parquet(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let columns = Columns::read(bytes)?;
    if columns.names.iter().any(|name| name == PARQUET_ROW) {
        return Err(format!(
            "it has a column `{PARQUET_ROW}`, which is made here"
        ));
    }
    let mut text = String::new();
    for own in columns.metadata.iter().filter(|own| own.key == KEY) {
        for line in own.value.iter().flat_map(|value| value.lines()) {
            text += &format!("# {line}\n");
        }
    }
    for name in &columns.names {
        if name.contains(['\n', '\r']) {
            return Err("the name of a column goes over several lines".to_owned());
        }
        text += &format!("{},", quoted(name));
    }
    text += PARQUET_ROW;
    text.push('\n');
    for row in 0..columns.rows {
        for column in &columns.columns {
            text += &printed(column, row);
            text.push(',');
        }
        text += &format!("{row}\n");
        if text.len() > MOST_BYTES {
            return Err("its texts are longer than 256 MiB".to_owned());
        }
    }
    Ok(text.into_bytes())
}

/// The file in Parquet with the numbers of a table that was made of it by [`table_of_parquet`] and corrected: the same
/// schema, and for each row of the table all values of the row that it is from. What did not change keeps its value; where
/// nothing changed, the file is the original, byte for byte.
///
/// # Errors
/// In words, where the table is not of that file, or a column of whole numbers would get a fraction.
pub fn parquet_of_table(original: &[u8], table: &[u8]) -> Result<Vec<u8>, String> {
    if table == table_of_parquet(original)? {
        return Ok(original.to_vec());
    }
    let source = Columns::read(original)?;
    let foreign = || "the table is not of that file".to_owned();
    let mut header = Vec::new();
    let mut rows: Vec<Vec<&[u8]>> = Vec::new();
    let mut from = 0;
    for line in table.split_inclusive(|byte| *byte == b'\n') {
        let span = from..from + line.trim_ascii_end().len();
        from += line.len();
        if let Some(comment) = table[span.clone()].strip_prefix(b"#") {
            header.push(String::from_utf8_lossy(comment.trim_ascii()).into_owned());
            continue;
        }
        let cells = cells_of(table, span, b',').map_err(|_| foreign())?;
        rows.push(cells.into_iter().map(|cell| &table[cell]).collect());
    }
    if rows.first().map(Vec::len) != Some(source.names.len() + 1) {
        return Err(foreign());
    }
    let mut own = Vec::with_capacity(rows.len());
    for cells in rows.iter().skip(1) {
        let last = cells.last().and_then(|cell| std::str::from_utf8(cell).ok());
        let row: Option<usize> = last.and_then(|cell| cell.parse().ok());
        let row = row.filter(|row| *row < source.rows).ok_or_else(foreign)?;
        if cells.len() != source.names.len() + 1 {
            return Err(foreign());
        }
        own.push(row);
    }
    let mut made = source.taken(&own);
    for (index, column) in made.columns.iter_mut().enumerate() {
        let is_number = !matches!(column, Data::Bytes(_) | Data::Fixed(_) | Data::Int96(_));
        for (row, cells) in rows.iter().skip(1).enumerate().filter(|_| is_number) {
            let cell = String::from_utf8_lossy(cells[index]);
            if cell != printed(column, row) {
                put(column, row, &cell).ok_or_else(|| {
                    format!(
                        "its column `{}` cannot hold {cell}: write it with the type double",
                        source.names[index]
                    )
                })?;
            }
        }
    }
    made.metadata.retain(|own| own.key != KEY);
    if !header.is_empty() {
        let value = header.join("\n");
        made.metadata.push(KeyValue::new(KEY.to_owned(), value));
    }
    made.write()
}

/// A text as a cell: in quotes where it needs them; line ends are blanks.
fn quoted(text: &str) -> String {
    match text.contains([',', ';', '"', '\n', '\r', '\t', '#']) || text.trim() != text {
        true => format!(
            "\"{}\"",
            text.replace('"', "\"\"").replace(['\n', '\r'], " ")
        ),
        false => text.to_owned(),
    }
}

/// The cell of a row; empty where there is no value, or none that text can say.
fn printed(column: &Data, row: usize) -> String {
    fn of<V: ToString>(value: Option<V>) -> String {
        value.map_or_else(String::new, |value| value.to_string())
    }
    match column {
        Data::Bool(v) => of(v.at(row).map(|value| u8::from(*value))),
        Data::Int32(v) => of(v.at(row)),
        Data::Int64(v) => of(v.at(row)),
        Data::Float(v) => of(v.at(row)),
        Data::Double(v) => of(v.at(row)),
        Data::Bytes(v) => match v.at(row).and_then(|value| value.as_utf8().ok()) {
            Some(text) => quoted(text),
            None => String::new(),
        },
        Data::Int96(_) | Data::Fixed(_) => String::new(),
    }
}

/// Puts a number in place of that of a row; none where the column cannot hold it.
fn put(column: &mut Data, row: usize, cell: &str) -> Option<()> {
    match column {
        Data::Bool(v) => v.put(row, cell.parse::<u8>().ok()? != 0),
        Data::Int32(v) => v.put(row, whole(cell)? as i32),
        Data::Int64(v) => v.put(row, whole(cell)? as i64),
        Data::Float(v) => v.put(row, cell.parse().ok()?),
        Data::Double(v) => v.put(row, cell.parse().ok()?),
        Data::Bytes(_) | Data::Fixed(_) | Data::Int96(_) => {}
    }
    Some(())
}

fn whole(cell: &str) -> Option<f64> {
    let value: f64 = cell.parse().ok()?;
    (value.fract() == 0.0 && value.abs() < 2e9).then_some(value)
}
