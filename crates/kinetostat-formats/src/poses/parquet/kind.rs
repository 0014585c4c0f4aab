//! Value types of a column: numbers of all types, and other values.
//!
//! Source: Apache Parquet format 2, logical types.

use parquet::basic::{ConvertedType, LogicalType, Type as PhysicalType};
use parquet::schema::types::ColumnDescriptor;

use crate::poses::parquet::data::Data;

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
