//! A drawing of a machine: its limbs as they stand, and how it moves or bends.
//!
//! Parallel projection; what is nearer covers what is behind. Links that bend are distinguished from rigid
//! ones, drives from passive joints. What moves little is drawn larger, on top of the machine.

mod applied;
mod limb;
mod lines;
mod order;
mod paint;
mod parts;
mod scene;
mod symbol;
#[cfg(test)]
mod tests;
mod view;

pub use lines::{Drawing, Magnified, Moved, Placed, View};
