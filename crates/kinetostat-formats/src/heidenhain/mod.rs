//! Heidenhain conversational programs (`.h`) of TNC 426 to TNC 640.
//!
//! From the blocks of a file ([`blocks`], [`words`]), in the order in which they run ([`flow`]), to motions ([`reading`], with what is in
//! force in [`state`], ends and ways in [`ends`], planes and circles in [`arcs`], cycles that move the coordinates in [`datum`]). What each
//! statement is taken for stands in [`table`]. Corrected blocks are written by [`writing`], and numbered again by [`blocks`].
//! Programs that repeat, jump, count or drill by cycles are run once and written flat by [`expand`].
//!
//! Source: HEIDENHAIN, user's manuals "Conversational Programming" of TNC 426/430, iTNC 530, TNC 320 and TNC 640, and public files
//! (see the tests).

pub(crate) mod arcs;
pub(crate) mod blocks;
pub(crate) mod datum;
pub(crate) mod ends;
pub(crate) mod expand;
pub(crate) mod flow;
pub(crate) mod language;
pub(crate) mod path_words;
pub(crate) mod reading;
pub(crate) mod state;
pub(crate) mod table;
pub(crate) mod words;
pub(crate) mod writing;
