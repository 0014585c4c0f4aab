//! The last check of a written program, from its bytes: its geometry and feeds, its text, and the field
//! evaluated again in
//! places that the division did not choose.

pub(crate) mod field;
pub(crate) mod moves;
pub(crate) mod text;
pub(crate) mod verifier;
pub(crate) mod verify;
