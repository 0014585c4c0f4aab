//! Running a program of a robot: values with the literals that state them, expressions, and the bounds of a run.
//!
//! A program is run concretely, as its controller runs it. A value that only the controller knows is unknown, with its reason; a branch
//! or a loop on an unknown value is passed over where its arms neither move the tool nor change what is in force.
//!
//! A language brings its tokens ([`token`]), its grammar of expressions ([`reading`]), its statements as a [`tree`] with [`symbols`] (by the
//! words of its blocks: [`lexing`], [`blocks`], [`block_files`]), and what is its own by [`run::Dialect`]. Shared are the order of the run
//! ([`control`], [`passing`]), its data ([`storage`], [`evaluate`], [`operation`], [`value`]), and the targets at which motions end
//! ([`ends`], [`targets`]); [`whole`] runs all programs of the files and says at the end what a person should know; [`flat`] writes a
//! program flat.

pub(crate) mod block_files;
pub(crate) mod blocks;
pub(crate) mod calls;
mod control;
pub(crate) mod ends;
pub(crate) mod evaluate;
pub(crate) mod expression;
pub(crate) mod flat;
pub(crate) mod lexing;
pub(crate) mod operation;
mod passing;
pub(crate) mod reading;
pub(crate) mod run;
pub(crate) mod storage;
pub(crate) mod symbols;
mod targets;
pub(crate) mod token;
pub(crate) mod tree;
pub(crate) mod value;
mod whole;
