//! Value types of a column of a file in Parquet, and its values.

use parquet::basic::{ConvertedType, LogicalType, Type as PhysicalType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArray,
    FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96, Int96Type,
};
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedColumnWriter;
use parquet::schema::types::ColumnDescriptor;

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

// Source: Apache Parquet format 2, logical types.

/// Value type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Stored number: signed integers, and floats of 32 and 64 bits.
    Number,
    /// Unsigned integer.
    Unsigned,
    /// Fixed-point number with so many decimals.
    Decimal(u32),
    /// Numbers of 16 bits with a fraction.
    Half,
    /// Yes or no.
    Bool,
    /// Text.
    Text,
    /// A date, or a time.
    Time,
    /// Bytes that text cannot say.
    Other,
}

impl Kind {
    pub(crate) fn of(column: &ColumnDescriptor) -> Self {
        let whole = matches!(
            column.physical_type(),
            PhysicalType::INT32 | PhysicalType::INT64
        );
        let scale = || u32::try_from(column.type_scale()).unwrap_or(0);
        match column.logical_type_ref() {
            Some(LogicalType::Integer(of)) if !of.is_signed => return Self::Unsigned,
            Some(LogicalType::Decimal(_)) => return Self::Decimal(scale()),
            Some(LogicalType::Float16) => return Self::Half,
            _ => {}
        }
        match column.converted_type() {
            ConvertedType::DECIMAL => return Self::Decimal(scale()),
            ConvertedType::UINT_8
            | ConvertedType::UINT_16
            | ConvertedType::UINT_32
            | ConvertedType::UINT_64 => return Self::Unsigned,
            ConvertedType::INT_8
            | ConvertedType::INT_16
            | ConvertedType::INT_32
            | ConvertedType::INT_64 => return Self::Number,
            _ => {}
        }
        let is_plain = matches!(
            column.logical_type_ref(),
            None | Some(LogicalType::Integer(_))
        );
        match column.physical_type() {
            PhysicalType::BOOLEAN => Self::Bool,
            PhysicalType::FLOAT | PhysicalType::DOUBLE => Self::Number,
            _ if whole && is_plain && column.converted_type() == ConvertedType::NONE => {
                Self::Number
            }
            PhysicalType::INT32 | PhysicalType::INT64 | PhysicalType::INT96 => Self::Time,
            PhysicalType::BYTE_ARRAY => Self::Text,
            PhysicalType::FIXED_LEN_BYTE_ARRAY => Self::Other,
        }
    }

    pub(crate) fn is_number(self) -> bool {
        matches!(
            self,
            Self::Number | Self::Unsigned | Self::Decimal(_) | Self::Half
        )
    }
}

/// The type of a column for people, as in `INT64 (TIMESTAMP_MILLIS)`.
pub(crate) fn type_of(column: &ColumnDescriptor) -> String {
    match column.converted_type() {
        ConvertedType::NONE => column.physical_type().to_string(),
        of => format!("{} ({of})", column.physical_type()),
    }
}

/// The cell of a row; empty where there is no value, or none that text can say.
pub(crate) fn printed(column: &Data, kind: Kind, row: usize) -> String {
    fn of<V: ToString>(value: Option<V>) -> String {
        value.map_or_else(String::new, |value| value.to_string())
    }
    let decimal = |value: Option<i128>, digits: u32| {
        value.map_or_else(String::new, |value| with_point(value, digits))
    };
    match (column, kind) {
        (Data::Bool(v), _) => of(v.at(row).map(|value| u8::from(*value))),
        (Data::Int32(v), Kind::Unsigned) => of(v.at(row).map(|value| value.cast_unsigned())),
        (Data::Int64(v), Kind::Unsigned) => of(v.at(row).map(|value| value.cast_unsigned())),
        (Data::Int32(v), Kind::Decimal(n)) => decimal(v.at(row).map(|x| i128::from(*x)), n),
        (Data::Int64(v), Kind::Decimal(n)) => decimal(v.at(row).map(|x| i128::from(*x)), n),
        (Data::Bytes(v), Kind::Decimal(n)) => decimal(v.at(row).and_then(|x| whole(x.data())), n),
        (Data::Fixed(v), Kind::Decimal(n)) => decimal(v.at(row).and_then(|x| whole(x.data())), n),
        (Data::Fixed(v), Kind::Half) => of(v.at(row).and_then(|x| half(x.data()))),
        (Data::Int32(v), _) => of(v.at(row)),
        (Data::Int64(v), _) => of(v.at(row)),
        (Data::Float(v), _) => of(v.at(row)),
        (Data::Double(v), _) => of(v.at(row)),
        (Data::Bytes(v), _) => match v.at(row).and_then(|value| value.as_utf8().ok()) {
            Some(text) => quoted(text),
            None => String::new(),
        },
        (Data::Int96(_) | Data::Fixed(_), _) => String::new(),
    }
}

/// A text as a cell: in quotes where it needs them; line ends are blanks.
pub(crate) fn quoted(text: &str) -> String {
    match text.contains([',', ';', '"', '\n', '\r', '\t', '#']) || text.trim() != text {
        true => format!(
            "\"{}\"",
            text.replace('"', "\"\"").replace(['\n', '\r'], " ")
        ),
        false => text.to_owned(),
    }
}

/// The whole number of bytes, the highest first, with a sign; none of more than 16 bytes.
fn whole(bytes: &[u8]) -> Option<i128> {
    let (first, rest) = bytes.split_first().filter(|_| bytes.len() <= 16)?;
    let signed = i128::from(first.cast_signed());
    Some(
        rest.iter()
            .fold(signed, |value, byte| (value << 8) | i128::from(*byte)),
    )
}

/// A whole number with a point in front of its last digits.
fn with_point(value: i128, digits: u32) -> String {
    let digits = usize::try_from(digits).unwrap_or(0).min(100);
    let all = format!("{:0>width$}", value.unsigned_abs(), width = digits + 1);
    let (before, behind) = all.split_at(all.len() - digits);
    let sign = if value < 0 { "-" } else { "" };
    match behind.is_empty() {
        true => format!("{sign}{before}"),
        false => format!("{sign}{before}.{behind}"),
    }
}

/// A number of 16 bits (IEEE 754, the lowest byte first).
fn half(bytes: &[u8]) -> Option<f64> {
    let [low, high] = <[u8; 2]>::try_from(bytes).ok()?;
    let bits = u16::from_le_bytes([low, high]);
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    let size = match exponent {
        0 => fraction * 2f64.powi(-24),
        0x1f if fraction == 0.0 => f64::INFINITY,
        0x1f => f64::NAN,
        _ => (1024.0 + fraction) * 2f64.powi(exponent - 25),
    };
    Some(match bits >> 15 {
        0 => size,
        _ => -size,
    })
}
