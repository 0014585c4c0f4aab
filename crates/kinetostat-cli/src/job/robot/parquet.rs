//! Lists of poses in Parquet, by way of text. Without the feature `parquet` there is no text: the reader refuses such a file,
//! with what to do.

use crate::ui::failure::{Answer, Failure};

/// A file in Parquet that was written.
#[derive(Debug, Default)]
pub(crate) struct Written {
    pub(crate) bytes: Vec<u8>,
    /// Columns that have another type now.
    pub(crate) widened: Vec<String>,
}

/// The text of a program in Parquet; none of any other.
pub(crate) fn as_text(name: &str, bytes: &[u8]) -> Answer<Option<Vec<u8>>> {
    match bytes.starts_with(b"PAR1") {
        true => text_of(bytes)
            .map_err(|what| Failure::input(format!("the table in Parquet '{name}': {what}"))),
        false => Ok(None),
    }
}

/// A program in Parquet with the numbers of a text.
pub(crate) fn of_text(name: &str, original: &[u8], text: &[u8]) -> Answer<Written> {
    file_of(original, text).map_err(|what| {
        Failure::input(format!(
            "the table in Parquet '{name}' cannot be written corrected: {what}"
        ))
    })
}

#[cfg(feature = "parquet")]
fn text_of(bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    kinetostat_formats::table_of_parquet(bytes).map(Some)
}

#[cfg(not(feature = "parquet"))]
fn text_of(_bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    Ok(None)
}

#[cfg(feature = "parquet")]
fn file_of(original: &[u8], text: &[u8]) -> Result<Written, String> {
    let made = kinetostat_formats::parquet_of_table(original, text)?;
    Ok(Written {
        bytes: made.bytes,
        widened: made.widened,
    })
}

#[cfg(not(feature = "parquet"))]
fn file_of(_original: &[u8], _text: &[u8]) -> Result<Written, String> {
    Err("this kinetostat does not write it".to_owned())
}
