//! Figures that are possible but unlikely: usually a unit or a decimal point is wrong.
//!
//! Takes a document and the machine that it describes; gives warnings, each at the number that it is about. Nothing here
//! refuses a model.

pub(crate) mod at_home;
pub(crate) mod drives;
pub(crate) mod home;
pub(crate) mod limb;
pub(crate) mod link_matrix;
pub(crate) mod masses;
pub(crate) mod numbers;
pub(crate) mod springs;
