//! Tables in Parquet, by way of text: read as CSV with the row of each pose, written back with all columns of that row.
//!
//! [`columns`] are those of a file, [`data`] their values and what these mean, [`text`] is the way there and back. Schema, codec of each column and further
//! metadata of the file stay; a header of comments is metadata under the key `kinetostat`.
//!
//! Source: Apache Parquet format 2, by the crate `parquet`.

pub(crate) mod columns;
pub(crate) mod data;
pub(crate) mod text;
