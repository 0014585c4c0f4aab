//! Block by block: what each of them changes, and where the tool goes.
//!
//! Knows: modes, offsets and places after the last block ([`interpreter`]). Takes a block ([`interpret`]) and gives its move
//! ([`motion`], [`machine_places`], [`carried_cycles`], [`outside_calls`]) or what it changes ([`offsets`]); in the end the path ([`finish`]).

pub(crate) mod carried_cycles;
pub(crate) mod finish;
pub(crate) mod interpret;
pub(crate) mod interpreter;
pub(crate) mod machine_places;
pub(crate) mod motion;
pub(crate) mod offsets;
pub(crate) mod outside_calls;
pub(crate) mod warnings;
