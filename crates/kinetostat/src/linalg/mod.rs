//! TODO

pub(crate) mod block_elimination;
pub(crate) mod complement;
pub(crate) mod krylov;
pub(crate) mod saddle;
pub(crate) mod singular_values;
pub(crate) mod sparse;
