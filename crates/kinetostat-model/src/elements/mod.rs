//! Elements of a chain: from what is written, with units in the keys, to SI.
//!
//! Takes one table of a document and its place; gives parts for the core's builder, or a finding that says what is wrong
//! and what to write. Knows no other element.

pub(crate) mod damping;
pub(crate) mod elastic;
pub(crate) mod joint;
pub(crate) mod link;
pub(crate) mod part;
pub(crate) mod placement;
pub(crate) mod quantity;
pub(crate) mod rotary;
pub(crate) mod rotor;
pub(crate) mod section;
pub(crate) mod shape;
