//! Tests of the cutting forces: closed forms, reference values, plain summation written apart.

#![allow(clippy::unwrap_used)]

mod corrections;
mod milling_invariants;
mod milling_plain;
mod milling_reference;
mod plain;
