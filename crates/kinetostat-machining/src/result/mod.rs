//! Results of a run: plain data with units in the names, and the figures and sentences made from them once, so that
//! terminal, report and JSON say the same. Computes no posture.

mod assess;
pub(crate) mod assessment;
pub(crate) mod chatter;
pub(crate) mod cutting;
pub(crate) mod envelope;
pub(crate) mod feature;
pub(crate) mod figures;
pub(crate) mod joints;
pub(crate) mod kept_points;
pub(crate) mod point;
pub(crate) mod run_result;
pub(crate) mod selection;
pub(crate) mod statements;
pub(crate) mod summary;
pub(crate) mod tolerance;
pub(crate) mod uncertainty_band;
