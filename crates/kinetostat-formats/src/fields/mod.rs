//! Quantities on a grid of places as files of other programs: VTK, NetCDF and Parquet.
//!
//! It takes coordinates and columns, and gives bytes. Numbers that do not exist are NaN.

mod grid;
mod polylines;
#[cfg(feature = "parquet")]
mod rows;

pub use grid::{FieldAxis, FieldColumn, FieldError, Fields};
pub use polylines::{PointQuantity, Polylines};
#[cfg(feature = "parquet")]
pub use rows::{Cell, RowColumn, RowsWriter};
