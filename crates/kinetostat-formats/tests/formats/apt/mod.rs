//! APT and CLDATA.

mod properties;
mod random;
