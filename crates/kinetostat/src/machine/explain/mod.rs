//! Why a machine is soft or unstable: which joints and springs move with the tool, and which springs have a negative
//! net stiffness under their loads.

pub(crate) mod negative_stiffness;
pub(crate) mod participation;
