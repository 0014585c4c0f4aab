//! Programs that are longer than memory: run part by part, and gone on with where they were interrupted.
//!
//! `compensate` and `deflect` come here with a long program in G-code ([`which`]). The program is read once
//! ([`Survey`](kinetostat_program::Survey)), looked at, and run in parts; what is done is kept beside the outputs
//! ([`checkpoint`]) until they are in place.

pub(crate) mod checkpoint;
pub(crate) mod difference;
mod partial;
pub(crate) mod put_in_place;
pub(crate) mod run;
mod side_by_side;
mod source;
pub(crate) mod which;
mod work;
