//! TODO

pub(crate) mod assembly;
pub(crate) mod constraints;
pub(crate) mod directions;
pub(crate) mod explain;
pub(crate) mod forward;
pub(crate) mod graded;
pub(crate) mod inverse;
pub(crate) mod mobility;
pub(crate) mod network;
pub(crate) mod platform_system;
pub(crate) mod platforms;
pub(crate) mod posture;
pub(crate) mod singular;
pub(crate) mod state;
pub(crate) mod turned_loads;
