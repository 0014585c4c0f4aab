//! Staubli VAL3: programs (`.pgx`) with the data of their application (`.dtx`), both in XML.

mod dialect;
mod expression;
mod frames;
mod instructions;
pub(crate) mod language;
mod lex;
mod motion;
mod parser;
pub(crate) mod reader;
mod state;
pub(crate) mod table;
pub(crate) mod write;
mod xml;
