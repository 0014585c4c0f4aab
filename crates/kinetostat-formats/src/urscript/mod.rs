//! Universal Robots URScript: a program is run as its controller runs it, and corrected in place.
//!
//! Words, expressions and functions of the controller are a table ([`grammar`]); a run and the writer ask for what is its own
//! ([`dialect`]): motions with their ends and frames, and what is done with each word ([`motion`]).
//! Lengths of the text are in metres, angles in radians, orientations rotation vectors.
//!
//! Source: Universal Robots, The URScript Programming Language (script manual, e-Series, SW 5).

pub(crate) mod dialect;
mod grammar;
pub(crate) mod motion;
