//! Pictures of vibration: stability lobes, and receptances of a tool.
//!
//! Takes what `kinetostat-chatter` computes; draws with `chart::plot`.

mod lobes;
mod receptance;

pub(crate) use lobes::draw as lobes;
pub(crate) use receptance::draw as receptance;
pub use receptance::{DrawnMotion, ReceptanceCurve};
