//! Conversion of motions to blocks.
//!
//! [`mod@write`] goes through the motions; what changes becomes [`pieces`], with the tool's [`direction`] or the [`angles`] of
//! rotary axes where the text states them. What
//! is in force in the written program stands in [`writer`].

pub(crate) mod angles;
pub(crate) mod direction;
pub(crate) mod pieces;
pub(crate) mod write;
pub(crate) mod writer;
