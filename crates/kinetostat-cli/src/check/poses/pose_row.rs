//! A measured pose and its line.

use kinetostat_analysis::measured_poses::MeasuredPose;

/// A row and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct PoseRow {
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) measured: MeasuredPose,
}

/// Upper limit of the rows: more are not measured by hand.
pub(crate) const MOST: usize = 10_000;
