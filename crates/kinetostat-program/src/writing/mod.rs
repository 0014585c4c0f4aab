//! From a program, its path and a field of corrections to the corrected program.
//!
//! In the order of work: the path is divided where the correction bends or jumps ([`dividing`], [`node`], [`merge`]), arcs
//! are fitted to the corrected curves of arcs ([`fitting`]), pieces become blocks ([`emit`], [`blocks`]), and every block is accounted for ([`accounting`]).

pub(crate) mod accounting;
pub(crate) mod blocks;
pub(crate) mod corrected_curve;
pub(crate) mod departure;
pub(crate) mod directed_moves;
pub(crate) mod dividing;
pub(crate) mod emit;
pub(crate) mod fitting;
pub(crate) mod merge;
pub(crate) mod node;
pub(crate) mod options;
pub(crate) mod output_state;
pub(crate) mod piece_account;
pub(crate) mod plan;
pub(crate) mod queries;
pub(crate) mod rotary_words;
pub(crate) mod short_blocks;
pub(crate) mod steps;
pub(crate) mod write;
pub(crate) mod written;
