//! The text of the pieces of one block: words replaced in place, added, taken out.
//!
//! Knows: the block as it stands ([`block_text`]), its move and what the controller holds before it. Takes the pieces of the block,
//! gives their lines ([`block_writer`]): the words that say how to move, where to and how fast ([`words`],
//! [`crate::writing::arc_words`]), and the shares of other axes.

pub(crate) mod block_text;
pub(crate) mod block_writer;
pub(crate) mod words;
