//! Tables as Parquet files: row after row, columns of numbers or texts, or a row for each place of a grid.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::fields::grid::{FieldError, Fields};

/// Rows of a group: some megabytes in memory.
const GROUP: usize = 1 << 16;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct RowColumn {
    /// Name: letters, digits and `_`.
    pub name: String,
    /// Unit; `1` for a number without one, empty for texts.
    pub unit: String,
    /// Description of the column.
    pub description: String,
    /// The column contains texts, not numbers.
    pub is_text: bool,
}

/// A cell of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number; NaN where there is none.
    Number(f64),
    /// A text.
    Text(&'a str),
}

enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<ByteArray>),
}

/// Writes a table to a sink.
pub struct RowsWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    columns: Vec<Values>,
    rows: usize,
}

impl<W: Write + Send> RowsWriter<W> {
    /// Begins a table. The metadata has `unit.NAME` and `description.NAME` of each column, and the facts.
    ///
    /// # Errors
    /// A fault of the sink, or a name that is none of a column.
    pub fn new(
        sink: W,
        columns: &[RowColumn],
        facts: &[(String, String)],
    ) -> Result<Self, FieldError> {
        Self::begun(sink, columns, facts).map_err(failed)
    }

    fn begun(
        sink: W,
        columns: &[RowColumn],
        facts: &[(String, String)],
    ) -> Result<Self, ParquetError> {
        let fields = columns.iter().map(|column| {
            let (kind, logical) = match column.is_text {
                true => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
                false => (Physical::DOUBLE, None),
            };
            Type::primitive_type_builder(&column.name, kind)
                .with_repetition(Repetition::REQUIRED)
                .with_logical_type(logical)
                .build()
                .map(Arc::new)
        });
        let fields = fields.collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder("points")
            .with_fields(fields)
            .build()?;
        let mut known: Vec<KeyValue> = Vec::new();
        let mut fact = |name: String, text: &str| known.push(KeyValue::new(name, text.to_owned()));
        facts
            .iter()
            .for_each(|(name, text)| fact(name.clone(), text));
        for column in columns {
            fact(format!("unit.{}", column.name), &column.unit);
            fact(format!("description.{}", column.name), &column.description);
        }
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(known))
            .build();
        let file = SerializedFileWriter::new(sink, Arc::new(schema), Arc::new(properties))?;
        let columns = columns.iter().map(|column| match column.is_text {
            true => Values::Texts(Vec::new()),
            false => Values::Numbers(Vec::new()),
        });
        Ok(Self {
            file,
            columns: columns.collect(),
            rows: 0,
        })
    }

    /// Adds a row. A number in a column of texts is left empty there, a text in one of numbers is NaN, and so is what is missing.
    ///
    /// # Errors
    /// A fault of the sink.
    pub fn push<'c>(
        &mut self,
        cells: impl IntoIterator<Item = Cell<'c>>,
    ) -> Result<(), FieldError> {
        let mut cells = cells.into_iter();
        for column in &mut self.columns {
            match (column, cells.next()) {
                (Values::Numbers(all), Some(Cell::Number(x))) => all.push(x),
                (Values::Numbers(all), _) => all.push(f64::NAN),
                (Values::Texts(all), Some(Cell::Text(text))) => all.push(text.into()),
                (Values::Texts(all), _) => all.push("".into()),
            }
        }
        self.rows += 1;
        match self.rows == GROUP {
            true => self.write_group().map_err(failed),
            false => Ok(()),
        }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for values in &mut self.columns {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            match values {
                Values::Numbers(all) => {
                    column.typed::<DoubleType>().write_batch(all, None, None)?;
                    all.clear();
                }
                Values::Texts(all) => {
                    column
                        .typed::<ByteArrayType>()
                        .write_batch(all, None, None)?;
                    all.clear();
                }
            }
            column.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }

    /// Writes what is left, and the end of the file.
    ///
    /// # Errors
    /// A fault of the sink.
    pub fn finish(mut self) -> Result<(), FieldError> {
        if self.rows > 0 {
            self.write_group().map_err(failed)?;
        }
        self.file.close().map(|_| ()).map_err(failed)
    }
}

fn failed(error: ParquetError) -> FieldError {
    FieldError(error.to_string())
}

// A row for each place of a grid; columns of doubles, whose units and meanings stand in the metadata of the file.

/// Rows of a group.
const ROWS_OF_GRID: usize = 1 << 20;

impl Fields {
    /// Writes a Parquet file. The metadata has `unit.NAME` and `description.NAME` for each column.
    ///
    /// # Errors
    /// A fault of the writer.
    pub fn parquet(&self) -> Result<Vec<u8>, FieldError> {
        self.rows().map_err(|e| FieldError(e.to_string()))
    }

    fn rows(&self) -> Result<Vec<u8>, ParquetError> {
        let names = self.axes.iter().map(|a| &a.name);
        let names = names.chain(self.columns.iter().map(|c| &c.name));
        let fields = names.map(|name| {
            let own = Type::primitive_type_builder(name, Physical::DOUBLE);
            own.with_repetition(Repetition::REQUIRED)
                .build()
                .map(Arc::new)
        });
        let fields = fields.collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder("map")
            .with_fields(fields)
            .build()?;
        let mut facts = vec![KeyValue::new("title".to_owned(), self.title.clone())];
        let mut fact = |name: String, text: &str| facts.push(KeyValue::new(name, text.to_owned()));
        self.facts
            .iter()
            .for_each(|(name, text)| fact(name.clone(), text));
        for axis in &self.axes {
            fact(format!("unit.{}", axis.name), &axis.unit);
        }
        for column in &self.columns {
            fact(format!("unit.{}", column.name), &column.unit);
            fact(format!("description.{}", column.name), &column.description);
        }
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(facts))
            .build();
        let mut out = Vec::new();
        let mut file = SerializedFileWriter::new(&mut out, Arc::new(schema), Arc::new(properties))?;
        let coordinates = [0, 1, 2].map(|axis| self.coordinates(axis));
        let all = coordinates
            .iter()
            .chain(self.columns.iter().map(|c| &c.values));
        let all: Vec<&Vec<f64>> = all.collect();
        for first in (0..self.len()).step_by(ROWS_OF_GRID) {
            let end = self.len().min(first + ROWS_OF_GRID);
            let mut group = file.next_row_group()?;
            for values in &all {
                let Some(mut column) = group.next_column()? else {
                    break;
                };
                column
                    .typed::<DoubleType>()
                    .write_batch(&values[first..end], None, None)?;
                column.close()?;
            }
            group.close()?;
        }
        file.close()?;
        Ok(out)
    }
}
