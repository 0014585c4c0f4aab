//! Papers of made-up runs.
