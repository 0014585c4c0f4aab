//! Cached reading of a robot's program; a run requests it several times.

use std::sync::{Arc, OnceLock};

use kinetostat_formats::{RobotPath, RobotProgram};

/// A program with its path.
#[derive(Debug)]
pub(crate) struct ReadOnce {
    pub(crate) program: RobotProgram,
    pub(crate) path: RobotPath,
}

/// Empty before the first reading.
pub(crate) type Reading = OnceLock<Arc<ReadOnce>>;
