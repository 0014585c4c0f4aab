//! TODO

pub(crate) mod chain_blocks;
pub(crate) mod elimination;
pub(crate) mod passive_rules;
pub(crate) mod report_iteration;
pub(crate) mod shape_criterion;
