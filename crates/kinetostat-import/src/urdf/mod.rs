//! URDF: text to robot ([`read`]), robot to checked tree ([`tree`]), tree to platforms and paths
//! ([`graph`]), paths to chains ([`chain`]), all of it to a model file ([`mod@write`]).

mod chain;
mod close;
mod flange;
mod graph;
mod import;
mod loops;
mod read;
mod remarks;
mod request;
mod robot;
mod tree;
mod values;
mod write;
mod xml;

pub use import::{Imported, import_urdf, read_section};
pub use loops::{LoopFile, UrdfOptions};
pub use xml::{MOST_URDF_BYTES, read_text};
