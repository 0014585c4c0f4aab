//! Chapter 5: force-deflection curves, limits and shapes of chains of two and three links, and the toggle.

pub(crate) mod elastic_figures;
pub(crate) mod three_link_figures;
pub(crate) mod three_links;
pub(crate) mod toggle;
pub(crate) mod two_chains;
