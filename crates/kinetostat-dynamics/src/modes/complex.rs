//! Complex modes.
