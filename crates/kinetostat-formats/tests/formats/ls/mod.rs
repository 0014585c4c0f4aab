//! FANUC TP programs.

mod properties;
mod random;
