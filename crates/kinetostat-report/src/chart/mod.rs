//! Charts: axes, lines, labels that avoid each other, and what is drawn from them.
//!
//! Takes numbers with the words for their axes; gives SVG. Knows neither runs nor machines.

pub(crate) mod area;
pub(crate) mod axis;
pub(crate) mod bars;
pub(crate) mod label;
pub(crate) mod outline;
pub(crate) mod panel;
pub(crate) mod plot;
pub(crate) mod section;
