//! TODO

pub(crate) mod factor;
pub(crate) mod solve;
pub(crate) mod stages;
#[cfg(test)]
mod tests;
