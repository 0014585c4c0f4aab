//! Tests of the identification against the reference values.

mod joints;
mod links;
mod support;
