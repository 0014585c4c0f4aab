//! Chapter 4: two links under load, their matrices and their forces.

pub(crate) mod two_link_matrices;
pub(crate) mod two_links;
