//! Frames against transformations by hand.
