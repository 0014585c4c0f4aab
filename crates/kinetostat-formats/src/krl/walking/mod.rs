//! What the statements do in their order: routines followed from the first one, branches and loops noted.
//!
//! Each routine is walked once; what depends on where it is called from stays open until all its calls are known.
//!
//! [`walk`] goes through routines, blocks and statements with a [`walker`]; [`segments`] notes motions, [`calling`] calls, and
//! [`statements`] what is put in force.

mod calling;
mod segments;
mod statements;
mod walk;
pub(crate) mod walker;
