//! The path as it is drawn: pieces along its length, and the feet of points on it.

mod foot;
mod path;

pub use foot::Foot;
pub use path::{NominalPath, Pass, Piece};
