//! The text of the pieces of one block: words replaced in place, added, taken out.
//!
//! Knows: the block as it stands ([`block_text`]), its move and what the controller holds before it. Takes the pieces of the block,
//! gives their lines ([`block_writer`]): the words that say how to move ([`motion_words`]), where to ([`axis_words`], [`arc_of_piece`]), the shares of
//! other axes ([`extra_words`]) and how fast ([`feed_words`]).

pub(crate) mod arc_of_piece;
pub(crate) mod axis_words;
pub(crate) mod block_text;
pub(crate) mod block_writer;
pub(crate) mod feed_words;
