//! Universal Robots URScript: a program is run as its controller runs it, and corrected in place.
//!
//! Words and expressions are a table ([`grammar`]); a run asks for what is its own ([`dialect`]): functions of the controller ([`functions`]),
//! motions with their ends and frames ([`motion`]), what is done with each word ([`table`]). [`write`] says what the writer must know.
//! Lengths of the text are in metres, angles in radians, orientations rotation vectors.
//!
//! Source: Universal Robots, The URScript Programming Language (script manual, e-Series, SW 5).

pub(crate) mod dialect;
mod functions;
mod grammar;
mod motion;
pub(crate) mod table;
mod write;
