//! Running a program of a robot: values with the literals that state them, expressions, and the bounds of a run.
//!
//! A program is run concretely, as its controller runs it. A value that only the controller knows is unknown, with its reason; a branch
//! or a loop on an unknown value is passed over where its arms neither move the tool nor change what is in force.

pub(crate) mod expression;
pub(crate) mod operation;
pub(crate) mod value;
