//! The columns of a file in Parquet, read and written.

use bytes::Bytes;
use parquet::basic::{Compression, Type as PhysicalType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type, TypePtr};

use crate::poses::parquet::data::{
    Data, Kind, MOST_ROWS, Values, append, of_reader, printed, type_of,
};

/// Metadata key of Arrow's own schema.
const ARROW: &str = "ARROW:schema";

/// A file.
#[derive(Debug)]
pub(crate) struct Columns {
    pub names: Vec<String>,
    pub columns: Vec<Data>,
    pub kinds: Vec<Kind>,
    /// Their types for people.
    pub types: Vec<String>,
    pub rows: usize,
    pub metadata: Vec<KeyValue>,
    paths: Vec<(ColumnPath, Compression, bool)>,
    schema: TypePtr,
}

/// A fault of Parquet in words.
pub(crate) fn words(error: ParquetError) -> String {
    format!("it is no Parquet that is read here ({error}): write it anew, without encryption")
}

impl Columns {
    /// Reads all of a file.
    ///
    /// The library asserts what a whole file holds (pages inside of it, a dictionary before those that refer to one, lengths of
    /// texts); a panic in it says that the file is broken, and ends nothing else: what it had made is dropped.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        std::panic::catch_unwind(|| Self::read_whole(bytes)).unwrap_or_else(|_| {
            Err("its pages do not hold what its end says of them: the file is broken, write it anew".to_owned())
        })
    }

    fn read_whole(bytes: &[u8]) -> Result<Self, String> {
        let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(words)?;
        let metadata = reader.metadata().file_metadata().clone();
        let rows = usize::try_from(metadata.num_rows()).unwrap_or(usize::MAX);
        if rows > MOST_ROWS {
            return Err(format!(
                "it has {rows} rows, and at most {MOST_ROWS} are read: divide it"
            ));
        }
        let description = metadata.schema_descr();
        let mut columns: Vec<Data> = Vec::new();
        let (mut names, mut paths) = (Vec::new(), Vec::new());
        let (mut kinds, mut types) = (Vec::new(), Vec::new());
        for (index, column) in description.columns().iter().enumerate() {
            if column.max_rep_level() > 0
                || column.max_def_level() > 1
                || column.path().parts().len() != 1
            {
                return Err(format!(
                    "its column `{}` is a list or a group, and only columns with one value a row are read: leave it out, or write its values as columns",
                    column.path().string()
                ));
            }
            let codec = match reader.metadata().row_groups().first() {
                Some(group) => group.column(index).compression(),
                None => Compression::UNCOMPRESSED,
            };
            kinds.push(Kind::of(column));
            types.push(type_of(column));
            names.push(column.name().to_owned());
            paths.push((column.path().clone(), codec, column.max_def_level() > 0));
        }
        for group in 0..reader.num_row_groups() {
            let group = reader.get_row_group(group).map_err(words)?;
            for (index, (_, _, optional)) in paths.iter().enumerate() {
                let column = group.get_column_reader(index).map_err(words)?;
                let read = of_reader(column, *optional).map_err(words)?;
                match columns.get_mut(index) {
                    Some(before) => append(before, read)?,
                    None => columns.push(read),
                }
            }
        }
        if columns.iter().any(|column| column.row_count() != rows) {
            return Err("its columns have other numbers of rows than it states".to_owned());
        }
        Ok(Self {
            names,
            columns,
            kinds,
            types,
            rows,
            metadata: metadata.key_value_metadata().cloned().unwrap_or_default(),
            paths,
            schema: description.root_schema_ptr(),
        })
    }

    /// Writes a file with its schema.
    pub(crate) fn file_bytes(&self) -> Result<Vec<u8>, String> {
        let mut properties = WriterProperties::builder();
        if !self.metadata.is_empty() {
            properties = properties.set_key_value_metadata(Some(self.metadata.clone()));
        }
        for (path, codec, _) in &self.paths {
            properties = properties.set_column_compression(path.clone(), *codec);
        }
        let mut bytes = Vec::new();
        let properties = properties.build().into();
        let mut file = SerializedFileWriter::new(&mut bytes, self.schema.clone(), properties)
            .map_err(words)?;
        let mut group = file.next_row_group().map_err(words)?;
        for (column, (_, _, optional)) in self.columns.iter().zip(&self.paths) {
            let writer = group.next_column().map_err(words)?;
            let mut writer = writer.ok_or("its schema has fewer columns than it")?;
            column.write(&mut writer, *optional).map_err(words)?;
            writer.close().map_err(words)?;
        }
        group.close().map_err(words)?;
        file.close().map_err(words)?;
        Ok(bytes)
    }

    /// Makes a column one of the type double, which holds all its numbers.
    pub(crate) fn widen(&mut self, index: usize) -> Result<(), String> {
        let (column, kind) = (&self.columns[index], self.kinds[index]);
        let cells = (0..self.rows).map(|row| printed(column, kind, row).parse().ok());
        let cells: Vec<Option<f64>> = cells.collect();
        let mut wide = Values {
            values: Vec::with_capacity(cells.len()),
            of_row: Vec::with_capacity(cells.len()),
        };
        for cell in cells {
            wide.of_row.push(cell.map(|_| wide.values.len()));
            wide.values.extend(cell);
        }
        self.columns[index] = Data::Double(wide);
        self.kinds[index] = Kind::Number;
        self.types[index] = PhysicalType::DOUBLE.to_string();
        let mut fields = self.schema.get_fields().to_vec();
        let field = fields
            .get_mut(index)
            .ok_or("its schema has no such column")?;
        let made = Type::primitive_type_builder(field.name(), PhysicalType::DOUBLE)
            .with_repetition(field.get_basic_info().repetition())
            .build()
            .map_err(words)?;
        *field = made.into();
        let root = Type::group_type_builder(self.schema.name()).with_fields(fields);
        self.schema = root.build().map_err(words)?.into();
        // The schema of Arrow, which readers would put over that of the file.
        self.metadata.retain(|own| own.key != ARROW);
        Ok(())
    }

    /// The rows that are named, in their order.
    pub(crate) fn with_rows(&self, rows: &[usize]) -> Self {
        Self {
            names: self.names.clone(),
            columns: self
                .columns
                .iter()
                .map(|column| column.taken(rows))
                .collect(),
            kinds: self.kinds.clone(),
            types: self.types.clone(),
            rows: rows.len(),
            metadata: self.metadata.clone(),
            paths: self.paths.clone(),
            schema: self.schema.clone(),
        }
    }
}
