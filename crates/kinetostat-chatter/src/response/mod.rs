//! Response of the tool to a force: modes with damping, and the residual flexibility of the omitted ones.
//!
//! Takes modal data at the cutting point; gives receptances in any frame. Sources: `dynamics.md` sections 3, 7 and 8.

mod coupling;
mod mode;
mod tool;

pub(crate) use coupling::Coupling;
pub use mode::Mode;
pub(crate) use tool::first_order;
pub use tool::{FeedFrame, ToolResponse};
