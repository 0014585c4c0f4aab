//! Parquet: a row for each place; columns of doubles, whose units and meanings stand in the metadata of the file.

use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::fields::grid::{FieldError, Fields};

/// Rows of a group.
const GROUP: usize = 1 << 20;

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
        for first in (0..self.len()).step_by(GROUP) {
            let end = self.len().min(first + GROUP);
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
