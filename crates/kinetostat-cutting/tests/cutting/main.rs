//! Tests of cutting forces, a module for each room.

mod fitting;
mod material;
