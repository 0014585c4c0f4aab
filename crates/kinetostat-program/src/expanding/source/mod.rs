//! Lines of a program with macros, as statements.
//!
//! Takes the bytes of a file; gives for each line what it is: a plain block, a block with expressions, an assignment, a
//! statement of control. Knows no values.

pub(crate) mod read;
pub(crate) mod statement;
