//! TODO

pub(crate) mod all_of_chain;
pub(crate) mod all_of_machine;
pub(crate) mod chain;
pub(crate) mod critical;
pub(crate) mod descent;
pub(crate) mod growing_load;
pub(crate) mod no_equilibrium;
