//! Conversion of motions to blocks.
//!
//! [`mod@write`] goes through the motions; their pieces become blocks with the tool's [`place`] and direction, or the
//! [`angles`] of rotary axes where the text states them. What
//! is in force in the written program stands in [`writer`].

pub(crate) mod angles;
pub(crate) mod place;
pub(crate) mod write;
pub(crate) mod writer;
