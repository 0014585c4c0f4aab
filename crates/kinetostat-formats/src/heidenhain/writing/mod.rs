//! Conversion of motions to blocks.
//!
//! [`mod@write`] goes through the motions; those without [`pieces`] stay, or state what they took over. A block
//! becomes a piece with its feed, its [`angles`] or direction and its [`words`], or an arc about a [`centre`] with a pole of its own;
//! what the walk knows stands in [`writer`].

pub(crate) mod angles;
pub(crate) mod centre;
pub(crate) mod pieces;
pub(crate) mod words;
pub(crate) mod write;
pub(crate) mod writer;
