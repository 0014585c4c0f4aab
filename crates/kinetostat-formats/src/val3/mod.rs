//! Staubli VAL3: programs (`.pgx`) with the data of their application (`.dtx`), both in XML.

mod dialect;
mod expression;
mod frames;
pub(crate) mod instructions;
pub(crate) mod language;
mod motion;
mod parser;
pub(crate) mod reader;
mod xml;
