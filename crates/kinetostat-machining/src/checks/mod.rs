//! Does the question make sense, and does the answer?
//!
//! Takes the task and the solved points; gives figures beyond their limits, which refuse a program, and warnings about
//! figures that are allowed and unusual. Changes nothing.

pub(crate) mod correction;
pub(crate) mod displacement;
pub(crate) mod exceeded;
pub(crate) mod few_places;
pub(crate) mod load;
pub(crate) mod motion;
pub(crate) mod own_weight;
pub(crate) mod placement;
pub(crate) mod refused;
pub(crate) mod tool;
pub(crate) mod unusual;
