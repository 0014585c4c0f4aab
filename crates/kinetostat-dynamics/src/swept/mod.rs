//! The lowest modes of one long chain, at a cost that grows with the number of its coordinates and no faster.
//!
//! A chain is a ladder: what lies beyond a spring or joint answers the motion of its near side with a wrench, and that is
//! found from the tip inwards, coordinate by coordinate, for `P = K - H - s M` at any shift `s` (`factor`). The signs of
//! the pivots count the modes below `s` (Sylvester's law; Wittrick & Williams 1971), two passes solve `P x = b`, and a
//! block Lanczos method with these solutions finds the lowest modes (`lowest`): none is missed, since they are counted.
//!
//! The dense matrices of [`crate::LinearDynamics`] are the reference; one suite of tests is over both
//! (`tests/dynamics/swept.rs`).

pub(crate) mod factor;
pub(crate) mod long_chain;
pub(crate) mod lowest;
pub(crate) mod stages;
