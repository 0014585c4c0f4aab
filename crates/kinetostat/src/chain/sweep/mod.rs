//! TODO

pub(crate) mod end_spring;
pub(crate) mod factor;
pub(crate) mod solve;
pub(crate) mod stages;
#[cfg(test)]
mod tests;
