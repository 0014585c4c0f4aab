//! Block by block: what each of them changes, and where the tool goes.
//!
//! Knows: modes, offsets and places after the last block ([`interpreter`]). Takes a block ([`interpret`]) and gives its move
//! ([`motion`], [`carried`]) or what it changes ([`offsets`]); in the end the path ([`interpret`]).

pub(crate) mod carried;
pub(crate) mod interpret;
pub(crate) mod interpreter;
pub(crate) mod motion;
pub(crate) mod offsets;
pub(crate) mod warnings;
