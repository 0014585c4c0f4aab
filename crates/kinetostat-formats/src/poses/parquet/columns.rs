//! The values of a file in Parquet, column by column.

use bytes::Bytes;
use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArray,
    FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96, Int96Type,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnPath, TypePtr};

/// Most rows of a file.
const MOST_ROWS: usize = 10_000_000;

/// Values of a column: those that are there, and for each row which of them is its own.
#[derive(Debug, Clone)]
pub(crate) struct Values<V> {
    pub values: Vec<V>,
    pub of_row: Vec<Option<usize>>,
}

/// A column.
#[derive(Debug, Clone)]
pub(crate) enum Data {
    Bool(Values<bool>),
    Int32(Values<i32>),
    Int64(Values<i64>),
    Int96(Values<Int96>),
    Float(Values<f32>),
    Double(Values<f64>),
    Bytes(Values<ByteArray>),
    Fixed(Values<FixedLenByteArray>),
}

/// A file.
#[derive(Debug)]
pub(crate) struct Columns {
    pub names: Vec<String>,
    pub columns: Vec<Data>,
    pub rows: usize,
    pub metadata: Vec<KeyValue>,
    paths: Vec<(ColumnPath, Compression, bool)>,
    schema: TypePtr,
}

/// A fault of Parquet in words.
pub(crate) fn words(error: ParquetError) -> String {
    format!("it is no Parquet that is read here: {error}")
}

impl Columns {
    /// Reads all of a file.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(words)?;
        let metadata = reader.metadata().file_metadata().clone();
        let rows = usize::try_from(metadata.num_rows()).unwrap_or(usize::MAX);
        if rows > MOST_ROWS {
            return Err(format!("it has {rows} rows, {MOST_ROWS} are read"));
        }
        let description = metadata.schema_descr();
        let mut columns: Vec<Data> = Vec::new();
        let (mut names, mut paths) = (Vec::new(), Vec::new());
        for (index, column) in description.columns().iter().enumerate() {
            if column.max_rep_level() > 0
                || column.max_def_level() > 1
                || column.path().parts().len() != 1
            {
                return Err(format!(
                    "its column `{}` is a list or a group",
                    column.path().string()
                ));
            }
            let codec = match reader.metadata().row_groups().first() {
                Some(group) => group.column(index).compression(),
                None => Compression::UNCOMPRESSED,
            };
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
        if columns.iter().any(|column| column.rows() != rows) {
            return Err("its columns have other numbers of rows than it states".to_owned());
        }
        Ok(Self {
            names,
            columns,
            rows,
            metadata: metadata.key_value_metadata().cloned().unwrap_or_default(),
            paths,
            schema: description.root_schema_ptr(),
        })
    }

    /// Writes a file with its schema.
    pub(crate) fn write(&self) -> Result<Vec<u8>, String> {
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

    /// The rows that are named, in their order.
    pub(crate) fn taken(&self, rows: &[usize]) -> Self {
        Self {
            names: self.names.clone(),
            columns: self
                .columns
                .iter()
                .map(|column| column.taken(rows))
                .collect(),
            rows: rows.len(),
            metadata: self.metadata.clone(),
            paths: self.paths.clone(),
            schema: self.schema.clone(),
        }
    }
}

fn read_all<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    optional: bool,
) -> Result<Values<T::T>, ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let mut count = 0;
    loop {
        let levels = optional.then_some(&mut levels);
        let (records, _, _) = reader.read_records(1 << 16, levels, None, &mut values)?;
        count += records;
        if records == 0 || count > MOST_ROWS {
            break;
        }
    }
    let mut next = 0;
    let mut own = |is_there: bool| {
        let index = next;
        next += usize::from(is_there);
        is_there.then_some(index)
    };
    let of_row = match optional {
        true => levels.iter().map(|level| own(*level > 0)).collect(),
        false => (0..count).map(|_| own(true)).collect(),
    };
    Ok(Values { values, of_row })
}

fn of_reader(reader: ColumnReader, optional: bool) -> Result<Data, ParquetError> {
    Ok(match reader {
        ColumnReader::BoolColumnReader(r) => Data::Bool(read_all::<BoolType>(r, optional)?),
        ColumnReader::Int32ColumnReader(r) => Data::Int32(read_all::<Int32Type>(r, optional)?),
        ColumnReader::Int64ColumnReader(r) => Data::Int64(read_all::<Int64Type>(r, optional)?),
        ColumnReader::Int96ColumnReader(r) => Data::Int96(read_all::<Int96Type>(r, optional)?),
        ColumnReader::FloatColumnReader(r) => Data::Float(read_all::<FloatType>(r, optional)?),
        ColumnReader::DoubleColumnReader(r) => Data::Double(read_all::<DoubleType>(r, optional)?),
        ColumnReader::ByteArrayColumnReader(r) => {
            Data::Bytes(read_all::<ByteArrayType>(r, optional)?)
        }
        ColumnReader::FixedLenByteArrayColumnReader(r) => {
            Data::Fixed(read_all::<FixedLenByteArrayType>(r, optional)?)
        }
    })
}

