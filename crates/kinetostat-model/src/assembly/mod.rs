//! From a document to the mechanism: chains, limbs as drawn and as built, platforms, loads, the controller's map.
//!
//! The only room that knows both the schema and the core's builders. Every mistake found on the way is kept with its place.

pub(crate) mod controller;
pub(crate) mod deviation;
pub(crate) mod load;
pub(crate) mod mechanism;
pub(crate) mod platform;
pub(crate) mod repair;
pub(crate) mod template;
