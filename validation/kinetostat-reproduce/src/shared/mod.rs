//! Shared parts of several chapters: chains of the report, and curves with their marks.

pub(crate) mod curves;
pub(crate) mod models;
