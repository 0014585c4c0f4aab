//! The values of a column of a file in Parquet.

use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArray,
    FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96, Int96Type,
};
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedColumnWriter;

/// Limit of the rows of a file.
pub(crate) const MOST_ROWS: usize = 10_000_000;

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

pub(crate) fn of_reader(reader: ColumnReader, optional: bool) -> Result<Data, ParquetError> {
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

pub(crate) fn append(before: &mut Data, more: Data) -> Result<(), String> {
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
    pub(crate) fn row_count(&self) -> usize {
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

    pub(crate) fn taken(&self, rows: &[usize]) -> Self {
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

    pub(crate) fn write(
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
