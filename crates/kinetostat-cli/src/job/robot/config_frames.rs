//! Frames found in the `$config.dat` of a controller.

use std::path::PathBuf;

/// Tools and bases that were found.
#[derive(Clone, Debug)]
pub(crate) struct SystemFrames {
    pub(super) path: PathBuf,
    /// `BASE_DATA[2]`, ... in capitals.
    pub(super) names: Vec<String>,
}
