//! TODO

pub(crate) mod beam;
pub(crate) mod builder;
pub(crate) mod chain;
pub(crate) mod kinematics;
pub(crate) mod limits;
pub(crate) mod link;
pub(crate) mod loads;
pub(crate) mod mechanism;
pub(crate) mod mechanism_builder;
pub(crate) mod mechanism_check;
pub(crate) mod springs;
pub(crate) mod uniform;