impl<V: Clone> Values<V> {
    /// The value of a row.
    pub(crate) fn at(&self, row: usize) -> Option<&V> {
        self.values.get((*self.of_row.get(row)?)?)
    }

    fn append(&mut self, more: Self) {
        let from = self.values.len();
        self.values.extend(more.values);
        let moved = more.of_row.into_iter().map(|own| own.map(|own| own + from));
        self.of_row.extend(moved);
    }

    fn taken(&self, rows: &[usize]) -> Self {
        let mut taken = Self {
            values: Vec::with_capacity(rows.len()),
            of_row: Vec::with_capacity(rows.len()),
        };
        for row in rows {
            let value = self.at(*row);
            taken.of_row.push(value.map(|_| taken.values.len()));
            taken.values.extend(value.cloned());
        }
        taken
    }

    /// Puts a value in place of that of a row, where there is one.
    pub(crate) fn put(&mut self, row: usize, value: V) {
        let own = self.of_row.get(row).copied().flatten();
        if let Some(place) = own.and_then(|own| self.values.get_mut(own)) {
            *place = value;
        }
    }

    fn levels(&self, optional: bool) -> Option<Vec<i16>> {
        let level = |own: &Option<usize>| i16::from(own.is_some());
        optional.then(|| self.of_row.iter().map(level).collect())
    }
}

fn append(before: &mut Data, more: Data) -> Result<(), String> {
    match (before, more) {
        (Data::Bool(a), Data::Bool(b)) => a.append(b),
        (Data::Int32(a), Data::Int32(b)) => a.append(b),
        (Data::Int64(a), Data::Int64(b)) => a.append(b),
        (Data::Int96(a), Data::Int96(b)) => a.append(b),
        (Data::Float(a), Data::Float(b)) => a.append(b),
        (Data::Double(a), Data::Double(b)) => a.append(b),
        (Data::Bytes(a), Data::Bytes(b)) => a.append(b),
        (Data::Fixed(a), Data::Fixed(b)) => a.append(b),
        _ => return Err("a column changes its type".to_owned()),
    }
    Ok(())
}

impl Data {
    fn rows(&self) -> usize {
        match self {
            Self::Bool(v) => v.of_row.len(),
            Self::Int32(v) => v.of_row.len(),
            Self::Int64(v) => v.of_row.len(),
            Self::Int96(v) => v.of_row.len(),
            Self::Float(v) => v.of_row.len(),
            Self::Double(v) => v.of_row.len(),
            Self::Bytes(v) => v.of_row.len(),
            Self::Fixed(v) => v.of_row.len(),
        }
    }

    fn taken(&self, rows: &[usize]) -> Self {
        match self {
            Self::Bool(v) => Self::Bool(v.taken(rows)),
            Self::Int32(v) => Self::Int32(v.taken(rows)),
            Self::Int64(v) => Self::Int64(v.taken(rows)),
            Self::Int96(v) => Self::Int96(v.taken(rows)),
            Self::Float(v) => Self::Float(v.taken(rows)),
            Self::Double(v) => Self::Double(v.taken(rows)),
            Self::Bytes(v) => Self::Bytes(v.taken(rows)),
            Self::Fixed(v) => Self::Fixed(v.taken(rows)),
        }
    }

    fn write(
        &self,
        writer: &mut SerializedColumnWriter<'_>,
        optional: bool,
    ) -> Result<usize, ParquetError> {
        fn one<T: DataType>(
            writer: &mut SerializedColumnWriter<'_>,
            values: &Values<T::T>,
            optional: bool,
        ) -> Result<usize, ParquetError> {
            let levels = values.levels(optional);
            let writer = writer.typed::<T>();
            writer.write_batch(&values.values, levels.as_deref(), None)
        }
        match self {
            Self::Bool(v) => one::<BoolType>(writer, v, optional),
            Self::Int32(v) => one::<Int32Type>(writer, v, optional),
            Self::Int64(v) => one::<Int64Type>(writer, v, optional),
            Self::Int96(v) => one::<Int96Type>(writer, v, optional),
            Self::Float(v) => one::<FloatType>(writer, v, optional),
            Self::Double(v) => one::<DoubleType>(writer, v, optional),
            Self::Bytes(v) => one::<ByteArrayType>(writer, v, optional),
            Self::Fixed(v) => one::<FixedLenByteArrayType>(writer, v, optional),
        }
    }
}
